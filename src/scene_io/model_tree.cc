// SPDX-License-Identifier: Apache-2.0
#include "scene_io/model_tree.h"

#include <algorithm>
#include <utility>
#include <variant>

#include "scene/material_parameters.h"
#include "scene_io/material_json.h"

namespace nacre {
namespace {

Json PointJson(const Vec3d& v) { return {v.x, v.y, v.z}; }

Json ColorJson(const Rgb& color) {
  if (color.x == color.y && color.y == color.z) return color.x;
  return {color.x, color.y, color.z};
}

void AddAttenuation(const Attenuation& attenuation, Json* json) {
  if (attenuation == Attenuation::InverseSquare()) return;
  (*json)["attenuation"] = {{"constant", attenuation.constant},
                            {"linear", attenuation.linear},
                            {"quadratic", attenuation.quadratic}};
}

}  // namespace

Json ModelLightJson(const Light& light) {
  Json json;
  if (const auto* ambient = std::get_if<AmbientLight>(&light.kind)) {
    return {{"type", "ambient"}, {"radiance", ColorJson(ambient->radiance)}};
  }
  if (const auto* sky = std::get_if<EnvironmentLight>(&light.kind)) {
    const auto* const room = std::get_if<PictureSky>(&sky->sky);
    if (room == nullptr) return json;
    json = {{"type", "environment"},
            {"scale", ColorJson(room->scale)},
            {"rotate_deg", sky->rotate_deg},
            {"background", sky->background}};
  } else if (const auto* sun = std::get_if<DirectionalLight>(&light.kind)) {
    json = {{"type", "directional"},
            {"direction_of_travel", PointJson(sun->direction_of_travel)},
            {"irradiance", ColorJson(sun->irradiance)}};
  } else if (const auto* point = std::get_if<PointLight>(&light.kind)) {
    json = {{"type", "point"},
            {"position", PointJson(point->position)},
            {"intensity", ColorJson(point->intensity)}};
    AddAttenuation(point->attenuation, &json);
  } else if (const auto* spot = std::get_if<SpotLight>(&light.kind)) {
    json = {{"type", "spot"},
            {"position", PointJson(spot->position)},
            {"intensity", ColorJson(spot->intensity)},
            {"direction_of_travel", PointJson(spot->direction_of_travel)},
            {"cutoff_deg", spot->cutoff_deg},
            {"inner_deg", spot->inner_deg},
            {"exponent", spot->exponent},
            {"edge", spot->edge == SpotEdge::kSquare ? "square" : "smoothstep"}};
    AddAttenuation(spot->attenuation, &json);
  } else {
    return json;
  }
  if (!light.shadows) json["shadows"] = false;
  return json;
}

Json CameraJson(const Camera& camera) {
  const bool perspective = camera.projection == Projection::kPerspective;
  Json json = {{"type", perspective ? "perspective" : "orthographic"},
               {"position", PointJson(camera.position)},
               {"look_at", PointJson(camera.look_at)},
               {"up", PointJson(camera.up)}};
  if (perspective) {
    json["fov_y_deg"] = camera.fov_y_deg;
  } else {
    json["height"] = camera.height;
  }
  return json;
}

void AddMaterials(const Scene& scene, Json* put) {
  Json& materials = (*put)["materials"];
  for (const Material& material : scene.materials) {
    if (ModelOf(material) == nullptr) continue;
    Json whole = MaterialJson(material);
    if (materials.contains(material.name)) whole.update(materials[material.name]);
    materials[material.name] = std::move(whole);
  }
}

// What has a type was put whole; of others members were put, or null, which has removed them.
void AddLights(const Scene& scene, Json* put) {
  Json own = put->value("lights", Json::object()), lights = Json::object();
  for (const auto& [name, light] : own.items()) {
    if (light.is_object() && light.contains("type")) lights[name] = light;
  }
  for (const Light& light : scene.lights) {
    if (lights.contains(light.name)) continue;
    Json whole = ModelLightJson(light);
    if (!whole.is_null()) lights[light.name] = std::move(whole);
  }
  (*put)["lights"] = std::move(lights);
}

Json ModelTree(const Scene& scene, const ImageSettings& image, Json put) {
  AddMaterials(scene, &put);
  AddLights(scene, &put);
  put["camera"] = CameraJson(scene.camera);
  Json whole = {{"width", image.width}, {"height", image.height},   {"spp", image.spp},
                {"seed", image.seed},   {"shadows", image.shadows}, {"culling", image.culling}};
  whole.update(put.value("image", Json::object()));
  put["image"] = std::move(whole);
  put["background"] = ColorJson(scene.background);
  put["nacre"] = 1;
  return put;
}

}  // namespace nacre
