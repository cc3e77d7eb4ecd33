// SPDX-License-Identifier: Apache-2.0
// scene_io/gltf_skins.h: where the vertices of a glTF primitive are in the world: moved by the
// matrix of their node, or, in a mesh with a skin, each by the joints that it is weighted to.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/vec.h"
#include "scene_io/gltf_accessor.h"
#include "scene_io/gltf_document.h"

namespace nacre {

// For each joint of a skin the matrix from the mesh as it was bound to the joints to the world:
// the inverse bind matrix, then the world matrix of the joint's node (row vectors). `is_placed`
// says of each node whether it is in the scene, and so has one. Throws Error (kBadInput) for skins,
// joints and accessors that are not there, and for joints outside the scene.
std::vector<Imath::M44d> JointMatrices(const GltfDocument& document, int skin,
                                       const std::vector<Imath::M44d>& world_from_node,
                                       const std::vector<bool>& is_placed);

class GltfPlacement {
 public:
  // All vertices by one matrix.
  explicit GltfPlacement(const Imath::M44d& world_from_node) : world_from_node_(world_from_node) {}
  // Linear blend skinning: each vertex by the mean of its joints' matrices, weighted by WEIGHTS_0,
  // WEIGHTS_1 and so on, which are divided by their sum. Refers to `document` and `joints`. Throws
  // Error (kBadInput) for accessors that are not there or do not fit the positions, and for more
  // than 16 sets of weights.
  GltfPlacement(const GltfDocument& document, const gltf::Primitive& primitive, size_t positions,
                const std::vector<Imath::M44d>& joints);

  // Of the primitive's vertex of this number (row vectors, the last column is 0, 0, 0, 1). Throws
  // Error (kBadInput) for weights below 0 and for joints that the skin does not have.
  Imath::M44d WorldFromVertex(size_t vertex) const;

  bool is_skinned() const { return joints_ != nullptr; }
  // How many threads may ask for matrices: what is wrong with a skin is told by one.
  int ThreadsOf(const GltfDocument& document) const { return is_skinned() ? 1 : document.threads; }

 private:
  struct Influences {
    GltfAccessor joints, weights;  // four of each a vertex
  };
  const Imath::M44d& MatrixOf(const Influences& influences, size_t vertex, size_t c) const;

  Imath::M44d world_from_node_;
  const GltfDocument* document_ = nullptr;
  const std::vector<Imath::M44d>* joints_ = nullptr;  // null: there is no skin
  std::vector<Influences> influences_;
};

// Whether a skin can move the primitive: it says by which joints.
bool HasJoints(const gltf::Primitive& primitive);

}  // namespace nacre
