# SPDX-License-Identifier: Apache-2.0
"""Reflection models as a user writes them in numpy."""
import numpy as np


def dot(a, b):
    return (a * b).sum(axis=1)


def lambert(albedo):
    return lambda normal, to_view, to_light: np.full((len(normal), 3), albedo / np.pi)


def ggx(alpha):
    """White metal, separable Smith, no compensation, as in most textbooks."""
    a2 = alpha * alpha

    def brdf(normal, to_view, to_light):
        half = to_view + to_light
        half /= np.linalg.norm(half, axis=1, keepdims=True)
        n_l, n_v, n_h = dot(normal, to_light), dot(normal, to_view), dot(normal, half)
        d = a2 / (np.pi * (n_h * n_h * (a2 - 1) + 1)**2)

        def g1(c):
            return 2 * c / (c + np.sqrt(a2 + (1 - a2) * c * c))
        return (d * g1(n_l) * g1(n_v) / (4 * n_l * n_v))[:, None]
    return brdf


# nacre's model that the GGX above is.
WHITE_METAL = {"base_color": 1, "metallic": 1, "shadowing": "separable", "compensation": "none"}


def phong(exponent, ks=0.5):
    """The lesson's lobe over n.l: neither reciprocal nor kind to energy."""
    def brdf(normal, to_view, to_light):
        n_l = dot(normal, to_light)[:, None]
        mirrored = 2 * n_l * normal - to_light
        lobe = np.maximum(dot(mirrored, to_view), 0)[:, None]**exponent
        return ks * lobe / n_l
    return brdf
