#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Prints the polynomial coefficients and tables of src/base/{math,trig}-inl.h and their errors.

Interpolates at Chebyshev nodes in exact rational arithmetic, then rounds to float. The error
printed is that of the rounded polynomial, evaluated exactly, over a dense grid.
"""
import decimal
import math
import struct
from fractions import Fraction


def to_float(x):
    return struct.unpack('f', struct.pack('f', float(x)))[0]


def fit(function, low, high, degree):
    """Coefficients, lowest first, of the interpolant at the Chebyshev nodes of [low, high]."""
    count = degree + 1
    nodes = [Fraction((low + high) / 2 + (high - low) / 2 * math.cos(math.pi * (2 * i + 1) / (2 * count)))
             for i in range(count)]
    divided = [Fraction(function(float(x))) for x in nodes]
    for order in range(1, count):
        for i in range(count - 1, order - 1, -1):
            divided[i] = (divided[i] - divided[i - 1]) / (nodes[i] - nodes[i - order])
    polynomial = [Fraction(0)]
    for i in range(count - 1, -1, -1):  # Horner over Newton's form
        shifted = [Fraction(0)] + polynomial
        polynomial = [a - nodes[i] * b for a, b in zip(shifted, polynomial + [Fraction(0)])]
        polynomial[0] += divided[i]
    return polynomial[:count]


def show(name, function, low, high, degree):
    coefficients = [to_float(c) for c in fit(function, low, high, degree)]
    worst = 0.0
    for i in range(20001):
        x = low + (high - low) * i / 20000
        value = math.fsum(c * x ** k for k, c in enumerate(coefficients))
        worst = max(worst, abs(value / function(x) - 1))
    print(f'{name}: degree {degree} on [{low:.6g}, {high:.6g}], relative error {worst:.2g}')
    print('  {' + ', '.join(f'{c:.9g}f' for c in coefficients) + '}')


def log2_over_f(f):
    return math.log1p(f) / math.log(2) / f if abs(f) > 1e-9 else 1 / math.log(2)


show('log2(1 + f) / f', log2_over_f, math.sqrt(0.5) - 1, math.sqrt(2) - 1, 9)
show('2^f', lambda f: 2.0 ** f, -0.5, 0.5, 6)


def float_steps(x, steps):
    return struct.unpack('f', struct.pack('I', struct.unpack('I', struct.pack('f', x))[0] + steps))[0]


def log2(x):
    return decimal.Decimal(x).ln() / decimal.Decimal(2).ln()


def log_tables():
    """Of each 32nd m of [1/2, 1) a float s about 1 / m, of 6000 the one whose 1 - log2(s) is nearest
    to a float; 1 for the last."""
    scales, logs, worst, least, most = [], [], 0, 0, 0
    for i in range(16):
        low, high = 0.5 + i / 32, 0.5 + (i + 1) / 32
        about = to_float(2 / (low + high))
        candidates = [float_steps(about, k) for k in range(-3000, 3000)] if i < 15 else [1.0]
        exact = {s: 1 - log2(s) for s in candidates}
        scale = min(candidates, key=lambda s: abs(decimal.Decimal(to_float(exact[s])) - exact[s]))
        scales.append(scale)
        logs.append(to_float(exact[scale]))
        worst = max(worst, abs(decimal.Decimal(logs[-1]) - exact[scale]))
        least, most = min(least, scale * low - 1), max(most, scale * high - 1)
    return scales, logs, worst, least, most


def show_table(name, numbers):
    print(f'{name}\n  {{' + ', '.join(f'{x:.9g}f' for x in numbers) + '}')


SCALES, LOGS, WORST, LEAST, MOST = log_tables()
show_table('s', SCALES)
show_table(f'1 - log2(s), error 2^{math.log2(WORST):.1f}', LOGS)
show(f'log2(1 + f) / f for s m - 1 from {LEAST:.6g} to {MOST:.6g}', log2_over_f, -1 / 32, 0.0304, 3)
show_table('2^(k / 16)', [to_float(2 ** (k / 16)) for k in range(16)])
show_table('and what that is rounded by', [
    decimal.Decimal(2) ** (decimal.Decimal(k) / 16) - decimal.Decimal(to_float(2 ** (k / 16)))
    for k in range(16)])
show('(2^f - 1) / f', lambda f: math.expm1(f * math.log(2)) / f if abs(f) > 1e-9 else math.log(2),
     -1 / 32, 1 / 32, 2)


def atan_remainder(z):
    x = math.sqrt(z)
    if z > 0.05:
        return (x - math.atan(x)) / x ** 3
    return math.fsum((-z) ** k / (2 * k + 3) for k in range(16))


def half_pi_sine(z):
    x = math.sqrt(z)
    return math.sin(math.pi / 2 * x) / x if x > 1e-9 else math.pi / 2


print('src/base/trig-inl.h:')
show('sin(pi/2 x) / x in x^2', half_pi_sine, 0, 0.25, 4)
show('cos(pi/2 x) in x^2', lambda z: math.cos(math.pi / 2 * math.sqrt(z)), 0, 0.25, 4)
show('(x - atan x) / x^3 in x^2', atan_remainder, 0, 1, 8)
