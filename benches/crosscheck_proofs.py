"""The proofs, scenes/proofs/*.ron, as Mitsuba has them: written by hand from the same numbers.

Each copy knows the digest of the scene it was written from, so that a proof whose numbers change is refused and not
compared with what it was. Terrarium's `max_depth` counts events and Mitsuba's the segments between them: one more.
"""

import hashlib
import os
import re
from dataclasses import dataclass
from typing import Callable

import mitsuba as mi
import numpy as np

from crosscheck_parts import T, box, clear, diffuse, floor, glow, grey, matt, mirror_of, picture, quad_light, sun

FOLDER = os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), "scenes/proofs")
PROOFS = {}

SKY = {"type": "constant", "radiance": grey(1)}


@dataclass
class Proof:
    """`passes` are Terrarium's and `samples` Mitsuba's, of each seed; `note` says what the copy has otherwise."""
    digest: str
    passes: int
    samples: int
    describe: Callable

    @property
    def note(self):
        return " ".join((self.describe.__doc__ or "").split())


def proof(digest, passes, samples):
    def register(describe):
        PROOFS[describe.__name__.replace("_", "-")] = Proof(digest, passes, samples, describe)
        return describe
    return register


def path_of(name):
    return os.path.join(FOLDER, name + ".ron")


def read(name):
    with open(path_of(name), encoding="utf-8") as file:
        return file.read()


def claim(name):
    """What the proof shows, and its answer."""
    text = read(name)
    return (re.search(r"^// Proof for \w+: (.*)$", text, re.M)[1],
            float(re.search(r"^// Answer: mean (\S+) ± ", text, re.M)[1]))


def digest(text):
    """Of what the scene says: comments and layout do not count."""
    return hashlib.sha256(" ".join(re.sub(r"//.*", "", text).split()).encode()).hexdigest()[:12]


def mistakes():
    """Proofs without a copy, copies without a proof, and copies of what a proof no longer says."""
    here = "benches/crosscheck_proofs.py"
    there = {name[:-4] for name in os.listdir(FOLDER) if name.endswith(".ron")}
    found = [f"scenes/proofs/{name}.ron has no copy in {here}" for name in sorted(there - set(PROOFS))]
    found += [f"{here} has {name}, and there is no such proof" for name in sorted(set(PROOFS) - there)]
    for name in sorted(there & set(PROOFS)):
        now = digest(read(name))
        if now != PROOFS[name].digest:
            found.append(f"scenes/proofs/{name}.ron has changed: change its copy in {here}, and the digest to {now}")
    return found


def pixel(*view, **rest):
    """A picture of one pixel or few, of which Mitsuba makes 64 × 64: its sums, in single precision, so stay small."""
    return picture(*view, side=64, sampler="multijitter", **rest)


@proof("a7f7c2565997", 1, 256)
def brewster():
    return pixel((1.5, 1, 0), (0, 0, 0), 0.0001, 2, up=(0.1, 0.3, 0.5), sky=SKY,
                 glass=box((2, 0.2, 2), (0, -0.1, 0), bsdf=clear(1.5)))


@proof("6401b9f3e35b", 1, 1)
def ellipsoid():
    """The ellipsoid is Mitsuba's own shape for sets of them, since its spheres take no such scale."""
    numbers = {"centers": [0, 0, 0], "scales": [2, 1, 0.5], "quaternions": [0, 0, 0, 1]}
    shape = {"type": "ellipsoids", "extent": 1.0, "bsdf": diffuse(1),
             **{name: mi.TensorXf(values, (1, len(values))) for name, values in numbers.items()}}
    return pixel((3, 2, 7), (4 / 3, 1 / 3, 1 / 3), 0.0001, 2, ball=shape, sun=sun((-1, -2, -2), 3))


@proof("2e106692404b", 64, 64)
def eye_in_glass():
    return picture((0, 0, 0), (0, 0.2, 1), 60, 1001, side=24, roulette=1001, sky=SKY,
                   ball={"type": "sphere", "bsdf": clear(1.5)})


@proof("9fee46a5f591", 8192, 4)
def facing_mirrors():
    return picture((0, 0, 0), (1, 0.1, 0), 0.01, 1001, side=16, roulette=1001, sky=SKY,
                   right=box((1, 4, 4), (1.5, 0, 0), bsdf=mirror_of(0.5)),
                   left=box((1, 4, 4), (-1.5, 0, 0), bsdf=mirror_of(0.5)))


def turned(profile, sides, **surface):
    """A mesh: the line of points (radius, y), turned around the y axis. From below to above its outside is out."""
    radius, y = np.array(profile, float).T
    turn = 2 * np.pi * np.arange(sides) / sides
    points = [[r * np.sin(turn), np.full(sides, height), r * np.cos(turn)] for r, height in zip(radius, y)]
    ring, side = np.meshgrid(np.arange(len(y) - 1), np.arange(sides), indexing="ij")
    a, b = ring * sides + side, ring * sides + (side + 1) % sides
    lower, upper = np.stack([a, b, b + sides], -1), np.stack([a, b + sides, a + sides], -1)
    # On the axis triangles have no area.
    faces = np.concatenate([lower[radius[:-1] > 0], upper[radius[1:] > 0]])
    properties = mi.Properties()
    for name, part in surface.items():
        properties[name] = mi.load_dict(part)
    mesh = mi.Mesh("turned", sides * len(y), faces.size // 3, properties)
    parts = mi.traverse(mesh)
    parts["vertex_positions"], parts["faces"] = np.transpose(points, (0, 2, 1)).ravel(), faces.ravel()
    parts.update()
    return mesh


@proof("746610266d0a", 256, 64)
def glass_in_even_sky():
    """The cone is a mesh of 96 sides."""
    return picture((2, 1.5, 3), (0, 0, 0), 45, 1001, side=32, roulette=1001, sky=SKY,
                   ball={"type": "sphere", "bsdf": clear(1.5)}, box=box((1, 1, 1), bsdf=clear(1.333, 1.5)),
                   cone=turned([(0, -0.35), (0.4, -0.35), (0, 0.35)], 96, bsdf=clear(2.417, 1.333)))


@proof("6dd0ce130e08", 1, 1)
def glass_of_air():
    """Light of a direction does not pass Mitsuba's glass, whatever its index. Its thin glass lets it through, and of
    index 1 both bend nothing."""
    ball = {"type": "sphere", "center": [0, 0.8, 0], "radius": 0.5, "bsdf": {**clear(1.0), "type": "thindielectric"}}
    return picture((0, 3, 0), (0, 0, 0), 40, 2, up=(0, 0, -1), side=24, by="volpath",
                   floor=floor(20, matt(1)), ball=ball, sun=sun((0, -1, 0), 1))


def face(x, size, bsdf):
    """A square across the x axis, its outside towards −x."""
    place = T().translate([x, 0, 0]).rotate([0, 1, 0], -90).scale([size / 2, size / 2, 1])
    return {"type": "rectangle", "to_world": place, "bsdf": bsdf}


@proof("cb06bf290a5b", 1, 256)
def glass_on_water():
    """Glass and water are the two faces that so short a path can reach: the front of the glass, and the one that they
    share, which is one surface to Mitsuba."""
    return pixel((-5, 0, 0), (0, 0, 0), 0.001, 3, glass=face(-0.1, 9, clear(1.5)),
                 water=face(0, 9, clear(1.33, 1.5)), wall=box((0.1, 8, 8), (2, 0, 0), **glow(1)))


@proof("9a91d2ccc959", 1024, 256)
def horizon():
    return picture((0, 1.7, 0), (0, 1.7, -1), 0.4, -1, side=32, sampler="multijitter", sky=SKY,
                   planet={"type": "sphere", "center": [0, -1e6, 0], "radius": 1e6, "bsdf": diffuse(0)})


# The pictures of the spheres seen from inside.
INSIDE = {"eye": (0.2, 0.1, 0), "target": (1, 0.2, 0.3), "fov": 70, "depth": -1, "side": 12}


@proof("057324a89909", 1024, 1024)
def integrating_sphere_glow():
    """The sphere is a mesh of 2208 triangles. Where rounding puts a point of the sphere outside of it,
    Mitsuba samples directions to a sphere that glows by one density and weighs them by another: 0.8 % too bright,
    though its sampling of lamps by itself is right, and so is that of surfaces."""
    turn = np.pi * np.arange(1, 24) / 24
    profile = [(0, 1), *zip(np.sin(turn), np.cos(turn)), (0, -1)]
    return picture(**INSIDE, wall=turned(profile, 48, **{**glow(0.5), "bsdf": diffuse(0.5)}))


@proof("c260a3c6a783", 128, 1024)
def integrating_sphere_lamp():
    lamp = {"type": "point", "position": [0, 0, 0], "intensity": grey(np.pi)}
    return picture(**INSIDE, wall={"type": "sphere", "flip_normals": True, "bsdf": diffuse(0.5)}, lamp=lamp)


@proof("9d14ed9680a5", 64, 1024)
def pane():
    """Light goes from the lamp to the eye (`ptracer`), down a beam little wider than what is seen. The floor reflects a
    thousandth of light a thousand times as strong, so that the pane sends nothing back to it: the proof has no indirect
    light."""
    strong = 1000
    beam = {"type": "rectangle", "to_world": T().translate([0, 1, 0]).rotate([1, 0, 0], 90).scale([0.3, 0.3, 1]),
            "bsdf": {"type": "null"}, "emitter": {"type": "directionalarea", "radiance": grey(strong)}}
    return picture((0, 0.45, 0), (0, 0, 0), 60, -1, up=(0, 0, -1), side=24, by="ptracer", sun=beam,
                   floor=floor(40, matt(1 / strong)), pane=box((4, 0.05, 4), (0, 0.525, 0), bsdf=clear(1.5)))


@proof("6ce322ac5457", 1, 256)
def slab():
    return pixel((-2, -2, 0), (0, 0, 0), 0.0001, 3, glass=box((1, 50, 50), bsdf=clear(1.5)),
                 wall=box((0.1, 60, 60), (3, 0, 0), **glow(1)))


@proof("ea771900dfff", 65536, 256)
def sphere_light():
    return pixel((0.002, 0.005, 0.003), (0, 0, 0), 0.01, 2, floor=floor(0.01, matt(1)),
                 lamp={"type": "sphere", "center": [2, 3, 0.8], "radius": 1.5, **glow(3)})


@proof("eab196af1852", 65536, 256)
def square_light():
    return pixel((0.002, 0.005, 0.003), (0, 0, 0), 0.01, 2, floor=floor(0.01, matt(1)),
                 lamp=quad_light((-0.5, 1, -0.5), (1, 0, 0), (0, 0, 1), 2))


@proof("2662c6c1dedd", 1, 256)
def under_water():
    return pixel((0.2, 0, 0), (5, 0, 0), 0.001, 2, wall=box((0.1, 9, 9), (5, 0, 0), **glow(1)),
                 water=box((2, 9, 9), bsdf=clear(1.333)))


@proof("b07666bcd93e", 16384, 4096)
def wire():
    # Samples that are not spread evenly over a pixel would have to be a thousand times as many.
    return picture((0, 0, 5), (0, 0, 0), 30, 1, side=32, sampler="multijitter",
                   wire=box((0.000837341, 9, 0.0001), (0.01234, 0, 0), **glow(1)))
