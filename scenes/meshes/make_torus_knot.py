#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes torus_knot.obj: a (2, 3) torus knot as a tube of quads, without normals.

Lies about the xy plane: |x|, |y| < 1.6, |z| < 0.7 (nacre computes the smooth normals).
"""
import math
import pathlib

ALONG, AROUND = 220, 20  # quads along the knot and around its tube
TUBE_RADIUS = 0.2
SCALE = 0.46  # of the curve, whose core circle has radius 2


def curve(t):
    r = 2 + math.cos(3 * t)
    return [SCALE * r * math.cos(2 * t), SCALE * r * math.sin(2 * t), -SCALE * math.sin(3 * t)]


def core(t):
    """The point of the core circle around which the curve winds: the outside of the tube's frame."""
    return [SCALE * 2 * math.cos(2 * t), SCALE * 2 * math.sin(2 * t), 0]


def subtract(a, b):
    return [x - y for x, y in zip(a, b)]


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def unit(a):
    length = math.sqrt(sum(x * x for x in a))
    return [x / length for x in a]


def ring(t):
    """One ring of the tube, counter-clockwise seen against the direction of the curve."""
    step = 1e-4
    tangent = unit(subtract(curve(t + step), curve(t - step)))
    binormal = unit(cross(tangent, subtract(curve(t), core(t))))
    normal = cross(binormal, tangent)
    center = curve(t)
    for j in range(AROUND):
        angle = 2 * math.pi * j / AROUND
        c, s = TUBE_RADIUS * math.cos(angle), TUBE_RADIUS * math.sin(angle)
        yield [center[k] + c * normal[k] + s * binormal[k] for k in range(3)]


def main():
    lines = ["# (2, 3) torus knot, made by make_torus_knot.py"]
    for i in range(ALONG):
        for point in ring(2 * math.pi * i / ALONG):
            lines.append("v " + " ".join(f"{x:.6f}" for x in point))

    def index(i, j):
        return i % ALONG * AROUND + j % AROUND + 1

    for i in range(ALONG):
        for j in range(AROUND):
            corners = (index(i, j), index(i, j + 1), index(i + 1, j + 1), index(i + 1, j))
            lines.append("f " + " ".join(map(str, corners)))
    path = pathlib.Path(__file__).with_name("torus_knot.obj")
    path.write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
