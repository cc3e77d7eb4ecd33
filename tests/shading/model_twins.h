// SPDX-License-Identifier: Apache-2.0
// tests/shading/model_twins.h: lights and reflection models evaluated in double, one hit at a time,
// from the scalar twins: what the shading kernels are held against.
#pragma once

#include <cmath>
#include <variant>

#include "brdf/burley.h"
#include "brdf/eon.h"
#include "brdf/fresnel.h"
#include "brdf/ggx.h"
#include "brdf/multi_scatter.h"
#include "brdf/phong.h"
#include "light/punctual.h"
#include "scene/light.h"
#include "scene/material.h"
#include "shading/material.h"

namespace nacre {

// Of every light here.
inline const Rgb kLightColor(60, 50, 40);

// Direction to the light, and irradiance perpendicular to it per unit of its colour.
struct Incident {
  Vec3d to_light;
  double irradiance;
};

inline Incident Illuminate(const Light& light, const Vec3d& position) {
  if (const auto* sun = std::get_if<DirectionalLight>(&light.kind)) {
    return {-sun->direction_of_travel.normalized(), 1};
  }
  const auto from = [&](const Vec3d& where, const Attenuation& a) -> Incident {
    const Vec3d offset = where - position;
    const AttenuationTerms<double> terms{a.constant, a.linear, a.quadratic};
    return {offset.normalized(), AttenuationFactor(terms, offset.length())};
  };
  if (const auto* point = std::get_if<PointLight>(&light.kind)) {
    return from(point->position, point->attenuation);
  }
  const auto& spot = std::get<SpotLight>(light.kind);
  Incident incident = from(spot.position, spot.attenuation);
  incident.irradiance *= SpotFactor<double>(
      {OneMinusCosine(spot.cutoff_deg), OneMinusCosine(spot.inner_deg), spot.exponent},
      OneMinusCosine(-incident.to_light, spot.direction_of_travel.normalized()));
  return incident;
}

// Radiance towards the viewer.
struct Reflected {
  Rgb diffuse{0, 0, 0}, specular{0, 0, 0};
};

inline Reflected Reflect(const LambertMaterial& m, const Vec3d& n, const Vec3d&,
                         const Incident& in) {
  return {m.albedo * kLightColor * (M_1_PI * (n ^ in.to_light) * in.irradiance), Rgb(0, 0, 0)};
}

inline Reflected Reflect(const OrenNayarMaterial& m, const Vec3d& n, const Vec3d& v,
                         const Incident& in) {
  const Angles<double> a = ComputeAngles(n, in.to_light, v);
  Reflected out;
  for (int c = 0; c < 3; ++c) {
    out.diffuse[c] = Eon(a, m.albedo[c], m.roughness) * kLightColor[c] * a.n_dot_l * in.irradiance;
  }
  return out;
}

inline Reflected Reflect(const BurleyMaterial& m, const Vec3d& n, const Vec3d& v,
                         const Incident& in) {
  const Angles<double> a = ComputeAngles(n, in.to_light, v);
  return {m.albedo * kLightColor * (BurleyDiffuse(a, m.roughness) * a.n_dot_l * in.irradiance),
          Rgb(0, 0, 0)};
}

inline Reflected Reflect(const PhongMaterial& m, const Vec3d& n, const Vec3d& v,
                         const Incident& in) {
  const bool blinn = m.model == PhongModel::kBlinnPhong;
  const double lobe = blinn ? BlinnLobe(ComputeAngles(n, in.to_light, v), m.shininess)
                            : PhongLobe(n, in.to_light, v, m.shininess);
  const double cosine = n ^ in.to_light;
  const bool radiometric = m.convention == PhongConvention::kRadiometric;
  const double kd = radiometric ? M_1_PI : 1;
  const double ks = !radiometric ? 1
                    : blinn      ? BlinnNormalization(m.shininess)
                                 : PhongNormalization(m.shininess);
  const double weight = m.model == PhongModel::kModifiedPhong ? cosine : 1;
  return {m.kd * m.color * kLightColor * (kd * cosine * in.irradiance),
          m.ks * kLightColor * (ks * lobe * weight * in.irradiance)};
}

// Fresnel's terms of the dielectric and of the metal that a material mixes, unweighted.
struct FresnelTerms {
  Rgb dielectric{0, 0, 0}, metal{0, 0, 0};
};

inline FresnelTerms Fresnel(const MicrofacetModel& m, const Angles<double>& a) {
  FresnelTerms terms;
  for (int c = 0; c < 3; ++c) {
    switch (m.fresnel) {
      case FresnelForm::kSchlick:
        terms.dielectric[c] =
            FresnelSchlick(m.dielectric_f0[c], m.dielectric_f90, SchlickWeight(a));
        terms.metal[c] = FresnelSchlick(m.metal_f0[c], SchlickWeight(a));
        break;
      case FresnelForm::kF82:
        terms.dielectric[c] =
            FresnelSchlick(m.dielectric_f0[c], m.dielectric_f90, SchlickWeight(a));
        terms.metal[c] = FresnelF82(VDotH(a), OneMinusVDotH(a), m.metal_f0[c], m.f82_slope[c]);
        break;
      case FresnelForm::kDielectric:
        terms.dielectric[c] = FresnelDielectric(VDotH(a), OneMinusVDotH(a), m.eta[c]);
        break;
      case FresnelForm::kConductor:
        terms.metal[c] = FresnelConductor(VDotH(a), OneMinusVDotH(a), m.eta[c], m.k[c]);
        break;
      case FresnelForm::kThinFilm: {
        const auto at = static_cast<size_t>(c);
        terms.dielectric[c] =
            m.dielectric_scale[c] * (1 - FresnelTableLoss(m.film->dielectric, VDotH(a))[at]);
        terms.metal[c] = m.metal_scale * (1 - FresnelTableLoss(m.film->metal, VDotH(a))[at]);
        break;
      }
      case FresnelForm::kOpenPbr:
        terms.dielectric[c] = m.dielectric_scale[c] *
                              FresnelCoatedDielectric(VDotH(a), OneMinusVDotH(a), m.dielectric);
        terms.metal[c] =
            m.metal_scale * FresnelF82(VDotH(a), OneMinusVDotH(a), m.metal_f0[c], m.f82_slope[c]);
        break;
    }
  }
  return terms;
}

inline double Visibility(const MicrofacetModel& m, const Angles<double>& a) {
  switch (m.shadowing) {
    case Shadowing::kHeightCorrelated:
      return VisibilityHeightCorrelated(a.n_dot_l, a.n_dot_v, m.alpha);
    case Shadowing::kSeparable:
      return VisibilitySeparable(a.n_dot_l, a.n_dot_v, m.alpha);
    case Shadowing::kSchlickDirect:
    case Shadowing::kSchlickIbl:
      break;
  }
  return VisibilitySchlick(a.n_dot_l, a.n_dot_v, SchlickK(m.shadowing, std::sqrt(m.alpha)));
}

// What reaches the base and leaves it again, of channel c.
inline double BaseShare(const MicrofacetModel& m, const Angles<double>& a, double fresnel, int c) {
  switch (m.coupling) {
    case DiffuseCoupling::kAlbedoScaled: {
      const double out = 1 - CoverAlbedo(m, a.n_dot_v, c);
      const bool reciprocal = m.compensation == Compensation::kKullaConty;
      return reciprocal ? out * (1 - CoverAlbedo(m, a.n_dot_l, c)) : out;
    }
    case DiffuseCoupling::kOneMinusFresnel:
      return 1 - fresnel;
    case DiffuseCoupling::kNone:
      break;
  }
  return 1;
}

// What a base reflects over what Lambert's does.
inline double BaseSpreadOf(const MicrofacetModel& m, const Angles<double>& a, int c) {
  switch (m.base_form) {
    case DiffuseForm::kOrenNayar: {
      const double l_dot_v = 1 - a.lv_squared / 2, r = m.base_roughness;
      return M_PI * (EonSingle(a.n_dot_l, a.n_dot_v, l_dot_v, r) +
                     m.base_ratio[c] * EonMultiple(a.n_dot_l, a.n_dot_v, r));
    }
    case DiffuseForm::kBurley:
      return M_PI * BurleyDiffuse(a, m.base_roughness);
    case DiffuseForm::kLambert:
      break;
  }
  return 1;
}

inline Reflected Reflect(const MicrofacetModel& m, const Vec3d& n, const Vec3d& v,
                         const Incident& in) {
  const Angles<double> a = ComputeAngles(n, in.to_light, v);
  const double weight = a.n_dot_l * in.irradiance;
  const FresnelTerms fresnel = Fresnel(m, a);
  const double lobe = GgxDistribution(a, m.alpha) * Visibility(m, a);
  const double loss_v = AlbedoLoss(m.albedo.lobe, a.n_dot_v);
  const double loss_l = AlbedoLoss(m.albedo.lobe, a.n_dot_l);
  Reflected out;
  for (int c = 0; c < 3; ++c) {
    double dielectric = fresnel.dielectric[c] * lobe, metal = fresnel.metal[c] * lobe;
    if (m.compensation == Compensation::kTurquin) {
      // Turquin 2019, eq. 16.
      const double more = 1 / (1 - loss_v) - 1;
      dielectric *= 1 + m.dielectric_f0[c] * more;
      metal *= 1 + m.metal_f0[c] * more;
    }
    const auto mix = [&](double of_dielectric, double of_metal) {
      return (1 - m.metallic) * of_dielectric + m.metallic * of_metal;
    };
    double specular = mix(dielectric, metal);
    if (m.compensation == Compensation::kKullaConty) {
      specular += m.f_multiple[c] * m.multiple * loss_v * loss_l;
    }
    out.specular[c] = specular * kLightColor[c] * weight;
    const double base =
        BaseShare(m, a, mix(fresnel.dielectric[c], fresnel.metal[c]), c) * BaseSpreadOf(m, a, c);
    out.diffuse[c] = base * m.diffuse[c] * kLightColor[c] * weight;
  }
  return out;
}

}  // namespace nacre
