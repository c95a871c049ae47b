"""What the plan promises against what a render takes, and the price of each effect.

    benches/plan.py forecast [scene...]   predicted time and memory of every scene of the repository
    benches/plan.py effects               seconds with an effect, and without it
    benches/plan.py off                   seconds where no effect is called for, beside an older build

SIZE=1 renders the scenes as they are; the default, 0.5, halves their sides and passes. BEFORE=program
names an older build: the scenes that do not call for an effect are rendered by both, in turns.
"""

import glob
import json
import os
import statistics
import subprocess
import sys
import tempfile

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from measure import ROOT, TERRARIUM, Run, verdict  # noqa: E402

SIZE = float(os.environ.get("SIZE", "0.5"))
TURNS = int(os.environ.get("TURNS", "5"))
BEFORE = os.environ.get("BEFORE")


def scenes():
    found = [file for pattern in ("scenes/*.ron", "scenes/gallery/*.ron", "scenes/gallery/*.toml", "scenes/yardstick/*.ron")
             for file in sorted(glob.glob(os.path.join(ROOT, pattern)))]
    mesh = os.path.join(ROOT, "scenes", "yardstick", "heightfield.obj")
    return [file for file in found if os.path.exists(mesh) or "heightfield" not in file]


def smaller(scene):
    """Overrides that shrink a scene by SIZE."""
    if SIZE == 1:
        return []
    plan = json.loads(subprocess.run([TERRARIUM, "plan", scene, "--json", "--quiet"],
                                     capture_output=True, check=True).stdout)
    sides = ["--set", "image.width=%d" % max(plan["width"] * SIZE, 16),
             "--set", "image.height=%d" % max(plan["height"] * SIZE, 16)]
    return sides + ["--passes", "%d" % max(plan["passes"] * SIZE, 1)]


def render(scene, stats, *more, program=TERRARIUM):
    return [program, "render", scene, "-o", "image.exr", "--progress", "none", "--stats", stats, *more]


def forecast(folder, wanted):
    print("Predicted beside taken, sides and passes x %g" % SIZE)
    print("  %-34s %9s %9s %6s   %9s %9s %6s" % ("scene", "s", "predicted", "ratio", "MiB", "predicted", "ratio"))
    stats = os.path.join(folder, "stats.json")
    times, peaks, planning = [], [], []
    for scene in wanted or scenes():
        Run(render(os.path.abspath(scene), stats, *smaller(scene)), folder)
        with open(stats) as file:
            took = json.load(file)
        seconds = sum(stage["seconds"] for stage in took["stages"])
        time = took["predicted_seconds"] / seconds
        peak = took["predicted_peak_bytes"] / took["peak_bytes"]
        times.append(max(time, 1 / time))
        peaks.append(abs(peak - 1))
        spent = sum(stage["seconds"] for stage in took["stages"] if stage["name"] in ("plan", "survey", "forecast"))
        planning.append((spent, spent / seconds))
        print("  %-34s %9.2f %9.2f %6.2f   %9.1f %9.1f %6.2f   planning %4.1f ms, %.1f %%" % (
            os.path.relpath(scene, ROOT), seconds, took["predicted_seconds"], time,
            took["peak_bytes"] / 2**20, took["predicted_peak_bytes"] / 2**20, peak, 1e3 * spent,
            100 * spent / seconds))
    verdict("share of scenes within a factor 1.5 in time", sum(t <= 1.5 for t in times) / len(times), 0.9, "more")
    verdict("share of scenes within 20 % in memory", sum(p <= 0.2 for p in peaks) / len(peaks), 0.9, "more")
    verdict("planning at most, ms", 1e3 * max(p[0] for p in planning), 50, "less")
    verdict("planning at most, share of the render", max(p[1] for p in planning), 0.02, "less")


# An effect, and a scene that calls for it.
EFFECTS = [
    ("direct", "scenes/gallery/primitives.toml"),
    ("shadows", "scenes/gallery/primitives.toml"),
    ("soft_shadows", "scenes/gallery/tumbler.ron"),
    ("reflection", "scenes/gallery/reflection.ron"),
    ("refraction", "scenes/gallery/tumbler.ron"),
    ("absorption", "scenes/gallery/tumbler.ron"),
    ("dispersion", "scenes/gallery/prism.ron"),
    ("highlights", "scenes/gallery/primitives.toml"),
    ("textures", "scenes/gallery/primitives.toml"),
    ("normal_maps", "scenes/gallery/normal_maps.ron"),
    ("caustics", "scenes/gallery/tumbler.ron"),
    ("indirect", "scenes/yardstick/cornell-glass.ron"),
    ("depth_of_field", "scenes/terrarium.ron"),
    ("environment", "scenes/gallery/still_life.toml"),
    ("antialiasing", "scenes/gallery/antialiasing.ron"),
]
# They call for no photons, indirect light, dispersion or environment.
UNCALLED = ["scenes/gallery/%s" % scene for scene in (
    "primitives.toml", "shadows.toml", "smooth_shading.toml", "textures.ron", "normal_maps.ron", "soft_shadows.ron")]
MIDDLING = ["--set", "image.width=640", "--set", "image.height=360", "--passes", "8"]
SMALL = ["--set", "image.width=320", "--set", "image.height=180", "--passes", "4"]


def in_turns(commands, folder):
    seconds = {name: [] for name in commands}
    for _ in range(TURNS):
        for name, command in commands.items():
            seconds[name].append(Run(command, folder).cpu)
    return {name: statistics.median(taken) for name, taken in seconds.items()}


def effects(folder, _):
    print("Processor seconds with each effect and without it, 320x180, medians of %d turns" % TURNS)
    stats = os.path.join(folder, "stats.json")
    for effect, scene in EFFECTS:
        path = os.path.join(ROOT, scene)
        took = in_turns({
            "on": render(path, stats, *SMALL),
            "off": render(path, stats, *SMALL, "--without", effect),
        }, folder)
        print("  %-16s %-36s on %7.3f  off %7.3f  price %+6.1f %%" % (
            effect, scene, took["on"], took["off"], 100 * (took["on"] / took["off"] - 1)))


def off(folder, _):
    if not BEFORE:
        print("The price of `off` needs an older build to compare with: BEFORE=program benches/plan.py off")
        return
    stats = os.path.join(folder, "stats.json")
    print("Scenes that call for none of what is newer than %s, in turns" % BEFORE)
    for scene in UNCALLED:
        path = os.path.join(ROOT, scene)
        took = in_turns({
            "now": render(path, stats, *MIDDLING),
            "before": render(path, stats, *MIDDLING, program=BEFORE),
        }, folder)
        verdict(scene + ": now / before", took["now"] / took["before"], 1.03, "less")


def main():
    wanted = sys.argv[1:2] or ["forecast", "effects", "off"]
    with tempfile.TemporaryDirectory() as folder:
        for name in wanted:
            {"forecast": forecast, "effects": effects, "off": off}[name](folder, sys.argv[2:])
            print(flush=True)


main()
