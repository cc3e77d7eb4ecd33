// SPDX-License-Identifier: Apache-2.0
// tests/light/area_fuzz_test.cc: area lights of any shape anywhere, also degenerate ones and the
// shaded point in, on and through them: samples, pdfs and irradiance stay finite and in range.
#include <cmath>
#include <random>
#include <sstream>

#include "catch.h"
#include "light/area_kernel.h"
#include "targets.h"

namespace nacre {
namespace {

class Draws {
 public:
  float Number() {
    constexpr float kSpecial[] = {0, 0, 1, -1, 0.5f, 1e-6f, -1e-6f, 1e-3f, 1e3f, -1e3f, 1e6f};
    const auto choice = static_cast<size_t>(random_() % 16);
    return choice < std::size(kSpecial) ? kSpecial[choice] : 4 * unit_(random_) - 2;
  }
  float Positive() { return std::abs(Number()); }
  Vec3f Vector() {
    const float x = Number(), y = Number(), z = Number();
    return {x, y, z};
  }
  Vec3f Direction() {
    const auto v = Vec3d(Vector());
    return v.length() > 0 ? Vec3f(v.normalized()) : Vec3f(0, 1, 0);
  }
  // Perpendicular to `edge` to float's rounding, of any length.
  Vec3f Across(const Vec3f& edge) {
    const Vec3d cross = Vec3d(edge) % Vec3d(Vector());
    return cross.length() > 0 ? Vec3f(cross.normalized() * Positive()) : Vec3f(0);
  }
  float Unit() {
    constexpr float kSpecial[] = {0, 0.5f, 0.25f, 0x1.fffffep-1f};
    const auto choice = static_cast<size_t>(random_() % 8);
    return choice < std::size(kSpecial) ? kSpecial[choice] : unit_(random_);
  }

 private:
  std::mt19937 random_{1};
  std::uniform_real_distribution<float> unit_{0, 0x1.fffffep-1f};
};

// Checks what holds for every result; prints the query if it does not.
template <class Light>
void CheckInRange(const LightQuery<Light>& query, const LightAnswer& answer) {
  const AreaSample<float>& s = answer.sample;
  const bool finite = std::isfinite(s.to_light.length2()) && std::isfinite(s.distance) &&
                      std::isfinite(s.inverse_pdf) && std::isfinite(s.cos_light) &&
                      std::isfinite(answer.pdf) && std::isfinite(answer.irradiance);
  const bool is_unit = s.inverse_pdf == 0 || std::abs(s.to_light.length() - 1) <= 1e-5f;
  // If a triangle's area is all rounding error, the cosine has few digits.
  const bool in_range = s.inverse_pdf >= 0 && s.distance >= 0 && answer.pdf >= 0 &&
                        std::abs(s.cos_light) <= 1.001f && answer.irradiance >= 0 &&
                        answer.irradiance <= 3.1416f;
  if (finite && is_unit && in_range) return;
  UNSCOPED_INFO("u " << query.u0 << ' ' << query.u1 << " normal " << query.normal);
  FAIL("sample " << s.to_light << " distance " << s.distance << " inverse pdf " << s.inverse_pdf
                 << " cosine " << s.cos_light << " pdf " << answer.pdf << " irradiance "
                 << answer.irradiance);
}

constexpr int kDraws = 40000;

template <class Light, class MakeLight, class Describe>
void Fuzz(const MakeLight& make_light, const Describe& describe) {
  Draws draws;
  std::vector<LightQuery<Light>> queries;
  for (int i = 0; i < kDraws; ++i) {
    const Light light = make_light(&draws);
    const float u0 = draws.Unit(), u1 = draws.Unit();
    const Vec3f direction = draws.Direction(), normal = draws.Direction();
    queries.push_back({light, u0, u1, direction, normal});
  }
  ForEachTarget([&](Target) {
    const std::vector<LightAnswer> answers = AskLights(queries);
    for (size_t i = 0; i < queries.size(); ++i) {
      INFO(describe(queries[i].light));
      CheckInRange(queries[i], answers[i]);
    }
  });
}

std::string Text(const Vec3f& v) {
  std::ostringstream text;
  text.precision(9);
  text << v;
  return text.str();
}

TEST_CASE("spheres anywhere stay in range") {
  Fuzz<SphereLight<float>>(
      [](Draws* draws) {
        const Vec3f centre = draws->Vector();
        return SphereLight<float>{centre, draws->Positive()};
      },
      [](const SphereLight<float>& light) {
        return Text(light.centre) + " radius " + std::to_string(light.radius);
      });
}

TEST_CASE("rectangles anywhere stay in range") {
  Fuzz<RectangleLight<float>>(
      [](Draws* draws) {
        const Vec3f corner = draws->Vector(), edge = draws->Vector();
        return RectangleLight<float>{corner, edge, draws->Across(edge)};
      },
      [](const RectangleLight<float>& light) {
        return Text(light.corner) + Text(light.edge_x) + Text(light.edge_y);
      });
}

TEST_CASE("triangles anywhere stay in range") {
  Fuzz<TriangleLight<float>>(
      [](Draws* draws) {
        const Vec3f corner = draws->Vector(), edge = draws->Vector();
        return TriangleLight<float>{corner, edge, draws->Vector()};
      },
      [](const TriangleLight<float>& light) {
        return Text(light.corner) + Text(light.edge_x) + Text(light.edge_y);
      });
}

TEST_CASE("disks anywhere stay in range") {
  Fuzz<DiskLight<float>>(
      [](Draws* draws) {
        const Vec3f centre = draws->Vector(), normal = draws->Direction();
        return DiskLight<float>{centre, normal, draws->Positive()};
      },
      [](const DiskLight<float>& light) {
        return Text(light.centre) + Text(light.normal) + std::to_string(light.radius);
      });
}

}  // namespace
}  // namespace nacre
