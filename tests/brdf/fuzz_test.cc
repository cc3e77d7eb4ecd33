// SPDX-License-Identifier: Apache-2.0
// tests/brdf/fuzz_test.cc: the fuzz lobe against tables of its distribution, of random walks
// through the fibres and of another renderer, its integrals, limits and sampler, and the SIMD
// twins.
#include "brdf/fuzz.h"

#include <cmath>
#include <limits>
#include <random>

#include "brdf/layer_kernel.h"
#include "brdf/quadrature.h"
#include "catch.h"
#include "chi_squared.h"
#include "tables.h"
#include "targets.h"

namespace nacre {
namespace {

const Vec3d kNormal(0, 0, 1);

Vec3d DirectionAt(double cos, double phi) {
  const double sin = std::sqrt((1 - cos) * (1 + cos));
  return {sin * std::cos(phi), sin * std::sin(phi), cos};
}

FuzzView<double> ViewOf(double roughness, double n_dot_v) {
  return FuzzFromView(MakeFuzz(roughness), n_dot_v);
}

TEST_CASE("the fuzz lobe's distribution is that of the table", "[table]") {
  const nlohmann::json table = LoadTable("fuzz");
  CHECK(table.at("distribution").size() >= 100);
  for (const auto& row : table.at("distribution")) {
    const double n_dot_l = TableNumber(row["n_dot_l"]), n_dot_v = TableNumber(row["n_dot_v"]);
    CAPTURE(row["a"], row["tilt"], n_dot_l, n_dot_v, row["phi"]);
    const FuzzView<double> view{0.5, TableNumber(row["a"]), TableNumber(row["tilt"])};
    const Vec3d l = DirectionAt(n_dot_l, TableNumber(row["phi"])), v = DirectionAt(n_dot_v, 0);
    const Angles<double> angles = ComputeAngles(kNormal, l, v);
    const double want = TableNumber(row["D"]), cond = TableNumber(row["cond"]);
    CHECK(PassesConditionedRule(FuzzPdf(view, angles), want, cond, kHalfUlpDouble));
    CHECK(
        PassesConditionedRule(FuzzLobe(view, angles) * n_dot_l, 0.5 * want, cond, kHalfUlpDouble));
  }
}

TEST_CASE("fuzz reflects as much light as random walks through its fibres", "[table]") {
  const nlohmann::json table = LoadTable("fuzz");
  CHECK(table.at("walks").size() >= 20);
  for (const auto& row : table.at("walks")) {
    const double roughness = row["roughness"], n_dot_v = row["n_dot_v"];
    CAPTURE(roughness, n_dot_v);
    // The fit's worst error, and three standard errors of the walks.
    const double error = (roughness < 0.06 ? 0.013 : 0.006) + 0.0018;
    CHECK(std::abs(FuzzAlbedo(MakeFuzz(roughness), n_dot_v) - double{row["R"]}) <= error);
  }
}

TEST_CASE("fuzz is that of OpenPBR's reference implementation", "[table]") {
  const nlohmann::json table = LoadTable("fuzz_openpbr");
  CHECK(table.at("rows").size() >= 30);
  for (const auto& row : table.at("rows")) {
    const auto at = [&](size_t i) { return row[i].get<double>(); };
    const double weight = at(0), roughness = at(4);
    const Vec3d color(at(1), at(2), at(3)), v(at(5), at(6), at(7)), l(at(8), at(9), at(10));
    CAPTURE(roughness, v.z, l.z);
    const FuzzView<double> view = ViewOf(roughness, v.z);
    CHECK(std::abs(1 - weight * view.albedo - at(14)) <= 0.0056 * weight);
    const double lobe = FuzzLobe(view, ComputeAngles(kNormal, l, v)) * l.z;
    // Below a roughness of 0.25 the table of the reference is too coarse for what it interpolates.
    for (int channel = 0; channel < 3; ++channel) {
      const double want = at(11 + static_cast<size_t>(channel));
      const double error = 0.002 * weight * color[channel] + (roughness < 0.25 ? 0.16 * want : 0);
      CHECK(std::abs(weight * color[channel] * lobe - want) <= error);
    }
  }
}

const double kRoughnesses[] = {0, 0.01, 0.02, 0.05, 0.1, 0.2, 0.3, 0.45, 0.6, 0.8, 0.95, 1};
const double kCosines[] = {0, 1e-5, 1e-3, 0.01, 0.03, 0.1, 0.2, 0.4, 0.6, 0.8, 0.95, 1 - 1e-9, 1};

// The n.l below which a fraction q of D would be without a tilt, and d(n.l) / dq times n.l.
struct Elevation {
  double n_dot_l, slope;
};
Elevation ElevationAt(double a, double q) {
  const double below = 1 - q + q * a * a;
  return {a * std::sqrt(q / below), a * a / (2 * below * below)};
}

constexpr int kRings = 12, kSectors = 16;

// The integrals of a function of the direction to light, times n.l, over rings and sectors about
// the normal that D fills evenly but for its tilt.
template <class Function>
std::vector<double> IntegrateCells(double a, const Function& f) {
  const QuadratureRule& rule = GaussLegendre(8);
  std::vector<double> integrals;
  for (int ring = 0; ring < kRings; ++ring) {
    for (int sector = 0; sector < kSectors; ++sector) {
      double sum = 0;
      for (size_t i = 0; i < rule.x.size(); ++i) {
        const Elevation at = ElevationAt(a, (ring + rule.x[i]) / kRings);
        for (size_t j = 0; j < rule.x.size(); ++j) {
          const double phi = 2 * M_PI * (sector + rule.x[j]) / kSectors;
          sum += rule.w[i] * rule.w[j] * at.slope * f(DirectionAt(at.n_dot_l, phi));
        }
      }
      integrals.push_back(sum * 2 * M_PI / (kRings * kSectors));
    }
  }
  return integrals;
}

double Sum(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return sum;
}

TEST_CASE("fuzz over white reflects exactly all light") {
  for (const double roughness : kRoughnesses) {
    const Fuzz<double> fuzz = MakeFuzz(roughness);
    for (const double n_dot_v : kCosines) {
      CAPTURE(roughness, n_dot_v);
      const FuzzView<double> view = FuzzFromView(fuzz, n_dot_v);
      const Vec3d v = DirectionAt(n_dot_v, 0.7);
      const double albedo = Sum(IntegrateCells(
          view.a, [&](const Vec3d& l) { return FuzzLobe(view, ComputeAngles(kNormal, l, v)); }));
      CHECK(albedo == Approx(FuzzAlbedo(fuzz, n_dot_v)).epsilon(1e-9));
      CHECK(albedo + (1 - view.albedo) == Approx(1).epsilon(1e-9));
    }
  }
}

TEST_CASE("the fuzz lobe's parameters are within their bounds everywhere") {
  double least_a = 1, most_a = 0, least_tilt = 0, most_tilt = -1, most_albedo = 0;
  for (int i = 0; i <= 300; ++i) {
    const Fuzz<double> fuzz = MakeFuzz(i / 300.0);
    for (int j = 0; j <= 300; ++j) {
      const FuzzView<double> view = FuzzFromView(fuzz, std::pow(j / 300.0, 4));
      least_a = std::min(least_a, view.a);
      most_a = std::max(most_a, view.a);
      least_tilt = std::min(least_tilt, view.tilt);
      most_tilt = std::max(most_tilt, view.tilt);
      most_albedo = std::max(most_albedo, view.albedo);
      // Written so that it fails for what is not a number.
      if (!(view.albedo >= 0)) FAIL("albedo");
    }
  }
  CHECK(least_a >= 5e-5);
  CHECK(most_a <= 1);
  CHECK(least_tilt >= -0.2);
  CHECK(most_tilt <= 0.1);
  CHECK(most_albedo <= 0.95);
}

TEST_CASE("the fuzz lobe has limits: smooth and wide fibres, grazing directions, the normal") {
  // What is less rough than kLeastFuzzRoughness counts as that rough.
  for (const double roughness : {0.0, 1e-300, 1e-9, 0.0099}) {
    for (const double n_dot_v : kCosines) {
      const FuzzView<double> got = ViewOf(roughness, n_dot_v), want = ViewOf(0.01, n_dot_v);
      CHECK(got.albedo == want.albedo);
      CHECK(got.a == want.a);
      CHECK(got.tilt == want.tilt);
    }
    CHECK(FuzzAlbedo(MakeFuzz(roughness), 0.1) < 1e-4);
  }
  for (const double roughness : kRoughnesses) {
    const Fuzz<double> fuzz = MakeFuzz(roughness);
    CAPTURE(roughness);
    // Seen along the normal, and with fibres as wide as long, it is the same at all azimuths.
    const Vec3d l = DirectionAt(0.3, 0), turned = DirectionAt(0.3, 2);
    const FuzzView<double> along = FuzzFromView(fuzz, 1.0);
    const double above = FuzzPdf(along, ComputeAngles(kNormal, l, kNormal));
    CHECK(FuzzPdf(along, ComputeAngles(kNormal, turned, kNormal)) == Approx(above).epsilon(1e-14));
    const Vec3d close = DirectionAt(std::cos(1e-9), 1);
    CHECK(FuzzPdf(FuzzFromView(fuzz, close.z), ComputeAngles(kNormal, l, close)) ==
          Approx(above).epsilon(1e-7));
    if (roughness == 1) {
      CHECK(FuzzFromView(fuzz, 0.2).tilt == 0);
    }
    // Viewers in the surface's plane, and beyond it, where n.v counts as 0.
    for (const double n_dot_v : {0.0, -1e-20, -0.3, -1.0}) {
      const FuzzView<double> view = FuzzFromView(fuzz, n_dot_v);
      CHECK(view.albedo == FuzzAlbedo(fuzz, 0.0));
      const Vec3d v = DirectionAt(n_dot_v, 0);
      CHECK(Sum(IntegrateCells(view.a, [&](const Vec3d& light) {
              return FuzzDistribution(view, ComputeAngles(kNormal, light, v));
            })) == Approx(1).epsilon(1e-9));
      // Of grazing light the BRDF has a limit, which is 1 / pi a^2 times R; none comes from below.
      const double limit = view.albedo / (M_PI * view.a * view.a);
      for (const double n_dot_l : {1e-10, 1e-100, 1e-320}) {
        const Angles<double> a = ComputeAngles(kNormal, DirectionAt(n_dot_l, 1), v);
        CHECK(FuzzLobe(view, a) == Approx(limit).epsilon(1e-6));
      }
      for (const double n_dot_l : {0.0, -1e-320, -0.5, -1.0}) {
        const Angles<double> a = ComputeAngles(kNormal, DirectionAt(n_dot_l, 1), v);
        CHECK(FuzzLobe(view, a) == 0);
        CHECK(FuzzPdf(view, a) == 0);
      }
    }
  }
}

TEST_CASE("the fuzz lobe is sampled with its pdf, above the surface") {
  constexpr int kSamples = 40000;
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(0, 1);
  // About another normal, and from both sides of it.
  const Vec3d normal = Vec3d(1, -2, -1).normalized();
  const Basis<double> basis = BasisAbout(normal);
  for (const double roughness : {0.01, 0.1, 0.3, 0.6, 1.0}) {
    for (const double n_dot_v : {-0.2, 0.0, 0.02, 0.3, 1.0}) {
      CAPTURE(roughness, n_dot_v);
      const FuzzView<double> view = ViewOf(roughness, n_dot_v);
      const Vec3d v = basis.ToWorld(DirectionAt(n_dot_v, 0.4));
      const std::vector<double> probabilities = IntegrateCells(view.a, [&](const Vec3d& local) {
        const Vec3d l = basis.ToWorld(local);
        return FuzzPdf(view, ComputeAngles(normal, l, v)) / (normal ^ l);
      });
      CHECK(Sum(probabilities) == Approx(1).epsilon(1e-9));
      std::vector<double> counts(probabilities.size());
      for (int i = 0; i < kSamples; ++i) {
        const double u0 = unit(random), u1 = unit(random);
        const Vec3d world = SampleFuzz(normal, v, view, u0, u1);
        const Vec3d l = basis.ToLocal(world);
        if (std::abs(l.length() - 1) > 1e-12) FAIL("length");
        if (!(l.z > 0)) FAIL("below");
        // The inverse of ElevationAt.
        const double across2 = view.a * view.a * (l.x * l.x + l.y * l.y);
        const double q = l.z * l.z / (across2 + l.z * l.z);
        const double turns = std::atan2(l.y, l.x) / (2 * M_PI);
        const int ring = std::min(static_cast<int>(q * kRings), kRings - 1);
        const int sector =
            std::min(static_cast<int>((turns < 0 ? turns + 1 : turns) * kSectors), kSectors - 1);
        counts[static_cast<size_t>(ring * kSectors + sector)] += 1;
      }
      CHECK(FollowsProbabilities(counts, kSamples, probabilities));
    }
  }
}

template <typename T>
std::vector<LayerQuery<T>> Queries() {
  std::mt19937 random(6);
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<LayerQuery<T>> queries;
  const auto add = [&](const Vec3d& l, const Vec3d& v, double roughness) {
    LayerQuery<T> q;
    q.n = Imath::Vec3<T>(kNormal);
    q.l = Imath::Vec3<T>(l);
    q.v = Imath::Vec3<T>(v);
    q.roughness = static_cast<T>(roughness);
    queries.push_back(q);
  };
  for (int i = 0; i < 8000; ++i) {
    // Some from below.
    add(DirectionAt(std::pow(unit(random), 3) - 0.1, 6 * unit(random)),
        DirectionAt(std::pow(unit(random), 3) - 0.1, 6 * unit(random)), unit(random));
  }
  for (const double n_dot_l : {0.0, 1e-38, 1e-20, 1e-5, 0.5, 1.0}) {
    for (const double n_dot_v : {-1.0, 0.0, 1e-38, 1e-30, 1e-5, 0.5, 1.0}) {
      for (const double roughness : {0.0, 1e-38, 9e-7, 1e-3, 0.01, 0.5, 1.0}) {
        add(DirectionAt(n_dot_l, 1), DirectionAt(n_dot_v, 0), roughness);
      }
    }
  }
  return queries;
}

template <typename T>
void CheckTwins(RoughnessOf roughness_of, double unit_roundoff) {
  std::vector<LayerQuery<T>> queries = Queries<T>();
  if (roughness_of == RoughnessOf::kFirst) {
    for (auto& query : queries) query.roughness = static_cast<T>(0.37);
  }
  const std::vector<LayerAnswer<T>> answers = EvaluateLayers(roughness_of, queries);
  double albedo = 0, a_error = 0, tilt = 0, lobe = 0;
  for (size_t i = 0; i < queries.size(); ++i) {
    const LayerQuery<T>& q = queries[i];
    const LayerAnswer<T>& got = answers[i];
    for (const T number : {got.fuzz_albedo, got.fuzz_a, got.fuzz, got.fuzz_pdf}) {
      if (!(number >= 0) || !std::isfinite(number)) FAIL("number of query " << i);
    }
    const Angles<double> a = ComputeAngles(Vec3d(q.n), Vec3d(q.l), Vec3d(q.v));
    const FuzzView<double> view = ViewOf(double{q.roughness}, a.n_dot_v);
    albedo = std::max(albedo, std::abs(got.fuzz_albedo - view.albedo));
    a_error = std::max(a_error, std::abs(got.fuzz_a / view.a - 1));
    tilt = std::max(tilt, std::abs(got.fuzz_tilt - view.tilt));
    // With the twin's own parameters, whose errors are judged above.
    const FuzzView<double> own{got.fuzz_albedo, got.fuzz_a, got.fuzz_tilt};
    const double want = FuzzLobe(own, a), pdf = FuzzPdf(own, a);
    if (want == 0) CHECK(got.fuzz == 0);
    if (pdf == 0) CHECK(got.fuzz_pdf == 0);
    if (want > 1e-30) lobe = std::max(lobe, std::abs(got.fuzz / want - 1));
    if (pdf > 1e-30) lobe = std::max(lobe, std::abs(got.fuzz_pdf / pdf - 1));
  }
  // Of polynomials whose coefficients sum to some hundreds; the exponentials hold these errors
  // relative to their values.
  CHECK(albedo <= 256 * unit_roundoff);
  CHECK(a_error <= 256 * unit_roundoff);
  CHECK(tilt <= 96 * unit_roundoff);
  CHECK(lobe <= 64 * unit_roundoff);
}

TEST_CASE("SIMD fuzz is its double twin on every target, in floats and in doubles") {
  ForEachTarget([](Target) {
    for (const RoughnessOf roughness_of : {RoughnessOf::kEach, RoughnessOf::kFirst}) {
      CheckTwins<float>(roughness_of, kHalfUlpFloat);
      CheckTwins<double>(roughness_of, kHalfUlpDouble);
    }
  });
}

}  // namespace
}  // namespace nacre
