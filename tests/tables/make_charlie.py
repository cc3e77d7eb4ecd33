#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes charlie.json, the reference values of src/brdf/sheen.h: tests/tables/make_charlie.py.

Charlie's lobe (Estevez and Kulla 2017; KHR_materials_sheen) from the published formulas as they
stand, in 40 digits: cosines are above where nacre departs from them. `cond` is the sum of
|x df/dx| / |f| over roughness, n.l, n.v and the azimuth between light and viewer. Albedos are
integrals by Gauss-Legendre rules in 20 digits. Needs python3-mpmath; takes some minutes.
"""
import json
import pathlib
import random

import mpmath
from mpmath import mp, mpf

COEFFICIENTS = (('25.3245', '21.5473'), ('3.32435', '3.82987'), ('0.16801', '0.19823'),
                ('-1.27393', '-1.97760'), ('-4.85967', '-4.32054'))


def log_lambda(x, alpha):
    smooth = (1 - alpha) ** 2
    a, b, c, d, e = (smooth * mpf(at_0) + (1 - smooth) * mpf(at_1) for at_0, at_1 in COEFFICIENTS)
    return a / (1 + b * x ** c) + d * x + e


def big_lambda(x, alpha):
    half = mpf(1) / 2
    if x < half:
        return mpmath.exp(log_lambda(x, alpha))
    return mpmath.exp(2 * log_lambda(half, alpha) - log_lambda(1 - x, alpha))


def distribution(roughness, n_dot_l, n_dot_v, phi):
    alpha = roughness ** 2
    sin_l, sin_v = mpmath.sqrt(1 - n_dot_l ** 2), mpmath.sqrt(1 - n_dot_v ** 2)
    across2 = sin_l ** 2 + sin_v ** 2 + 2 * sin_l * sin_v * mpmath.cos(phi)
    sin2 = across2 / (across2 + (n_dot_l + n_dot_v) ** 2)
    return (2 + 1 / alpha) * sin2 ** (1 / (2 * alpha)) / (2 * mp.pi)


def visibility(roughness, n_dot_l, n_dot_v):
    alpha = roughness ** 2
    return 1 / ((1 + big_lambda(n_dot_v, alpha) + big_lambda(n_dot_l, alpha)) *
                4 * n_dot_v * n_dot_l)


def lobe(roughness, n_dot_l, n_dot_v, phi):
    return (distribution(roughness, n_dot_l, n_dot_v, phi) *
            visibility(roughness, n_dot_l, n_dot_v))


def condition(function, inputs):
    value = function(*inputs)
    total = mpf(0)
    for i, x in enumerate(inputs):
        step = x * mpf(10) ** -12
        moved = [list(inputs), list(inputs)]
        moved[0][i], moved[1][i] = x - step, x + step
        total += abs(x * (function(*moved[1]) - function(*moved[0])) / (2 * step) / value)
    return total


def panels(finest, breaks):
    """Nodes and weights on panels that double from 0 and end at each of `breaks`."""
    x, w = GAUSS
    edges = [mpf(0)]
    edge = finest
    for end in breaks:
        while edge < end * 0.7:
            edges.append(edge)
            edge *= 2
        edges.append(mpf(end))
        edge = mpf(end) * 2
    for begin, end in zip(edges, edges[1:]):
        for node, weight in zip(x, w):
            yield begin + (end - begin) * (1 + node) / 2, (end - begin) * weight / 2


def legendre_rule(points):
    nodes, weights = [], []
    for i in range(points):
        x = mpmath.cos(mp.pi * (i + mpf(3) / 4) / (points + mpf(1) / 2))
        for _ in range(8):  # Newton's: quadratic from four digits
            before, value = mpf(1), x
            for n in range(2, points + 1):
                before, value = value, ((2 * n - 1) * x * value - (n - 1) * before) / n
            slope = points * (x * value - before) / (x * x - 1)
            x -= value / slope
        nodes.append(x)
        weights.append(2 / ((1 - x * x) * slope * slope))
    return nodes, weights


def albedo(roughness, n_dot_v):
    # Lambda bends at 1/2 and has a root of a low order at 1.
    total = mpf(0)
    azimuths = list(panels(mpf(1) / 64, [mp.pi]))
    half = list(panels(mpf(2) ** -30, [mpf(1) / 2]))
    for n_dot_l, weight in half + [(1 - x, w) for x, w in half]:
        ring = sum(w * distribution(roughness, n_dot_l, n_dot_v, mp.pi - phi)
                   for phi, w in azimuths)
        total += weight * n_dot_l * visibility(roughness, n_dot_l, n_dot_v) * 2 * ring
    return total


def digits(value, count=30):
    return mpmath.nstr(value, count, strip_zeros=False, min_fixed=-5, max_fixed=5)


mp.dps = 40
rng = random.Random(5)
rows = []
for i in range(120):
    roughness = rng.choice((0.02, 0.05, 0.1, 0.2, 0.35, 0.5, 0.7, 0.9, 1.0))
    cosines = [round(rng.choice((rng.random(), rng.random() ** 3, roughness * rng.random())), 6)
               for _ in range(2)]
    cosines = [min(max(c, 0.0002), 0.999) for c in cosines]
    inputs = [mpf(str(x)) for x in (roughness, *cosines, round(rng.uniform(0.01, 3.1), 4))]
    value = lobe(*inputs)
    if value < mpf(10) ** -30:
        continue
    rows.append(dict(roughness=str(roughness), n_dot_l=str(inputs[1]), n_dot_v=str(inputs[2]),
                     phi=str(inputs[3]), D=digits(distribution(*inputs)),
                     V=digits(visibility(*inputs[:3])), DV=digits(value),
                     cond=mpmath.nstr(condition(lobe, inputs), 4)))

mp.dps = 20
GAUSS = legendre_rule(10)
albedos = []
for roughness in ('0.1', '0.3', '0.5', '1'):
    for n_dot_v in ('0.01', '0.1', '0.5', '0.9'):
        albedos.append(dict(roughness=roughness, n_dot_v=n_dot_v,
                            E=digits(albedo(mpf(roughness), mpf(n_dot_v)), 10)))

table = dict(precision='lobe: 30 digits; E: absolute error < 1e-8', lobe=rows, albedo=albedos)
with open(pathlib.Path(__file__).with_name('charlie.json'), 'w', encoding='utf-8') as file:
    json.dump(table, file, indent=0)
    file.write('\n')
