#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Prints the coefficients of kCharlieAlbedo in src/brdf/sheen.h and the error of the fit.

The directional albedo of Charlie's lobe is integrated in double, by Gauss-Legendre rules on panels
that grow from where the integrand bends, over roughnesses and cosines that are densest at 0. The
form of the fit is that of CharlieAlbedo; its polynomial comes from weighted least squares, whose
weights are raised where the error is largest until it is nearly even (Lawson 1961). Errors are of
E, or of E relative to itself where it is above 1. Needs python3-numpy; takes a minute.
"""
import numpy as np

TERMS = 8  # in each variable
LEAST_COSINE = 2.0 ** -14
COEFFICIENTS = ((25.3245, 21.5473), (3.32435, 3.82987), (0.16801, 0.19823), (-1.27393, -1.97760),
                (-4.85967, -4.32054))


def cosine_lambda(x, alpha):
    """x Lambda(x) of Estevez and Kulla 2017, kept at its value at LEAST_COSINE below it."""
    rough = 1 - (1 - alpha) ** 2
    a, b, c, d, e = (at_0 + (at_1 - at_0) * rough for at_0, at_1 in COEFFICIENTS)
    x = np.maximum(x, LEAST_COSINE)

    def log_lambda(y):
        return a / (1 + b * y ** c) + d * y + e

    near = log_lambda(np.minimum(x, 0.5))
    far = 2 * log_lambda(0.5) - log_lambda(1 - np.maximum(x, 0.5))
    return x * np.exp(np.where(x < 0.5, near, far))


def panels(finest, end):
    """Nodes and weights of Gauss-Legendre rules on [0, end], on panels that double from finest."""
    x, w = np.polynomial.legendre.leggauss(10)
    edges = [0.0]
    edge = finest
    while edge < end / 1.5:
        edges.append(edge)
        edge *= 2
    edges = np.array(edges + [end])
    length = np.diff(edges)[:, None]
    return (edges[:-1, None] + length * (x + 1) / 2).ravel(), (length * w / 2).ravel()


def directional_albedo(mu, roughness):
    """int D V n.l dl."""
    alpha = roughness * roughness
    n_dot_l, weight = panels(min(max(mu, 1e-9), roughness) / 64, 1.0)
    sin_v, sin_l = np.sqrt((1 - mu) * (1 + mu)), np.sqrt((1 - n_dot_l) * (1 + n_dot_l))
    visibility = 1 / (4 * (mu * n_dot_l + n_dot_l * cosine_lambda(mu, alpha) +
                           mu * cosine_lambda(n_dot_l, alpha)))
    n_dot_u = (mu + n_dot_l)[:, None]
    # The azimuth from the plane opposite the viewer, where l + v is shortest.
    phi, phi_weight = panels(1e-6, np.pi)
    across2 = ((sin_l - sin_v) ** 2)[:, None] + \
        4 * sin_v * sin_l[:, None] * np.sin(phi / 2) ** 2
    distribution = np.exp(-np.log1p(n_dot_u ** 2 / np.maximum(across2, 1e-300)) / (2 * alpha))
    scale = (2 + 1 / alpha) / (2 * np.pi)
    return (weight * n_dot_l * visibility * 2 * scale * (distribution @ phi_weight)).sum()


def envelope(mu, roughness):
    """What the polynomial is multiplied by: see CharlieAlbedo."""
    alpha = roughness * roughness
    mu2 = mu * mu
    log_sin2 = np.log1p(-mu2 * (1 / 4 + mu2 * (1 / 16 + mu2 / 8)))
    typical = roughness / (1 + roughness)
    sum_of_cosines = mu + cosine_lambda(mu, alpha) + mu * cosine_lambda(typical, alpha) / (2 * typical)
    return np.exp(log_sin2 / (2 * alpha)) / (roughness * sum_of_cosines)


def variables(mu, roughness):
    offset = 3 * roughness
    return 2 * np.sqrt(mu * (1 + offset) / (mu + offset)) - 1, 2 * roughness ** 0.25 - 1


def samples(count_x, count_y):
    """Cosines and roughnesses whose variables are Chebyshev's extrema in [-1, 1], and albedos."""
    mu, roughness, albedo = [], [], []
    for r in ((1 - np.cos(np.linspace(0, np.pi, count_y))) / 2) ** 4:
        r = max(r, 2.0 ** -20)
        for u in ((1 - np.cos(np.linspace(0, np.pi, count_x))) / 2) ** 2:
            cosine = min(3 * r * u / (1 + 3 * r - u), 1.0)
            if envelope(cosine, r) < 1e-9:
                continue  # no light worth an error
            mu.append(cosine)
            roughness.append(r)
            albedo.append(directional_albedo(cosine, r))
    return np.array(mu), np.array(roughness), np.array(albedo)


def polynomial(coefficients, x, y):
    return np.polynomial.polynomial.polyval2d(x, y, coefficients)


def errors(coefficients, mu, roughness, albedo):
    x, y = variables(mu, roughness)
    fit = polynomial(coefficients, x, y) * envelope_of(mu, roughness)
    return np.abs(fit - albedo) / np.maximum(albedo, 1)


def envelope_of(mu, roughness):
    return np.array([envelope(m, r) for m, r in zip(mu, roughness)])


def fit(mu, roughness, albedo):
    x, y = variables(mu, roughness)
    factor = envelope_of(mu, roughness)
    weight = factor / np.maximum(albedo, 1)
    chebyshev = np.polynomial.chebyshev.chebvander2d(x, y, (TERMS - 1, TERMS - 1))
    rise = np.ones_like(mu)
    best = None
    for _ in range(200):
        row = weight * np.sqrt(rise)
        solution = np.linalg.lstsq(chebyshev * row[:, None], albedo / factor * row, rcond=None)[0]
        error = np.abs(chebyshev @ solution - albedo / factor) * weight
        if best is None or error.max() < best[0]:
            best = error.max(), solution
        rise *= error / error.max() + 1e-6
        rise /= rise.mean()
    of_chebyshev = best[1].reshape(TERMS, TERMS)
    # From Chebyshev's polynomials to powers, one variable after the other.
    to_powers = np.zeros((TERMS, TERMS))
    for i in range(TERMS):
        powers = np.polynomial.chebyshev.cheb2poly(np.eye(TERMS)[i])
        to_powers[i, :len(powers)] = powers
    return to_powers.T @ of_chebyshev @ to_powers


coefficients = np.array([[float(f'{c:.9g}') for c in row] for row in fit(*samples(64, 72))])
dense = samples(101, 131)
error = errors(coefficients, *dense)
for least in (0, 0.001, 0.03):
    within = np.where(dense[1] >= least, error, 0)
    worst = within.argmax()
    print(f'roughness {least} to 1: error up to {within[worst]:.2g}, '
          f'at n.v {dense[0][worst]:.3g}, roughness {dense[1][worst]:.3g}')
for row in coefficients:
    print('    {' + ', '.join(f'{c:.9g}' for c in row) + '},')
