// SPDX-License-Identifier: Apache-2.0
// tests/shading/highlight_test.cc: highlights against the models in double, over the whole lobe, on
// every target: in float up to the limits of kDoubleTermsRoughness and kDoubleTermsShininess, in
// double beyond them.
#include "shading/highlight.h"

#include <algorithm>
#include <cmath>

#include "base/float_mode.h"
#include "shading/model_twins.h"
#include "shading/prepare.h"
#include "targets.h"

namespace nacre {
namespace {

constexpr uint32_t kSeeds = 8;  // highlights of 1000 normals each: a bound is not met by luck

// The worst relative error of the specular part over highlights of `material`.
template <class Model>
double HighlightError(const ShadingMaterial& material, const Model& model, double width) {
  double worst = 0;
  for (uint32_t seed = 1; seed <= kSeeds; ++seed) {
    const Highlight got = ShadeHighlight(material, kLightColor, width, seed);
    for (size_t i = 0; i < got.hits.count; ++i) {
      const Vec3d n(got.hits.normal.x[i], got.hits.normal.y[i], got.hits.normal.z[i]);
      const Reflected expected =
          Reflect(model, n, kHighlightToView, Incident{kHighlightToLight, 1});
      worst = std::max(worst, std::abs(got.radiance.specular.x[i] / expected.specular.x - 1));
    }
  }
  return worst;
}

double GgxError(double roughness, bool double_terms) {
  ShadingMaterial prepared = Prepare(MetallicRoughnessMaterial{.roughness = roughness});
  auto& model = std::get<MicrofacetModel>(prepared.model);
  CHECK(model.double_terms == (roughness < kDoubleTermsRoughness));
  model.double_terms = double_terms;
  return HighlightError(prepared, model, roughness * roughness);
}

double PhongError(PhongModel model, double shininess, bool double_terms) {
  PhongMaterial material{.model = model, .shininess = shininess};
  ShadingMaterial prepared = Prepare(material);
  auto& prepared_model = std::get<PhongFamilyModel>(prepared.model);
  CHECK(prepared_model.double_terms == (shininess > kDoubleTermsShininess));
  prepared_model.double_terms = double_terms;
  return HighlightError(prepared, material, 1 / std::sqrt(shininess));
}

// With u = 6e-8, the rounding of a direction's components to float: D sees it as 4 u / alpha where
// it is steepest, forming its terms as much again; with double terms the model's other 32 roundings
// are left.
TEST_CASE("highlights of smooth GGX surfaces keep their precision") {
  const FlushDenormals flush;
  ForEachTarget([](Target) {
    CHECK(GgxError(0.3, false) <= 1e-5);
    CHECK(GgxError(0.05, false) <= 2e-4);
    for (const double roughness : {0.05, 0.01, 0.001}) {
      CAPTURE(roughness);
      CHECK(GgxError(roughness, true) <= 2e-6);
    }
  });
}

// Three widths out in both directions the lobe is e^-36: Log2's relative error of 2e-7 is then
// 7e-6 of the lobe, and rounding its product with the exponent is 2e-6. With terms in float, what
// rounding the directions costs comes on top: measured up to 1.2e-5 at the limit. All together was
// below 2e-5 in the 8000 hits of here; in 2 million (kSeeds of 2000) at each of eight exponents
// from 30 to the limit it was at most 2.5e-5, and 2.0e-5 with fused multiply-add. r - v in parts
// along n and across it, in half as many operations again, was within 2.1e-5 and 1.8e-5 of the
// same.
TEST_CASE("highlights of the Phong family keep their precision") {
  const FlushDenormals flush;
  ForEachTarget([](Target) {
    for (const PhongModel model :
         {PhongModel::kPhong, PhongModel::kModifiedPhong, PhongModel::kBlinnPhong}) {
      CAPTURE(static_cast<int>(model));
      for (const double shininess : {30.0, 100.0, kDoubleTermsShininess}) {
        CAPTURE(shininess);
        CHECK(PhongError(model, shininess, false) <= 2e-5);
      }
      for (const double shininess : {500.0, 1e4, 1e6, 1e9}) {
        CAPTURE(shininess);
        CHECK(PhongError(model, shininess, true) <= 1e-5);
      }
    }
  });
}

}  // namespace
}  // namespace nacre
