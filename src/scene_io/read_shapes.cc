// SPDX-License-Identifier: Apache-2.0
// scene_io/read_shapes.cc: the part "shapes". Meshes: read_meshes.cc. Grids, pairs and clouds:
// read_generators.cc.
#include <array>
#include <utility>

#include "base/error.h"
#include "scene/displace.h"
#include "scene_io/readers.h"

namespace nacre {
namespace {

void ReadSphere(JsonObject* shape, SceneContext* context) {
  Sphere sphere;
  shape->Require("center", "[x, y, z]");
  shape->Point("center", &sphere.center);
  shape->Require("radius", "a length greater than 0");
  shape->Number("radius", limits::kLength, &sphere.radius);
  ReadMaterialOf(shape, context, &sphere.material);
  Displacement displacement;
  if (!ReadDisplacement(shape, true, context, &displacement)) {
    context->budget->Spend(1);
    context->scene->spheres.push_back(sphere);
    return;
  }
  displacement.center = sphere.center;
  displacement.size = sphere.radius;
  const auto segments = static_cast<uint64_t>(displacement.segments);
  context->budget->Spend(segments * segments);
  Mesh mesh = TessellateSphere(sphere, displacement.segments);
  Displace(*context->scene, displacement, &mesh);
  context->scene->meshes.push_back(std::move(mesh));
}

struct ShapeType {
  std::string_view name;
  void (*read)(JsonObject*, SceneContext*);
};
constexpr std::array<ShapeType, 7> kShapeTypes = {{{"sphere", ReadSphere},
                                                   {"mesh", ReadMesh},
                                                   {"icosphere", ReadIcosphere},
                                                   {"uv_sphere", ReadUvSphere},
                                                   {"grid", ReadGrid},
                                                   {"pair", ReadPair},
                                                   {"cloud", ReadCloud}}};

void ReadShape(const JsonValue& value, SceneContext* context) {
  std::array<std::string_view, kShapeTypes.size()> names;
  for (size_t i = 0; i < names.size(); ++i) names[i] = kShapeTypes[i].name;
  JsonObject shape(value);
  shape.Require("type", "one of: sphere, mesh, icosphere, uv_sphere, grid, pair, cloud");
  size_t type = 0;
  if (!shape.Choice("type", names, &type)) return;
  try {
    kShapeTypes[type].read(&shape, context);
  } catch (const Error& error) {  // of a generator
    for (const Fault& fault : error.faults()) value.AddFault(fault.what, fault.hint);
  }
  shape.RefuseOthers();
}

}  // namespace

void ReadShapes(const JsonValue& value, SceneContext* context) {
  if (!value.Expect(value.json.is_array(), "an array", "[{\"type\": \"sphere\", ...}, ...]"))
    return;
  for (size_t i = 0; i < value.json.size(); ++i) {
    ReadShape({value.json[i], value.path.Element(i), value.faults}, context);
  }
}

}  // namespace nacre
