// SPDX-License-Identifier: Apache-2.0
// textbook/albedo.h: how much of the light from everywhere a reflection model gives back, by
// quadrature of the model's own functions. 1 is all of it; more is made from nothing.
#pragma once

#include <functional>

#include "base/vec.h"
#include "textbook/faults.h"

namespace nacre {

// f(to_light, to_view) without the cosine, around the normal (0, 0, 1), isotropic.
using TextbookBrdf = std::function<double(const Vec3d& to_light, const Vec3d& to_view)>;

// The integral of f n.l over all directions of light, for a lobe that is GGX-shaped with this
// roughness > 0 (the substitution that flattens its peak), to 3e-5.
double LobeAlbedo(double n_dot_v, double roughness, const TextbookBrdf& f);

// The same for an f without a peak.
double SmoothAlbedo(double n_dot_v, const TextbookBrdf& f);

// 2 int E(mu) mu dmu: of light from everywhere to everywhere.
double AverageAlbedo(const std::function<double(double n_dot_v)>& albedo);

// ---- The lesson's model -------------------------------------------------------------------------

// D F G / (4 n.l n.v) with F0 = f0.
double TextbookSpecularAlbedo(double n_dot_v, double roughness, double f0,
                              const TextbookFaults& faults);

// kd albedo / pi with kd = 1 - F(v.h) and a white albedo: a dielectric's base.
double TextbookDiffuseAlbedo(double n_dot_v, double f0, const TextbookFaults& faults);

}  // namespace nacre
