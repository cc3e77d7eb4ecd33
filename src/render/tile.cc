#include "render/tile.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "render/tile_layers.h"

namespace nacre {
namespace {

// Charges the time since the last call to a stage.
class StageClock {
 public:
  explicit StageClock(RenderStats* stats) : stats_(stats) {}
  void Charge(Stage stage) {
    const auto now = std::chrono::steady_clock::now();
    stats_->seconds(stage) += std::chrono::duration<double>(now - last_).count();
    last_ = now;
  }

 private:
  RenderStats* stats_;
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

// Samples [first, first + count) of each pixel of the tile, and the camera rays through them.
void MakeRays(const RenderPlan& plan, const Window& tile, int first, int count, TileScratch* s) {
  SamplePixels(plan.sampler, tile, first, count, s->film_x.data(), s->film_y.data(),
               s->weight.data());
  const size_t ray_count = tile.pixel_count() * static_cast<size_t>(count);
  MakeCameraRays(plan.camera, s->film_x.data(), s->film_y.data(), ray_count, &s->rays);
}

// Sorts the rays that hit something by material: hit_rays lists them run by run, in the order of
// their index within a run, so that what a hit's lane computes never depends on its neighbours.
size_t SortHits(const RenderPlan& plan, TileScratch* s) {
  constexpr uint32_t kNone = std::numeric_limits<uint32_t>::max();
  for (const MaterialRun& run : s->runs) s->run_of_material[run.material.index] = kNone;
  s->runs.clear();
  s->run_of_material.resize(plan.scene->materials.size(), kNone);
  for (size_t ray = 0; ray < s->rays.count; ++ray) {
    const uint32_t primitive = s->closest.primitive[ray];
    if (primitive == kNoPrimitive) continue;
    const MaterialId material = MaterialAt(plan, primitive, s->film_x[ray]);
    uint32_t& run = s->run_of_material[material.index];
    if (run == kNone) {
      run = static_cast<uint32_t>(s->runs.size());
      s->runs.push_back({material, 0, 0});
    }
    s->run_of_ray[ray] = run;
    ++s->runs[run].end;  // counts the run's hits for now
  }
  size_t begin = 0;
  for (MaterialRun& run : s->runs) {
    const size_t count = run.end;
    run.begin = run.end = begin;
    begin += count;
  }
  for (size_t ray = 0; ray < s->rays.count; ++ray) {
    if (s->closest.primitive[ray] == kNoPrimitive) continue;
    s->hit_rays[s->runs[s->run_of_ray[ray]].end++] = static_cast<uint32_t>(ray);
  }
  return begin;
}

// Takes the light from the hits that lie in its shadow. Only hits that it reaches are asked.
void CastShadows(const RenderPlan& plan, const PlannedLight& planned, TileScratch* s,
                 RenderStats* stats) {
  const HitBatch& hits = s->hits;
  const LightBatch& light = s->light;
  ShadowRayBatch& rays = s->shadow_rays;
  rays.count = 0;
  rays.light = planned.occluders;
  rays.outward = plan.eye_outside;
  for (size_t i = 0; i < hits.count; ++i) {
    if (!(light.irradiance[i] > 0)) continue;
    if (!planned.shadowed.empty() && planned.shadowed[hits.object[i]] == 0) continue;
    const size_t ray = rays.count++;
    s->shadow_hits[ray] = static_cast<uint32_t>(i);
    rays.primitive[ray] = hits.primitive[i];
    rays.origin.x[ray] = hits.position.x[i];
    rays.origin.y[ray] = hits.position.y[i];
    rays.origin.z[ray] = hits.position.z[i];
    rays.direction.x[ray] = light.offset.x[i];
    rays.direction.y[ray] = light.offset.y[i];
    rays.direction.z[ray] = light.offset.z[i];
    rays.t_max[ray] = light.t_max;
  }
  stats->shadow_rays += rays.count;
  if (rays.count == 0) return;
  plan.intersector->Occluded(&rays);
  for (size_t ray = 0; ray < rays.count; ++ray) {
    if (rays.occluded[ray] != 0) s->light.irradiance[s->shadow_hits[ray]] = 0;
  }
}

// Adds up what the batch's hits reflect of every light.
void ShadeHits(const RenderPlan& plan, TileScratch* s, StageClock* clock, RenderStats* stats) {
  const Scene& scene = *plan.scene;
  PrepareSurface(s->hits, &s->surface);
  for (const MaterialRun& run : s->runs) {
    PrepareRun(plan.materials[run.material.index], run.begin, run.end, &s->surface);
  }
  ClearRadiance(s->hits.count, &s->total);
  s->per_light.resize(plan.light_layer_count);
  for (Soa3<float>& layer : s->per_light) ClearSoa(s->hits.count, &layer);
  const BatchBounds bounds = plan.cull_lights ? BoundHits(s->hits) : BatchBounds{};
  clock->Charge(Stage::kRefine);
  for (const PlannedLight& planned : plan.lights) {
    ++stats->light_batches;
    if (plan.cull_lights && !MayReach(planned.reach, bounds)) {
      ++stats->culled_lights;
      continue;
    }
    const Light& light = scene.lights[planned.index];
    EvaluateLight(light, scene.camera.position, s->hits, s->surface, &s->light);
    clock->Charge(Stage::kLight);
    if (planned.shadow_rays) {
      CastShadows(plan, planned, s, stats);
      clock->Charge(Stage::kShadow);
    }
    const bool apart = planned.layer >= 0;
    ReflectedRadiance* radiance = apart ? &s->single : &s->total;
    if (apart) ClearRadiance(s->hits.count, &s->single);
    for (const MaterialRun& run : s->runs) {
      ShadeRun(plan.materials[run.material.index], planned.color, {s->hits, s->surface, s->light},
               run.begin, run.end, &s->narrow, radiance);
    }
    if (apart) KeepLightLayer(static_cast<size_t>(planned.layer), s);
    stats->shades += s->hits.count;
    clock->Charge(Stage::kShade);
  }
}

}  // namespace

void RenderTile(const RenderPlan& plan, const Window& tile, TileScratch* scratch, StripFilm* film,
                RenderStats* stats) {
  TileScratch& s = *scratch;
  StageClock clock(stats);
  const int spp = plan.scene->image.spp;
  const bool anything = plan.intersector != nullptr &&
                        (!plan.tiles || plan.intersector->EnterTile(tile, &s.candidates));
  clock.Charge(Stage::kIntersect);
  if (!anything && HasUnitWeights(plan.sampler)) {
    AddBackground(plan, tile, film);
    clock.Charge(Stage::kFilm);
    return;
  }
  for (int first = 0; first < spp; first += plan.samples_per_round) {
    const int count = std::min(plan.samples_per_round, spp - first);
    MakeRays(plan, tile, first, count, &s);
    stats->camera_rays += s.rays.count;
    clock.Charge(Stage::kSample);
    s.hits.count = 0;
    if (anything) {
      if (plan.tiles) {
        plan.intersector->ClosestInTile(s.candidates, count, s.rays, &s.closest);
      } else {
        plan.intersector->Closest(s.rays, &s.closest);
      }
      clock.Charge(Stage::kIntersect);
      const size_t hit_count = SortHits(plan, &s);
      if (hit_count > 0) {
        plan.intersector->Refine(s.rays, s.closest, s.hit_rays.data(), hit_count, &s.hits);
        stats->hits += hit_count;
        ShadeHits(plan, &s, &clock, stats);
      }
    }
    AddToFilm(plan, {tile, count, s.weight.data()}, &s, film);
    clock.Charge(Stage::kFilm);
  }
}

}  // namespace nacre
