#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes fuzz.json, the reference values of src/brdf/fuzz.h: tests/tables/make_fuzz.py.

`distribution`: the transformed cosine of Zeltner et al. 2022 by its matrix, as the paper has it, in
40 digits, with b = tilt sin(theta_v). `cond` is the sum of |x df/dx| / |f| over a, tilt, n.l, n.v
and the azimuth between light and viewer.

`walks`: the albedo of the paper's layer of fibres by random walks of any length, which shares no
method with scripts/fit_fuzz.py; its standard error is below 0.0006. Needs python3-mpmath and
python3-numpy; takes a minute.
"""
import json
import pathlib
import random

import mpmath
import numpy as np
from mpmath import mp, mpf


def distribution(a, tilt, n_dot_l, n_dot_v, phi):
    sin_l, sin_v = mpmath.sqrt(1 - n_dot_l ** 2), mpmath.sqrt(1 - n_dot_v ** 2)
    inverse = mpmath.matrix([[a, 0, tilt * sin_v], [0, a, 0], [0, 0, 1]])
    v = inverse * mpmath.matrix([sin_l * mpmath.cos(phi), sin_l * mpmath.sin(phi), n_dot_l])
    length = mpmath.norm(v)
    return v[2] / length / mp.pi * mpmath.det(inverse) / length ** 3


def condition(function, inputs):
    value = function(*inputs)
    total = mpf(0)
    for i, x in enumerate(inputs):
        step = x * mpf(10) ** -12
        moved = [list(inputs), list(inputs)]
        moved[0][i], moved[1][i] = x - step, x + step
        total += abs(x * (function(*moved[1]) - function(*moved[0])) / (2 * step) / value)
    return total


def digits(value, count=30):
    return mpmath.nstr(value, count, strip_zeros=False, min_fixed=-5, max_fixed=5)


def normalized(v):
    return v / np.linalg.norm(v, axis=1)[:, None]


def scattered(d, s, rng):
    """Directions of motion after specular SGGX flakes whose matrix is diag(1, 1, s^2)."""
    stretch = np.array([1, 1, s])
    back = -d
    # Visible normals: of a sphere, cosine-weighted, where the flakes' ellipsoid is one.
    axis = normalized(back * stretch)
    radius2, phi = rng.random(len(d)), 2 * np.pi * rng.random(len(d))
    helper = np.where(np.abs(axis[:, :1]) > 0.9, [[0.0, 1, 0]], [[1.0, 0, 0]])
    x = normalized(np.cross(axis, helper))
    y = np.cross(axis, x)
    radius = np.sqrt(radius2)
    on_sphere = (x * (radius * np.cos(phi))[:, None] + y * (radius * np.sin(phi))[:, None] +
                 axis * np.sqrt(1 - radius2)[:, None])
    m = normalized(on_sphere * stretch)
    return 2 * (m * back).sum(1)[:, None] * m - back


def walk_albedo(roughness, n_dot_v, walks, rng):
    s = roughness ** 2
    d = np.tile([np.sqrt(1 - n_dot_v ** 2), 0, -n_dot_v], (walks, 1))
    height = np.ones(walks)
    reflected = 0
    while len(d):
        extinction = np.sqrt(d[:, 0] ** 2 + d[:, 1] ** 2 + s * s * d[:, 2] ** 2)
        height = height - np.log1p(-rng.random(len(d))) / extinction * d[:, 2]
        reflected += (height > 1).sum()
        inside = (height >= 0) & (height <= 1)
        d, height = d[inside], height[inside]
        if len(d):
            d = scattered(d, s, rng)
    return reflected / walks


mp.dps = 40
choose = random.Random(8)
rows = []
for i in range(120):
    a = choose.choice(('0.0005', '0.003', '0.02', '0.1', '0.4', '0.9', '1.1'))
    tilt = choose.choice(('-0.18', '-0.15', '-0.05', '-0.001'))
    cosines = [choose.choice((choose.random(), choose.random() ** 3, 1e-3 * choose.random(),
                              1e-7 * choose.random(), 1 - 1e-5 * choose.random()))
               for _ in range(2)]
    inputs = [mpf(a), mpf(tilt)] + [mpf(f'{c:.9g}') for c in cosines]
    inputs.append(mpf(choose.choice(('1e-6', f'{choose.uniform(0.01, 3.1):.4f}'))))
    rows.append(dict(a=a, tilt=tilt, n_dot_l=digits(inputs[2], 10), n_dot_v=digits(inputs[3], 10),
                     phi=digits(inputs[4], 10), D=digits(distribution(*inputs)),
                     cond=mpmath.nstr(condition(distribution, inputs), 4)))

walks = []
for roughness in (0.03, 0.1, 0.2, 0.5, 0.8, 1.0):
    for n_dot_v in (0.01, 0.1, 0.4, 1.0):
        albedo = walk_albedo(roughness, n_dot_v, 800000, np.random.default_rng(len(walks)))
        walks.append(dict(roughness=roughness, n_dot_v=n_dot_v, R=round(albedo, 6)))

table = dict(precision='distribution: 30 digits; walks: standard error < 0.0006',
             distribution=rows, walks=walks)
with open(pathlib.Path(__file__).with_name('fuzz.json'), 'w', encoding='utf-8') as file:
    json.dump(table, file, indent=0)
    file.write('\n')
