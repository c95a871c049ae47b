"""What the scenes of `make crosscheck` are made of, as Mitsuba dictionaries."""

import mitsuba as mi
import numpy as np

mi.set_variant("scalar_rgb")
T = mi.ScalarTransform4f

SIDE = 64


def grey(value):
    return {"type": "rgb", "value": [value] * 3 if isinstance(value, (int, float)) else list(value)}


def diffuse(value):
    return {"type": "diffuse", "reflectance": grey(value)}


def matt(value):
    return {"type": "twosided", "bsdf": diffuse(value)}


def clear(inside, outside=1.0):
    """Glass or water of the index `inside`, in what has the index `outside`."""
    return {"type": "dielectric", "int_ior": inside, "ext_ior": outside}


def mirror_of(value):
    return {"type": "conductor", "material": "none", "specular_reflectance": grey(value)}


def glow(radiance):
    """What a shape that only shines has for its surface."""
    return {"bsdf": diffuse(0), "emitter": {"type": "area", "radiance": grey(radiance)}}


def floor(size, bsdf):
    """The quad of `size` on y = 0, u along +x and v along -z."""
    return {"type": "rectangle", "to_world": T().rotate([1, 0, 0], -90).scale([size / 2, size / 2, 1]), "bsdf": bsdf}


def box(size, center=(0, 0, 0), turn=0, **surface):
    """`size` is that of the edges; `turn`, in degrees, is about the vertical through the centre."""
    place = T().translate(list(center)).rotate([0, 1, 0], turn).scale([edge / 2 for edge in size])
    return {"type": "cube", "to_world": place, **surface}


def quad_light(corner, u, v, radiance):
    """Shines to the side of u × v; its back is black."""
    corner, u, v = map(np.array, (corner, u, v))
    n = np.cross(u, v) / np.linalg.norm(np.cross(u, v))
    matrix = np.eye(4)
    matrix[:3, 0], matrix[:3, 1], matrix[:3, 2], matrix[:3, 3] = u / 2, v / 2, n, corner + (u + v) / 2
    return {"type": "rectangle", "to_world": T(matrix), **glow(radiance)}


def sun(direction, irradiance):
    return {"type": "directional", "direction": list(direction), "irradiance": grey(irradiance)}


def picture(eye, target, fov, depth, up=(0, 1, 0), side=SIDE, by="path", sampler="independent", roulette=12, **parts):
    """A Mitsuba scene, seen in a square. `depth` counts the segments of a path: 2 is direct light alone, -1 all."""
    return {
        "type": "scene",
        "integrator": {"type": by, "max_depth": depth, "rr_depth": roulette},
        "sensor": {
            "type": "perspective",
            "fov": fov,
            "near_clip": 1e-4,
            "to_world": T().look_at(origin=list(eye), target=list(target), up=list(up)),
            "film": {"type": "hdrfilm", "width": side, "height": side, "pixel_format": "rgb",
                     "component_format": "float32", "rfilter": {"type": "box"}},
            "sampler": {"type": sampler},
        },
        **parts,
    }
