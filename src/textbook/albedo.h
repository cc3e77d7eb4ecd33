// SPDX-License-Identifier: Apache-2.0
// textbook/albedo.h: the albedo of reflection models, by quadrature of the models' own functions. 1
// means that all light is reflected; more violates conservation of energy.
#pragma once

#include <functional>

#include "base/vec.h"
#include "textbook/faults.h"

namespace nacre {

// An isotropic BRDF f(to_light, to_view) for the normal (0, 0, 1), without the cosine.
using TextbookBrdf = std::function<double(const Vec3d& to_light, const Vec3d& to_view)>;

// The integral of f n.l over all directions of light, within 3e-5, for a lobe shaped like GGX with
// this roughness > 0. A substitution flattens its peak.
double LobeAlbedo(double n_dot_v, double roughness, const TextbookBrdf& f);

// The integral of f n.l over all directions of light, for an f without a peak.
double SmoothAlbedo(double n_dot_v, const TextbookBrdf& f);

// 2 int E(mu) mu dmu: the albedo averaged over all viewing directions.
double AverageAlbedo(const std::function<double(double n_dot_v)>& albedo);

// ---- The lesson's model -------------------------------------------------------------------------

// D F G / (4 n.l n.v) with F0 = f0.
double TextbookSpecularAlbedo(double n_dot_v, double roughness, double f0,
                              const TextbookFaults& faults);

// kd albedo / pi with kd = 1 - F(v.h) and a white albedo: a dielectric's base.
double TextbookDiffuseAlbedo(double n_dot_v, double f0, const TextbookFaults& faults);

}  // namespace nacre
