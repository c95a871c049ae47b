"""The scene of scenes/yardstick/heightfield.ron in Mitsuba 3: heightfield_mitsuba.py VARIANT OBJ OUT."""

import sys

import mitsuba as mi

variant, mesh, out = sys.argv[1:4]
mi.set_variant(variant)
mi.logger().set_log_level(mi.LogLevel.Warn)

scene = mi.load_dict({
    "type": "scene",
    # One primary and one shadow ray a sample.
    "integrator": {"type": "path", "max_depth": 2},
    "sensor": {
        "type": "perspective",
        "fov": 45,
        "fov_axis": "y",
        "to_world": mi.ScalarTransform4f().look_at(origin=[0, 6, 9], target=[0, 0, 0], up=[0, 1, 0]),
        "film": {"type": "hdrfilm", "width": 1024, "height": 1024, "rfilter": {"type": "box"}},
        "sampler": {"type": "independent", "sample_count": 16},
    },
    "field": {
        "type": "obj",
        "filename": mesh,
        "face_normals": True,
        "bsdf": {"type": "twosided", "bsdf": {"type": "diffuse", "reflectance": {"type": "rgb", "value": 0.6}}},
    },
    "lamp": {"type": "point", "position": [4, 8, 3], "intensity": {"type": "rgb", "value": 200}},
})
mi.util.write_bitmap(out, mi.render(scene), write_async=False)
