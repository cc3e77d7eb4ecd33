// SPDX-License-Identifier: Apache-2.0
// The plots of materials: slices, and lobes beside those that stand in for them.
#include <algorithm>
#include <cmath>

#include "catch.h"
#include "shading/material_fit.h"
#include "study/material_curves.h"

namespace nacre {
namespace {

NamedMaterial Prepared(const std::string& label, const Material& material) {
  return {label, PrepareMaterial(material)};
}

Material Matte(double albedo) { return {.model = LambertMaterial{Rgb(albedo)}}; }

}  // namespace

TEST_CASE("a slice's directions have its angles, at right angles to the half vector's plane") {
  for (const double theta_h : {0.25, 30.0, 89.75}) {
    for (const double theta_d : {0.25, 45.0, 89.75}) {
      const auto [to_light, to_view] = DirectionsOfSlice(theta_h, theta_d);
      const Vec3d half = (to_light + to_view).normalized();
      // Roundings of a few sines.
      CHECK(std::abs(to_light.length() - 1) <= 1e-15);
      CHECK(std::abs(half.z - std::cos(theta_h * M_PI / 180)) <= 1e-13);
      CHECK(std::abs((half ^ to_light) - std::cos(theta_d * M_PI / 180)) <= 1e-13);
      CHECK(std::abs(half.y) <= 1e-13);
      CHECK(to_light.z > 0);
      CHECK(to_view.z > 0);
    }
  }
}

TEST_CASE("a matte slice is its albedo over pi; several slices share one scale") {
  Material bright{.model = MetallicRoughnessMaterial{.metallic = 1, .roughness = 0.3}};
  const std::vector<Plot> plots =
      SlicePlots({Prepared("matte", Matte(0.5)), Prepared("metal", bright)}, ColorChannel::kRed);
  REQUIRE(plots.size() == 2);
  for (const double value : plots[0].field->values) {
    REQUIRE(std::abs(value - 0.5 / M_PI) <= 1e-13);
  }
  CHECK(plots[0].title == "matte");
  // White metal of roughness 0.3 mirrors 1 / (4 pi alpha^2) = 9.8 along the normal; towards 84
  // degrees from there G / n.l lets it grow.
  double largest = 0;
  for (size_t i = 0; i < plots[1].field->values.size(); ++i) {
    const Vec3d to_light = DirectionsOfSlice(plots[1].field->x[i], plots[1].field->y[i]).to_light;
    if (to_light.z > 0.1) largest = std::max(largest, plots[1].field->values[i]);
  }
  CHECK(largest > 9.8);
  for (const Plot& plot : plots) {
    CHECK(plot.field->high >= largest);
    CHECK(plot.field->high < 10 * largest);
    CHECK(plot.field->low == plots[0].field->low);
    CHECK(plot.field->high / plot.field->low <= 1.0001e4);
  }
}

TEST_CASE("a black slice has a scale of its own") {
  const Plot plot = SlicePlots({Prepared("black", Matte(0))}, ColorChannel::kLuminance).at(0);
  CHECK(plot.field->low < plot.field->high);
  CHECK(plot.field->low > 0);
}

TEST_CASE("lobes are drawn around the mirror direction") {
  Material metal{.model = MetallicRoughnessMaterial{.metallic = 1, .roughness = 0.5}};
  const MaterialFit fit = FitMaterial(metal, "blinn_phong");
  const Figure figure =
      LobeFigure({{"original", metal}, {"closed form", fit.guess}, {"fit", fit.fitted}});
  REQUIRE(figure.panels.size() == kResidualViewsDeg.size());
  for (size_t i = 0; i < figure.panels.size(); ++i) {
    const Plot& plot = figure.panels[i];
    REQUIRE(plot.curves.size() == 3);
    CHECK(plot.x.low < kResidualViewsDeg[i]);
    CHECK(plot.x.high > kResidualViewsDeg[i]);
    for (const Curve& curve : plot.curves) CHECK(curve.x == plot.curves[0].x);
  }
  // At 30 degrees the original's largest value is near the mirror direction: the off-specular
  // shift of GGX is below 10 degrees there.
  const Curve& original = figure.panels[1].curves[0];
  const auto peak = std::max_element(original.y.begin(), original.y.end()) - original.y.begin();
  CHECK(std::abs(original.x[static_cast<size_t>(peak)] - 30) <= 10);
}

}  // namespace nacre
