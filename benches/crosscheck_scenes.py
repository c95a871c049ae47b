"""The scenes of `make crosscheck` that are not proofs.

Each is written twice by hand from the same numbers, in RON and as a Mitsuba dictionary, and makes its name, these two,
and Terrarium's passes and Mitsuba's samples of each seed.
"""

import os

import mitsuba as mi
import numpy as np

from crosscheck_parts import SIDE, T, box, clear, floor, grey, matt, mirror_of, picture, quad_light, sun


def ron(eye, target, fov, rest, up=(0, 1, 0)):
    return (f"(camera: (eye: {eye}, target: {target}, up: {up}, fov_deg: {fov}), "
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
    block = box((1, 1.2, 0.8), (0, 0.6, 0), turn=30, bsdf=matt(0.7))
    lamp = quad_light((-1, 4, -1), (2, 0, 0), (0, 0, 2), (12, 10, 8))
    return ("a box under a square light: soft shadows", ron(*VIEW, """
        materials: { "floor": (diffuse: 0.6), "box": (diffuse: 0.7) },
        lights: { "lamp": quad(corner: (-1, 4, -1), edge_u: (2, 0, 0), edge_v: (0, 0, 2), radiance: (12, 10, 8)) },
        objects: [(shape: quad(size: (8, 8)), material: "floor"),
            (shape: box(size: (1, 1.2, 0.8), center: (0, 0, 0)), material: "box",
             transform: [rotate(axis: (0, 1, 0), deg: 30), translate((0, 0.6, 0))])]"""),
        picture(*VIEW, 2, floor=floor(8, matt(0.6)), box=block, lamp=lamp), (128, 256))


def directional():
    tube = {"type": "cylinder", "p0": [0, 0, 0], "p1": [0, 1.2, 0], "radius": 0.6, "bsdf": matt(0.8)}
    disc = {"type": "disk", "bsdf": matt((0.9, 0.4, 0.2)),
            "to_world": T().translate([1.2, 0.8, 0.5]).rotate([1, 0, 0], -60).scale(0.5)}
    return ("an open cylinder and a disk under parallel light", ron(*VIEW, """
        materials: { "floor": (diffuse: 0.6), "tube": (diffuse: 0.8), "disc": (diffuse: (0.9, 0.4, 0.2)) },
        lights: { "sun": directional(direction: (-0.5, -1, -0.4), irradiance: 2) },
        objects: [(shape: quad(size: (8, 8)), material: "floor"),
            (shape: cylinder(radius: 0.6, height: 1.2, caps: false), material: "tube"),
            (shape: disk(radius: 0.5), material: "disc",
             transform: [rotate(axis: (1, 0, 0), deg: 30), translate((1.2, 0.8, 0.5))])]"""),
        picture(*VIEW, 2, floor=floor(8, matt(0.6)), tube=tube, disc=disc,
                sun=sun((-0.5, -1, -0.4), 2)), (64, 64))


def textured():
    """From right above, 4 m wide: squares of 16 pixels, whose edges lie 4 pixels off those of blocks.

    Patterns are averaged over the footprint of a ray, about a pixel, which so takes no light from one block to another.
    """
    view = ((0.25, 4, 0.25), (0.25, 0, 0.25), 53.13010235415598)
    checks = {"type": "checkerboard", "color0": grey((0.8, 0.7, 0.6)), "color1": grey(0.1),
              "to_uv": T().scale([3.5, 3.5, 1])}
    bsdf = {"type": "diffuse", "reflectance": checks}
    lamp = {"type": "point", "position": [-1, 3, 1], "intensity": grey(20)}
    return ("a chequered plane under a point light", ron(*view, """
        textures: { "checks": checker(a: (0.8, 0.7, 0.6), b: 0.1, squares: (7, 7)) },
        materials: { "floor": (diffuse: texture("checks")) },
        lights: { "lamp": point(position: (-1, 3, 1), intensity: 20) },
        objects: [(shape: quad(size: (7, 7)), material: "floor")]""", up=(0, 0, -1)),
        picture(*view, 2, up=(0, 0, -1), floor=floor(7, bsdf), lamp=lamp), (64, 128))


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


def sky_of(folder):
    return {"type": "envmap", "filename": os.path.join(folder, "sky-mitsuba.exr")}


def sky_light(folder):
    return ("a matt ball on a floor under an image of the sky", ron(*VIEW, """
        materials: { "floor": (diffuse: 0.5), "ball": (diffuse: 0.8) },
        lights: { "sky": environment(map: image(path: "sky.exr")) },
        objects: [(shape: quad(size: (3, 3)), material: "floor"),
            (shape: sphere(radius: 0.8, center: (0, 0.8, 0)), material: "ball")]"""),
        picture(*VIEW, 2, floor=floor(3, matt(0.5)), ball=ball(matt(0.8)), sky=sky_of(folder)), (96, 192))


def mirror(folder):
    return ("a mirror ball on a floor under the sky: reflection, caustic, indirect light", ron(*VIEW, f"""
        {ALL_LIGHT} {CAUSTICS}
        materials: {{ "floor": (diffuse: 0.5), "steel": (reflection: (0.9, 0.8, 0.7)) }},
        lights: {{ "sky": environment(map: image(path: "sky.exr")) }},
        objects: [(shape: quad(size: (3, 3)), material: "floor"),
            (shape: sphere(radius: 0.8, center: (0, 0.8, 0)), material: "steel")]"""),
        picture(*VIEW, -1, floor=floor(3, matt(0.5)), ball=ball(mirror_of((0.9, 0.8, 0.7))), sky=sky_of(folder)),
        (64, 256))


def glass(folder):
    return ("a glass ball on a floor under the sky: refraction, caustic, indirect light", ron(*VIEW, f"""
        {ALL_LIGHT} {CAUSTICS}
        materials: {{ "floor": (diffuse: 0.5), "glass": (transmission: 1, ior: 1.5) }},
        lights: {{ "sky": environment(map: image(path: "sky.exr")) }},
        objects: [(shape: quad(size: (3, 3)), material: "floor"),
            (shape: sphere(radius: 0.8, center: (0, 0.9, 0)), material: "glass")]"""),
        picture(*VIEW, -1, floor=floor(3, matt(0.5)), sky=sky_of(folder),
                ball={"type": "sphere", "center": [0, 0.9, 0], "radius": 0.8, "bsdf": clear(1.5)}), (64, 384))


def cornell():
    view = ((0, 1, 3.4), (0, 1, 0), 39)

    def wall(turn, axis, place, colour):
        rotated = T().translate(place).rotate(axis, turn)
        return {"type": "rectangle", "to_world": rotated, "bsdf": matt(colour)}

    red, green, white = (0.63, 0.06, 0.05), (0.14, 0.45, 0.09), 0.73
    lamp = quad_light((-0.3, 1.98, -0.3), (0.6, 0, 0), (0, 0, 0.6), (17, 12, 4))
    low = box((0.6, 0.6, 0.6), (0.35, 0.3, 0.35), turn=-17, bsdf=matt(white))
    high = box((0.6, 1.2, 0.6), (-0.35, 0.6, -0.3), turn=18, bsdf=matt(white))
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
        lights: {{ "lamp": quad(corner: (-0.3, 1.98, -0.3), edge_u: (0.6, 0, 0), edge_v: (0, 0, 0.6),
            radiance: (17, 12, 4)) }},
        objects: [{sides},
            (shape: box(size: (0.6, 0.6, 0.6), center: (0, 0, 0)), material: "white",
             transform: [rotate(axis: (0, 1, 0), deg: -17), translate((0.35, 0.3, 0.35))]),
            (shape: box(size: (0.6, 1.2, 0.6), center: (0, 0, 0)), material: "white",
             transform: [rotate(axis: (0, 1, 0), deg: 18), translate((-0.35, 0.6, -0.3))])]"""),
        picture(*view, -1, lamp=lamp, low=low, high=high, **walls), (64, 192))


SCENES = [point, soft_shadow, directional, textured, sky_light, mirror, glass, cornell]
