// SPDX-License-Identifier: Apache-2.0
#include "render/direct_batch.h"

namespace nacre {
namespace {

// The arrays do not overlap, so that the compiler can vectorise.
void AddArray(const float* __restrict from, size_t count, float* __restrict to) {
  for (size_t i = 0; i < count; ++i) to[i] += from[i];
}

void AddSoa(const Soa3<float>& from, size_t count, Soa3<float>* to) {
  AddArray(from.x.data(), count, to->x.data());
  AddArray(from.y.data(), count, to->y.data());
  AddArray(from.z.data(), count, to->z.data());
}

}  // namespace

void HideUnreflectedLight(const DirectBatch& batch) {
  if (!batch.surface().normal_mapped) return;
  for (const MaterialRun& run : LitRuns(batch.surfaces)) {
    HideUnreflectedLight(BsdfHitsOf(batch.surfaces, run), &batch.room.light);
  }
}

void AddToLightLayer(const DirectBatch& batch, const ReflectedRadiance& of_light, int layer) {
  const Soa3<float>& shown =
      batch.plan.lights.diffuse_light_layers ? of_light.diffuse : of_light.sum;
  AddSoa(shown, batch.lit(), &batch.radiance.per_light[static_cast<size_t>(layer)]);
}

void AddRadiance(const DirectBatch& batch, const ReflectedRadiance& of_light) {
  ReflectedRadiance& total = batch.radiance.total;
  AddSoa(of_light.sum, batch.lit(), &total.sum);
  if (!batch.plan.lights.components) return;
  AddSoa(of_light.diffuse, batch.lit(), &total.diffuse);
  AddSoa(of_light.specular, batch.lit(), &total.specular);
}

}  // namespace nacre
