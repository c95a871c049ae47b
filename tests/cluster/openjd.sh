#!/bin/sh
# Runs a scene's parts and merge by Open Job Description's own runner, and compares with one render.
# Needs openjd-cli (pip install openjd-cli). TERRARIUM names the program, SCENE the scene, SHARDS how many parts.
set -eu
root=$(cd "$(dirname "$0")/../.." && pwd)
program=${TERRARIUM:-$root/target/release/terrarium}
scene=${SCENE:-$root/scenes/gallery/caustic.ron}
shards=${SHARDS:-8}
more="--passes 16 --set image.width=160 --set image.height=100"
command -v openjd >/dev/null || { echo "openjd.sh: not tried: openjd is not installed (pip install openjd-cli)"; exit 0; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$root"
# shellcheck disable=SC2086
"$program" farm "$scene" --engine openjd --shards "$shards" -o "$work/out.exr" --parts "$work/parts" \
    --folder "$work" --program "$program" --cpus 1 $more
template=$(echo "$work"/*.openjd.yaml)
openjd check --extensions TASK_CHUNKING "$template"
begin=$(date +%s)
openjd run "$template" --extensions TASK_CHUNKING --step Merge --run-dependencies >"$work/log" 2>&1 || {
    tail -40 "$work/log"; exit 1; }
echo "openjd run: $(grep -c 'openjd_progress: 100' "$work/log") tasks said that they are done, in $(($(date +%s) - begin)) s"
# shellcheck disable=SC2086
"$program" render "$scene" -o "$work/whole.exr" --progress none -q $more
cmp "$work/out.exr" "$work/whole.exr" && echo "openjd.sh: the same bits as one render"
