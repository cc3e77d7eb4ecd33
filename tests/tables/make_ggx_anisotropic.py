#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes ggx_anisotropic.json, the reference values of src/brdf/ggx_anisotropic.h.

The published formulas as they stand, in 60 digits: Burley 2012, eq. 13, for the distribution, Heitz
2014, eq. 99 and 72, for shadowing with Lambda of the projected alpha, eq. 80. Directions are given by
n.x and the azimuth from the tangent, in the lobe's frame. `cond` is the sum of |x df/dx| / |f| over
alphas, cosines and azimuths. Needs python3-mpmath.
"""
import json
import pathlib
import random

import mpmath
from mpmath import mp, mpf


def direction(cosine, phi):
    sine = mpmath.sqrt(1 - cosine ** 2)
    return sine * mpmath.cos(phi), sine * mpmath.sin(phi), cosine


def distribution(alpha_x, alpha_y, n_dot_l, phi_l, n_dot_v, phi_v):
    u = [a + b for a, b in zip(direction(n_dot_l, phi_l), direction(n_dot_v, phi_v))]
    length2 = sum(x * x for x in u)
    term = ((u[0] / alpha_x) ** 2 + (u[1] / alpha_y) ** 2 + u[2] ** 2) / length2
    return 1 / (mp.pi * alpha_x * alpha_y * term ** 2)


def smith_lambda(alpha_x, alpha_y, cosine, phi):
    x, y, z = direction(cosine, phi)
    return (mpmath.sqrt(1 + ((alpha_x * x) ** 2 + (alpha_y * y) ** 2) / z ** 2) - 1) / 2


def correlated(alpha_x, alpha_y, n_dot_l, phi_l, n_dot_v, phi_v):
    total = (smith_lambda(alpha_x, alpha_y, n_dot_l, phi_l) +
             smith_lambda(alpha_x, alpha_y, n_dot_v, phi_v))
    return 1 / ((1 + total) * 4 * n_dot_l * n_dot_v)


def separable(alpha_x, alpha_y, n_dot_l, phi_l, n_dot_v, phi_v):
    return 1 / ((1 + smith_lambda(alpha_x, alpha_y, n_dot_l, phi_l)) *
                (1 + smith_lambda(alpha_x, alpha_y, n_dot_v, phi_v)) * 4 * n_dot_l * n_dot_v)


def pdf(alpha_x, alpha_y, n_dot_l, phi_l, n_dot_v, phi_v):
    """D G1(v) / (4 n.v)."""
    inputs = (alpha_x, alpha_y, n_dot_l, phi_l, n_dot_v, phi_v)
    return distribution(*inputs) / (
        (1 + smith_lambda(alpha_x, alpha_y, n_dot_v, phi_v)) * 4 * n_dot_v)


def condition(function, inputs):
    value = function(*inputs)
    total = mpf(0)
    for i, x in enumerate(inputs):
        step = x * mpf(10) ** -20
        moved = [list(inputs), list(inputs)]
        moved[0][i], moved[1][i] = x - step, x + step
        total += abs(x * (function(*moved[1]) - function(*moved[0])) / (2 * step) / value)
    return total


def digits(value, count=30):
    return mpmath.nstr(value, count, strip_zeros=False, min_fixed=-5, max_fixed=5)


mp.dps = 60
rng = random.Random(7)
rows = []
while len(rows) < 200:
    alpha_x = rng.choice((0.001, 0.01, 0.1, 0.3, 0.7, 1.0, 1.4142))
    alpha_y = float('%.4g' % (alpha_x * rng.choice((1.0, 0.7, 0.3, 0.1, 0.01, 0.0001))))
    cosines = [round(rng.choice((rng.random(), rng.random() ** 3, alpha_x * rng.random())), 7)
               for _ in range(2)]
    n_dot_l, n_dot_v = (min(max(c, 1e-7), 0.9999) for c in cosines)
    phi_v = round(rng.uniform(0.01, 6.28), 5)
    # Within a few widths of the mirror direction, or anywhere.
    phi_l = round(rng.uniform(0.01, 6.28), 5)
    if rng.random() < 0.6:
        n_dot_l = min(max(round(n_dot_v + alpha_x * rng.gauss(0, 1), 7), 1e-7), 0.9999)
        phi_l = round((phi_v + 3.14159 + alpha_y * rng.gauss(0, 2)) % 6.28318, 6) or 0.01
    texts = [repr(x) for x in (alpha_x, alpha_y, n_dot_l, phi_l, n_dot_v, phi_v)]
    inputs = [mpf(text) for text in texts]
    if distribution(*inputs) < mpf(10) ** -30:
        continue
    row = dict(zip(('alpha_x', 'alpha_y', 'n_dot_l', 'phi_l', 'n_dot_v', 'phi_v'), texts))
    for name, function in (('D', distribution), ('V_correlated', correlated),
                           ('V_separable', separable), ('pdf', pdf)):
        row[name] = digits(function(*inputs))
        row['cond_' + name] = mpmath.nstr(condition(function, inputs), 4)
    rows.append(row)

table = dict(precision='30 digits', rows=rows)
with open(pathlib.Path(__file__).with_name('ggx_anisotropic.json'), 'w', encoding='utf-8') as file:
    json.dump(table, file, indent=0)
    file.write('\n')
