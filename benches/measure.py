"""What a run of a program takes, and goals met or missed: for everything here that times programs."""

import os
import subprocess
import time

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
SCENES = os.path.join(ROOT, "scenes", "yardstick")
TERRARIUM = os.environ.get("TERRARIUM", os.path.join(ROOT, "target", "release", "terrarium"))


class Run:
    """What one run of a program took: seconds of wall and processor time, and its peak in MiB."""

    def __init__(self, command, cwd):
        start = time.perf_counter()
        process = subprocess.Popen(command, cwd=cwd, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        self.output = process.stdout.read().decode(errors="replace")
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        self.wall = time.perf_counter() - start
        self.cpu = usage.ru_utime + usage.ru_stime
        self.peak = usage.ru_maxrss / 1024
        if process.returncode:
            raise RuntimeError("%s failed:\n%s" % (command[0], self.output[-800:]))


def verdict(title, ratio, goal, better):
    """Prints whether a goal is met, and returns it."""
    met = ratio <= goal if better == "less" else ratio >= goal
    sign = "<=" if better == "less" else ">="
    print("  %-44s %12.3f  (goal %s %.3g) %s" % (title, ratio, sign, goal, "met" if met else "MISSED"))
    return met
