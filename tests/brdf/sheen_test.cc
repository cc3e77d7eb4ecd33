// SPDX-License-Identifier: Apache-2.0
// tests/brdf/sheen_test.cc: Charlie's lobe against a table and its own integrals, its limits at
// grazing angles and small roughnesses, white furnaces, its sampler, and the SIMD twins.
#include "brdf/sheen.h"

#include <cmath>
#include <limits>
#include <random>

#include "brdf/layer_kernel.h"
#include "brdf/lobe_sampling.h"
#include "brdf/quadrature.h"
#include "catch.h"
#include "tables.h"
#include "targets.h"

namespace nacre {
namespace {

const Vec3d kNormal(0, 0, 1);

Vec3d DirectionAt(double cos, double phi) {
  const double sin = std::sqrt((1 - cos) * (1 + cos));
  return {sin * std::cos(phi), sin * std::sin(phi), cos};
}

double Lobe(double roughness, const Vec3d& l, const Vec3d& v) {
  return CharlieLobe(MakeCharlie(roughness), ComputeAngles(kNormal, l, v));
}

TEST_CASE("Charlie's distribution and lobe are those of the table", "[table]") {
  const nlohmann::json table = LoadTable("charlie");
  size_t rows = 0;
  for (const auto& row : table.at("lobe")) {
    const double roughness = TableNumber(row["roughness"]), cond = TableNumber(row["cond"]);
    const double n_dot_l = TableNumber(row["n_dot_l"]), n_dot_v = TableNumber(row["n_dot_v"]);
    CAPTURE(roughness, n_dot_l, n_dot_v, row["phi"], cond);
    const Vec3d l = DirectionAt(n_dot_l, TableNumber(row["phi"])), v = DirectionAt(n_dot_v, 0);
    const Angles<double> a = ComputeAngles(kNormal, l, v);
    const double d = CharlieDistribution(a, roughness * roughness);
    CHECK(PassesConditionedRule(d, TableNumber(row["D"]), cond, kHalfUlpDouble));
    CHECK(
        PassesConditionedRule(Lobe(roughness, l, v), TableNumber(row["DV"]), cond, kHalfUlpDouble));
    ++rows;
  }
  CHECK(rows > 80);
}

// Gauss-Legendre panels on [0, end] that double from `finest` and end at each of `breaks`.
std::vector<std::pair<double, double>> Panels(double finest, const std::vector<double>& breaks) {
  const QuadratureRule& rule = GaussLegendre(10);
  std::vector<std::pair<double, double>> nodes;
  double begin = 0;
  double end = finest;
  for (const double at : breaks) {
    while (begin < at) {
      if (end > 0.7 * at) end = at;
      for (size_t i = 0; i < rule.x.size(); ++i) {
        nodes.emplace_back(begin + (end - begin) * rule.x[i], (end - begin) * rule.w[i]);
      }
      begin = end;
      end *= 2;
    }
  }
  return nodes;
}

// Light from one elevation, all azimuths.
struct Ring {
  double n_dot_l;
  double weight;  // of d(n.l)
  double lobe;    // int D V n.l dphi
};

std::vector<Ring> MakeRings(double roughness, double n_dot_v) {
  const Charlie<double> charlie = MakeCharlie(roughness);
  const Vec3d v = DirectionAt(n_dot_v, 0);
  const double finest = std::min(roughness, std::max(n_dot_v, 1e-9)) / 32;
  // The fit of Lambda bends at 1/2; from 1 on x Lambda(x) falls to nearly 0 within a thousandth.
  std::vector<std::pair<double, double>> cosines = Panels(finest, {kLeastCharlieCosine, 0.5});
  for (const auto& [x, weight] : Panels(1e-6, {0.5})) cosines.emplace_back(1 - x, weight);
  std::vector<Ring> rings;
  for (const auto& [n_dot_l, weight] : cosines) {
    // From the plane opposite the viewer, where half vectors turn to the normal.
    double sum = 0;
    for (const auto& [phi, phi_weight] : Panels(1e-6, {M_PI})) {
      const Angles<double> a = ComputeAngles(kNormal, DirectionAt(n_dot_l, M_PI - phi), v);
      sum += 2 * phi_weight * CharlieDistribution(a, charlie.alpha);
    }
    const double visibility =
        CharlieVisibility(n_dot_l, n_dot_v, CharlieCosineLambda(charlie, n_dot_l),
                          CharlieCosineLambda(charlie, n_dot_v));
    rings.push_back({n_dot_l, weight, sum * visibility * n_dot_l});
  }
  return rings;
}

double Albedo(const std::vector<Ring>& rings) {
  double sum = 0;
  for (const Ring& ring : rings) sum += ring.weight * ring.lobe;
  return sum;
}

const double kRoughnesses[] = {1e-3, 0.01, 0.03, 0.07, 0.1, 0.2, 0.3, 0.4, 0.5, 0.65, 0.8, 1};
const double kCosines[] = {0, 1e-5, 1e-3, 0.01, 0.03, 0.1, 0.2, 0.3, 0.45, 0.6, 0.75, 0.9, 1};

TEST_CASE("Charlie's albedo is that of the table, and its fit within 1.6e-3", "[table]") {
  const nlohmann::json table = LoadTable("charlie");
  CHECK(table.at("albedo").size() >= 16);
  for (const auto& row : table.at("albedo")) {
    const double roughness = TableNumber(row["roughness"]), n_dot_v = TableNumber(row["n_dot_v"]);
    CAPTURE(roughness, n_dot_v);
    CHECK(Albedo(MakeRings(roughness, n_dot_v)) == Approx(TableNumber(row["E"])).margin(1e-7));
  }
  double worst = 0;
  for (const double roughness : kRoughnesses) {
    for (const double n_dot_v : kCosines) {
      const double e = Albedo(MakeRings(roughness, n_dot_v));
      const double fit = CharlieAlbedo(MakeCharlie(roughness), n_dot_v);
      worst = std::max(worst, std::abs(fit - e) / std::max(e, 1.0));
    }
  }
  CHECK(worst <= 1.6e-3);
  // Where both the lobe's width and the least cosine of Lambda bend it.
  const double e = Albedo(MakeRings(6.14e-5, 2.64e-4));
  CHECK(CharlieAlbedo(MakeCharlie(6.14e-5), 2.64e-4) == Approx(e).epsilon(2.1e-3));
}

TEST_CASE("Charlie's distribution covers the surface once") {
  // int D n.h dh = 1, over the half vector's elevation.
  for (const double roughness : kRoughnesses) {
    double sum = 0;
    for (const auto& [elevation, weight] : Panels(roughness / 8, {M_PI_2})) {
      // Light and viewer both along the half vector.
      const Vec3d h(std::cos(elevation), 0, std::sin(elevation));
      sum += weight * 2 * M_PI * h.x * h.z *
             CharlieDistribution(ComputeAngles(kNormal, h, h), roughness * roughness);
    }
    CHECK(sum == Approx(1).epsilon(1e-7));  // the rule's error
  }
}

TEST_CASE("x Lambda(x) is the published one, and where that falls to 0 keeps its largest value") {
  for (const double roughness : kRoughnesses) {
    const Charlie<double> charlie = MakeCharlie(roughness);
    const auto published = [&](double x) {
      return x * std::exp(charlie.a / (1 + charlie.b * std::pow(x, charlie.c)) + charlie.d * x +
                          charlie.e);
    };
    double largest = 0;
    for (double x = 1e-12; x < 0.01; x *= 1.01) largest = std::max(largest, published(x));
    const double kept = CharlieCosineLambda(charlie, 0.0);
    CHECK(kept <= largest);
    CHECK(kept >= 0.99 * largest);
    CHECK(CharlieCosineLambda(charlie, 1e-6) == kept);
    CHECK(CharlieCosineLambda(charlie, 1e-4) == Approx(published(1e-4)).epsilon(1e-13));
    CHECK(CharlieCosineLambda(charlie, 0.49) == Approx(published(0.49)).epsilon(1e-13));
    // Mirrored about (1/2, log(Lambda(1/2))).
    const double half = published(0.5) / 0.5;
    CHECK(CharlieCosineLambda(charlie, 0.7) ==
          Approx(0.7 * half * half / (published(0.3) / 0.3)).epsilon(1e-13));
  }
}

TEST_CASE("sheen is finite, reciprocal, and dark below the surface") {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int i = 0; i < 20000; ++i) {
    const double roughness = std::pow(unit(random), 3);
    const Charlie<double> charlie = MakeCharlie(roughness);
    const Vec3d l = DirectionAt(std::pow(unit(random), 8), 6 * unit(random));
    const Vec3d v = DirectionAt(std::pow(unit(random), 8), 6 * unit(random));
    const double value = CharlieLobe(charlie, ComputeAngles(kNormal, l, v));
    if (!std::isfinite(value) || value < 0) FAIL("not finite");
    const double other = CharlieLobe(charlie, ComputeAngles(kNormal, v, l));
    // Angles of both orders differ by roundings, which the exponent of sin multiplies.
    if (std::abs(value - other) > (1e-14 + 1e-15 / charlie.alpha) * value) FAIL("not reciprocal");
    if (CharlieLobe(charlie, ComputeAngles(kNormal, -l, v)) != 0) FAIL("light from below");
    if (CharlieLobe(charlie, ComputeAngles(kNormal, l, -v)) != 0) FAIL("seen from below");
  }
  // In the surface's plane what reaches the viewer, D V n.l, has a limit.
  for (const double roughness : {1e-5, 0.1, 1.0}) {
    const Vec3d plane = DirectionAt(0, 0);
    double before = 0;
    for (const double n_dot_l : {1e-7, 1e-9, 1e-15, 1e-30, 1e-150}) {
      const Vec3d l(1, 0, n_dot_l);
      const double reflected = Lobe(roughness, l, plane) * n_dot_l;
      CHECK(std::isfinite(reflected));
      if (n_dot_l < 1e-7) CHECK(reflected == Approx(before).epsilon(1e-2));
      before = reflected;
    }
  }
}

TEST_CASE("the limit of sheen at roughness 0 is none") {
  const Vec3d l = DirectionAt(0.01, 1), v = DirectionAt(0.02, 0.5);
  double before = std::numeric_limits<double>::infinity();
  for (const double roughness : {0.01, 0.003, 1e-3, 3e-4}) {
    const double value = Lobe(roughness, l, v);
    CHECK(value < before / 2);
    before = value;
    CHECK(CharlieAlbedo(MakeCharlie(roughness), 0.05) < 0.1);
  }
  for (const double roughness : {0.0, 1e-300, 1e-160, 1e-20, 9e-7}) {
    const Charlie<double> charlie = MakeCharlie(roughness);
    for (const double n_dot_v : {1.0, 0.1, 1e-7, 1e-200, 0.0}) {
      CHECK(Lobe(roughness, DirectionAt(1e-9, 1), DirectionAt(n_dot_v, 0)) == 0);
      CHECK(CharlieAlbedo(charlie, n_dot_v) == 0);
    }
    const SheenScale<double> scale =
        ScaleSheen(1.0, CharlieAlbedo(charlie, 0.0), CharlieAlbedo(charlie, 0.0));
    CHECK(scale.below == 1);
    CHECK(scale.lobe == 1);
  }
  CHECK(CharliePdf(0.3, 0.0) == 0);
}

// What is reflected of uniform light: by the sheen, and by a white surface below.
struct Furnace {
  double sheen = 0, below = 0;
};

Furnace MakeFurnace(double roughness, double n_dot_v, double channel) {
  const Charlie<double> charlie = MakeCharlie(roughness);
  const double albedo_v = CharlieAlbedo(charlie, n_dot_v);
  Furnace furnace;
  for (const Ring& ring : MakeRings(roughness, n_dot_v)) {
    const auto scale = ScaleSheen(channel, albedo_v, CharlieAlbedo(charlie, ring.n_dot_l));
    furnace.sheen += ring.weight * channel * ring.lobe * scale.lobe;
    furnace.below += ring.weight * 2 * ring.n_dot_l * scale.below;
  }
  return furnace;
}

TEST_CASE("sheen over white reflects no more than all light") {
  double most = 0, least = 1;
  for (const double roughness : kRoughnesses) {
    for (const double n_dot_v : kCosines) {
      for (const double channel : {1.0, 0.5, 0.1, 0.0}) {
        CAPTURE(roughness, n_dot_v, channel);
        const Furnace got = MakeFurnace(roughness, n_dot_v, channel);
        const double sum = got.sheen + got.below;
        CHECK(got.sheen <= 1 + 1.6e-3);  // the fit's error
        CHECK(sum <= 1 + 1.6e-3);
        if (channel == 0) CHECK(sum == Approx(1).epsilon(1e-12));
        most = std::max(most, sum);
        if (roughness >= 0.2) least = std::min(least, sum);
      }
    }
  }
  CHECK(most >= 1);
  // The loss by taking the smaller of both scales, where grazing light meets other view directions.
  CHECK(least >= 0.85);
}

TEST_CASE("where sheen of this colour would not exceed the light, it is unscaled") {
  const SheenScale<double> some = ScaleSheen(0.5, 0.6, 1.2);
  CHECK(some.lobe == 1);
  CHECK(some.below == Approx(1 - 0.5 * 1.2).epsilon(1e-15));
  const SheenScale<double> more = ScaleSheen(1.0, 0.6, 1.25);
  CHECK(more.lobe == Approx(0.8).epsilon(1e-15));
  CHECK(more.below == 0);
}

TEST_CASE("Charlie's samples are above the surface and give its albedo with little variance") {
  // What the header's table promises, at n.v = 0.1 and 0.6.
  const struct {
    double roughness, deviation[2];
  } kPromises[] = {{0.1, {1.15, 2.35}}, {0.3, {0.7, 1.1}}, {0.5, {0.5, 0.75}}, {1, {0.25, 0.38}}};
  constexpr int kSteps = 400;
  for (const auto& promise : kPromises) {
    for (int at = 0; at < 2; ++at) {
      const double roughness = promise.roughness, n_dot_v = at == 0 ? 0.1 : 0.6;
      CAPTURE(roughness, n_dot_v);
      const Vec3d v = DirectionAt(n_dot_v, 0.4);
      double sum = 0, squares = 0;
      for (int i = 0; i < kSteps * kSteps; ++i) {
        const double u0 = (i / kSteps + 0.5) / kSteps, u1 = (i % kSteps + 0.5) / kSteps;
        const Vec3d l = SampleCharlie(kNormal, roughness, u0, u1);
        if (!(l.z > 0)) FAIL("below");
        const double weight = Lobe(roughness, l, v) * l.z / CharliePdf(l.z, roughness);
        sum += weight;
        squares += weight * weight;
      }
      const double mean = sum / (kSteps * kSteps), square = squares / (kSteps * kSteps);
      CHECK(mean == Approx(Albedo(MakeRings(roughness, n_dot_v))).epsilon(1e-3));
      CHECK(std::sqrt(square / (mean * mean) - 1) <= promise.deviation[at]);
    }
  }
}

double RelativeError(double got, double want) { return std::abs(got - want) / want; }

template <typename T>
void CheckTwins(double unit_roundoff) {
  std::mt19937 random(6);
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<LayerQuery<T>> queries;
  for (int i = 0; i < 8000; ++i) {
    LayerQuery<T> q;
    q.n = Imath::Vec3<T>(kNormal);
    // Some from below.
    q.l = Imath::Vec3<T>(DirectionAt(std::pow(unit(random), 3) - 0.1, 6 * unit(random)));
    q.v = Imath::Vec3<T>(DirectionAt(std::pow(unit(random), 3), 6 * unit(random)));
    q.roughness = static_cast<T>(i % 50 == 0 ? 0.0 : unit(random));
    q.largest_channel = static_cast<T>(unit(random));
    queries.push_back(q);
  }
  // Limits: grazing, along the normal, delta lobes.
  for (const double n_dot_l : {1e-20, 1e-5, 0.5, 1.0}) {  // D V below that is past float
    for (const double n_dot_v : {0.0, 1e-30, 1e-5, 0.5, 1.0}) {
      for (const double roughness : {0.0, 1e-12, 9e-7, 1e-6, 1e-3, 0.5, 1.0}) {
        LayerQuery<T> q;
        q.n = Imath::Vec3<T>(kNormal);
        q.l = Imath::Vec3<T>(DirectionAt(n_dot_l, 1));
        q.v = Imath::Vec3<T>(DirectionAt(n_dot_v, 0));
        q.roughness = static_cast<T>(roughness);
        queries.push_back(q);
      }
    }
  }
  const std::vector<LayerAnswer<T>> answers = EvaluateLayers(RoughnessOf::kEach, queries);
  double lobe = 0, lambda = 0, albedo = 0, scale = 0;
  for (size_t i = 0; i < queries.size(); ++i) {
    const LayerQuery<T>& q = queries[i];
    const LayerAnswer<T>& got = answers[i];
    for (const T number : {got.distribution, got.sheen, got.cosine_lambda_v, got.sheen_albedo_v,
                           got.sheen_albedo_l, got.sheen_scale, got.below_sheen}) {
      if (!(number >= 0) || !std::isfinite(number)) FAIL("number of query " << i);
    }
    const Charlie<double> charlie = MakeCharlie(double{q.roughness});
    const Angles<double> a = ComputeAngles(Vec3d(q.n), Vec3d(q.l), Vec3d(q.v));
    const double d = CharlieDistribution(a, charlie.alpha), want = CharlieLobe(charlie, a);
    if (want == 0) {
      // Along the normal sin is 1e-19, not 0, in float vectors: SquaredLength.
      if (got.sheen > 1e-19) FAIL("sheen " << got.sheen << " of query " << i);
    } else if (want > 1e-30) {
      // The sines' rounding, which grows as 1 / |u|, times the exponent of sin in the distribution;
      // and Lambda's logarithm, up to 17, of which a few operations each round.
      const double exponent =
          std::log1p(a.n_dot_u * a.n_dot_u / a.nxu_squared) / (2 * charlie.alpha);
      const double rounding =
          unit_roundoff * (256 + 16 * exponent * (1 + 1 / std::sqrt(a.u_squared)));
      lobe = std::max(lobe, RelativeError(got.sheen, want) / rounding);
      lobe = std::max(lobe, RelativeError(got.distribution, d) / rounding);
    }
    const double n_dot_v = q.v.z, n_dot_l = q.l.z;
    lambda =
        std::max(lambda, RelativeError(got.cosine_lambda_v, CharlieCosineLambda(charlie, n_dot_v)));
    const double albedo_v = CharlieAlbedo(charlie, n_dot_v);
    const double albedo_l = CharlieAlbedo(charlie, n_dot_l);
    albedo = std::max(albedo, std::abs(got.sheen_albedo_v - albedo_v) / std::max(albedo_v, 1.0));
    albedo = std::max(albedo, std::abs(got.sheen_albedo_l - albedo_l) / std::max(albedo_l, 1.0));
    const auto scales = ScaleSheen(double{q.largest_channel}, albedo_v, albedo_l);
    scale = std::max(scale, std::abs(got.sheen_scale - scales.lobe));
    scale = std::max(scale, std::abs(got.below_sheen - scales.below));
  }
  CHECK(lobe <= 1);
  CHECK(lambda <= 256 * unit_roundoff);
  // The exponent of the envelope, up to 25 where E is above 1e-9, and a polynomial whose
  // coefficients sum to 20.
  CHECK(albedo <= 512 * unit_roundoff);
  CHECK(scale <= 512 * unit_roundoff);
}

TEST_CASE("SIMD sheen is its double twin on every target, in floats and in doubles") {
  ForEachTarget([](Target) {
    CheckTwins<float>(kHalfUlpFloat);
    CheckTwins<double>(kHalfUlpDouble);
  });
}

// A roughness for all lanes is what the same roughness in each lane is.
template <typename T>
void CheckBroadcast(double unit_roundoff) {
  std::vector<LayerQuery<T>> queries;
  for (const double roughness : {0.0, 1e-3, 0.2, 1.0}) {
    queries.clear();
    for (int i = 0; i < 64; ++i) {
      LayerQuery<T> q;
      q.n = Imath::Vec3<T>(kNormal);
      q.l = Imath::Vec3<T>(DirectionAt((i + 0.5) / 64, i));
      q.v = Imath::Vec3<T>(DirectionAt((64 - i) / 64.0, 0));
      q.roughness = static_cast<T>(roughness);
      queries.push_back(q);
    }
    const auto each = EvaluateLayers(RoughnessOf::kEach, queries);
    const auto all = EvaluateLayers(RoughnessOf::kFirst, queries);
    for (size_t i = 0; i < queries.size(); ++i) {
      CAPTURE(roughness, i);
      const auto near = [&](T one, T other) {
        CHECK(std::abs(one - other) <= 512 * unit_roundoff * std::max<double>(one, 1));
      };
      CHECK(each[i].distribution == all[i].distribution);
      near(each[i].sheen, all[i].sheen);
      near(each[i].sheen_albedo_v, all[i].sheen_albedo_v);
    }
  }
}

TEST_CASE("layers of one roughness are those of a roughness each") {
  ForEachTarget([](Target) {
    CheckBroadcast<float>(kHalfUlpFloat);
    CheckBroadcast<double>(kHalfUlpDouble);
  });
}

}  // namespace
}  // namespace nacre
