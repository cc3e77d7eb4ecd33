// SPDX-License-Identifier: Apache-2.0
// tests/stress/reciprocity_test.cc: light and viewer change places, and the reciprocal models
// reflect as much (Helmholtz), in the kernels' own rounding.
#include <algorithm>
#include <cmath>
#include <memory>

#include "base/float_mode.h"
#include "catch.h"
#include "shading/shade.h"
#include "stress/fuzz_draws.h"
#include "stress/truth_reflect.h"
#include "targets.h"

namespace nacre {
namespace {

constexpr size_t kHits = kBatchCapacity;

// In double and in float, as the kernels read them.
template <typename Real>
void Set(const Vec3d& v, size_t i, Soa3<Real>* to) {
  to->x[i] = static_cast<Real>(v.x);
  to->y[i] = static_cast<Real>(v.y);
  to->z[i] = static_cast<Real>(v.z);
}

void Set(const Vec3d& v, size_t i, Soa3<double>* to, Soa3<float>* rounded) {
  Set(v, i, to);
  Set(v, i, rounded);
}

struct Side {
  HitBatch hits;
  Surface surface;
  LightBatch evaluated;
  ShadeScratch scratch;
  ReflectedRadiance radiance;
};

// The same hits from both sides, at cosines over 1e-3, under light of irradiance 1.
struct BothSides {
  explicit BothSides(uint64_t seed) {
    FuzzRandom random(seed);
    for (size_t i = 0; i < kHits;) {
      const FuzzDirections d = DrawDirections(&random);
      if (d.normal.dot(d.to_light) < 1e-3 || d.normal.dot(d.to_view) < 1e-3) continue;
      for (Side* side : {&there, &back}) {
        Set(d.normal, i, &side->hits.normal, &side->surface.normal);
      }
      Set(-d.to_light, i, &there.hits.position);
      Set(d.to_light, i, &there.evaluated.light_vector);
      Set(d.to_view, i, &there.hits.to_view, &there.surface.to_view);
      Set(-d.to_view, i, &back.hits.position);
      Set(d.to_view, i, &back.evaluated.light_vector);
      Set(d.to_light, i, &back.hits.to_view, &back.surface.to_view);
      for (Side* side : {&there, &back}) {
        side->evaluated.inverse_length[i] = side->evaluated.irradiance[i] = 1;
      }
      ++i;
    }
  }

  Side there, back;
};

double Cosine(const Side& side, size_t i) {
  const Soa3<float>& n = side.surface.normal;
  const Soa3<float>& l = side.evaluated.light_vector;
  return double{n.x[i]} * l.x[i] + double{n.y[i]} * l.y[i] + double{n.z[i]} * l.z[i];
}

// The largest relative difference of f(l, v) and f(v, l), over what is at least `floor`. The float
// cosine that a kernel multiplies with, and that is divided out here, errs by 2 u absolutely, so
// the difference counts in units of 1 + 1 / (4 cosine).
double Difference(const BothSides& sides, const Soa3<float>& there, const Soa3<float>& back,
                  double floor) {
  double worst = 0;
  for (size_t i = 0; i < kHits; ++i) {
    const double a = there.y[i] / Cosine(sides.there, i);
    const double b = back.y[i] / Cosine(sides.back, i);
    const double smaller = std::min(Cosine(sides.there, i), Cosine(sides.back, i));
    worst = std::max(worst, std::abs(a - b) / std::max({a, b, floor}) / (1 + 0.25 / smaller));
  }
  return worst;
}

void CheckReciprocal(const Material& material, BothSides* sides, double bound, double floor) {
  const ShadingLight light{.color = Rgb(1)};  // at the origin, and the hits around it
  const ShadingMaterial prepared = PrepareMaterial(material);
  for (Side* side : {&sides->there, &sides->back}) {
    ClearRadiance(kHits, &side->radiance);
    PrepareRun(prepared, 0, kHits, &side->surface);
    ShadeRun(
        {{prepared, side->hits, side->surface, 0, kHits}, light, &side->evaluated, &side->radiance},
        &side->scratch);
  }
  const ReflectedRadiance& there = sides->there.radiance;
  const ReflectedRadiance& back = sides->back.radiance;
  CHECK(there.diffuse.y[0] + there.specular.y[0] > 0);
  CHECK(Difference(*sides, there.diffuse, back.diffuse, floor) <= bound);
  CHECK(Difference(*sides, there.specular, back.specular, floor) <= bound);
}

TEST_CASE("reciprocal models are so to 16 roundings") {
  const FlushDenormals flush;
  constexpr double kBound = 16 * 0x1p-24;
  ForEachTarget([&](Target) {
    for (uint64_t seed = 0; seed < 20; ++seed) {
      const auto sides = std::make_unique<BothSides>(seed);
      Scene scene;
      scene.materials.resize(5);
      scene.materials[0].model = LambertMaterial{{0.3, 0.9, 1}};
      FuzzRandom random(seed);
      const Shadowing forms[] = {Shadowing::kHeightCorrelated, Shadowing::kSeparable,
                                 Shadowing::kSchlickDirect, Shadowing::kSchlickIbl};
      for (size_t i = 0; i < 4; ++i) {
        scene.materials[i + 1].model =
            MetallicRoughnessMaterial{.base_color = {0.2, 0.7, 1},
                                      .metallic = random.Uniform(0, 1),
                                      .roughness = random.Magnitude(0.02, 1),
                                      .shadowing = forms[i]};
      }
      UsePlainForms(&scene);
      for (const Material& material : scene.materials) {
        CheckReciprocal(material, sides.get(), kBound, 1e-30);
      }
      // Lewis 1994. r is rounded before it meets v, which moves the lobe by roundings of its peak.
      Material phong{.model = PhongMaterial{.model = PhongModel::kModifiedPhong,
                                            .convention = PhongConvention::kClassic,
                                            .shininess = 8}};
      CheckReciprocal(phong, sides.get(), 8 * kBound, 0.3);
    }
  });
}

}  // namespace
}  // namespace nacre
