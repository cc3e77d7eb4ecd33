// SPDX-License-Identifier: Apache-2.0
// textbook/shading.h: the lesson's shading functions, line by line. nacre's renderer does not use
// them: see brdf/ and shading/ for its own.
#pragma once

#include "base/vec.h"
#include "textbook/faults.h"

namespace nacre {

// The lesson's normalize(): vectors shorter than 1e-10 are returned unchanged.
Vec3d TextbookNormalize(const Vec3d& v, const TextbookFaults& faults);

// A surface point. All directions are unit and point away from the surface.
struct TextbookPoint {
  Vec3d normal, to_light, to_view;
  Rgb light{1, 1, 1};  // the light's colour, without fall-off
};

// ---- Phong --------------------------------------------------------------------------------------

struct TextbookPhong {
  double ka = 0.1, kd = 0.7, ks = 0.3, shininess = 32;
  Rgb color{1, 1, 1};  // of the object, but not of the highlight
};

// max(R.V, 0)^n and max(N.H, 0)^n.
double TextbookPhongLobe(const TextbookPoint& p, double shininess);
double TextbookBlinnLobe(const TextbookPoint& p, double shininess, const TextbookFaults& faults);

// phong_shading().
Rgb TextbookPhongShading(const TextbookPoint& p, const TextbookPhong& material,
                         const TextbookFaults& faults);

// ---- Cook-Torrance ------------------------------------------------------------------------------

struct TextbookAngles {
  double n_dot_l = 0, n_dot_v = 0, n_dot_h = 0, v_dot_h = 0;
  double sin2_h = 0;  // |n x h|^2, for D without its floor; the lesson only knows n.h
};

TextbookAngles TextbookAnglesAt(const TextbookPoint& p, const TextbookFaults& faults);

// distribution_ggx(), fresnel_schlick(), geometry_smith().
double TextbookDistribution(const TextbookAngles& a, double roughness,
                            const TextbookFaults& faults);
double TextbookFresnel(double cos_theta, double f0);
double TextbookGeometry(double n_dot_v, double n_dot_l, double roughness,
                        const TextbookFaults& faults);

// D F G / (4 n.l n.v + 0.0001), for one channel.
double TextbookSpecular(const TextbookAngles& a, double roughness, double f0,
                        const TextbookFaults& faults);

struct TextbookPbr {
  Rgb albedo{1, 1, 1};
  double metallic = 0, roughness = 0.5;
};

// pbr_shading() up to its tone mapping: linear radiance.
Rgb TextbookPbrRadiance(const TextbookPoint& p, const TextbookPbr& material,
                        const TextbookFaults& faults);

// The rest of pbr_shading(): Reinhard and gamma.
double TextbookEncode(double radiance, const TextbookFaults& faults);
Rgb TextbookEncode(const Rgb& radiance, const TextbookFaults& faults);

// ---- Beside the pictures ------------------------------------------------------------------------

// point_light_attenuation(), which the lesson defines but never calls.
double TextbookAttenuation(double distance);

// The nearest hit of a sphere as t along a direction of any length; negative if there is none.
double TextbookIntersectSphere(const Vec3d& origin, const Vec3d& direction, const Vec3d& center,
                               double radius, const TextbookFaults& faults);

}  // namespace nacre
