// SPDX-License-Identifier: Apache-2.0
// shading/measured_model.h: hits shaded by a measured BRDF (brdf/measured.h). All that it reflects
// is a specular component: a table does not say which part of it is diffuse.
#pragma once

#include "shading/material_hits.h"
#include "shading/models.h"

namespace nacre {

// Stores what the hits of the range reflect of its light.
void ShadeMeasured(const MeasuredModel& model, const LitHits& lit);

// SampleLobe and LobePdf for a measured model.
void SampleMeasured(const MeasuredModel& model, const MaterialHits& at, const float* u,
                    const float* v, Soa3<float>* to_light);
void MeasuredPdf(const MeasuredModel& model, const MaterialHits& at, const LightBatch& light,
                 float* pdf);

// The angle between half vector and normal, in radians, at which the lobe around the mirror
// direction has fallen to 1/e, as UserLobeWidth.
double MeasuredLobeWidth(const MeasuredModel& model);

}  // namespace nacre
