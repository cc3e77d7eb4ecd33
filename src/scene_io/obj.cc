// SPDX-License-Identifier: Apache-2.0
#include "scene_io/obj.h"

#include <map>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/error.h"
#include "scene/mesh.h"
#include "scene/polygon.h"
#include "scene_io/model_scene.h"
#include "scene_io/obj_file.h"
#include "scene_io/obj_materials.h"

namespace nacre {
namespace {

// Whether every corner has a normal, or a uv.
bool AllHave(const ObjFile& obj, int tinyobj::index_t::*index) {
  for (const tinyobj::shape_t& shape : obj.shapes) {
    for (const tinyobj::index_t& corner : shape.mesh.indices) {
      if (corner.*index < 0) return false;
    }
  }
  return true;
}

Vec3d Triple(const std::vector<double>& numbers, int index) {
  const auto i = 3 * static_cast<size_t>(index);
  return {numbers[i], numbers[i + 1], numbers[i + 2]};
}

// What makes a vertex of its own.
struct VertexKey {
  int position, normal, uv;
  bool operator==(const VertexKey&) const = default;
};
struct HashKey {
  size_t operator()(const VertexKey& key) const {
    uint64_t hash = static_cast<uint32_t>(key.position);
    for (const int index : {key.normal, key.uv}) {
      hash = (hash ^ hash >> 32) * 0x9e3779b97f4a7c15u + static_cast<uint32_t>(index);
    }
    return hash ^ hash >> 29;
  }
};

// Collects vertices: OBJ numbers positions, normals and uvs apart, a mesh has them by position.
class MeshBuilder {
 public:
  MeshBuilder(const ObjFile& obj, const std::string& file)
      : obj_(obj),
        file_(file),
        with_normals_(AllHave(obj, &tinyobj::index_t::normal_index)),
        with_uvs_(AllHave(obj, &tinyobj::index_t::texcoord_index)) {}

  void AddFace(const tinyobj::index_t* corners, size_t count) {
    face_.clear();
    for (size_t i = 0; i < count; ++i) {
      face_.push_back(Triple(obj_.attributes.vertices, corners[i].vertex_index));
    }
    local_.clear();
    Triangulate(face_, &local_);
    for (const uint32_t i : local_) mesh_.triangles.push_back(Vertex(corners[i]));
  }

  Mesh Take() { return std::move(mesh_); }

 private:
  uint32_t Vertex(const tinyobj::index_t& corner) {
    const VertexKey key{corner.vertex_index, with_normals_ ? corner.normal_index : 0,
                        with_uvs_ ? corner.texcoord_index : 0};
    const auto [entry, is_new] =
        vertices_.try_emplace(key, static_cast<uint32_t>(mesh_.positions.size()));
    if (!is_new) return entry->second;
    mesh_.positions.push_back(Triple(obj_.attributes.vertices, corner.vertex_index));
    if (with_normals_) {
      const Vec3d unit = Triple(obj_.attributes.normals, corner.normal_index).normalized();
      if (unit == Vec3d(0, 0, 0)) {
        throw Error(ExitCode::kBadInput, file_,
                    fmt::format("normal {} has length 0", key.normal + 1),
                    "leave the normals out to have smooth ones computed");
      }
      mesh_.normals.push_back(unit);
    }
    if (with_uvs_) {
      const auto uv = 2 * static_cast<size_t>(key.uv);
      mesh_.uvs.emplace_back(obj_.attributes.texcoords[uv], obj_.attributes.texcoords[uv + 1]);
    }
    return entry->second;
  }

  const ObjFile& obj_;
  const std::string& file_;
  bool with_normals_, with_uvs_;
  std::unordered_map<VertexKey, uint32_t, HashKey> vertices_;
  std::vector<Vec3d> face_;      // of one face: its corners,
  std::vector<uint32_t> local_;  // and its triangles as indices into them
  Mesh mesh_;
};

// Calls use(material, corners, count) for each face; a material below 0 is none.
template <class Use>
void ForEachFace(const ObjFile& obj, const Use& use) {
  for (const tinyobj::shape_t& shape : obj.shapes) {
    const tinyobj::index_t* corners = shape.mesh.indices.data();
    for (size_t face = 0; face < shape.mesh.num_face_vertices.size(); ++face) {
      const size_t count = shape.mesh.num_face_vertices[face];
      use(shape.mesh.material_ids[face], corners, count);
      corners += count;
    }
  }
}

}  // namespace

Mesh ReadObj(const std::filesystem::path& path) {
  const std::string file = path.string();
  const ObjFile obj = ReadObjFile(path, nullptr);
  MeshBuilder builder(obj, file);
  ForEachFace(obj, [&](int, const tinyobj::index_t* corners, size_t count) {
    builder.AddFace(corners, count);
  });
  Mesh mesh = builder.Take();
  mesh.name = path.stem().string();
  return mesh;
}

Scene ReadObjScene(const std::filesystem::path& path, const LoadOptions& options) {
  const std::string file = path.string();
  MtlReader reader(path, options);
  const ObjFile obj = ReadObjFile(path, &reader);
  Scene scene;
  scene.materials = reader.MakeMaterials(obj.materials, &scene);
  const auto none = static_cast<int>(scene.materials.size()) - 1;
  std::map<int, MeshBuilder> builders;  // by material
  ForEachFace(obj, [&](int material, const tinyobj::index_t* corners, size_t count) {
    const int known = material >= 0 && material < none ? material : none;
    builders.try_emplace(known, obj, file).first->second.AddFace(corners, count);
  });
  for (auto& [material, builder] : builders) {
    Mesh& mesh = scene.meshes.emplace_back(builder.Take());
    mesh.name = path.stem().string();
    mesh.material = {static_cast<uint32_t>(material)};
    if (mesh.normals.empty()) {
      ComputeNormals(NormalWeighting::kAngle, kModelCreaseAngleDeg, &mesh);
    }
  }
  DropMeshesWithoutArea(&scene);
  if (scene.meshes.empty()) throw Error(ExitCode::kBadInput, file, "has no face with an area");
  if (CompleteCoordinates(&scene) && options.on_warning) {
    options.on_warning(file + ": a mesh has images but no uvs: it shows one texel of each");
  }
  return scene;
}

}  // namespace nacre
