"""Whether renders tell the truth about their error: `make honesty`.

Five scenes, each at several numbers of passes and with many seeds: the stated error and its interval beside
the true error, against a reference of many more passes and another seed (made once, kept in target/honesty), whose own noise is taken off.
Then renders that end at an error, and at a time. Ends with 1 where a goal is missed.

SEEDS=20, SIDE=128 (pixels of the longer side), REFERENCE=4000 (passes), ONLY=scene name.
"""

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
FOLDER = os.path.join(ROOT, "target", "honesty")
SCENES = ["yardstick/caustic-sphere.ron", "yardstick/cornell-glass.ron", "gallery/tumbler.ron", "gallery/reflection.ron",
          "gallery/still_life.toml"]
PASSES = [4, 8, 16, 64]
TARGET = 0.02


def run(*arguments):
    return subprocess.run([TERRARIUM, *arguments], capture_output=True, text=True)


def small(scene):
    """Overrides that make the longer side of a scene SIDE pixels."""
    plan = json.loads(run("plan", scene, "--json", "--quiet", "--passes", "1").stdout)
    longer = max(plan["width"], plan["height"])
    side = lambda n: str(max(n * SIDE // longer, 1))  # noqa: E731
    return ["--set", "image.width=" + side(plan["width"]), "--set", "image.height=" + side(plan["height"])]


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
    """An image, and the noise that it states of itself."""
    name = os.path.basename(scene).split(".")[0]
    image = os.path.join(FOLDER, "%s-%d-%d.exr" % (name, SIDE, REFERENCE))
    kept = image + ".json"
    if not os.path.exists(image) or not os.path.exists(kept):
        stated = render(scene, image, *size, "--passes", str(REFERENCE), "--seed", "1000")["accuracy"]
        with open(kept, "w", encoding="utf-8") as out:
            json.dump(stated, out)
    with open(kept, encoding="utf-8") as stated:
        return image, json.load(stated)["noise"]


def main():
    os.makedirs(FOLDER, exist_ok=True)
    image = os.path.join(FOLDER, "image.exr")
    only = os.environ.get("ONLY")
    shares, ended, ratios = {}, [], []
    for name in [s for s in SCENES if not only or only in s]:
        scene = os.path.join(ROOT, "scenes", name)
        size = small(scene)
        truth = reference(scene, size)
        print("%s, %d seeds: true and stated error" % (name, SEEDS))
        held = runs = 0
        for passes in PASSES:
            rows = []
            for seed in range(SEEDS):
                stated = render(scene, image, *size, "--passes", str(passes), "--seed", str(seed))["accuracy"]
                rows.append((error(image, truth), stated))
            within = sum(s["interval"][0] <= e <= s["interval"][1] for e, s in rows)
            held, runs = held + within, runs + len(rows)
            true, said = statistics.mean(e for e, _ in rows), statistics.mean(s["error"] for _, s in rows)
            bias = statistics.mean(s["bias"] for _, s in rows)
            wide = statistics.median(s["interval"][1] / s["interval"][0] for _, s in rows)
            print("  %4d passes  true %7.3f %%  stated %7.3f %% (bias %6.3f %%), upper end over lower %5.2f  held %2d of %d" % (
                passes, 100 * true, 100 * said, 100 * bias, wide, within, len(rows)), flush=True)
        shares[name] = held / runs
        for seed in range(SEEDS):
            render(scene, image, *size, "--error", str(TARGET), "--passes", "100000", "--seed", str(seed))
            ended.append(error(image, truth))
        for seconds in (1, 3):
            began = time.perf_counter()
            render(scene, image, *size, "--time", "%ds" % seconds)
            ratios.append((time.perf_counter() - began - seconds) / max(0.5, 0.03 * seconds))
    met = [verdict("%s: intervals that hold the error" % name, share, 0.90, "more") for name, share in shares.items()]
    every = statistics.mean(shares.values())
    met.append(verdict("of all scenes: more would tell of intervals that are too wide", every, 0.99, "less"))
    inside = sum(0.01 <= e <= 0.022 for e in ended) / len(ended)
    print("  --error 2%%: true errors %s" % " ".join("%.2f" % (100 * e) for e in ended))
    met.append(verdict("share of --error 2% that ends in 1 to 2.2 %", inside, 0.9, "more"))
    met.append(verdict("--time: largest miss over what is allowed", max(abs(r) for r in ratios), 1.0, "less"))
    sys.exit(not all(met))


main()
