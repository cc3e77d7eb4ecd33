#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes src/brdf/fuzz_fit.h, the constants of the fuzz lobe of src/brdf/fuzz.h.

The lobe stands for a layer of upright fibres (Zeltner, Burley and Chiang 2022, "Practical
Multiple-Scattering Sheen Using Linearly Transformed Cosines", the variant "volume"): unit
thickness, unit density, no absorption, and specular SGGX microflakes (Heitz et al. 2015) of a fibre
along the normal, whose matrix is diag(1, 1, s^2) with s = roughness^2. The paper simulates random
walks of up to 16 events. Here the layer is solved without noise, for light of all orders:
directions are Gauss-Legendre nodes of the cosine times Fourier modes of the azimuth, and a layer so
thin that light scatters in it at most once is doubled until its thickness is 1 (van de Hulst 1963).
Where the scattering is too narrow for the nodes, what they miss is added to light that goes
straight on.

To what the layer reflects of light from each direction the transformed cosine is fitted as in the
paper: its albedo is that of the layer, and a and b minimise the cube of the difference over
elevation and azimuth. Polynomials in two variables, which expand grazing angles and small
roughnesses, are fitted to the results; their form is that of FuzzFromView in src/brdf/fuzz.h.

fit_fuzz.py                writes the header to standard output, and the errors to standard error
fit_fuzz.py --check FILE   also compares the layer and the fit with the paper's table, the file
                           fitting/python/data/ltc_table_sheen_volume.npy of its authors' code

Needs python3-numpy; takes a minute.
"""
import sys

import numpy as np

TERMS = 8  # in each variable
LEAST_ROUGHNESS = 0.01
MODES = 24
AZIMUTHS = (np.arange(48) + 0.5) / 48 * np.pi


def legendre_panels(edges, points):
    """Nodes and weights of Gauss-Legendre rules between the edges."""
    x, w = np.polynomial.legendre.leggauss(points)
    edges = np.asarray(edges, dtype=float)
    length = np.diff(edges)[:, None]
    return (edges[:-1, None] + length * (x + 1) / 2).ravel(), (length * w / 2).ravel()


def cosines(s):
    """Nodes in [0, 1] that are densest at 0, where light grazes fibres of width s."""
    edges = [0.0, min(s, 0.05) * 0.05]
    while edges[-1] * 3.2 < 0.4:
        edges.append(edges[-1] * 3.2)
    count = max(2, round(np.log(1 / edges[-1]) / np.log(2.2)))
    return legendre_panels(edges + list(np.geomspace(edges[-1], 1, count + 1)[1:]), 7)


def around(center, finest):
    """Nodes in [0, 1] on panels that double from `finest` on both sides of `center`."""
    nodes, weights = [], []
    for sign, end in ((-1, center), (1, 1 - center)):
        edges = [0.0]
        edge = finest
        while edge < end / 1.5:
            edges.append(edge)
            edge *= 2
        x, w = legendre_panels(edges + [end], 8)
        nodes.append(center + sign * x)
        weights.append(w)
    return np.clip(np.concatenate(nodes), 0, 1), np.concatenate(weights)


def scattering_modes(cosine, cosine_out, turns_back, s):
    """Fourier modes over the azimuth of D(h) / 4, the scattering per length and solid angle.

    Light goes down with a cosine, and on with cosine_out, up where it turns back. h is the half
    vector of where it comes from and where it goes to, and D of SGGX is
    s^3 / (pi (s^2 sin^2 + cos^2)^2) of h. The modes are the first axis.
    """
    points = 96
    psi = (np.arange(points) + 0.5) / points * np.pi
    cosine, cosine_out = np.asarray(cosine)[..., None], np.asarray(cosine_out)[..., None]
    sin = np.sqrt((1 - cosine) * (1 + cosine))
    sin_out = np.sqrt((1 - cosine_out) * (1 + cosine_out))
    along = cosine + cosine_out if turns_back else cosine - cosine_out
    across2 = (sin - sin_out) ** 2 + 4 * sin * sin_out * np.sin(psi / 2) ** 2
    ratio = (across2 + along ** 2) / np.maximum(s * s * across2 + along ** 2, 1e-300)
    integrals = np.cos(np.arange(MODES)[:, None] * psi) * (2 * np.pi / points)
    return np.moveaxis(s ** 3 * ratio ** 2 / (4 * np.pi) @ integrals.T, -1, 0)


def simulate(roughness):
    """Cosines, weights, and reflected[mode, to, from] of light, with the fraction lost to errors."""
    s = roughness ** 2
    mu, weight = cosines(s)
    to, source = mu[:, None], mu[None, :]
    back = scattering_modes(source, to, True, s)
    on = scattering_modes(source, to, False, s)
    extinction = np.sqrt((1 - mu) * (1 + mu) + s * s * mu * mu)  # the projected area of SGGX
    for i in range(len(mu)):
        x, w = around(mu[i], min(s, 0.1) / 64)
        total = np.tensordot(scattering_modes(mu[i], x, False, s), w, (1, 0))
        total[0] = extinction[i] - back[0, :, i] @ weight  # nothing is absorbed
        others = on[:, :, i] @ weight - on[:, i, i] * weight[i]
        on[:, i, i] = (total - others) / weight[i]
    # A layer in which light scatters at most once.
    doublings = int(np.ceil(-np.log2(0.01 * mu[0]))) + 8
    thickness = 2.0 ** -doublings
    rate = extinction / mu
    rate_to, rate_from = rate[:, None], rate[None, :]
    into = weight[:, None] / mu[None, :]
    both = rate_to + rate_from
    reflected = back * into * (-np.expm1(-thickness * both) / both)
    difference = rate_to - rate_from
    same = np.abs(difference) * thickness < 1e-9
    path = np.where(same, thickness,
                    -np.expm1(-difference * thickness) / np.where(same, 1, difference))
    passed = on * into * np.exp(-rate_from * thickness) * path + np.diag(np.exp(-rate * thickness))
    for _ in range(doublings):
        # passed (1 - reflected^2)^-1, by the transposed equation.
        between = np.eye(len(mu)) - reflected @ reflected
        through = np.swapaxes(
            np.linalg.solve(np.swapaxes(between, 1, 2), np.swapaxes(passed, 1, 2)), 1, 2)
        reflected, passed = reflected + through @ reflected @ passed, through @ passed
    lost = np.abs(1 - reflected[0].sum(0) - passed[0].sum(0)).max()
    return mu, weight, reflected, lost


def lobe(a, tilt, n_dot_v, n_dot_l):
    """The transformed cosine, with b = tilt sin(theta_v), in rows of n.l and columns of AZIMUTHS."""
    sin_v, sin_l = np.sqrt((1 - n_dot_v) * (1 + n_dot_v)), np.sqrt((1 - n_dot_l) * (1 + n_dot_l))
    sin_l, n_dot_l = sin_l[:, None], n_dot_l[:, None]
    length2 = a * a * sin_l ** 2 + 2 * a * tilt * n_dot_l * sin_v * sin_l * np.cos(AZIMUTHS) + \
        (1 + (tilt * sin_v) ** 2) * n_dot_l ** 2
    return n_dot_l * (a / length2) ** 2 / np.pi


def minimise(function, start, steps):
    """The simplex of Nelder and Mead 1965, in two variables."""
    x = np.array([start, [start[0] + steps[0], start[1]], [start[0], start[1] + steps[1]]])
    y = np.array([function(p) for p in x])
    for _ in range(120):
        order = np.argsort(y)
        x, y = x[order], y[order]
        if np.abs(x[1:] - x[0]).max() < 1e-5:
            break
        center = (x[0] + x[1]) / 2
        tries = [2 * center - x[2]]
        values = [function(tries[0])]
        if values[0] < y[0]:
            tries.append(3 * center - 2 * x[2])
        elif values[0] >= y[1]:
            tries.append((center + (tries[0] if values[0] < y[2] else x[2])) / 2)
        values += [function(p) for p in tries[1:]]
        best = int(np.argmin(values))
        if values[best] < y[2]:
            x[2], y[2] = tries[best], values[best]
        else:
            x[1:] = x[0] + (x[1:] - x[0]) / 2
            y[1:] = [function(p) for p in x[1:]]
    return x[0], y[0]


def fit_cosines(mu, weight, reflected):
    """Albedo, a and tilt at each cosine to the viewer; of hardly any light, those of the last."""
    albedo = reflected[0].sum(0)
    modes = np.arange(MODES)[:, None]
    # Light goes down opposite to the azimuth that it comes from.
    series = np.cos(modes * (AZIMUTHS + np.pi)) * np.where(modes > 0, 1, 0.5) / np.pi
    area = (weight / np.sqrt((1 - mu) * (1 + mu)))[:, None]  # of elevation and azimuth
    fits = []
    for i, n_dot_v in enumerate(mu):
        if albedo[i] < 1e-7:
            fits.append(fits[-1])
            continue
        layer = reflected[:, :, i].T @ series / weight[:, None]

        def cube(p):
            return (np.abs(albedo[i] * lobe(np.exp(p[0]), p[1], n_dot_v, mu) - layer) ** 3 *
                    area).sum()

        starts = [(np.log(0.1), -0.1), (np.log(0.5), -0.05)]
        if fits:
            starts = [(np.log(fits[-1][0]), fits[-1][1])] + (starts if i % 4 == 0 else [])
        best = min((minimise(cube, start, (0.3, 0.05)) for start in starts), key=lambda m: m[1])[0]
        fits.append((np.exp(best[0]), best[1]))
    a, tilt = np.array(fits).T
    return albedo, a, tilt


def to_the_ends(mu, roughness, *curves):
    """The cosines 0 and 1 added to the nodes, and some next to 0, where x still changes."""
    ends = mu[0] * np.array([0, 0.001, 0.03])
    slope = (1 - mu[-1]) / (mu[-1] - mu[-2])
    cosine = np.concatenate([ends, mu, [1]])
    extended = tuple(
        np.concatenate([np.full(3, c[0]), c, [c[-1] * (c[-1] / c[-2]) ** slope]]) for c in curves)
    return (cosine, np.full(len(cosine), roughness)) + extended


def variables(n_dot_v, roughness):
    """Those of FuzzFromView and MakeFuzz, in [-1, 1]."""
    fourth = np.sqrt(np.sqrt(roughness))
    offset = 2 * roughness * fourth
    x = 2 * (n_dot_v * (1 + offset) / (n_dot_v + offset)) ** 0.25 - 1
    least = LEAST_ROUGHNESS ** 0.25
    return x, 2 * (fourth - least) / (1 - least) - 1


def basis(n_dot_v, roughness):
    x, y = variables(n_dot_v, roughness)
    return np.polynomial.chebyshev.chebvander2d(x, y, (TERMS - 1, TERMS - 1))


def evened(columns, target, weight, rounds):
    """Least squares whose weights rise where the error is largest (Lawson 1961)."""
    rise = np.ones(len(target))
    best = None
    for _ in range(rounds):
        row = weight * np.sqrt(rise)
        solution = np.linalg.lstsq(columns * row[:, None], target * row, rcond=None)[0]
        error = np.abs(columns @ solution - target) * weight
        if best is None or error.max() < best[0]:
            best = error.max(), solution
        rise *= error / error.max() + 1e-4
        rise /= rise.mean()
    return best[1]


def evened_exponential(columns, target, weight, solution):
    """The same of exp(columns solution), by Levenberg's and Marquardt's steps."""
    ridge = 1e-8  # keeps the logarithm of an albedo of 0 where it is
    logarithm = np.log(np.maximum(target, 1e-6))
    rise = np.ones(len(target))
    damping = 1e-3
    best = None
    for _ in range(30):
        row = weight * np.sqrt(rise)

        def residuals(c):
            power = columns @ c
            return np.concatenate([row * (np.exp(np.minimum(power, 50)) - target),
                                   np.sqrt(ridge) * (power - logarithm)])

        for _ in range(6):
            now = residuals(solution)
            value = np.exp(columns @ solution)
            jacobian = np.concatenate([(row * value)[:, None] * columns, np.sqrt(ridge) * columns])
            square = jacobian.T @ jacobian
            for _ in range(12):
                step = np.linalg.solve(square + damping * np.diag(np.diag(square)),
                                       -jacobian.T @ now)
                if (residuals(solution + step) ** 2).sum() < (now ** 2).sum():
                    solution = solution + step
                    damping = max(damping / 5, 1e-12)
                    break
                damping *= 4
        error = np.abs(np.exp(columns @ solution) - target) * weight
        if best is None or error.max() < best[0]:
            best = error.max(), solution
        rise *= error / error.max() + 0.02
        rise /= rise.mean()
    return best[1]


def powers(solution):
    """Of Chebyshev's polynomials in both variables, the coefficients of powers."""
    to_powers = np.zeros((TERMS, TERMS))
    for i in range(TERMS):
        row = np.polynomial.chebyshev.cheb2poly(np.eye(TERMS)[i])
        to_powers[i, :len(row)] = row
    table = to_powers.T @ solution.reshape(TERMS, TERMS) @ to_powers
    return np.array([[float(f'{c:.9g}') for c in row] for row in table])


def evaluate(tables, n_dot_v, roughness):
    """Albedo, a and tilt, as FuzzFromView computes them."""
    x, y = np.broadcast_arrays(*variables(n_dot_v, np.maximum(roughness, LEAST_ROUGHNESS)))
    log_albedo, log_a, tilt = (np.polynomial.polynomial.polyval2d(x, y, table) for table in tables)
    return np.minimum(np.exp(log_albedo), 1), np.exp(log_a), (1 - roughness) * tilt


def report(name, error):
    print(f'{name}: rms {np.sqrt((error ** 2).mean()):.2g}, worst {np.abs(error).max():.2g}',
          file=sys.stderr)


def check(tables, file):
    paper = np.load(file)  # n.v, roughness, (a, b, R)
    steps = np.maximum(LEAST_ROUGHNESS, np.linspace(0, 1, 32))
    layer, fit = np.zeros((32, 32, 3)), np.zeros((32, 32, 3))
    for k, roughness in enumerate(steps):
        mu, weight, reflected, _ = simulate(roughness)
        albedo, a, tilt = fit_cosines(mu, weight, reflected)
        sin = np.sqrt(1 - steps ** 2)
        order = (np.interp(steps, mu, a), np.interp(steps, mu, tilt) * sin,
                 np.interp(steps, mu, albedo))
        layer[:, k] = np.transpose(order)
        albedo, a, tilt = evaluate(tables, steps, roughness)
        fit[:, k] = np.transpose((a, tilt * sin, albedo))
    lit = paper[:, :, 2] > 0.01
    for least in (0, 0.2):
        part = lit & (steps >= least)[None, :]
        for i, name in enumerate(('a', 'b', 'R')):
            for what, ours in (('layer', layer), ('fit', fit)):
                report(f'roughness from {least}: {name} of the {what} less the paper\'s',
                       (ours - paper)[part][:, i])


def main():
    y = (1 - np.cos(np.linspace(0, np.pi, 40))) / 2
    rows = []
    for roughness in (0.1 + 0.9 * y) ** 2:
        mu, weight, reflected, lost = simulate(roughness)
        assert lost < 1e-4
        rows.append(to_the_ends(mu, roughness, *fit_cosines(mu, weight, reflected)))
    n_dot_v, roughness, albedo, a, tilt = (np.concatenate(column) for column in zip(*rows))
    columns = basis(n_dot_v, roughness)
    # Fuzz of roughness 0.01 to 0.1 shows at the very edge of things alone.
    rough = 1 + 2 * np.clip((roughness - 0.02) / 0.1, 0, 1)
    start = evened(columns, np.log(np.maximum(albedo, 1e-5)), np.maximum(albedo, 1e-3) * rough, 3)
    # Of the light that is reflected, and for a good shape also where that is a hundredth.
    weight = (albedo + 0.2 * np.minimum(albedo / 0.01, 1) + 0.01) * rough
    tables = [powers(evened_exponential(columns, albedo, rough, start)),
              powers(evened(columns, np.log(a), weight, 60)),
              powers(evened((1 - roughness)[:, None] * columns, tilt, weight + 0.05, 60))]
    fit = evaluate(tables, n_dot_v, roughness)
    for least in (0, 0.06, 0.2):
        part = roughness >= least
        report(f'roughness from {least}: R', (fit[0] - albedo)[part])
        report(f'roughness from {least}: R log(a)', (albedo * np.log(fit[1] / a))[part])
        report(f'roughness from {least}: R tilt', (albedo * (fit[2] - tilt))[part])
    if len(sys.argv) > 2 and sys.argv[1] == '--check':
        check(tables, sys.argv[2])
    print('''// SPDX-License-Identifier: Apache-2.0
// brdf/fuzz_fit.h: the polynomials of FuzzFromView in brdf/fuzz.h. Written by scripts/fit_fuzz.py,
// which says what they are fitted to.
#pragma once

namespace nacre {

// Row i belongs to x^i, column j to y^j.
inline constexpr int kFuzzTerms = %d;
struct FuzzTable {
  double terms[kFuzzTerms][kFuzzTerms];
};''' % TERMS)
    for name, table in zip(('LogAlbedo', 'LogA', 'Tilt'), tables):
        print(f'\ninline constexpr FuzzTable kFuzz{name} = {{{{')
        for row in table:
            print('    {' + ', '.join(f'{c:.9g}' for c in row) + '},')
        print('}};')
    print('\n}  // namespace nacre')


main()
