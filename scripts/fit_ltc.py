#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Fits linearly transformed cosines to the GGX lobe, and writes src/light/ltc_{one,schlick}.h.

Heitz, Dupuy, Hill and Neubelt 2016, "Real-Time Polygonal-Light Shading with Linearly Transformed
Cosines": the lobe, seen from one direction and with all of its light's reflections counted as one,
is about a clamped cosine whose directions are mapped by a matrix. For each roughness and view the
three numbers of the matrix that the mean direction leaves free are found by the simplex method, the
cube of the difference being least. Only the shape is fitted: what the lobe reflects in all is known
better (src/brdf/albedo.h).

The lobe is that of src/brdf/ggx.h, with height-correlated shadowing, once with F = 1 and once with
F = (1 - v.h)^5: Schlick's curve is a mixture of both. It wants numpy, takes some minutes, makes the
same bytes again, and prints how far the fits are off, as the part of the light that comes from
elsewhere than it should: half the integral of the difference of both distributions. That is much
where a lobe's light is in two places, as Schlick's part of narrow ones near the normal: at the peak
and next to the horizon.
"""
import argparse
import pathlib

import numpy as np

ROUGHNESSES = np.linspace(0.1, 1.0, 19)
ANGLES = 32  # views, evenly in sqrt(1 - cos)
SIDE = 40  # samples along each side of the square


def grid():
    s = (np.arange(SIDE) + 0.5) / SIDE
    u, v = np.meshgrid(s, s)
    return u.ravel(), v.ravel()


def lobe(view, light, alpha, power):
    """f cos, with F = (1 - v.h)^power."""
    half = view + light
    half /= np.linalg.norm(half, axis=1, keepdims=True)
    nh2 = half[:, 2] ** 2
    d = alpha**2 / (np.pi * (nh2 * (alpha**2 - 1) + 1) ** 2)
    nl, nv = np.maximum(light[:, 2], 0), view[2]
    root = lambda c, o: o * np.sqrt(alpha**2 + (1 - alpha**2) * c * c)
    visibility = 0.5 / np.maximum(root(nv, nl) + root(nl, nv), 1e-30)
    fresnel = np.maximum(1 - half @ view, 0) ** power
    return np.where(light[:, 2] > 0, d * visibility * nl * fresnel, 0)


def lobe_samples(view, alpha):
    """Directions by the visible normals (Heitz 2018)."""
    u, v = grid()
    stretched = np.array([alpha * view[0], 0, view[2]])
    stretched /= np.linalg.norm(stretched)
    length = np.hypot(stretched[0], stretched[1])
    t1 = np.array([0, stretched[0], 0]) / length if length > 1e-9 else np.array([1.0, 0, 0])
    t2 = np.cross(stretched, t1)
    r, phi = np.sqrt(u), 2 * np.pi * v
    p1, p2 = r * np.cos(phi), r * np.sin(phi)
    s = 0.5 * (1 + stretched[2])
    p2 = (1 - s) * np.sqrt(np.maximum(1 - p1**2, 0)) + s * p2
    p3 = np.sqrt(np.maximum(1 - p1**2 - p2**2, 0))
    n = p1[:, None] * t1 + p2[:, None] * t2 + p3[:, None] * stretched
    n = np.stack([alpha * n[:, 0], alpha * n[:, 1], np.maximum(n[:, 2], 1e-12)], axis=1)
    n /= np.linalg.norm(n, axis=1, keepdims=True)
    light = 2 * (n @ view)[:, None] * n - view
    return light


def lobe_density(view, light, alpha):
    half = view + light
    half /= np.linalg.norm(half, axis=1, keepdims=True)
    d = alpha**2 / (np.pi * (half[:, 2] ** 2 * (alpha**2 - 1) + 1) ** 2)
    g1 = 2 / (view[2] + np.sqrt(alpha**2 + (1 - alpha**2) * view[2] ** 2))
    return np.where(half[:, 2] > 0, d * g1 / 4, 0)


def hemisphere_samples():
    """Uniform."""
    u, v = grid()
    r, phi = np.sqrt(1 - u * u), 2 * np.pi * v
    return np.stack([r * np.cos(phi), r * np.sin(phi), u], axis=1)


HEMISPHERE = hemisphere_samples()
HEMISPHERE_DENSITY = 1 / (2 * np.pi)


def cosine_samples():
    u, v = grid()
    r, phi = np.sqrt(u), 2 * np.pi * v
    return np.stack([r * np.cos(phi), r * np.sin(phi), np.sqrt(1 - u)], axis=1)


COSINES = cosine_samples()


def transformed(inverse, light):
    """The density of the linearly transformed cosine."""
    w = light @ inverse.T
    length = np.linalg.norm(w, axis=1)
    return np.maximum(w[:, 2], 0) / length**4 * abs(np.linalg.det(inverse)) / np.pi


def matrix(mean, numbers):
    m11, m22, m13 = numbers
    frame = np.array([[mean[2], 0, mean[0]], [0, 1, 0], [-mean[0], 0, mean[2]]])
    return frame @ np.array([[m11, 0, m13], [0, m22, 0], [0, 0, 1.0]])


def simplex(cost, start, steps=200):
    """The least of a function near a place, and whether it settled: Nelder and Mead 1965."""
    start = np.asarray(start, float)
    points = [start]
    for i in range(len(start)):
        other = start.copy()
        other[i] += 0.05 if other[i] == 0 else 0.1 * other[i]
        points.append(other)
    values = [cost(p) for p in points]
    for _ in range(steps):
        order = np.argsort(values)
        points, values = [points[i] for i in order], [values[i] for i in order]
        if max(np.abs(p - points[0]).max() for p in points) < 1e-5:
            return points[0], True
        centre = np.mean(points[:-1], axis=0)
        place = lambda t: centre + t * (points[-1] - centre)
        reflected = place(-1)
        value = cost(reflected)
        if value < values[0]:
            far = place(-2)
            far_value = cost(far)
            points[-1], values[-1] = (far, far_value) if far_value < value else (reflected, value)
        elif value < values[-2]:
            points[-1], values[-1] = reflected, value
        else:
            near = place(-0.5 if value < values[-1] else 0.5)
            near_value = cost(near)
            if near_value < min(value, values[-1]):
                points[-1], values[-1] = near, near_value
            else:
                points = [points[0]] + [(p + points[0]) / 2 for p in points[1:]]
                values = [values[0]] + [cost(p) for p in points[1:]]
    return points[int(np.argmin(values))], False


class Cell:
    """One roughness and view."""

    def __init__(self, roughness, cosine, power):
        self.alpha, self.power = roughness**2, power
        self.view = np.array([np.sqrt(max(1 - cosine**2, 0)), 0, cosine])
        # With F = (1 - v.h)^5 a narrow lobe has nearly all of its light far from where it is densest,
        # where none of its own samples may be: half of all samples know nothing of it.
        self.lights = np.concatenate([lobe_samples(self.view, self.alpha), HEMISPHERE])
        weights = lobe(self.view, self.lights, self.alpha, power) / self.density(self.lights)
        self.albedo = weights.sum() / SIDE**2
        mean = (self.lights * weights[:, None]).sum(axis=0)
        mean[1] = 0
        self.mean = mean / np.linalg.norm(mean)

    def density(self, light):
        """Of the lobe's samples and those of the hemisphere together."""
        return lobe_density(self.view, light, self.alpha) + HEMISPHERE_DENSITY

    def integral(self, numbers, exponent):
        m = matrix(self.mean, numbers)
        if abs(np.linalg.det(m)) < 1e-12:
            return 1e9
        inverse = np.linalg.inv(m)
        own = COSINES @ m.T
        own /= np.linalg.norm(own, axis=1, keepdims=True)
        total = 0
        for light in (self.lights, own):
            wanted = lobe(self.view, light, self.alpha, self.power) / self.albedo
            got = transformed(inverse, light)
            total += (np.abs(wanted - got) ** exponent / (self.density(light) + got)).sum()
        return total / SIDE**2

    def fit(self, start, is_round):
        def expand(x):
            return (abs(x[0]), abs(x[0]), 0.0) if is_round else (abs(x[0]), abs(x[1]), x[2])

        free = start[:1] if is_round else start
        cost = lambda x: self.integral(np.maximum(np.array(expand(x)), [1e-4, 1e-4, -1e9]), 3)
        best, self.settled = simplex(cost, free)
        return np.maximum(np.array(expand(best)), [1e-4, 1e-4, -1e9])


def fit_row(roughness, power):
    """From the view along the normal to grazing, each from where the last one ended."""
    width = roughness**2 if power == 0 else 1.0
    numbers, row, errors, unsettled = np.array([width, width, 0.0]), [], [], 0
    for k in range(ANGLES):
        x = k / (ANGLES - 1)
        cell = Cell(roughness, max(1 - x * x, 1e-3), power)
        numbers = cell.fit(numbers, k == 0)
        unsettled += not cell.settled
        inverse = np.linalg.inv(matrix(cell.mean, numbers))
        inverse /= inverse[1, 1]
        row.append((inverse[0, 0], inverse[0, 2], inverse[2, 0], inverse[2, 2]))
        errors.append(cell.integral(numbers, 1) / 2)
    return row, errors, unsettled


def header(name, array, curve, rows, told):
    """The table as a header."""
    lines = [
        "// SPDX-License-Identifier: Apache-2.0",
        f"// light/{name}: written by scripts/fit_ltc.py, for light/ltc.cc alone: of each roughness,",
        f"// by views, LtcNumbers for {curve}.",
        "//",
        f"// Light that the fits have elsewhere: {told}.",
        "#pragma once",
        "",
        '#include "light/ltc.h"',
        "",
        "namespace nacre {",
        "",
        "// clang-format off",
        f"inline constexpr LtcRow {array}[kLtcRoughnesses] = {{",
    ]
    for row in rows:
        cells = ["{" + ", ".join(f"{float(x):.6e}f" for x in cell) + "}" for cell in row]
        lines.append("{{" + ",\n  ".join(cells) + "}},")
    lines += ["};", "// clang-format on", "", "}  // namespace nacre"]
    return "\n".join(lines) + "\n"


def write(path, power, array, curve):
    rows, errors, unsettled = zip(*[fit_row(r, power) for r in ROUGHNESSES])
    errors = np.array(errors)
    told = f"{100 * np.median(errors):.1f} % in the median, {100 * errors.max():.1f} % at worst"
    path.write_text(header(path.name, array, curve, rows, told), encoding="utf-8")
    i, k = np.unravel_index(errors.argmax(), errors.shape)
    print(f"{path.name}: {told}, at roughness {ROUGHNESSES[i]:.2f} and view {k} of {ANGLES}; "
          f"{sum(unsettled)} of {errors.size} fits did not settle", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    root = pathlib.Path(__file__).resolve().parent.parent
    parser.add_argument("-o", "--output", type=pathlib.Path, default=root / "src/light")
    folder = parser.parse_args().output
    write(folder / "ltc_one.h", 0, "kLtcOne", "F = 1")
    write(folder / "ltc_schlick.h", 5, "kLtcSchlick", "F = (1 - v.h)^5")


if __name__ == "__main__":
    main()
