// SPDX-License-Identifier: Apache-2.0
// shading/user_model.h: hits shaded by the caller's own reflection model (scene/user_brdf.h). What
// its functions return is checked; a number that is none is an Error (kUsage) that names the
// sample.
#pragma once

#include "shading/kernels.h"
#include "shading/lobe_sample.h"
#include "shading/scalar_material.h"

namespace nacre {

// Writes what the hits of the range reflect of its light. A model with a sampler of its
// own is a specular component, whose directions SampleUser chooses; one without is a diffuse
// component, which the cosine law samples.
void ShadeUser(const UserModel& model, const ShadeRange& range, ShadeScratch* scratch);

// SampleLobe and LobePdf of a model with a sampler.
void SampleUser(const UserModel& model, const LobeRange& range, const float* u, const float* v,
                ShadeScratch* scratch, Soa3<float>* to_light);
void UserPdf(const UserModel& model, const LobeRange& range, const LightBatch& light,
             ShadeScratch* scratch, float* pdf);

// f n.l of one pair of directions above the surface.
Reflection ReflectUser(const UserModel& model, const Vec3d& normal, const Vec3d& to_light,
                       const Vec3d& to_view);

// One direction by the model's sampler or, if it has none, the cosine law, and its pdf.
Vec3d SampleUser(const UserModel& model, const Vec3d& normal, const Vec3d& to_view, double u0,
                 double u1);
double UserPdf(const UserModel& model, const Vec3d& normal, const Vec3d& to_view,
               const Vec3d& to_light);

// About how far the half vector may turn from the normal, in radians, before the lobe around the
// mirror direction has fallen to 1/e; infinite of a model that changes little over half a radian.
// Measured by the function itself: highlights of other places, and edges, go unnoticed.
double UserLobeWidth(const UserModel& model);

}  // namespace nacre
