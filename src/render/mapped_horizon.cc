// SPDX-License-Identifier: Apache-2.0
#include "render/mapped_horizon.h"

#include "render/tile.h"
#include "shading/lobe_sample.h"

namespace nacre {
namespace {

bool HasMirroredLobe(const ShadingMaterial& material) {
  return material.turned && HasSampledLobe(material);
}

// Mirrors scratch->light for the run. False if no hit has a mirrored lobe with light in it.
bool MirrorLight(const RenderPlan& plan, const MaterialRun& run, TileScratch* s) {
  if (!HasMirroredLobe(plan.materials[run.material.index])) return false;
  if (!s->mirrored) s->mirrored = std::make_unique<MirroredLobe>();
  return MirrorAtHorizon(s->surface, run.begin, run.end, s->light, &s->mirrored->light);
}

void AddArray(const MaterialRun& run, const float* from, float* to) {
  for (size_t i = run.begin; i < run.end; ++i) to[i] += from[i];
}

void AddSpecular(const MaterialRun& run, const Soa3<float>& from, Soa3<float>* to) {
  AddArray(run, from.x.data(), to->x.data());
  AddArray(run, from.y.data(), to->y.data());
  AddArray(run, from.z.data(), to->z.data());
}

}  // namespace

void HideBelowHorizon(const RenderPlan& plan, TileScratch* scratch) {
  for (const MaterialRun& run : scratch->runs) {
    if (!plan.materials[run.material.index].turned) continue;
    HideBelowHorizon(scratch->surface, run.begin, run.end, &scratch->light);
  }
}

void RaiseLobeSamples(const RenderPlan& plan, const MaterialRun& run, TileScratch* scratch,
                      Soa3<float>* to_light) {
  if (!HasMirroredLobe(plan.materials[run.material.index])) return;
  RaiseAboveHorizon(scratch->surface, run.begin, run.end, to_light);
}

void AddMirroredLobe(const RenderPlan& plan, const MaterialRun& run, const ShadingLight& light,
                     Leaves leaves, TileScratch* scratch, ReflectedRadiance* radiance) {
  TileScratch& s = *scratch;
  if (!MirrorLight(plan, run, &s)) return;
  ShadingLight given;
  given.form = LightForm::kGiven;
  given.color = light.color;
  const LightOnBatch along{&given, &s.mirrored->light};
  const LitHits lit{s.hits, s.surface, {&along, 1}, s.textures.get(), Leaves::kParts};
  ShadeRun(plan.materials[run.material.index], lit, run.begin, run.end, &s.narrow,
           &s.mirrored->radiance);
  const Soa3<float>& specular = s.mirrored->radiance.specular;
  if (leaves != Leaves::kSum) AddSpecular(run, specular, &radiance->specular);
  if (leaves == Leaves::kSum || leaves == Leaves::kPartsAndSum) {
    AddSpecular(run, specular, &radiance->sum);
  }
}

void AddMirroredLobePdf(const RenderPlan& plan, const MaterialRun& run, TileScratch* scratch,
                        float* pdf) {
  TileScratch& s = *scratch;
  if (!MirrorLight(plan, run, &s)) return;
  MirroredLobe& mirrored = *s.mirrored;
  LobeDensity(plan.materials[run.material.index],
              {s.hits, s.surface, run.begin, run.end, s.textures.get()}, mirrored.light, &s.narrow,
              mirrored.pdf.data());
  for (size_t i = run.begin; i < run.end; ++i) {
    if (mirrored.light.irradiance[i] > 0) pdf[i] += mirrored.pdf[i];
  }
}

}  // namespace nacre
