// SPDX-License-Identifier: Apache-2.0
// tests/shading/log_fit_test.cc: fits to measured materials find the parameters that tables were
// made of.
#include "shading/log_fit.h"

#include "catch.h"
#include "measured_tables.h"
#include "shading/material_fit.h"
#include "shading/scalar_bsdf.h"

namespace nacre {
namespace {

// The table of a material.
Material Measured(const Material& of) {
  const ShadingMaterial prepared = PrepareMaterial(of);
  MeasuredBrdf brdf;
  brdf.table = MakeMerlTable([&](const Vec3d& n, const Vec3d& l, const Vec3d& v) {
    return Reflect(prepared, n, l, v).Sum() / l.z;
  });
  FinishMeasured(&brdf);
  return {.model = MeasuredMaterial{.brdf = std::make_shared<const MeasuredBrdf>(brdf)}};
}

bool IsNear(double got, double wanted, double tolerance) {
  CAPTURE(got, wanted);
  const bool near = std::abs(got - wanted) <= tolerance;
  CHECK(near);
  return near;
}

TEST_CASE("a measured metal is fitted by the metal that it is") {
  MetallicRoughnessMaterial gold;
  gold.base_color = Rgb(0.9, 0.7, 0.3);
  gold.metallic = 1;
  gold.roughness = 0.4;
  const MaterialFit fit = FitMaterial(Measured({.model = gold}), "metallic_roughness");
  const auto& fitted = std::get<MetallicRoughnessMaterial>(fit.fitted.model);
  IsNear(fitted.roughness, 0.4, 0.01);
  IsNear(fitted.metallic, 1, 0.02);
  for (int c = 0; c < 3; ++c) IsNear(fitted.base_color[c], gold.base_color[c], 0.02);
  CHECK(fit.log_rms < 0.01);
  CHECK(fit.residual.rms < 0.05);
  CHECK(fit.log_rms < fit.guess_log_rms);
}

TEST_CASE("measured plastic is parted into lobe and base") {
  MetallicRoughnessMaterial plastic;
  plastic.base_color = Rgb(0.6, 0.2, 0.1);
  plastic.roughness = 0.35;
  const Material measured = Measured({.model = plastic});
  const MaterialFit fit = FitMaterial(measured, "metallic_roughness");
  const auto& fitted = std::get<MetallicRoughnessMaterial>(fit.fitted.model);
  IsNear(fitted.roughness, 0.35, 0.01);
  IsNear(fitted.metallic, 0, 0.02);
  for (int c = 0; c < 3; ++c) IsNear(fitted.base_color[c], plastic.base_color[c], 0.02);
  CHECK(fit.log_rms < 0.01);
  for (const char* target : {"blinn_phong", "phong", "dielectric", "open_pbr"}) {
    CAPTURE(target);
    const MaterialFit other = FitMaterial(measured, target);
    // Phong's lobes have no Fresnel term: at 75 degrees the model's highlight is twenty times as
    // bright as at the normal.
    CHECK(other.log_rms < (std::string_view(target).ends_with("phong") ? 0.35 : 0.05));
    CHECK(other.log_rms <= other.guess_log_rms);
    CHECK(std::abs(LogResidual(measured, other.fitted) - other.log_rms) < 1e-12);
  }
}

TEST_CASE("any material becomes one of OpenPBR") {
  PhongMaterial phong{.model = PhongModel::kBlinnPhong, .shininess = 40};
  const MaterialFit fit = FitMaterial({.model = phong}, "open_pbr");
  CHECK(std::holds_alternative<OpenPbrMaterial>(fit.fitted.model));
  CHECK(fit.log_rms < 0.1);
}

}  // namespace
}  // namespace nacre
