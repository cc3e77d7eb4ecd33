// SPDX-License-Identifier: Apache-2.0
// api/scene_bytes.cc: serialises scenes of the public API to bytes (CBOR), for other processes.
#include <cstring>
#include <filesystem>
#include <utility>

#include "api/scene_impl.h"
#include "base/path.h"

namespace nacre::v0 {
namespace {

template <class Item>
Json BytesOf(const std::vector<Item>& items) {
  std::vector<uint8_t> bytes(items.size() * sizeof(Item));
  if (!items.empty()) std::memcpy(bytes.data(), items.data(), bytes.size());
  return Json::binary(std::move(bytes));
}

template <class Item>
std::vector<Item> ItemsOf(const Json& json) {
  const std::vector<uint8_t>& bytes = json.get_binary();
  std::vector<Item> items(bytes.size() / sizeof(Item));
  if (!items.empty()) {
    std::memcpy(static_cast<void*>(items.data()), bytes.data(), items.size() * sizeof(Item));
  }
  return items;
}

// Makes a path absolute, as the other process may have another working directory.
std::string Absolute(const std::filesystem::path& path) {
  return path.empty() ? std::string() : AbsolutePath(path).string();
}

Json Pack(const Scene::Impl::Source& source) {
  const SceneDocument& document = source.document;
  Json packed = {{"nacre", Version()},
                 {"text", JsonText(*ValueIn(document.tree, ""))},
                 {"model", Absolute(document.model)},
                 {"file", document.file},
                 {"folder", Absolute(document.folder)},
                 {"bytes", document.bytes},
                 {"own_lights", document.own_lights},
                 {"allow_paths", source.allow_paths},
                 {"names", source.names},
                 {"meshes", Json::array()}};
  std::vector<double> balls;
  std::vector<uint32_t> materials;
  for (const nacre::Sphere& sphere : source.spheres) {
    const Vec3d& center = sphere.center;
    balls.insert(balls.end(), {center.x, center.y, center.z, sphere.radius});
    materials.push_back(sphere.material.index);
  }
  packed["balls"] = BytesOf(balls);
  packed["materials"] = BytesOf(materials);
  for (const nacre::Mesh& mesh : source.meshes) {
    packed["meshes"].push_back({{"material", mesh.material.index},
                                {"positions", BytesOf(mesh.positions)},
                                {"normals", BytesOf(mesh.normals)},
                                {"uvs", BytesOf(mesh.uvs)},
                                {"triangles", BytesOf(mesh.triangles)}});
  }
  return packed;
}

Scene::Impl::Source Unpack(const Json& packed) {
  if (packed.at("nacre") != Version()) {
    throw nacre::Error(ExitCode::kBadInput, "Scene", "these bytes are of another version of nacre",
                       "a scene file is read by all later ones");
  }
  Scene::Impl::Source source;
  SceneDocument& document = source.document;
  document.model = packed.at("model").get<std::string>();
  document.file = packed.at("file");
  document.folder = packed.at("folder").get<std::string>();
  document.own_lights = packed.at("own_lights");
  const std::string text = packed.at("text");
  FaultList faults;
  document.tree.root = ParseJson(text, document.file, &faults, {},
                                 document.model.empty() ? &document.tree.spheres : nullptr);
  document.bytes = packed.at("bytes");
  source.allow_paths = packed.at("allow_paths");
  source.names = packed.at("names").get<std::vector<std::string>>();
  for (uint32_t i = 0; i < source.names.size(); ++i) source.places.try_emplace(source.names[i], i);
  const auto material_of = [&](uint32_t index) {
    static_cast<void>(source.names.at(index));  // throws if there is no such material
    return nacre::MaterialId{index};
  };
  const auto balls = ItemsOf<double>(packed.at("balls"));
  const auto materials = ItemsOf<uint32_t>(packed.at("materials"));
  for (size_t i = 0; i < materials.size(); ++i) {
    const Vec3d center(balls.at(4 * i), balls.at(4 * i + 1), balls.at(4 * i + 2));
    source.spheres.push_back({center, balls.at(4 * i + 3), material_of(materials[i])});
  }
  for (const Json& mesh : packed.at("meshes")) {
    nacre::Mesh& own = source.meshes.emplace_back();
    own.material = material_of(mesh.at("material"));
    own.positions = ItemsOf<Vec3d>(mesh.at("positions"));
    own.normals = ItemsOf<Vec3d>(mesh.at("normals"));
    own.uvs = ItemsOf<Vec2d>(mesh.at("uvs"));
    own.triangles = ItemsOf<uint32_t>(mesh.at("triangles"));
  }
  return source;
}

}  // namespace

std::vector<uint8_t> Scene::ToBytes() const {
  return AtBorder([&] {
    const Impl::Source& source = impl_->source;
    if (!source.user_brdfs.empty()) {
      throw nacre::Error(ExitCode::kUsage, "Scene",
                         "the material \"" + source.user_brdfs.begin()->first +
                             "\" is a function, which cannot be written",
                         "make the scene where it is rendered");
    }
    return Json::to_cbor(Pack(source));
  });
}

Scene Scene::FromBytes(const std::vector<uint8_t>& bytes) {
  return AtBorder([&] {
    Scene scene;
    try {
      scene.impl_->source = Unpack(Json::from_cbor(bytes));
    } catch (const nacre::Error&) {
      throw;
    } catch (const std::exception&) {
      throw nacre::Error(ExitCode::kBadInput, "Scene", "these bytes are no scene",
                         "they are those of Scene::ToBytes");
    }
    return scene;
  });
}

}  // namespace nacre::v0
