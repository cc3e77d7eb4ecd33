// SPDX-License-Identifier: Apache-2.0
#include "render/sampled_lights.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "render/lighting_kernel.h"
#include "render/sampled_shadows.h"

namespace nacre {
namespace {

// A batch of hits and one light that it is shaded by.
struct LitBatch {
  const DirectBatch& batch;
  const PlannedSampledLight& planned;
  const LightShadows& shadows;
  const SampleNumbers& numbers;
  SampledRoom& room;

  size_t count() const { return batch.lit(); }
  const HitBatch& hits() const { return batch.hits(); }
  const Surface& surface() const { return batch.surface(); }
  LightBatch& light() const { return batch.room.light; }
  ReflectedRadiance& single() const { return batch.room.single; }
  std::span<const MaterialRun> runs() const { return LitRuns(batch.surfaces); }
  MaterialHits HitsOf(const MaterialRun& run) const { return nacre::HitsOf(batch.surfaces, run); }
};

// What directions are sampled for, by component.
struct Components {
  bool diffuse, specular;
};

// A point of a flat light, relative to the camera, and its unit normal.
struct LightPlane {
  Vec3d place, normal;
};

std::optional<LightPlane> PlaneOf(const SampledLight& light) {
  if (light.form == SampledForm::kRectangle || light.form == SampledForm::kDisk) {
    return LightPlane{light.place, light.normal};
  }
  if (light.form != SampledForm::kMesh || !light.mesh->is_flat) return std::nullopt;
  const TriangleLight<double>& triangle = light.mesh->triangles[0];
  return LightPlane{light.place + triangle.corner,
                    triangle.edge_x.cross(triangle.edge_y).normalized()};
}

// Whether the triangle lies in the light's plane, within the rounding of both: 2^-44 of their
// coordinates, as in scene/light_shapes.cc.
bool LiesInPlane(const TracedShapes& shapes, const LightPlane& light, uint32_t primitive) {
  if (IsSphere(shapes.primitives, primitive)) return false;
  const TriangleRef triangle = TriangleOf(shapes.primitives, primitive);
  const Vec3d& camera = shapes.primitives.scene->camera.position;
  for (size_t k = 0; k < 3; ++k) {
    const Vec3d& corner = triangle.mesh->positions[triangle.Vertex(k)];
    const double extent = SumOfAbs(corner) + SumOfAbs(light.place) + shapes.camera_extent;
    const double distance = std::abs((corner - camera - light.place).dot(light.normal));
    if (!(distance <= 0x1p-44 * extent)) return false;
  }
  return true;
}

// Sets light() to 0 at hits on triangles in the plane of a flat light. No light reaches them, but
// rounding places some of them in front of the light, and these may face it, as the back of a wall
// does that the light is let into.
void HideLightInPlane(const LitBatch& lit) {
  const std::optional<LightPlane> light = PlaneOf(lit.planned.light);
  if (!light) return;
  const HitBatch& hits = lit.hits();
  bool in_plane = false;
  for (size_t i = 0; i < lit.count(); ++i) {
    if (i == 0 || hits.primitive[i] != hits.primitive[i - 1]) {
      in_plane = LiesInPlane(lit.batch.plan.shapes, *light, hits.primitive[i]);
    }
    if (in_plane) lit.light().irradiance[i] = 0;
  }
}

// Sets light() to a light of irradiance 1 from the sampled directions.
void Illuminate(const LitBatch& lit) {
  lit.batch.stats.directions_not_finite +=
      IlluminateAlong(lit.room.directions, lit.surface(), lit.count(), &lit.light());
  HideUnreflectedLight(lit.batch);
  HideLightInPlane(lit);
}

// Sets light() to 0 at hits in shadow.
void ApplyShadows(const LitBatch& lit) {
  lit.batch.clock.Charge(Stage::kLight);
  if (!lit.shadows.rays) return;
  CastSampledShadows(lit.batch, lit.planned, lit.shadows, lit.room.directions);
  lit.batch.clock.Charge(Stage::kShadow);
}

// Computes room.unit, the reflection of light() if the light has colour 1, and pdfs.
void EvaluateUnitLight(const LitBatch& lit, const LobePdfs& pdfs) {
  static const ShadingLight kUnit{.form = LightForm::kGiven, .color = Rgb(1, 1, 1)};
  for (const MaterialRun& run : lit.runs()) {
    EvaluateBsdf({lit.HitsOf(run), kUnit, &lit.light(), &lit.room.unit}, &lit.batch.room.bsdf,
                 pdfs);
  }
}

// Adds part * room.weight * the light's colour to the sum and to the component that it is; also
// times `by_color`, the radiance along room.directions or the irradiance, if the light IsColored.
void AddWeightedRadiance(const LitBatch& lit, const Soa3<float>& part, const Soa3<float>& by_color,
                         Soa3<float>* component) {
  const SampledLight& light = lit.planned.light;
  const Soa3<float>* const factor = IsColored(light) ? &by_color : nullptr;
  const auto add_to = [&](Soa3<float>* to) {
    AddWeighted(part, lit.room.weight.data(), factor, light.color, lit.count(), to);
  };
  add_to(&lit.single().sum);
  if (lit.batch.plan.lights.components) add_to(component);
}

// Sets room.weight to 1 over the sum of the strategies' pdfs for lobes of one kind, where by_lobes
// is null if they are not sampled. It is 0 at hits without such lobes: a batch is sampled if any of
// its hits has one, and a pixel must not depend on the other pixels of its tile.
void WeightByPdf(const LitBatch& lit, const float* by_lobes, LobeKind kind) {
  const SampledLight& light = lit.planned.light;
  const float* const by_light = HasSampler(light) ? lit.room.directions.pdf.data() : nullptr;
  float* const weight = lit.room.weight.data();
  ComputeWeights(lit.light().irradiance.data(), by_light, by_lobes, lit.count(), weight);
  for (const MaterialRun& run : lit.runs()) {
    if (HasLobes(*run.shading, kind)) continue;
    std::fill(weight + run.begin, weight + run.end, 0.0f);
  }
}

// Adds the light reflected along the directions, which were sampled by one of the strategies and
// passed to Illuminate. The strategies, SampleLight and SampleLobes, are combined by multiple
// importance sampling (the balance heuristic): the pdf of a component's directions is the sum of
// theirs. The components are sampled apart (SampleLobes of one kind), not by one direction for
// both: where diffuse reflection has a closed form, or light samples alone serve it as well, as
// under an area light, no directions are spent on it.
void AddSampledLight(const LitBatch& lit, const Components& components) {
  const Soa3<float>& radiance = lit.room.directions.radiance;
  LobePdfs pdfs;
  if (components.diffuse && IsSky(lit.planned.light)) pdfs.diffuse = lit.room.diffuse_pdf.data();
  if (components.specular) pdfs.glossy = lit.room.glossy_pdf.data();
  ApplyShadows(lit);
  EvaluateUnitLight(lit, pdfs);
  if (components.diffuse) {
    WeightByPdf(lit, pdfs.diffuse, LobeKind::kDiffuse);
    if (lit.planned.closed_form) {
      for (size_t i = 0; i < lit.count(); ++i) {
        if (lit.room.closed_form[i] != 0) lit.room.weight[i] = 0;
      }
    }
    AddWeightedRadiance(lit, lit.room.unit.diffuse, radiance, &lit.single().diffuse);
  }
  if (components.specular) {
    WeightByPdf(lit, pdfs.glossy, LobeKind::kGlossy);
    AddWeightedRadiance(lit, lit.room.unit.specular, radiance, &lit.single().specular);
  }
  lit.batch.stats.shades += lit.count();
  lit.batch.clock.Charge(Stage::kShade);
}

// How many hits reflect diffusely in closed form, and how many are left to samples.
struct DiffuseHits {
  size_t closed_form = 0, sampled = 0;
};

// Finds the hits whose diffuse reflection has a closed form: those from which the whole light is
// visible, and whose diffuse term does not depend on the light's direction.
DiffuseHits FindClosedForm(const LitBatch& lit) {
  const bool some_see_all = !lit.shadows.rays || !lit.shadows.shadowed.empty();
  DiffuseHits hits;
  for (const MaterialRun& run : lit.runs()) {
    const bool diffuse = HasLobes(*run.shading, LobeKind::kDiffuse);
    const bool may_be =
        diffuse && lit.planned.closed_form && some_see_all && DiffuseIsFlat(*run.shading);
    for (size_t i = run.begin; i < run.end; ++i) {
      const bool closed_form = may_be && NeverShadowed(lit.shadows, lit.hits().primitive[i]);
      lit.room.closed_form[i] = closed_form ? 1 : 0;
      hits.closed_form += closed_form ? 1 : 0;
      hits.sampled += diffuse && !closed_form ? 1 : 0;
    }
  }
  return hits;
}

// Adds the diffuse reflection of these hits: the irradiance, as if all light came along the normal.
void AddClosedForm(const LitBatch& lit) {
  const SampledLight& light = lit.planned.light;
  Soa3<float>& irradiance = lit.room.irradiance;
  LightIrradiance(light, lit.hits(), lit.surface(), &irradiance);
  LightBatch& batch = lit.light();
  CopySoa(lit.surface().normal, lit.count(), &batch.light_vector);
  for (size_t i = 0; i < lit.count(); ++i) {
    batch.irradiance[i] = lit.room.closed_form[i] != 0 ? 1.0f : 0.0f;
    lit.room.weight[i] = IsColored(light) ? 1 : irradiance.x[i];
  }
  HideLightInPlane(lit);
  EvaluateUnitLight(lit, {});
  AddWeightedRadiance(lit, lit.room.unit.diffuse, irradiance, &lit.single().diffuse);
  lit.batch.clock.Charge(Stage::kLight);
}

// Draws a pair of random numbers for each hit.
void DrawPoints(const LitBatch& lit, size_t pair) {
  SamplePair(lit.batch.plan.lights.pairs, lit.planned.first_pair + pair, lit.numbers,
             lit.hits().ray.data(), lit.count(), &lit.room.points);
}

void AddLightSamples(const LitBatch& lit, const Components& components) {
  DrawPoints(lit, 0);
  SampleLight(lit.planned.light, lit.hits(), lit.room.points, &lit.room.directions);
  Illuminate(lit);
  AddSampledLight(lit, components);
}

// The normals of all hits: hits without a lobe to sample get these as directions, and a weight of
// 0.
void SetDirectionsToNormals(const LitBatch& lit) {
  CopySoa(lit.surface().normal, lit.count(), &lit.room.directions.to_light);
}

void AddBsdfSamples(const LitBatch& lit, LobeKind kind) {
  const bool diffuse = kind == LobeKind::kDiffuse;
  DrawPoints(lit, diffuse ? 1 : 2);
  SetDirectionsToNormals(lit);
  for (const MaterialRun& run : lit.runs()) {
    SampleLobes(lit.HitsOf(run), kind, lit.room.points.u.data(), lit.room.points.v.data(),
                &lit.batch.room.bsdf, &lit.room.directions.to_light);
  }
  FindLight(lit.planned.light, lit.hits(), &lit.room.directions);
  Illuminate(lit);
  AddSampledLight(lit, {diffuse, !diffuse});
}

// Adds the light that the perfect mirrors at one level of stacks reflect, which comes from one
// direction.
void AddMirrorReflection(const LitBatch& lit, size_t level) {
  const auto is_mirror = [&](const MaterialRun& run) { return AnyMirror(lit.HitsOf(run), level); };
  if (std::ranges::none_of(lit.runs(), is_mirror)) return;
  Soa3<float>& reflectance = lit.room.unit.specular;
  ClearSoa(lit.count(), &reflectance);
  SetDirectionsToNormals(lit);
  for (const MaterialRun& run : lit.runs()) {
    SampleMirror(lit.HitsOf(run), level, &lit.room.directions.to_light, &reflectance);
  }
  FindLight(lit.planned.light, lit.hits(), &lit.room.directions);
  Illuminate(lit);
  AlignedArray<float>& irradiance = lit.light().irradiance;
  for (size_t i = 0; i < lit.count(); ++i) {
    const bool reflects = (reflectance.x[i] > 0) | (reflectance.y[i] > 0) | (reflectance.z[i] > 0);
    if (!reflects) irradiance[i] = 0;
  }
  ApplyShadows(lit);
  std::copy_n(irradiance.data(), lit.count(), lit.room.weight.data());
  AddWeightedRadiance(lit, reflectance, lit.room.directions.radiance, &lit.single().specular);
  lit.batch.clock.Charge(Stage::kShade);
}

void ShadeBySampledLight(const LitBatch& lit) {
  const bool lobes = std::ranges::any_of(
      lit.runs(), [](const MaterialRun& run) { return HasLobes(*run.shading, LobeKind::kGlossy); });
  const DiffuseHits diffuse = FindClosedForm(lit);
  const bool sampled_diffuse = diffuse.sampled > 0;
  if (diffuse.closed_form > 0) AddClosedForm(lit);
  if (HasSampler(lit.planned.light) && (lobes || sampled_diffuse)) {
    AddLightSamples(lit, {sampled_diffuse, lobes});
  }
  if (IsSky(lit.planned.light) && sampled_diffuse) AddBsdfSamples(lit, LobeKind::kDiffuse);
  if (lobes) AddBsdfSamples(lit, LobeKind::kGlossy);
  size_t levels = 1;
  for (const MaterialRun& run : lit.runs()) {
    levels = std::max(levels, 1 + run.shading->coats.size());
  }
  for (size_t level = 0; level < levels; ++level) AddMirrorReflection(lit, level);
}

}  // namespace

void ShadeBySampledLights(const DirectBatch& batch, const SampleNumbers& numbers) {
  std::unique_ptr<SampledRoom>& room = batch.room.sampled;
  if (!room) room = std::make_unique<SampledRoom>();
  for (size_t i = 0; i < batch.plan.lights.sampled.size(); ++i) {
    const PlannedSampledLight& planned = batch.plan.lights.sampled[i];
    ++batch.stats.light_batches;
    ClearRadiance(batch.lit(), &batch.room.single);
    ShadeBySampledLight({batch, planned, batch.plan.shadows.sampled[i], numbers, *room});
    if (planned.layer >= 0) AddToLightLayer(batch, batch.room.single, planned.layer);
    AddRadiance(batch, batch.room.single);
  }
}

}  // namespace nacre
