#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes thin_film.json, the reference values of thin films: tests/tables/make_thin_film.py.

Airy's sum from Fresnel's amplitudes as textbooks have it (Born and Wolf, 7.6.1), in 60 digits, where
nacre multiplies characteristic matrices. `cond` is the sum of |x df/dx| / |f| over all inputs, of
1 - R. Colours are integrals over the spectrum by Gauss-Legendre rules between the wavelengths of the
CIE's tables, which are read from src/brdf/visible_spectrum.cc, and averages are integrals over the
hemisphere. Needs python3-mpmath; takes some minutes.
"""
import json
import pathlib
import random
import re

import mpmath
from mpmath import mp, mpc, mpf

ROOT = pathlib.Path(__file__).parents[2]


def root(x):
    """The square root whose imaginary part is not positive: waves decay as exp(-i q z)."""
    value = mpmath.sqrt(x)
    return -value if value.imag > 0 else value


def amplitudes(q1, q2, n1, n2):
    """Of s and of p, from q = n cos(theta) on either side."""
    return (q1 - q2) / (q1 + q2), (n2 ** 2 * q1 - n1 ** 2 * q2) / (n2 ** 2 * q1 + n1 ** 2 * q2)


def reflectances(outside, index, thickness, eta, k, cosine, wavelength):
    """|r|^2 of s and of p."""
    below = mpc(eta, -k)
    sine2 = outside ** 2 * (1 - cosine ** 2)
    q = [root(mpc(n) ** 2 - sine2) for n in (outside, index, below)]
    first = amplitudes(q[0], q[1], outside, index)
    second = amplitudes(q[1], q[2], index, below)
    crossed_twice = mpmath.exp(-4j * mp.pi * thickness * q[1] / wavelength)
    return [abs((a + b * crossed_twice) / (1 + a * b * crossed_twice)) ** 2
            for a, b in zip(first, second)]


def loss(*film):
    s, p = reflectances(*film)
    return (1 - s + 1 - p) / 2


def condition(function, inputs):
    value = function(*inputs)
    total = mpf(0)
    for i, x in enumerate(inputs):
        step = x * mpf(10) ** -20
        if step == 0 or value == 0:
            continue
        moved = [list(inputs), list(inputs)]
        moved[0][i], moved[1][i] = x - step, x + step
        if i == 5 and moved[1][i] > 1:
            moved[1][i] = x
        slope = (function(*moved[1]) - function(*moved[0])) / (moved[1][i] - moved[0][i])
        total += abs(x * slope / value)
    return total


def digits(value, count=30):
    return mpmath.nstr(value, count, strip_zeros=False, min_fixed=-5, max_fixed=5)


def legendre_rule(points):
    nodes, weights = [], []
    for i in range(points):
        x = mpmath.cos(mp.pi * (i + mpf(3) / 4) / (points + mpf(1) / 2))
        for _ in range(9):  # Newton's: quadratic from four digits
            before, value = mpf(1), x
            for n in range(2, points + 1):
                before, value = value, ((2 * n - 1) * x * value - (n - 1) * before) / n
            slope = points * (x * value - before) / (x * x - 1)
            x -= value / slope
        nodes.append(x)
        weights.append(2 / ((1 - x * x) * slope * slope))
    return nodes, weights


def read_table(name, columns):
    source = (ROOT / 'src/brdf/visible_spectrum.cc').read_text(encoding='utf-8')
    body = re.search(name + r'\[kTableSize\](?:\[3\])? = \{(.*?)\};', source, re.DOTALL).group(1)
    numbers = [mpf(x) for x in re.findall(r'[0-9][0-9.e-]*', body)]
    assert len(numbers) == 95 * columns
    return [numbers[i:i + columns] for i in range(0, len(numbers), columns)]


def natural_spline(values):
    """Second derivatives in units of the step, by elimination."""
    n = len(values)
    above, right = [mpf(0)] * n, [mpf(0)] * n
    for i in range(1, n - 1):
        pivot = 4 - above[i - 1]
        above[i] = 1 / pivot
        right[i] = (6 * (values[i + 1] - 2 * values[i] + values[i - 1]) - right[i - 1]) / pivot
    bends = [mpf(0)] * n
    for i in range(n - 2, 0, -1):
        bends[i] = right[i] - above[i] * bends[i + 1]
    return bends


def sensitivities():
    """Wavelengths with weights of the channels, for both lights, at the nodes of all panels."""
    observer, d65 = read_table('kObserver', 3), [row[0] for row in read_table('kD65', 1)]
    xyz_of = mpmath.matrix([[mpf('0.64'), mpf('0.30'), mpf('0.15')],
                            [mpf('0.33'), mpf('0.60'), mpf('0.06')],
                            [mpf('0.03'), mpf('0.10'), mpf('0.79')]])
    rgb_of = xyz_of ** -1  # but for the scale of each row
    channels = [[sum(rgb_of[c, j] * row[j] for j in range(3)) for row in observer]
                for c in range(3)]
    bends = [natural_spline(channel) for channel in channels]
    found = {'equal_energy': [], 'd65': []}
    for i in range(94):
        for x, w in zip(*RULE):
            t = (1 + x) / 2
            u = 1 - t
            values = [u * channels[c][i] + t * channels[c][i + 1] +
                      ((u ** 3 - u) * bends[c][i] + (t ** 3 - t) * bends[c][i + 1]) / 6
                      for c in range(3)]
            wavelength = 360 + 5 * (i + t)
            power = u * d65[i] + t * d65[i + 1]
            found['equal_energy'].append((wavelength, [w * v for v in values]))
            found['d65'].append((wavelength, [w * v * power for v in values]))
    for rows in found.values():
        total = [sum(weights[c] for _, weights in rows) for c in range(3)]
        for _, weights in rows:
            for c in range(3):
                weights[c] /= total[c]
    return found


def colour(light, outside, index, thickness, eta, k, cosine):
    total = [mpf(0)] * 3
    for wavelength, weights in SENSITIVITIES[light]:
        value = loss(outside, index, thickness, eta, k, cosine, wavelength)
        for c in range(3):
            total[c] += weights[c] * value
    return total


def average(outside, index, thickness, eta, k, wavelength):
    """2 int (1 - R) c dc in the root of the distance from the critical cosine."""
    critical = mpmath.sqrt(1 - (eta / outside) ** 2) if k == 0 and eta < outside else mpf(0)
    end = mpmath.sqrt(1 - critical)

    def integrand(x):
        cosine = critical + x * x
        return 4 * x * cosine * loss(outside, index, thickness, eta, k, cosine, wavelength)
    return mpmath.quad(integrand, mpmath.linspace(0, end, 9))


NAMES = ('outside', 'index', 'thickness', 'eta', 'k', 'cosine', 'wavelength')
rng = random.Random(9)


def text(x, places):
    return str(round(x, places))


def random_film(kind):
    outside = {'air': 1.0, 'coat': 1.6, 'water': 1.333}[kind]
    eta, k = rng.choice(((1.5, 0), (rng.uniform(1.02, 2.4), 0), (1.0, 0), (0.8, 5.5), (0.05, 3.2),
                         (rng.uniform(0.1, 4), rng.uniform(0.1, 8))))
    index = rng.choice((1.4, rng.uniform(1.05, 2.6), outside, eta if k == 0 else 2.2))
    thickness = rng.choice((0, rng.uniform(1, 60), rng.uniform(60, 900), rng.uniform(900, 10000)))
    cosine = rng.choice((1, rng.random(), rng.random(), rng.random() ** 4, 1e-6))
    return [text(outside, 4), text(index, 4), text(thickness, 2), text(eta, 4), text(k, 4),
            text(cosine, 7)]


mp.dps = 60
airy = []
while len(airy) < 160:
    inputs = random_film(rng.choice(('air', 'air', 'coat', 'water')))
    inputs.append(text(rng.uniform(380, 750), 2))
    numbers = [mpf(x) for x in inputs]
    if numbers[0] == numbers[1] == numbers[3] and numbers[4] == 0:
        continue  # no interface
    value = loss(*numbers)
    if abs(value) < mpf(10) ** -50:
        value = mpf(0)  # total reflection
    reflected = sum(reflectances(*numbers)) / 2
    cond = condition(loss, numbers) if value else mpf(0)
    airy.append(dict(zip(NAMES, inputs), R=digits(reflected), loss=digits(value),
                     cond=mpmath.nstr(cond, 4)))

mp.dps = 24
RULE = legendre_rule(12)
SENSITIVITIES = sensitivities()
spectral = []
while len(spectral) < 44:
    inputs = random_film(rng.choice(('air', 'coat')))
    numbers = [mpf(x) for x in inputs]
    if numbers[0] == numbers[1] == numbers[3] and numbers[4] == 0:
        continue
    light = rng.choice(('equal_energy', 'equal_energy', 'd65'))
    rgb = colour(light, *numbers)
    if len(spectral) % 2 == 0 and max(abs(c) for c in rgb) < mpf(10) ** -6:
        continue  # half of the rows may be dark
    spectral.append(dict(zip(NAMES, inputs), light=light, loss=[digits(c, 18) for c in rgb]))

averages = []
for inputs in (('1', '1.4', '400', '1.5', '0', '620'), ('1', '2', '150', '1.5', '0', '450'),
               ('1', '1.8', '800', '0.2', '3.4', '540'), ('1.6', '1.4', '120', '1.5', '0', '540'),
               ('1.6', '1.4', '120', '1.3', '0', '540'), ('1', '1.33', '500', '1', '0', '450'),
               ('1', '1.5', '0', '1.5', '0', '540')):
    numbers = [mpf(x) for x in inputs]
    averages.append(dict(zip(NAMES[:5] + NAMES[6:], inputs), loss=digits(average(*numbers), 15)))

table = dict(precision='airy: 30 digits; spectral: absolute error < 1e-9; average: 1e-12',
             airy=airy, spectral=spectral, average=averages)
with open(pathlib.Path(__file__).with_name('thin_film.json'), 'w', encoding='utf-8') as file:
    json.dump(table, file, indent=0)
    file.write('\n')
