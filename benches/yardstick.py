"""How far Terrarium's pictures are from references, against time: `make yardstick`.

Two scenes, a ladder of passes each: whole-process seconds on two threads, the least of TURNS runs (1); the
error as mean((I - R)^2 / (R^2 + 0.01)) without the worst 0.1 % of the pixels, less the noise of the
reference; the mean of the picture over that of the reference; peak memory. For the sphere also the box of
pixels where its caustic lies, with nothing left out. Below it the goals, met or missed.

    benches/yardstick.py [caustic-sphere|cornell-glass]... [--passes 1,2,4,8]
"""

import argparse
import math
import os
import sys
import tempfile

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import images  # noqa: E402
from measure import ROOT, SCENES, TERRARIUM, Run, verdict  # noqa: E402

REFERENCES = os.path.join(ROOT, "tests", "references")
TURNS = int(os.environ.get("TURNS", "1"))
THREADS = os.environ.get("THREADS", "2")
WIDTH = 256
LADDER = "1,2,4,8,16,32,64,128"
TARGETS = (1e-2, 3e-3, 1e-3)


class Scene:
    """A scene, the noise of its reference, and what is wanted of it."""

    def __init__(self, noise, goals, box=None, box_goal=None):
        self.noise, self.goals, self.box, self.box_goal = noise, goals, box, box_goal


# Goals: seconds to an error. The box: columns and rows, from the first to the one after the last; its goal is
# an error, the seconds to it, and the energy that it must have there.
YARDSTICK = {
    "caustic-sphere": Scene(1.8e-4, {3e-3: 0.4, 1e-3: 1.1}, ((150, 215), (160, 200)), (1e-2, 5.0, (0.98, 1.02))),
    "cornell-glass": Scene(2.2e-4, {3e-3: 4.0, 1e-3: 25.0}),
}


class Rung:
    """One number of passes: what it took and how good it is."""

    def __init__(self, passes, runs, image, reference, scene):
        self.passes = passes
        self.seconds = min(run.wall for run in runs)
        self.cpu = min(run.cpu for run in runs)
        self.peak = max(run.peak for run in runs)
        self.measured = images.rel_mse(image, reference)
        self.error = max(self.measured - scene.noise, 0.0)
        self.mean = sum(image) / sum(reference)
        if scene.box:
            part = cut(image, scene.box), cut(reference, scene.box)
            self.box = images.rel_mse(*part, trimmed=0.0)
            self.energy = sum(part[0]) / sum(part[1])


def cut(image, box):
    """The pixels of a box."""
    (left, right), (top, bottom) = box
    values = []
    for y in range(top, bottom):
        values.extend(image[3 * (y * WIDTH + left):3 * (y * WIDTH + right)])
    return values


def render(name, passes, folder):
    output = os.path.join(folder, "%s.exr" % name)
    command = [TERRARIUM, "render", os.path.join(SCENES, name + ".ron"), "-o", output, "--progress", "none",
               "--quiet", "--threads", THREADS, "--passes", str(passes)]
    return [Run(command, folder) for _ in range(TURNS)], images.read(output)


def slope(rungs, value):
    """Least squares through log value against log passes; the noise of the reference ends what is fitted."""
    points = [(math.log(r.passes), math.log(value(r))) for r in rungs if value(r) > 0]
    if len(points) < 2:
        return float("nan")
    mx, my = (sum(p[i] for p in points) / len(points) for i in (0, 1))
    return sum((x - mx) * (y - my) for x, y in points) / sum((x - mx) ** 2 for x, _ in points)


def time_to(rungs, target, value):
    """Seconds until a value is at most `target`, between rungs by a power law: (text, seconds or None)."""
    first = rungs[0]
    if value(first) <= target:
        return "< %.2f" % first.seconds, first.seconds
    for a, b in zip(rungs, rungs[1:]):
        if value(b) <= target:
            low = max(value(b), 1e-12)
            part = math.log(value(a) / target) / math.log(value(a) / low)
            seconds = a.seconds * (b.seconds / a.seconds) ** part
            return "%.2f" % seconds, seconds
    return "not in %.1f" % rungs[-1].seconds, None


def goal(title, text, seconds, allowed):
    met = seconds is not None and seconds <= allowed
    print("  %-44s %12s s (goal <= %g s) %s" % (title, text, allowed, "met" if met else "MISSED"))


def report(name, scene, rungs):
    print("  error falls with passes as n^%.2f" % slope(rungs[1:] or rungs, lambda r: r.error))
    for target in TARGETS:
        text, seconds = time_to(rungs, target, lambda r: r.error)
        title = "relMSE %g" % target
        if target in scene.goals:
            goal(title, text, seconds, scene.goals[target])
        else:
            print("  %-44s %12s s" % (title, text))
    last = rungs[-1]
    verdict("mean off by, %", 100 * abs(last.mean - 1), 0.5, "less")
    if scene.box:
        target, allowed, (low, high) = scene.box_goal
        print("  its error falls as n^%.2f" % slope(rungs[1:] or rungs, lambda r: r.box))
        text, seconds = time_to(rungs, target, lambda r: r.box)
        goal("caustic box %g" % target, text, seconds, allowed)
        there = next((r for r in rungs if r.box <= target), last)
        met = low <= there.energy <= high
        print("  %-44s %12.4f   (goal %g to %g) %s" % (
            "energy of the box at %d passes" % there.passes, there.energy, low, high, "met" if met else "MISSED"))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("scene", nargs="*", help=", ".join(YARDSTICK))
    parser.add_argument("--passes", default=os.environ.get("LADDER", LADDER), help="the ladder: " + LADDER)
    arguments = parser.parse_args()
    ladder = sorted({int(n) for n in arguments.passes.split(",")})
    for name in arguments.scene or YARDSTICK:
        scene = YARDSTICK[name]
        reference = images.read(os.path.join(REFERENCES, name + ".exr"))
        print("%s, 256x256, %s threads, %d run%s a rung; the reference's noise of %g is subtracted" % (
            name, THREADS, TURNS, "" if TURNS == 1 else "s", scene.noise))
        box = "  %9s %9s" % ("box", "energy") if scene.box else ""
        print("  %6s %9s %9s %10s %9s%s %7s" % ("passes", "wall s", "CPU s", "relMSE", "mean", box, "MiB"))
        rungs = []
        with tempfile.TemporaryDirectory() as folder:
            for passes in ladder:
                runs, image = render(name, passes, folder)
                r = Rung(passes, runs, image, reference, scene)
                rungs.append(r)
                box = "  %9.2e %9.4f" % (r.box, r.energy) if scene.box else ""
                print("  %6d %9.3f %9.3f %10.2e %9.5f%s %7.1f" % (
                    r.passes, r.seconds, r.cpu, r.error, r.mean, box, r.peak), flush=True)
        report(name, scene, rungs)
        print(flush=True)


main()
