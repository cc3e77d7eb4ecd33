// SPDX-License-Identifier: Apache-2.0
// render/film_plan.h: what a frame needs of its samples on their way from places to pixels: parts
// of RenderPlan, each with its reason in RenderPlan::items.
#pragma once

#include "render/plan.h"

namespace nacre {

// The pattern of samples, and how many make a batch: `sampler`, `tile_width`, `samples_per_round`.
void PlanSampling(const Scene& scene, const RenderSettings& settings, RenderPlan* plan);

// After lights: whether diffuse and specular parts are kept: `one_light`, `leaves`.
void PlanParts(const Scene& scene, const RenderSettings& settings, RenderPlan* plan);

// After shapes and materials: which samples are placed: `places_unasked`.
void PlanPlaces(const Scene& scene, const RenderSettings& settings, RenderPlan* plan);

// Whether samples are added up: `one_sample`.
void PlanFilm(const Scene& scene, const RenderSettings& settings, RenderPlan* plan);

}  // namespace nacre
