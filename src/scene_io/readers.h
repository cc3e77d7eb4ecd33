// SPDX-License-Identifier: Apache-2.0
// scene_io/readers.h: one reader for each part of a scene file. All report to the faults of the
// value that they are given and leave defaults in place of what is wrong.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "scene/displace.h"
#include "scene/generators.h"
#include "scene/material_parameters.h"
#include "scene/scene.h"
#include "scene/user_brdf.h"
#include "scene_io/json_reader.h"
#include "scene_io/kept_files.h"
#include "scene_io/plain_spheres.h"
#include "scene_io/read_members.h"
#include "scene_io/scene_budget.h"
#include "scene_io/text_file.h"
#include "scene_io/texture_image.h"

namespace nacre {

void ReadCamera(const JsonValue& value, Camera* camera);
void ReadImageSettings(const JsonValue& value, ImageSettings* image);

// What materials and shapes need to know of the rest of the file.
struct SceneContext {
  std::filesystem::path folder;  // of the scene file
  ReferenceRules references;     // of its file names
  int threads = 0;
  const UserBrdfs* user_brdfs = nullptr;
  Scene* scene = nullptr;
  SceneBudget* budget = nullptr;
  TexelBudget* texels = nullptr;
  MaterialNames materials;
  // So that one fault does not make others of all that refer to it:
  bool has_materials = true;                          // false: their names could not be read
  std::unordered_set<uint32_t> unreadable_materials;  // indices of those that have faults
  std::unordered_set<uint32_t> varied_materials;      // shapes have made others of them
  const WholeMaterials* whole_materials = nullptr;    // ReadMembers::whole, of an earlier reading
  // Of the shapes read, as in ReadMembers.
  std::vector<ShapeRead> shapes;
  std::vector<size_t> runs;
  TextureSources textures;
  std::unordered_map<std::string, ImageId> images;     // by path, encoding and part
  TexturesAhead ahead;                                 // of DecodeMapsAhead
  std::function<void(const std::string&)> on_warning;  // LoadOptions::on_warning
  KeptFiles* kept = nullptr;                           // of a scene that is read again; else null
  // Of a model in the studio: the room, which an environment without another sky keeps.
  std::shared_ptr<const SkyPicture> room;
};

// All of a context but what has been read; SceneReading is in read_scene.h.
struct SceneReading;
void SetUpContext(const SceneReading& reading, SceneBudget* budget, TexelBudget* texels,
                  Scene* scene, SceneContext* context);

// The object "lights"; `context` says where their pictures are.
void ReadLights(const JsonValue& value, const SceneContext& context, std::vector<Light>* lights);

// Lights by type, from the object of one; read_area_lights.cc.
SphereAreaLight ReadSphereArea(JsonObject* light);
RectangleAreaLight ReadRectangleArea(JsonObject* light);
DiskAreaLight ReadDiskArea(JsonObject* light);
MeshAreaLight ReadMeshArea(JsonObject* light, const SceneContext& context);
EnvironmentLight ReadEnvironment(JsonObject* light, const SceneContext& context);
// The members of a light that name its mesh; null if there are faults. In read_meshes.cc.
std::shared_ptr<const Mesh> ReadLightMesh(JsonObject* light, const SceneContext& context);

// Members that a light must have.
inline void ReadRequiredPoint(JsonObject* object, std::string_view name, std::string_view hint,
                              Vec3d* out) {
  object->Require(name, hint);
  object->Point(name, out);
}
inline void ReadRadiance(JsonObject* object, std::string_view name, std::string_view hint,
                         Rgb* out) {
  object->Require(name, hint);
  object->Color(name, limits::kRadiance, out);
}
// The object "textures". Their images are read when a material names them.
void ReadTextures(const JsonValue& value, SceneContext* context);

// A texture by its name. Its absence is a fault.
void ReadTextureId(const JsonValue& value, MapUse use, SceneContext* context, TextureId* id);

// The members of a material that name textures; null takes the one that is there away.
void ReadMaps(const MaterialModel& model, JsonObject* object, SceneContext* context,
              Material* material);

// The object "materials": all of them, in its order.
void ReadMaterials(const JsonValue& value, SceneContext* context);
// One of them. Inline ones that it names are added to the scene, it itself is not.
Material ReadNamedMaterial(const JsonValue& value, const std::string& name, SceneContext* context);
// Before them: decodes the images that they are going to read, several at a time. `materials` is
// the same JSON, which may be wrong.
void DecodeMapsAhead(const Json& materials, SceneContext* context);

// Sets what the object says of a material that is there, its maps too. With a "model" it says all
// of the material, and only the name stays.
void ChangeMaterial(const JsonValue& value, SceneContext* context, Material* material);

// A material by name or inline. An inline one is added to the scene, named by its JSON pointer.
bool ReadMaterialId(const JsonValue& value, SceneContext* context, MaterialId* id);

// A list of them, of one at least.
void ReadMaterialList(const JsonValue& value, SceneContext* context, std::vector<MaterialId>* ids);

// The required member "material" of a shape.
void ReadMaterialOf(JsonObject* shape, SceneContext* context, MaterialId* id);

// A copy of a material by name, or an inline one that is not added to the scene. False if it has
// faults, even if they were reported before.
bool ReadBaseMaterial(const JsonValue& value, SceneContext* context, Material* material);

// The array "shapes"; `spheres` are those of its elements that the value lacks.
void ReadShapes(const JsonValue& value, const PlainSpheres& spheres, SceneContext* context);

// One of them.
void ReadShape(const JsonValue& value, SceneContext* context);

// The shape as the file has it.
Json JsonOf(const Sphere& sphere, const std::string& material);

// Those with a file or faces of their own.
void ReadMesh(JsonObject* shape, SceneContext* context);
void ReadIcosphere(JsonObject* shape, SceneContext* context);
void ReadUvSphere(JsonObject* shape, SceneContext* context);

// The generators among the shapes; each adds what it makes to the scene unless there are faults.
void ReadGrid(JsonObject* shape, SceneContext* context);
void ReadPair(JsonObject* shape, SceneContext* context);
void ReadCloud(JsonObject* shape, SceneContext* context);

// The member "displacement" of a shape; false if there is none, or it has faults. In
// read_meshes.cc.
bool ReadDisplacement(JsonObject* shape, bool is_sphere, SceneContext* context,
                      Displacement* displacement);

}  // namespace nacre
