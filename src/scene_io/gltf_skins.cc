// SPDX-License-Identifier: Apache-2.0
#include "scene_io/gltf_skins.h"

#include <optional>
#include <string>

#include <fmt/format.h>

namespace nacre {
namespace {

constexpr size_t kMaxInfluences = 16;  // in sets of four joints

int SkinAttribute(const gltf::Primitive& primitive, const char* name, size_t set) {
  return gltf::AttributeOf(primitive, fmt::format("{}_{}", name, set));
}

// Reads matrix i of an accessor. The file stores it by columns, which is by rows for row vectors.
// The last row of the file's matrix, which is 0, 0, 0, 1, is not read.
Imath::M44d ReadAffine(const GltfAccessor& accessor, size_t i) {
  Imath::M44d matrix;
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 3; ++column) {
      matrix[row][column] = accessor.Number(i, static_cast<size_t>(4 * row + column));
    }
  }
  return matrix;
}

}  // namespace

std::vector<Imath::M44d> JointMatrices(const GltfDocument& document, int skin,
                                       const std::vector<Imath::M44d>& world_from_node,
                                       const std::vector<bool>& is_placed) {
  const std::string place = fmt::format("/skins/{}", skin);
  const gltf::Skin& source =
      document.At(document.model.skins, skin, place, "there is no such skin");
  std::optional<GltfAccessor> inverse_bind;  // nullopt: the identity
  if (source.inverseBindMatrices >= 0) {
    inverse_bind.emplace(document, source.inverseBindMatrices, "MAT4");
    if (!inverse_bind->is_float()) {
      document.Refuse(inverse_bind->place() + "/componentType", "matrices are of floats");
    }
    if (inverse_bind->count() < source.joints.size()) {
      document.Refuse(
          inverse_bind->place() + "/count",
          fmt::format("{} matrices for {} joints", inverse_bind->count(), source.joints.size()));
    }
  }
  std::vector<Imath::M44d> matrices;
  matrices.reserve(source.joints.size());
  for (size_t i = 0; i < source.joints.size(); ++i) {
    const auto node = static_cast<size_t>(source.joints[i]);
    if (node >= is_placed.size() || !is_placed[node]) {
      document.Refuse(fmt::format("{}/joints/{}", place, i),
                      fmt::format("node {} is not in the scene", node),
                      "a mesh and the joints that move it are in one scene");
    }
    matrices.push_back(inverse_bind ? ReadAffine(*inverse_bind, i) * world_from_node[node]
                                    : world_from_node[node]);
  }
  return matrices;
}

GltfPlacement::GltfPlacement(const GltfDocument& document, const gltf::Primitive& primitive,
                             size_t positions, const std::vector<Imath::M44d>& joints)
    : document_(&document), joints_(&joints) {
  for (size_t set = 0;; ++set) {
    const int joint = SkinAttribute(primitive, "JOINTS", set);
    const int weight = SkinAttribute(primitive, "WEIGHTS", set);
    if (joint < 0 || weight < 0) return;
    if (set == kMaxInfluences) {
      document.Refuse(fmt::format("/accessors/{}", joint),
                      fmt::format("more than {} sets of joints a vertex", kMaxInfluences));
    }
    influences_.push_back({{document, joint, "VEC4"}, {document, weight, "VEC4"}});
    influences_.back().joints.CheckCount(document, positions);
    influences_.back().weights.CheckCount(document, positions);
    if (!influences_.back().joints.is_unsigned()) {
      document.Refuse(influences_.back().joints.place() + "/componentType",
                      "joints are of an unsigned type");
    }
  }
}

const Imath::M44d& GltfPlacement::MatrixOf(const Influences& influences, size_t vertex,
                                           size_t c) const {
  const uint32_t joint = influences.joints.Index(vertex, c);
  if (joint >= joints_->size()) {
    document_->Refuse(influences.joints.place(),
                      fmt::format("joint {} of element {}", joint, vertex),
                      fmt::format("the skin has {}", joints_->size()));
  }
  return (*joints_)[joint];
}

Imath::M44d GltfPlacement::WorldFromVertex(size_t vertex) const {
  if (joints_ == nullptr) return world_from_node_;
  Imath::M44d sum(0.0);
  double total = 0;
  for (const Influences& influences : influences_) {
    for (size_t c = 0; c < 4; ++c) {
      const double weight = influences.weights.Number(vertex, c);
      if (!(weight >= 0)) {
        document_->Refuse(influences.weights.place(),
                          fmt::format("weight {} of element {}", weight, vertex),
                          "weights are 0 or more");
      }
      if (weight == 0) continue;  // then the joint's index is meaningless
      sum += MatrixOf(influences, vertex, c) * weight;
      total += weight;
    }
  }
  // Like the usual viewers, attaches a vertex without weights to its first joint.
  if (total == 0) return MatrixOf(influences_.front(), vertex, 0);
  sum /= total;
  for (int row = 0; row < 3; ++row) sum[row][3] = 0;
  sum[3][3] = 1;  // equal to 1 except for rounding
  return sum;
}

}  // namespace nacre
