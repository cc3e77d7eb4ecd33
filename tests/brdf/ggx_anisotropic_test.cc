// SPDX-License-Identifier: Apache-2.0
// tests/brdf/ggx_anisotropic_test.cc: anisotropic GGX against tables, the isotropic lobe and
// itself, its sampler against its pdf, formats' alphas, hard inputs, and the SIMD twins.
#include "brdf/ggx_anisotropic.h"

#include <cmath>
#include <random>

#include "brdf/anisotropic_kernel.h"
#include "brdf/fresnel.h"
#include "brdf/lobe_sampling.h"
#include "brdf/quadrature.h"
#include "catch.h"
#include "chi_squared.h"
#include "tables.h"
#include "targets.h"

namespace nacre {
namespace {

const Basis<double> kUpright{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

// A frame in general position.
Basis<double> TiltedFrame() {
  return LobeFrame(Vec3d(0.3, -0.5, 0.7).normalized(), Vec3d(0.6, 0.9, -0.2));
}

Vec3d Direction(double cosine, double phi) {
  const double sin = std::sqrt((1 - cosine) * (1 + cosine));
  return {sin * std::cos(phi), sin * std::sin(phi), cosine};
}

AnisotropicQuery MakeQuery(const Basis<double>& frame, const Vec3d& l, const Vec3d& v,
                           const GgxAlphas<double>& alpha) {
  return {Vec3f(frame.z),
          Vec3f(frame.x),
          Vec3f(l),
          Vec3f(v),
          static_cast<float>(alpha.x),
          static_cast<float>(alpha.y)};
}

// The terms of a query, whose vectors are rounded to float, in double.
struct Terms {
  FrameAngles<double> angles;
  GgxAlphas<double> alpha;
};
Terms TermsOf(const AnisotropicQuery& query) {
  const Vec3d n = Vec3d(query.n).normalized(), l = Vec3d(query.l).normalized();
  const Basis<double> frame = LobeFrame(n, Vec3d(query.t));
  return {ComputeAngles(frame, l, Vec3d(query.v).normalized()),
          MakeGgxAlphas(double{query.alpha_x}, double{query.alpha_y})};
}

TEST_CASE("anisotropic terms are those of the table", "[table]") {
  const nlohmann::json table = LoadTable("ggx_anisotropic");
  size_t rows = 0;
  std::vector<AnisotropicQuery> queries;
  for (const auto& row : table.at("rows")) {
    const GgxAlphas<double> alpha =
        MakeGgxAlphas(TableNumber(row["alpha_x"]), TableNumber(row["alpha_y"]));
    const Vec3d l = Direction(TableNumber(row["n_dot_l"]), TableNumber(row["phi_l"]));
    const Vec3d v = Direction(TableNumber(row["n_dot_v"]), TableNumber(row["phi_v"]));
    CAPTURE(row.dump());
    const FrameAngles<double> a = ComputeAngles(kUpright, l, v);
    const auto check = [&](double got, const char* name) {
      const double cond = TableNumber(row[std::string("cond_") + name]);
      CHECK(PassesConditionedRule(got, TableNumber(row[name]), cond, kHalfUlpDouble));
    };
    check(GgxDistribution(a, alpha), "D");
    check(VisibilityHeightCorrelated(a, alpha), "V_correlated");
    check(VisibilitySeparable(a, alpha), "V_separable");
    check(GgxVisiblePdf(a, alpha), "pdf");
    queries.push_back(MakeQuery(kUpright, l, v, alpha));
    ++rows;
  }
  CHECK(rows == 200);
  // Inputs of the kernels are rounded to float, which the condition numbers allow for.
  ForEachTarget([&](Target) {
    const std::vector<AnisotropicAnswer> answers = AskAnisotropic(queries);
    for (size_t i = 0; i < queries.size(); ++i) {
      const auto& row = table.at("rows")[i];
      CAPTURE(row.dump());
      const auto check = [&](double got, const char* name) {
        const double cond = TableNumber(row[std::string("cond_") + name]);
        CHECK(PassesConditionedRule(got, TableNumber(row[name]), cond, kHalfUlpFloat));
      };
      // Directions near the horizon lose what the components of unit vectors round away.
      const double grazing = std::min(TableNumber(row["n_dot_l"]), TableNumber(row["n_dot_v"]));
      if (grazing < 1e-3) continue;
      check(answers[i].distribution, "D");
      check(answers[i].height_correlated, "V_correlated");
      check(answers[i].separable, "V_separable");
      check(answers[i].pdf, "pdf");
    }
  });
}

TEST_CASE("OpenPBR's metal is Adobe's within 1e-4", "[table]") {
  const nlohmann::json table = LoadTable("openpbr_anisotropy");
  CHECK(table.at("rows").size() == 36);
  for (const auto& row : table.at("rows")) {
    const auto number = [&](size_t i) { return row[i].get<double>(); };
    CAPTURE(row.dump());
    const GgxAlphas<double> alpha = OpenPbrAlphas(number(0), number(1), AlphaLimit::kNone);
    const Vec3d v = Vec3d(number(5), number(6), number(7)).normalized();
    const Vec3d l = Vec3d(number(8), number(9), number(10)).normalized();
    const FrameAngles<double> a = ComputeAngles(kUpright, l, v);
    const double lobe = GgxDistribution(a, alpha) * VisibilitySeparable(a, alpha) * a.n_dot_l;
    for (size_t c = 0; c < 3; ++c) {
      const double value = lobe * FresnelSchlick(number(2 + c), SchlickWeight(a));
      CHECK(value == Approx(number(11 + c)).epsilon(1e-4));
    }
  }
}

TEST_CASE("with equal alphas the lobe is the isotropic one") {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(0, 1);
  const Basis<double> frame = TiltedFrame();
  for (int i = 0; i < 2000; ++i) {
    const double alpha = std::pow(unit(random), 4);
    const GgxAlphas<double> alphas = MakeGgxAlphas(alpha, alpha);
    const Vec3d v = frame.ToWorld(Direction(std::pow(unit(random), 4), 6.28 * unit(random)));
    const double u0 = unit(random), u1 = unit(random);
    const Vec3d l = SampleGgxVisible(frame, v, alphas, u0, u1);
    const FrameAngles<double> a = ComputeAngles(frame, l, v);
    const Angles<double>& isotropic = a;
    CAPTURE(alpha, a.n_dot_l, a.n_dot_v);
    // Roundings of directions, as the lobe's steepest slope sees them.
    const double rounding = 64 * 0x1p-53 / alpha + 1e-13;
    CHECK(GgxDistribution(a, alphas) ==
          Approx(GgxDistribution(isotropic, alpha)).epsilon(rounding));
    CHECK(GgxVisiblePdf(a, alphas) == Approx(GgxVisiblePdf(isotropic, alpha)).epsilon(rounding));
    if (a.n_dot_l <= 0) continue;
    CHECK(VisibilityHeightCorrelated(a, alphas) ==
          Approx(VisibilityHeightCorrelated(a.n_dot_l, a.n_dot_v, alpha)).epsilon(1e-13));
    CHECK(VisibilitySeparable(a, alphas) ==
          Approx(VisibilitySeparable(a.n_dot_l, a.n_dot_v, alpha)).epsilon(1e-13));
    // The isotropic sampler has axes of its own.
    const Basis<double> basis = BasisAbout(frame.z);
    CHECK((SampleGgxVisible(basis, v, alphas, u0, u1) - SampleGgxVisible(frame.z, v, alpha, u0, u1))
              .length() <= 1e-13);
  }
}

TEST_CASE("the anisotropic lobe is reciprocal, and the same for opposite tangents") {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(0, 1);
  const Basis<double> frame = TiltedFrame();
  const Basis<double> opposite{-frame.x, -frame.y, frame.z};
  const Basis<double> quarter{frame.y, -frame.x, frame.z};
  for (int i = 0; i < 2000; ++i) {
    const GgxAlphas<double> alpha = MakeGgxAlphas(0.05 + unit(random), 0.05 + unit(random));
    const Vec3d l = frame.ToWorld(Direction(unit(random), 6.28 * unit(random)));
    const Vec3d v = frame.ToWorld(Direction(unit(random), 6.28 * unit(random)));
    const auto lobes = [&](const FrameAngles<double>& a, const GgxAlphas<double>& of) {
      const double d = GgxDistribution(a, of);
      return Vec3d(d, d * VisibilityHeightCorrelated(a, of), d * VisibilitySeparable(a, of));
    };
    const Vec3d value = lobes(ComputeAngles(frame, l, v), alpha);
    const double bound = 1e-12 * value.length();
    CHECK((lobes(ComputeAngles(frame, v, l), alpha) - value).length() <= bound);
    CHECK((lobes(ComputeAngles(opposite, l, v), alpha) - value).length() <= bound);
    // A quarter of a turn exchanges the alphas.
    CHECK((lobes(ComputeAngles(quarter, l, v), {alpha.y, alpha.x}) - value).length() <= bound);
  }
}

// int D n.h dh over the hemisphere, in the squeezed surface's angles, where D is that of a
// hemisphere: checks the factor ax ay, and the axes.
TEST_CASE("anisotropic GGX covers the surface once") {
  const QuadratureRule& rule = GaussLegendre(24);
  for (const GgxAlphas<double>& alpha :
       {GgxAlphas<double>{0.5, 0.5}, GgxAlphas<double>{0.9, 0.2}, GgxAlphas<double>{0.3, 0.003}}) {
    double sum = 0;
    for (size_t i = 0; i < rule.x.size(); ++i) {
      const double cos2 = rule.x[i], sin = std::sqrt(1 - cos2), cos = std::sqrt(cos2);
      for (int j = 0; j < 64; ++j) {
        const double phi = 2 * M_PI * (j + 0.5) / 64;
        // The slopes' area dx dy is d(cos^2) dphi ax ay / (2 cos^4), and n.h dh is cos^4(h) of it.
        const Vec3d h =
            Vec3d(alpha.x * sin * std::cos(phi), alpha.y * sin * std::sin(phi), cos).normalized();
        const double area = alpha.x * alpha.y / (2 * cos2 * cos2) * std::pow(h.z, 4);
        sum += rule.w[i] * 2 * M_PI / 64 * area *
               GgxDistribution(ComputeAngles(kUpright, h, h), alpha);
      }
    }
    CHECK(sum == Approx(1).epsilon(1e-12));
  }
}

// Bins of the squeezed surface's coordinates, in which samples are spread evenly over a cap however
// narrow the lobe is. Of a direction, the half vector is found, then the point of the cap.
struct CapPoint {
  double turn, height;  // both in [0, 1)
};
CapPoint PointOfCap(const Basis<double>& frame, const Vec3d& view, const Vec3d& light,
                    const GgxAlphas<double>& alpha) {
  const Vec3d v = frame.ToLocal(view), h = frame.ToLocal((view + light).normalized());
  const Vec3d q = Vec3d(alpha.x * v.x, alpha.y * v.y, std::max(v.z, 0.0)).normalized();
  const Vec3d m = Vec3d(h.x / alpha.x, h.y / alpha.y, h.z).normalized();
  const Vec3d point = m * (2 * (m ^ q)) - q;  // the mirror direction of q
  return {std::atan2(point.y, point.x) / (2 * M_PI) + 0.5, (1 - point.z) / (1 + q.z)};
}

TEST_CASE("visible normals are sampled in proportion to their pdf") {
  constexpr int kSamples = 40000;
  const Basis<double> frame = TiltedFrame();
  std::mt19937 random(9);
  std::uniform_real_distribution<double> unit(0, 1);
  for (const GgxAlphas<double>& alpha :
       {GgxAlphas<double>{0.8, 0.2}, GgxAlphas<double>{0.3, 0.3}, GgxAlphas<double>{0.1, 1.0},
        GgxAlphas<double>{1.4, 0.4}}) {
    for (const double n_dot_v : {1.0, 0.6, 0.1, 0.0}) {
      CAPTURE(alpha.x, alpha.y, n_dot_v);
      const Vec3d v = frame.ToWorld(Direction(n_dot_v, 0.7));
      // Cells of the sphere of directions to light, evenly in z and azimuth of the lobe's frame,
      // and the integral of the pdf over each by midpoints.
      constexpr size_t kRings = 16, kSectors = 16;
      constexpr int kSteps = 40;
      std::vector<double> probabilities(kRings * kSectors), counts(kRings * kSectors);
      double total = 0;
      for (size_t cell = 0; cell < probabilities.size(); ++cell) {
        for (int i = 0; i < kSteps * kSteps; ++i) {
          const double ring = static_cast<double>(cell / kSectors) + (i / kSteps + 0.5) / kSteps;
          const double sector = static_cast<double>(cell % kSectors) + (i % kSteps + 0.5) / kSteps;
          const Vec3d l =
              frame.ToWorld(Direction(1 - 2 * ring / kRings, 2 * M_PI * (sector / kSectors - 0.5)));
          probabilities[cell] += GgxVisiblePdf(ComputeAngles(frame, l, v), alpha) * 4 * M_PI /
                                 (kRings * kSectors * kSteps * kSteps);
        }
        total += probabilities[cell];
      }
      CHECK(total == Approx(1).epsilon(4e-3));
      for (double& probability : probabilities) probability /= total;
      for (int i = 0; i < kSamples; ++i) {
        const double u0 = unit(random), u1 = unit(random);
        const Vec3d l = SampleGgxVisible(frame, v, alpha, u0, u1);
        REQUIRE(std::abs(l.length() - 1) < 1e-12);
        const Vec3d local = frame.ToLocal(l);
        const auto ring = static_cast<size_t>((1 - local.z) / 2 * kRings);
        const double turn = std::atan2(local.y, local.x) / (2 * M_PI) + 0.5;
        const auto sector = static_cast<size_t>(turn * kSectors);
        counts[std::min(ring, kRings - 1) * kSectors + std::min(sector, kSectors - 1)] += 1;
      }
      CHECK(FollowsProbabilities(counts, kSamples, probabilities));
    }
  }
}

TEST_CASE("narrow and grazing lobes fill their cap evenly") {
  constexpr int kSamples = 20000;
  const Basis<double> frame = TiltedFrame();
  std::mt19937 random(4);
  std::uniform_real_distribution<double> unit(0, 1);
  for (const GgxAlphas<double>& alpha : {GgxAlphas<double>{0.5, 5e-5}, GgxAlphas<double>{1e-3, 0.1},
                                         GgxAlphas<double>{1e-4, 1e-4}}) {
    for (const double n_dot_v : {1.0, 0.3, 1e-3}) {
      CAPTURE(alpha.x, alpha.y, n_dot_v);
      const Vec3d v = frame.ToWorld(Direction(n_dot_v, 0.7));
      constexpr size_t kBins = 12;
      std::vector<double> counts(kBins * kBins);
      double weight = 0;
      for (int i = 0; i < kSamples; ++i) {
        const double u0 = unit(random), u1 = unit(random);
        const Vec3d l = SampleGgxVisible(frame, v, alpha, u0, u1);
        const CapPoint p = PointOfCap(frame, v, l, alpha);
        const auto row = std::min(static_cast<size_t>(p.height * kBins), kBins - 1);
        const auto column = std::min(static_cast<size_t>(p.turn * kBins), kBins - 1);
        counts[row * kBins + column] += 1;
        // The lobe over its pdf is Smith's shadowing of the light, and at most 1.
        const FrameAngles<double> a = ComputeAngles(frame, l, v);
        if (a.n_dot_l <= 0) continue;
        weight = std::max(weight, GgxDistribution(a, alpha) * VisibilityHeightCorrelated(a, alpha) *
                                      a.n_dot_l / GgxVisiblePdf(a, alpha));
      }
      CHECK(weight <= 1 + 1e-9);
      CHECK(FollowsProbabilities(counts, kSamples,
                                 std::vector<double>(kBins * kBins, 1.0 / (kBins * kBins))));
    }
  }
}

TEST_CASE("a delta lobe is one in both directions; a streak has a least width") {
  CHECK(IsDeltaLobe(MakeGgxAlphas(0.0, 0.0)));
  CHECK(IsDeltaLobe(MakeGgxAlphas(1e-13, 5e-13)));
  const GgxAlphas<double> streak = MakeGgxAlphas(0.5, 0.0);
  CHECK(!IsDeltaLobe(streak));
  CHECK(streak.x == 0.5);
  CHECK(streak.y == 0x1p-40);
  CHECK(MakeGgxAlphas(0.0f, 0.25f).x == 0x1p-40f);
  const Vec3d v = Direction(0.4, 1), l = Mirrored(v, Vec3d(0, 0, 1));
  const FrameAngles<double> a = ComputeAngles(kUpright, l, v);
  const GgxAlphas<double> delta = MakeGgxAlphas(0.0, 0.0);
  CHECK(GgxDistribution(a, delta) == 0);
  CHECK(GgxVisiblePdf(a, delta) == 0);
  CHECK((SampleGgxVisible(kUpright, v, delta, 0.3, 0.6) - l).length() <= 1e-15);
  // The peak, exactly at the mirror direction, is 1 / (pi ax ay).
  const Vec3d up(0, 0, 1);
  CHECK(GgxDistribution(ComputeAngles(kUpright, up, up), streak) ==
        Approx(0x1p41 / M_PI).epsilon(1e-14));
}

TEST_CASE("an n.v that rounding makes negative counts as 0") {
  const Vec3d l = Direction(0.3, 2.5), below(std::sqrt(1 - 1e-14), 0, -1e-7);
  const GgxAlphas<double> alpha{0.4, 0.1};
  const FrameAngles<double> a = ComputeAngles(kUpright, l, below);
  FrameAngles<double> level = a;
  level.n_dot_v = 0;
  CHECK(VisibilityHeightCorrelated(a, alpha) == VisibilityHeightCorrelated(level, alpha));
  CHECK(VisibilitySeparable(a, alpha) == VisibilitySeparable(level, alpha));
  CHECK(GgxVisiblePdf(a, alpha) == GgxVisiblePdf(level, alpha));
  const Vec3d grazing(1, 0, 0);
  CHECK((SampleGgxVisible(kUpright, below, alpha, 0.2, 0.7) -
         SampleGgxVisible(kUpright, grazing, alpha, 0.2, 0.7))
            .length() <= 1e-6);
}

// Nothing that is finite makes terms, pdfs or samples NaN or infinite.
TEST_CASE("anisotropic terms of hard inputs are finite on every target") {
  std::vector<AnisotropicQuery> queries;
  const float alphas[] = {0x1p-40f, 1e-6f, 1e-4f, 1e-2f, 1.0f, 1.5f};
  const Vec3d directions[] = {{0, 0, 1},     {1, 0, 0},         {0, 1, 0},        {-1, 0, 0},
                              {0, -1, 0},    {0.6, 0, 0.8},     {0, 0.6, 0.8},    {1, 0, 1e-7},
                              {0, 1, 1e-20}, {1e-20, 1, 1e-30}, {0.7, -0.7, 1e-4}};
  for (const float alpha_x : alphas) {
    for (const float alpha_y : alphas) {
      for (const Vec3d& normal : {Vec3d(0, 0, 1), Vec3d(0, 0, -1), Vec3d(1e-4, 0, -1)}) {
        const Basis<double> frame = LobeFrame(normal.normalized(), Vec3d(1, 1, 0));
        for (const Vec3d& light : directions) {
          for (const Vec3d& view : directions) {
            AnisotropicQuery query =
                MakeQuery(frame, frame.ToWorld(light.normalized()),
                          frame.ToWorld(view.normalized()), {alpha_x, alpha_y});
            for (const float u : {0.0f, 0.37f, 1 - 0x1p-24f}) {
              query.u0 = u;
              query.u1 = u;
              queries.push_back(query);
            }
          }
        }
      }
    }
  }
  bool scalar = true;
  for (const AnisotropicQuery& query : queries) {
    const Terms terms = TermsOf(query);
    const Basis<double> frame = LobeFrame(Vec3d(query.n).normalized(), Vec3d(query.t));
    const Vec3d sample = SampleGgxVisible(frame, Vec3d(query.v).normalized(), terms.alpha,
                                          double{query.u0}, double{query.u1});
    scalar = scalar && std::isfinite(GgxDistribution(terms.angles, terms.alpha)) &&
             std::isfinite(GgxVisiblePdf(terms.angles, terms.alpha)) &&
             std::abs(sample.length() - 1) < 1e-12;
    if (!(terms.angles.n_dot_l > 0)) continue;
    scalar = scalar && VisibilityHeightCorrelated(terms.angles, terms.alpha) > 0 &&
             std::isfinite(VisibilityHeightCorrelated(terms.angles, terms.alpha)) &&
             std::isfinite(VisibilitySeparable(terms.angles, terms.alpha));
  }
  CHECK(scalar);
  ForEachTarget([&](Target) {
    const std::vector<AnisotropicAnswer> answers = AskAnisotropic(queries);
    bool finite = true, unit = true;
    for (size_t i = 0; i < queries.size(); ++i) {
      const AnisotropicAnswer& answer = answers[i];
      finite = finite && std::isfinite(answer.distribution) && answer.distribution >= 0 &&
               std::isfinite(answer.pdf) && answer.pdf >= 0;
      unit = unit && std::abs(answer.sample.length() - 1) < 1e-5f;
      if ((queries[i].n ^ queries[i].l) <= 0) continue;
      finite = finite && !std::isnan(answer.height_correlated) && answer.height_correlated > 0 &&
               !std::isnan(answer.separable) && answer.separable > 0;
    }
    CHECK(finite);
    CHECK(unit);
  });
}

TEST_CASE("SIMD anisotropic terms and samples agree with their double twins on every target") {
  std::mt19937 random(8);
  std::uniform_real_distribution<double> unit(0, 1);
  for (const GgxAlphas<double>& alpha :
       {GgxAlphas<double>{1, 1}, GgxAlphas<double>{1.3, 0.3}, GgxAlphas<double>{0.5, 0.01},
        GgxAlphas<double>{0.1, 1e-3}, GgxAlphas<double>{1e-2, 0.3}}) {
    const double narrow = std::min(alpha.x, alpha.y);
    CAPTURE(alpha.x, alpha.y);
    std::vector<AnisotropicQuery> queries;
    for (int i = 0; i < 4000; ++i) {
      const Vec3d n = Direction(2 * unit(random) - 1, 6.28 * unit(random));
      const Basis<double> frame = LobeFrame(n, Direction(unit(random), 6.28 * unit(random)));
      const Vec3d v = frame.ToWorld(Direction(1e-3 + 0.999 * unit(random), 6.28 * unit(random)));
      const double u0 = unit(random), u1 = 0.99 * unit(random);
      const Vec3d l = SampleGgxVisible(frame, v, alpha, u0, u1);
      if ((l ^ frame.z) < 1e-3) continue;
      AnisotropicQuery query = MakeQuery(frame, l, v, alpha);
      query.u0 = static_cast<float>(u0);
      query.u1 = static_cast<float>(u1);
      queries.push_back(query);
    }
    ForEachTarget([&](Target) {
      const std::vector<AnisotropicAnswer> answers = AskAnisotropic(queries);
      double distribution = 0, pdf = 0, visibility = 0, sample = 0;
      const auto raise = [](double* worst, double got, double reference) {
        *worst = std::max(*worst, std::abs(got / reference - 1));
      };
      for (size_t i = 0; i < queries.size(); ++i) {
        const AnisotropicQuery& query = queries[i];
        const auto [a, rounded] = TermsOf(query);
        raise(&distribution, answers[i].distribution, GgxDistribution(a, rounded));
        raise(&pdf, answers[i].pdf, GgxVisiblePdf(a, rounded));
        raise(&visibility, answers[i].height_correlated, VisibilityHeightCorrelated(a, rounded));
        raise(&visibility, answers[i].separable, VisibilitySeparable(a, rounded));
        const Basis<double> frame = LobeFrame(Vec3d(query.n).normalized(), Vec3d(query.t));
        const Vec3d l = SampleGgxVisible(frame, Vec3d(query.v).normalized(), rounded,
                                         double{query.u0}, double{query.u1});
        sample = std::max(sample, (Vec3d(answers[i].sample) - l).length());
      }
      // The half vector is off by u = 6e-8 rad, which D sees as 4 u over the narrower alpha; of
      // light and viewer opposed by more, since u = l + v is short.
      CHECK(distribution < 64 * 0x1p-24 / narrow + 64 * 0x1p-24);
      CHECK(pdf < 64 * 0x1p-24 / narrow + 2 * 0x1p-24 / 1e-3);
      CHECK(visibility < 2 * 0x1p-24 / 1e-3);
      CHECK(sample < 3e-6);
    });
  }
}

TEST_CASE("tangents become frames, at poles and where they have no direction") {
  std::mt19937 random(8);
  std::uniform_real_distribution<double> unit(-1, 1);
  std::vector<FrameQuery> queries;
  for (int i = 0; i < 500; ++i) {
    const Vec3d n = Vec3d(unit(random), unit(random), unit(random)).normalized();
    queries.push_back({Vec3f(n), Vec3f(Vec3d(unit(random), unit(random), unit(random)))});
  }
  const size_t with_direction = queries.size();
  for (const Vec3f& n : {Vec3f(0, 0, 1), Vec3f(0, 0, -1), Vec3f(0, 1, 0), Vec3f(1, 0, 0)}) {
    for (const Vec3f& t : {n, -n, Vec3f(0, 0, 0), n * 1e30f, n * 1e-30f, Vec3f(1e-38f, 1e-38f, 0),
                           Vec3f(3e38f, -3e38f, 3e38f)}) {
      queries.push_back({n, t});
    }
  }
  const Rotation<float> rotation = RotationOfTurns(0.1f);
  for (FrameQuery& query : queries) {
    query.cos = rotation.cos;
    query.sin = rotation.sin;
  }
  const auto check = [](const Basis<double>& frame, double bound) {
    CHECK(std::abs(frame.x.length() - 1) < bound);
    CHECK(std::abs(frame.x ^ frame.z) < bound);
    CHECK((frame.y - frame.z % frame.x).length() < bound);
  };
  for (const FrameQuery& query : queries) {
    check(LobeFrame(Vec3d(query.n).normalized(), Vec3d(query.t)), 1e-14);
  }
  ForEachTarget([&](Target) {
    const std::vector<FrameAnswer> answers = AskFrames(queries);
    for (size_t i = 0; i < queries.size(); ++i) {
      const FrameAnswer& answer = answers[i];
      const Basis<double> frame{Vec3d(answer.frame_x), Vec3d(answer.frame_y), Vec3d(queries[i].n)};
      check(frame, 1e-6);
      const Rotation<double> by{queries[i].cos, queries[i].sin};
      CHECK((Vec3d(answer.rotated) - RotatedTangent(frame.z, frame.x, by)).length() < 1e-6);
      if (i >= with_direction) continue;
      const Basis<double> twin = LobeFrame(frame.z.normalized(), Vec3d(queries[i].t));
      const double slant = (Vec3d(queries[i].t).normalized() % frame.z).length();
      CHECK((twin.x - frame.x).length() < 1e-6 / slant);
    }
  });
}

TEST_CASE("the tangent turns counter-clockwise about the normal") {
  const Vec3d n(0, 0, 1), t(1, 0, 0);
  CHECK(RotatedTangent(n, t, RotationOfTurns(0.25)) == Vec3d(0, 1, 0));
  CHECK(RotatedTangent(n, t, RotationOfDegrees(180.0)) == Vec3d(-1, 0, 0));
  CHECK(RotatedTangent(n, t, RotationOfTurns(-0.25)) == Vec3d(0, -1, 0));
  CHECK(RotatedTangent(n, t, RotationOfTurns(1.0)) == t);
  const Rotation<double> eighth = RotationOfDegrees(30.0);
  CHECK(eighth.cos == Approx(std::sqrt(0.75)).epsilon(1e-15));
  CHECK(eighth.sin == Approx(0.5).epsilon(1e-15));
  const Rotation<double> many = RotationOfTurns(-7.35);
  CHECK(many.cos == Approx(std::cos(-2 * M_PI * 0.35)).epsilon(1e-13));
  CHECK(many.sin == Approx(std::sin(-2 * M_PI * 0.35)).epsilon(1e-13));
}

TEST_CASE("alphas of four formats are those of their definitions") {
  const auto is = [](const GgxAlphas<double>& alpha, double x, double y) {
    return alpha.x == Approx(x).margin(5e-5) && alpha.y == Approx(y).margin(5e-5);
  };
  // Roughness 0.5, by hand.
  CHECK(is(OpenPbrAlphas(0.5, 0.5, AlphaLimit::kNone), 0.3162, 0.1581));
  CHECK(is(OpenPbrAlphas(0.5, 0.9, AlphaLimit::kNone), 0.3518, 0.0352));
  CHECK(is(StandardSurfaceAlphas(0.5, 0.5), 0.3536, 0.1768));
  CHECK(is(StandardSurfaceAlphas(0.5, 0.9), 0.7906, 0.0791));
  CHECK(is(GltfAlphas(0.5, 0.5), 0.4375, 0.25));
  CHECK(is(GltfAlphas(0.5, 0.9), 0.8575, 0.25));
  CHECK(is(DisneyAlphas(0.5, 0.5), 0.3371, 0.1854));
  CHECK(is(DisneyAlphas(0.5, 0.9), 0.5735, 0.1090));
  // Without anisotropy all are isotropic; OpenPBR's keeps the mean square.
  for (const double roughness : {0.0, 0.01, 0.3, 1.0}) {
    const double alpha = roughness * roughness;
    for (const GgxAlphas<double>& of :
         {OpenPbrAlphas(roughness, 0.0, AlphaLimit::kNone), GltfAlphas(roughness, 0.0),
          StandardSurfaceAlphas(roughness, 0.0), DisneyAlphas(roughness, 0.0)}) {
      CHECK(of.x == Approx(alpha).epsilon(1e-15));
      CHECK(of.y == Approx(alpha).epsilon(1e-15));
    }
    const GgxAlphas<double> open = OpenPbrAlphas(roughness, 0.7, AlphaLimit::kNone);
    CHECK(open.x * open.x + open.y * open.y == Approx(2 * alpha * alpha).epsilon(1e-14));
  }
  CHECK(OpenPbrAlphas(1.0, 1.0, AlphaLimit::kNone).x == Approx(std::sqrt(2)).epsilon(1e-15));
  CHECK(OpenPbrAlphas(1.0, 1.0, AlphaLimit::kOne).x == 1);
  CHECK(StandardSurfaceAlphas(0.1, 1.0).y == StandardSurfaceAlphas(0.1, 0.98).y);
}

TEST_CASE("alphas tell OpenPBR's and glTF's parameters, where these have them") {
  for (const double roughness : {0.05, 0.3, 0.8}) {
    for (const double anisotropy : {0.0, 0.2, 0.7, 0.999}) {
      CAPTURE(roughness, anisotropy);
      const auto open = OpenPbrFromAlphas(OpenPbrAlphas(roughness, anisotropy, AlphaLimit::kNone));
      REQUIRE(open);
      CHECK(open->roughness == Approx(roughness).epsilon(1e-14));
      CHECK(open->anisotropy == Approx(anisotropy).margin(1e-14));
      const auto gltf = GltfFromAlphas(GltfAlphas(roughness, anisotropy));
      REQUIRE(gltf);
      CHECK(gltf->roughness == Approx(roughness).epsilon(1e-14));
      CHECK(gltf->anisotropy == Approx(anisotropy).margin(1e-7));
      // From one to the other and back.
      const GgxAlphas<double> alpha = GltfAlphas(roughness, anisotropy);
      const auto there = OpenPbrFromAlphas(alpha);
      REQUIRE(there);
      const GgxAlphas<double> back =
          OpenPbrAlphas(there->roughness, there->anisotropy, AlphaLimit::kNone);
      CHECK(back.x == Approx(alpha.x).epsilon(1e-14));
      CHECK(back.y == Approx(alpha.y).epsilon(1e-13));
    }
  }
  CHECK(!GltfFromAlphas(GgxAlphas<double>{1.2, 0.3}));
  CHECK(!GltfFromAlphas(GgxAlphas<double>{0.2, 0.3}));
  CHECK(!OpenPbrFromAlphas(GgxAlphas<double>{0.2, 0.3}));
  CHECK(GltfFromAlphas(GgxAlphas<double>{1, 1})->anisotropy == 0);
  CHECK(OpenPbrFromAlphas(GgxAlphas<double>{})->anisotropy == 0);
}

}  // namespace
}  // namespace nacre
