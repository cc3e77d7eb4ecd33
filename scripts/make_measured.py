#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes an analytic BRDF as a file of measurements: a MERL .binary or an EPFL .bsdf.

A GGX lobe with Schlick's Fresnel term and height-correlated Smith shadowing, over a Lambertian base
in MERL files. With --diffuse 0, nacre's own material of the same reflection is
  {"model": "metallic_roughness", "metallic": 1, "base_color": F0, "roughness": ROUGHNESS,
   "compensation": "none"}

  scripts/make_measured.py gold.binary --f0 1 0.77 0.34 --roughness 0.5
  scripts/make_measured.py brushed.bsdf --roughness 0.5 --anisotropy 0.8

A MERL file has 35 MB, whatever is in it. Takes a few seconds.
"""
import argparse
import array
import bisect
import itertools
import math
import struct
import sys

# Values of MERL files are these multiples of 1/sr.
MERL_SCALES = (1 / 1500, 1.15 / 1500, 1.66 / 1500)
THETA_HALF, THETA_DIFF, PHI_DIFF = 90, 90, 180  # cells


class Ggx:
    """Directions are (x, y, z), with the normal along z."""

    def __init__(self, f0, roughness, anisotropy):
        alpha = roughness ** 2
        self.f0 = f0
        self.alpha = (alpha + (1 - alpha) * anisotropy ** 2, alpha)  # as in glTF
        self.anisotropic = anisotropy > 0

    def distribution(self, m):
        (x, y), (ax, ay) = m[:2], self.alpha
        k = (x / ax) ** 2 + (y / ay) ** 2 + m[2] ** 2
        return 1 / (math.pi * ax * ay * k * k)

    def smith_lambda(self, w):
        (x, y), (ax, ay) = w[:2], self.alpha
        slope2 = ((ax * x) ** 2 + (ay * y) ** 2) / max(w[2], 1e-9) ** 2
        return (math.sqrt(1 + slope2) - 1) / 2

    def fresnel(self, cosine):
        edge = (1 - min(max(cosine, 0), 1)) ** 5
        return [f0 + (1 - f0) * edge for f0 in self.f0]


def direction(theta, phi):
    sine = math.sin(theta)
    return sine * math.cos(phi), sine * math.sin(phi), math.cos(theta)


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


# ---- MERL ----

def write_merl(path, model, diffuse):
    """At the centres of cells: the cosines of light and viewer to the normal are c -+ s."""
    values = [array.array('d', bytes(8 * THETA_HALF * THETA_DIFF * PHI_DIFF)) for _ in range(3)]
    cos_phi = [math.cos((k + 0.5) / PHI_DIFF * math.pi) for k in range(PHI_DIFF)]
    alpha2 = model.alpha[1] ** 2

    def root(cosine):  # 1 + 2 lambda, times the cosine
        return math.sqrt(alpha2 + (1 - alpha2) * cosine * cosine)

    for i, j in itertools.product(range(THETA_HALF), range(THETA_DIFF)):
        theta_half = ((i + 0.5) / THETA_HALF) ** 2 * math.pi / 2  # goes by its square root
        theta_diff = (j + 0.5) / THETA_DIFF * math.pi / 2
        c = math.cos(theta_half) * math.cos(theta_diff)
        s = math.sin(theta_half) * math.sin(theta_diff)
        d = model.distribution(direction(theta_half, 0))
        fresnel = model.fresnel(math.cos(theta_diff))
        lobe = [-1.0] * PHI_DIFF  # what cannot be measured is negative
        for k in range(PHI_DIFF // 2):
            light, view = c - s * cos_phi[k], c + s * cos_phi[k]
            if light > 0 and view > 0:  # light and viewer change places at the other azimuth
                lobe[k] = lobe[-1 - k] = d / (2 * (light * root(view) + view * root(light)))
        first = PHI_DIFF * (j + THETA_DIFF * i)
        for channel in range(3):
            base, f = diffuse[channel] / math.pi, fresnel[channel]
            scale = 1 / MERL_SCALES[channel]
            values[channel][first:first + PHI_DIFF] = array.array(
                'd', [(base + f * g) * scale if g >= 0 else -1.0 for g in lobe])
    with open(path, 'wb') as file:
        file.write(struct.pack('<3i', THETA_HALF, THETA_DIFF, PHI_DIFF))
        for channel in values:
            if sys.byteorder == 'big':
                channel.byteswap()
            file.write(channel.tobytes())


# ---- EPFL ----

def write_tensors(path, fields):
    """The header lists names, shapes, types and offsets; the arrays follow. fields: {name: (shape,
    numbers, or bytes)}."""
    size = 18 + sum(2 + len(name) + 11 + 8 * len(shape) for name, (shape, _) in fields.items())
    head, data = b'tensor_file\0' + struct.pack('<BBI', 1, 0, len(fields)), b''
    for name, (shape, numbers) in fields.items():
        is_bytes = isinstance(numbers, bytes)
        head += struct.pack('<H', len(name)) + name.encode()
        head += struct.pack('<HBQ', len(shape), 1 if is_bytes else 10, size + len(data))
        head += struct.pack(f'<{len(shape)}Q', *shape)
        data += numbers if is_bytes else struct.pack(f'<{len(numbers)}f', *numbers)
    with open(path, 'wb') as file:
        file.write(head + data)


def steps(first, last, count):
    return [first + (last - first) * i / (count - 1) for i in range(count)]


def half_vector(x, y):
    """Of a point of the unit square."""
    return direction(x * x * math.pi / 2, (2 * y - 1) * math.pi)


def mix(a, b, t):
    return [x * (1 - t) + y * t for x, y in zip(a, b)]


class Warp:
    """The map of the unit square to a density that is bilinear between nodes."""

    def __init__(self, density):  # rows of columns
        self.density = density
        self.rows, self.columns = len(density) - 1, len(density[0]) - 1
        self.along = [self.integrate(row) for row in density]
        self.up_to = self.integrate([row[-1] for row in self.along])

    @staticmethod
    def integrate(values):
        panels = ((a + b) / (2 * (len(values) - 1)) for a, b in zip(values, values[1:]))
        return [0, *itertools.accumulate(panels)]

    @staticmethod
    def solve(a, b, integral):
        """t in [0, 1] for which a t + (b - a) t^2 / 2 is the integral."""
        root = math.sqrt(max(a * a + 2 * integral * (b - a), 0))
        return min(max(2 * integral / max(a + root, 1e-300), 0), 1)

    def forward_row(self, y, xs):
        """The points of (x, y) for all xs."""
        target = y * self.up_to[-1]
        j = min(max(bisect.bisect_right(self.up_to, target) - 1, 0), self.rows - 1)
        t = self.solve(self.along[j][-1], self.along[j + 1][-1],
                       (target - self.up_to[j]) * self.rows)
        along = mix(self.along[j], self.along[j + 1], t)
        density = mix(self.density[j], self.density[j + 1], t)
        for x in xs:
            target = x * along[-1]
            i = min(max(bisect.bisect_right(along, target) - 1, 0), self.columns - 1)
            s = self.solve(density[i], density[i + 1], (target - along[i]) * self.columns)
            yield (i + s) / self.columns, (j + t) / self.rows


def write_rgl(path, model, angles, nodes, warp_nodes):
    theta_i = steps(0, math.pi / 2 * 0.995, angles)
    # Mirrored in both axes, a quarter of the azimuths stands for all.
    phi_i = steps(-math.pi, -math.pi / 2, 7) if model.anisotropic else [0]
    axis, squares = steps(0, 1, warp_nodes), steps(0, 1, nodes)
    halves = [[half_vector(x, y) for x in axis] for y in axis]
    # The density of half vectors over the square, but for how the viewer sees them.
    ndf_in_square = [[model.distribution(m) * math.sqrt(max(1 - m[2] ** 2, 0)) * x
                      for m, x in zip(row, axis)] for row in halves]
    vndf, rgb, luminance = [], [], []
    for phi, theta in itertools.product(phi_i, theta_i):
        # Azimuths of half vectors are counted from the viewer's if the material is isotropic.
        v = direction(theta, phi)
        density = [[max(dot(m, v), 0) * d + 1e-4 for m, d in zip(*rows)]
                   for rows in zip(halves, ndf_in_square)]
        of_view = 1 + model.smith_lambda(v)
        colors = []
        warp = Warp(density)
        for x, y in (point for s in squares for point in warp.forward_row(s, squares)):
            h = half_vector(x, y)
            cosine = dot(h, v)
            l = [2 * cosine * a - b for a, b in zip(h, v)]
            leaves = of_view / (of_view + model.smith_lambda(l)) if cosine > 0 and l[2] > 0 else 0
            colors.append([f * leaves for f in model.fresnel(cosine)])
        vndf += itertools.chain(*density)
        rgb += [color[channel] for channel in range(3) for color in colors]
        luminance += [0.2126 * r + 0.7152 * g + 0.0722 * b + 1e-3 for r, g, b in colors]
    fine, rows = steps(0, 1, 256), steps(0, 1, 65 if model.anisotropic else 2)
    whole = [half_vector(x, y) for y in rows for x in fine]
    sigma = [max(z, 1e-4) * (1 + model.smith_lambda((x, y, max(z, 1e-4)))) for x, y, z in whole]
    shape = len(phi_i), len(theta_i)
    text = 'GGX, alpha {:.6g} and {:.6g}'.format(*model.alpha).encode()
    write_tensors(path, {
        'description': ((len(text),), text),
        'theta_i': ((len(theta_i),), theta_i),
        'phi_i': ((len(phi_i),), phi_i),
        'ndf': ((len(rows), len(fine)), [model.distribution(m) for m in whole]),
        'sigma': ((len(rows), len(fine)), sigma),
        'vndf': ((*shape, warp_nodes, warp_nodes), vndf),
        'luminance': ((*shape, nodes, nodes), luminance),
        'rgb': ((*shape, 3, nodes, nodes), rgb),
        'jacobian': ((1,), b'\1')})


def main():
    parser = argparse.ArgumentParser(description=__doc__.split('\n\n', maxsplit=1)[0])
    parser.add_argument('file', help='.binary or .bsdf')
    parser.add_argument('--f0', type=float, nargs='+', default=[1, 0.77, 0.34],
                        help='reflectance at normal incidence: one number, or three')
    parser.add_argument('--diffuse', type=float, nargs='+', default=[0],
                        help='albedo of the base of a MERL file')
    parser.add_argument('--roughness', type=float, default=0.5)
    parser.add_argument('--anisotropy', type=float, default=0,
                        help='of a .bsdf, in [0, 1], as in glTF')
    parser.add_argument('--angles', type=int, default=16, help="viewer's angles of a .bsdf")
    parser.add_argument('--nodes', type=int, default=32, help='along a side of its tables')
    parser.add_argument('--warp-nodes', type=int, default=64, help='along a side of its density')
    options = parser.parse_args()
    for name in 'f0', 'diffuse':
        if len(getattr(options, name)) not in (1, 3):
            parser.error(f'--{name} takes one number or three')
    f0, diffuse = options.f0 * (3 // len(options.f0)), options.diffuse * (3 // len(options.diffuse))
    model = Ggx(f0, options.roughness, options.anisotropy)
    if options.file.endswith('.binary'):
        if options.anisotropy:
            parser.error('tables of the MERL database are isotropic')
        write_merl(options.file, model, diffuse)
    elif options.file.endswith('.bsdf'):
        if any(diffuse):
            parser.error('a .bsdf has no base here')
        write_rgl(options.file, model, options.angles, options.nodes, options.warp_nodes)
    else:
        parser.error('the file is called .binary or .bsdf')


if __name__ == '__main__':
    main()
