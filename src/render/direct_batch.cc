// SPDX-License-Identifier: Apache-2.0
#include "render/direct_batch.h"

namespace nacre {
namespace {

// The arrays do not overlap, which lets the compiler use vectors.
void AddArray(const float* __restrict a, size_t count, float* __restrict sum) {
  for (size_t i = 0; i < count; ++i) sum[i] += a[i];
}

void AddSoa(const Soa3<float>& a, size_t count, Soa3<float>* sum) {
  AddArray(a.x.data(), count, sum->x.data());
  AddArray(a.y.data(), count, sum->y.data());
  AddArray(a.z.data(), count, sum->z.data());
}

}  // namespace

void ShowLight(const DirectBatch& batch, const ReflectedRadiance& of_light, int layer) {
  Soa3<float>& to = batch.radiance.per_light[static_cast<size_t>(layer)];
  AddSoa(of_light.diffuse, batch.lit(), &to);
  AddSoa(of_light.specular, batch.lit(), &to);
}

void AddLight(const DirectBatch& batch, const ReflectedRadiance& of_light, int layer) {
  if (layer >= 0) ShowLight(batch, of_light, layer);
  AddSoa(of_light.diffuse, batch.lit(), &batch.radiance.total.diffuse);
  AddSoa(of_light.specular, batch.lit(), &batch.radiance.total.specular);
}

}  // namespace nacre
