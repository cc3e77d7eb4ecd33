// SPDX-License-Identifier: Apache-2.0
// tests/light/area_twin_test.cc: SIMD samples of area lights against their scalar double twins, on
// every target.
#include <cmath>
#include <random>

#include "catch.h"
#include "light/area_kernel.h"
#include "light/area_rounding.h"
#include "light/area_shapes.h"
#include "targets.h"

namespace nacre {
namespace {

// The tolerances for float.
struct Tolerances {
  double direction;  // angle
  double distance;   // of the size of offset and light
  double inverse_pdf;
};

double OffsetLength(const SphereLight<double>& light) {
  return light.centre.length() + light.radius;
}
double OffsetLength(const DiskLight<double>& light) { return light.centre.length() + light.radius; }
template <class Light>
double OffsetLength(const Light& light) {
  return light.corner.length() + light.edge_x.length() + light.edge_y.length();
}

// Random samples, and their pdfs.
template <class Light>
std::vector<LightAnswer> RandomAnswers(const Light& light,
                                       std::vector<LightQuery<Light>>* queries) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> unit(0, 1);
  for (int i = 0; i < 1000; ++i) {
    // Not at the rim itself, where rounding decides what hits.
    queries->push_back({light, 0.999f * unit(random), 0.999f * unit(random), {0, 0, 1}});
  }
  std::vector<LightAnswer> answers = AskLights(*queries);
  for (size_t i = 0; i < queries->size(); ++i) {
    (*queries)[i].direction = answers[i].sample.to_light;
  }
  return AskLights(*queries);
}

// The pdf at a sample's direction is that of the sample, to 1e-6 or to the effect that rounding the
// direction has on the distance and the cosine of a light seen edge-on.
bool IsConsistent(const LightAnswer& answer) {
  if (answer.sample.inverse_pdf == 0) return true;
  const double tolerance = 1e-6 + 16 * 0x1p-24 / std::abs(double{answer.sample.cos_light});
  return std::abs(double{answer.sample.inverse_pdf} * answer.pdf - 1) <= tolerance;
}

template <class Light>
void CheckTwins(const Light& exact, const Tolerances& tolerances) {
  const auto light = ToFloat(exact);
  const Light as_double = ToDouble(light);
  const double offset = OffsetLength(as_double);
  std::vector<LightQuery<std::decay_t<decltype(light)>>> queries;
  const std::vector<LightAnswer> answers = RandomAnswers(light, &queries);
  double direction = 0, distance = 0, inverse_pdf = 0;
  size_t inconsistent = 0, one_sided = 0, valid = 0;
  for (size_t i = 0; i < queries.size(); ++i) {
    const AreaSample<float>& got = answers[i].sample;
    const AreaSample<double> want =
        SampleLight(as_double, double{queries[i].u0}, double{queries[i].u1});
    inconsistent += !IsConsistent(answers[i]);
    one_sided += (got.inverse_pdf > 0) != (want.inverse_pdf > 0);
    if (want.inverse_pdf == 0 || got.inverse_pdf == 0) continue;
    ++valid;
    direction = std::max(direction, (Vec3d(got.to_light) - want.to_light).length());
    distance = std::max(distance, std::abs(got.distance - want.distance) / offset);
    inverse_pdf = std::max(inverse_pdf, std::abs(got.inverse_pdf / want.inverse_pdf - 1));
    CHECK(std::abs(got.cos_light - want.cos_light) <= 1e-3);
  }
  CHECK(valid > 500);
  CHECK(inconsistent == 0);
  // A nearby disk's rim, on either side of it.
  CHECK(one_sided <= 2);
  CHECK(direction <= tolerances.direction);
  CHECK(distance <= tolerances.distance);
  CHECK(inverse_pdf <= tolerances.inverse_pdf);
}

template <class Light>
void CheckAllTwins(const std::vector<Light>& lights, const std::vector<size_t>& hard,
                   const Tolerances& usual, const Tolerances& hardest) {
  ForEachTarget([&](Target) {
    for (size_t i = 0; i < lights.size(); ++i) {
      CAPTURE(i);
      const bool is_hard = std::find(hard.begin(), hard.end(), i) != hard.end();
      CheckTwins(lights[i], is_hard ? hardest : usual);
    }
  });
}

// Measured errors, with a factor of 3 or so to spare. The hard ones: a sphere at a distance of 1e-6
// radii (its tangent's length has half the digits); planes that all but contain the point, at a
// height of 1e-3 of the light's size, whose samples take that height's rounding to the horizon.
TEST_CASE("SIMD samples of area lights agree with their double twins on every target") {
  CheckAllTwins(SphereLights(), {2}, {4e-7, 6e-7, 6e-7}, {2e-5, 2e-5, 2e-5});
  CheckAllTwins(RectangleLights(), {2, 3}, {2e-6, 2e-6, 5e-6}, {5e-6, 1e-4, 1e-6});
  CheckAllTwins(TriangleLights(), {2}, {5e-6, 5e-6, 5e-6}, {1e-3, 1e-3, 1e-6});
  CheckAllTwins(DiskLights(), {3, 4}, {3e-6, 1e-5, 1e-5}, {2e-3, 2e-3, 1e-3});
}

TEST_CASE("SIMD solid angles agree with their double twins") {
  ForEachTarget([&](Target) {
    const auto check = [](const auto& lights) {
      for (const auto& light : lights) {
        const auto rounded = ToFloat(light);
        const double got = AskLights({{rounded, 0, 0, {0, 0, 1}}})[0].solid_angle;
        CAPTURE(got, OffsetLength(light));
        CHECK(std::abs(got / SolidAngle(ToDouble(rounded)) - 1) <= 2e-5);
      }
    };
    check(SphereLights());
    check(RectangleLights());
    check(TriangleLights());
  });
}

TEST_CASE("disks seen from their axis have consistent samples in SIMD") {
  ForEachTarget([&](Target) {
    for (const float z : {2000.0f, 1.0f, 0.1f, 1e-3f}) {
      CAPTURE(z);
      const Vec3f axis(Turn({0, 0, 1}));
      std::vector<LightQuery<DiskLight<float>>> queries;
      const std::vector<LightAnswer> answers =
          RandomAnswers(DiskLight<float>{axis * z, axis, 1}, &queries);
      size_t inconsistent = 0;
      for (size_t i = 0; i < answers.size(); ++i) {
        const AreaSample<float>& sample = answers[i].sample;
        inconsistent += !IsConsistent(answers[i]);
        const Vec3d point = Vec3d(sample.to_light) * sample.distance;
        if (sample.inverse_pdf > 0)
          CHECK((point - Vec3d(axis * z)).length() <= 1 + 1e-6 * z + 1e-3);
      }
      CHECK(inconsistent == 0);
    }
  });
}

RectangleLight<float> Scaled(const RectangleLight<float>& light, float by) {
  return {light.corner * by, light.edge_x * by, light.edge_y * by};
}
TriangleLight<float> Scaled(const TriangleLight<float>& light, float by) {
  return {light.corner * by, light.edge_x * by, light.edge_y * by};
}
DiskLight<float> Scaled(const DiskLight<float>& light, float by) {
  return {light.centre * by, light.normal, light.radius * by};
}
SphereLight<float> Scaled(const SphereLight<float>& light, float by) {
  return {light.centre * by, light.radius * by};
}

// Solid angles and irradiances depend on proportions only. Lengths of a scene are between 1e-15 and
// 1e15, whose cubes are out of the range of float. Scaling by powers of two is exact, so all bits
// must be equal.
template <class Light>
void CheckScales(const std::vector<Light>& lights) {
  for (size_t i = 0; i < lights.size(); ++i) {
    const auto light = ToFloat(lights[i]);
    using Query = LightQuery<std::decay_t<decltype(light)>>;
    const Vec3f normal(Turn({0.3, -0.1, 1}).normalized());
    const auto ask = [&](float by) {
      std::vector<Query> queries;
      constexpr float strata[8] = {0.06f, 0.19f, 0.31f, 0.44f, 0.56f, 0.69f, 0.81f, 0.94f};
      for (size_t k = 0; k < 64; ++k) {
        Query query{Scaled(light, by), strata[k % 8], strata[k / 8], {0, 0, 1}};
        query.normal = normal;
        queries.push_back(query);
      }
      std::vector<LightAnswer> answers = AskLights(queries);
      for (size_t k = 0; k < queries.size(); ++k) queries[k].direction = answers[k].sample.to_light;
      return AskLights(queries);
    };
    const std::vector<LightAnswer> want = ask(1);
    for (const int exponent : {-50, -35, 35, 50}) {
      const float by = std::ldexp(1.0f, exponent);
      if (OffsetLength(lights[i]) * double{by} > 4e15) continue;  // beyond the limits
      CAPTURE(i, exponent);
      const std::vector<LightAnswer> got = ask(by);
      size_t other = 0;
      for (size_t k = 0; k < want.size(); ++k) {
        const AreaSample<float>&a = got[k].sample, &b = want[k].sample;
        other += a.to_light != b.to_light || a.distance != b.distance * by ||
                 a.inverse_pdf != b.inverse_pdf || a.cos_light != b.cos_light ||
                 got[k].pdf != want[k].pdf || got[k].solid_angle != want[k].solid_angle ||
                 got[k].irradiance != want[k].irradiance;
      }
      CHECK(other == 0);
    }
  }
}

TEST_CASE("SIMD samples of area lights of any size are those of their proportions") {
  ForEachTarget([](Target) {
    CheckScales(SphereLights());
    CheckScales(RectangleLights());
    CheckScales(TriangleLights());
    CheckScales(DiskLights());
  });
}

TEST_CASE("SIMD finds no sample where there is none, and nothing is ever not finite") {
  ForEachTarget([&](Target) {
    const auto inverse_pdf = [](const auto& light) {
      const LightAnswer answer = AskLights({{light, 0.3f, 0.6f, {0, 0, 1}}})[0];
      const AreaSample<float>& s = answer.sample;
      CHECK(std::isfinite(s.to_light.length() + s.distance + s.cos_light + answer.pdf));
      return s.inverse_pdf;
    };
    CHECK(inverse_pdf(RectangleLight<float>{{-1, -1, 0}, {2, 0, 0}, {0, 2, 0}}) == 0);
    CHECK(inverse_pdf(RectangleLight<float>{{3, 4, 0}, {2, 0, 0}, {0, 2, 0}}) == 0);
    CHECK(inverse_pdf(RectangleLight<float>{{3, 4, 5}, {0, 0, 0}, {0, 2, 0}}) == 0);
    CHECK(inverse_pdf(TriangleLight<float>{{-1, -1, 0}, {2, 0, 0}, {0, 9, 0}}) == 0);
    CHECK(inverse_pdf(TriangleLight<float>{{0, 0, 0}, {2, 0, 0}, {0, 9, 0}}) == 0);
    CHECK(inverse_pdf(DiskLight<float>{{0.5f, 0, 0}, {0, 0, 1}, 1}) == 0);
    CHECK(inverse_pdf(DiskLight<float>{{0, 0, 1}, {0, 0, 1}, 0}) == 0);
    CHECK(inverse_pdf(SphereLight<float>{{0, 0, 1}, 0}) == 0);
    CHECK(inverse_pdf(SphereLight<float>{{0, 0, 0}, 0}) == 0);
    CHECK(inverse_pdf(SphereLight<float>{{0, 0, 1}, 1}) == 6.28318531f);
    CHECK(inverse_pdf(SphereLight<float>{{0, 0, 0}, 1}) == 2 * 6.28318531f);
    // From beside the corner of one that fills a quadrant of the plane: pi / 6. The rectangle's
    // squares leave float's range with 1e-10 and 1e10; then there is no light, and nothing else.
    const auto quadrant = [](auto light, float near, float far) {
      light.corner = {near, near, near};
      light.edge_x = {far, 0, 0};
      light.edge_y = {0, far, 0};
      return light;
    };
    const double sixth = M_PI / 6;
    CHECK(inverse_pdf(quadrant(RectangleLight<float>(), 1e-8f, 1e8f)) ==
          Approx(sixth).epsilon(1e-5));
    CHECK(inverse_pdf(quadrant(TriangleLight<float>(), 1e-8f, 1e8f)) ==
          Approx(sixth).epsilon(1e-5));
    CHECK(inverse_pdf(quadrant(RectangleLight<float>(), 1e-10f, 1e10f)) == 0);
    CHECK(inverse_pdf(quadrant(TriangleLight<float>(), 1e-10f, 1e10f)) ==
          Approx(sixth).epsilon(1e-5));
  });
}

}  // namespace
}  // namespace nacre
