#!/bin/sh
# Checks the manifests for Kubernetes against its schemas, and runs their command lines as its indexed Job would, in
# any order, without a cluster. Needs kubernetes-validate and PyYAML (pip install kubernetes-validate pyyaml).
# TERRARIUM names the program, SCENE the scene, SHARDS how many parts, VERSIONS the versions of Kubernetes.
set -eu
root=$(cd "$(dirname "$0")/../.." && pwd)
program=${TERRARIUM:-$root/target/release/terrarium}
scene=${SCENE:-$root/scenes/gallery/caustic.ron}
shards=${SHARDS:-8}
more="--passes 16 --set image.width=160 --set image.height=100"
command -v kubernetes-validate >/dev/null || {
    echo "kubernetes.sh: not tried: kubernetes-validate is not installed (pip install kubernetes-validate pyyaml)"; exit 0; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$root"
# shellcheck disable=SC2086
"$program" farm "$scene" --engine kubernetes --shards "$shards" -o "$work/out.exr" --parts "$work/parts" \
    --folder "$work" --program "$program" --cpus 1 $more >/dev/null
for version in ${VERSIONS:-1.31 1.37}; do
    kubernetes-validate --strict -k "$version" "$work"/*.yaml
done
python3=$(dirname "$(command -v kubernetes-validate)")/python3
[ -x "$python3" ] || python3=python3
"$python3" - "$work"/*.yaml <<'EOF'
import os, random, subprocess, sys, yaml

jobs = [job for path in sys.argv[1:] for job in yaml.safe_load_all(open(path)) if job and job["kind"] == "Job"]
jobs.sort(key=lambda job: -job["spec"].get("completions", 1))
for job in jobs:
    [container] = job["spec"]["template"]["spec"]["containers"]
    words = container.get("command", []) + container.get("args", [])
    indexed = job["spec"].get("completionMode") == "Indexed"
    indices = list(range(job["spec"].get("completions", 1)))
    random.Random(7).shuffle(indices)
    for index in indices:
        variables = {"JOB_COMPLETION_INDEX": str(index)} if indexed else {}
        subprocess.run(words, cwd=container.get("workingDir"), env={**os.environ, **variables}, check=True,
                       stderr=subprocess.DEVNULL)
    print("%s: %d tasks ran" % (job["metadata"]["name"], len(indices)))
EOF
# shellcheck disable=SC2086
"$program" render "$scene" -o "$work/whole.exr" --progress none -q $more
cmp "$work/out.exr" "$work/whole.exr" && echo "kubernetes.sh: the same bits as one render"
