// SPDX-License-Identifier: Apache-2.0
#include "stress/surface_fuzz.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "render/render.h"
#include "stress/fuzz_draws.h"

namespace nacre {
namespace {

class BrokenModelMaker {
 public:
  explicit BrokenModelMaker(uint64_t seed) : random_(seed) {}

  Scene Make() {
    scene_.image.width = scene_.image.height = 12;
    scene_.image.spp = 2;
    scene_.camera.position = Vec3d(0, 0, 4);
    scene_.camera.fov_y_deg = 40;
    if (random_.OneIn(4)) scene_.camera.projection = Projection::kOrthographic;
    scene_.camera.height = 2.5;
    const size_t count = 1 + random_.Below(3);
    for (size_t i = 0; i < count; ++i) AddMesh(AddMaterial());
    if (random_.OneIn(2)) {
      const uint32_t material = AddMaterial();
      scene_.materials[material].single_sided = false;  // one side and holes are for meshes
      scene_.materials[material].opacity = 1;
      scene_.materials[material].opacity_cutoff = 0.5;
      scene_.materials[material].opacity_map = {};
      scene_.spheres.push_back(
          {random_.Direction() * random_.Uniform(0, 1), random_.Uniform(0.2, 0.8), {material}});
    }
    const size_t lights = 1 + random_.Below(2);
    for (size_t i = 0; i < lights; ++i) AddLight(i);
    scene_.image.shadows = !random_.OneIn(4);
    return std::move(scene_);
  }

 private:
  TextureId AddNoise() {
    constexpr int kSize = 4;
    constexpr float kValues[] = {0, 1, 0.5f, 128.0f / 255};
    std::vector<float> texels(3 * kSize * kSize);
    for (float& texel : texels) {
      texel = random_.OneIn(2) ? random_.Pick(kValues) : static_cast<float>(random_.Uniform(0, 1));
    }
    scene_.images.push_back(
        {"noise",
         std::make_shared<const MipChain>(MakeMipChain(kSize, kSize, 3, std::move(texels))),
         128.0f / 255});
    Texture texture;
    texture.image = {static_cast<uint32_t>(scene_.images.size() - 1)};
    texture.mapping = random_.OneIn(2) ? MappingKind::kUv : MappingKind::kSpherical;
    if (random_.OneIn(4)) texture.scale = Vec2d(-1, 3);
    texture.second_uvs = texture.mapping == MappingKind::kUv && random_.OneIn(3);
    scene_.textures.push_back(texture);
    return {static_cast<uint32_t>(scene_.textures.size() - 1)};
  }

  uint32_t AddMaterial() {
    const auto models = MaterialModels();
    const MaterialModel& model = models[random_.Below(models.size())];
    Material material = DrawMaterial(model, &random_);
    material.name = fmt::format("material {}", scene_.materials.size());
    for (const MaterialMap& map : model.maps) {
      if (random_.OneIn(3)) map.set(material, AddNoise());
    }
    if (random_.OneIn(3)) material.normal_map = {AddNoise(), random_.Magnitude(0.1, 10)};
    if (random_.OneIn(4)) material.bump_map = {AddNoise(), random_.Uniform(-2, 2)};
    scene_.materials.push_back(std::move(material));
    return static_cast<uint32_t>(scene_.materials.size() - 1);
  }

  // From anywhere on the sphere; about the axis of the view; across it; or opposed to another.
  Vec3d VertexNormal(const Mesh& mesh) {
    switch (random_.Below(4)) {
      case 0:
        return Vec3d(random_.Magnitude(1e-9, 1e-2), 1, random_.OneIn(2) ? 0 : -1e-3).normalized();
      case 1:
        return Vec3d(0, 0, random_.OneIn(2) ? 1 : -1);
      case 2:
        if (!mesh.normals.empty()) return -mesh.normals.back();
        [[fallthrough]];
      default:
        return random_.Direction();
    }
  }

  // What only some files have: tangents, along the normal as well as across it; second coordinates,
  // all the same in some; opacities at and about the cutoff; colours.
  void AddVertexData(Mesh* mesh) {
    const bool tangents = random_.OneIn(3), uvs = random_.OneIn(2), opacities = random_.OneIn(4);
    const bool colors = random_.OneIn(3);
    constexpr float kOpacities[] = {0, 0.5f, 0.5f, 1, 1, 1};
    for (size_t i = 0; i < mesh->positions.size(); ++i) {
      const Vec3d along = random_.OneIn(4) ? mesh->normals[i] : random_.Direction();
      if (tangents) mesh->tangents.push_back({along, random_.OneIn(2) ? 1.0 : -1.0});
      const bool same = i > 0 && random_.OneIn(3);
      const Vec2d uv(random_.Uniform(-2, 2), random_.Uniform(-2, 2));
      if (uvs) mesh->second_uvs.push_back(same ? mesh->second_uvs.back() : uv);
      if (opacities) mesh->opacities.push_back(random_.Pick(kOpacities));
      const auto unit = [&] { return static_cast<float>(random_.Uniform(0, 1)); };
      if (colors) mesh->colors.emplace_back(unit(), unit(), unit());
    }
  }

  void AddMesh(uint32_t material) {
    Mesh mesh;
    mesh.name = fmt::format("mesh {}", scene_.meshes.size());
    mesh.material = {material};
    constexpr Interpolation kAll[] = {Interpolation::kPhong, Interpolation::kPhong,
                                      Interpolation::kGouraud, Interpolation::kFlat,
                                      Interpolation::kFaceted};
    mesh.interpolation = random_.Pick(kAll);
    mesh.smooth_terminator = random_.OneIn(2);
    const size_t triangles = 1 + random_.Below(8);
    for (size_t i = 0; i < 3 * triangles; ++i) {
      Vec3d position = random_.Direction() * random_.Uniform(0, 1.5);
      // Of no area, all but the first, and as thin as can be.
      if (i % 3 == 2 && i > 2 && random_.OneIn(8)) position = mesh.positions.back();
      if (i % 3 == 2 && random_.OneIn(8)) position = mesh.positions.back() + Vec3d(1e-7, 0, 0);
      mesh.normals.push_back(VertexNormal(mesh));
      mesh.positions.push_back(position);
      const bool same = random_.OneIn(3) && !mesh.uvs.empty();  // no tangents
      mesh.uvs.push_back(same ? mesh.uvs.back()
                              : Vec2d(random_.Uniform(-2, 2), random_.Uniform(-2, 2)));
      mesh.triangles.push_back(static_cast<uint32_t>(i));
    }
    AddVertexData(&mesh);
    scene_.meshes.push_back(std::move(mesh));
  }

  std::shared_ptr<const SkyPicture> MakeSkyPicture() {
    auto picture = std::make_shared<SkyPicture>();
    picture->width = 8;
    picture->height = 4;
    for (int i = 0; i < 3 * picture->width * picture->height; ++i) {
      picture->rgb.push_back(static_cast<float>(random_.OneIn(8) ? 100 : random_.Uniform(0, 1)));
    }
    return picture;
  }

  void AddLight(size_t number) {
    const Vec3d place = random_.Direction() * random_.Uniform(0.5, 4), facing = random_.Direction();
    const Rgb color(random_.Uniform(0.1, 3), random_.Uniform(0.1, 3), random_.Uniform(0.1, 3));
    Light light;
    light.name = fmt::format("light {}", number);
    light.shadows = !random_.OneIn(3);
    // The last four are environments, of which a scene has one.
    const bool has_sky = std::any_of(
        scene_.lights.begin(), scene_.lights.end(),
        [](const Light& l) { return std::holds_alternative<EnvironmentLight>(l.kind); });
    switch (random_.Below(has_sky ? 7 : 11)) {
      case 0:
        light.kind = DirectionalLight{facing, color};
        break;
      case 1:
        light.kind = PointLight{.position = place, .intensity = color};
        break;
      case 2:
        light.kind = SpotLight{
            .position = place, .direction_of_travel = -place, .intensity = color, .cutoff_deg = 60};
        break;
      case 3:
        light.kind =
            SphereAreaLight{.center = place, .radius = random_.Uniform(0.1, 1), .radiance = color};
        break;
      case 4:
        light.kind = RectangleAreaLight{
            .center = place, .facing = facing, .radiance = color, .two_sided = random_.OneIn(2)};
        break;
      case 5:
        light.kind = DiskAreaLight{
            .center = place, .facing = facing, .radiance = color, .two_sided = random_.OneIn(2)};
        break;
      case 6: {
        auto mesh = std::make_shared<Mesh>();
        for (int i = 0; i < 4; ++i) mesh->positions.push_back(place + random_.Direction());
        mesh->triangles = {0, 1, 2, 0, 2, 3};
        light.kind = MeshAreaLight{mesh, color, random_.OneIn(2), random_.OneIn(2)};
        break;
      }
      case 7:
        light.kind = EnvironmentLight{.sky = ConstantSky{color}};
        break;
      case 8:
        light.kind = EnvironmentLight{.sky = GradientSky{}};
        break;
      case 9:
        light.kind = EnvironmentLight{.sky = QuadraticSky{color, facing, 0.5, 0.5, 0.5}};
        break;
      default:
        light.kind = EnvironmentLight{.sky = PictureSky{MakeSkyPicture(), color}};
        light.shadows = !random_.OneIn(5);
    }
    if (auto* sky = std::get_if<EnvironmentLight>(&light.kind)) sky->background = number == 0;
    scene_.lights.push_back(std::move(light));
  }

  FuzzRandom random_;
  Scene scene_;
};

void JudgePicture(uint64_t seed, const Image& image, SurfaceFuzzResult* result) {
  const std::vector<float>& alpha = image.Find("A")->samples;
  for (const char* name : {"R", "G", "B"}) {
    const std::vector<float>& samples = image.Find(name)->samples;
    for (size_t i = 0; i < samples.size(); ++i) {
      if (name[0] == 'R' && alpha[i] > 0) {
        ++result->pixels;
        if (samples[i] > 0) ++result->lit;
      }
      const bool finite = std::isfinite(samples[i]);
      result->not_finite += finite ? 0 : 1;
      result->negative += samples[i] < 0 ? 1 : 0;
      if ((!finite || samples[i] < 0) && result->first_fault.empty()) {
        result->first_fault = fmt::format("seed {}, pixel {}: {} = {}", seed, i, name, samples[i]);
      }
    }
  }
}

}  // namespace

Scene MakeBrokenModel(uint64_t seed) { return BrokenModelMaker(seed).Make(); }

SurfaceFuzzResult FuzzSurfaces(uint64_t scenes, const std::function<void(double)>& on_progress) {
  SurfaceFuzzResult result;
  for (uint64_t seed = 0; seed < scenes; ++seed) {
    const Scene scene = MakeBrokenModel(seed);
    RenderSettings settings{.threads = 1};
    RenderStats stats;
    JudgePicture(seed, RenderImage(scene, settings, &stats), &result);
    result.directions_not_finite += stats.directions_not_finite;
    if (stats.directions_not_finite > 0 && result.first_fault.empty()) {
      result.first_fault = fmt::format("seed {}: {} directions to light are not finite", seed,
                                       stats.directions_not_finite);
    }
    ++result.scenes;
    if (on_progress && seed % 64 == 0) {
      on_progress(static_cast<double>(seed) / static_cast<double>(scenes));
    }
  }
  return result;
}

std::string Describe(const SurfaceFuzzResult& result) {
  return fmt::format(
      "{} of {} pixels lit, {} samples not finite, {} negative, {} directions lost{}{}", result.lit,
      result.pixels, result.not_finite, result.negative, result.directions_not_finite,
      result.first_fault.empty() ? "" : "; ", result.first_fault);
}

}  // namespace nacre
