# SPDX-License-Identifier: Apache-2.0
"""Scenes made for the scaling curves, and the material grid for other renderers."""
import json
import math

# A wall of spheres, meshes or lights seen from in front; 1920x1080 at 40 degrees sees 12.9 x 7.3 of
# the plane z = 0 from here.
_CAMERA = {"position": [0, 0, 10], "look_at": [0, 0, 0], "fov_y_deg": 40}
_LIGHTS = {"key": {"type": "directional", "direction_of_travel": [-0.4, -0.6, -1],
                   "irradiance": 3, "shadows": False},
           "sky": {"type": "ambient", "radiance": 0.1}}
MATERIAL = {"model": "metallic_roughness", "base_color": [0.9, 0.6, 0.2], "roughness": 0.3}


def write_scene(path, **parts):
    """A scene file of these members over a camera, a material and two lights; returns its path."""
    scene = {"nacre": 1, "camera": _CAMERA, "materials": {"gold": MATERIAL}, "lights": _LIGHTS,
             **parts}
    path.write_text(json.dumps(scene))
    return path


def write_spheres(path, count):
    """`count` spheres all over the frame and a little beyond. However many, their silhouettes
    together have the area of the frame: what grows is their number, not how much they cover."""
    radius = math.sqrt(12.9 * 7.3 / (math.pi * count))
    cloud = {"type": "cloud", "count": count, "seed": 1, "min": [-6.5, -3.7, -0.5],
             "max": [6.5, 3.7, 0.5], "radius": radius, "materials": ["gold"]}
    return write_scene(path, shapes=[cloud])


def write_triangles(path, count):
    """A ball of about `count` triangles: scene and OBJ file, rows of latitude all round."""
    rows = max(2, round(math.sqrt(count / 4)))
    columns = 2 * rows
    obj = path.with_suffix(".obj")
    with open(obj, "w", encoding="ascii") as file:
        for row in range(rows + 1):
            y = math.cos(math.pi * row / rows)
            r = math.sin(math.pi * row / rows)
            file.write("".join(
                f"v {r * math.cos(math.tau * c / columns):.7g} {y:.7g} "
                f"{r * math.sin(math.tau * c / columns):.7g}\n" for c in range(columns)))
        for row in range(rows):
            lines = []
            for c in range(columns):
                a = row * columns + c + 1
                b = row * columns + (c + 1) % columns + 1
                lines.append(f"f {a} {b} {b + columns}\nf {a} {b + columns} {a + columns}\n")
            file.write("".join(lines))
    mesh = {"type": "mesh", "file": obj.name, "material": "gold",
            "transform": {"scale": 3.5}}
    return write_scene(path, shapes=[mesh]), 2 * rows * columns


def write_lights(path, count, kind):
    """A sphere before a wall under `count` lights: "point" lights that reach everything, or "spot"
    lights each of which lights a small part."""
    lights = {}
    columns = math.ceil(math.sqrt(count * 16 / 9))
    rows = math.ceil(count / columns)
    for i in range(count):
        x = ((i % columns + 0.5) / columns - 0.5) * 12
        y = ((i // columns + 0.5) / rows - 0.5) * 7
        light = {"type": kind, "position": [x, y, 4], "intensity": 40 / count, "shadows": False}
        if kind == "spot":
            light |= {"direction_of_travel": [0, 0, -1], "intensity": 10,
                      "cutoff_deg": min(60, 120 / columns), "inner_deg": 0}
        lights[f"light {i}"] = light
    shapes = [{"type": "sphere", "center": [0, 0, 0], "radius": 2, "material": "gold"},
              {"type": "sphere", "center": [0, 0, -1e4 - 1], "radius": 1e4, "material": "gold"}]
    return write_scene(path, lights=lights, shapes=shapes)
