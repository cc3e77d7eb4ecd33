// SPDX-License-Identifier: Apache-2.0
// render/frame_plan.h: what a frame needs, decided once before any ray is traced, and so what is
// skipped: a plan for each stage of the work on a batch of samples. `--explain` prints the reasons.
#pragma once

#include <memory>
#include <string>

#include "render/adaptive_plan.h"
#include "render/direct_plan.h"
#include "render/explanation.h"
#include "render/film.h"
#include "render/hits_plan.h"
#include "render/prepared_scene.h"
#include "render/samples.h"
#include "render/settings.h"
#include "render/stats.h"
#include "render/surfaces.h"

namespace nacre {

// What each part is made from; MakePlan makes them in the order in which one needs another.
struct FramePlan {
  const Scene* scene = nullptr;
  std::shared_ptr<const SceneWithLights> with_lights;  // owns `scene` where lights are visible
  Window frame;                                        // all pixels: 0, 0, width, height
  Window window;                                       // those to render
  CameraFrame camera{};
  FilmPlan film;         // layers, image settings, camera; sky and background of `direct`
  HitsPlan hits;         // shapes, camera, image settings; shadows and readers of hits
  SurfacePlan surfaces;  // materials, textures, ambient lights, shapes; camera for footprints
  DirectPlan direct;     // lights, layers, shapes, camera; `hits` for shadows
  SamplingPlan
      sampling;  // image settings; what `direct`, `surfaces`, `hits`, `film` ask of samples
  AdaptivePlan adaptive;  // max_error, and all of the above
  Explanation why;        // of all parts
};

// `scene` must be valid (scene/validate.h) and outlive the plan. Throws Error (usage) for a layer
// or region that the scene does not have.
FramePlan MakePlan(const Scene& scene, const RenderSettings& settings);

// The same bits from pieces that were made for a plan before, of which none may be rendered any
// more. `prepared` has been told of all changes of the scene since.
FramePlan MakePlan(const Scene& scene, const RenderSettings& settings, PreparedScene* prepared);

// The plan as text: each item, used or skipped, and why; with `stats`, each stage's share.
std::string ExplainPlan(const FramePlan& plan, const RenderStats* stats);

}  // namespace nacre
