// SPDX-License-Identifier: Apache-2.0
// tests/brdf/fresnel_table_test.cc: tables of thin films against their curves, and the SIMD twin
// against the scalar one.
#include "brdf/fresnel_table.h"

#include <cmath>

#include "brdf/energy_kernel.h"
#include "brdf/fresnel.h"
#include "catch.h"
#include "tables.h"
#include "targets.h"

namespace nacre {
namespace {

struct Case {
  const char* name;
  ThinFilm film;
  RgbSubstrate substrate;
};

const RgbSubstrate kGold{Substrate{0.15, 3.4}, Substrate{0.45, 2.4}, Substrate{1.45, 1.9}};

std::vector<Case> Cases(double thickness_nm) {
  return {
      {"varnish on glass", {1, 1.4, thickness_nm}, SameSubstrate({1.5, 0})},
      {"dense film on glass", {1, 2.3, thickness_nm}, SameSubstrate({1.5, 0})},
      {"bubble", {1, 1.33, thickness_nm}, SameSubstrate({1, 0})},
      {"film on gold", {1, 1.5, thickness_nm}, kGold},
      {"film on aluminium", {1, 1.4, thickness_nm}, SameSubstrate({0.8, 5.5})},
      {"film on gold under a coat", {1.5, 1.9, thickness_nm}, kGold},
      {"film under a coat on a thinner base", {1.6, 1.8, thickness_nm}, SameSubstrate({1.33, 0})},
      {"thinner film under a coat", {1.6, 1.4, thickness_nm}, SameSubstrate({1.8, 0})},
      {"thinner film under a coat on gold", {1.6, 1.4, thickness_nm}, kGold},
      {"thinner film and base under a coat", {1.6, 1.4, thickness_nm}, SameSubstrate({1.5, 0})},
  };
}

// Many near grazing incidence.
std::vector<float> Cosines() {
  std::vector<float> cosines{0.0f, 1e-30f, 1e-7f, 1 - 0x1p-24f, 1.0f};
  for (int i = 1; i <= 700; ++i) {
    const float x = static_cast<float>(i) / 701;
    cosines.push_back(i % 3 == 0 ? x * x * x * x : x);
  }
  return cosines;
}

double Clamped(double x) { return std::clamp(x, 0.0, 1.0); }

// How far the curve moves within the rounding error of the cosine and of a critical cosine.
double MovesBy(const FresnelCurve& curve, double cosine, int channel, double loss) {
  constexpr double kRounding = 0x1p-24;
  const auto off = [&](double at) {
    return std::abs(curve.loss(std::clamp(at, 0.0, 1.0))[channel] - loss);
  };
  return std::max(off(cosine - kRounding), off(cosine + kRounding));
}

// The largest error of a table beyond what rounding the cosine does, and within a degree of grazing
// incidence the largest error relative to 1 - R or, where that falls faster, to the cosine.
struct TableErrors {
  double absolute = 0, grazing = 0;
};

TableErrors FindErrors(const FresnelTable& table, const FresnelCurve& curve) {
  TableErrors errors;
  for (const float cosine : Cosines()) {
    const double c = double{cosine};
    const Rgb want = curve.loss(c);
    const std::array<double, 3> got = FresnelTableLoss(table, c);
    for (int i = 0; i < 3; ++i) {
      const double off = std::abs(got[static_cast<size_t>(i)] - Clamped(want[i]));
      if (off > errors.absolute) {
        errors.absolute = std::max(errors.absolute, off - MovesBy(curve, c, i, want[i]));
      }
      if (c > 0 && c < 0.017) {
        errors.grazing = std::max(errors.grazing, off / std::max(want[i], c));
      }
    }
  }
  return errors;
}

TEST_CASE("tables are their curves to 1e-5 for films up to 2 um") {
  for (const double thickness : {0.0, 30.0, 400.0, 2000.0}) {
    for (const Case& of : Cases(thickness)) {
      for (const ThinFilmModel model :
           {ThinFilmModel::kSpectral, ThinFilmModel::kThreeLines, ThinFilmModel::kBelcourBarla}) {
        ThinFilmOptions options;
        options.model = model;
        const FresnelCurve curve = ThinFilmCurve(of.film, of.substrate, options);
        const FresnelTable table = MakeFresnelTable(curve);
        const TableErrors errors = FindErrors(table, curve);
        CAPTURE(of.name, thickness, static_cast<int>(model), table.intervals);
        CHECK(errors.absolute <= 1e-5);
        if (table.slope > 0) CHECK(errors.grazing <= 5e-3);
        // 1 - R is divided by the cosine wherever it falls with it.
        const bool falls = curve.critical_cosine == 0 && of.substrate[0].eta != 1;
        if (falls && model != ThinFilmModel::kBelcourBarla) CHECK(table.slope == 1);
        CHECK(static_cast<size_t>(table.intervals + 3) * FresnelTable::kRow ==
              table.coefficients.size());
      }
    }
  }
}

TEST_CASE("tables of films of 10 um have the stated errors") {
  for (const Case& of : Cases(10000)) {
    CAPTURE(of.name);
    const bool tunnelled = of.film.index < of.film.outside;
    const FresnelCurve spectral = ThinFilmCurve(of.film, of.substrate);
    CHECK(FindErrors(MakeFresnelTable(spectral), spectral).absolute <= (tunnelled ? 1e-3 : 2e-5));
    ThinFilmOptions options;
    options.model = ThinFilmModel::kThreeLines;
    const FresnelCurve lines = ThinFilmCurve(of.film, of.substrate, options);
    if (!tunnelled) CHECK(FindErrors(MakeFresnelTable(lines), lines).absolute <= 1e-5);
  }
}

TEST_CASE("SIMD tables are the scalar ones on every target") {
  std::vector<FresnelTable> tables;
  for (const double thickness : {0.0, 30.0, 400.0, 2000.0}) {
    for (const Case& of : Cases(thickness)) {
      tables.push_back(MakeFresnelTable(ThinFilmCurve(of.film, of.substrate)));
    }
  }
  const std::vector<float> cosines = Cosines();
  ForEachTarget([&](Target) {
    for (const FresnelTable& table : tables) {
      const std::vector<Vec3f> losses = EvaluateFresnelTable(table, cosines);
      for (size_t i = 0; i < cosines.size(); ++i) {
        const std::array<float, 3> want = FresnelTableLoss(table, cosines[i]);
        const std::array<double, 3> exact = FresnelTableLoss(table, double{cosines[i]});
        CAPTURE(cosines[i], table.intervals);
        // Positions have a rounding error of 2^-23 of the table's length, in which steep curves
        // change a little; coefficients up to 6 are multiplied by the cosine.
        for (size_t c = 0; c < 3; ++c) {
          const float got = losses[i][static_cast<int>(c)];
          CHECK(std::abs(got - want[c]) <= 1e-5f);
          CHECK(std::abs(double{got} - exact[c]) <= 1e-5);
          CHECK((got >= 0 && got <= 1));
          // Near grazing incidence the error falls with the cosine, as 1 - R does.
          if (table.slope > 0) {
            CHECK(std::abs(double{got} - exact[c]) <= 1e-4 * exact[c] + 1e-5 * cosines[i]);
          }
        }
      }
    }
  });
}

TEST_CASE("a table goes to its limits") {
  // Grazing incidence, where all is reflected, and below the critical cosine.
  const FresnelTable glass =
      MakeFresnelTable(ThinFilmCurve({1, 1.4, 300}, SameSubstrate({1.5, 0})));
  CHECK(FresnelTableLoss(glass, 0.0)[1] == 0);
  CHECK(FresnelTableLoss(glass, 1e-12)[1] > 0);
  const ThinFilm under_coat{1.6, 1.8, 300};
  const FresnelCurve total = ThinFilmCurve(under_coat, SameSubstrate({1.33, 0}));
  const FresnelTable table = MakeFresnelTable(total);
  CHECK(FresnelTableLoss(table, total.critical_cosine - 1e-6)[0] <= 1e-6);
  CHECK(FresnelTableLoss(table, total.critical_cosine + 1e-3)[0] > 0.01);
  // No interface at all: R is 0 even at grazing incidence.
  const FresnelTable none = MakeFresnelTable(ThinFilmCurve({1, 1, 0}, SameSubstrate({1, 0})));
  for (const double c : {0.0, 1e-6, 0.5, 1.0}) CHECK(FresnelTableLoss(none, c)[0] == Approx(1));
  // Colours that leave the gamut are clamped.
  bool clamped = false;
  const FresnelCurve vivid = ThinFilmCurve({1, 1.5, 260}, kGold);
  const FresnelTable vivid_table = MakeFresnelTable(vivid);
  for (int step = 0; step <= 100; ++step) {
    const double c = step / 100.0;
    const Rgb loss = vivid.loss(c);
    for (int i = 0; i < 3; ++i) {
      clamped = clamped || loss[i] < 0 || loss[i] > 1;
      CHECK(FresnelTableLoss(vivid_table, c)[static_cast<size_t>(i)] ==
            Approx(Clamped(loss[i])).margin(1e-5));
    }
  }
}

TEST_CASE("a film's curve is blended with the interface without film") {
  const ThinFilm film{1, 1.4, 15};
  const RgbSubstrate glass = SameSubstrate({1.5, 0});
  const auto bare = [](double c) {
    return Rgb(1, 1, 1) * (1 - FresnelSchlick(0.9, Power5(1 - c)));
  };
  const double share = ThinFilmShare(film.thickness_nm, 30);
  const FresnelCurve blend = ThinFilmCurve(film, glass, {}, share, bare);
  const FresnelCurve covered = ThinFilmCurve(film, glass);
  for (const double c : {0.01, 0.5, 1.0}) {
    CHECK(blend.loss(c).x == Approx(share * covered.loss(c).x + (1 - share) * bare(c).x));
  }
  const FresnelCurve absent = ThinFilmCurve(film, glass, {}, 0, bare);
  CHECK(absent.loss(0.4).y == Approx(bare(0.4).y));
}

TEST_CASE("averages over the hemisphere are the table's", "[table]") {
  const nlohmann::json table = LoadTable("thin_film");
  REQUIRE(table.at("average").size() >= 6);
  for (const auto& row : table.at("average")) {
    CAPTURE(row.dump());
    const ThinFilm film{TableNumber(row.at("outside")), TableNumber(row.at("index")),
                        TableNumber(row.at("thickness"))};
    const Substrate below{TableNumber(row.at("eta")), TableNumber(row.at("k"))};
    const double line = TableNumber(row.at("wavelength"));
    ThinFilmOptions options;
    options.model = ThinFilmModel::kThreeLines;
    options.lines_nm = {line, line, line};
    const FresnelCurve curve = ThinFilmCurve(film, SameSubstrate(below), options);
    const double want = TableNumber(row.at("loss"));
    CHECK(AverageLoss(curve).x == Approx(want).margin(1e-8));
    CHECK(AverageLoss(MakeFresnelTable(curve)).z == Approx(want).margin(2e-6));
  }
  // Without film, Fresnel's average.
  const FresnelCurve glass = ThinFilmCurve({1, 1.5, 0}, SameSubstrate({1.5, 0}));
  CHECK(AverageLoss(glass).y == Approx(1 - AverageDielectric(1.5)).margin(2e-7));
  const FresnelCurve metal = ThinFilmCurve({1, 1.5, 0}, SameSubstrate({0.2, 3}));
  CHECK(AverageLoss(metal).y == Approx(1 - AverageConductor(0.2, 3)).margin(2e-7));
}

}  // namespace
}  // namespace nacre
