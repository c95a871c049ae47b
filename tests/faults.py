"""Kills a render, or has the system refuse it, at each of its writes: `make faults`, and a step of `make hard`.

What is at the output's place after that has to be the old file or a whole new one, whose bits are those of a
render that nothing happened to; with --resume the render then has to go on to the same bits. Needs strace
(https://strace.io), which injects the faults; images are read by OpenEXR's own reader where Python has it
(pip install OpenEXR).
"""

import filecmp
import os
import re
import shutil
import subprocess
import sys
import tempfile

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
TERRARIUM = os.environ.get("TERRARIUM", os.path.join(ROOT, "target", "release", "terrarium"))
SCENE = os.path.join(ROOT, "scenes", "gallery", "caustic.ron")
RENDER = [TERRARIUM, "render", SCENE, "-o", "out.exr", "-o", "out.png", "--quiet", "--progress", "none",
          "--set", "image.width=96", "--set", "image.height=54", "--passes", "4", "--checkpoint", "20ms", "--resume"]
# Everything that changes a file or its name.
CALLS = "write,pwrite64,writev,rename,renameat,renameat2,fsync,fdatasync,unlink,ftruncate,openat"
IMAGES = ("out.exr", "out.png")


def traced(folder, inject=None):
    calls = ["-e", "trace=" + CALLS] + (["-e", "inject=%s:%s" % (CALLS, inject)] if inject else [])
    log = os.path.join(folder, "strace")
    process = subprocess.run(["strace", "-f", "-o", log, *calls, *RENDER], cwd=folder, capture_output=True, text=True)
    with open(log) as file:
        made = sum(bool(re.search(r"\b(%s)\(" % CALLS.replace(",", "|"), line)) for line in file)
    os.remove(log)
    return process, made


def readable(path):
    try:
        import OpenEXR
    except ImportError:
        return
    if path.endswith(".exr"):
        OpenEXR.File(path)


def judge(folder, whole, when):
    """What is there is whole; whether anything is."""
    there = False
    for name in IMAGES:
        path = os.path.join(folder, name)
        if os.path.exists(path):
            there = True
            readable(path)
            if not filecmp.cmp(path, os.path.join(whole, name), shallow=False):
                sys.exit("%s: %s is not whole" % (when, name))
    return there


def finish(folder, whole, when):
    process = subprocess.run(RENDER, cwd=folder, capture_output=True, text=True)
    if process.returncode:
        sys.exit("%s: it does not go on: %s" % (when, process.stderr))
    judge(folder, whole, when + ", after going on")
    left = sorted(name for name in os.listdir(folder) if ".tmp-" not in name)
    if left != sorted(IMAGES):
        sys.exit("%s: it leaves %s" % (when, left))


def reader():
    try:
        import OpenEXR
        return "read by OpenEXR %s" % OpenEXR.__version__
    except ImportError:
        return "not read by OpenEXR, which Python does not have here"


def main():
    if not shutil.which("strace"):
        print("make faults: skipped: there is no strace")
        return
    with tempfile.TemporaryDirectory() as whole:
        subprocess.run(RENDER, cwd=whole, check=True)
        with tempfile.TemporaryDirectory() as folder:
            process, calls = traced(folder)
            if process.returncode:
                print("make faults: skipped: strace can't trace here: " + process.stderr.strip())
                return
        kills = refused = early = 0
        # Threads make a few calls more or less each time.
        every = max(1, calls // int(os.environ.get("FAULTS", "60")))
        for n in range(1, calls + 1, every):
            for inject in ("signal=KILL:when=%d" % n, "error=ENOSPC:when=%d+" % n, "error=EIO:when=%d" % n):
                with tempfile.TemporaryDirectory() as folder:
                    when = "%s of %d calls" % (inject, calls)
                    process, _ = traced(folder, inject)
                    kill = inject.startswith("signal")
                    if not kill and process.returncode not in (0, 1, 2, 3, 4, 127):
                        sys.exit("%s: code %d: %s" % (when, process.returncode, process.stderr))
                    if "panicked" in process.stderr or "broke off" in process.stderr:
                        sys.exit("%s: %s" % (when, process.stderr))
                    early += judge(folder, whole, when)
                    finish(folder, whole, when)
                    kills += kill
                    refused += not kill
        print("%d calls: killed at %d, refused at %d; images were there after %d (%s); always whole, and gone on with"
              % (calls, kills, refused, early, reader()))


main()
