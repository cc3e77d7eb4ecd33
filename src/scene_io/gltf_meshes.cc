// SPDX-License-Identifier: Apache-2.0
// scene_io/gltf_meshes.cc: the triangles of a glTF file.
#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "base/float_mode.h"
#include "base/parallel.h"
#include "scene/limits.h"
#include "scene/material_parameters.h"
#include "scene/mesh.h"
#include "scene_io/gltf_accessor.h"
#include "scene_io/gltf_readers.h"
#include "scene_io/gltf_skins.h"

namespace nacre {
namespace {

// A primitive while it is converted.
struct Primitive {
  const gltf::Primitive& source;
  std::string place;
  // The indices into the accessors of the elements that triangles use, ascending; and, for each
  // triangle, three indices into `vertices`.
  std::vector<uint32_t> vertices;
  std::vector<uint32_t> triangles;
};

int AttributeOf(const Primitive& primitive, const char* name) {
  return gltf::AttributeOf(primitive.source, name);
}

// The corners of triangle i, as numbered by the primitive.
std::array<size_t, 3> CornerIndices(int mode, size_t i) {
  if (mode == gltf::kTriangleStrip) return {i, i + 1 + i % 2, i + 2 - i % 2};
  if (mode == gltf::kTriangleFan) return {i + 1, i + 2, 0};
  return {3 * i, 3 * i + 1, 3 * i + 2};
}

// The number of triangles that the corners form. Refuses lists that end within a triangle.
size_t TriangleCount(const GltfDocument& document, const Primitive& primitive, size_t corners) {
  const bool is_list = primitive.source.mode == gltf::kTriangles;
  if (corners < 3 || (is_list && corners % 3 != 0)) {
    document.Refuse(primitive.place, fmt::format("{} corners are no whole triangles", corners));
  }
  return is_list ? corners / 3 : corners - 2;
}

// Calls set(i) for all i below `count`, on several threads. set returns false if something is wrong
// with element i. Returns the first such element, or `count`.
template <class Set>
size_t SetAll(size_t count, int threads, const Set& set) {
  constexpr size_t kPiece = size_t{1} << 14;
  std::atomic<size_t> first_wrong = count;
  ParallelForBlocks(count, kPiece, threads, [&](size_t i, size_t end) {
    const DefaultFloatMode mode;  // numbers may be denormal
    if (i > first_wrong) return;
    while (i < end && set(i)) ++i;
    if (i == end) return;
    size_t first = first_wrong;
    while (i < first && !first_wrong.compare_exchange_weak(first, i)) {
    }
  });
  return first_wrong;
}

// Three indices into the accessors for each triangle.
std::vector<uint32_t> ReadTriangles(const GltfDocument& document, const Primitive& primitive,
                                    size_t vertex_count, SceneBudget* budget) {
  std::vector<uint32_t> triangles;
  // Returns the first triangle with an index that is too large, or the number of triangles.
  const auto fill = [&](size_t corners, const auto& index_of) {
    const size_t count = TriangleCount(document, primitive, corners);
    budget->Spend(count, document.file);
    triangles.resize(3 * count);
    return SetAll(count, document.threads, [&](size_t i) {
      bool fits = true;
      uint32_t* to = &triangles[3 * i];
      for (const size_t corner : CornerIndices(primitive.source.mode, i)) {
        *to = index_of(corner);
        fits &= *to++ < vertex_count;
      }
      return fits;
    });
  };
  if (primitive.source.indices < 0) {
    fill(vertex_count, [](size_t corner) { return static_cast<uint32_t>(corner); });
    return triangles;
  }
  const GltfAccessor indices(document, primitive.source.indices, "SCALAR");
  if (!indices.is_unsigned()) {
    document.Refuse(indices.place() + "/componentType", "indices are of an unsigned type");
  }
  const size_t wrong = fill(indices.count(), [&](size_t corner) { return indices.Index(corner); });
  if (3 * wrong == triangles.size()) return triangles;
  for (const size_t corner : CornerIndices(primitive.source.mode, wrong)) {
    const uint32_t index = indices.Index(corner);
    if (index < vertex_count) continue;
    document.Refuse(indices.place(), fmt::format("index {} at {}", index, corner),
                    fmt::format("there are {} positions", vertex_count));
  }
  return triangles;
}

// Drops unused vertices: primitives may share long accessors.
void Compact(Primitive* primitive) {
  std::vector<uint32_t>& vertices = primitive->vertices;
  const size_t end =
      *std::max_element(primitive->triangles.begin(), primitive->triangles.end()) + size_t{1};
  if (end <= primitive->triangles.size()) {
    // Faster than sorting, and the table is not longer than the triangles.
    std::vector<uint32_t> places(end, 0);
    for (const uint32_t index : primitive->triangles) places[index] = 1;
    for (uint32_t index = 0; index < end; ++index) {
      if (places[index] == 0) continue;
      places[index] = static_cast<uint32_t>(vertices.size());
      vertices.push_back(index);
    }
    if (vertices.size() == end) return;
    for (uint32_t& index : primitive->triangles) index = places[index];
    return;
  }
  vertices = primitive->triangles;
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  if (vertices.back() + size_t{1} == vertices.size()) return;
  for (uint32_t& index : primitive->triangles) {
    const auto found = std::lower_bound(vertices.begin(), vertices.end(), index);
    index = static_cast<uint32_t>(found - vertices.begin());
  }
}

Vec3d Triple(const GltfAccessor& accessor, size_t element) {
  return {accessor.Number(element, 0), accessor.Number(element, 1), accessor.Number(element, 2)};
}

void ReadPositions(const GltfDocument& document, const Primitive& primitive,
                   const GltfAccessor& accessor, const GltfPlacement& placement, Mesh* mesh) {
  const size_t count = primitive.vertices.size();
  mesh->positions.resize(count);
  const auto set = [&](size_t i) {
    const uint32_t element = primitive.vertices[i];
    Vec3d& position = mesh->positions[i];
    placement.WorldFromVertex(element).multVecMatrix(Triple(accessor, element), position);
    return limits::kCoordinate.Contains(position);
  };
  const size_t wrong = SetAll(count, placement.ThreadsOf(document), set);
  if (wrong == count) return;
  document.Refuse(accessor.place(),
                  fmt::format("position {} is out of range", primitive.vertices[wrong]),
                  "in the world each coordinate is " + Describe(limits::kCoordinate));
}

// Transforms a normal by the cofactor matrix. It equals the inverse transpose up to a factor, and
// also exists where the determinant is 0.
Vec3d TransformNormal(const Vec3d& normal, const Imath::M44d& world_from_vertex) {
  const auto row = [&](int i) {
    return Vec3d(world_from_vertex[i][0], world_from_vertex[i][1], world_from_vertex[i][2]);
  };
  const Vec3d x = row(1).cross(row(2)), y = row(2).cross(row(0)), z = row(0).cross(row(1));
  const double side = row(0).dot(x) < 0 ? -1 : 1;
  return ((x * normal.x + y * normal.y + z * normal.z) * side).normalized();
}

void ReadNormals(const GltfDocument& document, const Primitive& primitive, size_t positions,
                 const GltfPlacement& placement, Mesh* mesh) {
  const int index = AttributeOf(primitive, "NORMAL");
  if (index < 0) return;  // without normals, the specification requires flat shading
  const GltfAccessor accessor(document, index, "VEC3");
  accessor.CheckCount(document, positions);
  mesh->normals.resize(primitive.vertices.size());
  SetAll(primitive.vertices.size(), placement.ThreadsOf(document), [&](size_t i) {
    const uint32_t element = primitive.vertices[i];
    mesh->normals[i] =
        TransformNormal(Triple(accessor, element), placement.WorldFromVertex(element));
    return true;
  });
  MendNormals(mesh);  // some exporters write normals of length 0
}

// Tangents are transformed by the matrix itself; a mirroring matrix flips the sign of their
// bitangents. The specification says to ignore tangents without normals.
void ReadTangents(const Primitive& primitive, size_t positions, const GltfPlacement& placement,
                  GltfDocument* document, Mesh* mesh) {
  const int index = AttributeOf(primitive, "TANGENT");
  if (index < 0 || mesh->normals.empty()) return;
  const GltfAccessor accessor(*document, index, "VEC4");
  accessor.CheckCount(*document, positions);
  // The tolerance of Khronos' validator: the error of signed bytes, the coarsest format.
  constexpr double kTolerance = 0.00674;
  mesh->tangents.reserve(primitive.vertices.size());
  for (const uint32_t element : primitive.vertices) {
    const Imath::M44d world_from_vertex = placement.WorldFromVertex(element);
    const double hand = world_from_vertex.determinant() < 0 ? -1 : 1;
    const Vec3d given = Triple(accessor, element);
    const double sign = accessor.Number(element, 3);
    Vec3d direction;
    world_from_vertex.multDirMatrix(given, direction);
    direction.normalize();
    if (!(std::abs(given.length() - 1) <= kTolerance) || std::abs(sign) != 1 ||
        direction == Vec3d(0)) {
      document->Warn(
          "tangents that are no unit vectors with 1 or -1 behind are left out: MikkTSpace's take "
          "the place of their mesh's");
      mesh->tangents.clear();
      return;
    }
    mesh->tangents.push_back({direction, sign * hand});
  }
}

// Reverses the winding of mirrored triangles, so that their fronts stay in front. If only some of
// the joints of a triangle mirror it, the majority of its corners decides.
void TurnMirrored(const Primitive& primitive, const GltfPlacement& placement, Mesh* mesh) {
  if (!placement.is_skinned() && placement.WorldFromVertex(0).determinant() >= 0) return;
  std::vector<bool> mirrored;
  mirrored.reserve(primitive.vertices.size());
  for (const uint32_t element : primitive.vertices) {
    mirrored.push_back(placement.WorldFromVertex(element).determinant() < 0);
  }
  for (size_t i = 0; i < mesh->triangles.size(); i += 3) {
    const auto corner = [&](size_t c) -> int { return mirrored[mesh->triangles[i + c]]; };
    if (corner(0) + corner(1) + corner(2) < 2) continue;
    std::swap(mesh->triangles[i + 1], mesh->triangles[i + 2]);
  }
}

GltfPlacement PlacementOf(const Primitive& primitive, size_t positions,
                          const Imath::M44d& world_from_node,
                          const std::vector<Imath::M44d>* joints, GltfDocument* document) {
  if (joints == nullptr) return GltfPlacement(world_from_node);
  if (AttributeOf(primitive, "JOINTS_0") >= 0 && AttributeOf(primitive, "WEIGHTS_0") >= 0) {
    return GltfPlacement(*document, primitive.source, positions, *joints);
  }
  document->Warn("a mesh with a skin has no JOINTS_0 and WEIGHTS_0: its node moves it");
  return GltfPlacement(world_from_node);
}

void ReadUvs(const GltfDocument& document, const Primitive& primitive, const char* name,
             size_t positions, std::vector<Vec2d>* uvs) {
  const int index = AttributeOf(primitive, name);
  if (index < 0) return;
  const GltfAccessor accessor(document, index, "VEC2");
  accessor.CheckCount(document, positions);
  const size_t count = primitive.vertices.size();
  uvs->resize(count);
  const size_t wrong = SetAll(count, document.threads, [&](size_t i) {
    const uint32_t element = primitive.vertices[i];
    // In glTF, (0, 0) is an image's top left corner.
    const Vec2d uv(accessor.Number(element, 0), 1 - accessor.Number(element, 1));
    (*uvs)[i] = uv;
    return limits::kCoordinate.Contains(uv.x) && limits::kCoordinate.Contains(uv.y);
  });
  if (wrong == count) return;
  document.Refuse(accessor.place(),
                  fmt::format("texture coordinate {} is out of range", primitive.vertices[wrong]));
}

// Reads linear vertex colours. All-white colours, which many exporters write, have no effect and
// are dropped. Alpha counts if the material is a mask.
void ReadColors(const GltfDocument& document, const Primitive& primitive, size_t positions,
                Mesh* mesh) {
  const int index = AttributeOf(primitive, "COLOR_0");
  if (index < 0) return;
  const gltf::Accessor* const colors = gltf::ItemAt(document.model.accessors, index);
  const bool alpha = colors != nullptr && colors->type == "VEC4";
  const GltfAccessor accessor(document, index, alpha ? "VEC4" : "VEC3");
  accessor.CheckCount(document, positions);
  const auto& materials = document.model.materials;
  const bool masked = alpha && mesh->material.index < materials.size() &&
                      materials[mesh->material.index].alphaMode == "MASK";
  const auto in_unit = [](double value) { return value > 0 ? std::min(value, 1.0) : 0; };
  for (size_t i = 0; masked && i < primitive.vertices.size(); ++i) {
    const double opacity = in_unit(accessor.Number(primitive.vertices[i], 3));
    mesh->opacities.push_back(static_cast<float>(opacity));
  }
  const auto is_one = [](float opacity) { return opacity == 1; };
  if (std::all_of(mesh->opacities.begin(), mesh->opacities.end(), is_one)) mesh->opacities.clear();
  mesh->colors.reserve(primitive.vertices.size());
  bool white = true;
  for (const uint32_t element : primitive.vertices) {
    Vec3d color = Triple(accessor, element);
    for (int c = 0; c < 3; ++c) color[c] = in_unit(color[c]);
    white = white && color == Vec3d(1);
    mesh->colors.emplace_back(color);
  }
  if (white) mesh->colors.clear();
}

// Whether any texture of the material uses the second texture coordinates.
bool UsesSecondUvs(const Scene& scene, MaterialId id) {
  const std::vector<TextureId> textures = TexturesOf(scene.materials[id.index]);
  return std::any_of(textures.begin(), textures.end(),
                     [&](TextureId texture) { return scene.textures[texture.index].second_uvs; });
}

MaterialId MaterialOf(const GltfDocument& document, const Primitive& primitive) {
  if (document.variant) {
    for (const gltf::VariantMapping& mapping : primitive.source.mappings) {
      if (std::ranges::find(mapping.variants, *document.variant) != mapping.variants.end()) {
        return {static_cast<uint32_t>(mapping.material)};
      }
    }
  }
  const auto& materials = document.model.materials;
  const int index = primitive.source.material;
  if (index < 0) return {static_cast<uint32_t>(materials.size())};  // the default comes last
  document.At(materials, index, primitive.place + "/material",
              fmt::format("there is no material {}", index));
  return {static_cast<uint32_t>(index)};
}

// Refuses a primitive whose positions or indices have no data of their own, but an extension that
// refers to a buffer view, as extensions for compressed meshes do.
void RefuseCompressed(const GltfDocument& document, const Primitive& primitive) {
  const gltf::Extensions extensions = primitive.source.extensions;
  if (extensions == nullptr) return;
  const auto is_empty = [&](int index) {
    const gltf::Accessor* const accessor = gltf::ItemAt(document.model.accessors, index);
    return accessor != nullptr && accessor->bufferView < 0 && !accessor->sparse;
  };
  if (!is_empty(AttributeOf(primitive, "POSITION")) && !is_empty(primitive.source.indices)) return;
  for (const auto& [name, extension] : extensions->items()) {
    if (extension.contains("bufferView")) document.RefuseExtension(primitive.place, name);
  }
}

// The number of sparse elements in the primitive's accessors. They are read for every node that
// shows the primitive, whether or not its triangles use them.
uint64_t SparseElements(const gltf::Model& model, const gltf::Primitive& primitive) {
  uint64_t count = 0;
  const auto add = [&](int index) {
    const gltf::Accessor* const accessor = gltf::ItemAt(model.accessors, index);
    if (accessor != nullptr && accessor->sparse) {
      count += static_cast<uint64_t>(accessor->sparse->count);
    }
  };
  add(primitive.indices);
  for (const auto& [name, accessor] : primitive.attributes) add(accessor);
  return count;
}

void AddPrimitive(Primitive primitive, const std::string& name, const Imath::M44d& world_from_node,
                  const std::vector<Imath::M44d>* joints, GltfDocument* document,
                  SceneBudget* budget, Scene* scene) {
  const int mode = primitive.source.mode;
  const auto leave_out = [&](const char* warning) {
    budget->Spend(1, document->file);  // bounds how often nodes may show it
    document->Warn(warning);
  };
  if (mode < gltf::kTriangles) return leave_out("points and lines are not shown");
  if (mode > gltf::kTriangleFan) {
    document->Refuse(primitive.place + "/mode", fmt::format("{} is none", mode), "from 0 to 6");
  }
  if (primitive.source.targets != nullptr) {
    document->Warn("morph targets are left out: meshes are shown in their basic form");
  }
  if (AttributeOf(primitive, "POSITION") < 0) {
    return leave_out("primitives without positions are left out");
  }
  RefuseCompressed(*document, primitive);
  budget->Spend(SparseElements(document->model, primitive.source), document->file);
  const GltfAccessor positions(*document, AttributeOf(primitive, "POSITION"), "VEC3");
  primitive.triangles = ReadTriangles(*document, primitive, positions.count(), budget);
  Compact(&primitive);
  Mesh mesh;
  mesh.name = name;
  mesh.material = MaterialOf(*document, primitive);
  mesh.triangles = std::move(primitive.triangles);
  const GltfPlacement placement =
      PlacementOf(primitive, positions.count(), world_from_node, joints, document);
  ReadPositions(*document, primitive, positions, placement, &mesh);
  ReadNormals(*document, primitive, positions.count(), placement, &mesh);
  ReadTangents(primitive, positions.count(), placement, document, &mesh);
  ReadUvs(*document, primitive, "TEXCOORD_0", positions.count(), &mesh.uvs);
  if (UsesSecondUvs(*scene, mesh.material)) {
    ReadUvs(*document, primitive, "TEXCOORD_1", positions.count(), &mesh.second_uvs);
    if (mesh.second_uvs.empty()) {
      document->Warn("a mesh without TEXCOORD_1 has images on it: they are on its first ones");
    }
  }
  ReadColors(*document, primitive, positions.count(), &mesh);
  TurnMirrored(primitive, placement, &mesh);
  if (!HasArea(mesh)) {
    document->Warn("meshes without any area are left out");
    return;
  }
  scene->meshes.push_back(std::move(mesh));
}

}  // namespace

void AddGltfMesh(int mesh, const std::string& name, const Imath::M44d& world_from_node,
                 const std::vector<Imath::M44d>* joints, GltfDocument* document,
                 SceneBudget* budget, Scene* scene) {
  const auto& primitives = document
                               ->At(document->model.meshes, mesh, fmt::format("/meshes/{}", mesh),
                                    "there is no such mesh")
                               .primitives;
  for (size_t i = 0; i < primitives.size(); ++i) {
    AddPrimitive({primitives[i], fmt::format("/meshes/{}/primitives/{}", mesh, i), {}, {}}, name,
                 world_from_node, joints, document, budget, scene);
  }
}

}  // namespace nacre
