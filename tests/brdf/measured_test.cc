// SPDX-License-Identifier: Apache-2.0
// tests/brdf/measured_test.cc: measured BRDFs: the angles of MERL tables by their definition, cells
// and interpolation, warps, symmetries, samples by chi-squared, and the SIMD twins.
#include "brdf/measured.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "brdf/measured_kernel.h"
#include "brdf/sphere_cells.h"
#include "catch.h"
#include "chi_squared.h"
#include "measured_tables.h"
#include "targets.h"

namespace nacre {
namespace {

const Basis<double> kUpright{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
constexpr auto kLinear = MeasuredInterpolation::kLinear;
constexpr auto kNearest = MeasuredInterpolation::kNearest;

double Uniform(std::mt19937* random) { return static_cast<double>((*random)()) * 0x1p-32; }

Vec3d At(double n_dot, double phi) {
  const double sin = std::sqrt(std::max(1 - n_dot * n_dot, 0.0));
  return {sin * std::cos(phi), sin * std::sin(phi), n_dot};
}

// A direction at least this much above the surface.
Vec3d Above(double least, std::mt19937* random) {
  const double cosine = least + (1 - least) * Uniform(random);
  return At(cosine, 2 * M_PI * Uniform(random));
}

Vec3d RotatedZ(const Vec3d& v, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {c * v.x - s * v.y, s * v.x + c * v.y, v.z};
}
Vec3d RotatedY(const Vec3d& v, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {c * v.x + s * v.z, v.y, c * v.z - s * v.x};
}

const MeasuredBrdf& Gold() {
  static const MeasuredBrdf brdf = AnalyticMerl();
  return brdf;
}

// All kinds of tables, by name.
struct NamedBrdf {
  const char* name;
  const MeasuredBrdf* brdf;
};
std::vector<NamedBrdf> AllTables() {
  static const MeasuredBrdf isotropic = MakeRglBrdf(RandomRgl(1));
  static const MeasuredBrdf whole = MakeRglBrdf(RandomRgl(2, 5, 1), 1);
  static const MeasuredBrdf half = MakeRglBrdf(RandomRgl(3, 4, 2), 2);
  static const MeasuredBrdf quarter = MakeRglBrdf(RandomRgl(4, 3, 4), 4);
  return {{"MERL", &Gold()},
          {"isotropic", &isotropic},
          {"anisotropic", &whole},
          {"half of the azimuths", &half},
          {"a quarter of the azimuths", &quarter}};
}

TEST_CASE("the angles of MERL tables are those of Rusinkiewicz") {
  std::mt19937 random(1);
  for (int i = 0; i < 2000; ++i) {
    const Vec3d l = Above(0.01, &random), v = Above(0.01, &random);
    const RusinkiewiczAngles angles = ComputeRusinkiewicz({0, 0, 1}, l, v);
    // The definition: the half vector is turned to the normal, and the light with it.
    const Vec3d h = (l + v).normalized();
    const double theta = std::acos(h.z), phi = std::atan2(h.y, h.x);
    const Vec3d d = RotatedY(RotatedZ(l, -phi), -theta);
    CHECK(std::abs(angles.theta_half - theta) < 1e-7);
    CHECK(std::abs(angles.theta_diff - std::acos(std::min(d.z, 1.0))) < 1e-7);
    const double turned = std::atan2(d.y, d.x);
    const double expected = turned < 0 ? turned + M_PI : turned;
    const double off = std::abs(angles.phi_diff - expected);
    CHECK(std::min(off, M_PI - off) * std::hypot(d.x, d.y) < 1e-7);
  }
}

TEST_CASE("cells of MERL tables are found from their centres, either way round") {
  MerlTable table;
  table.rgb.resize(3 * MerlTable::kCells);
  std::mt19937 random(2);
  for (float& value : table.rgb) value = static_cast<float>(Uniform(&random));
  int seen = 0;
  for (int i = 0; i < 3000; ++i) {
    const size_t cell = random() % MerlTable::kCells;
    const size_t phi = cell % 180, diff = cell / 180 % 90, half = cell / 180 / 90;
    const auto [l0, v0] = MerlDirections(half, diff, phi);
    if (!(l0.z > 0.01) || !(v0.z > 0.01)) continue;
    ++seen;
    const double turn = 2 * M_PI * Uniform(&random);
    const Vec3d l = RotatedZ(l0, turn), v = RotatedZ(v0, turn), n(0, 0, 1);
    CHECK(EvaluateMerl(table, kNearest, n, l, v) == MerlValue(table, cell));
    CHECK(EvaluateMerl(table, kNearest, n, v, l) == MerlValue(table, cell));
    CHECK((EvaluateMerl(table, kLinear, n, l, v) - MerlValue(table, cell)).length() < 1e-6);
  }
  CHECK(seen > 1000);
}

TEST_CASE("linear interpolation of MERL tables follows the model between cells") {
  const AnalyticGgx model;
  std::mt19937 random(3);
  std::vector<double> linear, nearest;
  for (int i = 0; i < 2000; ++i) {
    const Vec3d l = Above(0.2, &random), v = Above(0.2, &random);
    const double exact = model({0, 0, 1}, l, v).x * l.z;
    linear.push_back(std::abs(EvaluateMeasured(Gold(), kLinear, kUpright, l, v).x / exact - 1));
    nearest.push_back(std::abs(EvaluateMeasured(Gold(), kNearest, kUpright, l, v).x / exact - 1));
  }
  std::sort(linear.begin(), linear.end());
  std::sort(nearest.begin(), nearest.end());
  CHECK(linear[1000] < 2e-3);
  CHECK(linear.back() < 0.03);
  CHECK(nearest[1000] > 5 * linear[1000]);
}

TEST_CASE("warps and their inverses agree, and have the density") {
  std::mt19937 random(4);
  for (const auto& [name, brdf] : AllTables()) {
    CAPTURE(name);
    for (int i = 0; i < 500; ++i) {
      const Slices slices =
          SlicesAt(brdf->half.angles, (2 * Uniform(&random) - 1) * M_PI, Uniform(&random) * M_PI_2);
      const SquarePoint u{Uniform(&random), Uniform(&random)};
      const SquarePoint p = WarpForward(brdf->half, slices, u);
      const SquarePoint back = WarpInverse(brdf->half, slices, p);
      CHECK(std::abs(back.x - u.x) < 1e-5);
      CHECK(std::abs(back.y - u.y) < 1e-5);
      // The area that the inverse makes of a small square is the density times its own.
      constexpr double kStep = 1e-4;
      if (p.x > 1 - kStep || p.y > 1 - kStep) continue;
      const SquarePoint right = WarpInverse(brdf->half, slices, {p.x + kStep, p.y});
      const SquarePoint up = WarpInverse(brdf->half, slices, {p.x, p.y + kStep});
      const double area = (right.x - back.x) * (up.y - back.y);
      const double density = WarpDensity(brdf->half, slices, {p.x + kStep / 2, p.y + kStep / 2});
      CHECK(std::abs(area / (kStep * kStep) - density) < 0.02 * density + 1e-3);
    }
  }
}

// With a density that is 1 everywhere, the table of colours is looked up at the half vector itself.
TEST_CASE("tables of EPFL's form are products of distribution and colour") {
  RandomRgl file(5);
  for (const char* name : {"vndf", "luminance"}) {
    std::vector<float>& values = file.At(name).values;
    std::fill(values.begin(), values.end(), 3.0f);
  }
  std::vector<float>& sigmas = file.At("sigma").values;
  for (size_t k = 0; k < sigmas.size(); ++k) sigmas[k] = 0.5f + 0.1f * static_cast<float>(k % 5);
  const MeasuredBrdf brdf = MakeRglBrdf(file);
  const auto& table = std::get<RglTable>(brdf.table);
  const auto bilinear = [](const float* t, size_t w, size_t h, double x, double y) {
    x *= static_cast<double>(w - 1);
    y *= static_cast<double>(h - 1);
    const size_t i = std::min(static_cast<size_t>(x), w - 2);
    const size_t j = std::min(static_cast<size_t>(y), h - 2);
    const double a = x - static_cast<double>(i), b = y - static_cast<double>(j);
    const float* const at = t + j * w + i;
    return (at[0] * (1 - a) + at[1] * a) * (1 - b) + (at[w] * (1 - a) + at[w + 1] * a) * b;
  };
  std::mt19937 random(6);
  for (int i = 0; i < 500; ++i) {
    const Vec3d l = Above(0.05, &random), v = Above(0.05, &random);
    const Vec3d h = (l + v).normalized();
    const double theta_v = std::acos(v.z);
    const double turn = std::atan2(h.y, h.x) - std::atan2(v.y, v.x) + M_PI;
    const double y = turn / (2 * M_PI) - std::floor(turn / (2 * M_PI));
    const double x = std::sqrt(2 * std::acos(h.z) / M_PI);
    size_t slice = 0;
    while (slice + 2 < file.theta.size() && file.theta[slice + 1] <= theta_v) ++slice;
    const double t =
        std::min((theta_v - file.theta[slice]) / (file.theta[slice + 1] - file.theta[slice]), 1.0);
    const double ndf = bilinear(table.ndf.values.data(), 9, 4, x, y);
    const double sigma = 0.5 + 0.1 * 4 * std::sqrt(2 * theta_v / M_PI);
    const Rgb value = EvaluateMeasured(brdf, kLinear, kUpright, l, v);
    for (int c = 0; c < 3; ++c) {
      const float* const rgb = table.rgb.data() + (slice * 3 + static_cast<size_t>(c)) * 49;
      const double color =
          bilinear(rgb, 7, 7, x, y) * (1 - t) + bilinear(rgb + 3 * 49, 7, 7, x, y) * t;
      CHECK(std::abs(value[c] - color * ndf / (4 * sigma)) < 1e-5 * value[c]);
    }
  }
}

TEST_CASE("azimuths that were not measured follow by symmetry") {
  const auto tables = AllTables();
  const MeasuredBrdf &half = *tables[3].brdf, &quarter = *tables[4].brdf;
  std::mt19937 random(7);
  double whole_differs = 0;
  for (int i = 0; i < 200; ++i) {
    const Vec3d l = Above(0.05, &random), v = Above(0.05, &random);
    const auto value = [&](const MeasuredBrdf& brdf, double x, double y) {
      const Vec3d signs(x, y, 1);
      return EvaluateMeasured(brdf, kLinear, kUpright, l * signs, v * signs);
    };
    for (const double x : {-1.0, 1.0}) {
      for (const double y : {-1.0, 1.0}) {
        CHECK((value(quarter, x, y) - value(quarter, 1, 1)).length() < 1e-12);
      }
    }
    CHECK((value(half, -1, -1) - value(half, 1, 1)).length() < 1e-12);
    whole_differs += (value(half, -1, 1) - value(half, 1, 1)).length();
  }
  CHECK(whole_differs > 1);
}

TEST_CASE("measured BRDFs are sampled with their pdfs") {
  constexpr int kSamples = 40000;
  for (const auto& [name, brdf] : AllTables()) {
    for (const double n_dot_v : {1.0, 0.7, 0.1}) {
      CAPTURE(name, n_dot_v);
      const Vec3d v = At(n_dot_v, 0.7);
      const SphereCells cells{BasisAbout(Mirrored(v, kUpright.z)), 0.3};
      std::vector<double> probabilities = cells.Integrate(
          [&, brdf = brdf](const Vec3d& l) { return MeasuredPdf(*brdf, kUpright, v, l); }, 60);
      std::vector<double> counts(probabilities.size());
      std::mt19937 random(8);
      double valid = 0, total = 0;
      for (int i = 0; i < kSamples; ++i) {
        const double u0 = Uniform(&random), u1 = Uniform(&random);
        const Vec3d l = SampleMeasured(*brdf, kUpright, v, u0, u1);
        CHECK(std::abs(l.length() - 1) < 1e-6);
        if (!(MeasuredPdf(*brdf, kUpright, v, l) > 0)) continue;
        ++counts[cells.CellOf(l)];
        ++valid;
      }
      for (const double p : probabilities) total += p;
      // Half vectors that face away from the viewer make no directions.
      CHECK(std::abs(total - valid / kSamples) < 0.02);
      CHECK(FollowsProbabilities(counts, kSamples, probabilities));
    }
  }
}

TEST_CASE("samples of MERL tables have weights near the albedo") {
  for (const double n_dot_v : {1.0, 0.7, 0.3}) {
    CAPTURE(n_dot_v);
    const Vec3d v = At(n_dot_v, 0);
    std::mt19937 random(9);
    constexpr int kSamples = 100000;
    double sum = 0, sum2 = 0;
    for (int i = 0; i < kSamples; ++i) {
      const double u0 = Uniform(&random), u1 = Uniform(&random);
      const Vec3d l = SampleMeasured(Gold(), kUpright, v, u0, u1);
      const double f = EvaluateMeasured(Gold(), kLinear, kUpright, l, v).y;
      const double weight = f > 0 ? f / MeasuredPdf(Gold(), kUpright, v, l) : 0;
      sum += weight / kSamples;
      sum2 += weight * weight / kSamples;
    }
    CHECK(std::abs(sum - MeasuredAlbedo(Gold(), n_dot_v).y) < 0.01);
    CHECK(sum2 < 1.35 * sum * sum);
  }
}

TEST_CASE("measured BRDFs reflect alike on every target") {
  std::mt19937 random(10);
  std::vector<MeasuredQuery> queries;
  const Vec3d n = Vec3d(0.3, -0.5, 0.7).normalized();
  const Basis<double> frame = LobeFrame(n, Vec3d(1, 0.2, 0.1));
  for (int i = 0; i < 1000; ++i) {
    MeasuredQuery query;
    query.n = Vec3f(frame.z);
    query.tangent = Vec3f(frame.x);
    query.v = Vec3f(frame.ToWorld(Above(0.02, &random)));
    query.l = Vec3f(frame.ToWorld(Above(-0.1, &random)));
    query.u0 = static_cast<float>(random() >> 8) * 0x1p-24f;
    query.u1 = static_cast<float>(random() >> 8) * 0x1p-24f;
    queries.push_back(query);
  }
  for (const auto& [name, brdf] : AllTables()) {
    CAPTURE(name);
    ForEachTarget([&, brdf = brdf](Target) {
      const std::vector<MeasuredAnswer> answers = AskMeasured(*brdf, queries);
      int other_cells = 0, far_samples = 0;
      for (size_t i = 0; i < queries.size(); ++i) {
        const MeasuredQuery& query = queries[i];
        const Vec3d l(query.l), v(query.v);
        const Basis<double> lobe = LobeFrame(Vec3d(query.n), Vec3d(query.tangent));
        const Rgb linear = EvaluateMeasured(*brdf, kLinear, lobe, l, v);
        const Rgb nearest = EvaluateMeasured(*brdf, kNearest, lobe, l, v);
        const double pdf = MeasuredPdf(*brdf, lobe, v, l);
        CAPTURE(i, lobe.z ^ l, lobe.z ^ v);
        const double grazing = 1e-6 / std::max(std::min(std::abs(lobe.z ^ l), lobe.z ^ v), 1e-3);
        const double tolerance = 1e-4 + 10 * grazing;
        CHECK((Rgb(Vec3d(answers[i].linear)) - linear).length() <=
              tolerance * linear.length() + 1e-5);
        other_cells += (Rgb(Vec3d(answers[i].nearest)) - nearest).length() >
                       tolerance * nearest.length() + 1e-5;
        CHECK(std::abs(answers[i].pdf - pdf) <= 2e-4 * pdf + 1e-4);
        const Vec3d sample = SampleMeasured(*brdf, lobe, v, double{query.u0}, double{query.u1});
        far_samples += (Vec3d(answers[i].sample) - sample).length() > 1e-3;
      }
      // Rounding puts directions on the edge of a cell into the next one, and samples beside the
      // step between the two strategies into the other.
      CHECK(other_cells <= 5);
      CHECK(far_samples <= 2);
    });
  }
}

}  // namespace
}  // namespace nacre
