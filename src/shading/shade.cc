#include "shading/shade.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <variant>

#include "base/overloaded.h"
#include "shading/kernels.h"

namespace nacre {
namespace {

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
                          const Vec3d to_light = -directional.direction_of_travel.normalized();
                          for (int c = 0; c < 3; ++c) uniforms.to_light[c] = to_light[c];
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

LambertUniforms MakeUniforms(const LambertModel& model, const Rgb& light) {
  LambertUniforms uniforms;
  Assign(model.diffuse * light, uniforms.diffuse);
  return uniforms;
}

PhongUniforms MakeUniforms(const PhongFamilyModel& model, const Rgb& light) {
  PhongUniforms uniforms;
  uniforms.model = model.model;
  Assign(model.diffuse * light, uniforms.diffuse);
  Assign(model.specular * light, uniforms.specular);
  uniforms.shininess = static_cast<float>(model.shininess);
  uniforms.narrow = nullptr;
  return uniforms;
}

MicrofacetUniforms MakeUniforms(const MicrofacetModel& model, const Rgb& light) {
  MicrofacetUniforms uniforms;
  uniforms.model = &model;
  Assign(model.diffuse * light, uniforms.diffuse);
  Assign(model.delta ? Rgb(0, 0, 0) : light, uniforms.specular);
  Assign(model.f_multiple * light, uniforms.multiple);
  uniforms.narrow = nullptr;
  return uniforms;
}

void ShadeByCurve(const MicrofacetUniforms& uniforms, const ShadeRange& range) {
  switch (uniforms.model->fresnel) {
    case FresnelForm::kSchlick:
      return ShadeSchlick(uniforms, range);
    case FresnelForm::kF82:
      return ShadeF82(uniforms, range);
    case FresnelForm::kDielectric:
      return ShadeDielectric(uniforms, range);
    case FresnelForm::kConductor:
      return ShadeConductor(uniforms, range);
  }
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
  const bool infinitely_far = std::holds_alternative<DirectionalLight>(light.kind);
  result->t_max = infinitely_far ? std::numeric_limits<double>::infinity() : 1.0;
  EvaluateLightKernel(MakeUniforms(light, camera_position), hits, surface, result);
}

void PrepareRun(const ShadingMaterial& material, size_t begin, size_t end, Surface* surface) {
  if (const auto* microfacet = std::get_if<MicrofacetModel>(&material.model)) {
    PrepareMicrofacet(*microfacet, begin, end, surface);
  }
}

void ShadeRun(const ShadingMaterial& material, const Rgb& light_color, const LitHits& lit,
              size_t begin, size_t end, NarrowLobes* scratch, ReflectedRadiance* radiance) {
  const ShadeRange range{lit.surface, lit.light, begin, end, radiance};
  std::visit(Overloaded{[](std::monostate) {},
                        [&](const LambertModel& lambert) {
                          ShadeLambert(MakeUniforms(lambert, light_color), range);
                        },
                        [&](const PhongFamilyModel& phong) {
                          PhongUniforms uniforms = MakeUniforms(phong, light_color);
                          if (phong.double_terms) {
                            NarrowPhong(phong.model, lit, begin, end, scratch);
                            uniforms.narrow = scratch;
                          }
                          ShadePhong(uniforms, range);
                        },
                        [&](const MicrofacetModel& microfacet) {
                          MicrofacetUniforms uniforms = MakeUniforms(microfacet, light_color);
                          if (microfacet.double_terms) {
                            NarrowGgx(microfacet.alpha, lit, begin, end, scratch);
                            uniforms.narrow = scratch->first.data();
                          }
                          ShadeByCurve(uniforms, range);
                        }},
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

}  // namespace nacre
