// SPDX-License-Identifier: Apache-2.0
#include "render/mapped_horizon.h"

#include "shading/lobe_sample.h"

namespace nacre {
namespace {

bool HasMirroredLobe(const ShadingMaterial& material) {
  return material.turned && HasSampledLobe(material);
}

// Mirrors room.light for the run. Returns false if the term f(l') is 0 at all hits.
bool MirrorLight(const DirectBatch& batch, const MaterialRun& run) {
  if (!HasMirroredLobe(*run.shading)) return false;
  DirectRoom& room = batch.room;
  if (!room.mirrored) room.mirrored = std::make_unique<MirroredLobe>();
  return MirrorAtHorizon(batch.surface(), run.begin, run.end, room.light, &room.mirrored->light);
}

}  // namespace

void HideLightsBelowHorizon(const DirectBatch& batch) {
  for (const MaterialRun& run : LitRuns(batch.surfaces)) {
    if (!run.shading->turned) continue;
    HideBelowHorizon(batch.surface(), run.begin, run.end, &batch.room.light);
  }
}

void RaiseLobeSamples(const DirectBatch& batch, const MaterialRun& run, Soa3<float>* to_light) {
  if (!HasMirroredLobe(*run.shading)) return;
  RaiseAboveHorizon(batch.surface(), run.begin, run.end, to_light);
}

void AddMirroredLobe(const DirectBatch& batch, const MaterialRun& run, const ShadingLight& light,
                     ReflectedRadiance* radiance) {
  if (!MirrorLight(batch, run)) return;
  MirroredLobe& mirrored = *batch.room.mirrored;
  ShadingLight given;
  given.form = LightForm::kGiven;
  given.color = light.color;
  const LitHits lit{
      batch.hits(), batch.surface(), given, &mirrored.light, true, batch.surfaces.textures.get()};
  ShadeRun(*run.shading, lit, run.begin, run.end, &batch.room.shade, &mirrored.radiance);
  AddSoa(mirrored.radiance.specular, run.begin, run.end, &radiance->sum);
  AddSoa(mirrored.radiance.specular, run.begin, run.end, &radiance->specular);
}

void AddMirroredLobePdf(const DirectBatch& batch, const MaterialRun& run, float* pdf) {
  if (!MirrorLight(batch, run)) return;
  MirroredLobe& mirrored = *batch.room.mirrored;
  LobePdf(*run.shading,
          {batch.hits(), batch.surface(), run.begin, run.end, batch.surfaces.textures.get()},
          mirrored.light, &batch.room.shade, mirrored.pdf.data());
  for (size_t i = run.begin; i < run.end; ++i) {
    if (mirrored.light.irradiance[i] > 0) pdf[i] += mirrored.pdf[i];
  }
}

}  // namespace nacre
