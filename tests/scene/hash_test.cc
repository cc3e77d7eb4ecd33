// SPDX-License-Identifier: Apache-2.0
// tests/scene/hash_test.cc: a scene's fingerprint tells every value that shows from another.
#include "scene/hash.h"

#include <memory>
#include <set>
#include <vector>

#include "catch.h"
#include "scene/material_parameters.h"
#include "scene/sphere_mesh.h"

namespace nacre {
namespace {

Scene MakeScene() {
  Scene scene;
  Material lambert, phong, ggx, conductor, dielectric, rough, burley;
  rough.model = OrenNayarMaterial{};
  burley.model = BurleyMaterial{};
  conductor.model = ConductorMaterial{};
  dielectric.model = DielectricMaterial{};
  lambert.model = LambertMaterial{};
  phong.model = PhongMaterial{};
  ggx.model = MetallicRoughnessMaterial{};
  scene.materials = {lambert, phong, ggx, conductor, dielectric, rough, burley};
  scene.spheres = {{{0, 0, 0}, 1, {0}}, {{1, 0, 0}, 1, {1}}};
  Light key;
  key.name = "key";
  key.kind = PointLight{};
  scene.lights = {key};
  scene.meshes = {MakeMesh(UvSphere{.segments = 3, .rings = 2})};
  return scene;
}

TEST_CASE("equal scenes have equal hashes, names of materials aside") {
  Scene scene = MakeScene();
  const uint64_t hash = HashScene(scene);
  CHECK(HashScene(MakeScene()) == hash);
  scene.materials[0].name = "other";
  CHECK(HashScene(scene) == hash);
}

TEST_CASE("every parameter of every material changes the hash") {
  const uint64_t hash = HashScene(MakeScene());
  for (size_t i = 0; i < MakeScene().materials.size(); ++i) {
    for (const MaterialParameter& parameter : ModelOf(MakeScene().materials[i])->parameters) {
      CAPTURE(parameter.name);
      Scene scene = MakeScene();
      parameter.set(scene.materials[i], Rgb(0.123, 0.123, 0.123));
      const uint64_t grey = HashScene(scene);
      CHECK(grey != hash);
      if (!parameter.is_color) continue;
      for (const Rgb& color :
           {Rgb(0.2, 0.123, 0.123), Rgb(0.123, 0.2, 0.123), Rgb(0.123, 0.123, 0.2)}) {
        parameter.set(scene.materials[i], color);
        CHECK(HashScene(scene) != grey);
      }
    }
    for (const MaterialChoice& choice : ModelOf(MakeScene().materials[i])->choices) {
      if (choice.get == nullptr) continue;
      CAPTURE(choice.name);
      Scene scene = MakeScene();
      choice.set(scene.materials[i], (choice.get(scene.materials[i]) + 1) % choice.options.size());
      CHECK(HashScene(scene) != hash);
    }
  }
}

TEST_CASE("what else shows changes the hash") {
  const uint64_t hash = HashScene(MakeScene());
  const auto differs = [&](auto change) {
    Scene scene = MakeScene();
    change(&scene);
    return HashScene(scene) != hash;
  };
  CHECK(differs([](Scene* s) { s->camera.position.x += 1e-12; }));
  CHECK(differs([](Scene* s) { s->image.spp = 17; }));
  CHECK(differs([](Scene* s) { s->image.seed = 1; }));
  CHECK(differs([](Scene* s) { s->image.shadows = false; }));
  CHECK(differs([](Scene* s) { s->background.z = 1; }));
  CHECK(differs([](Scene* s) { s->lights[0].shadows = false; }));
  CHECK(differs([](Scene* s) { s->materials[0].vertex_colors = VertexColors::kBase; }));
  CHECK(differs([](Scene* s) { s->lights[0].kind = SpotLight{}; }));
  CHECK(differs([](Scene* s) { std::swap(s->spheres[0], s->spheres[1]); }));
  CHECK(differs([](Scene* s) { s->spheres.pop_back(); }));
  CHECK(differs([](Scene* s) { s->meshes.pop_back(); }));
  CHECK(differs([](Scene* s) { s->meshes[0].positions[2].y += 1e-12; }));
  CHECK(differs([](Scene* s) { s->meshes[0].normals.clear(); }));
  CHECK(differs([](Scene* s) { s->meshes[0].uvs.clear(); }));
  CHECK(differs([](Scene* s) { s->meshes[0].uvs[1].y += 1e-12; }));
  CHECK(differs([](Scene* s) { s->meshes[0].second_uvs = s->meshes[0].uvs; }));
  CHECK(differs([](Scene* s) { s->meshes[0].colors.resize(s->meshes[0].positions.size()); }));
  CHECK(differs([](Scene* s) { s->meshes[0].opacities.resize(s->meshes[0].positions.size()); }));
  CHECK(differs([](Scene* s) { s->meshes[0].tangents.resize(s->meshes[0].positions.size()); }));
  CHECK(differs([](Scene* s) { s->materials[0].opacity_cutoff = 0.25; }));
  CHECK(differs([](Scene* s) { s->meshes[0].interpolation = Interpolation::kFaceted; }));
  CHECK(differs([](Scene* s) { s->meshes[0].smooth_terminator = false; }));
}

// They are hashed in chains of eight bytes each, and the last of them may be shorter.
TEST_CASE("every value of an array counts, and where it stands") {
  Scene scene = MakeScene();
  Mesh& mesh = scene.meshes[0];
  for (size_t count = 1; count < 20; ++count) {
    mesh.opacities.assign(count, 0.5f);
    const uint64_t hash = HashShapes(scene);
    std::set<uint64_t> hashes = {hash};
    for (float& opacity : mesh.opacities) {
      opacity = 0.25f;
      CHECK(hashes.insert(HashShapes(scene)).second);
      opacity = 0.5f;
    }
    CHECK(HashShapes(scene) == hash);
  }
}

// Pieces of an array are hashed on their own, and mixed in their order.
TEST_CASE("of long arrays it counts which piece a value is in") {
  Scene scene = MakeScene();
  std::vector<float>& opacities = scene.meshes[0].opacities;
  constexpr size_t kPiece = size_t{1} << 18;  // values
  opacities.assign(3 * kPiece + 5, 0.5f);
  std::set<uint64_t> hashes = {HashShapes(scene)};
  for (const size_t i : {size_t{7}, kPiece + 7, 2 * kPiece + 7, 3 * kPiece + 4}) {
    opacities[i] = 0.25f;
    CHECK(hashes.insert(HashShapes(scene)).second);
    opacities[i] = 0.5f;
  }
}

std::shared_ptr<SkyPicture> MakePicture(float value) {
  return std::make_shared<SkyPicture>(SkyPicture{1, 1, {value, value, value}});
}

void ShowSky(const std::shared_ptr<SkyPicture>& picture, Scene* scene) {
  scene->lights.resize(1);
  Light& sky = scene->lights.emplace_back();
  sky.name = "sky";
  sky.kind = EnvironmentLight{.sky = PictureSky{.picture = picture}};
}

TEST_CASE("hashes that are kept give that of the scene, whatever changes") {
  Scene scene = MakeScene();
  KeptHashes kept;
  const auto check = [&] {
    kept.ForgetShapes();
    CHECK(HashScene(scene, &kept) == HashScene(scene));
    CHECK(HashScene(scene, &kept) == HashScene(scene));
  };
  check();
  ShowSky(MakePicture(1), &scene);
  check();
  CHECK(kept.shared.size() == 1);
  scene.materials.pop_back();
  check();
  ShowSky(MakePicture(2), &scene);
  check();
  CHECK(kept.shared.size() == 1);  // the other one is let go
  scene.spheres.pop_back();
  check();
}

TEST_CASE("of many materials those are hashed that have changed") {
  Scene scene = MakeScene();
  scene.materials.resize(1000, scene.materials[0]);
  KeptHashes kept;
  HashScene(scene, &kept);
  for (const size_t changed : {size_t{0}, size_t{255}, size_t{256}, size_t{999}}) {
    scene.materials[changed].emission = Rgb(static_cast<double>(1 + changed));
    kept.ForgetMaterial(changed);
    CHECK(HashScene(scene, &kept) == HashScene(scene));
  }
  scene.materials.resize(1001, scene.materials[0]);
  CHECK(HashScene(scene, &kept) == HashScene(scene));
  std::swap(scene.materials[0], scene.materials[999]);
  CHECK(HashScene(scene) != HashScene(scene, &kept));  // the order counts
}

TEST_CASE("of many spheres those groups are hashed that have changed") {
  Scene scene = MakeScene();
  scene.spheres.resize(3000, scene.spheres[0]);
  KeptHashes kept;
  HashScene(scene, &kept);
  for (const size_t changed : {size_t{0}, size_t{1023}, size_t{1024}, size_t{2999}}) {
    scene.spheres[changed].radius = 0.5 + static_cast<double>(changed);
    CHECK(HashScene(scene, &kept) != HashScene(scene));
    kept.ForgetSphere(changed);
    CHECK(HashScene(scene, &kept) == HashScene(scene));
  }
  scene.meshes.push_back(scene.meshes[0]);
  kept.ForgetShapes();
  CHECK(HashScene(scene, &kept) == HashScene(scene));
}

TEST_CASE("what is shared, and shapes that are the same, are hashed once") {
  Scene scene = MakeScene();
  const auto picture = MakePicture(1);
  ShowSky(picture, &scene);
  KeptHashes kept;
  const uint64_t hash = HashScene(scene, &kept);
  // Against the rules, so that it would show.
  picture->rgb[0] = 2;
  scene.spheres[0].radius *= 2;
  scene.meshes.clear();
  CHECK(HashScene(scene, &kept) == hash);
  scene.image.spp = 17;
  CHECK(HashScene(scene, &kept) != hash);
}

}  // namespace
}  // namespace nacre
