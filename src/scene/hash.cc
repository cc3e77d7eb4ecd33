// SPDX-License-Identifier: Apache-2.0
#include "scene/hash.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <span>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "base/parallel.h"
#include "scene/keys.h"
#include "scene/material_parameters.h"

namespace nacre {
namespace {

// Order-dependent mixing of 64-bit words: multiply and fold (constants of MurmurHash3's
// finaliser, Appleby 2011).
class Hasher {
 public:
  void Word(uint64_t word) {
    state_ = (state_ ^ word) * 0xff51afd7ed558ccdu;
    state_ ^= state_ >> 33;
    state_ *= 0xc4ceb9fe1a85ec53u;
    state_ ^= state_ >> 29;
  }
  template <class... Words>
  void AddWords(Words... words) {
    (Word(static_cast<uint64_t>(words)), ...);
  }
  void Add(double value) { Word(std::bit_cast<uint64_t>(value)); }
  void Add(const Vec3d& v) { AddAll(v.x, v.y, v.z); }
  void Add(const Vec2d& v) { AddAll(v.x, v.y); }
  template <class Tag>
  void Add(Handle<Tag> id) {
    Word(id.index);
  }
  template <class... Values>
  void AddAll(const Values&... values) {
    (Add(values), ...);
  }
  void Add(std::string_view text) {
    Word(text.size());
    for (const char c : text) Word(static_cast<unsigned char>(c));
  }
  uint64_t state() const { return state_; }

 private:
  uint64_t state_ = 0x9e3779b97f4a7c15u;
};

// Hashes a piece of an array, eight bytes at a time, in four interleaved chains: in a single chain
// each multiplication would wait for the one before.
uint64_t HashPiece(std::span<const unsigned char> bytes) {
  constexpr size_t kChains = 4;
  std::array<Hasher, kChains> chains;
  std::array<uint64_t, kChains> words{};
  for (size_t i = 0; i < bytes.size(); i += sizeof(words)) {
    const size_t left = bytes.size() - i;
    if (left < sizeof(words)) words = {};
    std::memcpy(words.data(), bytes.data() + i, std::min(left, sizeof(words)));
    for (size_t chain = 0; chain < kChains; ++chain) chains[chain].Word(words[chain]);
  }
  Hasher all;
  for (const Hasher& chain : chains) all.Word(chain.state());
  return all.state();
}

// Splits `count` items into pieces, computes hash_piece(first, end) of each on several threads, and
// adds the results to `hash`.
template <class HashPieceOf>
void AddPieces(size_t count, size_t at_a_time, Hasher* hash, const HashPieceOf& hash_piece) {
  std::vector<uint64_t> pieces((count + at_a_time - 1) / at_a_time);
  ParallelFor(pieces.size(), 0, [&](size_t i) {
    const size_t first = i * at_a_time;
    pieces[i] = hash_piece(first, std::min(first + at_a_time, count));
  });
  for (const uint64_t piece : pieces) hash->Word(piece);
}

constexpr size_t kPiece = size_t{1} << 20;  // bytes in a piece of a long array

template <class T>
std::span<const unsigned char> BytesOf(std::span<const T> values) {
  static_assert(std::is_standard_layout_v<T> && sizeof(T) % sizeof(float) == 0);
  return {reinterpret_cast<const unsigned char*>(values.data()), values.size_bytes()};
}

// Adds a long array, piece by piece on several threads.
template <class T>
void AddArray(std::span<const T> values, Hasher* hash) {
  const std::span<const unsigned char> bytes = BytesOf(values);
  AddPieces(bytes.size(), kPiece, hash,
            [&](size_t first, size_t end) { return HashPiece(bytes.subspan(first, end - first)); });
}
template <class T, class Allocator>
void AddArray(const std::vector<T, Allocator>& values, Hasher* hash) {
  AddArray(std::span<const T>(values), hash);
}

// Adds the values of all keys of `owner` (scene/keys.h).
template <class Owner>
void AddKeys(const Owner& owner, Hasher* hash) {
  for (const SceneKey<Owner>& key : KeysFor(owner)) {
    const Vec3d value = key.get(owner);
    switch (key.form) {
      case KeyForm::kNumber:
        hash->Add(value.x);
        break;
      case KeyForm::kColor:
      case KeyForm::kPoint:
      case KeyForm::kDirection:
        hash->Add(value);
        break;
      case KeyForm::kWhole:
      case KeyForm::kBoolean:
      case KeyForm::kChoice:
        hash->Word(static_cast<uint64_t>(value.x));
        break;
    }
  }
}

// The hashes of pictures and meshes that scenes share: finds those that were kept from the last
// call, and collects those that this call uses.
class SharedHashes {
 public:
  explicit SharedHashes(const KeptHashes* kept) : kept_(kept) {}

  // The hash of `source`: the one that was kept, or else one that add(&hasher) computes.
  template <class Source, class AddTo>
  uint64_t Of(const std::shared_ptr<const Source>& source, const AddTo& add) {
    if (const KeptHashes::Entry* const known = Find(source.get())) return Use(*known);
    Hasher hash;
    add(&hash);
    return Use({source, hash.state()});
  }

  std::vector<KeptHashes::Entry> used() && { return std::move(used_); }

 private:
  const KeptHashes::Entry* Find(const void* source) const {
    if (kept_ == nullptr) return nullptr;
    const auto found =
        std::find_if(kept_->shared.begin(), kept_->shared.end(),
                     [&](const auto& entry) { return entry.source.get() == source; });
    return found != kept_->shared.end() ? &*found : nullptr;
  }
  uint64_t Use(const KeptHashes::Entry& entry) {
    if (kept_ != nullptr) used_.push_back(entry);
    return entry.hash;
  }

  const KeptHashes* kept_;
  std::vector<KeptHashes::Entry> used_;
};

// Hashes the contents of an image; its file name does not count.
void Add(const SceneImage& image, SharedHashes* shared, Hasher* hash) {
  const MipLevel& whole = image.texels->levels[0];
  hash->AddWords(whole.width, whole.height, image.texels->channels,
                 std::bit_cast<uint32_t>(image.middle));
  hash->Word(shared->Of(image.texels, [&](Hasher* own) {
    const TexelView texels = image.texels->Level(0);
    AddPieces(texels.size(), kPiece / sizeof(float), own, [&](size_t first, size_t end) {
      std::vector<float> values(end - first);
      texels.Read(first, values);
      return HashPiece(BytesOf(std::span<const float>(values)));
    });
  }));
}

void Add(const Texture& texture, Hasher* hash) {
  const SampleSettings& sampling = texture.sampling;
  hash->AddWords(texture.image.index, sampling.filter, sampling.wrap_u, sampling.wrap_v,
                 texture.mapping);
  hash->AddAll(texture.axis, texture.rotate_deg, texture.center, texture.size, texture.scale,
               texture.uv_rotate_deg, texture.offset);
  hash->Word(texture.second_uvs);
}

// Adds nothing for a material without maps.
void AddMaps(const Material& material, Hasher* hash) {
  const MaterialModel* const model = ModelOf(material);
  if (model == nullptr) return;
  for (size_t i = 0; i < model->maps.size(); ++i) {
    const TextureId id = model->maps[i].get(material);
    if (!id.valid()) continue;
    hash->Word(i);
    hash->Add(id);
  }
  for (const MaterialNormalMap& row : model->normal_maps) {
    const NormalMap& map = NormalMapOf(row, material);
    if (!map.texture.valid()) continue;
    if (&row != model->normal_maps.data()) hash->Add(row.name);
    hash->AddAll(map.texture, map.scale);
    hash->AddWords(map.convention);
  }
  const BumpMap& bumps = material.bump_map;
  if (bumps.texture.valid()) hash->AddAll(bumps.texture, bumps.distance);
}

void AddSplit(const SplitMaterial& split, Hasher* hash) {
  hash->Word(split.at.size());
  for (const double at : split.at) hash->Add(at);
  hash->Word(split.materials.size());
  for (const MaterialId id : split.materials) hash->Add(id);
}

// Adds all parameters and choices of the material's model (scene/material_parameters.h).
void AddModel(const Material& material, Hasher* hash) {
  const MaterialModel* const model = ModelOf(material);
  if (model == nullptr) return AddSplit(std::get<SplitMaterial>(material.model), hash);
  hash->Add(model->name);
  for (const MaterialParameter& parameter : model->parameters) {
    const Rgb value = parameter.get(material);
    parameter.is_color ? hash->Add(value) : hash->Add(value.x);
  }
  for (const MaterialChoice& choice : model->choices) {
    if (choice.get != nullptr) hash->Word(choice.get(material));
  }
  if (const auto* measured = std::get_if<MeasuredMaterial>(&material.model)) {
    hash->Word(measured->brdf ? measured->brdf->hash : 0);
  }
}

// Adds a kind of light, or of sky: its keys, and the contents of the mesh or picture that it refers
// to.
struct AddLightKind {
  SharedHashes* shared;
  Hasher* hash;

  template <class Kind>
  void operator()(const Kind& kind) const {
    AddKeys(kind, hash);
  }
  void operator()(const MeshAreaLight& light) const {
    hash->AddWords(light.mesh->positions.size(), light.mesh->triangles.size());
    hash->Word(shared->Of(light.mesh, [&](Hasher* own) {
      AddArray(light.mesh->positions, own);
      AddArray(light.mesh->triangles, own);
    }));
    AddKeys(light, hash);
  }
  void operator()(const EnvironmentLight& light) const {
    hash->Word(light.sky.index());
    std::visit(*this, light.sky);
    AddKeys(light, hash);
  }
  void operator()(const PictureSky& sky) const {
    hash->AddWords(sky.picture->width, sky.picture->height);
    hash->Word(shared->Of(sky.picture, [&](Hasher* own) { AddArray(sky.picture->rgb, own); }));
    AddKeys(sky, hash);
  }
};

uint64_t HashMaterial(const Material& material) {
  Hasher hash;
  hash.AddWords(material.emits_in_front_only, material.vertex_colors);
  AddModel(material, &hash);
  AddMaps(material, &hash);
  return hash.state();
}

uint64_t HashSphere(const Sphere& sphere) {
  Hasher hash;
  hash.AddAll(sphere.center, sphere.radius, sphere.material);
  return hash.state();
}

// Hashes of materials and of spheres are combined in groups, so that after a change of one of them
// few need be combined again.
constexpr size_t kMaterialGroup = 256, kSphereGroup = 1024;

void AddMaterials(const std::vector<Material>& materials, KeptHashes* kept, Hasher* hash) {
  const size_t count = materials.size();
  if (kept->materials.size() != count) kept->material_groups.clear();
  kept->materials.resize(count);
  kept->material_groups.resize((count + kMaterialGroup - 1) / kMaterialGroup);
  for (size_t group = 0; group < kept->material_groups.size(); ++group) {
    std::optional<uint64_t>& joined = kept->material_groups[group];
    if (!joined) {
      Hasher of_group;
      const size_t end = std::min(count, (group + 1) * kMaterialGroup);
      for (size_t i = group * kMaterialGroup; i < end; ++i) {
        if (!kept->materials[i]) kept->materials[i] = HashMaterial(materials[i]);
        of_group.Word(*kept->materials[i]);
      }
      joined = of_group.state();
    }
    hash->Word(*joined);
  }
}

void AddSpheres(std::span<const Sphere> spheres, std::vector<std::optional<uint64_t>>* groups,
                Hasher* hash) {
  hash->Word(spheres.size());
  groups->resize((spheres.size() + kSphereGroup - 1) / kSphereGroup);
  std::vector<size_t> missing;
  for (size_t group = 0; group < groups->size(); ++group) {
    if (!(*groups)[group]) missing.push_back(group);
  }
  ParallelFor(missing.size(), 0, [&](size_t i) {
    // Each sphere is hashed by itself: in one chain each multiplication would wait for the one
    // before.
    Hasher of_group;
    const size_t first = missing[i] * kSphereGroup;
    const size_t end = std::min(spheres.size(), first + kSphereGroup);
    for (size_t sphere = first; sphere < end; ++sphere) of_group.Word(HashSphere(spheres[sphere]));
    (*groups)[missing[i]] = of_group.state();
  });
  for (const std::optional<uint64_t>& group : *groups) hash->Word(*group);
}

uint64_t HashMeshes(std::span<const Mesh> meshes) {
  Hasher hash;
  hash.Word(meshes.size());
  const auto add_sizes = [&](const auto&... arrays) { hash.AddWords(arrays.size()...); };
  const auto add_arrays = [&](const auto&... arrays) { (AddArray(arrays, &hash), ...); };
  for (const Mesh& mesh : meshes) {
    add_sizes(mesh.positions, mesh.normals, mesh.uvs, mesh.second_uvs, mesh.colors, mesh.tangents,
              mesh.opacities, mesh.triangles);
    hash.AddWords(mesh.interpolation, mesh.smooth_terminator);
    add_arrays(mesh.positions, mesh.normals, mesh.uvs, mesh.second_uvs, mesh.colors, mesh.opacities,
               mesh.tangents, mesh.triangles);
    hash.Add(mesh.material);
  }
  return hash.state();
}

uint64_t HashShapes(std::span<const Sphere> spheres, std::span<const Mesh> meshes,
                    KeptHashes* kept) {
  Hasher hash;
  AddSpheres(spheres, &kept->sphere_groups, &hash);
  if (!kept->meshes) kept->meshes = HashMeshes(meshes);
  hash.Word(*kept->meshes);
  return hash.state();
}

}  // namespace

void KeptHashes::ForgetMaterials() {
  materials.clear();
  material_groups.clear();
}

void KeptHashes::ForgetMaterial(size_t material) {
  materials[material].reset();
  material_groups[material / kMaterialGroup].reset();
}

void KeptHashes::ForgetShapes() {
  sphere_groups.clear();
  meshes.reset();
}

void KeptHashes::ForgetSphere(size_t sphere) {
  if (sphere / kSphereGroup < sphere_groups.size()) sphere_groups[sphere / kSphereGroup].reset();
}

uint64_t HashScene(const Scene& scene, KeptHashes* kept) {
  Hasher hash;
  SharedHashes shared(kept);
  AddKeys(scene.camera, &hash);
  AddKeys(scene.image, &hash);
  hash.Add(scene.background);
  for (const SceneImage& image : scene.images) Add(image, &shared, &hash);
  for (const Texture& texture : scene.textures) Add(texture, &hash);
  hash.Word(scene.materials.size());  // sizes, so that no value can pass for one of the next array
  KeptHashes own;
  KeptHashes* const known = kept != nullptr ? kept : &own;
  AddMaterials(scene.materials, known, &hash);
  hash.Word(scene.lights.size());
  for (const Light& light : scene.lights) {
    hash.Word(light.kind.index());
    hash.Add(std::string_view(light.name));
    hash.Word(light.shadows);
    std::visit(AddLightKind{&shared, &hash}, light.kind);
  }
  hash.Word(HashShapes(scene.spheres, scene.meshes, known));
  if (kept != nullptr) kept->shared = std::move(shared).used();
  return hash.state();
}

uint64_t HashShapes(std::span<const Sphere> spheres, std::span<const Mesh> meshes) {
  KeptHashes own;
  return HashShapes(spheres, meshes, &own);
}

}  // namespace nacre
