// SPDX-License-Identifier: Apache-2.0
#include "render/sampled_lights.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "render/mapped_horizon.h"
#include "render/sampled_kernel.h"
#include "render/sampled_shadows.h"
#include "shading/lobe_sample.h"

namespace nacre {
namespace {

// A batch of hits and one light that it is shaded by.
struct LitBatch {
  const DirectBatch& batch;
  const PlannedSampledLight& planned;
  const SampleNumbers& numbers;
  SampledRoom& room;

  size_t count() const { return batch.lit(); }
  const HitBatch& hits() const { return batch.hits(); }
  const Surface& surface() const { return batch.surface(); }
  LightBatch& light() const { return batch.room.light; }
  ReflectedRadiance& single() const { return batch.room.single; }
  std::span<const MaterialRun> runs() const { return LitRuns(batch.surfaces); }
  LobeRange RangeOf(const MaterialRun& run) const {
    return {hits(), surface(), run.begin, run.end, batch.surfaces.textures.get()};
  }
};

// The components of the reflected light that directions are sampled for.
struct Components {
  bool diffuse, specular;
};

// The strategies that are combined by multiple importance sampling (the balance heuristic): the pdf
// of a component's directions is the sum of theirs.
struct SamplingStrategies {
  bool light;  // SampleLight
  // SampleCosine or SampleUnderLayers, for the diffuse component. SampleLobe is always used, for
  // the specular component.
  bool cosine;
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
bool LiesInPlane(const DirectPlan& plan, const LightPlane& light, uint32_t primitive) {
  if (IsSphere(plan.primitives, primitive)) return false;
  const TriangleRef triangle = TriangleOf(plan.primitives, primitive);
  const Vec3d& camera = plan.primitives.scene->camera.position;
  for (size_t k = 0; k < 3; ++k) {
    const Vec3d& corner = triangle.mesh->positions[triangle.Vertex(k)];
    const double extent = SumOfAbs(corner) + SumOfAbs(light.place) + plan.camera_extent;
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
      in_plane = LiesInPlane(lit.batch.plan, *light, hits.primitive[i]);
    }
    if (in_plane) lit.light().irradiance[i] = 0;
  }
}

// Sets light() to a light of irradiance 1 from the sampled directions. Directions of lobes and
// mirrors are above the horizon except for rounding errors, which must not hide a lobe that is
// narrower than these: they are not tested again.
void Illuminate(const LitBatch& lit, bool may_be_below_horizon) {
  lit.batch.stats.directions_not_finite +=
      IlluminateAlong(lit.room.directions, lit.surface(), lit.count(), &lit.light());
  if (may_be_below_horizon) HideLightsBelowHorizon(lit.batch);
  HideLightInPlane(lit);
}

// Sets light() to 0 at hits in shadow.
void ApplyShadows(const LitBatch& lit) {
  lit.batch.clock.Charge(Stage::kLight);
  if (!lit.planned.shadow_rays) return;
  CastSampledShadows(lit.batch, lit.planned, lit.room.directions);
  lit.batch.clock.Charge(Stage::kShadow);
}

// Computes room.unit: the reflection of light() if the light has colour 1.
void ShadeUnitLight(const LitBatch& lit) {
  static const ShadingLight kUnit = [] {
    ShadingLight light;
    light.form = LightForm::kGiven;
    light.color = Rgb(1, 1, 1);
    return light;
  }();
  const LitHits hits{lit.hits(),   lit.surface(), kUnit,
                     &lit.light(), true,          lit.batch.surfaces.textures.get()};
  for (const MaterialRun& run : lit.runs()) {
    ShadeRun(*run.shading, hits, run.begin, run.end, &lit.batch.room.shade, &lit.room.unit);
    AddMirroredLobe(lit.batch, run, kUnit, &lit.room.unit);
  }
}

// Adds part * room.weight * the light's radiance to the sum and to the component that it is.
void AddWeightedRadiance(const LitBatch& lit, const Soa3<float>& part, Soa3<float>* component) {
  const SampledLight& light = lit.planned.light;
  const Soa3<float>* radiance = IsColored(light) ? &lit.room.directions.radiance : nullptr;
  const auto add_to = [&](Soa3<float>* to) {
    AddWeighted(part, lit.room.weight.data(), radiance, light.color, lit.count(), to);
  };
  add_to(&lit.single().sum);
  if (lit.batch.plan.components) add_to(component);
}

// Sets room.weight to 1 / room.pdf.
void WeightByPdf(const LitBatch& lit) {
  ComputeWeights(lit.light().irradiance.data(), lit.room.pdf.data(), lit.count(),
                 lit.room.weight.data());
}

void WeightDiffuse(const LitBatch& lit, const SamplingStrategies& strategies) {
  const uint8_t* closed_form = lit.planned.closed_form ? lit.room.closed_form.data() : nullptr;
  ComputeDiffusePdf({strategies.light, strategies.cosine}, lit.room.directions, lit.surface(),
                    closed_form, lit.count(), lit.room.pdf.data());
  for (const MaterialRun& run : lit.runs()) {
    if (!strategies.cosine || run.shading->layers.empty()) continue;
    UnderLayersPdf(*run.shading, lit.RangeOf(run), lit.room.directions.to_light,
                   strategies.light ? lit.room.directions.pdf.data() : nullptr,
                   lit.room.pdf.data());
  }
  WeightByPdf(lit);
}

void WeightSpecular(const LitBatch& lit, const SamplingStrategies& strategies) {
  const LightDirections& directions = lit.room.directions;
  for (const MaterialRun& run : lit.runs()) {
    LobePdf(*run.shading, lit.RangeOf(run), lit.light(), &lit.batch.room.shade,
            lit.room.pdf.data());
    AddMirroredLobePdf(lit.batch, run, lit.room.pdf.data());
  }
  if (strategies.light) {
    for (size_t i = 0; i < lit.count(); ++i) lit.room.pdf[i] += directions.pdf[i];
  }
  // A batch is sampled if any of its hits has a lobe. Hits without one must still get nothing:
  // otherwise a pixel would depend on the other pixels of its tile.
  for (const MaterialRun& run : lit.runs()) {
    if (HasSampledLobe(*run.shading)) continue;
    std::fill(lit.room.pdf.data() + run.begin, lit.room.pdf.data() + run.end, 0.0f);
  }
  WeightByPdf(lit);
}

// Adds the light reflected along the directions, which were sampled by one of the strategies and
// passed to Illuminate.
void AddSampledLight(const LitBatch& lit, const SamplingStrategies& strategies,
                     const Components& components) {
  ApplyShadows(lit);
  ShadeUnitLight(lit);
  if (components.diffuse) {
    WeightDiffuse(lit, strategies);
    AddWeightedRadiance(lit, lit.room.unit.diffuse, &lit.single().diffuse);
  }
  if (components.specular) {
    WeightSpecular(lit, strategies);
    AddWeightedRadiance(lit, lit.room.unit.specular, &lit.single().specular);
  }
  lit.batch.stats.shades += lit.count();
  lit.batch.clock.Charge(Stage::kShade);
}

// Finds the hits whose diffuse reflection has a closed form: those from which the whole light is
// visible, and whose diffuse term does not depend on the light's direction. Returns their number.
size_t FindClosedForm(const LitBatch& lit) {
  const bool some_see_all = !lit.planned.shadow_rays || !lit.planned.shadowed.empty();
  size_t count = 0;
  for (const MaterialRun& run : lit.runs()) {
    const bool may_be = lit.planned.closed_form && some_see_all && DiffuseIsFlat(*run.shading);
    for (size_t i = run.begin; i < run.end; ++i) {
      lit.room.closed_form[i] =
          may_be && NeverShadowed(lit.planned, lit.hits().primitive[i]) ? 1 : 0;
      count += lit.room.closed_form[i];
    }
  }
  return count;
}

// Adds the diffuse reflection of these hits: the irradiance, as if all light came along the normal.
void AddClosedForm(const LitBatch& lit) {
  const SampledLight& light = lit.planned.light;
  Soa3<float>& irradiance = lit.room.directions.radiance;
  LightIrradiance(light, lit.hits(), lit.surface(), &irradiance);
  const Soa3<float>& n = lit.surface().normal;
  LightBatch& batch = lit.light();
  for (size_t i = 0; i < lit.count(); ++i) {
    batch.to_light.x[i] = n.x[i];
    batch.to_light.y[i] = n.y[i];
    batch.to_light.z[i] = n.z[i];
    batch.irradiance[i] = lit.room.closed_form[i] != 0 ? 1.0f : 0.0f;
    lit.room.weight[i] = IsColored(light) ? 1 : irradiance.x[i];
  }
  HideLightInPlane(lit);
  ShadeUnitLight(lit);
  AddWeightedRadiance(lit, lit.room.unit.diffuse, &lit.single().diffuse);
  lit.batch.clock.Charge(Stage::kLight);
}

// Draws a pair of random numbers for each hit.
void DrawPoints(const LitBatch& lit, size_t pair) {
  SamplePair(lit.batch.plan.pairs, lit.batch.first_pair + lit.planned.first_pair + pair,
             lit.numbers, lit.hits().ray.data(), lit.count(), &lit.room.points);
}

void AddLightSamples(const LitBatch& lit, const Components& components) {
  DrawPoints(lit, 0);
  SampleLight(lit.planned.light, lit.hits(), lit.room.points, &lit.room.directions);
  Illuminate(lit, true);
  AddSampledLight(lit, {true, IsSky(lit.planned.light)}, components);
}

void AddCosineSamples(const LitBatch& lit) {
  DrawPoints(lit, 1);
  SampleCosine(lit.surface(), lit.count(), lit.room.points.u.data(), lit.room.points.v.data(),
               &lit.room.directions.to_light);
  for (const MaterialRun& run : lit.runs()) {
    if (run.shading->layers.empty()) continue;
    SampleUnderLayers(*run.shading, lit.RangeOf(run), lit.room.points.u.data(),
                      lit.room.points.v.data(), &lit.room.directions.to_light);
  }
  FindLight(lit.planned.light, lit.hits(), &lit.room.directions);
  Illuminate(lit, true);
  AddSampledLight(lit, {HasSampler(lit.planned.light), true}, {true, false});
}

void AddLobeSamples(const LitBatch& lit) {
  DrawPoints(lit, 2);
  // Hits without a lobe get their normals as directions, and a weight of 0.
  Soa3<float>& to_light = lit.room.directions.to_light;
  const Soa3<float>& n = lit.surface().normal;
  std::copy_n(n.x.data(), lit.count(), to_light.x.data());
  std::copy_n(n.y.data(), lit.count(), to_light.y.data());
  std::copy_n(n.z.data(), lit.count(), to_light.z.data());
  for (const MaterialRun& run : lit.runs()) {
    SampleLobe(*run.shading, lit.RangeOf(run), lit.room.points.u.data(), lit.room.points.v.data(),
               &lit.batch.room.shade, &to_light);
    RaiseLobeSamples(lit.batch, run, &to_light);
  }
  FindLight(lit.planned.light, lit.hits(), &lit.room.directions);
  Illuminate(lit, false);
  AddSampledLight(lit, {HasSampler(lit.planned.light), false}, {false, true});
}

// Adds the light that perfect mirrors reflect, which comes from one direction.
void AddMirrorReflection(const LitBatch& lit) {
  MirrorDirections({lit.hits(), lit.surface(), 0, lit.count()}, &lit.room.directions.to_light);
  FindLight(lit.planned.light, lit.hits(), &lit.room.directions);
  ClearRadiance(lit.count(), &lit.room.unit);
  Illuminate(lit, false);
  AlignedArray<float>& irradiance = lit.light().irradiance;
  for (const MaterialRun& run : lit.runs()) {
    const LobeRange range = lit.RangeOf(run);
    for (size_t i = run.begin; i < run.end; ++i) {
      if (!IsMirror(*run.shading, range, i)) irradiance[i] = 0;
    }
    if (AnyMirror(*run.shading, range)) {
      MirrorReflectance(*run.shading, range, &lit.room.unit.specular);
    }
  }
  ApplyShadows(lit);
  std::copy_n(irradiance.data(), lit.count(), lit.room.weight.data());
  AddWeightedRadiance(lit, lit.room.unit.specular, &lit.single().specular);
  lit.batch.clock.Charge(Stage::kShade);
}

void ShadeBySampledLight(const LitBatch& lit) {
  bool mirrors = false, lobes = false;
  for (const MaterialRun& run : lit.runs()) {
    mirrors = mirrors || AnyMirror(*run.shading, lit.RangeOf(run));
    lobes = lobes || HasSampledLobe(*run.shading);
  }
  const size_t in_closed_form = FindClosedForm(lit);
  const bool sampled_diffuse = in_closed_form < lit.count();
  if (in_closed_form > 0) AddClosedForm(lit);
  if (HasSampler(lit.planned.light) && (lobes || sampled_diffuse)) {
    AddLightSamples(lit, {sampled_diffuse, lobes});
  }
  if (IsSky(lit.planned.light) && sampled_diffuse) AddCosineSamples(lit);
  if (lobes) AddLobeSamples(lit);
  if (mirrors) AddMirrorReflection(lit);
}

}  // namespace

void ShadeBySampledLights(const DirectBatch& batch, const SampleNumbers& numbers) {
  std::unique_ptr<SampledRoom>& room = batch.room.sampled;
  if (!room) room = std::make_unique<SampledRoom>();
  for (const PlannedSampledLight& planned : batch.plan.sampled_lights) {
    ++batch.stats.light_batches;
    ClearRadiance(batch.lit(), &batch.room.single);
    ShadeBySampledLight({batch, planned, numbers, *room});
    if (planned.layer >= 0) AddToLightLayer(batch, batch.room.single, planned.layer);
    AddRadiance(batch, batch.room.single);
  }
}

}  // namespace nacre
