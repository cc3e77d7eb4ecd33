// SPDX-License-Identifier: Apache-2.0
#include "shading/share.h"

#include <algorithm>
#include <cmath>

#include "base/overloaded.h"
#include "brdf/albedo_integral.h"
#include "brdf/multi_scatter.h"
#include "brdf/phong.h"
#include "brdf/quadrature.h"
#include "sampling/sobol.h"
#include "shading/layer.h"
#include "shading/scalar_bsdf.h"

namespace nacre {
namespace {

// int f(direction) d(direction) over the hemisphere, for an f that is symmetric about the x-z plane
// and may have a narrow lobe about `peak`, which lies in that plane (x >= 0). The integral is over
// polar angles about the peak, first up to the circle that touches the horizon, then beyond it;
// panels halve towards the beginning of both intervals. The part of each circle above the horizon
// is summed.
template <class Function>
double IntegrateAround(const Vec3d& peak, const Function& f) {
  const Vec3d across(0, 1, 0);
  const Vec3d along = across % peak;  // downwards
  const QuadratureRule& rule = GaussLegendre(32);
  const auto circle = [&](double angle) {
    const double height = std::cos(angle) * peak.z;
    const double swing = std::sin(angle) * peak.x;  // height of its centre over its lowest point
    if (height <= -swing) return 0.0;
    const double begin = height < swing ? std::acos(height / swing) : 0;
    double sum = 0;
    for (size_t i = 0; i < rule.x.size(); ++i) {
      const double phi = begin + (M_PI - begin) * rule.x[i];
      sum += rule.w[i] * f(peak * std::cos(angle) +
                           (along * std::cos(phi) + across * std::sin(phi)) * std::sin(angle));
    }
    return 2 * (M_PI - begin) * sum * std::sin(angle);
  };
  const double touch = std::atan2(peak.z, peak.x);  // from the peak down to the horizon
  const double rest = M_PI - 2 * touch;
  return touch * IntegrateTowardsZero([&](double t) { return circle(touch * t); }, 20) +
         rest * IntegrateTowardsZero([&](double t) { return circle(touch + rest * t); }, 20);
}

Vec3d InPlane(double cosine, double sign) {
  return {sign * std::sqrt((1 - cosine) * (1 + cosine)), 0, cosine};
}

// int part(reflection) over all directions of light to the view direction for kFurnace, or of view
// from the light's direction, weighted as ReflectedShare is. part(reflection, cosine) is a number;
// `cosine` is that of the direction that varies.
template <class Part>
double IntegrateReflected(const ShadingMaterial& material, ShareOf what, double cosine,
                          const Part& part) {
  const Vec3d normal(0, 0, 1), fixed = InPlane(cosine, -1);
  return IntegrateAround(InPlane(cosine, 1), [&](const Vec3d& other) {
    return what == ShareOf::kFurnace
               ? part(Reflect(material, normal, other, fixed), other.z)
               : part(Reflect(material, normal, fixed, other), other.z) * other.z / fixed.z;
  });
}

// ReflectedShare of channel c of the diffuse component, which has no narrow lobe.
double DiffuseShare(const ShadingMaterial& material, ShareOf what, double cosine, int c) {
  return IntegrateReflected(material, what, cosine,
                            [&](const Reflection& r, double) { return r.diffuse[c]; });
}

Rgb ShareOfModel(const MatteModel& model, ShareOf what, double cosine) {
  if (model.form == DiffuseForm::kLambert) return model.diffuse * M_PI;
  ShadingMaterial material;
  material.model = model;
  Rgb share;
  for (int c = 0; c < 3; ++c) share[c] = DiffuseShare(material, what, cosine, c);
  return share;
}

Rgb ShareOfModel(const PhongFamilyModel& model, ShareOf what, double cosine) {
  const Vec3d normal(0, 0, 1);
  const Vec3d fixed = InPlane(cosine, -1);
  const bool blinn = model.model == PhongModel::kBlinnPhong;
  // The lobe's f n.l without ks; for kOneLight, f n.v instead.
  const auto lobe = [&](const Vec3d& other) {
    const double value = blinn ? BlinnLobe(ComputeAngles(normal, fixed, other), model.shininess)
                               : PhongLobe(normal, fixed, other, model.shininess);
    const Vec3d& to_light = what == ShareOf::kFurnace ? other : fixed;
    const Vec3d& to_view = what == ShareOf::kFurnace ? fixed : other;
    const double f_n_dot_l = model.model == PhongModel::kModifiedPhong ? value * to_light.z : value;
    return what == ShareOf::kFurnace ? f_n_dot_l : f_n_dot_l * to_view.z / to_light.z;
  };
  const double specular = IntegrateAround(InPlane(cosine, 1), lobe);
  return model.diffuse * M_PI + model.specular * specular;
}

// ReflectedShare of channel c of the lobe, including compensation.
double LobeShare(const MicrofacetModel& model, ShareOf what, double cosine, int c) {
  const double roughness = std::sqrt(model.alpha);
  const AlbedoFit& fit = model.albedo.lobe;
  const bool turquin = model.compensation == Compensation::kTurquin;
  // Fresnel's term with Turquin's compensation for this n.v.
  const auto curve_from = [&](double n_dot_v) {
    const double loss = turquin ? AlbedoLoss(fit, n_dot_v) : 0;
    return [&model, c, more = loss / (1 - loss)](double vh, double one_minus_vh) {
      return FresnelOf(model, vh, one_minus_vh)[c] + more * TurquinTerm(model, vh, one_minus_vh)[c];
    };
  };
  double share = 0;
  if (what == ShareOf::kFurnace || !turquin || model.delta) {
    share = AlbedoOf(model.shadowing, roughness, cosine, curve_from(cosine));
  } else {
    const AlbedoQuadrature rule;
    for (const AlbedoNode& node : MakeAlbedoNodes(model.alpha, cosine, rule.points)) {
      share += node.weight * VisibilityOf(model, node.n_dot_l, cosine) *
               AzimuthIntegral(node, model.alpha, rule, curve_from(node.n_dot_l));
    }
  }
  if (model.compensation == Compensation::kKullaConty) {
    share += model.f_multiple[c] * AlbedoLoss(fit, cosine);
  }
  return share;
}

// 2 int (1 - albedo) mu dmu: the mean fraction that the lobe leaves for the base.
double MeanBaseShare(const MicrofacetModel& model, int c) {
  return IntegrateTowardsZero([&](double mu) { return 2 * mu * (1 - CoverAlbedo(model, mu, c)); },
                              20);
}

// int (1 - F(v.h)) cos / pi over the hemisphere.
double CoupledShare(const MicrofacetModel& model, double cosine, int c) {
  const Vec3d fixed = InPlane(cosine, -1);
  return IntegrateAround(InPlane(cosine, 1), [&](const Vec3d& other) {
    const Angles<double> a = ComputeAngles(Vec3d(0, 0, 1), other, fixed);
    return (1 - FresnelOf(model, VDotH(a), OneMinusVDotH(a))[c]) * other.z / M_PI;
  });
}

double BaseShareOf(const MicrofacetModel& model, ShareOf what, double cosine, int c) {
  switch (model.coupling) {
    case DiffuseCoupling::kAlbedoScaled: {
      const double here = 1 - CoverAlbedo(model, cosine, c);
      if (model.reciprocal) return here * MeanBaseShare(model, c);
      return what == ShareOf::kFurnace ? here : MeanBaseShare(model, c);
    }
    case DiffuseCoupling::kOneMinusFresnel:
      return CoupledShare(model, cosine, c);
    case DiffuseCoupling::kNone:
      break;
  }
  return 1;
}

Rgb ShareOfModel(const MicrofacetModel& model, ShareOf what, double cosine) {
  Rgb share;
  for (int c = 0; c < 3; ++c) {
    const auto same = [&](const Rgb& value) { return c > 0 && value[c] == value[c - 1]; };
    if (same(model.dielectric_f0) && same(model.metal_f0) && same(model.diffuse) &&
        same(model.eta) && same(model.k) && same(model.f82_slope) && same(model.base_ratio) &&
        same(model.dielectric_scale) && same(model.cover) && !model.film) {
      share[c] = share[c - 1];
      continue;
    }
    share[c] = LobeShare(model, what, cosine, c);
    if (model.diffuse[c] > 0 && model.base_form != DiffuseForm::kLambert) {
      ShadingMaterial material;
      material.model = model;
      share[c] += DiffuseShare(material, what, cosine, c);
    } else if (model.diffuse[c] > 0) {
      share[c] += M_PI * model.diffuse[c] * BaseShareOf(model, what, cosine, c);
    }
  }
  return share;
}

// A model of which only the values are known: it is treated as isotropic, but evaluated and
// averaged in both halves of the hemisphere.
template <class Model>
Rgb ShareOfValues(const Model& model, ShareOf what, double cosine) {
  ShadingMaterial material;
  material.model = model;
  const Vec3d normal(0, 0, 1), fixed = InPlane(cosine, -1);
  const auto reflected = [&](const Vec3d& other) {
    return what == ShareOf::kFurnace
               ? Reflect(material, normal, other, fixed).Sum()
               : Reflect(material, normal, fixed, other).Sum() * (other.z / fixed.z);
  };
  Rgb share;
  for (int c = 0; c < 3; ++c) {
    share[c] = IntegrateAround(InPlane(cosine, 1), [&](const Vec3d& other) {
      return (reflected(other)[c] + reflected({other.x, -other.y, other.z})[c]) / 2;
    });
  }
  return share;
}

Rgb ShareOfModel(const UserModel& model, ShareOf what, double cosine) {
  return ShareOfValues(model, what, cosine);
}
Rgb ShareOfModel(const MeasuredModel& model, ShareOf what, double cosine) {
  return ShareOfValues(model, what, cosine);
}

// ReflectedShare of a material whose layers over the coats, or all of whose layers, `below` lacks,
// whose own is `share`. The integral is computed again, because the layers scale each pair of
// directions differently.
Rgb ShareWithLayers(const ShadingMaterial& whole, const ShadingMaterial& below, const Rgb& share,
                    ShareOf what, double cosine) {
  const auto integrate = [&](int c, const ShadingMaterial& of) {
    return IntegrateReflected(of, what, cosine,
                              [&](const Reflection& r, double) { return r.Sum()[c]; });
  };
  double left = 1;  // the factor for a mirror below the layers
  for (const LayerModel& layer : whole.layers) {
    if (LiesOverCoats(layer) || below.layers.empty()) left *= LayerAlbedo(layer, cosine).below;
  }
  Rgb all;
  for (int c = 0; c < 3; ++c) {
    all[c] = integrate(c, whole);
    if (HasMirror(below)) all[c] += (share[c] - integrate(c, below)) * left;
  }
  return all;
}

// The light that the material below its topmost coat reflects, whose share is `share`, and that the
// coat transmits: a factor that differs with the direction over which is integrated, that of the
// viewer for kOneLight and else that of light.
Rgb ShareThroughCoat(const ShadingMaterial& material, ShareOf what, const Rgb& share,
                     double cosine) {
  ShadingMaterial below = material;
  below.coats.pop_back();
  const ShadingMaterial& coat = *material.coats.back();
  const auto integrate = [&](int c, const auto& seen) {
    return IntegrateReflected(below, what, cosine,
                              [&](const Reflection& r, double mu) { return seen(r, mu)[c]; });
  };
  const auto left = [&](double mu) {
    return what == ShareOf::kOneLight ? TransmittedByCoat(coat, mu, cosine)
                                      : TransmittedByCoat(coat, cosine, mu);
  };
  Rgb through;
  for (int c = 0; c < 3; ++c) {
    through[c] = integrate(c, [&](const Reflection& r, double mu) { return r.Sum() * left(mu); });
    if (!HasMirror(below)) continue;
    const double seen = integrate(c, [](const Reflection& r, double) { return r.Sum(); });
    through[c] += (share[c] - seen) * left(cosine)[c];
  }
  return through;
}

// Of a glossy lobe the quadrature would have to know the peak.
bool HasGlossyLayer(const ShadingMaterial& material) {
  return std::any_of(material.layers.begin(), material.layers.end(),
                     [](const LayerModel& layer) { return KindOf(layer) == LobeKind::kGlossy; });
}

// ReflectedShare in a direction in space, as the mean weight of samples. Lobes that are no
// function of the angle from a peak are integrated along the material's own samples, which are as
// narrow as they are.
Rgb SampledShare(const ShadingMaterial& material, ShareOf what, const Vec3d& fixed) {
  constexpr uint32_t kSamples = 1u << 14;
  const Vec3d normal(0, 0, 1);
  Rgb sum(0, 0, 0);
  for (uint32_t i = 0; i < kSamples; ++i) {
    const Vec2d u = SobolSample2D(i, 0, 1);
    const ReflectionSample sample = SampleReflection(material, normal, fixed, u.x, u.y);
    if (what == ShareOf::kFurnace || sample.kind == LobeKind::kDelta) {
      // A mirror reflects as much from the one direction as from the other.
      sum += sample.weight;
    } else if (sample.pdf > 0 && sample.to_light.z > 0) {
      const double cosines = sample.to_light.z / fixed.z;
      sum += Reflect(material, normal, fixed, sample.to_light).Sum() * (cosines / sample.pdf);
    }
  }
  return sum / static_cast<double>(kSamples);
}

}  // namespace

Rgb ReflectedShare(const ShadingMaterial& material, ShareOf what, double cosine, double azimuth) {
  if (HasAnisotropicLobe(material) || HasGlossyLayer(material)) {
    const double sine = std::sqrt((1 - cosine) * (1 + cosine));
    return SampledShare(material, what,
                        {sine * std::cos(azimuth), sine * std::sin(azimuth), cosine});
  }
  const bool over_coats = !material.layers.empty() && LiesOverCoats(material.layers.back());
  if (over_coats && !material.coats.empty()) {
    ShadingMaterial below = material;
    std::erase_if(below.layers, LiesOverCoats);
    return ShareWithLayers(material, below, ReflectedShare(below, what, cosine), what, cosine);
  }
  if (material.coats.empty()) {
    const Rgb share =
        std::visit(Overloaded{[](const std::monostate&) { return Rgb(0); },
                              [&](const auto& model) { return ShareOfModel(model, what, cosine); }},
                   material.model);
    if (material.layers.empty()) return share;
    ShadingMaterial below = material;
    below.layers.clear();
    return ShareWithLayers(material, below, share, what, cosine);
  }
  ShadingMaterial below = material;
  below.coats.pop_back();
  const ShadingMaterial& coat = *material.coats.back();
  const Rgb share = ReflectedShare(below, what, cosine);
  const Rgb of_coat = ReflectedShare(coat, what, cosine);
  if (what == ShareOf::kFurnace && !AbsorbsAlongLight(coat.transmission)) {
    return share * TransmittedByCoat(coat, cosine, cosine) + of_coat;
  }
  return ShareThroughCoat(material, what, share, cosine) + of_coat;
}

double PhongLobeIntegral(double shininess, double cosine) {
  const Vec3d fixed = InPlane(cosine, -1);
  return IntegrateAround(InPlane(cosine, 1), [&](const Vec3d& other) {
    return PhongLobe(Vec3d(0, 0, 1), fixed, other, shininess) * other.z;
  });
}

}  // namespace nacre
