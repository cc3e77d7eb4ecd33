#include "study/reflection.h"

#include <cmath>
#include <memory>

#include "base/overloaded.h"
#include "brdf/fresnel.h"
#include "brdf/ggx.h"
#include "brdf/multi_scatter.h"
#include "brdf/phong.h"
#include "shading/shade.h"

namespace nacre {
namespace {

Reflection ReflectModel(const LambertModel& model, const Vec3d& n, const Vec3d& l, const Vec3d&) {
  return {model.diffuse * (n ^ l), Rgb(0)};
}

Reflection ReflectModel(const PhongFamilyModel& model, const Vec3d& n, const Vec3d& l,
                        const Vec3d& v) {
  const double n_dot_l = n ^ l;
  const double lobe = model.model == PhongModel::kBlinnPhong
                          ? BlinnLobe(ComputeAngles(n, l, v), model.shininess)
                          : PhongLobe(n, l, v, model.shininess);
  const double weight = model.model == PhongModel::kModifiedPhong ? n_dot_l : 1;
  return {model.diffuse * n_dot_l, model.specular * (lobe * weight)};
}

// What reaches the base and leaves it again, of channel c.
double BaseShare(const MicrofacetModel& model, const Angles<double>& a, double fresnel, int c) {
  switch (model.coupling) {
    case DiffuseCoupling::kAlbedoScaled: {
      const double out = 1 - LobeAlbedo(model, a.n_dot_v, c);
      const bool reciprocal = model.compensation == Compensation::kKullaConty;
      return reciprocal ? out * (1 - LobeAlbedo(model, a.n_dot_l, c)) : out;
    }
    case DiffuseCoupling::kOneMinusFresnel:
      return 1 - fresnel;
    case DiffuseCoupling::kNone:
      break;
  }
  return 1;
}

Reflection ReflectModel(const MicrofacetModel& model, const Vec3d& n, const Vec3d& l,
                        const Vec3d& v) {
  const Angles<double> a = ComputeAngles(n, l, v);
  const Rgb fresnel = FresnelOf(model, VDotH(a), OneMinusVDotH(a));
  const double lobe = GgxDistribution(a, model.alpha) * VisibilityOf(model, a.n_dot_l, a.n_dot_v);
  const double loss_v = AlbedoLoss(model.albedo.lobe, a.n_dot_v);
  const double loss_l = AlbedoLoss(model.albedo.lobe, a.n_dot_l);
  Reflection out;
  for (int c = 0; c < 3; ++c) {
    double specular = fresnel[c] * lobe;
    if (model.compensation == Compensation::kTurquin) {
      specular *= TurquinFactor(model.f0[c], 1 - loss_v);
    } else if (model.compensation == Compensation::kKullaConty) {
      specular += model.f_multiple[c] * model.multiple * loss_v * loss_l;
    }
    out.specular[c] = specular * a.n_dot_l;
    out.diffuse[c] = BaseShare(model, a, fresnel[c], c) * model.diffuse[c] * a.n_dot_l;
  }
  return out;
}

}  // namespace

Reflection Reflect(const ShadingMaterial& material, const Vec3d& normal, const Vec3d& to_light,
                   const Vec3d& to_view) {
  if (!((normal ^ to_light) > 0) || !((normal ^ to_view) > 0)) return {};
  return std::visit(
      Overloaded{[](const std::monostate&) { return Reflection{}; },
                 [&](const auto& model) { return ReflectModel(model, normal, to_light, to_view); }},
      material.model);
}

Reflection ReflectByKernel(const ShadingMaterial& material, const Vec3d& normal,
                           const Vec3d& to_light, const Vec3d& to_view) {
  // Batches are a hundred kilobytes each: not for the stack.
  struct Batches {
    HitBatch hits;
    Surface surface;
    NarrowLobes scratch;
    ReflectedRadiance radiance;
  };
  const auto batches = std::make_unique<Batches>();
  HitBatch& hits = batches->hits;
  hits.count = 1;
  const auto put = [](Soa3<double>* soa, const Vec3d& value) {
    soa->x[0] = value.x;
    soa->y[0] = value.y;
    soa->z[0] = value.z;
  };
  put(&hits.normal, normal);
  put(&hits.to_view, to_view);
  put(&hits.position, -to_view);
  Light light;
  light.kind = DirectionalLight{.direction_of_travel = -to_light, .irradiance = Rgb(1)};
  const ShadingLight prepared = PrepareLight(light, Vec3d(0));
  const LightOnBatch on_hits{&prepared, nullptr};
  PrepareSurface(hits, &batches->surface);
  PrepareRun(material, 0, 1, &batches->surface);
  ShadeRun(material, {hits, batches->surface, {&on_hits, 1}}, 0, 1, &batches->scratch,
           &batches->radiance);
  const auto get = [](const Soa3<float>& soa) { return Rgb(soa.x[0], soa.y[0], soa.z[0]); };
  return {get(batches->radiance.diffuse), get(batches->radiance.specular)};
}

Rgb FresnelOf(const MicrofacetModel& model, double v_dot_h, double one_minus_vh) {
  Rgb fresnel;
  for (int c = 0; c < 3; ++c) {
    switch (model.fresnel) {
      case FresnelForm::kSchlick:
        fresnel[c] = FresnelSchlick(model.f0[c], Power5(one_minus_vh));
        break;
      case FresnelForm::kF82:
        fresnel[c] = FresnelF82(v_dot_h, one_minus_vh, model.f0[c], model.f82_slope[c]);
        break;
      case FresnelForm::kDielectric:
        fresnel[c] = FresnelDielectric(v_dot_h, one_minus_vh, model.eta[c]);
        break;
      case FresnelForm::kConductor:
        fresnel[c] = FresnelConductor(v_dot_h, one_minus_vh, model.eta[c], model.k[c]);
        break;
    }
  }
  return fresnel;
}

double VisibilityOf(const MicrofacetModel& model, double n_dot_l, double n_dot_v) {
  switch (model.shadowing) {
    case Shadowing::kHeightCorrelated:
      return VisibilityHeightCorrelated(n_dot_l, n_dot_v, model.alpha);
    case Shadowing::kSeparable:
      return VisibilitySeparable(n_dot_l, n_dot_v, model.alpha);
    case Shadowing::kSchlickDirect:
      break;
  }
  return VisibilitySchlickDirect(n_dot_l, n_dot_v, std::sqrt(model.alpha));
}

Vec3d DirectionAt(double degrees) {
  const double angle = degrees * M_PI / 180;
  return {std::sin(angle), 0, std::cos(angle)};
}

}  // namespace nacre
