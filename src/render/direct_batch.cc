// SPDX-License-Identifier: Apache-2.0
#include "render/direct_batch.h"

namespace nacre {
namespace {

// The arrays do not overlap, so that the compiler can vectorise.
void AddArray(const float* __restrict from, size_t begin, size_t end, float* __restrict to) {
  for (size_t i = begin; i < end; ++i) to[i] += from[i];
}

}  // namespace

void AddSoa(const Soa3<float>& from, size_t begin, size_t end, Soa3<float>* to) {
  AddArray(from.x.data(), begin, end, to->x.data());
  AddArray(from.y.data(), begin, end, to->y.data());
  AddArray(from.z.data(), begin, end, to->z.data());
}

void AddToLightLayer(const DirectBatch& batch, const ReflectedRadiance& of_light, int layer) {
  const Soa3<float>& shown = batch.plan.diffuse_light_layers ? of_light.diffuse : of_light.sum;
  AddSoa(shown, 0, batch.lit(), &batch.radiance.per_light[static_cast<size_t>(layer)]);
}

void AddRadiance(const DirectBatch& batch, const ReflectedRadiance& of_light) {
  ReflectedRadiance& total = batch.radiance.total;
  AddSoa(of_light.sum, 0, batch.lit(), &total.sum);
  if (!batch.plan.components) return;
  AddSoa(of_light.diffuse, 0, batch.lit(), &total.diffuse);
  AddSoa(of_light.specular, 0, batch.lit(), &total.specular);
}

}  // namespace nacre
