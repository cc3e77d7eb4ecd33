#include "shading/shade.h"

#include <algorithm>
#include <cmath>
#include <variant>

#include "brdf/fresnel.h"
#include "brdf/ggx.h"
#include "brdf/phong.h"
#include "shading/kernels.h"

namespace nacre {
namespace {

// Chooses by a variant's alternative.
template <class... Ts>
struct Overloaded : Ts... {
  using Ts::operator()...;
};
template <class... Ts>
Overloaded(Ts...) -> Overloaded<Ts...>;

void Assign(const Vec3d& from, float (&to)[3]) {
  for (int c = 0; c < 3; ++c) to[c] = static_cast<float>(from[c]);
}

AttenuationTerms<float> ToTerms(const Attenuation& a) {
  return {static_cast<float>(a.constant), static_cast<float>(a.linear),
          static_cast<float>(a.quadratic)};
}

ConeTerms<float> ToTerms(const SpotLight& spot) {
  const auto cosine = [](double degrees) {
    return static_cast<float>(std::cos(degrees * M_PI / 180));
  };
  return {cosine(spot.cutoff_deg), cosine(spot.inner_deg), static_cast<float>(spot.exponent)};
}

LightUniforms MakeUniforms(const Light& light, const Vec3d& camera_position) {
  LightUniforms uniforms;
  const auto place = [&](const Vec3d& position) {
    const Vec3d relative = position - camera_position;
    for (int c = 0; c < 3; ++c) uniforms.position[c] = relative[c];
  };
  std::visit(Overloaded{[&](const AmbientLight&) {},
                        [&](const DirectionalLight& directional) {
                          uniforms.kind = LightUniforms::Kind::kDirectional;
                          Assign(-directional.direction_of_travel.normalized(), uniforms.to_light);
                        },
                        [&](const PointLight& point) {
                          uniforms.kind = LightUniforms::Kind::kPoint;
                          place(point.position);
                          uniforms.attenuation = ToTerms(point.attenuation);
                        },
                        [&](const SpotLight& spot) {
                          uniforms.kind = LightUniforms::Kind::kSpot;
                          place(spot.position);
                          Assign(spot.direction_of_travel.normalized(), uniforms.axis);
                          uniforms.attenuation = ToTerms(spot.attenuation);
                          uniforms.cone = ToTerms(spot);
                        }},
             light.kind);
  return uniforms;
}

LambertUniforms MakeUniforms(const LambertMaterial& material, const Rgb& light) {
  LambertUniforms uniforms;
  Assign(material.albedo * light * M_1_PI, uniforms.diffuse);
  return uniforms;
}

PhongUniforms MakeUniforms(const PhongMaterial& material, const Rgb& light) {
  double diffuse_scale = 1;
  double specular_scale = 1;
  if (material.convention == PhongConvention::kRadiometric) {
    diffuse_scale = M_1_PI;
    specular_scale = material.model == PhongModel::kBlinnPhong
                         ? BlinnNormalization(material.shininess)
                         : PhongNormalization(material.shininess);
  }
  PhongUniforms uniforms;
  uniforms.model = material.model;
  Assign(material.kd * material.color * light * diffuse_scale, uniforms.diffuse);
  Assign(material.ks * light * specular_scale, uniforms.specular);
  uniforms.shininess = static_cast<float>(material.shininess);
  return uniforms;
}

MetallicRoughnessUniforms MakeUniforms(const MetallicRoughnessMaterial& material,
                                       const Rgb& light) {
  const double alpha = AlphaFromRoughness(material.roughness);
  const bool delta = IsDeltaLobe(alpha);
  const double k = (material.roughness + 1) * (material.roughness + 1) / 8;
  MetallicRoughnessUniforms uniforms;
  uniforms.shadowing = material.shadowing;
  Assign(material.base_color * light * ((1 - material.metallic) * M_1_PI), uniforms.diffuse);
  Assign(delta ? Rgb(0, 0, 0) : light, uniforms.specular);
  Assign(Rgb(kDielectricF0) * (1 - material.metallic) + material.base_color * material.metallic,
         uniforms.f0);
  uniforms.alpha = delta ? 1.0f : static_cast<float>(alpha);
  uniforms.schlick_k = static_cast<float>(k);
  return uniforms;
}

}  // namespace

Rgb LightColor(const Light& light) {
  return std::visit(
      Overloaded{[](const AmbientLight& ambient) { return ambient.radiance; },
                 [](const DirectionalLight& directional) { return directional.irradiance; },
                 [](const auto& positional) { return positional.intensity; }},
      light.kind);
}

void EvaluateLight(const Light& light, const Vec3d& camera_position, const HitBatch& hits,
                   const Surface& surface, LightBatch* result) {
  EvaluateLightKernel(MakeUniforms(light, camera_position), hits, surface, result);
}

void ShadeRun(const Material& material, const Rgb& light_color, const Surface& surface,
              const LightBatch& light, size_t begin, size_t end, ReflectedRadiance* radiance) {
  const ShadeRange range{surface, light, begin, end, radiance};
  std::visit(
      Overloaded{
          [&](const LambertMaterial& lambert) {
            ShadeLambert(MakeUniforms(lambert, light_color), range);
          },
          [&](const PhongMaterial& phong) { ShadePhong(MakeUniforms(phong, light_color), range); },
          [&](const MetallicRoughnessMaterial& metallic_roughness) {
            ShadeMetallicRoughness(MakeUniforms(metallic_roughness, light_color), range);
          },
          [](const SplitMaterial&) {}},
      material.model);
}

void ClearSoa(size_t count, Soa3<float>* soa) {
  std::fill_n(soa->x.data(), count, 0.0f);
  std::fill_n(soa->y.data(), count, 0.0f);
  std::fill_n(soa->z.data(), count, 0.0f);
}

void ClearRadiance(size_t count, ReflectedRadiance* radiance) {
  ClearSoa(count, &radiance->diffuse);
  ClearSoa(count, &radiance->specular);
}

MaterialConstants ComputeMaterialConstants(const Material& material, const Rgb& ambient_radiance) {
  MaterialConstants constants;
  constants.emission = material.emission;
  std::visit(Overloaded{[&](const LambertMaterial& lambert) {
                          constants.albedo = lambert.albedo;
                          constants.ambient = lambert.albedo * ambient_radiance;
                        },
                        [&](const PhongMaterial& phong) {
                          constants.albedo = phong.color * phong.kd;
                          constants.ambient = phong.color * phong.ka * ambient_radiance;
                        },
                        [&](const MetallicRoughnessMaterial& metallic_roughness) {
                          // Light from everywhere: base_color is what both the diffuse base and
                          // a metal reflect of it, the 4 % of a dielectric's gloss aside.
                          constants.albedo = metallic_roughness.base_color;
                          constants.ambient = metallic_roughness.base_color * ambient_radiance;
                        },
                        [](const SplitMaterial&) {}},
             material.model);
  return constants;
}

}  // namespace nacre
