// SPDX-License-Identifier: Apache-2.0
#include "render/sort_hits.h"

#include <limits>
#include <utility>

#include "render/tile.h"

namespace nacre {
namespace {

// Whether a hit shows the inside of its sphere or the back of its triangle.
bool IsFromBehind(const RenderPlan& plan, const TileScratch& s, size_t hit) {
  const uint32_t primitive = s.hits.primitive[hit];
  const Scene& scene = *plan.scene;
  const Soa3<double>& p = s.hits.position;
  const auto spheres = static_cast<uint32_t>(scene.spheres.size());
  if (primitive < spheres) {
    const Vec3d center = scene.spheres[primitive].center - scene.camera.position;
    const Soa3<float>& n = s.surface.normal;
    return (Vec3d(p.x[hit], p.y[hit], p.z[hit]) - center).dot(Vec3d(n.x[hit], n.y[hit], n.z[hit])) <
           0;
  }
  const Soa3<float>& v = s.surface.to_view;
  return FaceNormalOf(plan, primitive).dot(Vec3d(v.x[hit], v.y[hit], v.z[hit])) < 0;
}

MaterialId MaterialOfHit(const RenderPlan& plan, const TileScratch& s, size_t hit) {
  const MaterialId id = MaterialAt(plan, s.hits.primitive[hit], s.samples.x[s.hits.ray[hit]]);
  if (!plan.one_sided || !plan.scene->materials[id.index].emits_in_front_only) return id;
  return IsFromBehind(plan, s, hit) ? plan.black : id;
}

template <typename T>
void Permute(const AlignedArray<uint32_t>& order, size_t count, const AlignedArray<T>& from,
             AlignedArray<T>* to) {
  for (size_t i = 0; i < count; ++i) (*to)[i] = from[order[i]];
}

template <typename T>
void Permute(const AlignedArray<uint32_t>& order, size_t count, const Soa3<T>& from, Soa3<T>* to) {
  Permute(order, count, from.x, &to->x);
  Permute(order, count, from.y, &to->y);
  Permute(order, count, from.z, &to->z);
}

// Makes hit i the one that was order[i]; the padding repeats the last one.
void PermuteHits(bool exact, TileScratch* s) {
  std::swap(s->hits, s->unsorted_hits);
  std::swap(static_cast<HitDirections&>(s->surface), s->unsorted_directions);
  const HitBatch& from = s->unsorted_hits;
  HitBatch& to = s->hits;
  to.count = from.count;
  to.one_primitive = from.one_primitive;
  const size_t count = RoundUp(from.count, kBatchPadding);
  for (size_t i = from.count; i < count; ++i) s->order[i] = s->order[from.count - 1];
  Permute(s->order, count, from.ray, &to.ray);
  Permute(s->order, count, from.primitive, &to.primitive);
  if (s->positions) Permute(s->order, count, from.position, &to.position);
  Permute(s->order, count, s->unsorted_directions.normal, &s->surface.normal);
  Permute(s->order, count, s->unsorted_directions.to_view, &s->surface.to_view);
  if (!exact) return;
  Permute(s->order, count, from.normal, &to.normal);
  Permute(s->order, count, from.to_view, &to.to_view);
}

constexpr uint32_t kNoRun = std::numeric_limits<uint32_t>::max();

uint32_t& RunOf(MaterialId material, bool interpolated, TileScratch* s) {
  return s->run_of_material[interpolated ? s->run_of_material.size() / 2 + material.index
                                         : material.index];
}

// Finds each hit's run, and with it how many hits a run has.
void CountRuns(const RenderPlan& plan, TileScratch* s) {
  for (size_t i = 0; i < s->hits.count; ++i) {
    const MaterialId material = MaterialOfHit(plan, *s, i);
    const bool interpolated = IsInterpolated(plan, s->hits.primitive[i]);
    uint32_t& run = RunOf(material, interpolated, s);
    if (run == kNoRun) {
      run = static_cast<uint32_t>(s->runs.size());
      s->runs.push_back({material, 0, 0, interpolated});
    }
    s->run_of_hit[i] = run;
    ++s->runs[run].end;
  }
}

}  // namespace

void SortHits(const RenderPlan& plan, TileScratch* scratch) {
  TileScratch* const s = scratch;
  s->run_of_material.resize(2 * plan.materials.size(), kNoRun);
  for (const MaterialRun& run : s->runs) RunOf(run.material, run.interpolated, s) = kNoRun;
  s->runs.clear();
  if (s->hits.one_primitive && !plan.splits && !plan.one_sided) {
    s->runs.push_back({MaterialOfHit(plan, *s, 0), 0, s->hits.count, false});
    return;
  }
  CountRuns(plan, s);
  size_t begin = 0;
  for (const bool interpolated : {false, true}) {
    for (MaterialRun& run : s->runs) {
      if (run.interpolated != interpolated) continue;
      const size_t count = run.end;
      run.begin = run.end = begin;
      begin += count;
    }
  }
  for (size_t i = 0; i < s->hits.count; ++i) {
    s->order[s->runs[s->run_of_hit[i]].end++] = static_cast<uint32_t>(i);
  }
  if (s->runs.size() > 1) PermuteHits(plan.exact_directions, s);
}

}  // namespace nacre
