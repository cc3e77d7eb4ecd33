// SPDX-License-Identifier: Apache-2.0
#include "render/tile.h"

#include <algorithm>
#include <numeric>
#include <span>
#include <utility>

#include "render/mapped_horizon.h"
#include "render/mesh_points.h"
#include "render/shadow_rays_kernel.h"
#include "render/sort_hits.h"
#include "render/tile_layers.h"
#include "sampling/hash.h"

namespace nacre {
namespace {

// The pixels of a tile's spans; returns how many.
size_t ListSpans(const TileCandidates& candidates, std::vector<PixelRun>* runs) {
  const Window& tile = candidates.tile;
  const auto width = static_cast<uint32_t>(tile.width());
  size_t pixels = 0;
  uint32_t row = 0;  // its first pixel
  int y = tile.y0;
  for (const PixelSpan& span : candidates.spans) {
    for (; span.first >= row + width; row += width) ++y;
    runs->push_back(
        {tile.x0 + static_cast<int>(span.first - row), y, static_cast<int>(span.count)});
    pixels += span.count;
  }
  return pixels;
}

// Chooses the tile's pixels whose samples are placed, and readies them.
void ChoosePixels(const RenderPlan& plan, const Window& tile, TileScratch* s) {
  if (plan.sampler.centered) return;  // all are
  const bool were_only_spans = s->samples.only_spans;
  std::vector<PixelRun>& runs = s->sampled_runs;
  runs.clear();
  s->samples.only_spans = plan.places_unasked && s->in_sight && !s->triangles_in_sight &&
                          ListSpans(s->candidates, &runs) < tile.pixel_count();
  if (!s->samples.only_spans) {
    runs.clear();
    for (int y = tile.y0; y < tile.y1; ++y) runs.push_back({tile.x0, y, tile.width()});
  }
  PutPixels(plan.sampler, runs, &s->sampled_pixels);
  if (s->samples.only_spans) {
    NumberRays(tile, runs, plan.samples_per_round, s->samples.ray.data());
  } else if (were_only_spans) {
    s->samples.NumberInOrder();  // all of them: a later tile may have more than this one
  }
}

// Samples [first, first + count) of each of the chosen pixels.
void MakeSamples(const RenderPlan& plan, const Window& tile, int first, int count, TileScratch* s) {
  double* const x = s->samples.x.data();
  double* const y = s->samples.y.data();
  s->samples.centers = plan.sampler.centered && plan.places_unasked && !s->triangles_in_sight;
  if (!plan.sampler.centered) {
    SamplePixels(plan.sampler, s->sampled_pixels, first, count, x, y);
  } else if (!s->samples.centers) {
    PlaceCenters(tile, x, y);
  }
  s->samples.count = tile.pixel_count() * static_cast<size_t>(count);
  s->weights.resize(static_cast<size_t>(count));
  for (int i = 0; i < count; ++i) {
    s->weights[static_cast<size_t>(i)] = SampleWeight(plan.sampler, first + i);
  }
}

// The pixels and samples of a tile's rounds, for lights that are sampled.
void NumberPixels(const RenderPlan& plan, const Window& tile, SampleNumbers* numbers) {
  numbers->pixel_count = 0;
  for (int y = tile.y0; y < tile.y1; ++y) {
    for (int x = tile.x0; x < tile.x1; ++x) {
      numbers->seeds[numbers->pixel_count++] = PixelSeed(x, y, plan.sampler.seed);
    }
  }
  for (int k = 0; k < plan.samples_per_round; ++k) {
    uint32_t* const from = numbers->pixel.data() + static_cast<size_t>(k) * numbers->pixel_count;
    std::iota(from, from + numbers->pixel_count, 0u);
  }
}

// The round that begins with sample `first`.
void NumberSamples(int first, int count, SampleNumbers* numbers) {
  for (int k = 0; k < count; ++k) {
    std::fill_n(numbers->number.data() + static_cast<size_t>(k) * numbers->pixel_count,
                numbers->pixel_count, static_cast<uint32_t>(first + k));
  }
}

// Looks up the maps of the materials that have any.
void TextureRuns(const RenderPlan& plan, TileScratch* s) {
  s->surface.turned = false;
  if (!plan.textured) return;
  for (const MaterialRun& run : s->runs) {
    s->surface.turned = s->surface.turned || plan.materials[run.material.index].turned;
  }
  if (s->surface.turned) CopySoa(s->surface.normal, s->hits.count, &s->surface.unturned);
  for (const MaterialRun& run : s->runs) {
    const ShadingMaterial& material = plan.materials[run.material.index];
    if (material.textured == nullptr) continue;
    if (!s->textures) s->textures = std::make_unique<HitTextures>();
    TextureHits({plan.textures, material, run.begin, run.end}, &s->hits, &s->surface,
                s->textures.get());
  }
}

// Whether shadow rays to the light need be cast from the batch.
bool CastsShadowRays(const RenderPlan& plan, const PlannedLight& planned, const HitBatch& hits) {
  if (!hits.one_primitive) return planned.shadow_rays;
  return !NeverShadowed(planned, hits.primitive[0]) &&
         plan.intersector->MayOcclude(planned.occluders, hits);
}

// Takes the light from the hits that lie in its shadow. Only hits that it reaches are asked.
void CastShadows(const RenderPlan& plan, const PlannedLight& planned, TileScratch* s,
                 RenderStats* stats) {
  const HitBatch& hits = s->hits;
  const Soa3<double>& origin = plan.lift_shadows ? s->shadow_origin : hits.position;
  ShadowRayBatch& rays = s->shadow_rays;
  rays.light = planned.occluders;
  rays.outward = plan.eye_outside;
  rays.end_reach = plan.camera_reach;
  // Without a branch on what is lit, which would go either way from hit to hit.
  const bool all = hits.one_primitive && !NeverShadowed(planned, hits.primitive[0]);
  size_t count = 0;
  for (size_t i = 0; i < hits.count; ++i) {
    s->shadow_hits[count] = static_cast<uint32_t>(i);
    const bool asked = all || !NeverShadowed(planned, hits.primitive[i]);
    count += static_cast<size_t>(asked & (s->light.irradiance[i] > 0));
  }
  rays.count = count;
  stats->shadow_rays += count;
  if (count == 0) return;
  FillShadowRays(planned.light, hits, origin, s->shadow_hits, &rays);
  plan.intersector->Occluded(&rays);
  for (size_t ray = 0; ray < rays.count; ++ray) {
    if (rays.occluded[ray] != 0) s->light.irradiance[s->shadow_hits[ray]] = 0;
  }
}

// `lights` is one alone, evaluated, where maps have turned normals.
void ShadeRuns(const RenderPlan& plan, std::span<const LightOnBatch> lights, Leaves leaves,
               TileScratch* s, ReflectedRadiance* radiance) {
  for (const MaterialRun& run : s->runs) {
    const LitHits lit{s->hits, s->surface, lights, s->textures.get(), leaves};
    ShadeRun(plan.materials[run.material.index], lit, run.begin, run.end, &s->narrow, radiance);
    if (s->surface.turned) AddMirroredLobe(plan, run, *lights[0].light, leaves, s, radiance);
  }
}

// A light that is asked for its shadows, or kept apart in a layer, or of a form that takes a pass
// of its own.
void ShadeByOne(const RenderPlan& plan, const PlannedLight& planned, bool shadow_rays,
                Leaves leaves, TileScratch* s, StageClock* clock, RenderStats* stats) {
  EvaluateLight(planned.light, s->hits, s->surface, &s->light);
  if (s->surface.turned) HideBelowHorizon(plan, s);
  clock->Charge(Stage::kLight);
  if (shadow_rays) {
    CastShadows(plan, planned, s, stats);
    clock->Charge(Stage::kShadow);
  }
  const LightOnBatch light{&planned.light, &s->light};
  // One light's parts are added up before they are added to others', in a layer or not.
  const bool apart = planned.layer >= 0 || s->surface.turned;
  if (!apart || plan.one_light) {
    ShadeRuns(plan, {&light, 1}, leaves, s, &s->total);
    if (planned.layer >= 0) ShowLight(s->total, planned.layer, s);
  } else {
    ShadeRuns(plan, {&light, 1}, Leaves::kParts, s, &s->single);
    KeepLight(planned.layer, s);
  }
}

// In the order of the lights. Those that need nothing but their sum are taken together while they
// follow one another.
void ShadeByLights(const RenderPlan& plan, TileScratch* s, StageClock* clock, RenderStats* stats) {
  for (const MaterialRun& run : s->runs) {
    PrepareRun(plan.materials[run.material.index], run.begin, run.end, &s->surface,
               s->textures.get());
  }
  if (plan.lift_shadows) LiftShadowOrigins(plan, s);
  s->per_light.resize(plan.light_layer_count);
  for (Soa3<float>& layer : s->per_light) ClearSoa(s->hits.count, &layer);
  const BatchBounds bounds = plan.cull_lights ? BoundHits(s->hits, s->surface) : BatchBounds{};
  clock->Charge(Stage::kRefine);
  s->together.clear();
  bool dark = true;  // nothing is in s->total yet
  const auto leaves = [&] { return dark ? plan.leaves : Leaves::kAddedParts; };
  const auto shade_together = [&] {
    if (s->together.empty()) return;
    ShadeRuns(plan, s->together, leaves(), s, &s->total);
    s->together.clear();
    dark = false;
  };
  const auto clear_if_dark = [&] {
    if (dark) ClearRadiance(s->hits.count, &s->total);
    dark = false;
  };
  for (const PlannedLight& planned : plan.lights) {
    ++stats->light_batches;
    if (plan.cull_lights && !MayReach(planned.reach, bounds)) {
      ++stats->culled_lights;
      continue;
    }
    const bool shadow_rays = CastsShadowRays(plan, planned, s->hits);
    if (!shadow_rays && planned.layer < 0 && !s->surface.turned &&
        EvaluatedInPlace(planned.light)) {
      s->together.push_back({&planned.light, nullptr});
    } else {
      shade_together();
      const bool apart = planned.layer >= 0 || s->surface.turned;
      if (apart && !plan.one_light) clear_if_dark();
      ShadeByOne(plan, planned, shadow_rays, leaves(), s, clock, stats);
      dark = false;
    }
    stats->shades += s->hits.count;
  }
  shade_together();
  clear_if_dark();
  clock->Charge(Stage::kShade);
  if (!plan.sampled_lights.empty()) ShadeBySampledLights(plan, s, clock, stats);
}

// Shades the hits that are not interpolated, which come first, and interpolates the rest.
void ShadeAndInterpolate(const RenderPlan& plan, TileScratch* s, StageClock* clock,
                         RenderStats* stats) {
  TextureRuns(plan, s);
  const size_t count = s->hits.count;
  const auto rest = std::stable_partition(s->runs.begin(), s->runs.end(),
                                          [](const MaterialRun& run) { return !run.interpolated; });
  const std::vector<MaterialRun> interpolated(rest, s->runs.end());
  s->runs.erase(rest, s->runs.end());
  s->hits.count = s->runs.empty() ? 0 : s->runs.back().end;
  s->per_light.resize(plan.light_layer_count);
  if (s->hits.count > 0) ShadeByLights(plan, s, clock, stats);
  s->hits.count = count;
  s->runs.insert(s->runs.end(), interpolated.begin(), interpolated.end());
  Interpolate(plan, s);
  clock->Charge(Stage::kShade);
}

}  // namespace

void ShadeHits(const RenderPlan& plan, TileScratch* scratch, StageClock* clock,
               RenderStats* stats) {
  TextureRuns(plan, scratch);
  ShadeByLights(plan, scratch, clock, stats);
}

bool EnterTile(const RenderPlan& plan, const Window& tile, TileScratch* scratch) {
  TileScratch& s = *scratch;
  s.in_sight = plan.intersector != nullptr && EnterShapes(plan, tile, &s);
  if (!plan.sampled_lights.empty() && !s.sampled) s.sampled = std::make_unique<SampledScratch>();
  return s.in_sight || plan.sky != nullptr;
}

void TraceAndShade(const RenderPlan& plan, TileScratch* scratch, StageClock* clock,
                   RenderStats* stats) {
  TileScratch& s = *scratch;
  stats->camera_rays += s.samples.count;
  clock->Charge(Stage::kSample);
  s.hits.count = 0;
  if (!s.in_sight) return;
  FindHits(plan, &s);
  clock->Charge(Stage::kIntersect);
  if (s.hits.count == 0) return;
  stats->hits += s.hits.count;
  SortHits(plan, &s);
  if (plan.mesh_radiance.empty()) {
    ShadeHits(plan, &s, clock, stats);
  } else {
    ShadeAndInterpolate(plan, &s, clock, stats);
  }
}

namespace {

void ShowBackground(const RenderPlan& plan, const Window& tile, Strip* strip, uint8_t* blank) {
  if (*blank == 0) FillBackground(plan, tile, strip);
  *blank = 1;
}

// The only sample of each pixel.
void RenderOnce(const RenderPlan& plan, const Window& tile, TileScratch* scratch, Strip* strip,
                uint8_t* blank, StageClock* clock, RenderStats* stats) {
  TileScratch& s = *scratch;
  s.film.window = tile;
  MakeSamples(plan, tile, 0, 1, &s);
  if (s.sampled) NumberSamples(0, 1, &s.sampled->numbers);
  TraceAndShade(plan, &s, clock, stats);
  if (s.hits.count == 0) {
    ShowBackground(plan, tile, strip, blank);
  } else {
    *blank = 0;
    if (!PutOnlySamples(plan, &s, strip)) {
      StartTile(plan, tile, &s.film);
      AddToFilm(plan, &s);
      ResolveTile(plan, s.film, strip);
    }
  }
  clock->Charge(Stage::kFilm);
}

}  // namespace

void RenderTile(const RenderPlan& plan, const Window& tile, TileScratch* scratch, Strip* strip,
                uint8_t* blank, StageClock* clock, RenderStats* stats) {
  TileScratch& s = *scratch;
  const int spp = plan.scene->image.spp;
  const bool anything = EnterTile(plan, tile, &s);
  clock->Charge(Stage::kIntersect);
  if (!anything && HasUnitWeights(plan.sampler)) {
    ShowBackground(plan, tile, strip, blank);
    clock->Charge(Stage::kFilm);
    return;
  }
  ChoosePixels(plan, tile, &s);
  if (s.sampled) NumberPixels(plan, tile, &s.sampled->numbers);
  if (plan.one_sample) return RenderOnce(plan, tile, &s, strip, blank, clock, stats);
  *blank = 0;
  clock->Charge(Stage::kSample);
  StartTile(plan, tile, &s.film);
  clock->Charge(Stage::kFilm);
  for (int first = 0; first < spp; first += plan.samples_per_round) {
    const int count = std::min(plan.samples_per_round, spp - first);
    MakeSamples(plan, tile, first, count, &s);
    if (s.sampled) NumberSamples(first, count, &s.sampled->numbers);
    TraceAndShade(plan, &s, clock, stats);
    SeeSky(plan, &s);
    AddToFilm(plan, &s);
    clock->Charge(Stage::kFilm);
  }
  ResolveTile(plan, s.film, strip);
  clock->Charge(Stage::kFilm);
}

}  // namespace nacre
