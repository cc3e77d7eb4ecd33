// SPDX-License-Identifier: Apache-2.0
// tests/stress/accuracy_main.cc: prints what nacre's precision is, beside the textbook's formulas
// in float: the tables of tests/README.md. Everything is measured when it is printed.
#include <cmath>
#include <cstdio>
#include <exception>
#include <random>
#include <vector>

#include "base/float_mode.h"
#include "base/target.h"
#include "brdf/albedo.h"
#include "brdf/albedo_integral.h"
#include "brdf/ggx.h"
#include "brdf/phong.h"
#include "scene/scene.h"
#include "shading/highlight.h"
#include "visibility/intersector.h"
#include "visibility/projected_sphere_test.h"
#include "visibility/quad_hits.h"

namespace nacre {
namespace {

// ---- Hits ---------------------------------------------------------------------------------------

struct Hit {
  bool hit = false;
  Vec3d normal;
};

// The lesson's quadratic, t = (-b - sqrt(b^2 - 4 a c)) / 2 a.
Hit TextbookHit(const Imath::V3f& center, float radius, const Imath::V3f& direction) {
  const float a = direction.dot(direction);
  const float b = -2 * center.dot(direction);
  const float c = center.dot(center) - radius * radius;
  const float discriminant = b * b - 4 * a * c;
  if (discriminant < 0) return {};
  const float t = (-b - std::sqrt(discriminant)) / (2 * a);
  return {true, Vec3d((direction * t - center).normalized())};
}

// Compares hits with the true ones.
struct HitErrors {
  int wrong = 0;  // false hits and misses
  double normal = 0;
  void Count(const Hit& got, const QuadHit& truth) {
    wrong += got.hit != truth.hit;
    if (!got.hit || !truth.hit) return;
    const double chord = AngleTo(truth.normal, got.normal);
    normal = std::max(normal, 2 * std::asin(std::min(chord / 2, 1.0)));
  }
};

constexpr int kRounds = 20;  // batches of rays

void PrintHits() {
  std::printf(
      "| distance / radius | textbook, float: wrong hits and misses | its normals off by | nacre: "
      "wrong | its normals off by |\n|---|---|---|---|---|\n");
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-1.01, 1.01);
  for (const double distance : {1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7}) {
    const Vec3d center = Vec3d(0.3, -0.2, -1).normalized() * distance;
    Scene scene;
    scene.materials.emplace_back();
    scene.spheres = {{center, 1, {0}}};
    const Intersector intersector(scene, Vec3d(0));
    const Vec3d right = (center % Vec3d(0, 1, 0)).normalized();
    const Vec3d up = (right % center).normalized();
    HitErrors textbook, ours;
    for (int round = 0; round < kRounds; ++round) {
      RayBatch rays;
      ClosestHits closest;
      HitBatch hits;
      HitDirections rounded;
      rays.count = kBatchCapacity;
      // As rays of a camera whose pixels are fine enough.
      rays.view = {center.normalized(), kMaxProjectedScale};
      for (size_t i = 0; i < kBatchCapacity; ++i) {
        const double x = uniform(random);
        const double y = uniform(random);
        const Vec3d to = (center + right * x + up * y) / distance;
        rays.direction.x[i] = to.x;
        rays.direction.y[i] = to.y;
        rays.direction.z[i] = to.z;
      }
      intersector.Closest(rays, &closest);
      std::vector<uint32_t> found;
      for (uint32_t i = 0; i < kBatchCapacity; ++i) {
        if (closest.primitive[i] != kNoPrimitive) found.push_back(i);
      }
      intersector.Refine(rays, closest, found.data(), found.size(), {&hits, &rounded, true});
      std::vector<Hit> got(kBatchCapacity);
      for (size_t i = 0; i < found.size(); ++i) {
        got[found[i]] = {true, Vec3d(hits.normal.x[i], hits.normal.y[i], hits.normal.z[i])};
      }
      for (size_t i = 0; i < kBatchCapacity; ++i) {
        const Vec3d direction(rays.direction.x[i], rays.direction.y[i], rays.direction.z[i]);
        const QuadHit truth = TestInQuad(Vec3d(0), direction, {center, 1});
        ours.Count(got[i], truth);
        textbook.Count(TextbookHit(Imath::V3f(center), 1, Imath::V3f(direction)), truth);
      }
    }
    const double all = static_cast<double>(kRounds * kBatchCapacity);
    std::printf("| %.0e | %.3g %% | %.1e rad | %d of %.0f | %.1e rad |\n", distance,
                100 * textbook.wrong / all, textbook.normal, ours.wrong, all, ours.normal);
  }
}

// ---- Highlights ---------------------------------------------------------------------------------

// The worst relative error of what is rendered, and of a formula of float vectors n, l, v.
template <class Truth, class Formula>
void PrintHighlight(const char* label, double value, const ShadingMaterial& material, double width,
                    const Truth& truth, const Formula& formula) {
  const Highlight got = ShadeHighlight(material, Rgb(1), width, 5);
  double ours = 0;
  double naive = 0;
  for (size_t i = 0; i < got.hits.count; ++i) {
    const Vec3d n(got.hits.normal.x[i], got.hits.normal.y[i], got.hits.normal.z[i]);
    const double expected = truth(n);
    if (!(expected > 0)) continue;
    ours = std::max(ours, std::abs(got.radiance.specular.x[i] / expected - 1));
    const double value_of_formula =
        formula(Imath::V3f(n), Imath::V3f(kHighlightToLight), Imath::V3f(kHighlightToView));
    naive = std::max(naive, std::abs(value_of_formula / expected - 1));
  }
  std::printf("| %s %g | %.1e | %.1e |\n", label, value, naive, ours);
}

double TrueGgx(const Vec3d& n, double alpha) {
  const Angles<double> a = ComputeAngles(n, kHighlightToLight, kHighlightToView);
  return GgxDistribution(a, alpha) * VisibilityHeightCorrelated(a.n_dot_l, a.n_dot_v, alpha) *
         a.n_dot_l;
}

// D with (n.h)^2 (alpha^2 - 1) + 1, as in the textbooks; masking in double, which is not at issue.
double TextbookGgx(const Imath::V3f& n, const Imath::V3f& l, const Imath::V3f& v, float alpha) {
  const Imath::V3f h = (l + v).normalized();
  const float n_dot_h = n.dot(h);
  const float alpha2 = alpha * alpha;
  const float denominator = n_dot_h * n_dot_h * (alpha2 - 1) + 1;
  const float d = alpha2 / (static_cast<float>(M_PI) * denominator * denominator);
  const Angles<double> a = ComputeAngles(Vec3d(n), kHighlightToLight, kHighlightToView);
  return d * VisibilityHeightCorrelated<double>(a.n_dot_l, a.n_dot_v, alpha) * a.n_dot_l;
}

void PrintHighlights() {
  std::printf("| lobe | textbook formula, float | nacre |\n|---|---|---|\n");
  for (const double roughness : {0.5, 0.3, 0.1, 0.05, 0.02, 0.01, 0.001}) {
    Material material{.model = MetallicRoughnessMaterial{.base_color = Rgb(1),
                                                         .metallic = 1,
                                                         .roughness = roughness,
                                                         .compensation = Compensation::kNone}};
    const double alpha = AlphaFromRoughness(roughness);
    PrintHighlight(
        "GGX, roughness", roughness, PrepareMaterial(material), alpha,
        [&](const Vec3d& n) { return TrueGgx(n, alpha); },
        [&](const Imath::V3f& n, const Imath::V3f& l, const Imath::V3f& v) {
          return TextbookGgx(n, l, v, static_cast<float>(alpha));
        });
  }
  for (const double shininess : {1e2, 1e3, 1e4, 1e5, 1e6}) {
    Material material{.model = PhongMaterial{.model = PhongModel::kPhong,
                                             .convention = PhongConvention::kClassic,
                                             .ks = Rgb(1),
                                             .shininess = shininess}};
    PrintHighlight(
        "Phong, exponent", shininess, PrepareMaterial(material), 0.5 / std::sqrt(shininess),
        [&](const Vec3d& n) {
          return PhongLobe(n, kHighlightToLight, kHighlightToView, shininess);
        },
        [&](const Imath::V3f& n, const Imath::V3f& l, const Imath::V3f& v) {
          const Imath::V3f r = n * (2 * n.dot(l)) - l;
          return double{std::pow(std::max(r.dot(v), 0.0f), static_cast<float>(shininess))};
        });
  }
}

// ---- Energy -------------------------------------------------------------------------------------

// What a white surface reflects of equal light from everywhere, by quadrature in double, with the
// compensation and the base as they are rendered.
double WhiteAlbedo(double roughness, double metallic, double n_dot_v) {
  Material material;
  material.model =
      MetallicRoughnessMaterial{.base_color = Rgb(1), .metallic = metallic, .roughness = roughness};
  const auto model = std::get<MicrofacetModel>(PrepareMaterial(material).model);
  const double one = AlbedoOfOne(model.shadowing, roughness, n_dot_v);
  const double schlick = AlbedoOfSchlick(model.shadowing, roughness, n_dot_v);
  const double more = 1 / AlbedoOne(model.albedo.lobe, n_dot_v) - 1;
  const auto lobe_of = [&](double f0) { return (f0 * one + (1 - f0) * schlick) * (1 + f0 * more); };
  const double lobe =
      (1 - metallic) * lobe_of(model.dielectric_f0.x) + metallic * lobe_of(model.metal_f0.x);
  return lobe + M_PI * model.diffuse.x * (1 - CoverAlbedo(model, n_dot_v, 0));
}

void PrintFurnace() {
  std::printf(
      "| roughness | white metal, `compensation` `none` | white metal | white, `metallic` 0.5 | "
      "white "
      "dielectric |\n"
      "|---|---|---|---|---|\n");
  for (const double roughness : {0.0, 0.01, 0.05, 0.1, 0.2, 0.4, 0.6, 0.8, 1.0}) {
    double single = 1;
    double metal = 0;
    double half = 0;
    double dielectric = 0;
    for (const double n_dot_v : {1e-4, 1e-3, 0.01, 0.03, 0.1, 0.2, 0.4, 0.6, 0.8, 1.0}) {
      single = std::min(single, AlbedoOfOne(Shadowing::kHeightCorrelated, roughness, n_dot_v));
      metal = std::max(metal, std::abs(WhiteAlbedo(roughness, 1, n_dot_v) - 1));
      half = std::max(half, std::abs(WhiteAlbedo(roughness, 0.5, n_dot_v) - 1));
      dielectric = std::max(dielectric, std::abs(WhiteAlbedo(roughness, 0, n_dot_v) - 1));
    }
    std::printf("| %g | %.3f | 1 +- %.0e | 1 +- %.0e | 1 +- %.0e |\n", roughness, single, metal,
                half, dielectric);
  }
}

void PrintAll() {
  const FlushDenormals flush;
  std::printf(
      "All are largest errors, here on target %s.\n\n**Hits**, of %d rays at a sphere and just "
      "past "
      "it.\n\n",
      std::string(TargetName(ActiveTarget())).c_str(), static_cast<int>(kRounds * kBatchCapacity));
  PrintHits();
  std::printf(
      "\n**Highlights**: relative error within three widths of the peak (Phong: one and a half)."
      "\n\n");
  PrintHighlights();
  std::printf(
      "\n**Energy**: what a surface reflects of equal light from everywhere; the worst of ten "
      "directions from n.v = 1e-4 to 1.\n\n");
  PrintFurnace();
}

}  // namespace
}  // namespace nacre

int main() {
  try {
    nacre::PrintAll();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
