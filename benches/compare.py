"""Whole programs timed against each other, in turns, so that a busy machine slows all alike.

Every row names what is compared, the least and the median of the turns, and a ratio. `benches/run`
calls this; a peer that is not there is left out with a message.
"""

import array
import os
import re
import shutil
import statistics
import subprocess
import sys
import tempfile

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import images  # noqa: E402
from measure import ROOT, SCENES, TERRARIUM, Run, verdict  # noqa: E402

PEERS = os.path.join(ROOT, "benches", "peers")
TURNS = int(os.environ.get("TURNS", "3"))


def in_turns(commands, cwd, turns=TURNS):
    """Runs each of the named commands `turns` times, in turns."""
    runs = {name: [] for name in commands}
    for _ in range(turns):
        for name in list(runs):
            try:
                runs[name].append(Run(commands[name], cwd))
            except RuntimeError as failure:
                if commands[name][0] == TERRARIUM:
                    raise
                print("  %s does not run here: left out (%s)" % (name, str(failure).splitlines()[-1].strip()))
                del runs[name]
    return runs


def row(title, values, unit="s"):
    print("  %-44s min %8.3f  median %8.3f %s" % (title, min(values), statistics.median(values), unit))


def least(runs, what):
    return min(getattr(r, what) for r in runs)


def ours(scene, output, *more):
    return [TERRARIUM, "render", os.path.join(SCENES, scene), "-o", output, "--progress", "none", *more]


def povray(output, *antialiasing):
    return ["povray", "+I" + os.path.join(PEERS, "primitives.pov"), "+O" + output, "+W1024", "+H768", "-D",
            "+FP16", "File_Gamma=1.0", "-J", "+WT2", *antialiasing]


def primitives(folder):
    print("Y5 primitives, 1024x768, against POV-Ray")
    commands = {"terrarium grid(3)": ours("primitives.ron", "grid.exr", "--threads", "2")}
    if shutil.which("povray"):
        commands["POV-Ray 3x3"] = povray("grid.ppm", "+AM1", "+A0.0", "+R3")
    else:
        print("  POV-Ray is not here (Debian: povray): left out")
    runs = in_turns(commands, folder)
    for name, took in runs.items():
        row(name + ", CPU", [r.cpu for r in took])
    if len(runs) == 2:
        mine, theirs = (least(took, "cpu") for took in runs.values())
        verdict("grid(3) / POV-Ray 3x3, CPU", mine / theirs, 1 / 3, "less")


# Of each program, from the coarse to the fine.
OUR_ADAPTIVE = ["adaptive(threshold: %g, depth: %d)" % (t, d)
                for d in (1, 2, 3) for t in (0.8, 0.5, 0.3, 0.1)] + ["none", "grid(2)"]
THEIR_ADAPTIVE = [("+AM1", "+A0.3", "+R3"), ("+AM1", "+A0.1", "+R3"), ("+AM1", "+A0.1", "+R4"),
                  ("+AM2", "+A0.3", "+R3"), ("+AM2", "+A0.1", "+R3"), ("+AM2", "+A0.03", "+R3"),
                  ("+AM2", "+A0.1", "+R4")]


def adaptive(folder):
    """Each program's error is against its own picture of 9 x 9 samples a pixel, so that what differs between
    the two scenes does not count; for every setting of the peer's, the cheapest of ours that is as good."""
    print("Y5 primitives, adaptive antialiasing at like error, against POV-Ray")
    if not shutil.which("povray"):
        print("  POV-Ray is not here (Debian: povray): left out")
        return
    mine = {a: ours("primitives.ron", "a%d.exr" % i, "--threads", "2", "--set", "antialiasing=" + a)
            for i, a in enumerate(OUR_ADAPTIVE)}
    theirs = {" ".join(a): povray("a%d.ppm" % i, *a) for i, a in enumerate(THEIR_ADAPTIVE)}
    runs = in_turns({**mine, **theirs}, folder)
    Run(ours("primitives.ron", "own.exr", "--set", "antialiasing=grid(9)"), folder)
    Run(povray("own.ppm", "+AM1", "+A0.0", "+R9"), folder)

    def measured(names, kind, scale):
        read = lambda name: images.read(os.path.join(folder, name + kind))  # noqa: E731
        reference = array.array("d", (scale * v for v in read("own")))
        return {n: (least(runs[n], "cpu"), images.rel_mse(read("a%d" % i), reference, scale))
                for i, n in enumerate(names)}

    mine, theirs = measured(mine, ".exr", 1.0), measured(theirs, ".ppm", 4.0)
    print("  relMSE against 9 x 9 samples of its own, without the worst 0.1 % of the pixels; CPU in s")
    for name, (cpu, error) in theirs.items():
        print("  POV-Ray %-36s %8.2f  %9.2e" % (name, cpu, error))
        good = [(c, n) for n, (c, e) in mine.items() if e <= error]
        if not good:
            print("    none of ours is as good: MISSED")
            continue
        cheapest, ours_is = min(good)
        print("    %-40s %8.2f  %9.2e" % (ours_is, cheapest, mine[ours_is][1]))
        verdict("CPU at like error", cheapest / cpu, 1 / 3, "less")


def mitsuba_variants():
    """The variants that can be imported here; drawing one pixel shows whether they run."""
    found = []
    for variant in ("scalar_rgb", "llvm_ad_rgb"):
        test = "import mitsuba; mitsuba.set_variant('%s'); mitsuba.load_dict({'type': 'sphere'})" % variant
        if subprocess.run([sys.executable, "-c", test], capture_output=True).returncode == 0:
            found.append(variant)
    return found


def heightfield(folder):
    print("Y4 heightfield, 1024x1024, 16 samples, against Mitsuba")
    if not os.path.exists(os.path.join(SCENES, "heightfield.obj")):
        print("  its mesh is not here (cargo run --release --example heightfield): left out")
        return
    stats = os.path.join(folder, "stats.json")
    commands = {"terrarium": ours("heightfield.ron", "field.exr", "--threads", "2", "--stats", stats)}
    variants = mitsuba_variants()
    if not variants:
        print("  Mitsuba is not here (pip install mitsuba): left out")
    for variant in variants:
        commands["Mitsuba " + variant] = [
            sys.executable, os.path.join(PEERS, "heightfield_mitsuba.py"), variant,
            os.path.join(SCENES, "heightfield.obj"), "mitsuba.exr"]
    runs = in_turns(commands, folder)
    for name, took in runs.items():
        row(name + ", wall", [r.wall for r in took])
        row(name + ", CPU", [r.cpu for r in took])
        row(name + ", peak", [r.peak for r in took], "MiB")
    for variant in (v for v in variants if "Mitsuba " + v in runs):
        ratio = least(runs["terrarium"], "wall") / least(runs["Mitsuba " + variant], "wall")
        goal = 1.0 if variant == "scalar_rgb" else float("inf")
        verdict("terrarium / Mitsuba %s, wall" % variant, ratio, goal, "less")
    verdict("peak, MiB", least(runs["terrarium"], "peak"), 400, "less")


def start_up(folder):
    print("Start-up: primitives at 1x1 pixel, one sample")
    command = ours("primitives.ron", "dot.exr", "--set", "image.width=1", "--set", "image.height=1",
                   "--set", "antialiasing=none")
    took = [Run(command, folder).wall * 1000 for _ in range(10)]
    row("whole process, wall", took, "ms")
    verdict("start-up, ms", min(took), 50, "less")


def threads(folder):
    print("Threads: primitives with grid(3), the tracing stage alone")
    stats = os.path.join(folder, "stats.json")
    seconds = {1: [], 2: []}
    for _ in range(max(TURNS, 5)):
        for n, taken in seconds.items():
            Run(ours("primitives.ron", "threads.exr", "--threads", str(n), "--stats", stats), folder)
            with open(stats) as file:
                taken.append(trace_seconds(file.read()))
    for n, taken in seconds.items():
        row("%d thread%s" % (n, "s" if n > 1 else ""), taken)
    verdict("speed-up", min(seconds[1]) / min(seconds[2]), 1.9, "more")


def trace_seconds(stats):
    found = re.search(r'"name":\s*"trace",\s*"seconds":\s*([0-9.e+-]+)', stats)
    if not found:
        raise RuntimeError("the statistics have no stage `trace`")
    return float(found.group(1))


def main():
    wanted = sys.argv[1:] or ["primitives", "adaptive", "heightfield", "start_up", "threads"]
    with tempfile.TemporaryDirectory() as folder:
        for name in wanted:
            {"primitives": primitives, "adaptive": adaptive, "heightfield": heightfield,
             "start_up": start_up, "threads": threads}[name](folder)
            print(flush=True)


main()
