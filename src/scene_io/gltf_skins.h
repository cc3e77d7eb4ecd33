// SPDX-License-Identifier: Apache-2.0
// scene_io/gltf_skins.h: where the vertices of a glTF primitive are in the world. They are moved by
// the matrix of their node, or, in a mesh with a skin, by the weighted joints of each vertex.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/vec.h"
#include "scene_io/gltf_accessor.h"
#include "scene_io/gltf_document.h"

namespace nacre {

// For each joint of a skin, the matrix from the mesh's bind pose to the world: the inverse bind
// matrix followed by the world matrix of the joint's node (row vectors). `is_placed` says for each
// node whether it is in the scene, and thus has a world matrix. Throws Error (kBadInput) for skins,
// joints and accessors that do not exist, and for joints outside the scene.
std::vector<Imath::M44d> JointMatrices(const GltfDocument& document, int skin,
                                       const std::vector<Imath::M44d>& world_from_node,
                                       const std::vector<bool>& is_placed);

class GltfPlacement {
 public:
  // Places all vertices by one matrix.
  explicit GltfPlacement(const Imath::M44d& world_from_node) : world_from_node_(world_from_node) {}
  // Linear blend skinning: each vertex is placed by the mean of its joints' matrices, weighted by
  // WEIGHTS_0, WEIGHTS_1 and so on, which are divided by their sum. Refers to `document` and
  // `joints`, which must outlive it. Throws Error (kBadInput) for accessors that do not exist or do
  // not match the positions in number, and for more than 16 sets of weights.
  GltfPlacement(const GltfDocument& document, const gltf::Primitive& primitive, size_t positions,
                const std::vector<Imath::M44d>& joints);

  // The matrix of vertex `vertex` of the primitive (row vectors; the last column is 0, 0, 0, 1).
  // Throws Error (kBadInput) for weights below 0 and for joints that the skin does not have.
  Imath::M44d WorldFromVertex(size_t vertex) const;

  bool is_skinned() const { return joints_ != nullptr; }
  // How many threads may call WorldFromVertex: a single one for skins, so that their errors are
  // reported in order.
  int ThreadsOf(const GltfDocument& document) const { return is_skinned() ? 1 : document.threads; }

 private:
  struct Influences {
    GltfAccessor joints, weights;  // four of each per vertex
  };
  const Imath::M44d& MatrixOf(const Influences& influences, size_t vertex, size_t c) const;

  Imath::M44d world_from_node_;
  const GltfDocument* document_ = nullptr;
  const std::vector<Imath::M44d>* joints_ = nullptr;  // null: there is no skin
  std::vector<Influences> influences_;
};

}  // namespace nacre
