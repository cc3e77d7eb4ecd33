# SPDX-License-Identifier: Apache-2.0
"""The inputs of bench/waiting.py: large files of every kind, the same ones each time. Those that are
there already are kept."""
import array
import base64
import json
import math
import random

import scene_files
from processes import output_of, say

SPHERES = 1_000_000
GLB_TRIANGLES = 4_200_000
OBJ_TRIANGLES = 1_000_000
PAIR_SIZE = "3840x2160"

_BALL = {"type": "sphere", "center": [0, 0, 0], "radius": 2, "material": "gold"}
_FLOOR = {"type": "sphere", "center": [0, -1002, 0], "radius": 1000, "material": "gold"}


def _write_sky(path, width=8192, height=4096):
    """A Radiance file without run lengths: random mantissas, exponents that change slowly."""
    draw = random.Random(1)
    with open(path, "wb") as file:
        file.write(f"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {height} +X {width}\n".encode())
        for row in range(height):
            pixels = bytearray(draw.randbytes(4 * width))
            for i in range(3):  # normalised: a mantissa of 128 at least
                pixels[i::4] = bytes(value | 128 for value in pixels[i::4])
            pixels[3::4] = bytes([124 + 6 * row // height]) * width
            file.write(pixels)


def _write_json_spheres(path, count):
    """Every sphere spelled out."""
    draw = random.Random(2)
    radius = math.sqrt(12.9 * 7.3 / (math.pi * count))
    head = json.loads(scene_files.write_scene(path, shapes=[]).read_text())
    with open(path, "w", encoding="ascii") as file:
        file.write(json.dumps(head)[:-len("[]}")] + "[\n")
        for i in range(count):
            x, y, z = draw.uniform(-6.5, 6.5), draw.uniform(-3.7, 3.7), draw.uniform(-.5, .5)
            file.write(f'{"," if i else ""}{{"type": "sphere", "center": [{x:.9f}, {y:.9f}, {z:.9f}], '
                       f'"radius": {radius:.9f}, "material": "gold"}}\n')
        file.write("]}")


def _glb(document, binary):
    """The bytes of a GLB file."""
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    binary += b"\0" * (-len(binary) % 4)
    head = b"glTF" + (2).to_bytes(4, "little")
    chunks = (len(text).to_bytes(4, "little") + b"JSON" + text +
              len(binary).to_bytes(4, "little") + b"BIN\0" + binary)
    return head + (12 + len(chunks)).to_bytes(4, "little") + chunks


def _grid(side):
    """Positions, normals and indices of a wavy square of 2 side^2 triangles, and their bounds."""
    positions, normals = array.array("f"), array.array("f")
    waves = [0.02 * math.sin(40 * i / side) for i in range(side + 1)]
    slopes = [0.02 * 40 * math.cos(40 * i / side) for i in range(side + 1)]
    for y in range(side + 1):
        for x in range(side + 1):
            positions.extend((x / side - 0.5, waves[x] + waves[y], y / side - 0.5))
            scale = 1 / math.sqrt(1 + slopes[x] ** 2 + slopes[y] ** 2)
            normals.extend((-slopes[x] * scale, scale, -slopes[y] * scale))
    indices = array.array("I")
    for y in range(side):
        first = y * (side + 1)
        for a in range(first, first + side):
            b = a + side + 1
            indices.extend((a, b, a + 1, a + 1, b, b + 1))
    return positions, normals, indices


def _write_glb(path, triangles):
    side = round(math.sqrt(triangles / 2))
    positions, normals, indices = _grid(side)
    vertices = len(positions) // 3
    parts = [part.tobytes() for part in (positions, normals, indices)]
    views, offset = [], 0
    for part in parts:
        views.append({"buffer": 0, "byteOffset": offset, "byteLength": len(part)})
        offset += len(part)
    document = {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 1}, "indices": 2}]}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": vertices, "type": "VEC3",
             "min": [-0.5, -0.04, -0.5], "max": [0.5, 0.04, 0.5]},
            {"bufferView": 1, "componentType": 5126, "count": vertices, "type": "VEC3"},
            {"bufferView": 2, "componentType": 5125, "count": len(indices), "type": "SCALAR"}],
        "bufferViews": views, "buffers": [{"byteLength": offset}]}
    path.write_bytes(_glb(document, b"".join(parts)))


def _write_jpeg_model(path, images):
    """A square with five maps."""
    vertices = [(-1, -1, 0, 0, 1), (1, -1, 0, 1, 1), (1, 1, 0, 1, 0), (-1, 1, 0, 0, 0)]
    data = b"".join(array.array("f", part).tobytes() for part in (
        [value for v in vertices for value in v[:3]], [0, 0, 1] * 4,
        [value for v in vertices for value in v[3:]]))
    data += array.array("H", [0, 1, 2, 0, 2, 3]).tobytes()
    maps = [{"index": i} for i in range(5)]
    path.write_text(json.dumps({
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 2},
                                    "indices": 3, "material": 0}]}],
        "materials": [{"pbrMetallicRoughness": {"baseColorTexture": maps[0],
                                                "metallicRoughnessTexture": maps[1]},
                       "normalTexture": maps[2], "emissiveTexture": maps[3],
                       "emissiveFactor": [1, 1, 1], "occlusionTexture": maps[4]}],
        "textures": [{"source": i} for i in range(5)],
        "images": [{"uri": image.name} for image in images],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3",
                       "min": [-1, -1, 0], "max": [1, 1, 0]},
                      {"bufferView": 1, "componentType": 5126, "count": 4, "type": "VEC3"},
                      {"bufferView": 2, "componentType": 5126, "count": 4, "type": "VEC2"},
                      {"bufferView": 3, "componentType": 5123, "count": 6, "type": "SCALAR"}],
        "bufferViews": [{"buffer": 0, "byteOffset": offset, "byteLength": size}
                        for offset, size in ((0, 48), (48, 48), (96, 32), (128, 12))],
        "buffers": [{"byteLength": len(data), "uri": "data:application/octet-stream;base64," +
                     base64.b64encode(data).decode()}]}))


def make(folder, root, nacre, tool):
    """{name: path} of all of them. `tool` is waiting_bench."""
    files = {}
    folder.mkdir(parents=True, exist_ok=True)

    def add(name, write):
        path = folder / name
        if not path.exists():
            say(f"  making {name}")
            partial = path.with_name("part_" + name)
            write(partial)
            partial.rename(path)
        files[name] = path

    def render(scene, *options):
        return lambda path: output_of([nacre, "render", scene, "-o", path, "--quiet", *options])

    scenes = root / "scenes"
    add("sky.hdr", _write_sky)
    add("sky.json", lambda path: scene_files.write_scene(
        path, shapes=[_BALL, _FLOOR], lights={"sky": {"type": "environment", "image": "sky.hdr"}}))
    # A picture with detail everywhere, for textures.
    add("texture.png", render(scenes / "textures.json", "--size", "4096x4096", "--spp", "1"))
    add("texture.json", lambda path: scene_files.write_scene(
        path, shapes=[_BALL, {"type": "uv_sphere", "center": [0, -1002, 0], "radius": 1000,
                              "segments": 64, "rings": 32, "material": "floor"}],
        textures={"tiles": {"file": "texture.png", "mapping": {"kind": "planar", "axis": [0, 1, 0]}}},
        materials={"gold": scene_files.MATERIAL,
                   "floor": {"model": "metallic_roughness", "roughness": 0.5,
                             "base_color_map": "tiles"}}))
    jpegs = []
    for i in range(5):
        add(f"map{i}.jpg", lambda path: output_of([tool, "jpeg", files["texture.png"], path]))
        jpegs.append(files[f"map{i}.jpg"])
    add("maps.gltf", lambda path: _write_jpeg_model(path, jpegs))

    def write_obj(path):
        scene, _ = scene_files.write_triangles(path.with_suffix(".json"), OBJ_TRIANGLES)
        scene.unlink()  # it names the OBJ file by its name while it is being written
    add("ball.obj", write_obj)
    add("ball.json", lambda path: scene_files.write_scene(
        path, shapes=[{"type": "mesh", "file": "ball.obj", "material": "gold",
                       "transform": {"scale": 3.5}}]))
    add("grid.glb", lambda path: _write_glb(path, GLB_TRIANGLES))
    add("spheres.json", lambda path: _write_json_spheres(path, SPHERES))
    for count in (1_000_000, 10_000_000):
        add(f"cloud{count}.json", lambda path, n=count: scene_files.write_spheres(path, n))
    lamp = {"center": [0, 3, 3], "radius": 0.5}
    add("mesh_light.json", lambda path: scene_files.write_scene(
        path, shapes=[_BALL, _FLOOR],
        lights={"lamp": {"type": "mesh", "icosphere": {**lamp, "subdivisions": 2}, "radiance": 20}}))
    add("rectangle_light.json", lambda path: scene_files.write_scene(
        path, shapes=[_BALL, _FLOOR],
        lights={"lamp": {"type": "rectangle", "center": lamp["center"], "facing": [0, -1, -1],
                         "width": 1, "height": 1, "radiance": 20}}))
    grid = scenes / "material_grid.json"
    pair = ["--size", PAIR_SIZE, "--depth", "float"]
    add("a.exr", render(grid, *pair, "--spp", "4"))
    add("b.exr", render(grid, *pair, "--spp", "4", "--seed", "2"))
    return files
