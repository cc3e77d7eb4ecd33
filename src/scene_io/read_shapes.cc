// SPDX-License-Identifier: Apache-2.0
// scene_io/read_shapes.cc: the part "shapes". Meshes are read by read_meshes.cc; grids, pairs and
// clouds by read_generators.cc.
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "scene/displace.h"
#include "scene_io/readers.h"
#include "scene_io/sphere_file.h"
#include "scene_io/text_file.h"

namespace nacre {
namespace {

void ReadSphere(JsonObject* shape, SceneContext* context) {
  Sphere sphere;
  ReadPlace(shape, &sphere);
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

void ReadSpheres(JsonObject* shape, SceneContext* context) {
  SphereRowSettings settings;
  double radius = 0;
  if (shape->Number("radius", limits::kLength, &radius)) settings.radius = radius;
  if (const auto material = shape->Find("material")) {
    ReadMaterialId(*material, context, &settings.material);
  }
  if (const auto materials = shape->Find("materials")) {
    ReadMaterialList(*materials, context, &settings.materials);
  }
  settings.by_name = &context->read.names;
  const auto file = shape->Require("file", "a .ply, .csv or .npy file");
  // After a fault, materials that the file refers to may be missing.
  if (!file || shape->faults()->count() != 0) return;
  std::string name;
  if (!ReadText(*file, &name)) return;
  try {
    std::vector<Sphere> spheres = ReadSphereFile(
        ResolveReference(context->folder, name, context->references), settings, context->budget);
    std::vector<Sphere>& all = context->scene->spheres;
    if (all.empty()) {
      all = std::move(spheres);
    } else {
      all.insert(all.end(), spheres.begin(), spheres.end());
    }
  } catch (const Error& error) {
    AddFileFaults(error, *file);
  }
}

struct ShapeType {
  std::string_view name;
  void (*read)(JsonObject*, SceneContext*);
};
constexpr std::array<ShapeType, 8> kShapeTypes = {{{"sphere", ReadSphere},
                                                   {"spheres", ReadSpheres},
                                                   {"mesh", ReadMesh},
                                                   {"icosphere", ReadIcosphere},
                                                   {"uv_sphere", ReadUvSphere},
                                                   {"grid", ReadGrid},
                                                   {"pair", ReadPair},
                                                   {"cloud", ReadCloud}}};

// The scene's materials with these names; invalid ids for names that do not exist.
std::vector<MaterialId> FindMaterials(const std::vector<std::string>& names,
                                      const SceneContext& context) {
  std::vector<MaterialId> ids;
  ids.reserve(names.size());
  for (const std::string& name : names) {
    const auto found = context.read.names.find(name);
    ids.push_back(found != context.read.names.end() ? found->second : MaterialId{});
  }
  return ids;
}

bool IsInRange(const Sphere& sphere) {
  return limits::kCoordinate.Contains(sphere.center) && limits::kLength.Contains(sphere.radius);
}

// Does what ReadShape does, for each sphere of the run.
void ReadRun(const SphereRun& run, const PlainSpheres& plain, const std::vector<MaterialId>& ids,
             const JsonValue& shapes, SceneContext* context) {
  for (size_t i = 0; i < run.spheres.size(); ++i) {
    Sphere sphere = run.spheres[i];
    const MaterialId id = ids[sphere.material.index];
    // ReadShape reports what is wrong.
    if (!id.valid() || !IsInRange(sphere) || context->budget->IsSpent()) {
      const Json json = JsonOf(sphere, plain.MaterialOf(sphere));
      ReadShape({json, shapes.path.Element(run.first + i), shapes.faults}, context);
      continue;
    }
    sphere.material = id;
    context->budget->Spend(1);
    context->scene->spheres.push_back(sphere);
  }
}

// Writes a number as people do: 1, not 1.0.
Json AsWritten(double number) {
  const bool whole = std::abs(number) < 1e15 && number == std::trunc(number);
  return whole && !(number == 0 && std::signbit(number)) ? Json(static_cast<int64_t>(number))
                                                         : Json(number);
}

}  // namespace

void ReadShape(const JsonValue& value, SceneContext* context) {
  std::array<std::string_view, kShapeTypes.size()> names;
  for (size_t i = 0; i < names.size(); ++i) names[i] = kShapeTypes[i].name;
  JsonObject shape(value);
  shape.Require("type", "one of: sphere, spheres, mesh, icosphere, uv_sphere, grid, pair, cloud");
  size_t type = 0;
  if (!shape.Choice("type", names, &type)) return;
  try {
    kShapeTypes[type].read(&shape, context);
  } catch (const Error& error) {  // thrown by a generator
    for (const Fault& fault : error.faults()) value.AddFault(fault.what, fault.hint);
  }
  shape.RefuseOthers();
}

Json JsonOf(const Sphere& sphere, const std::string& material) {
  const Vec3d& center = sphere.center;
  return {{"type", "sphere"},
          {"center", {AsWritten(center.x), AsWritten(center.y), AsWritten(center.z)}},
          {"radius", AsWritten(sphere.radius)},
          {"material", material}};
}

void ReadShapes(const JsonValue& value, const PlainSpheres& spheres, SceneContext* context) {
  if (!value.Expect(value.json.is_array(), "an array", "[{\"type\": \"sphere\", ...}, ...]"))
    return;
  const std::vector<MaterialId> ids = FindMaterials(spheres.materials, *context);
  size_t count = 0;
  for (const SphereRun& run : spheres.runs) count += run.spheres.size();
  context->scene->spheres.reserve(count);
  auto run = spheres.runs.begin();
  size_t place = 0;
  for (const Json& shape : value.json) {
    const ShapeCounts first = CountShapes(*context->scene);
    ReadShape({shape, value.path.Element(place++), value.faults}, context);
    context->read.shapes.push_back({first, CountShapes(*context->scene) - first});
    if (run == spheres.runs.end() || run->first != place) continue;
    context->read.runs.push_back(context->scene->spheres.size());
    ReadRun(*run, spheres, ids, value, context);
    place += run->spheres.size();
    ++run;
  }
}

}  // namespace nacre
