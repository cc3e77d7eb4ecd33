// SPDX-License-Identifier: Apache-2.0
// scene_io/obj.cc: triangle meshes from Wavefront OBJ files.
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "scene/mesh.h"
#include "scene/polygon.h"
#include "scene_io/model_files.h"
#include "scene_io/model_scene.h"
#include "scene_io/obj_file.h"
#include "scene_io/obj_materials.h"

namespace nacre {
namespace {

// Corners of faces with equal keys share a vertex.
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

// Which attributes the meshes of a file have: normals if all corners have one, uvs if any has one.
struct ObjContents {
  explicit ObjContents(const ObjFile& obj) {
    ForEachFace(obj, [&](const ObjFace<const ObjCorner>& face) {
      for (const ObjCorner& corner : face.corners) {
        normals &= corner.normal >= 0;
        uvs |= corner.uv >= 0;
      }
    });
  }
  bool normals = true, uvs = false;
};

// Sets *positions to those of the corners.
void FindPositions(const ObjFile& obj, std::span<const ObjCorner> corners,
                   std::vector<Vec3d>* positions) {
  positions->clear();
  for (const ObjCorner& corner : corners) positions->push_back(obj.positions[corner.position]);
}

// Maps keys to vertex numbers by a hash table with linear probing, of at least twice as many slots
// as keys.
class VertexTable {
 public:
  // The vertex number of the key, and whether it is new. New keys get consecutive numbers.
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
  std::vector<uint32_t> places_;  // slots; their number is a power of two
};

// Collects vertices. OBJ indexes positions, normals and uvs separately, a mesh by vertex.
class MeshBuilder {
 public:
  MeshBuilder(const ObjFile& obj, const ObjContents& contents)
      : obj_(obj), with_normals_(contents.normals), with_uvs_(contents.uvs) {}

  void AddFace(std::span<const ObjCorner> corners) {
    FindPositions(obj_, corners, &face_);
    local_.clear();
    Triangulate(face_, &local_);
    for (const uint32_t i : local_) mesh_.triangles.push_back(Vertex(corners[i]));
  }

  Mesh Take() {
    if (!has_uv_) mesh_.uvs.clear();
    return std::move(mesh_);
  }
  bool has_all_uvs() const { return !misses_uv_ || !has_uv_; }

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
    if (with_uvs_) {
      (key.uv < 0 ? misses_uv_ : has_uv_) = true;
      mesh_.uvs.push_back(key.uv < 0 ? Vec2d(0, 0) : obj_.uvs[static_cast<size_t>(key.uv)]);
    }
    return vertex;
  }

  const ObjFile& obj_;
  bool with_normals_, with_uvs_;
  bool has_uv_ = false, misses_uv_ = false;  // whether some vertices do
  VertexTable vertices_;
  std::vector<Vec3d> face_;      // for the current face: its corners,
  std::vector<uint32_t> local_;  // and its triangles as indices into these
  Mesh mesh_;
};

// The interior angle of the polygon at corner `i`, more than pi if it is concave there; `normal` is
// the polygon's normal.
double AngleAt(const std::vector<Vec3d>& face, size_t i, const Vec3d& normal) {
  const Vec3d to_next = face[(i + 1) % face.size()] - face[i];
  const Vec3d to_last = face[(i + face.size() - 1) % face.size()] - face[i];
  const double angle = std::atan2(to_next.cross(to_last).dot(normal), to_next.dot(to_last));
  return angle < 0 ? angle + 2 * std::numbers::pi : angle;
}

// Gives corners without a normal one that follows the file's smoothing groups: at each position,
// the average over the faces of one group, weighted by their angles; without a group, the normal of
// the face.
void AddNormalsOfGroups(ObjFile* obj) {
  const auto first = static_cast<int32_t>(obj->normals.size());
  VertexTable numbers;      // numbers pairs of position and group, and faces without a group
  std::vector<Vec3d> sums;  // by number
  std::vector<Vec3d> face;
  uint32_t face_number = 0;
  ForEachFace(*obj, [&](const ObjFace<ObjCorner>& of) {
    FindPositions(*obj, of.corners, &face);
    const Vec3d normal = NewellNormal(face).normalized();
    const bool is_flat = of.group == ObjFile::kSmoothingOff;
    for (size_t i = 0; i < of.corners.size(); ++i) {
      ObjCorner& corner = of.corners[i];
      const VertexKey key{is_flat ? face_number : corner.position, static_cast<int32_t>(of.group),
                          0};
      const auto [number, is_new] = numbers.Find(key);
      if (is_new) sums.emplace_back(0, 0, 0);
      sums[number] += is_flat ? normal : normal * AngleAt(face, i, normal);
      if (corner.normal < 0) corner.normal = first + static_cast<int32_t>(number);
    }
    ++face_number;
  });
  for (const Vec3d& sum : sums) obj->normals.push_back(UnitOrUp(sum));
}

// For files without groups: gives corners without a normal averages over all faces, split at
// creases.
void AddNormalsOfCreases(double crease_angle_deg, int threads, ObjFile* obj) {
  const auto first = static_cast<int32_t>(obj->normals.size());
  Mesh mesh;
  mesh.positions = obj->positions;
  std::vector<ObjCorner*> owners;  // corner of the file for each corner of the mesh
  std::vector<Vec3d> face;
  std::vector<uint32_t> local;
  ForEachFace(*obj, [&](const ObjFace<ObjCorner>& of) {
    FindPositions(*obj, of.corners, &face);
    local.clear();
    Triangulate(face, &local);
    for (const uint32_t i : local) {
      mesh.triangles.push_back(of.corners[i].position);
      owners.push_back(&of.corners[i]);
    }
  });
  ComputeNormals(NormalWeighting::kAngle, crease_angle_deg, &mesh, threads);
  for (size_t i = 0; i < owners.size(); ++i) {
    if (owners[i]->normal < 0) {
      owners[i]->normal = first + static_cast<int32_t>(mesh.triangles[i]);
    }
  }
  obj->normals.insert(obj->normals.end(), mesh.normals.begin(), mesh.normals.end());
}

// Gives all corners normals if the file has some, or smoothing groups. Normals of length 0, which
// some exporters write, count as missing.
void CompleteNormals(double crease_angle_deg, int threads, ObjFile* obj) {
  size_t missing = 0;
  for (ObjCorner& corner : obj->corners) {
    if (corner.normal >= 0 && obj->normals[static_cast<size_t>(corner.normal)] == Vec3d(0, 0, 0)) {
      corner.normal = -1;
    }
    if (corner.normal < 0) ++missing;
  }
  if (missing > 0 && !obj->smoothing.empty()) {
    AddNormalsOfGroups(obj);
  } else if (missing > 0 && missing < obj->corners.size()) {
    AddNormalsOfCreases(crease_angle_deg, threads, obj);
  }
}

}  // namespace

Mesh ReadObj(const std::filesystem::path& path, const ObjReading& reading) {
  const std::string file = path.string();
  ObjFile obj = ReadObjFile(path, reading.threads, [&](const std::string& text) {
    if (reading.on_warning) reading.on_warning(file + ": " + text);
  });
  if (reading.complete_normals) CompleteNormals(180, reading.threads, &obj);
  MeshBuilder builder(obj, ObjContents(obj));
  ForEachFace(obj, [&](const auto& face) { builder.AddFace(face.corners); });
  Mesh mesh = builder.Take();
  mesh.name = path.stem().string();
  mesh.colors.clear();  // its material is the scene's, not one that uses vertex colours
  return mesh;
}

Scene ReadObjScene(const std::filesystem::path& path, const LoadOptions& options) {
  const std::string file = path.string();
  const auto warn = [&](const std::string& text) {
    if (options.on_warning) options.on_warning(file + ": " + text);
  };
  ObjFile obj = ReadObjFile(path, options.threads, warn);
  CompleteNormals(kModelCreaseAngleDeg, options.threads, &obj);
  Scene scene;
  const std::vector<MaterialId> materials = AddObjMaterials(path, obj, options, &scene);
  const ObjContents contents(obj);
  std::map<uint32_t, MeshBuilder> builders;  // by material
  ForEachFace(obj, [&](const auto& face) {
    const bool has_name = face.material != kNoMaterial;
    const MaterialId material = has_name ? materials[face.material] : materials.back();
    builders.try_emplace(material.index, obj, contents).first->second.AddFace(face.corners);
  });
  bool has_all_uvs = true;
  for (auto& [material, builder] : builders) {
    has_all_uvs &= builder.has_all_uvs();
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
  if (!has_all_uvs && !scene.textures.empty()) {
    warn("corners without texture coordinates have (0, 0)");
  }
  if (CompleteCoordinates(&scene)) {
    warn("a mesh has images but no uvs: it shows one texel of each");
  }
  return scene;
}

}  // namespace nacre
