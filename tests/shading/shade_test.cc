// tests/shading/shade_test.cc: the shading kernels against models evaluated in double from the
// scalar twins, on every target, and the promises that keep bits independent of neighbours.
#include "shading/shade.h"

#include <cmath>
#include <random>

#include "base/parallel.h"
#include "brdf/fresnel.h"
#include "brdf/ggx.h"
#include "brdf/phong.h"
#include "light/punctual.h"
#include "targets.h"

namespace nacre {
namespace {

constexpr size_t kHits = 1000;  // not a multiple of any vector
const Rgb kLightColor(60, 50, 40);

// Hits all around the visible side of a unit sphere at (0, 0, -6), seen from the origin.
HitBatch MakeHits() {
  HitBatch hits;
  hits.count = kHits;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (size_t i = 0; i < kHits;) {
    const Vec3d n = Vec3d(uniform(random), uniform(random), uniform(random)).normalized();
    const Vec3d position = n + Vec3d(0, 0, -6);
    const Vec3d to_view = -position.normalized();
    if ((n ^ to_view) <= 0.01) continue;
    hits.position.x[i] = position.x;
    hits.position.y[i] = position.y;
    hits.position.z[i] = position.z;
    hits.normal.x[i] = n.x;
    hits.normal.y[i] = n.y;
    hits.normal.z[i] = n.z;
    hits.to_view.x[i] = to_view.x;
    hits.to_view.y[i] = to_view.y;
    hits.to_view.z[i] = to_view.z;
    ++i;
  }
  return hits;
}

Vec3d At(const Soa3<double>& soa, size_t i) { return {soa.x[i], soa.y[i], soa.z[i]}; }
Rgb At(const Soa3<float>& soa, size_t i) { return {soa.x[i], soa.y[i], soa.z[i]}; }

Light MakeLight(const std::string& kind) {
  Light light;
  if (kind == "point") {
    light.kind = PointLight{.position = {3, 4, 2}, .intensity = kLightColor, .attenuation = {}};
  } else if (kind == "polynomial") {
    light.kind =
        PointLight{.position = {3, 4, 2}, .intensity = kLightColor, .attenuation = {1, 0.1, 0.05}};
  } else if (kind == "directional") {
    light.kind = DirectionalLight{.direction_of_travel = {-3, -4, -5}, .irradiance = kLightColor};
  } else {
    light.kind = SpotLight{.position = {3, 4, 2},
                           .direction_of_travel = {-3, -4, -8},
                           .intensity = kLightColor,
                           .attenuation = {},
                           .cutoff_deg = 20,
                           .inner_deg = 5,
                           .exponent = 3.5};
  }
  return light;
}

// Direction to the light and irradiance perpendicular to it, in double.
struct Incident {
  Vec3d to_light;
  double irradiance;
};

Incident Illuminate(const Light& light, const Vec3d& position) {
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
  const double degree = M_PI / 180;
  incident.irradiance *= SpotFactor<double>(
      {std::cos(spot.cutoff_deg * degree), std::cos(spot.inner_deg * degree), spot.exponent},
      -(incident.to_light ^ spot.direction_of_travel.normalized()));
  return incident;
}

struct Reflected {
  Rgb diffuse{0, 0, 0}, specular{0, 0, 0};
};

Reflected Reflect(const LambertMaterial& m, const Vec3d& n, const Vec3d&, const Incident& in) {
  return {m.albedo * kLightColor * (M_1_PI * (n ^ in.to_light) * in.irradiance), Rgb(0, 0, 0)};
}

Reflected Reflect(const PhongMaterial& m, const Vec3d& n, const Vec3d& v, const Incident& in) {
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

Reflected Reflect(const MetallicRoughnessMaterial& m, const Vec3d& n, const Vec3d& v,
                  const Incident& in) {
  const Angles<double> a = ComputeAngles(n, in.to_light, v);
  const double alpha = AlphaFromRoughness(m.roughness);
  const double visibility = m.shadowing == Shadowing::kHeightCorrelated
                                ? VisibilityHeightCorrelated(a.n_dot_l, a.n_dot_v, alpha)
                            : m.shadowing == Shadowing::kSeparable
                                ? VisibilitySeparable(a.n_dot_l, a.n_dot_v, alpha)
                                : VisibilitySchlickDirect(a.n_dot_l, a.n_dot_v, m.roughness);
  const double weight = a.n_dot_l * in.irradiance;
  Reflected out;
  for (int c = 0; c < 3; ++c) {
    const double f0 = 0.04 * (1 - m.metallic) + m.base_color[c] * m.metallic;
    const double fresnel = FresnelSchlick(f0, SchlickWeight(a));
    out.diffuse[c] =
        (1 - fresnel) * (1 - m.metallic) * m.base_color[c] * M_1_PI * kLightColor[c] * weight;
    out.specular[c] = fresnel * GgxDistribution(a, alpha) * visibility * kLightColor[c] * weight;
  }
  return out;
}

template <class Model>
ReflectedRadiance Shade(const Model& model, const Light& light, const HitBatch& hits) {
  Surface surface;
  LightBatch batch;
  ReflectedRadiance radiance;
  PrepareSurface(hits, &surface);
  EvaluateLight(light, {0, 0, 0}, hits, surface, &batch);
  Material material;
  material.model = model;
  ShadeRun(material, kLightColor, surface, batch, 0, hits.count, &radiance);
  return radiance;
}

// Relative error against the double model where the light is not grazing: with n.l >= 0.01 the
// rounding of directions to float (u = 6e-8) costs up to u / 0.01 in each cosine; `lobe_error` is
// what it costs the lobe. Grazing light must be small, and light from behind nothing.
template <class Model>
void CheckModel(const Model& model, const std::string& light_kind, double lobe_error) {
  CAPTURE(light_kind);
  const HitBatch hits = MakeHits();
  const Light light = MakeLight(light_kind);
  const ReflectedRadiance got = Shade(model, light, hits);
  const double cosine_error = 8 * 0x1p-24 / 0.01;
  for (size_t i = 0; i < hits.count; ++i) {
    const Vec3d n = At(hits.normal, i);
    const Incident incident = Illuminate(light, At(hits.position, i));
    const double cosine = n ^ incident.to_light;
    const Rgb diffuse = At(got.diffuse, i);
    const Rgb specular = At(got.specular, i);
    if (cosine <= -1e-6) {
      REQUIRE(diffuse == Rgb(0, 0, 0));
      REQUIRE(specular == Rgb(0, 0, 0));
    }
    // The penumbra's edge and a cone's rim have steep relative slopes, like grazing light.
    if (cosine < 0.01 || incident.irradiance < 1e-3) continue;
    const Reflected expected = Reflect(model, n, At(hits.to_view, i), incident);
    for (int c = 0; c < 3; ++c) {
      REQUIRE(std::abs(diffuse[c] - expected.diffuse[c]) <= cosine_error * expected.diffuse[c]);
      REQUIRE(std::abs(specular[c] - expected.specular[c]) <=
              (cosine_error + lobe_error) * expected.specular[c] + 1e-30);
    }
  }
}

TEST_CASE("kernels agree with the models in double on every target and under every light") {
  const FlushDenormals flush;
  ForEachTarget([](Target) {
    for (const char* light : {"point", "polynomial", "directional", "spot"}) {
      CheckModel(LambertMaterial{Rgb(0.9, 0.5, 0.1)}, light, 0);
      for (const PhongModel model :
           {PhongModel::kPhong, PhongModel::kModifiedPhong, PhongModel::kBlinnPhong}) {
        for (const PhongConvention convention :
             {PhongConvention::kClassic, PhongConvention::kRadiometric}) {
          PhongMaterial phong;
          phong.model = model;
          phong.convention = convention;
          phong.color = Rgb(0.9, 0.5, 0.1);
          phong.shininess = 40;
          // The whole hemisphere, far tails included: n tan(theta) u, tan up to the point where
          // the lobe is 1e-30, about 5.6 for n = 40.
          CheckModel(phong, light, 16 * 40 * 5.6 * 0x1p-24);
        }
      }
      for (const Shadowing shadowing :
           {Shadowing::kHeightCorrelated, Shadowing::kSeparable, Shadowing::kSchlickDirect}) {
        MetallicRoughnessMaterial ggx;
        ggx.base_color = Rgb(0.9, 0.5, 0.1);
        ggx.metallic = 0.4;
        ggx.shadowing = shadowing;
        for (const double roughness : {0.1, 0.3, 0.7, 1.0}) {
          ggx.roughness = roughness;
          CheckModel(ggx, light, 8 * 0x1p-24 / (roughness * roughness));
        }
      }
    }
  });
}

TEST_CASE("a delta lobe shows no punctual light, its base does") {
  MetallicRoughnessMaterial smooth;
  smooth.roughness = 0;
  const HitBatch hits = MakeHits();
  const ReflectedRadiance got = Shade(smooth, MakeLight("point"), hits);
  double diffuse = 0;
  for (size_t i = 0; i < hits.count; ++i) {
    REQUIRE(At(got.specular, i) == Rgb(0, 0, 0));
    diffuse += got.diffuse.x[i];
  }
  CHECK(diffuse > 0);
}

TEST_CASE("a hit's bits do not depend on its place in the batch or the run") {
  const FlushDenormals flush;
  ForEachTarget([](Target) {
    const HitBatch hits = MakeHits();
    const Light light = MakeLight("spot");
    Surface surface;
    LightBatch batch;
    PrepareSurface(hits, &surface);
    EvaluateLight(light, {0, 0, 0}, hits, surface, &batch);
    Material material;
    material.model = MetallicRoughnessMaterial{};
    ReflectedRadiance whole;
    ShadeRun(material, kLightColor, surface, batch, 0, kHits, &whole);
    ReflectedRadiance parts;
    for (size_t begin = 0; begin < kHits;) {
      const size_t end = std::min(kHits, begin + 1 + begin % 13);
      ShadeRun(material, kLightColor, surface, batch, begin, end, &parts);
      begin = end;
    }
    for (size_t i = 0; i < kHits; ++i) {
      REQUIRE(At(whole.diffuse, i) == At(parts.diffuse, i));
      REQUIRE(At(whole.specular, i) == At(parts.specular, i));
    }
  });
}

TEST_CASE("a light near a huge, far surface keeps its direction") {
  // Ground of radius 1e6 around (0, -1e6, 0): a light 1 above it, hits 1 away from its foot.
  ForEachTarget([](Target) {
    HitBatch hits;
    hits.count = 1;
    const double radius = 1e6;
    const double angle = 1 / radius;
    hits.position.x[0] = radius * std::sin(angle);
    hits.position.y[0] = -2 * radius * std::pow(std::sin(angle / 2), 2);
    hits.normal.y[0] = 1;
    hits.to_view.y[0] = 1;
    Surface surface;
    LightBatch batch;
    PrepareSurface(hits, &surface);
    Light light;
    light.kind = PointLight{.position = {0, 1, 0}, .intensity = {1, 1, 1}, .attenuation = {}};
    EvaluateLight(light, {0, 0, 0}, hits, surface, &batch);
    // Rounding of the difference to float and one normalisation: a few u.
    CHECK(batch.to_light.x[0] == Approx(-std::sqrt(0.5)).epsilon(8 * 0x1p-24));
    CHECK(batch.to_light.y[0] == Approx(std::sqrt(0.5)).epsilon(8 * 0x1p-24));
    CHECK(batch.irradiance[0] == Approx(0.5).epsilon(8 * 0x1p-24));
  });
}

TEST_CASE("constants of materials") {
  const Rgb sky(0.5, 1, 2);
  Material material;
  material.emission = Rgb(1, 2, 3);
  material.model = LambertMaterial{Rgb(0.5, 0.5, 0.25)};
  CHECK(ComputeMaterialConstants(material, sky).ambient == Rgb(0.25, 0.5, 0.5));
  CHECK(ComputeMaterialConstants(material, sky).emission == Rgb(1, 2, 3));
  PhongMaterial phong;
  phong.ka = Rgb(0.5, 0.5, 0.5);
  phong.color = Rgb(1, 0.5, 0.25);
  material.model = phong;
  CHECK(ComputeMaterialConstants(material, sky).ambient == Rgb(0.25, 0.25, 0.25));
}

}  // namespace
}  // namespace nacre
