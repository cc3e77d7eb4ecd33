// SPDX-License-Identifier: Apache-2.0
// shading/user_model.h: hits shaded by a reflection model that the library's caller has written
// (scene/user_brdf.h). The results of its functions are checked; an invalid one throws an Error
// (kUsage) that names the sample.
#pragma once

#include "shading/kernels.h"
#include "shading/lobe_sample.h"
#include "shading/reflection.h"

namespace nacre {

// Stores what the hits of the range reflect of its light. A model with a sampler counts as a
// specular component, whose directions SampleUser samples; one without counts as a diffuse
// component, for which cosine-weighted directions are sampled.
void ShadeUser(const UserModel& model, const LitHits& lit, ShadeScratch* scratch);

// SampleLobe and LobePdf for a model with a sampler.
void SampleUser(const UserModel& model, const MaterialHits& at, const float* u, const float* v,
                ShadeScratch* scratch, Soa3<float>* to_light);
void UserPdf(const UserModel& model, const MaterialHits& at, const LightBatch& light,
             ShadeScratch* scratch, float* pdf);

// f n.l for one pair of directions, which must be above the surface.
Reflection ReflectUser(const UserModel& model, const Vec3d& normal, const Vec3d& to_light,
                       const Vec3d& to_view);

// SampleUser samples one direction with the model's sampler or, if it has none, a cosine-weighted
// one. UserPdf is its pdf.
Vec3d SampleUser(const UserModel& model, const Vec3d& normal, const Vec3d& to_view, double u0,
                 double u1);
double UserPdf(const UserModel& model, const Vec3d& normal, const Vec3d& to_view,
               const Vec3d& to_light);

// The approximate angle between half vector and normal, in radians, at which the lobe around the
// mirror direction has fallen to 1/e; infinite for a model that changes little within half a
// radian. It is measured by evaluating the model near the mirror direction: highlights elsewhere,
// and edges, go unnoticed.
double UserLobeWidth(const UserModel& model);

}  // namespace nacre
