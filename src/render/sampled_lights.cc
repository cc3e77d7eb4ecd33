// SPDX-License-Identifier: Apache-2.0
#include "render/sampled_lights.h"

#include <algorithm>

#include "render/mapped_horizon.h"
#include "render/sampled_kernel.h"
#include "render/sampled_shadows.h"
#include "shading/lobe_sample.h"

namespace nacre {
namespace {

// A batch of hits under one light.
struct Lit {
  const DirectBatch& batch;
  const PlannedSampledLight& planned;
  const SampleNumbers& numbers;
  SampledRoom& c;

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

// Which components of the reflected light directions are sampled for.
struct Components {
  bool diffuse, specular;
};

// The strategies that are combined by multiple importance sampling (the balance heuristic): the pdf
// of a component's directions is the sum of theirs.
struct SamplingStrategies {
  bool light;  // SampleLight
  // SampleCosine or SampleUnderLayers, for the diffuse part; SampleLobe always is, for the specular
  // part.
  bool cosine;
};

// Lets a unit light shine on the hits that face it along the directions and do not miss it. What
// lobes and mirrors look along is above the horizon already, but for rounding, which must not hide
// a lobe that is narrower.
void FaceLight(const Lit& lit, bool may_be_below_horizon) {
  lit.batch.stats.directions_not_finite +=
      ShineAlong(lit.c.directions, lit.surface(), lit.count(), &lit.light());
  if (may_be_below_horizon) HideLightsBelowHorizon(lit.batch);
}

void Shadow(const Lit& lit) {
  lit.batch.clock.Charge(Stage::kLight);
  if (!lit.planned.shadow_rays) return;
  CastSampledShadows(lit.batch, lit.planned, lit.c.directions);
  lit.batch.clock.Charge(Stage::kShadow);
}

// What a light of colour 1 reflects along room.light, into c.unit.
void ShadeUnit(const Lit& lit) {
  static const ShadingLight kUnit = [] {
    ShadingLight light;
    light.form = LightForm::kGiven;
    light.color = Rgb(1, 1, 1);
    return light;
  }();
  const LightOnBatch light{&kUnit, &lit.light()};
  for (const MaterialRun& run : lit.runs()) {
    const LitHits hits{lit.hits(),
                       lit.surface(),
                       {&light, 1},
                       lit.batch.surfaces.textures.get(),
                       OutputMode::kOverwrite};
    ShadeRun(*run.shading, hits, run.begin, run.end, &lit.batch.room.shade, &lit.c.unit);
    AddMirroredLobe(lit.batch, run, kUnit, OutputMode::kOverwrite, &lit.c.unit);
  }
}

// sum += part x c.weight x the radiance that is seen.
void AddSeen(const Lit& lit, const Soa3<float>& part, Soa3<float>* sum) {
  const SampledLight& light = lit.planned.light;
  const Soa3<float>* radiance = IsColored(light) ? &lit.c.directions.radiance : nullptr;
  AddWeighted(part, lit.c.weight.data(), radiance, light.color, lit.count(), sum);
}

void WeighByPdf(const Lit& lit) {
  FindWeights(lit.light().irradiance.data(), lit.c.pdf.data(), lit.count(), lit.c.weight.data());
}

void WeighDiffuse(const Lit& lit, const SamplingStrategies& strategies) {
  const uint8_t* flat = lit.planned.closed_form ? lit.c.flat.data() : nullptr;
  FindDiffusePdf({strategies.light, strategies.cosine}, lit.c.directions, lit.surface(), flat,
                 lit.count(), lit.c.pdf.data());
  for (const MaterialRun& run : lit.runs()) {
    if (!strategies.cosine || run.shading->layers.empty()) continue;
    UnderLayersPdf(*run.shading, lit.RangeOf(run), lit.c.directions.to_light, lit.c.pdf.data());
    if (!strategies.light) continue;
    for (size_t i = run.begin; i < run.end; ++i) lit.c.pdf[i] += lit.c.directions.pdf[i];
  }
  WeighByPdf(lit);
}

void WeighSpecular(const Lit& lit, const SamplingStrategies& strategies) {
  const LightDirections& directions = lit.c.directions;
  for (const MaterialRun& run : lit.runs()) {
    LobePdf(*run.shading, lit.RangeOf(run), lit.light(), &lit.batch.room.shade, lit.c.pdf.data());
    AddMirroredLobePdf(lit.batch, run, lit.c.pdf.data());
  }
  if (strategies.light) {
    for (size_t i = 0; i < lit.count(); ++i) lit.c.pdf[i] += directions.pdf[i];
  }
  // A batch is sampled if any of its hits has a lobe. Those without must not get a share then, or
  // a pixel would depend on what else is in its tile.
  for (const MaterialRun& run : lit.runs()) {
    if (HasSampledLobe(*run.shading)) continue;
    std::fill(lit.c.pdf.data() + run.begin, lit.c.pdf.data() + run.end, 0.0f);
  }
  WeighByPdf(lit);
}

// Adds what is reflected along the directions, which were chosen in one of the strategies and which
// FaceLight has seen.
void AddDirections(const Lit& lit, const SamplingStrategies& strategies,
                   const Components& components) {
  Shadow(lit);
  ShadeUnit(lit);
  if (components.diffuse) {
    WeighDiffuse(lit, strategies);
    AddSeen(lit, lit.c.unit.diffuse, &lit.single().diffuse);
  }
  if (components.specular) {
    WeighSpecular(lit, strategies);
    AddSeen(lit, lit.c.unit.specular, &lit.single().specular);
  }
  lit.batch.stats.shades += lit.count();
  lit.batch.clock.Charge(Stage::kShade);
}

// Which hits reflect the light in closed form: those that see all of it, and whose diffuse
// reflection does not ask where it comes from. Returns how many do.
size_t FindFlat(const Lit& lit) {
  const bool some_see_all = !lit.planned.shadow_rays || !lit.planned.shadowed.empty();
  size_t count = 0;
  for (const MaterialRun& run : lit.runs()) {
    const bool may_be = lit.planned.closed_form && some_see_all && DiffuseIsFlat(*run.shading);
    for (size_t i = run.begin; i < run.end; ++i) {
      lit.c.flat[i] = may_be && NeverShadowed(lit.planned, lit.hits().primitive[i]) ? 1 : 0;
      count += lit.c.flat[i];
    }
  }
  return count;
}

// The diffuse part of those: as if all light came along the normal.
void AddClosedForm(const Lit& lit) {
  const SampledLight& light = lit.planned.light;
  Soa3<float>& irradiance = lit.c.directions.radiance;
  LightIrradiance(light, lit.hits(), lit.surface(), &irradiance);
  const Soa3<float>& n = lit.surface().normal;
  LightBatch& batch = lit.light();
  for (size_t i = 0; i < lit.count(); ++i) {
    batch.to_light.x[i] = n.x[i];
    batch.to_light.y[i] = n.y[i];
    batch.to_light.z[i] = n.z[i];
    batch.irradiance[i] = lit.c.flat[i] != 0 ? 1.0f : 0.0f;
    lit.c.weight[i] = IsColored(light) ? 1 : irradiance.x[i];
  }
  ShadeUnit(lit);
  AddSeen(lit, lit.c.unit.diffuse, &lit.single().diffuse);
  lit.batch.clock.Charge(Stage::kLight);
}

void ChoosePoints(const Lit& lit, size_t pair) {
  SamplePair(lit.batch.plan.pairs, lit.batch.first_pair + lit.planned.first_pair + pair,
             lit.numbers, lit.hits().ray.data(), lit.count(), &lit.c.points);
}

void AddByLight(const Lit& lit, const Components& components) {
  ChoosePoints(lit, 0);
  SampleLight(lit.planned.light, lit.hits(), lit.c.points, &lit.c.directions);
  FaceLight(lit, true);
  AddDirections(lit, {true, IsSky(lit.planned.light)}, components);
}

void AddByCosine(const Lit& lit) {
  ChoosePoints(lit, 1);
  SampleCosine(lit.surface(), lit.count(), lit.c.points.u.data(), lit.c.points.v.data(),
               &lit.c.directions.to_light);
  for (const MaterialRun& run : lit.runs()) {
    if (run.shading->layers.empty()) continue;
    SampleUnderLayers(*run.shading, lit.RangeOf(run), lit.c.points.u.data(), lit.c.points.v.data(),
                      &lit.c.directions.to_light);
  }
  FindLight(lit.planned.light, lit.hits(), &lit.c.directions);
  FaceLight(lit, true);
  AddDirections(lit, {HasSampler(lit.planned.light), true}, {true, false});
}

void AddByLobe(const Lit& lit) {
  ChoosePoints(lit, 2);
  // Hits without a lobe look along their normals, and reflect nothing of it.
  Soa3<float>& to_light = lit.c.directions.to_light;
  const Soa3<float>& n = lit.surface().normal;
  std::copy_n(n.x.data(), lit.count(), to_light.x.data());
  std::copy_n(n.y.data(), lit.count(), to_light.y.data());
  std::copy_n(n.z.data(), lit.count(), to_light.z.data());
  for (const MaterialRun& run : lit.runs()) {
    SampleLobe(*run.shading, lit.RangeOf(run), lit.c.points.u.data(), lit.c.points.v.data(),
               &to_light);
    RaiseLobeSamples(lit.batch, run, &to_light);
  }
  FindLight(lit.planned.light, lit.hits(), &lit.c.directions);
  FaceLight(lit, false);
  AddDirections(lit, {HasSampler(lit.planned.light), false}, {false, true});
}

// Perfect mirrors see the light in one direction.
void AddByMirror(const Lit& lit) {
  MirrorDirections({lit.hits(), lit.surface(), 0, lit.count()}, &lit.c.directions.to_light);
  FindLight(lit.planned.light, lit.hits(), &lit.c.directions);
  ClearRadiance(lit.count(), &lit.c.unit);
  FaceLight(lit, false);
  AlignedArray<float>& irradiance = lit.light().irradiance;
  for (const MaterialRun& run : lit.runs()) {
    const LobeRange range = lit.RangeOf(run);
    for (size_t i = run.begin; i < run.end; ++i) {
      if (!IsMirror(*run.shading, range, i)) irradiance[i] = 0;
    }
    if (AnyMirror(*run.shading, range)) {
      MirrorReflectance(*run.shading, range, &lit.c.unit.specular);
    }
  }
  Shadow(lit);
  std::copy_n(irradiance.data(), lit.count(), lit.c.weight.data());
  AddSeen(lit, lit.c.unit.specular, &lit.single().specular);
  lit.batch.clock.Charge(Stage::kShade);
}

void ShadeByOne(const Lit& lit) {
  bool mirrors = false, lobes = false;
  for (const MaterialRun& run : lit.runs()) {
    mirrors = mirrors || AnyMirror(*run.shading, lit.RangeOf(run));
    lobes = lobes || HasSampledLobe(*run.shading);
  }
  const size_t flat = FindFlat(lit);
  const bool sampled_diffuse = flat < lit.count();
  if (flat > 0) AddClosedForm(lit);
  if (HasSampler(lit.planned.light) && (lobes || sampled_diffuse)) {
    AddByLight(lit, {sampled_diffuse, lobes});
  }
  if (IsSky(lit.planned.light) && sampled_diffuse) AddByCosine(lit);
  if (lobes) AddByLobe(lit);
  if (mirrors) AddByMirror(lit);
}

}  // namespace

void ShadeBySampledLights(const DirectBatch& batch, const SampleNumbers& numbers) {
  std::unique_ptr<SampledRoom>& room = batch.room.sampled;
  if (!room) room = std::make_unique<SampledRoom>();
  for (const PlannedSampledLight& planned : batch.plan.sampled_lights) {
    ++batch.stats.light_batches;
    ClearRadiance(batch.lit(), &batch.room.single);
    ShadeByOne({batch, planned, numbers, *room});
    AddLight(batch, batch.room.single, planned.layer);
  }
}

}  // namespace nacre
