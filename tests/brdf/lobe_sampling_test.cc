// SPDX-License-Identifier: Apache-2.0
// tests/brdf/lobe_sampling_test.cc: lobe samplers: distribution by chi-squared, pdfs that
// integrate to one, weights that agree with the model's BRDF, and the SIMD twins.
#include "brdf/lobe_sampling.h"

#include <cmath>
#include <functional>
#include <random>

#include "brdf/lobe_kernel.h"
#include "brdf/sheen.h"
#include "brdf/sphere_cells.h"
#include "catch.h"
#include "chi_squared.h"
#include "tables.h"
#include "targets.h"

namespace nacre {
namespace {

const Vec3d kNormal = Vec3d(0.3, -0.5, 0.7).normalized();

// A view at this cosine from the normal, in an azimuth of no meaning.
Vec3d ViewAt(double n_dot_v) {
  const double sin = std::sqrt(1 - n_dot_v * n_dot_v);
  return BasisAbout(kNormal).ToWorld({sin * std::cos(0.7), sin * std::sin(0.7), n_dot_v});
}

// A lobe as functions of its numbers and directions, with where it is and how wide.
struct LobeUnderTest {
  std::string name;
  std::function<Vec3d(double, double)> sample;
  std::function<double(const Vec3d&)> pdf;
  Vec3d centre;
  double width;  // in radians
  int steps;     // of quadrature in each direction of a cell: more for lopsided lobes
};

std::vector<LobeUnderTest> LobesUnderTest() {
  std::vector<LobeUnderTest> lobes;
  lobes.push_back({"cosine", [](double u0, double u1) { return SampleCosine(kNormal, u0, u1); },
                   [](const Vec3d& l) { return CosinePdf(kNormal ^ l); }, kNormal, 1, 40});
  for (const double spread : {1e-3, 1e-2, 0.3, 4.0}) {
    lobes.push_back(
        {"Kulla and Conty " + std::to_string(spread),
         [=](double u0, double u1) { return SampleKullaConty(kNormal, spread, u0, u1); },
         [=](const Vec3d& l) { return KullaContyPdf(kNormal ^ l, spread); }, kNormal, 1, 200});
  }
  for (const double roughness : {0.05, 0.3, 1.0}) {
    lobes.push_back(
        {"Charlie " + std::to_string(roughness),
         [=](double u0, double u1) { return SampleCharlie(kNormal, roughness, u0, u1); },
         [=](const Vec3d& l) { return CharliePdf(kNormal ^ l, roughness); }, kNormal, 1, 200});
  }
  for (const double n_dot_v : {1.0, 0.6, 0.05, 0.0}) {
    const Vec3d v = ViewAt(n_dot_v);
    const Vec3d mirror = Mirrored(v, kNormal);
    const int steps = n_dot_v > 0.5 ? 40 : 120;
    const std::string at = " at " + std::to_string(n_dot_v);
    // Narrow lobes that graze the surface are too lopsided for the quadrature.
    const bool wide_only = n_dot_v == 0;
    for (const double alpha : {1e-4, 1e-2, 0.1, 0.5, 1.0}) {
      if (wide_only && alpha < 0.5) continue;
      lobes.push_back(
          {"GGX " + std::to_string(alpha) + at,
           [=](double u0, double u1) { return SampleGgxVisible(kNormal, v, alpha, u0, u1); },
           [=](const Vec3d& l) { return GgxVisiblePdf(kNormal, v, l, alpha); }, mirror, alpha,
           steps});
    }
    for (const double n : {1.0, 50.0, 1e4, 1e6}) {
      if (wide_only && n > 1) continue;
      const double width = 1 / std::sqrt(n + 1);
      lobes.push_back({"Phong " + std::to_string(n) + at,
                       [=](double u0, double u1) { return SamplePhongLobe(kNormal, v, n, u0, u1); },
                       [=](const Vec3d& l) { return PhongLobePdf(kNormal, v, l, n); }, mirror,
                       width, steps});
      lobes.push_back({"Blinn " + std::to_string(n) + at,
                       [=](double u0, double u1) { return SampleBlinnLobe(kNormal, v, n, u0, u1); },
                       [=](const Vec3d& l) { return BlinnLobePdf(kNormal, v, l, n); }, mirror,
                       width, steps});
    }
  }
  return lobes;
}

TEST_CASE("lobes are sampled with their pdfs, which integrate to 1") {
  constexpr int kSamples = 40000;
  for (const LobeUnderTest& lobe : LobesUnderTest()) {
    CAPTURE(lobe.name);
    const SphereCells cells{BasisAbout(lobe.centre), lobe.width};
    std::vector<double> probabilities = cells.Integrate(lobe.pdf, lobe.steps);
    std::vector<double> counts(probabilities.size());
    std::mt19937 random(3);
    std::uniform_real_distribution<double> unit(0, 1);
    double none = 0;
    for (int i = 0; i < kSamples; ++i) {
      const double u0 = unit(random), u1 = unit(random);
      const Vec3d l = lobe.sample(u0, u1);
      REQUIRE(std::abs(l.length() - 1) < 1e-12);
      if (lobe.pdf(l) > 0) {
        counts[cells.CellOf(l)] += 1;
      } else {
        none += 1;
      }
    }
    double sum = 0;
    for (const double p : probabilities) sum += p;
    // Only Blinn's lobe has directions that are no samples.
    if (lobe.name[0] != 'B') {
      CHECK(none == 0);
      CHECK(std::abs(sum - 1) <= 1e-4);
    }
    counts.push_back(none);
    probabilities.push_back(std::max(1 - sum, 0.0));
    CHECK(FollowsProbabilities(counts, kSamples, probabilities));
  }
}

// BRDF n.l over pdf, of height-correlated shadowing and a Fresnel term of 1.
double Weight(const Angles<double>& a, double alpha) {
  if (a.n_dot_l <= 0) return 0;
  return GgxDistribution(a, alpha) * VisibilityHeightCorrelated(a.n_dot_l, a.n_dot_v, alpha) *
         a.n_dot_l / GgxVisiblePdf(a, alpha);
}

TEST_CASE("GGX weights are Smith's shadowing of the light, and at most 1") {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(0, 1);
  for (const double alpha : {1e-4, 1e-2, 0.25, 1.0}) {
    for (const double n_dot_v : {1.0, 0.6, 0.05, 1e-3}) {
      CAPTURE(alpha, n_dot_v);
      const Vec3d v = ViewAt(n_dot_v);
      for (int i = 0; i < 2000; ++i) {
        const double u0 = unit(random), u1 = unit(random);
        const Vec3d l = SampleGgxVisible(kNormal, v, alpha, u0, u1);
        const Angles<double> a = ComputeAngles(kNormal, l, v);
        if (a.n_dot_l <= 0) continue;
        // G2 / G1: Smith's shadowing of the light, given that the viewer sees.
        const double v_root = SmithRoot(a.n_dot_v, alpha), l_root = SmithRoot(a.n_dot_l, alpha);
        const double shadowing =
            a.n_dot_l * (a.n_dot_v + v_root) / (a.n_dot_l * v_root + a.n_dot_v * l_root);
        const double weight = Weight(a, alpha);
        if (weight > 1 + 1e-12) FAIL("weight " << weight);
        if (std::abs(weight - shadowing) > 1e-12 * shadowing) FAIL(weight << " not " << shadowing);
      }
    }
  }
}

TEST_CASE("the mean of GGX weights is the directional albedo", "[table]") {
  const nlohmann::json table = LoadTable("ggx_albedo");
  size_t rows = 0;
  for (const auto& row : table.at("rows")) {
    const double roughness = TableNumber(row["roughness"]), mu = TableNumber(row["mu"]);
    if (roughness < 0.05 || mu < 0.02) continue;
    CAPTURE(roughness, mu);
    const double alpha = roughness * roughness;
    const Vec3d v = ViewAt(std::min(mu, 1.0));
    // The midpoint rule of 200^2 points, u1 denser towards 1, where the lobe's tail is.
    constexpr int kSteps = 200;
    double sum = 0;
    for (int i = 0; i < kSteps * kSteps; ++i) {
      const double root = (i / kSteps + 0.5) / kSteps;
      const Vec3d l =
          SampleGgxVisible(kNormal, v, alpha, (i % kSteps + 0.5) / kSteps, 1 - root * root);
      sum += Weight(ComputeAngles(kNormal, l, v), alpha) * 2 * root;
    }
    CHECK(std::abs(sum / (kSteps * kSteps) - TableNumber(row["E_corr"])) <= 1e-4);
    ++rows;
  }
  CHECK(rows > 50);
}

TEST_CASE("a constant lobe, of an exponent of 0, is sampled all around") {
  const Vec3d v = ViewAt(0.6);
  const Vec3d mirror = Mirrored(v, kNormal);
  for (int i = 0; i < 100; ++i) {
    const double u0 = (i + 0.5) / 100;
    const Vec3d l = SamplePhongLobe(kNormal, v, 0.0, u0, 0.3);
    CHECK((l ^ mirror) == Approx(1 - 2 * u0).margin(1e-12));
    CHECK(PhongLobePdf(kNormal, v, l, 0.0) == Approx(1 / (4 * M_PI)).epsilon(1e-14));
    CHECK(PhongLobePdf(kNormal, v, -l, 0.0) == PhongLobePdf(kNormal, v, l, 0.0));
  }
}

TEST_CASE("a delta lobe is sampled at the mirror direction, and a view from below not at all") {
  const Vec3d v = ViewAt(0.4);
  const Vec3d l = SampleGgxVisible(kNormal, v, 0.0, 0.3, 0.6);
  CHECK((l - Mirrored(v, kNormal)).length() <= 1e-15);
  CHECK(GgxVisiblePdf(kNormal, v, l, 0.0) == 0);
  CHECK(GgxVisiblePdf(kNormal, -v, -l, 0.3) == 0);
  CHECK(BlinnLobePdf(kNormal, v, -v, 3.0) == 0);
}

// SIMD samples lie within roundings of the twins', and SIMD pdfs at them are the twins' there
// up to the roundings of their directions, which a lobe of this width sees.
void CheckTwins(Lobe lobe, double width, double lobe_width, double n_dot_v) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> unit(0, 1);
  std::vector<LobeQuery> queries;
  const auto v = Vec3f(ViewAt(n_dot_v));
  for (int i = 0; i < 500; ++i) {
    queries.push_back({Vec3f(kNormal), v, static_cast<float>(width), unit(random), unit(random)});
  }
  std::vector<LobeAnswer> answers = AskLobe(lobe, queries);
  for (size_t i = 0; i < queries.size(); ++i) queries[i].l = answers[i].sample;
  answers = AskLobe(lobe, queries);
  double direction = 0, pdf = 0;
  for (size_t i = 0; i < queries.size(); ++i) {
    const LobeQuery& q = queries[i];
    const auto n = Vec3d(q.n), view = Vec3d(q.v), l = Vec3d(q.l);
    const double u0 = q.u0, u1 = q.u1, w = q.width;
    const Vec3d samples[] = {SampleCosine(n, u0, u1), SampleGgxVisible(n, view, w, u0, u1),
                             SamplePhongLobe(n, view, w, u0, u1),
                             SampleBlinnLobe(n, view, w, u0, u1), SampleKullaConty(n, w, u0, u1)};
    const double pdfs[] = {CosinePdf(n ^ l), GgxVisiblePdf(n, view, l, w),
                           PhongLobePdf(n, view, l, w), BlinnLobePdf(n, view, l, w),
                           KullaContyPdf(n ^ l, w)};
    const auto index = static_cast<size_t>(lobe);
    direction = std::max(direction, (l - samples[index]).length());
    if (pdfs[index] > 1e-30) pdf = std::max(pdf, std::abs(answers[i].pdf / pdfs[index] - 1));
  }
  CAPTURE(static_cast<int>(lobe), width, n_dot_v);
  CHECK(direction <= 3e-6);
  CHECK(pdf <= 64 * 0x1p-24 / lobe_width + 2e-4);
}

TEST_CASE("a viewer in the surface's plane sees narrow lobes where a mirror looks") {
  // Of hits whose roughness comes from a map alpha may be any, that of mirrors too: its square may
  // be below float's range. The half vector is off the normal by alpha / (1 - u1).
  std::mt19937 random(4);
  std::uniform_real_distribution<float> unit(0, 0.99f);
  std::vector<LobeQuery> queries;
  for (const float alpha : {1e-10f, 1e-15f, 1e-18f, 1e-19f, 1e-20f, 1e-24f, 1e-36f, 0.0f}) {
    for (int i = 0; i < 50; ++i) {
      queries.push_back({Vec3f(0, 0, 1), Vec3f(1, 0, 0), alpha, unit(random), unit(random)});
    }
  }
  ForEachTarget([&](Target) {
    double worst = 0;
    for (const LobeAnswer& answer : AskLobe(Lobe::kGgx, queries)) {
      worst = std::max(worst, (Vec3d(answer.sample) - Vec3d(-1, 0, 0)).length());
    }
    CHECK(worst <= 1e-6);
  });
}

TEST_CASE("SIMD lobe samplers agree with their double twins on every target") {
  ForEachTarget([](Target) {
    // n.l of a spread s is as small as sqrt(s) and known to 1e-7.
    for (const double spread : {1e-8, 1e-4, 0.01, 1.0, 4.0}) {
      CheckTwins(Lobe::kKullaConty, spread, std::sqrt(spread), 1);
    }
    for (const double n_dot_v : {1.0, 0.6, 0.05}) {
      CheckTwins(Lobe::kCosine, 1, 1, n_dot_v);
      for (const double alpha : {1e-4, 1e-2, 0.1, 0.5, 1.0}) {
        CheckTwins(Lobe::kGgx, alpha, alpha, n_dot_v);
      }
      for (const double n : {0.0, 1.0, 50.0, 1e4, 1e6}) {
        CheckTwins(Lobe::kPhong, n, 1 / std::sqrt(n + 1), n_dot_v);
        CheckTwins(Lobe::kBlinn, n, 1 / std::sqrt(n + 1), n_dot_v);
      }
    }
  });
}

}  // namespace
}  // namespace nacre
