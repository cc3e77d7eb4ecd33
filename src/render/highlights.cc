// SPDX-License-Identifier: Apache-2.0
#include "render/highlights.h"

#include <variant>

namespace nacre {

std::vector<HighlightLight> FindHighlightLights(const Scene& scene, const DirectPlan& direct) {
  std::vector<HighlightLight> lights;
  for (const PlannedPunctualLight& planned : direct.lights) {
    const auto& kind = scene.lights[planned.index].kind;
    if (const auto* sun = std::get_if<DirectionalLight>(&kind)) {
      lights.push_back({lights.size(), true, -sun->direction_of_travel.normalized(), 0});
      continue;
    }
    const auto* point = std::get_if<PointLight>(&kind);
    const Vec3d& position = point != nullptr ? point->position : std::get<SpotLight>(kind).position;
    lights.push_back({lights.size(), false, position - scene.camera.position, 0});
  }
  size_t number = lights.size();
  for (const PlannedSampledLight& planned : direct.sampled_lights) {
    const SampledLight& light = planned.light;
    if (IsSky(light)) continue;
    const Vec3d diagonal = light.edge_x + light.edge_y;  // of rectangles
    lights.push_back(
        {number++, false, light.place + diagonal / 2, light.radius + diagonal.length() / 2});
  }
  return lights;
}

double HalfVectorWidth(const SurfacePlan& surfaces, const AdaptivePlan& adaptive,
                       uint32_t material) {
  const ShadingMaterial& prepared = surfaces.materials[material];
  if (HasDeltaLobe(prepared) || (prepared.coat && HasDeltaLobe(*prepared.coat))) return 0;
  const auto* phong = std::get_if<PhongFamilyModel>(&prepared.model);
  const bool mirrored = phong != nullptr && phong->model != PhongModel::kBlinnPhong;
  return adaptive.lobe_widths[material] * (mirrored ? 0.5 : 1);
}

}  // namespace nacre
