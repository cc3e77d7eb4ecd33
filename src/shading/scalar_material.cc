#include "shading/scalar_material.h"

#include <cmath>

#include "base/overloaded.h"
#include "brdf/fresnel.h"
#include "brdf/ggx.h"
#include "brdf/phong.h"

namespace nacre {
namespace {

constexpr Vec3d kNormal(0, 0, 1);

Response Evaluate(const PhongFamilyModel& m, const Vec3d& l, const Vec3d& v) {
  const bool blinn = m.model == PhongModel::kBlinnPhong;
  const double lobe = blinn ? BlinnLobe(ComputeAngles(kNormal, l, v), m.shininess)
                            : PhongLobe(kNormal, l, v, m.shininess);
  return {m.diffuse * l.z,
          m.specular * (m.model == PhongModel::kModifiedPhong ? lobe * l.z : lobe)};
}

double FresnelOf(const MicrofacetModel& m, const Angles<double>& a, int c) {
  switch (m.fresnel) {
    case FresnelForm::kSchlick:
      return FresnelSchlick(m.f0[c], SchlickWeight(a));
    case FresnelForm::kF82:
      return FresnelF82(VDotH(a), OneMinusVDotH(a), m.f0[c], m.f82_slope[c]);
    case FresnelForm::kDielectric:
      return FresnelDielectric(VDotH(a), OneMinusVDotH(a), m.eta[c]);
    case FresnelForm::kConductor:
      return FresnelConductor(VDotH(a), OneMinusVDotH(a), m.eta[c], m.k[c]);
  }
  return 0;
}

double VisibilityOf(const MicrofacetModel& m, const Angles<double>& a) {
  switch (m.shadowing) {
    case Shadowing::kHeightCorrelated:
      return VisibilityHeightCorrelated(a.n_dot_l, a.n_dot_v, m.alpha);
    case Shadowing::kSeparable:
      return VisibilitySeparable(a.n_dot_l, a.n_dot_v, m.alpha);
    case Shadowing::kSchlickDirect:
      break;
  }
  return VisibilitySchlickDirect(a.n_dot_l, a.n_dot_v, std::sqrt(m.alpha));
}

// What reaches the base and leaves it again.
double BaseShareOf(const MicrofacetModel& m, const Angles<double>& a, double fresnel, int c) {
  switch (m.coupling) {
    case DiffuseCoupling::kAlbedoScaled: {
      const double out = 1 - LobeAlbedo(m, a.n_dot_v, c);
      const bool reciprocal = m.compensation == Compensation::kKullaConty;
      return reciprocal ? out * (1 - LobeAlbedo(m, a.n_dot_l, c)) : out;
    }
    case DiffuseCoupling::kOneMinusFresnel:
      return 1 - fresnel;
    case DiffuseCoupling::kNone:
      break;
  }
  return 1;
}

Response Evaluate(const MicrofacetModel& m, const Vec3d& l, const Vec3d& v) {
  const Angles<double> a = ComputeAngles(kNormal, l, v);
  const double lobe = GgxDistribution(a, m.alpha) * VisibilityOf(m, a);
  const double loss_v = AlbedoLoss(m.albedo.lobe, a.n_dot_v);
  const double loss_l = AlbedoLoss(m.albedo.lobe, a.n_dot_l);
  Response out;
  for (int c = 0; c < 3; ++c) {
    const double fresnel = FresnelOf(m, a, c);
    double specular = fresnel * lobe;
    if (m.compensation == Compensation::kTurquin) specular *= 1 + m.f0[c] * loss_v / (1 - loss_v);
    if (m.compensation == Compensation::kKullaConty) {
      specular += m.f_multiple[c] * m.multiple * loss_v * loss_l;
    }
    out.specular[c] = specular * l.z;
    out.diffuse[c] = BaseShareOf(m, a, fresnel, c) * m.diffuse[c] * l.z;
  }
  return out;
}

}  // namespace

Response EvaluateResponse(const ShadingMaterial& material, const Vec3d& to_light,
                          const Vec3d& to_view) {
  if (!(to_light.z > 0 && to_view.z > 0)) return {};
  return std::visit(
      Overloaded{[](const std::monostate&) { return Response{}; },
                 [&](const LambertModel& m) {
                   return Response{m.diffuse * to_light.z, Rgb(0)};
                 },
                 [&](const PhongFamilyModel& m) { return Evaluate(m, to_light, to_view); },
                 [&](const MicrofacetModel& m) { return Evaluate(m, to_light, to_view); }},
      material.model);
}

}  // namespace nacre
