// SPDX-License-Identifier: Apache-2.0
// tests/shading/one_sphere_test.cc: hits of one sphere under one point light, wherever the range
// of them begins and ends: they have the bits that they have among all, whatever is computed
// beside them, and nothing else is written.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <random>
#include <vector>

#include "base/float_mode.h"
#include "shading/model_twins.h"
#include "shading/prepare.h"
#include "shading/shade.h"
#include "shading/soa_at.h"
#include "targets.h"

namespace nacre {
namespace {

// More than a block of any kernel, and not a multiple of any vector.
constexpr size_t kSphereHits = 1000;

const Sphere kSphere{.center = {0, 0, -6}, .radius = 1, .material = {}};

struct Lit {
  HitBatch hits;
  Surface surface;
  ShadingLight light;
  LightBatch on_hits;
  size_t short_halves = 0, lobes = 0;  // lit hits with |l + v| < 1/2; with r.v > 0
};

// All over the visible half of the sphere, with a light at this angle from the viewer's side. Every
// fourth hit of the third quarter has a short half vector if the light is behind, and no other.
void MakeLit(double angle, Lit* lit) {
  const Vec3d from_center = Vec3d{std::sin(angle), 0, std::cos(angle)} * 30;
  const Vec3d position = kSphere.center + from_center;
  Light light{.kind = PointLight{.position = position, .intensity = {900, 800, 700}}};
  lit->light = PrepareLight(light, {0, 0, 0});
  REQUIRE(OffsetFromSpheres({&kSphere, 1}, {0, 0, 0}, &lit->light));
  lit->hits.count = kSphereHits;
  lit->hits.one_primitive = true;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (size_t i = 0; i < kSphereHits;) {
    const Vec3d n = Vec3d{uniform(random), uniform(random), uniform(random)}.normalized();
    const Vec3d hit = kSphere.center + n;
    const Vec3d v = -hit.normalized(), l = (position - hit).normalized();
    if ((n ^ v) <= 0) continue;
    const bool is_short = (l + v).length2() < 0.25;
    const bool is_third_quarter = kSphereHits / 2 <= i && i < kSphereHits * 3 / 4;
    const bool wants_short = angle > M_PI / 2 && is_third_quarter && i % 4 == 0;
    if (is_short != wants_short || (is_short && (n ^ l) <= 0)) continue;
    lit->short_halves += is_short;
    lit->lobes += (n ^ l) > 0 && 2 * (n ^ l) * (n ^ v) > (l ^ v);
    SetAt(i, n, &lit->hits.normal);
    SetAt(i, v, &lit->hits.to_view);
    SetAt(i, hit, &lit->hits.position);
    ++i;
  }
  PrepareSurface(lit->hits, &lit->surface);
}

// Where the limb is the edge of what the light reaches, too: n.v and n.l are both 0 but for some
// roundings, and n.u of what is lit may be below 0.
void MakeLimb(Lit* lit) {
  MakeLit(80 * M_PI / 180, lit);
  const Vec3d light = lit->light.position;
  std::mt19937 random(4);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (size_t i = 0; i < kSphereHits; ++i) {
    Vec3d n = Vec3d{0, i % 2 == 0 ? 1.0 : -1.0, 0};
    for (int step = 0; step < 50; ++step) {
      const Vec3d v = -(kSphere.center + n).normalized();
      n = (n - v * (n ^ v)).normalized();
      const Vec3d l = (light - (kSphere.center + n)).normalized();
      n = (n - l * ((n ^ l) - 3e-7 * uniform(random))).normalized();
    }
    SetAt(i, n, &lit->hits.normal);
    SetAt(i, -(kSphere.center + n).normalized(), &lit->hits.to_view);
    SetAt(i, kSphere.center + n, &lit->hits.position);
  }
  PrepareSurface(lit->hits, &lit->surface);
}

std::vector<ShadingMaterial> Materials() {
  std::vector<ShadingMaterial> materials;
  for (const Shadowing shadowing : {Shadowing::kSchlickDirect, Shadowing::kSchlickIbl,
                                    Shadowing::kSeparable, Shadowing::kHeightCorrelated}) {
    materials.push_back(
        Prepare(MetallicRoughnessMaterial{.base_color = {0.9, 0.5, 0.1},
                                          .metallic = 0.3,
                                          .roughness = 0.3,
                                          .shadowing = shadowing,
                                          .compensation = Compensation::kNone,
                                          .diffuse_coupling = DiffuseCoupling::kOneMinusFresnel}));
  }
  for (const PhongModel model : {PhongModel::kPhong, PhongModel::kModifiedPhong}) {
    // Next to 0 powers of nearly 0 are not 0 in float; the last has its lobes formed in double.
    for (const double shininess : {0.0, 1e-28, 1e-3, 1.0, 37.5, 2.0 * kDoubleTermsShininess}) {
      materials.push_back(Prepare(PhongMaterial{.model = model,
                                                .convention = PhongConvention::kClassic,
                                                .color = {0.9, 0.5, 0.1},
                                                .ka = {0, 0, 0},
                                                .kd = {0.7, 0.7, 0.7},
                                                .ks = {0.5, 0.6, 0.7},
                                                .shininess = shininess}));
    }
  }
  return materials;
}

std::array<uint32_t, 3> BitsAt(const Soa3<float>& soa, size_t i) {
  return {std::bit_cast<uint32_t>(soa.x[i]), std::bit_cast<uint32_t>(soa.y[i]),
          std::bit_cast<uint32_t>(soa.z[i])};
}

// `sum` rounds what is added to the diffuse part once, in place of the specular part and then their
// sum: half an ulp of the result, and of the specular part, is what they may differ by.
bool IsSumOf(float diffuse, float specular, float sum) {
  const double ulp = std::nextafter(std::max(specular, sum), INFINITY) - std::max(specular, sum);
  return std::abs(double{diffuse} + double{specular} - double{sum}) <= ulp;
}

// Of a range, in place and evaluated ahead, with components and without.
void CheckRange(const ShadingMaterial& material, const Lit& on, const ReflectedRadiance& all,
                size_t begin, size_t end) {
  constexpr float kUntouched = -7;
  for (const LightBatch* on_hits : {static_cast<const LightBatch*>(nullptr), &on.on_hits}) {
    for (const bool components : {false, true}) {
      CAPTURE(begin, end, on_hits == nullptr, components);
      ShadeScratch scratch;
      ReflectedRadiance part;
      for (size_t i = 0; i < kSphereHits; ++i) {
        for (Soa3<float>* soa : {&part.sum, &part.diffuse, &part.specular}) {
          SetAt(i, Vec3d(kUntouched), soa);
        }
      }
      ShadeRun({{material, on.hits, on.surface, begin, end}, on.light, on_hits, &part, components},
               &scratch);
      for (size_t i = 0; i < kSphereHits; ++i) {
        CAPTURE(i);
        const bool inside = begin <= i && i < end;
        if (inside) REQUIRE(BitsAt(part.sum, i) == BitsAt(all.sum, i));
        if (!inside) REQUIRE(ColorAt(part.sum, i) == Rgb(kUntouched));
        if (inside && components) {
          REQUIRE(BitsAt(part.diffuse, i) == BitsAt(all.diffuse, i));
          REQUIRE(BitsAt(part.specular, i) == BitsAt(all.specular, i));
          REQUIRE(IsSumOf(part.diffuse.x[i], part.specular.x[i], part.sum.x[i]));
          REQUIRE(IsSumOf(part.diffuse.y[i], part.specular.y[i], part.sum.y[i]));
          REQUIRE(IsSumOf(part.diffuse.z[i], part.specular.z[i], part.sum.z[i]));
        } else {
          REQUIRE(ColorAt(part.diffuse, i) == Rgb(kUntouched));
          REQUIRE(ColorAt(part.specular, i) == Rgb(kUntouched));
        }
      }
    }
  }
}

TEST_CASE("a range of hits has the bits that it has among all, and no others are written") {
  const FlushDenormals flush;
  // Light beside the viewer, and so far behind that some lit hits have |l + v| < 1/2, where half
  // vectors are formed with more care.
  const double degree = M_PI / 180;
  Lit front, limb, behind;
  MakeLit(30 * degree, &front);
  MakeLimb(&limb);
  MakeLit(180 * degree - 0.65, &behind);
  REQUIRE(front.short_halves == 0);
  REQUIRE(front.lobes > kSphereHits / 4);
  REQUIRE(front.lobes < kSphereHits);
  REQUIRE(behind.short_halves > kSphereHits / 20);
  ForEachTarget([&](Target) {
    for (Lit* on : {&front, &limb, &behind}) {
      EvaluateLight(on->light, on->hits, on->surface, &on->on_hits);
    }
    for (const ShadingMaterial& material : Materials()) {
      for (const Lit* on : {&front, &limb, &behind}) {
        ShadeScratch scratch;
        ReflectedRadiance all;
        ShadeRun({{material, on->hits, on->surface, 0, kSphereHits}, on->light, &on->on_hits, &all},
                 &scratch);
        CheckRange(material, *on, all, 77, 900);
        CheckRange(material, *on, all, 700, 701);
      }
    }
  });
}

}  // namespace
}  // namespace nacre
