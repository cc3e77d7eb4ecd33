// SPDX-License-Identifier: Apache-2.0
#include "scene_io/obj.h"

#include <algorithm>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "scene/mesh.h"
#include "scene/polygon.h"
#include "scene_io/model_scene.h"
#include "scene_io/obj_file.h"
#include "scene_io/obj_materials.h"

namespace nacre {
namespace {

// Whether every corner has a normal, or a uv.
bool AllHave(const ObjFile& obj, int32_t ObjCorner::*index) {
  return std::all_of(obj.corners.begin(), obj.corners.end(),
                     [&](const ObjCorner& corner) { return corner.*index >= 0; });
}

// What makes a vertex of its own.
struct VertexKey {
  uint32_t position;
  int32_t normal, uv;
  bool operator==(const VertexKey&) const = default;
};
struct HashKey {
  size_t operator()(const VertexKey& key) const {
    uint64_t hash = key.position;
    for (const int index : {key.normal, key.uv}) {
      hash = (hash ^ hash >> 32) * 0x9e3779b97f4a7c15u + static_cast<uint32_t>(index);
    }
    return hash ^ hash >> 29;
  }
};

// What of the file all of its meshes have.
struct ObjContents {
  explicit ObjContents(const ObjFile& obj)
      : normals(AllHave(obj, &ObjCorner::normal)), uvs(AllHave(obj, &ObjCorner::uv)) {}
  bool normals, uvs;
};

// Which vertex has a key: numbers of vertices in a table whose places are at least twice as many,
// each at the first free place from its hash on.
class VertexTable {
 public:
  // The number of the key's vertex, and whether it is a new one: the next.
  std::pair<uint32_t, bool> Find(const VertexKey& key) {
    if (places_.size() <= 2 * keys_.size()) Grow();
    size_t place = HashKey()(key) & (places_.size() - 1);
    for (; places_[place] != kFree; place = (place + 1) & (places_.size() - 1)) {
      if (keys_[places_[place]] == key) return {places_[place], false};
    }
    places_[place] = static_cast<uint32_t>(keys_.size());
    keys_.push_back(key);
    return {places_[place], true};
  }

 private:
  static constexpr uint32_t kFree = 0xffffffffu;

  void Grow() {
    places_.assign(std::max<size_t>(64, 4 * places_.size()), kFree);
    for (uint32_t i = 0; i < keys_.size(); ++i) {
      size_t place = HashKey()(keys_[i]) & (places_.size() - 1);
      while (places_[place] != kFree) place = (place + 1) & (places_.size() - 1);
      places_[place] = i;
    }
  }

  std::vector<VertexKey> keys_;   // by vertex
  std::vector<uint32_t> places_;  // a power of two of them
};

// Collects vertices: OBJ numbers positions, normals and uvs apart, a mesh has them by position.
class MeshBuilder {
 public:
  MeshBuilder(const ObjFile& obj, const ObjContents& contents)
      : obj_(obj), with_normals_(contents.normals), with_uvs_(contents.uvs) {}

  void AddFace(const ObjCorner* corners, size_t count) {
    face_.clear();
    for (size_t i = 0; i < count; ++i) face_.push_back(obj_.positions[corners[i].position]);
    local_.clear();
    Triangulate(face_, &local_);
    for (const uint32_t i : local_) mesh_.triangles.push_back(Vertex(corners[i]));
  }

  Mesh Take() {
    if (with_normals_) MendNormals(&mesh_);  // some exporters write normals of length 0
    return std::move(mesh_);
  }

 private:
  uint32_t Vertex(const ObjCorner& corner) {
    const VertexKey key{corner.position, with_normals_ ? corner.normal : 0,
                        with_uvs_ ? corner.uv : 0};
    const auto [vertex, is_new] = vertices_.Find(key);
    if (!is_new) return vertex;
    mesh_.positions.push_back(obj_.positions[corner.position]);
    if (!obj_.colors.empty()) mesh_.colors.push_back(obj_.colors[corner.position]);
    if (with_normals_) {
      mesh_.normals.push_back(obj_.normals[static_cast<size_t>(key.normal)].normalized());
    }
    if (with_uvs_) mesh_.uvs.push_back(obj_.uvs[static_cast<size_t>(key.uv)]);
    return vertex;
  }

  const ObjFile& obj_;
  bool with_normals_, with_uvs_;
  VertexTable vertices_;
  std::vector<Vec3d> face_;      // of one face: its corners,
  std::vector<uint32_t> local_;  // and its triangles as indices into them
  Mesh mesh_;
};

// Calls use(material, corners, count) for each face; the material is a place in
// obj.material_names, or kNoMaterial.
constexpr uint32_t kNoMaterial = 0xffffffffu;
template <class Use>
void ForEachFace(const ObjFile& obj, const Use& use) {
  const ObjCorner* corners = obj.corners.data();
  auto next = obj.uses.begin();
  uint32_t material = kNoMaterial;
  for (size_t face = 0; face < obj.corner_counts.size(); ++face) {
    if (next != obj.uses.end() && next->first_face == face) material = (next++)->name;
    use(material, corners, obj.corner_counts[face]);
    corners += obj.corner_counts[face];
  }
}

}  // namespace

Mesh ReadObj(const std::filesystem::path& path, int threads) {
  const ObjFile obj = ReadObjFile(path, threads, {});
  MeshBuilder builder(obj, ObjContents(obj));
  ForEachFace(obj, [&](uint32_t, const ObjCorner* corners, size_t count) {
    builder.AddFace(corners, count);
  });
  Mesh mesh = builder.Take();
  mesh.name = path.stem().string();
  mesh.colors.clear();  // its material is the scene's
  return mesh;
}

Scene ReadObjScene(const std::filesystem::path& path, const LoadOptions& options) {
  const std::string file = path.string();
  const auto warn = [&](const std::string& text) {
    if (options.on_warning) options.on_warning(file + ": " + text);
  };
  const ObjFile obj = ReadObjFile(path, options.threads, warn);
  Scene scene;
  const std::vector<MaterialId> materials = AddObjMaterials(path, obj, options, &scene);
  const ObjContents contents(obj);
  std::map<uint32_t, MeshBuilder> builders;  // by material
  ForEachFace(obj, [&](uint32_t name, const ObjCorner* corners, size_t count) {
    const MaterialId material = name == kNoMaterial ? materials.back() : materials[name];
    builders.try_emplace(material.index, obj, contents).first->second.AddFace(corners, count);
  });
  for (auto& [material, builder] : builders) {
    Mesh& mesh = scene.meshes.emplace_back(builder.Take());
    mesh.name = path.stem().string();
    mesh.material = {material};
    if (mesh.normals.empty()) {
      ComputeNormals(NormalWeighting::kAngle, kModelCreaseAngleDeg, &mesh, options.threads);
    }
  }
  DropMeshesWithoutArea(&scene);
  if (scene.meshes.empty()) throw Error(ExitCode::kBadInput, file, "has no face with an area");
  SplitColoredMaterials(&scene);
  if (CompleteCoordinates(&scene)) {
    warn("a mesh has images but no uvs: it shows one texel of each");
  }
  return scene;
}

}  // namespace nacre
