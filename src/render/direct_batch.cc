// SPDX-License-Identifier: Apache-2.0
#include "render/direct_batch.h"

namespace nacre {

void HideUnreflectedLight(const DirectBatch& batch) {
  if (!batch.surface().normal_mapped) return;
  for (const MaterialRun& run : LitRuns(batch.surfaces)) {
    HideUnreflectedLight(HitsOf(batch.surfaces, run), &batch.room.light);
  }
}

void AddToLightLayer(const DirectBatch& batch, const ReflectedRadiance& of_light, int layer) {
  const Soa3<float>& shown =
      batch.plan.lights.diffuse_light_layers ? of_light.diffuse : of_light.sum;
  AddSoa(shown, 0, batch.lit(), &batch.radiance.per_light[static_cast<size_t>(layer)]);
}

void AddRadiance(const DirectBatch& batch, const ReflectedRadiance& of_light) {
  ReflectedRadiance& total = batch.radiance.total;
  AddSoa(of_light.sum, 0, batch.lit(), &total.sum);
  if (!batch.plan.lights.components) return;
  AddSoa(of_light.diffuse, 0, batch.lit(), &total.diffuse);
  AddSoa(of_light.specular, 0, batch.lit(), &total.specular);
}

}  // namespace nacre
