// SPDX-License-Identifier: Apache-2.0
// scene_io/read_meshes.cc: the shapes "mesh", "icosphere" and "uv_sphere".
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include "base/error.h"
#include "base/path.h"
#include "scene/displace.h"
#include "scene/mesh.h"
#include "scene/sphere_mesh.h"
#include "scene_io/load_scene.h"
#include "scene_io/model_files.h"
#include "scene_io/readers.h"
#include "scene_io/text_file.h"

namespace nacre {
namespace {

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
  if (const auto scale = object.Find("scale")) ReadScale(*scale, &transform->scale);
  object.Point("rotate_deg", &transform->rotate_deg);
  object.RefuseOthers();
}

// Where the normals of a mesh come from.
struct NormalSettings {
  bool none = false;
  bool from_file = true;  // if the file has some; else computed
  NormalWeighting weighting = NormalWeighting::kAngle;
  std::optional<double> crease_angle_deg;
};

void ReadNormals(JsonObject* shape, NormalSettings* normals) {
  constexpr std::array<std::string_view, 5> kSources = {"file", "angle", "area", "uniform", "none"};
  size_t source = 0;
  const bool is_given = shape->Choice("normals", kSources, &source);
  bool smooth = true;  // in older scenes: false means "none"
  if (shape->Boolean("smooth", &smooth) && is_given) {
    shape->value().AddFault("\"normals\" takes the place of \"smooth\"", "keep \"normals\"");
  }
  normals->none = source == 4 || !smooth;
  normals->from_file = source == 0;
  constexpr std::array<NormalWeighting, 5> kWeightings = {
      NormalWeighting::kAngle, NormalWeighting::kAngle, NormalWeighting::kArea,
      NormalWeighting::kUniform};
  normals->weighting = kWeightings[source];
  double crease = 180;
  if (shape->Number("crease_angle_deg", limits::kCreaseAngleDeg, &crease)) {
    normals->crease_angle_deg = crease;
  }
}

// Reads the members that all meshes share.
void ReadInterpolation(JsonObject* shape, Mesh* mesh) {
  // The names are in the order of Interpolation.
  constexpr std::array<std::string_view, 4> kNames = {"phong", "gouraud", "flat", "faceted"};
  shape->Choice("interpolation", kNames, &mesh->interpolation);
  shape->Boolean("smooth_terminator", &mesh->smooth_terminator);
}

void PrepareNormals(const JsonValue& file, const NormalSettings& settings, int threads,
                    Mesh* mesh) {
  const bool keep = settings.from_file && !mesh->normals.empty();
  if (settings.crease_angle_deg && (settings.none || keep)) {
    file.AddFault("no normals are computed that \"crease_angle_deg\" could part",
                  keep ? "the file has its own; \"normals\": \"angle\" computes them"
                       : "leave it out, or ask for \"normals\"");
  }
  if (settings.none) {
    mesh->normals.clear();
  } else if (!keep) {
    ComputeNormals(settings.weighting, settings.crease_angle_deg.value_or(180), mesh, threads);
  }
}

// Displaces the surface; adds a fault if that needs texture coordinates that the mesh lacks.
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

// Reads the mesh of the file that `value` names and transforms it; nullopt if there are faults.
// Normals of smoothing groups count as the file's own: a weighting that the scene asks for replaces
// them.
std::optional<Mesh> ReadMeshFile(const JsonValue& value, const Transform& transform,
                                 const NormalSettings& normals, const SceneContext& context) {
  std::string file;
  if (!ReadText(value, &file)) return std::nullopt;
  try {
    const auto path = ResolveReference(context.folder, file, context.references);
    RefuseOtherModels(file);
    if (HasExtension(file, ".gltf") || HasExtension(file, ".glb")) {
      throw Error(ExitCode::kBadInput, {}, "a glTF file is a scene of its own",
                  "render it alone, or save its mesh as OBJ or PLY");
    }
    Mesh mesh = HasExtension(file, ".ply")
                    ? ReadPly(path, context.on_warning)
                    : ReadObj(path, {.threads = context.threads,
                                     .complete_normals = normals.from_file && !normals.none &&
                                                         !normals.crease_angle_deg,
                                     .on_warning = context.on_warning});
    context.budget->Spend(mesh.triangles.size() / 3);
    ApplyTransform(transform, &mesh);
    return mesh;
  } catch (const Error& error) {
    AddFileFaults(error, value);
  }
  return std::nullopt;
}

// Adds the mesh with the material and interpolation of `settings`.
void AddMesh(Mesh mesh, const Mesh& settings, SceneContext* context) {
  mesh.material = settings.material;
  mesh.interpolation = settings.interpolation;
  mesh.smooth_terminator = settings.smooth_terminator;
  context->scene->meshes.push_back(std::move(mesh));
}

void ReadFineness(JsonObject* shape, Icosphere* sphere) {
  shape->Whole("subdivisions", limits::kSubdivisions, &sphere->subdivisions);
}

void ReadFineness(JsonObject* shape, UvSphere* sphere) {
  shape->Whole("segments", limits::kSegments, &sphere->segments);
  shape->Whole("rings", limits::kRings, &sphere->rings);
}

// The number of triangles that it will have.
uint64_t TriangleCount(const Icosphere& sphere) {
  return uint64_t{20} << (2 * sphere.subdivisions);
}
uint64_t TriangleCount(const UvSphere& sphere) {
  return 2 * static_cast<uint64_t>(sphere.segments) * static_cast<uint64_t>(sphere.rings);
}

// Reads all that defines a sphere mesh; nullopt if there are faults.
template <typename SphereMesh>
std::optional<Mesh> ReadFaces(const JsonValue& value, const SceneContext& context) {
  const size_t before = value.faults->count();
  JsonObject object(value);
  SphereMesh sphere;
  ReadPlace(&object, &sphere);
  ReadFineness(&object, &sphere);
  object.RefuseOthers();
  if (value.faults->count() != before) return std::nullopt;
  try {
    context.budget->Spend(TriangleCount(sphere));
    return MakeMesh(sphere);
  } catch (const Error& error) {
    for (const Fault& fault : error.faults()) value.AddFault(fault.what, fault.hint);
  }
  return std::nullopt;
}

template <typename SphereMesh>
void ReadSphereMesh(JsonObject* shape, SceneContext* context) {
  SphereMesh sphere;
  Mesh settings;
  ReadFineness(shape, &sphere);
  ReadPlace(shape, &sphere);
  ReadMaterialOf(shape, context, &settings.material);
  ReadInterpolation(shape, &settings);
  if (shape->faults()->count() != 0) return;
  context->budget->Spend(TriangleCount(sphere));
  AddMesh(MakeMesh(sphere), settings, context);
}

// Identifies what a light's mesh is made from: the values of its members, and the state of its
// file.
std::string KeyOfLightMesh(std::initializer_list<const std::optional<JsonValue>*> members,
                           const SceneContext& context) {
  std::string key;
  for (const auto* member : members) key += (*member ? JsonText((*member)->json) : "") + "|";
  const std::optional<JsonValue>& file = **members.begin();
  if (file && file->json.is_string()) {
    key += KeyOfFile(context.folder / file->json.get<std::string>());
  }
  return key;
}

}  // namespace

bool ReadDisplacement(JsonObject* shape, bool is_sphere, SceneContext* context,
                      Displacement* displacement) {
  const auto value = shape->Find("displacement");
  if (!value) return false;
  const size_t before = shape->faults()->count();
  JsonObject object(*value, R"({"texture": "hills", "distance": 0.1})");
  if (const auto texture = object.Require("texture", "the name of one in \"textures\"")) {
    ReadTextureId(*texture, MapUse::kData, context, &displacement->texture);
  }
  object.Number("distance", limits::kCoordinate, &displacement->distance);
  if (is_sphere) object.Whole("segments", limits::kDisplacedSegments, &displacement->segments);
  object.RefuseOthers();
  return shape->faults()->count() == before && displacement->texture.valid();
}

void ReadMesh(JsonObject* shape, SceneContext* context) {
  Mesh settings;
  ReadMaterialOf(shape, context, &settings.material);
  Transform transform;
  if (const auto value = shape->Find("transform")) ReadTransform(*value, &transform);
  NormalSettings normals;
  ReadNormals(shape, &normals);
  ReadInterpolation(shape, &settings);
  std::optional<Displacement> displacement(std::in_place);
  if (!ReadDisplacement(shape, false, context, &*displacement)) displacement.reset();
  const auto file = shape->Require("file", "an OBJ or PLY file in the scene's folder");
  if (!file) return;
  std::optional<Mesh> mesh = ReadMeshFile(*file, transform, normals, *context);
  if (!mesh) return;
  PrepareNormals(*file, normals, context->threads, &*mesh);
  if (displacement) DisplaceMesh(*file, *displacement, *context->scene, &*mesh);
  AddMesh(*std::move(mesh), settings, context);
}

std::shared_ptr<const Mesh> ReadLightMesh(JsonObject* light, const SceneContext& context) {
  const auto file = light->Find("file");
  const auto icosphere = light->Find("icosphere");
  const auto uv_sphere = light->Find("uv_sphere");
  const auto transform_value = light->Find("transform");
  if (file.has_value() + icosphere.has_value() + uv_sphere.has_value() != 1) {
    light->value().AddFault("a mesh light has one mesh",
                            R"(give one of "file", "icosphere" and "uv_sphere")");
    return nullptr;
  }
  Transform transform;
  if (transform_value) {
    ReadTransform(*transform_value, &transform);
    if (!file) {
      transform_value->AddFault("is for meshes in files", "a sphere has \"center\" and \"radius\"");
    }
  }
  const auto read = [&] {
    return file        ? ReadMeshFile(*file, transform, {}, context)
           : icosphere ? ReadFaces<Icosphere>(*icosphere, context)
                       : ReadFaces<UvSphere>(*uv_sphere, context);
  };
  const auto make = [&](std::optional<Mesh> mesh) -> std::shared_ptr<const Mesh> {
    if (!mesh) return nullptr;
    return std::make_shared<const Mesh>(std::move(*mesh));
  };
  if (context.kept == nullptr) return make(read());
  std::weak_ptr<const Mesh>& kept = context.kept->light_meshes[KeyOfLightMesh(
      {&file, &icosphere, &uv_sphere, &transform_value}, context)];
  std::shared_ptr<const Mesh> mesh = kept.lock();
  if (mesh == nullptr) kept = mesh = make(read());
  return mesh;
}

void ReadIcosphere(JsonObject* shape, SceneContext* context) {
  ReadSphereMesh<Icosphere>(shape, context);
}

void ReadUvSphere(JsonObject* shape, SceneContext* context) {
  ReadSphereMesh<UvSphere>(shape, context);
}

}  // namespace nacre
