#!/usr/bin/env python3
"""Terrarium against Mitsuba 3, scene by scene: mean radiance, and a z-test block by block.

Every scene is written twice by hand, from the same numbers: for Terrarium (crosscheck_scenes.py has its own, and there
are the proofs, scenes/proofs/*.ron), and as a Mitsuba dictionary. Both programs render it with several seeds; what the
seeds differ by is the error of each block's mean. Writes docs/crosscheck.md. Needs `pip install mitsuba numpy`; without
them it says so and does nothing. Names of scenes or proofs as arguments: only those, block by block, and no page.
"""

import os
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass

try:
    import mitsuba as mi
    import numpy as np
except ImportError as error:
    print(f"make crosscheck: skipped: {error} (pip install mitsuba numpy)")
    sys.exit(0)

import crosscheck_proofs as proofs
import crosscheck_scenes as scenes

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
PROGRAM = os.environ.get("TERRARIUM", os.path.join(ROOT, "target/release/terrarium"))

BLOCK, SEEDS = 8, range(1, 7)
# The largest difference of the picture's mean, and of a block's beyond its noise, as shares. Photons blur. Patterns are
# averaged over the footprint of a ray, across which light changes: 0.019 % was the most of any block of the chequered
# plane, with so many samples that noise was less, and 0.004 % with footprints of an eighth.
MEAN_LIMIT, BLOCK_SLACK, PATTERN_SLACK = 5e-3, 3e-3, 4e-4
# A block is off beyond so many standard errors; so many of them may be, and none beyond the last.
OFF, OFF_SHARE, WORST = 3.0, 0.05, 6.0


def ours(scene, folder, passes):
    image = os.path.join(folder, "image.exr")
    pictures = []
    for seed in SEEDS:
        done = subprocess.run([PROGRAM, "render", scene, "-o", image, "--seed", str(seed), "--passes", str(passes),
                               "--quiet", "--progress", "none"], stderr=subprocess.PIPE, text=True)
        if done.returncode != 0:
            sys.exit(f"{scene}: {done.stderr}")
        pictures.append(np.array(mi.Bitmap(image).convert(mi.Bitmap.PixelFormat.RGB, mi.Struct.Type.Float32, False)))
    return np.array(pictures, dtype=np.float64)


def theirs(description, samples, side):
    scene = mi.load_dict(description)
    pictures = [np.array(mi.render(scene, spp=samples, seed=seed)) for seed in SEEDS]
    return squares(np.array(pictures, np.float64), side)


def squares(pictures, n):
    """Means of n × n squares of each picture."""
    seeds, side = pictures.shape[:2]
    return pictures.reshape(seeds, n, side // n, n, side // n, 3).mean(axis=(2, 4))


def blocks_a_side(side):
    """Blocks have up to 8 × 8 pixels, and there are several of them, but of pictures of 2 × 2 pixels or one."""
    if side <= 2:
        return 1
    return side // max(n for n in range(1, BLOCK + 1) if side % n == 0 and n < side)


@dataclass
class Comparison:
    """`error` is the standard error of the means' relative difference; the others are by block."""
    mean_a: float
    mean_b: float
    error: float
    apart: np.ndarray
    z: np.ndarray

    @property
    def difference(self):
        return self.mean_a / self.mean_b - 1

    @property
    def beyond(self):
        return float((self.z > OFF).mean())

    @property
    def agrees(self):
        return abs(self.difference) <= MEAN_LIMIT and self.beyond <= OFF_SHARE and self.z.max() <= WORST


def compare(a, b, slack=BLOCK_SLACK):
    error2 = lambda x: x.var(axis=0, ddof=1) / len(SEEDS)
    all_a, all_b = a.mean(axis=(1, 2, 3)), b.mean(axis=(1, 2, 3))
    error = np.sqrt(error2(all_a) + error2(all_b)) / all_b.mean()
    n = blocks_a_side(a.shape[1])
    a, b = squares(a, n).mean(axis=3), squares(b, n).mean(axis=3)
    seen = b.mean(axis=0)
    off = a.mean(axis=0) - seen
    # Of so few seeds, a block's own error is known badly: never less than half of what lit blocks have on average.
    relative = (error2(a) + error2(b)) / np.maximum(seen, 1e-12) ** 2
    relative = np.maximum(relative, 0.25 * np.median(relative[seen > 0]))
    variance = np.where(seen > 0, relative * seen**2, error2(a) + error2(b))
    z = np.maximum(np.abs(off) - slack * seen, 0) / np.sqrt(np.maximum(variance, 1e-24))
    return Comparison(all_a.mean(), all_b.mean(), error, off / np.maximum(seen, 1e-12), z)


def percent(share):
    return f"{100 * share:+.3f} %"


def scene_rows(wanted, folder):
    """(name, row, comparison) of every scene."""
    scenes.sky_image(folder)
    for make in scenes.SCENES:
        if wanted and make.__name__ not in wanted:
            continue
        name, text, description, (passes, samples) = make(folder) if make.__code__.co_argcount else make()
        scene = os.path.join(folder, "scene.ron")
        with open(scene, "w", encoding="utf-8") as file:
            file.write(text)
        slack = PATTERN_SLACK if make is scenes.textured else BLOCK_SLACK
        found = compare(ours(scene, folder, passes), theirs(description, samples, scenes.SIDE), slack)
        light = "direct" if description["integrator"]["max_depth"] == 2 else "all"
        yield name, (f"| {name} | {light} | {found.mean_a:.5f} | {found.mean_b:.5f} | {percent(found.difference)} "
                     f"| {100 * found.error:.3f} % | {found.z.max():.1f} | {100 * found.beyond:.1f} % "
                     f"| {verdict(found)} |"), found


def proof_rows(wanted, folder):
    for name, proof in sorted(proofs.PROOFS.items()):
        if wanted and name not in wanted:
            continue
        what, answer = proofs.claim(name)
        a = ours(proofs.path_of(name), folder, proof.passes)
        found = compare(a, theirs(proof.describe(), proof.samples, a.shape[1]))
        yield name, (f"| [{name}](../scenes/proofs/{name}.ron) | {what} | {answer:.7g} "
                     f"| {found.mean_a:.7f} | {percent(found.mean_a / answer - 1)} "
                     f"| {found.mean_b:.7f} | {percent(found.mean_b / answer - 1)} "
                     f"| {percent(found.difference)} | {100 * found.error:.3f} % | {found.z.max():.1f} "
                     f"| {verdict(found)} |"), found


def verdict(found):
    return "agrees" if found.agrees else "**differs**"


def table(rows, wanted):
    """The table's lines, and the names of those that differ."""
    lines, wrong = [], []
    began = time.time()
    for name, line, found in rows:
        print(f"{line} {time.time() - began:.0f} s", flush=True)
        began = time.time()
        lines.append(line)
        if not found.agrees:
            wrong.append(name)
        if wanted:
            np.set_printoptions(precision=5, suppress=True, linewidth=150)
            print(found.apart)
    return "\n".join(lines), wrong


PAGE = """# Another implementation agrees

Scenes that Mitsuba 3 can express too, written twice by hand from the same numbers, and rendered by both programs.
`make crosscheck` writes this page; it needs `pip install mitsuba numpy`.

Each picture is rendered with {seeds} seeds by both (Mitsuba {version}, `{variant}`). The means must agree within \
{limit:.1f} %. Means of blocks of {block} × {block} pixels are compared by their z: what they differ by beyond \
{slack:.1f} % (photons blur; {pattern:.2f} % for the chequered plane, as patterns are averaged over the footprint of a \
ray) over the standard error that the seeds tell. No more than {share:.0f} % of the blocks may be beyond \
z = {off:.0f} and none beyond {worst:.0f}.

## Scenes

Pictures of {side} × {side} pixels. "Direct" light is one bounce; "all" is light of any number of bounces.

| scene | light | mean | Mitsuba's | difference | ± | largest z | blocks beyond {off:.0f} | |
|---|---|---|---|---|---|---|---|---|
{scenes}

## Proofs

Small scenes whose answer is derived on paper, in [scenes/proofs](../scenes/proofs). "Off" is off that answer. \
Pictures of 12 × 12 pixels have blocks of 6 × 6; those of 2 × 2 and of one pixel are one block.

| proof | what | answer | mean | off | Mitsuba's | off | difference | ± | largest z | |
|---|---|---|---|---|---|---|---|---|---|---|
{proofs}

Mitsuba can express all {count} of them. Where its scene is not the same word for word:

{notes}

{verdict}
"""


def main():
    wanted = sys.argv[1:]
    mistakes = proofs.mistakes()
    if mistakes:
        sys.exit("make crosscheck: " + "\n".join(mistakes))
    # Else bars of progress, which no level of the log turns off.
    mi.logger().clear_appenders()
    with tempfile.TemporaryDirectory() as folder:
        scene_table, wrong = table(scene_rows(wanted, folder), wanted)
        proof_table, wrong_proofs = table(proof_rows(wanted, folder), wanted)
    wrong += wrong_proofs
    if not wanted:
        write(scene_table, proof_table, "All agree." if not wrong else "They differ in: " + "; ".join(wrong) + ".")
    sys.exit(1 if wrong else 0)


def write(scene_table, proof_table, verdict):
    notes = [f"- {name}: {proof.note}" for name, proof in sorted(proofs.PROOFS.items()) if proof.note]
    page = PAGE.format(seeds=len(SEEDS), version=mi.__version__, variant=mi.variant(), limit=100 * MEAN_LIMIT,
                       block=BLOCK, slack=100 * BLOCK_SLACK, pattern=100 * PATTERN_SLACK, share=100 * OFF_SHARE,
                       off=OFF, worst=WORST, side=scenes.SIDE, scenes=scene_table, proofs=proof_table,
                       count=len(proofs.PROOFS), notes="\n".join(notes), verdict=verdict)
    with open(os.path.join(ROOT, "docs/crosscheck.md"), "w", encoding="utf-8") as file:
        file.write(page)
    print(f"wrote docs/crosscheck.md: {verdict}")


if __name__ == "__main__":
    main()
