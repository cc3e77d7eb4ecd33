// SPDX-License-Identifier: Apache-2.0
// scene_io/gltf.cc: scenes from glTF 2.0 files.
#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include <Imath/ImathQuat.h>
#include <fmt/format.h>

#include "scene_io/gltf_document.h"
#include "scene_io/gltf_readers.h"
#include "scene_io/gltf_skins.h"
#include "scene_io/model_files.h"
#include "scene_io/model_scene.h"

namespace nacre {
namespace {

// The node's matrix for row vectors. Its numbers are in the order of the file, which uses column
// vectors and stores matrices by columns.
Imath::M44d MatrixOf(GltfDocument* document, const gltf::Node& node, const std::string& place) {
  Imath::M44d matrix;
  if (!node.matrix.empty()) {
    if (!node.translation.empty() || !node.rotation.empty() || !node.scale.empty()) {
      document->Warn(
          "a node has a matrix, and a translation, rotation or scale: the matrix counts");
    }
    for (size_t i = 0; i < 16; ++i) matrix[static_cast<int>(i / 4)][i % 4] = node.matrix[i];
    if (matrix[0][3] != 0 || matrix[1][3] != 0 || matrix[2][3] != 0 || matrix[3][3] != 1) {
      document->Refuse(place + "/matrix", "is no matrix of translation, rotation and scale",
                       "its last row is 0, 0, 0, 1");
    }
    return matrix;
  }
  if (!node.scale.empty()) matrix.scale(Vec3d(node.scale[0], node.scale[1], node.scale[2]));
  if (!node.rotation.empty()) {
    const auto& q = node.rotation;
    const double length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    if (!(length > 0) || !std::isfinite(length)) {
      document->Refuse(place + "/rotation", "is no rotation", "a quaternion of length 1");
    }
    const Imath::Quatd unit(q[3] / length, q[0] / length, q[1] / length, q[2] / length);
    matrix = matrix * unit.toMatrix44();
  }
  if (!node.translation.empty()) {
    const auto& t = node.translation;
    for (int c = 0; c < 3; ++c) matrix[3][c] = t[static_cast<size_t>(c)];
  }
  return matrix;
}

// The root nodes of the default scene, or, in a file without scenes, the nodes without a parent.
std::vector<int> RootsOf(const GltfDocument& document) {
  const gltf::Model& model = document.model;
  if (!model.scenes.empty()) {
    const int scene = std::max(model.scene, 0);
    return document.At(model.scenes, scene, "/scene", fmt::format("there is no scene {}", scene))
        .nodes;
  }
  std::vector<bool> has_parent(model.nodes.size());
  for (const gltf::Node& node : model.nodes) {
    for (const int child : node.children) {
      if (gltf::ItemAt(model.nodes, child) != nullptr) {
        has_parent[static_cast<size_t>(child)] = true;
      }
    }
  }
  std::vector<int> roots;
  for (size_t i = 0; i < has_parent.size(); ++i) {
    if (!has_parent[i]) roots.push_back(static_cast<int>(i));
  }
  return roots;
}

// Visits the nodes from the roots, parents first, in the order of the file.
class NodeWalk {
 public:
  NodeWalk(uint64_t max_triangles, GltfDocument* document, Scene* scene)
      : document_(*document), scene_(*scene), budget_(max_triangles) {}

  bool has_camera() const { return has_camera_; }

  void Run() {
    Place();
    for (const size_t node : order_) Add(node);
  }

 private:
  struct Visit {
    int node;
    Imath::M44d world_from_parent;
  };

  // Finds the world matrices of all nodes before anything is added: joints may come after the
  // meshes that they move.
  void Place() {
    const size_t count = document_.model.nodes.size();
    world_from_node_.resize(count);
    is_placed_.resize(count);
    Push(RootsOf(document_), Imath::M44d());
    while (!stack_.empty()) {
      const Visit visit = stack_.back();
      stack_.pop_back();
      const std::string place = fmt::format("/nodes/{}", visit.node);
      const gltf::Node& node =
          document_.At(document_.model.nodes, visit.node, place, "there is no such node");
      const auto index = static_cast<size_t>(visit.node);
      if (is_placed_[index]) document_.Refuse(place, "is in the scene twice, or below itself");
      is_placed_[index] = true;
      world_from_node_[index] = MatrixOf(&document_, node, place) * visit.world_from_parent;
      order_.push_back(index);
      Push(node.children, world_from_node_[index]);
    }
  }

  void Push(const std::vector<int>& nodes, const Imath::M44d& world) {
    for (auto node = nodes.rbegin(); node != nodes.rend(); ++node) stack_.push_back({*node, world});
  }

  // The joints of the node's skin, or null if it has none.
  const std::vector<Imath::M44d>* JointsOf(const gltf::Node& node) {
    if (node.skin < 0) return nullptr;
    const auto [known, is_new] = joints_.try_emplace(node.skin);
    if (is_new) {
      known->second = JointMatrices(document_, node.skin, world_from_node_, is_placed_);
    }
    return &known->second;
  }

  void Add(size_t index) {
    const gltf::Node& node = document_.model.nodes[index];
    const Imath::M44d& world = world_from_node_[index];
    if (node.mesh >= 0) {
      AddGltfMesh(node.mesh, node.name, world, JointsOf(node), &document_, &budget_, &scene_);
    }
    if (node.camera >= 0 && !has_camera_) {
      if (const auto camera = MakeGltfCamera(node.camera, index, world, &document_)) {
        scene_.camera = *camera;
        has_camera_ = true;
      }
    }
    const Json* const light = gltf::FindExtension(node.extensions, "KHR_lights_punctual");
    if (light == nullptr) return;
    if (!light->contains("light")) {
      document_.Refuse(fmt::format("/nodes/{}/extensions/KHR_lights_punctual", index),
                       "has no \"light\"");
    }
    AddGltfLight((*light)["light"].get<int>(), index, world, &document_, &light_names_, &scene_);
  }

  GltfDocument& document_;
  Scene& scene_;
  SceneBudget budget_;
  UniqueNames light_names_;
  std::vector<Imath::M44d> world_from_node_;        // by node
  std::vector<bool> is_placed_;                     // by node: whether it is in the scene
  std::vector<size_t> order_;                       // the nodes in the scene, parents first
  std::map<int, std::vector<Imath::M44d>> joints_;  // by skin
  std::vector<Visit> stack_;  // instead of recursion: nodes may nest a million deep
  bool has_camera_ = false;
};

}  // namespace

Scene ReadGltf(const std::filesystem::path& path, const LoadOptions& options, bool* has_camera) {
  GltfDocument document = ReadGltfDocument(path, options);
  Scene scene;
  scene.materials = MakeGltfMaterials(&document, &scene);
  const uint64_t of_its_size = std::min(TrianglesOfBytes(document.bytes), kDefaultMaxPrimitives);
  NodeWalk walk(options.max_primitives.value_or(of_its_size), &document, &scene);
  walk.Run();
  SplitColoredMaterials(&scene);
  if (CompleteCoordinates(&scene)) {
    document.Warn("a mesh has images but no texture coordinates: it shows one texel of each");
  }
  *has_camera = walk.has_camera();
  const Json* const animations = document.model.animations;
  if (animations != nullptr && !animations->empty()) {
    document.Warn("animations are left out: nodes are where they are without them");
  }
  if (scene.meshes.empty()) document.Refuse({}, "has no triangles in its scene");
  return scene;
}

}  // namespace nacre
