#!/bin/sh
# Compiles embree_rays.cpp and runs it: embree.sh DIRECTORY [robust]
# Leaves with status 77 and a reason on stderr where g++ or Embree 3 is missing.
set -eu
here=$(dirname "$0")
command -v g++ >/dev/null || { echo "no g++ here" >&2; exit 77; }
echo '#include <embree3/rtcore.h>' | g++ -E -x c++ - >/dev/null 2>&1 ||
    { echo "no Embree 3 headers here (Debian: libembree-dev)" >&2; exit 77; }
g++ -O3 -march=native -std=c++17 "$here/embree_rays.cpp" -o "$1/embree_rays" -lembree3 -pthread
exec "$1/embree_rays" "$@"
