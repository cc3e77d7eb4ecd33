// SPDX-License-Identifier: Apache-2.0
// scene_io/readers.h: one reader for each part of a scene file. All of them add errors to the fault
// list of the value that they are given, and leave defaults in place of what is wrong.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

#include "scene/displace.h"
#include "scene/generators.h"
#include "scene/material_parameters.h"
#include "scene/parts.h"
#include "scene/scene.h"
#include "scene/user_brdf.h"
#include "scene_io/json_reader.h"
#include "scene_io/kept_files.h"
#include "scene_io/materialx.h"
#include "scene_io/plain_spheres.h"
#include "scene_io/read_members.h"
#include "scene_io/scene_budget.h"
#include "scene_io/text_file.h"
#include "scene_io/texture_image.h"

namespace nacre {

// The parts "camera" and "image" consist of keys alone. In read_keys.cc.
void ReadCamera(const JsonValue& value, Camera* camera);
void ReadImageSettings(const JsonValue& value, ImageSettings* image);

// What readers of materials and shapes need to know of the rest of the file.
struct SceneContext {
  std::filesystem::path folder;  // folder of the scene file
  ReferenceRules references;     // which files it may refer to
  int threads = 0;
  const UserBrdfs* user_brdfs = nullptr;
  Scene* scene = nullptr;
  SceneBudget* budget = nullptr;
  TexelBudget* texels = nullptr;
  ReadMembers read;  // what has been read so far
  // So that one fault does not cause more in everything that refers to it:
  bool has_materials = true;                          // false: their names could not be read
  std::unordered_set<uint32_t> unreadable_materials;  // indices of materials that have faults
  const WholeMaterials* whole_materials = nullptr;    // ReadMembers::whole of an earlier reading
  std::unordered_map<std::string, ImageId> images;    // by path, encoding and part
  // What MaterialX documents have given, by file and name of the material.
  std::map<std::pair<std::string, std::string>, MaterialXMaterial> materialx;
  // Measured BRDFs by path, and the bytes of their tables.
  std::unordered_map<std::string, std::shared_ptr<const MeasuredBrdf>> measured;
  uint64_t measured_bytes = 0;
  TexturesAhead ahead;                                 // filled by DecodeMapsAhead
  std::function<void(const std::string&)> on_warning;  // LoadOptions::on_warning
  KeptFiles* kept = nullptr;                           // for a scene that is read again; else null
  // For a model with studio lights: the picture of the room, which an environment keeps unless it
  // is given another sky.
  std::shared_ptr<const SkyPicture> room;
};

// Sets up a context before anything is read. SceneReading is defined in read_scene.h; its `files`
// receive files as those of the part that `*part` is by then.
struct SceneReading;
void SetUpContext(const SceneReading& reading, const ScenePart* part, SceneBudget* budget,
                  TexelBudget* texels, Scene* scene, SceneContext* context);

// Reads the object "lights"; `context` says where their pictures are.
void ReadLights(const JsonValue& value, const SceneContext& context, std::vector<Light>* lights);

// Reads the members of an environment that define its sky. In read_skies.cc.
void ReadSky(JsonObject* light, const SceneContext& context, EnvironmentLight* to);
// Reads the members of a light that define its mesh; null if there are faults. In read_meshes.cc.
std::shared_ptr<const Mesh> ReadLightMesh(JsonObject* light, const SceneContext& context);

// Reads the object "textures". Their images are read when a material names them.
void ReadTextures(const JsonValue& value, SceneContext* context);

// Reads the textures of a material of a MaterialX document, whose files are looked for in `folder`;
// `value` is where the scene names the document.
void ReadTexturesOf(const MaterialXMaterial& material, const std::filesystem::path& folder,
                    const JsonValue& value, SceneContext* context);

// Reads the name of a texture. A name that does not exist is a fault.
void ReadTextureId(const JsonValue& value, MapUse use, SceneContext* context, TextureId* id);

// Reads the members of a material that name textures; null removes the present one.
void ReadMaps(const MaterialModel& model, JsonObject* object, SceneContext* context,
              Material* material);

// Reads the member "file" of a measured material, if there is one. In read_measured.cc.
void ReadMeasuredTable(JsonObject* object, SceneContext* context, MeasuredMaterial* material);

// Reads a value of `parameter`; a number becomes three equal components.
bool ReadParameterValue(const JsonValue& value, const MaterialParameter& parameter, Rgb* out);

// Reads the object "materials", in its order.
void ReadMaterials(const JsonValue& value, SceneContext* context);
// Reads one material. Inline materials that it contains are added to the scene; it itself is not.
Material ReadNamedMaterial(const JsonValue& value, const std::string& name, SceneContext* context);
// Decodes the images that ReadMaterials is going to read, on several threads. `materials` is the
// same JSON, which may have faults.
void DecodeMapsAhead(const Json& materials, SceneContext* context);

// Sets what the object specifies of an existing material, its maps included. With a "model", it
// specifies the whole material, and only the name stays.
void ChangeMaterial(const JsonValue& value, SceneContext* context, Material* material);

// Reads a material by name or inline. An inline one is added to the scene, named by its JSON
// pointer.
bool ReadMaterialId(const JsonValue& value, SceneContext* context, MaterialId* id);

// Reads a list of at least one material.
void ReadMaterialList(const JsonValue& value, SceneContext* context, std::vector<MaterialId>* ids);

// Reads the required member "material" of a shape.
void ReadMaterialOf(JsonObject* shape, SceneContext* context, MaterialId* id);

// Reads a copy of a material by name, or an inline one, without adding it to the scene. Returns
// false if it has faults, even if they were reported before.
bool ReadBaseMaterial(const JsonValue& value, SceneContext* context, Material* material);

// Reads the array "shapes"; `spheres` are the elements that the value lacks.
void ReadShapes(const JsonValue& value, const PlainSpheres& spheres, SceneContext* context);

// Reads one shape.
void ReadShape(const JsonValue& value, SceneContext* context);

// The plain sphere as the file has it.
Json JsonOf(const Sphere& sphere, const std::string& material);

// Reads the required members "center" and "radius" of a sphere or sphere mesh.
template <typename AnySphere>
void ReadPlace(JsonObject* shape, AnySphere* sphere) {
  shape->Require("center", "[x, y, z]");
  shape->Point("center", &sphere->center);
  shape->Require("radius", "a length greater than 0");
  shape->Number("radius", limits::kLength, &sphere->radius);
}

// Readers of shapes that have a file or faces of their own.
void ReadMesh(JsonObject* shape, SceneContext* context);
void ReadIcosphere(JsonObject* shape, SceneContext* context);
void ReadUvSphere(JsonObject* shape, SceneContext* context);

// Readers of shapes that generate others; each adds its shapes to the scene unless there are
// faults.
void ReadGrid(JsonObject* shape, SceneContext* context);
void ReadPair(JsonObject* shape, SceneContext* context);
void ReadCloud(JsonObject* shape, SceneContext* context);

// Reads the member "displacement" of a shape; false if there is none, or it has faults. In
// read_meshes.cc.
bool ReadDisplacement(JsonObject* shape, bool is_sphere, SceneContext* context,
                      Displacement* displacement);

}  // namespace nacre
