// study/reflection.h: reflection models evaluated one pair of directions at a time: in double, from
// the scalar terms of brdf/, and in float, by the kernels that render.
//
// Values are the reflected radiance per unit of the light's perpendicular irradiance, f n.l: for
// every model finite where the BRDF f is not. All directions are unit vectors.
#pragma once

#include "base/vec.h"
#include "shading/material.h"

namespace nacre {

struct Reflection {
  Rgb diffuse{0, 0, 0}, specular{0, 0, 0};

  Rgb Sum() const { return diffuse + specular; }
};

// In double. Black where light or viewer is not above the surface.
Reflection Reflect(const ShadingMaterial& material, const Vec3d& normal, const Vec3d& to_light,
                   const Vec3d& to_view);

// What the active SIMD target's kernel makes of it.
Reflection ReflectByKernel(const ShadingMaterial& material, const Vec3d& normal,
                           const Vec3d& to_light, const Vec3d& to_view);

// Fresnel's term of the model's curve, at cosine v.h.
Rgb FresnelOf(const MicrofacetModel& model, double v_dot_h, double one_minus_vh);

// G / (4 n.l n.v) in the model's form.
double VisibilityOf(const MicrofacetModel& model, double n_dot_l, double n_dot_v);

// A direction in the plane of incidence, with the normal (0, 0, 1): `degrees` from it, positive
// towards +x.
Vec3d DirectionAt(double degrees);

}  // namespace nacre
