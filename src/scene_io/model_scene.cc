// SPDX-License-Identifier: Apache-2.0
#include "scene_io/model_scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

#include <Imath/ImathBox.h>

#include "base/error.h"
#include "scene/idle_layers.h"
#include "scene_io/overrides.h"
#include "scene_io/read_scene.h"
#include "scene_io/readers.h"
#include "scene_io/scene_json.h"

namespace nacre {
namespace {

// Calls use(center, radius) for balls that together enclose all shapes. Vertices of meshes have
// radius 0.
template <class Use>
void ForEachPoint(const Scene& scene, const Use& use) {
  for (const Mesh& mesh : scene.meshes) {
    for (const Vec3d& position : mesh.positions) use(position, 0.0);
  }
  for (const Sphere& sphere : scene.spheres) use(sphere.center, sphere.radius);
}

// Unit vectors to the right of the camera, upwards, and back from the scene to the camera.
struct View {
  Vec3d right, up, back;
};
View ViewOf(const Camera& camera) {
  const Vec3d back = (camera.position - camera.look_at).normalized();
  const Vec3d right = camera.up.cross(back).normalized();
  return {right, back.cross(right), back};
}

Light MakeDirectional(std::string name, const Vec3d& to_light, double irradiance) {
  return {.name = std::move(name), .kind = DirectionalLight{-to_light, Rgb(irradiance)}};
}

// A soft box of a studio: a round light at infinity with a soft edge.
struct SoftBox {
  Vec3d to_box;       // unit
  double half_angle;  // radians, to where the radiance has fallen to a half
  double fade;        // radians, from full radiance to none
  double radiance;
};

// The surroundings of a model in the studio, which give metals and glossy materials something to
// reflect: a room, dark below and light above, with a soft box around the key light, one around the
// fill light and a bright ceiling. Surfaces that face up get the irradiance of a uniform radiance
// of 0.35, those that face the camera of 0.25, those that face down of 0.06.
std::shared_ptr<const SkyPicture> MakeStudioRoom(const View& view) {
  // A texel is 0.7 degrees wide: a perfect mirror shows steps, which the soft edges of the boxes
  // hide.
  constexpr int kWidth = 512, kHeight = 256;
  constexpr double kDegree = std::numbers::pi / 180;
  const std::array<SoftBox, 3> boxes = {{
      {(view.right * -0.6 + view.up * 0.8 + view.back * 0.9).normalized(), 20 * kDegree,
       8 * kDegree, 1.6},
      {(view.right * 0.9 + view.up * 0.2 + view.back * 0.6).normalized(), 14 * kDegree, 8 * kDegree,
       0.8},
      {view.up, 30 * kDegree, 40 * kDegree, 0.3},
  }};
  auto picture = std::make_shared<SkyPicture>();
  picture->width = kWidth;
  picture->height = kHeight;
  picture->rgb.reserve(size_t{3} * kWidth * kHeight);
  for (int y = 0; y < kHeight; ++y) {
    const double theta = (y + 0.5) / kHeight * std::numbers::pi;
    for (int x = 0; x < kWidth; ++x) {
      const double phi = (x + 0.5) / kWidth * 2 * std::numbers::pi;
      const Vec3d direction(std::sin(phi) * std::sin(theta), std::cos(theta),
                            -std::cos(phi) * std::sin(theta));
      const double height = direction.dot(view.up);
      double radiance = height < 0 ? 0.06 : 0.06 + 0.14 * height;
      for (const SoftBox& box : boxes) {
        const double angle = std::acos(std::clamp(direction.dot(box.to_box), -1.0, 1.0));
        const double t = std::clamp((box.half_angle - angle) / box.fade + 0.5, 0.0, 1.0);
        radiance += box.radiance * t * t * (3 - 2 * t);
      }
      picture->rgb.insert(picture->rgb.end(), 3, static_cast<float>(radiance));
    }
  }
  return picture;
}

void SetMaterials(const JsonValue& value, SceneContext* context) {
  JsonObject object(value, "materials by name");
  if (!object.is_object()) return;
  Scene* const scene = context->scene;
  const std::vector<std::string> names = NamesOf(scene->materials);
  for (const auto& [name, json] : value.json.items()) {
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end()) {
      FaultUnknownName(value, "material", name, names);
      continue;
    }
    Material& material = scene->materials[static_cast<size_t>(found - names.begin())];
    ChangeMaterial({json, value.path.Member(name), value.faults}, context, &material);
  }
}

// Completes lights of which only single members are set, and removes those of the scene that are
// set to null.
Json CompletedLights(const JsonValue& value, Scene* scene) {
  if (!value.json.is_object()) return value.json;
  Json lights = Json::object();
  for (const auto& [name, own] : value.json.items()) {
    const auto found = std::ranges::find(scene->lights, name, &Light::name);
    Json whole = found == scene->lights.end() ? Json() : ModelLightJson(*found);
    if (own.is_null()) {
      if (found != scene->lights.end()) scene->lights.erase(found);
      continue;
    }
    if (!own.is_object() || own.contains("type") || whole.is_null()) {
      whole = own;
    } else {
      // The room's scale does not apply to another sky, which has its own.
      const bool other_sky =
          own.contains("radiance") || own.contains("gradient") || own.contains("quadratic");
      if (other_sky) whole.erase("scale");
      whole.update(own);
    }
    lights[name] = std::move(whole);
  }
  return lights;
}

// Adds new lights, and replaces lights of the scene with the same name.
void SetLights(const JsonValue& value, const SceneContext& context, Scene* scene) {
  std::vector<Light> lights;
  const Json whole = CompletedLights(value, scene);
  ReadLights({whole, value.path, value.faults}, context, &lights);
  for (Light& light : lights) {
    const auto found = std::ranges::find(scene->lights, light.name, &Light::name);
    if (found == scene->lights.end()) {
      scene->lights.push_back(std::move(light));
    } else {
      *found = std::move(light);
    }
  }
}

// Points the camera at all spheres and meshes, in a three-quarter view from the front, the right
// and above. Keeps its projection and field of view.
void FrameScene(Scene* scene) {
  Imath::Box3d box;
  ForEachPoint(*scene, [&](const Vec3d& point, double reach) {
    box.extendBy(point - Vec3d(reach));
    box.extendBy(point + Vec3d(reach));
  });
  if (box.isEmpty()) box = Imath::Box3d(Vec3d(-1), Vec3d(1));
  Camera& camera = scene->camera;
  camera.look_at = box.center();
  camera.position = camera.look_at + Vec3d(0.55, 0.4, 1).normalized();
  camera.up = Vec3d(0, 1, 0);
  const auto [right, up, back] = ViewOf(camera);
  const double aspect = static_cast<double>(scene->image.width) / scene->image.height;
  // Leaves a tenth of the picture free on the sides that the model fills.
  constexpr double kFilled = 0.9;
  const double half_y = camera.fov_y_deg * (std::numbers::pi / 360);
  const double tan_y = kFilled * std::tan(half_y), tan_x = tan_y * aspect;
  double distance = 0, height = 0;
  ForEachPoint(*scene, [&, right = right, up = up, back = back](const Vec3d& point, double reach) {
    const Vec3d p = point - camera.look_at;
    const double x = std::abs(p.dot(right)), y = std::abs(p.dot(up));
    // The distance at which the planes that bound the view touch the ball.
    const auto needed = [&](double off_axis, double tangent) {
      return p.dot(back) + off_axis / tangent + reach * std::hypot(1, 1 / tangent);
    };
    distance = std::max({distance, needed(x, tan_x), needed(y, tan_y)});
    height = std::max({height, 2 * (y + reach), 2 * (x + reach) / aspect});
  });
  const double size = std::max(box.size().length(), limits::kLength.min);
  camera.position = camera.look_at + back * std::max(distance, size / 2);
  camera.height = std::max(height / kFilled, limits::kLength.min);
}

// For scenes without any light: adds the three lights of photography (key, fill, rim), placed
// relative to the camera, an environment ("sky") that shows a room with soft boxes, for metals to
// reflect, and a grey background.
void AddStudioLights(Scene* scene) {
  const auto [right, up, back] = ViewOf(scene->camera);
  // White paper under the key light alone has radiance 0.8. The fill light brightens shadows, the
  // rim light separates the model from the background.
  const bool is_classic =
      std::any_of(scene->materials.begin(), scene->materials.end(), [](const Material& material) {
        const auto* phong = std::get_if<PhongMaterial>(&material.model);
        return phong != nullptr && phong->convention == PhongConvention::kClassic;
      });
  const double key = 0.8 * (is_classic ? 1 : std::numbers::pi);
  scene->lights.push_back(MakeDirectional("key", right * -0.6 + up * 0.8 + back * 0.9, key));
  scene->lights.push_back(MakeDirectional("fill", right * 0.9 + up * 0.2 + back * 0.6, 0.25 * key));
  scene->lights.back().shadows = false;
  scene->lights.push_back(MakeDirectional("rim", right * 0.4 + up * 0.7 + back * -1, 0.6 * key));
  Light sky;
  sky.name = "sky";
  // The classic Phong convention has an ambient term of its own, and reflects no environment.
  if (is_classic) {
    sky.kind = AmbientLight{Rgb(0.12)};
  } else {
    sky.kind = EnvironmentLight{.sky = PictureSky{MakeStudioRoom({right, up, back}), Rgb(1)},
                                .background = false};
  }
  scene->lights.push_back(std::move(sky));
  scene->background = Rgb(0.18);
}

}  // namespace

bool CompleteCoordinates(Scene* scene) {
  bool any = false;
  for (Mesh& mesh : scene->meshes) {
    if (!mesh.uvs.empty() || TexturesOf(scene->materials[mesh.material.index]).empty()) continue;
    mesh.uvs.assign(mesh.positions.size(), Vec2d(0, 0));
    any = true;
  }
  return any;
}

void SplitColoredMaterials(Scene* scene) {
  std::map<uint32_t, uint32_t> colored;  // index of the copy by index of the original
  for (Mesh& mesh : scene->meshes) {
    if (mesh.colors.empty()) continue;
    const auto next = static_cast<uint32_t>(scene->materials.size());
    const auto [copy, is_new] = colored.try_emplace(mesh.material.index, next);
    if (is_new) {
      Material material = scene->materials[mesh.material.index];
      const auto* const lambert = std::get_if<LambertMaterial>(&material.model);
      const bool unlit = lambert != nullptr && lambert->albedo == Rgb(0);
      material.vertex_colors = unlit ? VertexColors::kEmission : VertexColors::kBase;
      material.name += " with vertex colours";
      scene->materials.push_back(std::move(material));
    }
    mesh.material = {copy->second};
  }
}

ModelOverrides OverridesOf(const LoadOptions& options) {
  ModelOverrides overrides;
  LoadOptions environment;
  environment.environment = options.environment;
  ApplyOptions(environment, &overrides.root);
  overrides.own_lights = !options.environment.empty();
  for (const auto& [pointer, json] : options.overrides) {
    ReplaceValue(pointer, json, &overrides.root);
    // Setting all of "lights" removes the model's own lights, as in a scene file.
    if (pointer == "/lights") overrides.own_lights = true;
  }
  return overrides;
}

bool CompleteModelScene(const ModelCompletion& how, SceneParts parts, Scene* scene) {
  const Json& root = how.overrides->root;
  FaultList faults;
  JsonObject overrides({root, JsonPath{}, &faults});
  const auto member = [&](std::string_view name, ScenePart part, const auto& read) {
    const auto value = overrides.Find(name);
    if (value && parts.Has(part)) read(*value);
  };
  member("image", ScenePart::kImage,
         [&](const JsonValue& value) { ReadImageSettings(value, &scene->image); });
  // Reads the camera first, as its projection and field of view decide how far away it must be.
  member("camera", ScenePart::kCamera,
         [&](const JsonValue& value) { ReadCamera(value, &scene->camera); });
  if (!how.has_camera && parts.Has(ScenePart::kCamera)) {
    FrameScene(scene);
    FaultList told_already;
    JsonObject again({root, JsonPath{}, &told_already});
    if (const auto camera = again.Find("camera")) ReadCamera(*camera, &scene->camera);
  }
  if (parts.Has(ScenePart::kLights)) {
    if (how.overrides->own_lights) scene->lights.clear();
    const bool needs_light = !how.overrides->own_lights && scene->lights.empty();
    if (needs_light && faults.count() == 0) AddStudioLights(scene);
  }
  SceneBudget budget(how.options->max_primitives.value_or(kDefaultMaxPrimitives));
  TexelBudget texels(0, TexelValuesOf(*scene));
  SceneContext context;
  SetUpContext({.folder = std::filesystem::path(how.file).parent_path(),
                .options = how.options,
                .kept = how.kept},
               nullptr, &budget, &texels, scene, &context);
  for (const Light& light : scene->lights) {
    const auto* const sky = std::get_if<EnvironmentLight>(&light.kind);
    const auto* const room = sky != nullptr ? std::get_if<PictureSky>(&sky->sky) : nullptr;
    if (room != nullptr) context.room = room->picture;
  }
  for (uint32_t i = 0; i < scene->materials.size(); ++i) {  // a split may refer to them
    context.read.names.try_emplace(scene->materials[i].name, MaterialId{i});
  }
  member("lights", ScenePart::kLights,
         [&](const JsonValue& value) { SetLights(value, context, scene); });
  member("textures", ScenePart::kTextures,
         [&](const JsonValue& value) { ReadTextures(value, &context); });
  member("materials", ScenePart::kMaterials,
         [&](const JsonValue& value) { SetMaterials(value, &context); });
  // This comes last, because overrides may set what a file leaves idle. (Complete parts have no
  // idle layers.)
  for (Material& material : scene->materials) RemoveIdleLayers(*scene, &material);
  // New maps may need texture coordinates.
  const bool new_coordinates = parts.Has(ScenePart::kMaterials) && CompleteCoordinates(scene);
  member("background", ScenePart::kBackground,
         [&](const JsonValue& value) { ReadColor(value, limits::kRadiance, &scene->background); });
  overrides.RefuseOthers();
  ThrowFaults(faults, how.file);
  return new_coordinates;
}

}  // namespace nacre
