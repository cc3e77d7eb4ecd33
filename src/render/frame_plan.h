// SPDX-License-Identifier: Apache-2.0
// render/frame_plan.h: how a frame is rendered and which work can be skipped, decided once before
// its first camera ray. Each stage of the work on a batch of samples has a plan of its own.
// `--explain` prints the reasons.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "render/adaptive_plan.h"
#include "render/direct_batch.h"
#include "render/explanation.h"
#include "render/film.h"
#include "render/hits_plan.h"
#include "render/mesh_shading.h"
#include "render/prepared_scene.h"
#include "render/samples.h"
#include "render/settings.h"
#include "render/stats.h"
#include "render/surfaces.h"

namespace nacre {

// The plans of all stages. MakePlan says what each is made from.
struct FramePlan {
  const Scene* scene = nullptr;
  std::shared_ptr<const SceneWithLights> with_lights;  // owns `scene` if lights are visible
  Window frame;                                        // all pixels: 0, 0, width, height
  Window window;                                       // the pixels to render
  CameraFrame camera{};
  // What metadata says of the settings.
  std::vector<std::pair<std::string_view, SettingValue>> changed_settings;
  SamplingPlan sampling;
  HitsPlan hits;
  SurfacePlan surfaces;
  DirectPlan direct;
  ShadedMeshes meshes;
  FilmPlan film;
  AdaptivePlan adaptive;  // max_error is 0 without adaptive sampling
  Explanation why;        // of all stages
};

// `scene` must be valid (scene/validate.h) and outlive the plan. Throws Error: usage for a layer or
// region that the scene does not have, bad input for shapes that a build without Embree cannot
// trace, internal for BVHs that cannot be built; and Cancelled.
FramePlan MakePlan(const Scene& scene, const RenderSettings& settings);

// Makes the same plan, faster, with what earlier plans have left in `prepared`, whose versions must
// include all changes of the scene since. Those earlier plans must not be rendered any more.
FramePlan MakePlan(const Scene& scene, const RenderSettings& settings, PreparedScene* prepared);

// The plan as text: what is used or skipped, and why. With `stats`, which may be null, also each
// stage's share of the time.
std::string ExplainPlan(const FramePlan& plan, const RenderStats* stats);

}  // namespace nacre
