# SPDX-License-Identifier: Apache-2.0
"""Makes pawns.glb: chess pieces on a board, all of triangles, for `nacre render`.

Usage: make_pawns.py OUT.glb. Nothing but Python's own library is needed.
"""
import json
import math
import struct
import sys

SEGMENTS = 48


class Model:
    """A glTF document and the bytes of its one buffer."""

    def __init__(self):
        self.bytes = b""
        self.json = {"asset": {"version": "2.0", "generator": "make_pawns.py"}, "scene": 0,
                     "scenes": [{"nodes": []}], "nodes": [], "meshes": [], "materials": [],
                     "accessors": [], "bufferViews": [], "buffers": []}

    def add(self, kind, item):
        self.json[kind].append(item)
        return len(self.json[kind]) - 1

    def accessor(self, data, component, kind, count, **members):
        view = self.add("bufferViews", {"buffer": 0, "byteOffset": len(self.bytes),
                                        "byteLength": len(data)})
        self.bytes += data + bytes(-len(data) % 4)
        return self.add("accessors", {"bufferView": view, "componentType": component, "type": kind,
                                      "count": count, **members})

    def meshes(self, name, positions, normals, triangles, materials):
        """One mesh for each of the materials."""
        def floats(triples):
            return b"".join(struct.pack("<3f", *triple) for triple in triples)
        bounds = {"min": [min(p[c] for p in positions) for c in range(3)],
                  "max": [max(p[c] for p in positions) for c in range(3)]}
        primitive = {"attributes": {
            "POSITION": self.accessor(floats(positions), 5126, "VEC3", len(positions), **bounds)}}
        if normals:
            primitive["attributes"]["NORMAL"] = self.accessor(
                floats(normals), 5126, "VEC3", len(normals))
        primitive["indices"] = self.accessor(
            struct.pack(f"<{len(triangles)}H", *triangles), 5123, "SCALAR", len(triangles))
        return [self.add("meshes", {"name": name,
                                    "primitives": [{"material": material, **primitive}]})
                for material in materials]

    def write(self, path):
        self.json["buffers"] = [{"byteLength": len(self.bytes)}]
        text = json.dumps(self.json, separators=(",", ":")).encode()
        text += b" " * (-len(text) % 4)
        chunks = struct.pack("<II", len(text), 0x4E4F534A) + text
        chunks += struct.pack("<II", len(self.bytes), 0x004E4942) + self.bytes
        with open(path, "wb") as file:
            file.write(struct.pack("<III", 0x46546C67, 2, 12 + len(chunks)) + chunks)


def lathe(profile):
    """The surface that a list of (radius, height, normal's radius, normal's height) sweeps."""
    positions, normals, triangles = [], [], []
    for radius, height, normal_radius, normal_height in profile:
        for i in range(SEGMENTS):
            c, s = math.cos(2 * math.pi * i / SEGMENTS), math.sin(2 * math.pi * i / SEGMENTS)
            positions.append((radius * c, height, radius * s))
            normals.append((normal_radius * c, normal_height, normal_radius * s))
    for ring in range(len(profile) - 1):
        for i in range(SEGMENTS):
            a, b = ring * SEGMENTS + i, ring * SEGMENTS + (i + 1) % SEGMENTS
            triangles += [a, a + SEGMENTS, b, b, a + SEGMENTS, b + SEGMENTS]
    return positions, normals, triangles


def arc(center_radius, center_height, radius, first_deg, last_deg, steps):
    """Points of a circle in the profile, from one angle to another, with their normals."""
    points = []
    for i in range(steps + 1):
        angle = math.radians(first_deg + (last_deg - first_deg) * i / steps)
        c, s = math.cos(angle), math.sin(angle)
        points.append((max(center_radius + radius * c, 0), center_height + radius * s, c, s))
    return points


def hollow(center_radius, center_height, radius, first_deg, last_deg, steps):
    """The same of a groove: normals point to the circle's centre."""
    return [(r, h, -c, -s) for r, h, c, s in
            arc(center_radius, center_height, radius, first_deg, last_deg, steps)]


def pawn():
    profile = [(0, 0, 0, -1), (0.36, 0, 0, -1), (0.36, 0, 1, 0)] + arc(0.3, 0.06, 0.06, 0, 90, 8)
    profile += arc(0.25, 0.2, 0.05, -60, 90, 10)
    profile += hollow(0.5, 0.55, 0.37, 215, 160, 14)
    profile += arc(0.14, 0.7, 0.045, -90, 90, 10)
    profile += arc(0, 0.88, 0.17, -55, 90, 24)
    return lathe(profile)


def box(size, height):
    """A box under the plane y = 0; no normals: its faces are flat."""
    x = size / 2
    corners = [(sx * x, y, sz * x) for y in (-height, 0) for sz in (-1, 1) for sx in (-1, 1)]
    quads = [(4, 6, 7, 5), (0, 1, 3, 2), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    return corners, None, [quad[i] for quad in quads for i in (0, 1, 2, 0, 2, 3)]


def main():
    model = Model()

    def material(name, color, metallic, roughness, **extensions):
        item = {"name": name, "pbrMetallicRoughness": {
            "baseColorFactor": [*color, 1], "metallicFactor": metallic,
            "roughnessFactor": roughness}}
        if extensions:
            item["extensions"] = extensions
        return model.add("materials", item)
    ivory = material("ivory", (0.82, 0.73, 0.55), 0, 0.3)
    brass = material("brass", (0.91, 0.72, 0.36), 1, 0.28)
    light = material("light wood", (0.65, 0.45, 0.25), 0, 0.5)
    dark = material("dark wood", (0.16, 0.08, 0.045), 0, 0.4)
    rim = material("rim", (0.07, 0.05, 0.04), 0, 0.25, KHR_materials_ior={"ior": 1.8})
    model.json["extensionsUsed"] = ["KHR_materials_ior"]

    pawns = model.meshes("pawn", *pawn(), (ivory, brass))
    squares = model.meshes("square", *box(0.995, 0.1), (light, dark))
    frame, = model.meshes("frame", *box(5.6, 0.3), (rim,))
    nodes = model.json["scenes"][0]["nodes"]
    board = {"name": "board", "children": [
        model.add("nodes", {"name": "frame", "mesh": frame, "translation": [0, -0.02, 0]})]}
    for row in range(5):
        for column in range(5):
            square = {"name": "square", "mesh": squares[(row + column) % 2],
                      "translation": [column - 2, 0, row - 2]}
            piece = {(0, 1): 1, (1, 3): 1, (2, 0): 1, (3, 2): 0, (4, 4): 0, (2, 4): 1, (4, 0): 0,
                     (3, 1): 0, (1, 2): 1}.get((row, column))
            if piece is not None:
                square["children"] = [model.add("nodes", {"name": "pawn", "mesh": pawns[piece]})]
            board["children"].append(model.add("nodes", square))
    nodes.append(model.add("nodes", board))
    model.write(sys.argv[1])


if __name__ == "__main__":
    main()
