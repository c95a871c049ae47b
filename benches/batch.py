"""What batches cost: a merge of 8 parts of 1920x1080, checkpoints, and 8 shards beside one run.

    benches/batch.py        on the machine as it is; TURNS=n sets how often each program runs
"""

import filecmp
import json
import os
import statistics
import sys
import tempfile

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from measure import ROOT, TERRARIUM, Run, verdict  # noqa: E402

TURNS = int(os.environ.get("TURNS", "3"))
PARTS = 8
PLAIN = os.path.join(ROOT, "scenes", "gallery", "primitives.toml")
CAUSTIC = os.path.join(ROOT, "scenes", "gallery", "caustic.ron")
LARGE = ["--set", "image.width=1920", "--set", "image.height=1080", "--passes", str(PARTS)]
# Checkpoints are this far apart at least, if they are not asked for otherwise.
APART = 30.0


def render(scene, folder, *more):
    return Run([TERRARIUM, "render", scene, "--progress", "none", "--quiet", *more], folder)


def shards(scene, folder, settings):
    """Renders every shard as a process of its own; their processor seconds, and their files."""
    files = ["part-%d.exr" % i for i in range(PARTS)]
    cpu = sum(render(scene, folder, *settings, "--shard", "%d/%d" % (i, PARTS), "-o", file).cpu
              for i, file in enumerate(files))
    return cpu, files


def equal(folder, one, other):
    if not filecmp.cmp(os.path.join(folder, one), os.path.join(folder, other), shallow=False):
        raise RuntimeError("the merged image is not that of one run")


def merging(folder):
    _, files = shards(PLAIN, folder, LARGE)
    render(PLAIN, folder, *LARGE, "-o", "whole.exr")
    os.sync()
    runs = [Run([TERRARIUM, "merge", *files, "-o", "merged.exr"], folder) for _ in range(TURNS)]
    equal(folder, "merged.exr", "whole.exr")
    size = os.path.getsize(os.path.join(folder, files[0])) / 2**20
    print("  8 parts of %.0f MiB, %.0f MiB held" % (size, max(run.peak for run in runs)))
    verdict("merging 8 parts of 1920x1080, s", statistics.median(run.wall for run in runs), 3, "less")


def checkpoints(folder):
    stats = os.path.join(folder, "stats.json")
    render(PLAIN, folder, *LARGE, "-o", "often.exr", "--checkpoint", "1s", "--stats", stats)
    with open(stats) as file:
        took = json.load(file)["checkpoints"]
    equal(folder, "often.exr", "whole.exr")
    each = took["seconds"] / took["written"]
    print("  a checkpoint of 1920x1080 takes %.2f s (mean of %d)" % (each, took["written"]))
    verdict("checkpoints' share of a render's time", each / max(APART, 50 * each), 0.02, "less")


def splitting(folder):
    small = ["--set", "image.width=960", "--set", "image.height=540", "--passes", "32"]
    whole, parts = [], []
    for _ in range(TURNS):
        whole.append(render(CAUSTIC, folder, *small, "-o", "whole.exr").cpu)
        parts.append(shards(CAUSTIC, folder, small)[0])
    print("  caustic.ron, 32 passes: %.1f s of processor time, 8 shards %.1f s" % (
        statistics.median(whole), statistics.median(parts)))
    verdict("8 shards / one run, processor time", statistics.median(parts) / statistics.median(whole), 1.05, "less")


def main():
    print("Batches, medians of %d" % TURNS)
    with tempfile.TemporaryDirectory() as folder:
        merging(folder)
        checkpoints(folder)
        splitting(folder)


main()
