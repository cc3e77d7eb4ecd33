// SPDX-License-Identifier: Apache-2.0
// tests/api/brdf_test.cc: reflection models of the public API: the kernels beside the formulas.
#include <cmath>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "catch.h"
#include "nacre.h"

namespace {

// Unit vectors around +z, light and view above the surface but for one in eight.
struct Samples {
  static constexpr size_t kCount = 2500;  // two batches and a part
  std::vector<double> planes[9];
  nacre::Directions directions;

  Samples() {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> uniform(-1, 1);
    for (std::vector<double>& plane : planes) plane.resize(kCount);
    for (size_t i = 0; i < kCount; ++i) {
      const bool below = i % 8 == 0;
      Put(0, i, {0, 0, 1});
      Put(3, i, {uniform(random), uniform(random), 0.2 + std::abs(uniform(random))});
      Put(6, i, {uniform(random), uniform(random), below ? -0.3 : 0.3});
    }
    directions.count = kCount;
    for (size_t c = 0; c < 3; ++c) {
      directions.normal[c] = planes[c].data();
      directions.to_view[c] = planes[3 + c].data();
      directions.to_light[c] = planes[6 + c].data();
    }
  }
  nacre::Vec3 At(size_t first, size_t i) const {
    return {planes[first][i], planes[first + 1][i], planes[first + 2][i]};
  }

 private:
  void Put(size_t first, size_t i, const nacre::Vec3& v) {
    const double length = std::hypot(v[0], v[1], v[2]);
    for (size_t c = 0; c < 3; ++c) planes[first + c][i] = v[c] / length;
  }
};

TEST_CASE("Lambert's reflection is albedo / pi times the cosine") {
  const nacre::Brdf brdf("lambert", {{"albedo", {0.2, 0.4, 0.6}}});
  const double cosine = 0.6;
  const nacre::Reflection got = brdf.Evaluate({0, 0, 1}, {0, 0, 1}, {0.8, 0, cosine});
  for (size_t c = 0; c < 3; ++c) {
    // Three roundings in double.
    const double expected = 0.2 * static_cast<double>(c + 1) / 3.14159265358979323846 * cosine;
    REQUIRE(std::abs(got.diffuse[c] - expected) <= 3 * 0x1p-53 * 2 * expected);
    REQUIRE(got.specular[c] == 0);
  }
  REQUIRE(brdf.Evaluate({0, 0, 1}, {0, 0, 1}, {0, 0, -1}).diffuse[0] == 0);
}

TEST_CASE("kernels agree with the formulas, for every model and target") {
  const Samples samples;
  const std::string before = nacre::ActiveTarget();
  const std::vector<std::pair<std::string, nacre::Parameters>> materials = {
      {"lambert", {}},
      {"oren_nayar", {{"roughness", 0.7}}},
      {"burley", {{"roughness", 0.7}}},
      {"blinn_phong", {{"shininess", 50}}},
      {"metallic_roughness", {{"roughness", 0.4}, {"metallic", 0.5}}},
      {"conductor", {{"roughness", 0.3}}},
      {"dielectric", {{"roughness", 0.3}}},
  };
  for (const std::string& target : nacre::SupportedTargets()) {
    nacre::SetTarget(target);
    for (const auto& [model, parameters] : materials) {
      CAPTURE(target, model);
      const nacre::Brdf brdf(model, parameters);
      const nacre::Reflections got = brdf.Shade(samples.directions);
      double sum = 0;
      for (size_t i = 0; i < Samples::kCount; ++i) {
        const nacre::Reflection expected =
            brdf.Evaluate(samples.At(0, i), samples.At(3, i), samples.At(6, i));
        for (size_t c = 0; c < 3; ++c) {
          // Directions rounded to float, 6e-8, in lobes of width alpha >= 0.09, to the side of
          // which they change by 40 times that; terms of 64 roundings.
          const auto near = [](double a, double b) { return std::abs(a - b) <= 2e-5 * b + 4e-7; };
          REQUIRE(near(got.diffuse[c][i], expected.diffuse[c]));
          REQUIRE(near(got.specular[c][i], expected.specular[c]));
          sum += expected.diffuse[c] + expected.specular[c];
        }
      }
      REQUIRE(sum > 0);
    }
  }
  nacre::SetTarget(before);
}

TEST_CASE("kernels agree with the formulas under coats and layers") {
  const Samples samples;
  const nacre::Brdf brdf(
      "metallic_roughness",
      {{"coat", 0.8}, {"coat_roughness", 0.3}, {"sheen_color", 0.5}, {"sheen_roughness", 0.4}});
  const nacre::Reflections fast = brdf.Shade(samples.directions);
  const nacre::ExactReflections exact = brdf.Evaluate(samples.directions);
  for (size_t i = 0; i < Samples::kCount; ++i) {
    // Some tens of roundings in float.
    const double sum = exact.diffuse[1][i] + exact.specular[1][i];
    REQUIRE(std::abs(double{fast.diffuse[1][i]} + fast.specular[1][i] - sum) <= 1e-5 * sum + 1e-7);
  }
}

TEST_CASE("a material of a scene is that material, and splits and unknown names are refused") {
  nacre::Scene scene;
  scene.AddMaterial("gold", {{"model", "conductor"}, {"preset", "gold"}, {"roughness", 0.4}});
  scene.AddMaterial("clay", {{"model", "oren_nayar"}});
  scene.AddMaterial("both", {{"model", "split"},
                             {"at", std::vector<double>{0.5}},
                             {"materials", std::vector<std::string>{"gold", "clay"}}});
  const nacre::Vec3 up = {0, 0, 1}, slanted = {0.6, 0, 0.8};
  const nacre::Reflection gold = nacre::Brdf(scene, "gold").Evaluate(up, slanted, up);
  REQUIRE(gold.specular[0] > gold.specular[2]);
  REQUIRE(gold.diffuse[0] == 0);
  REQUIRE_THROWS_AS(nacre::Brdf(scene, "both"), nacre::Error);
  REQUIRE_THROWS_AS(nacre::Brdf(scene, "silver"), nacre::Error);
  REQUIRE_THROWS_AS(nacre::Brdf("lambart"), nacre::Error);
  REQUIRE_THROWS_AS(nacre::SetTarget("sse9"), nacre::Error);
}

// The error of a call, or "" if there is none.
template <class Call>
std::string ErrorOf(const Call& call) {
  try {
    call();
  } catch (const nacre::Error& error) {
    REQUIRE(error.exit_code() == 64);
    REQUIRE(error.faults().size() == 1);
    return error.faults()[0].where + ": " + error.faults()[0].what;
  }
  return "";
}

TEST_CASE("directions that are not finite and unit are refused, and told") {
  const nacre::Brdf brdf("metallic_roughness");
  const double nan = std::nan(""), inf = HUGE_VAL;
  const nacre::Vec3 up{0, 0, 1};
  const std::vector<nacre::Vec3> bad = {{0, 0, 0},   {0, 0, 2},   {0, nan, 1},      {nan, nan, nan},
                                        {0, 0, inf}, {inf, 0, 0}, {0, 0, 1 + 5e-7}, {0, 0, 0.5},
                                        {0, 0, -2},  {1, 1, 1},   {0, 0, 1e300},    {-inf, 0, nan}};
  for (const nacre::Vec3& v : bad) {
    CAPTURE(v[0], v[1], v[2]);
    REQUIRE_THAT(ErrorOf([&] { brdf.Evaluate(v, up, up); }),
                 Catch::Matchers::StartsWith("Brdf::Evaluate: normal ("));
    REQUIRE_THAT(ErrorOf([&] { brdf.Evaluate(up, v, up); }),
                 Catch::Matchers::StartsWith("Brdf::Evaluate: to_view ("));
    REQUIRE_THAT(ErrorOf([&] { brdf.Evaluate(up, up, v); }),
                 Catch::Matchers::StartsWith("Brdf::Evaluate: to_light ("));
    for (size_t which = 0; which < 3; ++which) {
      Samples samples;
      for (size_t c = 0; c < 3; ++c) samples.planes[3 * which + c][2100] = v[c];
      const char* const names[] = {"normal", "to_view", "to_light"};
      REQUIRE_THAT(
          ErrorOf([&] { brdf.Shade(samples.directions); }),
          Catch::Matchers::StartsWith("Brdf::Shade: " + std::string(names[which]) + " 2100 ("));
    }
  }
  REQUIRE(ErrorOf([&] {
            brdf.Evaluate({0, 0, 2}, up, up);
          }) == "Brdf::Evaluate: normal (0, 0, 2) has length 2, not 1");
  const Samples samples;
  nacre::Directions missing = samples.directions;
  missing.to_light[1] = nullptr;
  REQUIRE(ErrorOf([&] { brdf.Shade(missing); }) ==
          "Brdf::Shade: a component of to_light is a null pointer");
  REQUIRE(brdf.Shade({}).diffuse[0].empty());  // of no points none is asked for
}

TEST_CASE("directions made unit in float arithmetic are unit") {
  const nacre::Brdf brdf("phong");
  std::mt19937 random(5);
  std::uniform_real_distribution<float> uniform(-1, 1);
  for (int i = 0; i < 20000; ++i) {
    const float x = uniform(random), y = uniform(random), z = uniform(random);
    const float inverse = 1 / std::sqrt(x * x + y * y + z * z);
    const nacre::Vec3 v{x * inverse, y * inverse, z * inverse};
    REQUIRE(ErrorOf([&] { brdf.Evaluate(v, v, v); }).empty());
  }
}

// The terms of the models, in all the ways in which directions are chosen.
const std::vector<std::pair<std::string, nacre::Parameters>> kSampledModels = {
    {"lambert", {}},
    {"oren_nayar", {{"roughness", 1}}},
    {"phong", {{"shininess", 40}}},
    {"blinn_phong", {{"shininess", 40}}},
    {"metallic_roughness", {{"metallic", 0.3}, {"roughness", 0.3}}},
    {"metallic_roughness", {{"metallic", 1}, {"roughness", 0.8}, {"compensation", "kulla_conty"}}},
    {"metallic_roughness",
     {{"coat", 0.8}, {"coat_roughness", 0.3}, {"sheen_color", 0.7}, {"sheen_roughness", 0.5}}},
    {"conductor", {{"preset", "gold"}, {"roughness", 0.2}}},
    {"dielectric", {{"roughness", 0.4}}}};

TEST_CASE("samples weighted by their pdf reflect the albedo") {
  constexpr size_t kCount = 40000;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (const auto& [model, parameters] : kSampledModels) {
    const nacre::Brdf brdf(model, parameters);
    for (const double cosine : {1.0, 0.6, 0.15}) {
      INFO(model << " at n.v " << cosine);
      std::vector<double> planes[6], u(kCount), v(kCount);
      const double view[6] = {0, 0, 1, std::sqrt(1 - cosine * cosine), 0, cosine};
      for (size_t c = 0; c < 6; ++c) planes[c].assign(kCount, view[c]);
      for (size_t i = 0; i < kCount; ++i) {
        u[i] = uniform(random);
        v[i] = uniform(random);
      }
      nacre::Directions d;
      d.count = kCount;
      for (size_t c = 0; c < 3; ++c) {
        d.normal[c] = planes[c].data();
        d.to_view[c] = planes[3 + c].data();
      }
      const auto sampled = brdf.Sample(d, u.data(), v.data());
      for (size_t c = 0; c < 3; ++c) d.to_light[c] = sampled[c].data();
      const std::vector<double> pdf = brdf.Pdf(d);
      const nacre::ExactReflections f = brdf.Evaluate(d);
      double sum = 0, squares = 0;
      for (size_t i = 0; i < kCount; ++i) {
        const double value = f.diffuse[1][i] + f.specular[1][i];
        if (value == 0) continue;
        REQUIRE(pdf[i] > 0);
        sum += value / pdf[i];
        squares += value / pdf[i] * (value / pdf[i]);
      }
      const double mean = sum / kCount;
      const double deviation = std::sqrt(std::max(squares / kCount - mean * mean, 0.0) / kCount);
      // Five standard deviations, and what albedos that are fits may be off by.
      CHECK(std::abs(mean - brdf.Albedo(cosine)[1]) < 5 * deviation + 1e-3);
    }
  }
}

TEST_CASE("arrays are evaluated as single points are, and a lobe is the product of its terms") {
  const Samples samples;
  const nacre::Parameters parameters = {{"roughness", 0.3}, {"compensation", "none"}};
  for (const char* model : {"metallic_roughness", "conductor", "dielectric"}) {
    const nacre::Brdf brdf(model, parameters);
    const nacre::ExactReflections all = brdf.Evaluate(samples.directions);
    const nacre::MicrofacetTerms terms = brdf.Terms(samples.directions);
    for (size_t i = 0; i < Samples::kCount; ++i) {
      const nacre::Vec3 n = samples.At(0, i), v = samples.At(3, i), l = samples.At(6, i);
      const nacre::Reflection one = brdf.Evaluate(n, v, l);
      for (size_t c = 0; c < 3; ++c) {
        REQUIRE(all.diffuse[c][i] == one.diffuse[c]);
        REQUIRE(all.specular[c][i] == one.specular[c]);
        const double lobe = terms.d[i] * terms.g[i] * terms.f[c][i] / (4 * v[2]);
        REQUIRE(std::abs(lobe - one.specular[c]) <= 1e-14 * one.specular[c]);
      }
      if (l[2] <= 0) continue;
      // Heitz 2014, eq. 99: height-correlated.
      const double g = 1 / (1 + terms.lambda_view[i] + terms.lambda_light[i]);
      REQUIRE(std::abs(terms.g[i] - g) <= 1e-14 * g);
    }
  }
  CHECK_THROWS_AS(nacre::Brdf("lambert").Terms(samples.directions), nacre::Error);
  CHECK_THROWS_AS(nacre::Brdf("lambert").Albedo(0), nacre::Error);
}

}  // namespace
