#!/usr/bin/env python3
"""Terrarium against Mitsuba 3, scene by scene: mean radiance, and a z-test block by block.

Every scene is written twice by hand, from the same numbers: in RON, and as a Mitsuba dictionary. Both programs
render it with several seeds; what the seeds differ by is the error of each block's mean. Writes
docs/crosscheck.md. Needs `pip install mitsuba numpy`; without them it says so and does nothing.
"""

import os
import subprocess
import sys
import tempfile
import time

try:
    import mitsuba as mi
    import numpy as np
except ImportError as error:
    print(f"make crosscheck: skipped: {error} (pip install mitsuba numpy)")
    sys.exit(0)

mi.set_variant("scalar_rgb")
T = mi.ScalarTransform4f
ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
PROGRAM = os.environ.get("TERRARIUM", os.path.join(ROOT, "target/release/terrarium"))

SIDE, BLOCK, SEEDS = 64, 8, 6
# The largest difference of the picture's mean, and of a block's beyond its noise, as shares. Patterns are averaged
# over the footprint of a ray, which takes light across the edges of blocks.
MEAN_LIMIT, BLOCK_SLACK, PATTERN_SLACK = 5e-3, 3e-3, 5e-2
# A block is off beyond so many standard errors; so many of them may be, and none beyond the last.
OFF, OFF_SHARE, WORST = 3.0, 0.05, 6.0


def grey(value):
    return {"type": "rgb", "value": [value] * 3 if isinstance(value, (int, float)) else list(value)}


def matt(value):
    return {"type": "twosided", "bsdf": {"type": "diffuse", "reflectance": grey(value)}}


def floor(size, bsdf):
    """The quad of `size` on y = 0, u along +x and v along -z."""
    return {"type": "rectangle", "to_world": T().rotate([1, 0, 0], -90).scale([size / 2, size / 2, 1]), "bsdf": bsdf}


def quad_light(corner, u, v, radiance):
    """Shines to the side of u × v; its back is black."""
    corner, u, v = map(np.array, (corner, u, v))
    n = np.cross(u, v) / np.linalg.norm(np.cross(u, v))
    matrix = np.eye(4)
    matrix[:3, 0], matrix[:3, 1], matrix[:3, 2], matrix[:3, 3] = u / 2, v / 2, n, corner + (u + v) / 2
    return {
        "type": "rectangle",
        "to_world": T(matrix),
        "bsdf": {"type": "diffuse", "reflectance": grey(0)},
        "emitter": {"type": "area", "radiance": grey(radiance)},
    }


def picture(eye, target, fov, depth, **parts):
    """A Mitsuba scene; `depth` 2 is direct light alone, -1 all of it."""
    return {
        "type": "scene",
        "integrator": {"type": "path", "max_depth": depth, "rr_depth": 12},
        "sensor": {
            "type": "perspective",
            "fov": fov,
            "to_world": T().look_at(origin=list(eye), target=list(target), up=[0, 1, 0]),
            "film": {"type": "hdrfilm", "width": SIDE, "height": SIDE, "pixel_format": "rgb",
                     "component_format": "float32", "rfilter": {"type": "box"}},
            "sampler": {"type": "independent"},
        },
        **parts,
    }


def ron(eye, target, fov, rest):
    return (f"(camera: (eye: {tuple(eye)}, target: {tuple(target)}, fov_deg: {fov}), "
            f"image: (width: {SIDE}, height: {SIDE}), {rest})")


VIEW = ((0.5, 2.5, 5), (0, 0.5, 0), 40)
ALL_LIGHT = "indirect: true, indirect_by: paths,"
CAUSTICS = "photons: progressive(count: 20000),"


def ball(bsdf, radius=0.8):
    return {"type": "sphere", "center": [0, radius, 0], "radius": radius, "bsdf": bsdf}


def point():
    lamp = {"type": "point", "position": [2, 4, 2], "intensity": grey((30, 20, 10))}
    return ("a matt ball on a floor under a point light", ron(*VIEW, """
        materials: { "floor": (diffuse: 0.6), "ball": (diffuse: (0.3, 0.5, 0.8)) },
        lights: { "lamp": point(position: (2, 4, 2), intensity: (30, 20, 10)) },
        objects: [(shape: quad(size: (8, 8)), material: "floor"),
            (shape: sphere(radius: 0.8, center: (0, 0.8, 0)), material: "ball")]"""),
        picture(*VIEW, 2, floor=floor(8, matt(0.6)), ball=ball(matt((0.3, 0.5, 0.8))), lamp=lamp), (64, 64))


def soft_shadow():
    box = {"type": "cube", "bsdf": matt(0.7),
           "to_world": T().translate([0, 0.6, 0]).rotate([0, 1, 0], 30).scale([0.5, 0.6, 0.4])}
    lamp = quad_light((-1, 4, -1), (2, 0, 0), (0, 0, 2), (12, 10, 8))
    return ("a box under a square light: soft shadows", ron(*VIEW, """
        materials: { "floor": (diffuse: 0.6), "box": (diffuse: 0.7) },
        lights: { "lamp": quad(corner: (-1, 4, -1), edge_u: (2, 0, 0), edge_v: (0, 0, 2), radiance: (12, 10, 8)) },
        objects: [(shape: quad(size: (8, 8)), material: "floor"),
            (shape: box(size: (1, 1.2, 0.8), center: (0, 0, 0)), material: "box",
             transform: [rotate(axis: (0, 1, 0), deg: 30), translate((0, 0.6, 0))])]"""),
        picture(*VIEW, 2, floor=floor(8, matt(0.6)), box=box, lamp=lamp), (128, 256))


def directional():
    tube = {"type": "cylinder", "p0": [0, 0, 0], "p1": [0, 1.2, 0], "radius": 0.6, "bsdf": matt(0.8)}
    disc = {"type": "disk", "bsdf": matt((0.9, 0.4, 0.2)),
            "to_world": T().translate([1.2, 0.8, 0.5]).rotate([1, 0, 0], -60).scale(0.5)}
    sun = {"type": "directional", "direction": [-0.5, -1, -0.4], "irradiance": grey(2)}
    return ("an open cylinder and a disk under parallel light", ron(*VIEW, """
        materials: { "floor": (diffuse: 0.6), "tube": (diffuse: 0.8), "disc": (diffuse: (0.9, 0.4, 0.2)) },
        lights: { "sun": directional(direction: (-0.5, -1, -0.4), irradiance: 2) },
        objects: [(shape: quad(size: (8, 8)), material: "floor"),
            (shape: cylinder(radius: 0.6, height: 1.2, caps: false), material: "tube"),
            (shape: disk(radius: 0.5), material: "disc",
             transform: [rotate(axis: (1, 0, 0), deg: 30), translate((1.2, 0.8, 0.5))])]"""),
        picture(*VIEW, 2, floor=floor(8, matt(0.6)), tube=tube, disc=disc, sun=sun), (64, 64))


def textured():
    checks = {"type": "checkerboard", "color0": grey((0.8, 0.7, 0.6)), "color1": grey(0.1),
              "to_uv": T().scale([3.5, 3.5, 1])}
    bsdf = {"type": "diffuse", "reflectance": checks}
    lamp = {"type": "point", "position": [-1, 3, 1], "intensity": grey(20)}
    return ("a chequered plane under a point light", ron(*VIEW, """
        textures: { "checks": checker(a: (0.8, 0.7, 0.6), b: 0.1, squares: (7, 7)) },
        materials: { "floor": (diffuse: texture("checks")) },
        lights: { "lamp": point(position: (-1, 3, 1), intensity: 20) },
        objects: [(shape: quad(size: (6, 6)), material: "floor")]"""),
        picture(*VIEW, 2, floor=floor(6, bsdf), lamp=lamp), (64, 128))


def sky_image(folder):
    """A smooth sky with a sun that is wide, as both programs read images of it."""
    w, h = 256, 128

    def save(name, row, first):
        column, row = np.meshgrid((np.arange(w) + 0.5) / w, row)
        mi.Bitmap(sky(2 * np.pi * (column - first), np.pi * row)).write(os.path.join(folder, name))

    save("sky.exr", (np.arange(h) + 0.5) / h, 0.5)
    # Mitsuba begins with the column that looks along -z, and its first and last rows are the poles themselves.
    save("sky-mitsuba.exr", np.arange(h) / (h - 1), 0)


def sky(azimuth, polar):
    d = np.stack([np.sin(azimuth) * np.sin(polar), np.cos(polar), -np.cos(azimuth) * np.sin(polar)], -1)
    sun = np.array([0.6, 0.6, 0.53])
    glow = np.exp(20 * (d @ (sun / np.linalg.norm(sun)) - 1))
    rgb = 0.2 + 0.3 * (d[..., 1:2] + 1) * np.array([0.5, 0.7, 1.0]) + 6 * glow[..., None] * np.array([1.0, 0.9, 0.7])
    return np.ascontiguousarray(rgb.astype(np.float32))


def sky_light(folder):
    sky = {"type": "envmap", "filename": os.path.join(folder, "sky-mitsuba.exr")}
    return ("a matt ball on a floor under an image of the sky", ron(*VIEW, """
        materials: { "floor": (diffuse: 0.5), "ball": (diffuse: 0.8) },
        lights: { "sky": environment(map: image(path: "sky.exr")) },
        objects: [(shape: quad(size: (3, 3)), material: "floor"),
            (shape: sphere(radius: 0.8, center: (0, 0.8, 0)), material: "ball")]"""),
        picture(*VIEW, 2, floor=floor(3, matt(0.5)), ball=ball(matt(0.8)), sky=sky), (96, 192))


def mirror(folder):
    steel = {"type": "conductor", "material": "none", "specular_reflectance": grey((0.9, 0.8, 0.7))}
    sky = {"type": "envmap", "filename": os.path.join(folder, "sky-mitsuba.exr")}
    return ("a mirror ball on a floor under the sky: reflection, caustic, indirect light", ron(*VIEW, f"""{ALL_LIGHT} {CAUSTICS}
        materials: {{ "floor": (diffuse: 0.5), "steel": (reflection: (0.9, 0.8, 0.7)) }},
        lights: {{ "sky": environment(map: image(path: "sky.exr")) }},
        objects: [(shape: quad(size: (3, 3)), material: "floor"),
            (shape: sphere(radius: 0.8, center: (0, 0.8, 0)), material: "steel")]"""),
        picture(*VIEW, -1, floor=floor(3, matt(0.5)), ball=ball(steel), sky=sky), (64, 256))


def glass(folder):
    clear = {"type": "dielectric", "int_ior": 1.5, "ext_ior": 1.0}
    sky = {"type": "envmap", "filename": os.path.join(folder, "sky-mitsuba.exr")}
    return ("a glass ball on a floor under the sky: refraction, caustic, indirect light", ron(*VIEW, f"""{ALL_LIGHT} {CAUSTICS}
        materials: {{ "floor": (diffuse: 0.5), "glass": (transmission: 1, ior: 1.5) }},
        lights: {{ "sky": environment(map: image(path: "sky.exr")) }},
        objects: [(shape: quad(size: (3, 3)), material: "floor"),
            (shape: sphere(radius: 0.8, center: (0, 0.9, 0)), material: "glass")]"""),
        picture(*VIEW, -1, floor=floor(3, matt(0.5)), sky=sky,
                ball={"type": "sphere", "center": [0, 0.9, 0], "radius": 0.8, "bsdf": clear}), (64, 384))


def cornell():
    view = ((0, 1, 3.4), (0, 1, 0), 39)

    def wall(turn, axis, place, colour):
        rotated = T().translate(place).rotate(axis, turn)
        return {"type": "rectangle", "to_world": rotated, "bsdf": matt(colour)}

    red, green, white = (0.63, 0.06, 0.05), (0.14, 0.45, 0.09), 0.73
    lamp = quad_light((-0.3, 1.98, -0.3), (0.6, 0, 0), (0, 0, 0.6), (17, 12, 4))
    low = {"type": "cube", "bsdf": matt(white),
           "to_world": T().translate([0.35, 0.3, 0.35]).rotate([0, 1, 0], -17).scale(0.3)}
    high = {"type": "cube", "bsdf": matt(white),
            "to_world": T().translate([-0.35, 0.6, -0.3]).rotate([0, 1, 0], 18).scale([0.3, 0.6, 0.3])}
    walls = {
        "floor": wall(-90, [1, 0, 0], [0, 0, 0], white),
        "ceiling": wall(90, [1, 0, 0], [0, 2, 0], white),
        "back": wall(0, [1, 0, 0], [0, 1, -1], white),
        "left": wall(90, [0, 1, 0], [-1, 1, 0], red),
        "right": wall(-90, [0, 1, 0], [1, 1, 0], green),
    }
    side = '(shape: quad(size: (2, 2)), material: "{}", transform: [rotate(axis: {}, deg: {}), translate({})])'
    sides = ", ".join(side.format(*each) for each in [
        ("white", "(1, 0, 0)", 0, "(0, 0, 0)"),
        ("white", "(1, 0, 0)", 180, "(0, 2, 0)"),
        ("white", "(1, 0, 0)", 90, "(0, 1, -1)"),
        ("red", "(0, 0, 1)", -90, "(-1, 1, 0)"),
        ("green", "(0, 0, 1)", 90, "(1, 1, 0)"),
    ])
    return ("a Cornell box with two blocks: all indirect light", ron(*view, f"""{ALL_LIGHT}
        materials: {{ "white": (diffuse: 0.73), "red": (diffuse: {red}), "green": (diffuse: {green}) }},
        lights: {{ "lamp": quad(corner: (-0.3, 1.98, -0.3), edge_u: (0.6, 0, 0), edge_v: (0, 0, 0.6), radiance: (17, 12, 4)) }},
        objects: [{sides},
            (shape: box(size: (0.6, 0.6, 0.6), center: (0, 0, 0)), material: "white",
             transform: [rotate(axis: (0, 1, 0), deg: -17), translate((0.35, 0.3, 0.35))]),
            (shape: box(size: (0.6, 1.2, 0.6), center: (0, 0, 0)), material: "white",
             transform: [rotate(axis: (0, 1, 0), deg: 18), translate((-0.35, 0.6, -0.3))])]"""),
        picture(*view, -1, lamp=lamp, low=low, high=high, **walls), (64, 192))


def ours(text, folder, passes):
    scene, image = os.path.join(folder, "scene.ron"), os.path.join(folder, "image.exr")
    with open(scene, "w") as file:
        file.write(text)
    pictures = []
    for seed in range(1, SEEDS + 1):
        subprocess.run([PROGRAM, "render", scene, "-o", image, "--seed", str(seed), "--passes", str(passes),
                        "--quiet", "--progress", "none"], check=True)
        pictures.append(np.array(mi.Bitmap(image).convert(mi.Bitmap.PixelFormat.RGB, mi.Struct.Type.Float32, False)))
    return np.array(pictures, dtype=np.float64)


def theirs(description, samples):
    scene = mi.load_dict(description)
    return np.array([np.array(mi.render(scene, spp=samples, seed=seed)) for seed in range(1, SEEDS + 1)], np.float64)


def blocks(pictures):
    """Means of square blocks, channels averaged, by seed."""
    n = SIDE // BLOCK
    return pictures.reshape(SEEDS, n, BLOCK, n, BLOCK, 3).mean(axis=(2, 4, 5)).reshape(SEEDS, -1)


def compare(a, b, slack):
    """The means, the relative difference with its standard error, and z of every block."""
    error2 = lambda x: x.var(axis=0, ddof=1) / SEEDS
    all_a, all_b = a.mean(axis=(1, 2, 3)), b.mean(axis=(1, 2, 3))
    mean_a, mean_b = all_a.mean(), all_b.mean()
    error = np.sqrt(error2(all_a) + error2(all_b)) / mean_b
    a, b = blocks(a), blocks(b)
    off = np.abs(a.mean(axis=0) - b.mean(axis=0))
    # Of so few seeds, a block's own error is known badly: never less than half of what blocks have on average.
    squares = (error2(a) + error2(b)) / np.maximum(b.mean(axis=0), 1e-12) ** 2
    squares = np.maximum(squares, 0.25 * np.median(squares)) * b.mean(axis=0) ** 2
    z = np.maximum(off - slack * b.mean(axis=0), 0) / np.sqrt(np.maximum(squares, 1e-24))
    return mean_a, mean_b, mean_a / mean_b - 1, error, z


PAGE = """# Another implementation agrees

Scenes that Mitsuba 3 can express too, written twice by hand from the same numbers, and rendered by both programs.
`make crosscheck` writes this page; it needs `pip install mitsuba numpy`.

Each picture has {side} × {side} pixels and is rendered with {seeds} seeds by both (Mitsuba {version}, `{variant}`, path tracing). The means must agree within {limit:.1f} %. Means of blocks of {block} × {block} pixels are compared by their z: what they differ by beyond {slack:.1f} % (photons blur; {pattern:.0f} % for the chequered plane, whose pattern is averaged over the footprint of a ray and so across the edges of blocks) over the standard error that the seeds tell. No more than {share:.0f} % of the blocks may be beyond z = {off:.0f} and none beyond {worst:.0f}. "Direct light" is one bounce; "all" is light of any number of bounces.

| scene | light | mean | Mitsuba's | difference | ± | largest z | blocks beyond {off:.0f} | |
|---|---|---|---|---|---|---|---|---|
{rows}

{verdict}
"""


def main():
    wanted = sys.argv[1:]
    rows, wrong = [], []
    with tempfile.TemporaryDirectory() as folder:
        sky_image(folder)
        makers = [point, soft_shadow, directional, textured, sky_light, mirror, glass, cornell]
        for make in makers:
            if wanted and make.__name__ not in wanted:
                continue
            name, text, description, (passes, samples) = make(folder) if make.__code__.co_argcount else make()
            began = time.time()
            a, b = ours(text, folder, passes), theirs(description, samples)
            mean_a, mean_b, difference, error, z = compare(a, b, PATTERN_SLACK if make is textured else BLOCK_SLACK)
            beyond = float((z > OFF).mean())
            good = abs(difference) <= MEAN_LIMIT and beyond <= OFF_SHARE and z.max() <= WORST
            light = "direct" if description["integrator"]["max_depth"] == 2 else "all"
            rows.append(f"| {name} | {light} | {mean_a:.5f} | {mean_b:.5f} | {100 * difference:+.3f} % | {100 * error:.3f} % "
                        f"| {z.max():.1f} | {100 * beyond:.1f} % | {'agrees' if good else '**differs**'} |")
            print(f"{rows[-1]} {time.time() - began:.0f} s", flush=True)
            if not good:
                wrong.append(name)
            if wanted:
                np.set_printoptions(precision=3, suppress=True, linewidth=150)
                n = SIDE // BLOCK
                seen = np.maximum(blocks(b).mean(axis=0), 1e-12)
                print((blocks(a).mean(axis=0) / seen - 1).reshape(n, n))
    if wanted:
        return
    verdict = "All agree." if not wrong else "They differ in: " + "; ".join(wrong) + "."
    page = PAGE.format(side=SIDE, seeds=SEEDS, version=mi.__version__, variant=mi.variant(), limit=100 * MEAN_LIMIT,
                       block=BLOCK, slack=100 * BLOCK_SLACK, pattern=100 * PATTERN_SLACK, share=100 * OFF_SHARE, off=OFF, worst=WORST,
                       rows="\n".join(rows), verdict=verdict)
    with open(os.path.join(ROOT, "docs/crosscheck.md"), "w") as file:
        file.write(page)
    print(f"wrote docs/crosscheck.md: {verdict}")
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()
