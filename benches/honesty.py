"""Whether renders tell the truth about their error: `make honesty`.

Five scenes, each at several numbers of passes and with many seeds: the stated error and its interval beside
the true error, against a reference of many more passes and another seed (made once, kept in target/honesty), whose own noise is taken off.
Then renders that end at an error, and at a time. The table is put into docs/accuracy.md. Ends with 1 where a goal is
missed.

SEEDS=20, SIDE=128 (pixels of the longer side), REFERENCE=4000 (passes), ONLY=names of scenes, or parts of
them, with commas between. What was found of a scene is kept with the program and the settings that it was found with:
with both the same it is not looked for again, and scenes that are not in ONLY are in the table, too.
"""

import hashlib
import json
import math
import os
import statistics
import subprocess
import sys
import time

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from measure import ROOT, TERRARIUM, verdict  # noqa: E402

SEEDS = int(os.environ.get("SEEDS", "20"))
SIDE = int(os.environ.get("SIDE", "128"))
REFERENCE = int(os.environ.get("REFERENCE", "4000"))
# Photons of the reference's passes over those of the renders'.
MORE = 4
FOLDER = os.path.join(ROOT, "target", "honesty")
with open(TERRARIUM, "rb") as program:
    PROGRAM = hashlib.sha256(program.read()).hexdigest()
SCENES = ["yardstick/caustic-sphere.ron", "yardstick/cornell-glass.ron", "gallery/tumbler.ron", "gallery/reflection.ron",
          "gallery/still_life.toml"]
PASSES = [4, 8, 16, 64]
TARGET = 0.02
PAGE = os.path.join(ROOT, "docs", "accuracy.md")


def run(*arguments):
    return subprocess.run([TERRARIUM, *arguments], capture_output=True, text=True)


def plan(scene, *more):
    return json.loads(run("plan", scene, "--json", "--quiet", "--passes", "1", *more).stdout)


def small(scene):
    """Overrides that make the longer side of a scene SIDE pixels."""
    planned = plan(scene)
    longer = max(planned["width"], planned["height"])
    side = lambda n: str(max(n * SIDE // longer, 1))  # noqa: E731
    return ["--set", "image.width=" + side(planned["width"]), "--set", "image.height=" + side(planned["height"])]


def render(scene, image, *more):
    """The statistics of a render."""
    done = run("render", scene, "-o", image, "--quiet", "--stats", "-", *more)
    if done.returncode:
        sys.exit(done.stderr)
    return json.loads(done.stdout)


def error(image, truth):
    """The relative RMS error of an image, without that of the reference's own noise."""
    reference, noise = truth
    found = json.loads(run("diff", image, reference, "--json", "--fast").stdout)
    picture = next(layer for layer in found["layers"] if layer["name"] == "")
    return math.sqrt(max(picture["colour"]["relative_rms"] ** 2 - noise ** 2, 0.0))


def reference(scene, size):
    """An image, and the noise that it states of itself. Its passes send MORE times the photons, so that its blur, which
    falls with the passes as that of the renders does, hides little of theirs."""
    planned = plan(scene, *size)
    photons = max((planned[kind] or {"emitted": 0})["emitted"] for kind in ("photons", "indirect_photons"))
    more = ["--set", "photons.progressive.count=%d" % (MORE * photons)] if photons else []
    name = os.path.basename(scene).split(".")[0]
    image = os.path.join(FOLDER, "%s-%d-%d-%s.exr" % (name, SIDE, REFERENCE, planned["scene_hash"][:8]))
    kept = image + ".json"
    if not os.path.exists(image) or not os.path.exists(kept):
        stated = render(scene, image, *size, *more, "--passes", str(REFERENCE), "--seed", "1000")["accuracy"]
        with open(kept, "w", encoding="utf-8") as out:
            json.dump(stated, out)
    with open(kept, encoding="utf-8") as stated:
        return image, json.load(stated)["noise"]


class Found:
    """What is found of one scene."""

    def __init__(self, name):
        self.name = name
        self.rows = []  # of passes: (passes, true, stated, bias, width, held)
        self.ended = []  # true errors of renders to an error
        self.misses = []  # of renders to a time, over what is allowed

    def share(self):
        return sum(row[5] for row in self.rows) / (len(self.rows) * SEEDS)

    @staticmethod
    def kept(name):
        """The file for what is found of a scene by this program with these settings."""
        scene = plan(os.path.join(ROOT, "scenes", name))["scene_hash"]
        of = repr((PROGRAM, scene, SEEDS, SIDE, REFERENCE, MORE, PASSES, TARGET))
        return os.path.join(FOLDER, "found-%s.json" % hashlib.sha256(of.encode()).hexdigest()[:16])

    @staticmethod
    def before(name):
        """What was found of a scene by an earlier run; None if there is nothing."""
        if not os.path.exists(Found.kept(name)):
            return None
        found = Found(name)
        with open(Found.kept(name), encoding="utf-8") as file:
            found.rows, found.ended, found.misses = json.load(file)
        return found

    def keep(self):
        with open(Found.kept(self.name), "w", encoding="utf-8") as file:
            json.dump([self.rows, self.ended, self.misses], file)


def by_passes(found, scene, size, truth, image):
    for passes in PASSES:
        runs = []
        for seed in range(SEEDS):
            stated = render(scene, image, *size, "--passes", str(passes), "--seed", str(seed))["accuracy"]
            runs.append((error(image, truth), stated))
        held = sum(s["interval"][0] <= e <= s["interval"][1] for e, s in runs)
        true, said = statistics.mean(e for e, _ in runs), statistics.mean(s["error"] for _, s in runs)
        bias = statistics.mean(s["bias"] for _, s in runs)
        wide = statistics.median(s["interval"][1] / s["interval"][0] for _, s in runs)
        found.rows.append((passes, true, said, bias, wide, held))
        print("  %4d passes  true %7.3f %%  stated %7.3f %% (bias %6.3f %%), upper end over lower %5.2f  held %2d of %d" % (
            passes, 100 * true, 100 * said, 100 * bias, wide, held, SEEDS), flush=True)


def study(name, image):
    found = Found(name)
    scene = os.path.join(ROOT, "scenes", name)
    size = small(scene)
    truth = reference(scene, size)
    print("%s, %d seeds: true and stated error" % (name, SEEDS), flush=True)
    by_passes(found, scene, size, truth, image)
    for seed in range(SEEDS):
        render(scene, image, *size, "--error", str(TARGET), "--passes", "100000", "--seed", str(seed))
        found.ended.append(error(image, truth))
    print("  to 2 %%: true errors %s" % " ".join("%.2f" % (100 * e) for e in found.ended), flush=True)
    for seconds in (1, 3):
        began = time.perf_counter()
        render(scene, image, *size, "--passes", "100000", "--time", "%ds" % seconds)
        found.misses.append((time.perf_counter() - began - seconds) / max(0.5, 0.03 * seconds))
    found.keep()
    return found


def at_error(ended):
    """The share of renders to 2 % that end between 1 and 2.2 %."""
    return sum(0.01 <= e <= 0.022 for e in ended) / len(ended)


def write(all_found, left_out):
    """The table, between its marks on the page."""
    lines = ["| scene | passes | true error | stated | of which bias | upper end over lower | held | to 2 %: true errors |",
             "|---|---|---|---|---|---|---|---|"]
    for found in all_found:
        ends = "%.2f to %.2f %%, %d of %d in 1 to 2.2 %%" % (
            100 * min(found.ended), 100 * max(found.ended), round(at_error(found.ended) * SEEDS), SEEDS)
        for i, (passes, true, said, bias, wide, held) in enumerate(found.rows):
            lines.append("| %s | %d | %.3g %% | %.3g %% | %.2g %% | %.2f | %d of %d | %s |" % (
                "`%s`" % found.name if i == 0 else "", passes, 100 * true, 100 * said, 100 * bias, wide, held, SEEDS,
                ends if i == 0 else ""))
    lines += ["", "%d seeds, %d pixels on the longer side, references of %d passes with four times the photons, their own noise taken off. Renders "
              "with `--time` missed it by at most %.0f %% of what is allowed, max(0.5 s, 3 %%)." % (
                  SEEDS, SIDE, REFERENCE, 100 * max(abs(m) for found in all_found for m in found.misses))]
    if left_out:
        lines += ["", "Not in this run: %s." % ", ".join("`%s`" % name for name in left_out)]
    with open(PAGE, encoding="utf-8") as file:
        before, rest = file.read().split("<!-- honesty -->\n")
    after = rest.split("<!-- end -->", 1)[1]
    with open(PAGE, "w", encoding="utf-8") as file:
        file.write(before + "<!-- honesty -->\n" + "\n".join(lines) + "\n<!-- end -->" + after)


def main():
    os.makedirs(FOLDER, exist_ok=True)
    image = os.path.join(FOLDER, "image.exr")
    only = os.environ.get("ONLY", "").split(",")
    chosen = [name for name in SCENES if any(part in name for part in only)]
    looked = {name: Found.before(name) or study(name, image) for name in chosen}
    all_found = [found for found in (looked.get(name) or Found.before(name) for name in SCENES) if found]
    met = [verdict("%s: intervals that hold the error" % found.name, found.share(), 0.90, "more")
           for found in all_found]
    every = statistics.mean(found.share() for found in all_found)
    met.append(verdict("of all scenes: more would tell of intervals that are too wide", every, 0.99, "less"))
    ended = [e for found in all_found for e in found.ended]
    met.append(verdict("share of --error 2% that ends in 1 to 2.2 %", at_error(ended), 0.9, "more"))
    misses = [abs(m) for found in all_found for m in found.misses]
    met.append(verdict("--time: largest miss over what is allowed", max(misses), 1.0, "less"))
    write(all_found, [name for name in SCENES if name not in [found.name for found in all_found]])
    sys.exit(not all(met))


if __name__ == "__main__":
    main()
