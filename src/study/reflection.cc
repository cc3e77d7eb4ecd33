// SPDX-License-Identifier: Apache-2.0
#include "study/reflection.h"

#include <cmath>
#include <memory>

#include "shading/bsdf.h"

namespace nacre {

Reflection ReflectByKernel(const ShadingMaterial& material, const Vec3d& normal,
                           const Vec3d& to_light, const Vec3d& to_view) {
  // Batches are a hundred kilobytes each, too large for the stack.
  struct Batches {
    HitBatch hits;
    Surface surface;
    LightBatch light;
    std::vector<CoatHits> coats;
    BsdfRoom room;
    ReflectedRadiance radiance;
  };
  const auto batches = std::make_unique<Batches>();
  HitBatch& hits = batches->hits;
  hits.count = 1;
  const auto put = [](Soa3<double>* soa, const Vec3d& value) {
    soa->x[0] = value.x;
    soa->y[0] = value.y;
    soa->z[0] = value.z;
  };
  put(&hits.normal, normal);
  put(&hits.to_view, to_view);
  put(&hits.position, -to_view);
  Light light;
  light.kind = DirectionalLight{.direction_of_travel = -to_light, .irradiance = Rgb(1)};
  const ShadingLight prepared = PrepareLight(light, Vec3d(0));
  PrepareSurface(hits, &batches->surface);
  EvaluateLight(prepared, hits, batches->surface, &batches->light);
  EvaluateBatch(material, hits, prepared, batches->light, &batches->surface, &batches->coats,
                &batches->room, &batches->radiance);
  const auto get = [](const Soa3<float>& soa) { return Rgb(soa.x[0], soa.y[0], soa.z[0]); };
  return {get(batches->radiance.diffuse), get(batches->radiance.specular)};
}

Vec3d DirectionAt(double degrees) {
  const double angle = degrees * M_PI / 180;
  return {std::sin(angle), 0, std::cos(angle)};
}

}  // namespace nacre
