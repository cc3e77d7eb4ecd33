// scene_io/read_shapes.cc: the part "shapes". Grids, pairs and clouds: read_generators.cc.
#include <array>
#include <cmath>
#include <utility>

#include "base/error.h"
#include "scene/displace.h"
#include "scene/mesh.h"
#include "scene/validate.h"
#include "scene_io/obj.h"
#include "scene_io/readers.h"
#include "scene_io/text_file.h"

namespace nacre {
namespace {

// The member "displacement"; false if there is none, or it has faults.
bool ReadDisplacement(JsonObject* shape, bool is_sphere, SceneContext* context,
                      Displacement* displacement) {
  const Json* const json = shape->Find("displacement");
  if (json == nullptr) return false;
  const size_t before = shape->faults()->count();
  JsonObject object({*json, shape->path().Member("displacement"), shape->faults()},
                    R"({"texture": "hills", "distance": 0.1})");
  if (const Json* texture = object.Require("texture", "the name of one in \"textures\"")) {
    ReadTextureId({*texture, object.path().Member("texture"), object.faults()}, MapUse::kData,
                  context, &displacement->texture);
  }
  object.Number("distance", limits::kCoordinate, &displacement->distance);
  if (is_sphere) object.Whole("segments", limits::kSegments, &displacement->segments);
  object.RefuseOthers();
  return shape->faults()->count() == before && displacement->texture.valid();
}

void ReadSphere(JsonObject* shape, SceneContext* context) {
  Sphere sphere;
  shape->Require("center", "[x, y, z]");
  shape->Point("center", &sphere.center);
  shape->Require("radius", "a length greater than 0");
  shape->Number("radius", limits::kLength, &sphere.radius);
  ReadMaterialOf(shape, context, &sphere.material);
  Displacement displacement;
  if (!ReadDisplacement(shape, true, context, &displacement)) {
    context->scene->spheres.push_back(sphere);
    return;
  }
  displacement.center = sphere.center;
  displacement.size = sphere.radius;
  Mesh mesh = TessellateSphere(sphere, displacement.segments);
  Displace(*context->scene, displacement, &mesh);
  context->scene->meshes.push_back(std::move(mesh));
}

void ReadScale(const JsonValue& value, Vec3d* scale) {
  double uniform = 1;
  if (value.json.is_number()) {
    if (ReadNumber(value, limits::kCoordinate, &uniform)) *scale = Vec3d(uniform);
  } else {
    ReadPoint(value, limits::kCoordinate, scale);
  }
  for (const double component : {scale->x, scale->y, scale->z}) {
    if (limits::kLength.Contains(std::abs(component))) continue;
    value.AddFault("would flatten the mesh", "no component is 0");
    break;
  }
}

void ReadTransform(const JsonValue& value, Transform* transform) {
  JsonObject object(value);
  object.Point("translate", &transform->translate);
  if (const Json* scale = object.Find("scale")) {
    ReadScale({*scale, object.path().Member("scale"), object.faults()}, &transform->scale);
  }
  object.Point("rotate_deg", &transform->rotate_deg);
  object.RefuseOthers();
}

// Moves the surface, or faults if that takes texture coordinates that it has not.
void DisplaceMesh(const JsonValue& value, Displacement displacement, const Scene& scene,
                  Mesh* mesh) {
  const Texture& texture = scene.textures[displacement.texture.index];
  if (texture.mapping == MappingKind::kUv && mesh->uvs.empty()) {
    value.AddFault("the mesh has no texture coordinates for its displacement",
                   "give the texture a \"mapping\": spherical, cylindrical, planar or cube");
    return;
  }
  displacement.center = texture.center;
  displacement.size = texture.size;
  Displace(scene, displacement, mesh);
}

// Adds the mesh in `file`, or a fault of `value`, where the scene names it. `displacement` may be
// null.
void LoadMesh(const JsonValue& value, const Transform& transform, bool smooth, MaterialId material,
              const Displacement* displacement, SceneContext* context) {
  std::string file;
  if (!ReadText(value, &file)) return;
  try {
    Mesh mesh = ReadObj(ResolveReference(context->folder, file, context->allow_paths));
    mesh.material = material;
    if (!smooth) mesh.normals.clear();
    ApplyTransform(transform, &mesh);
    if (smooth && mesh.normals.empty()) mesh.normals = AngleWeightedNormals(mesh);
    if (displacement != nullptr) DisplaceMesh(value, *displacement, *context->scene, &mesh);
    context->scene->meshes.push_back(std::move(mesh));
  } catch (const Error& error) {
    for (const Fault& fault : error.faults()) {
      value.AddFault(fault.where.empty() ? fault.what : fault.where + ": " + fault.what,
                     fault.hint);
    }
  }
}

void ReadMesh(JsonObject* shape, SceneContext* context) {
  MaterialId material;
  ReadMaterialOf(shape, context, &material);
  Transform transform;
  if (const Json* json = shape->Find("transform")) {
    ReadTransform({*json, shape->path().Member("transform"), shape->faults()}, &transform);
  }
  bool smooth = true;
  shape->Boolean("smooth", &smooth);
  Displacement displacement;
  const bool displaced = ReadDisplacement(shape, false, context, &displacement);
  if (const Json* file = shape->Require("file", "an OBJ file in the scene's folder")) {
    LoadMesh({*file, shape->path().Member("file"), shape->faults()}, transform, smooth, material,
             displaced ? &displacement : nullptr, context);
  }
}

struct ShapeType {
  std::string_view name;
  void (*read)(JsonObject*, SceneContext*);
};
constexpr std::array<ShapeType, 5> kShapeTypes = {{{"sphere", ReadSphere},
                                                   {"mesh", ReadMesh},
                                                   {"grid", ReadGrid},
                                                   {"pair", ReadPair},
                                                   {"cloud", ReadCloud}}};

void ReadShape(const JsonValue& value, SceneContext* context) {
  std::array<std::string_view, kShapeTypes.size()> names;
  for (size_t i = 0; i < names.size(); ++i) names[i] = kShapeTypes[i].name;
  JsonObject shape(value);
  shape.Require("type", "one of: sphere, mesh, grid, pair, cloud");
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
