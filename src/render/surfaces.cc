// SPDX-License-Identifier: Apache-2.0
#include "render/surfaces.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>
#include <variant>

#include <fmt/format.h>

namespace nacre {
namespace {

// Whether a hit shows the inside of its sphere or the back of its triangle.
bool IsFromBehind(const PrimitiveNumbers& primitives, const CameraHits& hits, size_t hit) {
  const uint32_t primitive = hits.batch.primitive[hit];
  const Scene& scene = *primitives.scene;
  if (IsSphere(primitives, primitive)) {
    const Vec3d center = scene.spheres[primitive].center - scene.camera.position;
    const Vec3d normal = VectorAt(hits.directions.normal, hit);
    return (VectorAt(hits.batch.position, hit) - center).dot(normal) < 0;
  }
  return FaceNormalOf(primitives, primitive).dot(VectorAt(hits.directions.to_view, hit)) < 0;
}

// The columns in which a primitive shows one material.
struct MaterialBand {
  MaterialId material;
  double from, to;  // film_x / frame_width
};

MaterialBand BandAt(const SurfacePlan& plan, uint32_t primitive, double film_x) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const MaterialId id = ShapeMaterial(plan.primitives, primitive);
  const auto* split = std::get_if<SplitMaterial>(&plan.primitives.scene->materials[id.index].model);
  if (split == nullptr) return {id, -kInfinity, kInfinity};
  const auto& at = split->at;
  const auto to = std::upper_bound(at.begin(), at.end(), film_x / plan.frame_width);
  return {split->materials[static_cast<size_t>(to - at.begin())],
          to == at.begin() ? -kInfinity : to[-1], to == at.end() ? kInfinity : *to};
}

bool IsIn(const SurfacePlan& plan, const MaterialBand& band, double film_x) {
  const double fraction = film_x / plan.frame_width;
  return band.from <= fraction && fraction < band.to;
}

bool IsInterpolated(const SurfacePlan& plan, uint32_t primitive) {
  return plan.interpolates && !IsSphere(plan.primitives, primitive) &&
         InterpolatesRadiance(*TriangleOf(plan.primitives, primitive).mesh);
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

// Hit i of `to` becomes hit order[i] of `from`. `count` includes the padding.
void PermuteHits(const CameraHits& from, size_t count, const AlignedArray<uint32_t>& order,
                 Surfaces* to) {
  to->hits.one_primitive = from.batch.one_primitive;
  Permute(order, count, from.batch.ray, &to->hits.ray);
  Permute(order, count, from.batch.primitive, &to->hits.primitive);
  if (from.has_positions) Permute(order, count, from.batch.position, &to->hits.position);
  Permute(order, count, from.directions.normal, &to->surface.normal);
  Permute(order, count, from.directions.to_view, &to->surface.to_view);
  if (!from.has_exact_directions) return;
  Permute(order, count, from.batch.normal, &to->hits.normal);
  Permute(order, count, from.batch.to_view, &to->hits.to_view);
}

// Moves the hits to `to`, in the same order.
void SwapHits(CameraHits* from, Surfaces* to) {
  std::swap(from->batch, to->hits);
  std::swap(from->directions, static_cast<HitDirections&>(to->surface));
}

constexpr uint32_t kNoRun = std::numeric_limits<uint32_t>::max();

uint32_t& RunOf(MaterialId material, bool interpolated, SortRoom* room) {
  const size_t half = room->run_of_material.size() / 2;
  return room->run_of_material[interpolated ? half + material.index : material.index];
}

// The index of the run, which is added to the list if it has no hits yet.
uint32_t FindRun(const SurfacePlan& plan, MaterialId material, bool interpolated, SortRoom* room,
                 std::vector<MaterialRun>* runs) {
  uint32_t& run = RunOf(material, interpolated, room);
  if (run == kNoRun) {
    run = static_cast<uint32_t>(runs->size());
    runs->push_back({material, &plan.materials[material.index], 0, 0, interpolated});
  }
  return run;
}

// Finds the segments of the runs, and counts the hits of each run in MaterialRun::end.
void FindSegments(const SurfacePlan& plan, const double* film_x, const CameraHits& hits,
                  SortRoom* room, std::vector<MaterialRun>* runs) {
  const AlignedArray<uint32_t>& primitive = hits.batch.primitive;
  const AlignedArray<uint32_t>& ray = hits.batch.ray;
  const size_t count = hits.batch.count;
  room->segments.clear();
  for (size_t begin = 0, end; begin < count; begin = end) {
    const MaterialBand band = BandAt(plan, primitive[begin], film_x[ray[begin]]);
    // The back of a material that emits in front only counts as another material.
    const bool has_back = plan.emits_in_front_only &&
                          plan.primitives.scene->materials[band.material.index].emits_in_front_only;
    const bool is_back = has_back && IsFromBehind(plan.primitives, hits, begin);
    end = begin + 1;
    while (!has_back && end < count && primitive[end] == primitive[begin] &&
           (!plan.splits || IsIn(plan, band, film_x[ray[end]]))) {
      ++end;
    }
    const uint32_t run = FindRun(plan, is_back ? plan.prepared->black : band.material,
                                 IsInterpolated(plan, primitive[begin]), room, runs);
    (*runs)[run].end += end - begin;
    room->segments.push_back({run, begin, end});
  }
}

void SortHits(const SurfacePlan& plan, const double* film_x, CameraHits* hits, SortRoom* room,
              Surfaces* to) {
  std::vector<MaterialRun>& runs = to->runs;
  room->run_of_material.resize(2 * plan.materials.size(), kNoRun);
  for (const MaterialRun& run : runs) RunOf(run.material, run.interpolated, room) = kNoRun;
  runs.clear();
  if (hits->batch.one_primitive && !plan.splits && !plan.emits_in_front_only) {
    const MaterialId material = ShapeMaterial(plan.primitives, hits->batch.primitive[0]);
    runs.push_back({material, &plan.materials[material.index], 0, hits->batch.count, false});
    return SwapHits(hits, to);
  }
  FindSegments(plan, film_x, *hits, room, &runs);
  size_t begin = 0;
  for (const bool interpolated : {false, true}) {
    for (MaterialRun& run : runs) {
      if (run.interpolated != interpolated) continue;
      const size_t count = run.end;
      run.begin = run.end = begin;
      begin += count;
    }
  }
  if (runs.size() == 1) {
    runs[0].end = hits->batch.count;
    return SwapHits(hits, to);
  }
  for (const HitSegment& segment : room->segments) {
    const size_t size = segment.end - segment.begin;
    size_t& end = runs[segment.run].end;
    std::iota(room->order.begin() + end, room->order.begin() + end + size,
              static_cast<uint32_t>(segment.begin));
    end += size;
  }
  const size_t count = hits->batch.count, padded = RoundUp(count, kBatchPadding);
  for (size_t i = count; i < padded; ++i) room->order[i] = room->order[count - 1];
  PermuteHits(*hits, padded, room->order, to);
  to->hits.count = count;
}

// Makes the hits of the lit runs' coats. A coat's shading normal is the one before the normal maps
// of what is below it, so this must precede their look-up. Returns the most coats of any run.
size_t CopyCoats(Surfaces* s) {
  size_t most = 0;
  for (const MaterialRun& run : LitRuns(*s)) most = std::max(most, run.shading->coats.size());
  if (s->coats.size() < most) s->coats.resize(most);
  for (size_t k = 0; k < most; ++k) CopyToCoat(s->hits, s->surface, &s->coats[k]);
  return most;
}

// Looks up the maps of a run's material or of one of its coats.
void LookUpMaps(const SurfacePlan& plan, const RayFootprints& footprints,
                const ShadingMaterial& material, const MaterialRun& run, HitBatch* hits,
                Surface* surface, std::unique_ptr<HitParameters>* textures) {
  if (material.scene_material == nullptr) return;
  if (!*textures) *textures = std::make_unique<HitParameters>();
  TextureHits(
      {plan.textures, material, run.begin, run.end, *hits, *surface, **textures, footprints});
}

bool MapsNormals(const ShadingMaterial& material) {
  return material.by_hit.normal ||
         std::ranges::any_of(material.coats, [](const auto& c) { return c->by_hit.normal; });
}

// Looks up the maps of the runs' materials and of their coats, `coats` of which are in use.
void LookUpMaps(const SurfacePlan& plan, size_t coats, Surfaces* s) {
  s->surface.normal_mapped =
      plan.textured && std::ranges::any_of(s->runs, [](const MaterialRun& run) {
        return MapsNormals(*run.shading);
      });
  if (s->surface.normal_mapped) {
    CopySoa(s->surface.normal, s->hits.count, &s->surface.interpolated_normal);
  }
  for (size_t k = 0; k < coats; ++k) {
    Surface& coat = s->coats[k].surface;
    coat.normal_mapped = s->surface.normal_mapped;
    if (coat.normal_mapped) {
      CopySoa(s->surface.normal, s->hits.count, &coat.interpolated_normal);
    }
  }
  if (!plan.textured) return;
  for (const MaterialRun& run : s->runs) {
    LookUpMaps(plan, s->footprints, *run.shading, run, &s->hits, &s->surface, &s->textures);
  }
  for (const MaterialRun& run : LitRuns(*s)) {
    for (size_t k = 0; k < run.shading->coats.size(); ++k) {
      CoatHits& coat = s->coats[k];
      LookUpMaps(plan, s->footprints, *run.shading->coats[k], run, &coat.hits, &coat.surface,
                 &coat.textures);
    }
  }
}

void PlanTextures(const Scene& scene, const RenderSettings& settings, const std::vector<bool>& used,
                  KeptTables* tables, SurfacePlan* plan, Explanation* why) {
  const std::vector<MaterialTraits>& traits = plan->prepared->traits;
  size_t count = 0;
  const bool any = Has(plan->prepared->any, MaterialTrait::kTextured);
  for (size_t i = 0; any && i < traits.size(); ++i) {
    count += used[i] && Has(traits[i], MaterialTrait::kTextured) ? 1 : 0;
  }
  plan->textured = count > 0;
  if (!plan->textured) {
    return why->items.push_back({"textures", false, "no shape's material has a map"});
  }
  // The footprint of a sample is its share of the pixel. For adaptive sampling 64 samples are
  // assumed.
  const double samples = settings.max_error > 0 ? 64 : scene.image.spp;
  const double footprint = std::max(1 / std::sqrt(samples), 0.125);
  plan->textures = PrepareTextures(scene, footprint, settings.threads, tables);
  size_t bytes = 0;
  for (const SceneImage& image : scene.images) bytes += image.texels->ImageBytes();
  why->items.push_back(
      {"textures", true,
       scene.images.empty()
           ? fmt::format("no shape's material has a map, but of {} materials with coats or layers "
                         "or anisotropic lobes ambient light, emission and tangents are found hit "
                         "by hit",
                         count)
           : fmt::format("maps on {} materials, those with coats or layers in ambient light "
                         "included: {} images, {:.1f} MiB before their mip levels; a sample's "
                         "footprint is {:g} pixels wide",
                         count, scene.images.size(), static_cast<double>(bytes) / (1 << 20),
                         footprint)});
}

}  // namespace

bool InterpolatesRadiance(const Mesh& mesh) {
  return mesh.interpolation == Interpolation::kFlat ||
         mesh.interpolation == Interpolation::kGouraud;
}

SurfacePlan PlanSurfaces(const Scene& scene, const RenderSettings& settings,
                         const CameraFrame& camera, const Rgb& ambient,
                         std::shared_ptr<const PreparedMaterials> materials,
                         const std::vector<bool>& used, KeptTables* tables, Explanation* why) {
  SurfacePlan plan;
  plan.primitives = NumberPrimitives(scene);
  plan.camera = camera;
  plan.frame_width = scene.image.width;
  why->items.push_back({"ambient light", !IsBlack(ambient),
                        IsBlack(ambient)
                            ? "the scene has none"
                            : "a constant per material without maps, coats and layers"});
  plan.prepared = std::move(materials);
  plan.materials = plan.prepared->all;
  plan.splits = Has(plan.prepared->any, MaterialTrait::kSplit);
  plan.emits_in_front_only = Has(plan.prepared->any, MaterialTrait::kEmitsInFrontOnly);
  const bool coated = Has(plan.prepared->any, MaterialTrait::kCoated);
  why->items.push_back(
      {"coats", coated,
       coated ? "over some materials, each with a lobe of its own" : "no material has any"});
  plan.interpolates = std::any_of(scene.meshes.begin(), scene.meshes.end(), InterpolatesRadiance);
  PlanTextures(scene, settings, used, tables, &plan, why);
  plan.textures.ambient = ambient;
  return plan;
}

bool NeedsExactDirections(const SurfacePlan& plan) {
  return Has(plan.prepared->any, MaterialTrait::kDoubleTerms);
}

MaterialId MaterialAt(const SurfacePlan& plan, uint32_t primitive, double film_x) {
  return BandAt(plan, primitive, film_x).material;
}

void ResolveSurfaces(const SurfacePlan& plan, const double* film_x, CameraHits* hits,
                     SortRoom* room, Surfaces* surfaces) {
  if (hits->batch.count == 0) {
    surfaces->hits.count = 0;
    return;
  }
  SortHits(plan, film_x, hits, room, surfaces);
  surfaces->footprints = {&plan.camera};
  PrepareSurfaces(plan, surfaces);
}

namespace {

// Attenuates the emission and the reflected ambient light of a hit below a coat, which the radiance
// of lights does not include, and adds the ambient light that the coat reflects: its albedo times
// the radiance.
void AttenuateByCoat(const Rgb& ambient, const MaterialHits& at, size_t k, HitParameters* below) {
  const CoatHits& coat = at.coats[k];
  for (size_t i = at.begin; i < at.end; ++i) {
    const Rgb albedo = Rgb(1) - Rgb(VectorAt(coat.surface.transmittance, i));
    const Rgb left = TransmittedAt(at, k, i, NDotV(coat.surface, i));
    SetVector(left * Rgb(VectorAt(below->ambient, i)) + albedo * ambient, i, &below->ambient);
    const Rgb emitted(VectorAt(below->emission, i));
    if (!IsBlack(emitted)) SetVector(EmittedThroughCoat(at, k, i) * emitted, i, &below->emission);
  }
}

// The same of the layers over all coats.
void AttenuateByLayers(const Rgb& ambient, const MaterialHits& at, HitParameters* below) {
  for (const LayerModel& layer : at.material.layers) {
    if (!LiesOverCoats(layer)) continue;
    for (size_t i = at.begin; i < at.end; ++i) {
      const LayerReflection albedo =
          LayerAlbedo(LayerAtHit(layer, at.Maps(), i), NDotV(at.surface, i));
      SetVector(Rgb(VectorAt(below->ambient, i)) * albedo.below + albedo.lobe * ambient, i,
                &below->ambient);
      if (at.material.emission_through != EmissionThrough::kBaseFactors) continue;
      SetVector(Rgb(VectorAt(below->emission, i)) * albedo.below, i, &below->emission);
    }
  }
}

}  // namespace

void PrepareSurfaces(const SurfacePlan& plan, Surfaces* surfaces) {
  Surfaces& s = *surfaces;
  const auto interpolated = std::stable_partition(
      s.runs.begin(), s.runs.end(), [](const MaterialRun& run) { return !run.interpolated; });
  s.lit_runs = static_cast<size_t>(interpolated - s.runs.begin());
  s.lit = s.lit_runs == 0 ? 0 : s.runs[s.lit_runs - 1].end;
  LookUpMaps(plan, CopyCoats(&s), &s);
  for (const MaterialRun& run : LitRuns(s)) {
    PrepareBsdf(*run.shading, run.begin, run.end, s.textures.get(), &s.surface, s.coats);
    if (!run.shading->by_hit.parameters) continue;
    const MaterialHits at{*run.shading, s.hits,           s.surface, run.begin,
                          run.end,      s.textures.get(), s.coats};
    for (size_t k = 0; k < run.shading->coats.size(); ++k) {
      AttenuateByCoat(plan.textures.ambient, at, k, s.textures.get());
    }
    AttenuateByLayers(plan.textures.ambient, at, s.textures.get());
  }
}

}  // namespace nacre
