// SPDX-License-Identifier: Apache-2.0
// tests/brdf/thin_film_test.cc: reflectances of thin films against the table, against numbers that
// others computed, and in their limits.
#include "brdf/thin_film.h"

#include <cmath>
#include <map>

#include "brdf/fresnel.h"
#include "brdf/ggx.h"
#include "brdf/thin_film_spectrum.h"
#include "catch.h"
#include "tables.h"

namespace nacre {
namespace {

ThinFilm FilmOf(const nlohmann::json& row) {
  return {TableNumber(row.at("outside")), TableNumber(row.at("index")),
          TableNumber(row.at("thickness"))};
}

Substrate SubstrateOf(const nlohmann::json& row) {
  return {TableNumber(row.at("eta")), TableNumber(row.at("k"))};
}

// A row of a table whose columns are named once for all.
class NamedRow {
 public:
  NamedRow(const nlohmann::json& table, const nlohmann::json& row) {
    for (size_t i = 0; i < row.size(); ++i) {
      values_[table.at("columns").at(i).get<std::string>()] = row.at(i).get<double>();
    }
  }
  double operator[](const std::string& name) const { return values_.at(name); }
  Rgb Colour(const std::string& name) const {
    const NamedRow& row = *this;
    return {row[name + ".r"], row[name + ".g"], row[name + ".b"]};
  }
  Vec3d Direction(const std::string& name) const {
    const NamedRow& row = *this;
    return Vec3d(row[name + ".x"], row[name + ".y"], row[name + ".z"]).normalized();
  }

 private:
  std::map<std::string, double> values_;
};

double LargestDifference(const Rgb& a, const Rgb& b) {
  return std::max({std::abs(a.x - b.x), std::abs(a.y - b.y), std::abs(a.z - b.z)});
}

Rgb Reflected(const Rgb& loss) { return Rgb(1, 1, 1) - loss; }

TEST_CASE("Airy's sum is the table's", "[table]") {
  const nlohmann::json table = LoadTable("thin_film");
  REQUIRE(table.at("airy").size() >= 100);
  for (const auto& row : table.at("airy")) {
    CAPTURE(row.dump());
    const ThinFilmReflectance got =
        AiryReflectance(FilmOf(row), SubstrateOf(row), TableNumber(row.at("cosine")),
                        TableNumber(row.at("wavelength")));
    const double loss = TableNumber(row.at("loss"));
    // Some 30 roundings, and what the inputs' own rounding does, which the sines of phases of many
    // periods magnify: all of that is in the condition number.
    const double relative = (30 + 4 * TableNumber(row.at("cond"))) * 0x1p-53;
    CHECK(std::abs(got.loss - loss) <= relative * loss + 1e-50);
    CHECK(std::abs(got.reflected - TableNumber(row.at("R"))) <= relative + 30 * 0x1p-53);
  }
}

TEST_CASE("a film's colour is the table's", "[table]") {
  const nlohmann::json table = LoadTable("thin_film");
  REQUIRE(table.at("spectral").size() >= 40);
  for (const auto& row : table.at("spectral")) {
    CAPTURE(row.dump());
    const ThinFilm film = FilmOf(row);
    const RgbSubstrate substrate = SameSubstrate(SubstrateOf(row));
    const Illuminant illuminant =
        row.at("light") == "d65" ? Illuminant::kD65 : Illuminant::kEqualEnergy;
    const double cosine = TableNumber(row.at("cosine"));
    const auto& losses = row.at("loss");
    const Rgb want(TableNumber(losses[0]), TableNumber(losses[1]), TableNumber(losses[2]));
    // D65 has corners, which a sum over wavelengths is less accurate for.
    const double tolerance = illuminant == Illuminant::kD65 ? 2e-5 : 3e-6;
    CHECK(LargestDifference(SpectralLossByQuadrature(film, substrate, cosine, illuminant), want) <=
          tolerance);
    CHECK(LargestDifference(SpectralLoss(film, substrate, cosine, illuminant), want) <= 2e-5);
    if (film.thickness_nm * film.index < 2000) {
      CHECK(LargestDifference(SpectralLoss(film, substrate, cosine, illuminant), want) <=
            tolerance);
    }
  }
}

TEST_CASE("films are as others computed them", "[table]") {
  const nlohmann::json tables = LoadTable("thin_film_others");
  const nlohmann::json& spectra = tables.at("spectra");
  for (const auto& json : spectra.at("rows")) {
    CAPTURE(json.dump());
    const NamedRow row(spectra, json);
    const ThinFilm film{1, row["n2"], row["d_nm"]};
    const Substrate below{row["n3"], row["k3"]};
    const double cosine = row["c"];
    const double f0 = FresnelF0(below.eta, below.k);
    const RgbSubstrate substrate = SameSubstrate(below);
    CHECK(LargestDifference(Reflected(ThreeLineLoss(film, substrate, cosine)),
                            row.Colour("lines")) <= 1e-6);
    CHECK(LargestDifference(GltfIridescence(film, Rgb(f0, f0, f0), cosine), row.Colour("gltf")) <=
          1e-5);
    // Their colour matching functions are straight between the CIE's wavelengths, 5 nm apart.
    CHECK(LargestDifference(Reflected(SpectralLoss(film, substrate, cosine, Illuminant::kD65)),
                            row.Colour("exact")) <= 2e-3);
  }

  const nlohmann::json& gltf = tables.at("gltf");
  for (const auto& json : gltf.at("rows")) {
    CAPTURE(json.dump());
    const NamedRow row(gltf, json);
    const ThinFilm film{1, row["iridescenceIor"], row["thickness_nm"]};
    CHECK(LargestDifference(GltfIridescence(film, row.Colour("F0"), row["cos"]), row.Colour("F")) <=
          1e-12);
  }
}

// adobe/openpbr-bsdf's specular lobe without compensation, divided by all but Fresnel's term.
Rgb FresnelOfLobe(const NamedRow& row, double* v_dot_h) {
  const Vec3d to_light = row.Direction("wi");
  const Angles<double> angles = ComputeAngles(Vec3d(0, 0, 1), to_light, row.Direction("wo"));
  const double alpha = AlphaFromRoughness(row["specular_roughness"]);
  *v_dot_h = VDotH(angles);
  return row.Colour("base_specular") /
         (GgxDistribution(angles, alpha) *
          VisibilitySeparable(angles.n_dot_l, angles.n_dot_v, alpha) * angles.n_dot_l);
}

TEST_CASE("films of adobe/openpbr-bsdf are three lines", "[table]") {
  const nlohmann::json tables = LoadTable("thin_film_others");
  // Single precision: stated as 1e-4, relative.
  const auto check = [](const Rgb& got, const Rgb& want) {
    for (int c = 0; c < 3; ++c) CHECK(std::abs(got[c] - want[c]) <= 1e-4 * want[c] + 1e-6);
  };
  constexpr double kFade = 30;
  for (const auto& json : tables.at("dielectric").at("rows")) {
    CAPTURE(json.dump());
    const NamedRow row(tables.at("dielectric"), json);
    const ThinFilm film{1, row["thin_film_ior"], 1000 * row["thin_film_thickness"]};
    const Substrate below{row["specular_ior"], 0};
    double v_dot_h = 0;
    const Rgb want = FresnelOfLobe(row, &v_dot_h);
    const double bare = FresnelDielectric(v_dot_h, 1 - v_dot_h, below.eta);
    const double share = row["thin_film_weight"] * ThinFilmShare(film.thickness_nm, kFade);
    const Rgb covered = Reflected(ThreeLineLoss(film, SameSubstrate(below), v_dot_h));
    check(covered * share + Rgb(bare, bare, bare) * (1 - share), want);
  }
  for (const auto& json : tables.at("metal").at("rows")) {
    CAPTURE(json.dump());
    const NamedRow row(tables.at("metal"), json);
    const ThinFilm film{1, row["thin_film_ior"], 1000 * row["thin_film_thickness"]};
    const Rgb f0 = row.Colour("base_color");
    const Rgb tint = row.Colour("specular_color");
    double v_dot_h = 0;
    const Rgb want = FresnelOfLobe(row, &v_dot_h);
    RgbSubstrate substrate;
    for (int c = 0; c < 3; ++c) {
      substrate[static_cast<size_t>(c)] = GulbrandsenIndex(f0[c], tint[c], 0.99);
    }
    const Rgb covered = Reflected(ThreeLineLoss(film, substrate, v_dot_h));
    const double share = row["thin_film_weight"] * ThinFilmShare(film.thickness_nm, kFade);
    check(MakeRgb([&](int c) {
            const double bare =
                FresnelF82(v_dot_h, 1 - v_dot_h, f0[c], F82SlopeFromTint(f0[c], tint[c]));
            return bare + (covered[c] - bare) * share;
          }),
          want);
  }
}

TEST_CASE("choices that implementations differ in have the figures of each") {
  // Printed to three or four digits.
  const auto is = [](const Rgb& reflected, const Rgb& figures, double digit) {
    CHECK(LargestDifference(reflected, figures) <= digit * 0.501);
  };
  const ThinFilm film{1, 1.4, 500};
  const RgbSubstrate glass = SameSubstrate({1.5, 0});
  const std::array<double, 3> raster{700, 546.1, 435.8};
  is(Reflected(ThreeLineLoss(film, glass, 1)), Rgb(0.0284, 0.0196, 0.0374), 1e-4);
  is(Reflected(ThreeLineLoss(film, glass, 1, raster)), Rgb(0.0400, 0.0186, 0.0316), 1e-4);
  // Under a coat of 1.6: seen from the coat, and as MaterialX has it, from vacuum with the
  // substrate's index relative to the coat.
  is(Reflected(ThreeLineLoss({1.6, 1.4, 500}, glass, 1)), Rgb(0.0059, 0.0094, 0.0021), 1e-4);
  is(Reflected(ThreeLineLoss(film, SameSubstrate({1.6 / 1.5, 0}), 1)), Rgb(0.0482, 0.0806, 0.0119),
     1e-4);
  // A film between air and air: a soap bubble's wall has no interface but this one.
  const Rgb bubble = Reflected(ThreeLineLoss(film, SameSubstrate({1, 0}), 1));
  is(bubble, Rgb(0.0582, 0.0974, 0.0136), 1e-4);

  // Gold, F0 = (.929, .788, .374), under a film of 400 nm.
  const ThinFilm on_gold{1, 1.4, 400};
  const std::array<double, 3> f0{0.929, 0.788, 0.374};
  const auto gold = [&](const auto& index) {
    return Reflected(ThreeLineLoss(on_gold, {index(0), index(1), index(2)}, 1));
  };
  is(gold([&](size_t c) { return RealIndex(f0[c]); }), Rgb(0.916, 0.783, 0.129), 1e-3);
  // Its green is not tinted: F82 is Schlick's curve.
  CHECK(FresnelSchlick(f0[1], Power5(0.8)) == Approx(0.857).margin(6e-4));
  const Substrate by_tint = GulbrandsenIndex(f0[1], 1);
  const Substrate by_f82 = GulbrandsenIndex(f0[1], FresnelSchlick(f0[1], Power5(6.0 / 7)));
  CHECK(AiryReflectance(on_gold, by_tint, 1, 540).reflected == Approx(0.758).margin(6e-4));
  CHECK(AiryReflectance(on_gold, by_f82, 1, 540).reflected == Approx(0.773).margin(6e-4));
  // Without film, the three indices are three other metals at grazing incidence.
  const auto bare = [](const Substrate& metal) {
    return FresnelConductor(0.2, 0.8, metal.eta, metal.k);
  };
  CHECK(bare(by_tint) == Approx(0.936).margin(6e-4));
  CHECK(bare(by_f82) == Approx(0.714).margin(6e-4));
  CHECK(bare(RealIndex(f0[1])) == Approx(0.624).margin(5e-4));
}

TEST_CASE("indices from colours reflect these colours") {
  for (const double r : {0.0, 0.04, 0.5, 0.95}) {
    for (const double g : {0.0, 0.3, 0.8, 1.0}) {
      const Substrate metal = GulbrandsenIndex(r, g);
      CHECK(FresnelF0(metal.eta, metal.k) == Approx(r).margin(1e-13));
    }
    CHECK(FresnelF0(RealIndex(r).eta, 0.0) == Approx(r).margin(1e-14));
    // Without an edge tint the metal is a dielectric, and with all of it k is largest.
    CHECK(GulbrandsenIndex(r, 0).k == Approx(0).margin(1e-5));
    CHECK(GulbrandsenIndex(r, 1).eta == Approx((1 - r) / (1 + r)));
  }
  // A mirror has no index: both stop short of it, where implementations do.
  for (const double largest : {0.99, 0.999}) {
    const Substrate metal = GulbrandsenIndex(1, 0.5, largest);
    CHECK(FresnelF0(metal.eta, metal.k) == Approx(largest));
  }
  CHECK(FresnelF0(RealIndex(1).eta, 0.0) == Approx(0.99));
}

TEST_CASE("a film fades in smoothly") {
  CHECK(ThinFilmShare(0, 0) == 1);
  CHECK(ThinFilmShare(0, 30) == 0);
  CHECK(ThinFilmShare(15, 30) == 0.5);
  CHECK(ThinFilmShare(30, 30) == 1);
  CHECK(ThinFilmShare(500, 30) == 1);
}

TEST_CASE("without a film a film's reflectance is Fresnel's") {
  const std::vector<double> cosines{0.0, 1e-9, 0.003, 0.2, 0.6, 0.9, 1.0};
  for (const double outside : {1.0, 1.6}) {
    for (const Substrate& below : {Substrate{1.5, 0}, Substrate{1.2, 0}, Substrate{0.2, 3.4}}) {
      for (const double c : cosines) {
        CAPTURE(outside, below.eta, below.k, c);
        const double bare = below.k > 0
                                ? FresnelConductor(c, 1 - c, below.eta / outside, below.k / outside)
                                : FresnelDielectric(c, 1 - c, below.eta / outside);
        const auto is_bare = [&](const ThinFilm& film) {
          const ThinFilmReflectance got = AiryReflectance(film, below, c, 550);
          CHECK(got.reflected == Approx(bare).epsilon(1e-12).margin(1e-14));
          CHECK(got.loss == Approx(1 - bare).epsilon(1e-12).margin(1e-13));
          // The same of every wavelength, and so of every colour.
          const RgbSubstrate grey = SameSubstrate(below);
          for (const Illuminant illuminant : {Illuminant::kEqualEnergy, Illuminant::kD65}) {
            const Rgb want = Rgb(1, 1, 1) * (1 - bare);
            CHECK(LargestDifference(SpectralLoss(film, grey, c, illuminant), want) <= 2e-7);
            CHECK(LargestDifference(SpectralLossByQuadrature(film, grey, c, illuminant), want) <=
                  1e-12);
          }
        };
        for (const double index : {1.3, 1.6, 2.2}) is_bare({outside, index, 0});
        is_bare({outside, outside, 700});
        if (below.k == 0) is_bare({outside, below.eta, 700});
      }
    }
  }
}

TEST_CASE("quarter and half waves are as in textbooks") {
  constexpr double kWavelength = 560;
  for (const double index : {1.25, 1.38, 2.3}) {
    const double below = 1.55;
    const double quarter = kWavelength / (4 * index);
    const double root = (below - index * index) / (below + index * index);
    const Substrate glass{below, 0};
    CHECK(AiryReflectance({1, index, quarter}, glass, 1, kWavelength).reflected ==
          Approx(root * root).epsilon(1e-12));
    CHECK(AiryReflectance({1, index, 3 * quarter}, glass, 1, kWavelength).reflected ==
          Approx(root * root).epsilon(1e-12));
    CHECK(AiryReflectance({1, index, 2 * quarter}, glass, 1, kWavelength).reflected ==
          Approx(FresnelF0(below, 0.0)).epsilon(1e-12));
  }
  const double matched = std::sqrt(1.55);  // an antireflection coating
  CHECK(AiryReflectance({1, matched, kWavelength / (4 * matched)}, {1.55, 0}, 1, kWavelength)
            .reflected <= 1e-30);
}

TEST_CASE("what a film does not reflect it lets pass, for any numbers") {
  const std::vector<double> cosines{0.0, 1e-300, 1e-12, 1e-4, 0.1, 0.5, 0.9, 1 - 0x1p-53, 1.0};
  const std::vector<double> indices{1e-3, 0.7, 1.0, 1.0 + 0x1p-52, 1.5, 1e3, 1e60};
  for (const double c : cosines) {
    for (const double outside : {1e-3, 1.0, 1.5, 1e3}) {
      for (const double index : indices) {
        for (const double eta : indices) {
          for (const double k : {0.0, 1e-12, 3.0, 1e60}) {
            for (const double thickness : {0.0, 1e-9, 300.0, 1e7, 1e300}) {
              const ThinFilmReflectance got =
                  AiryReflectance({outside, index, thickness}, {eta, k}, c, 500);
              CAPTURE(c, outside, index, eta, k, thickness, got.reflected, got.loss);
              REQUIRE((got.reflected >= 0 && got.reflected <= 1 + 1e-14));
              REQUIRE((got.loss >= 0 && got.loss <= 1 + 1e-14));
              REQUIRE(std::abs(got.reflected + got.loss - 1) <= 1e-14);
            }
          }
        }
      }
    }
  }
  for (const double c : cosines) {
    for (const double index : {1.0, 1.3, 1.6, 2.5}) {
      for (const Substrate& below : {Substrate{1, 0}, Substrate{1.5, 0}, Substrate{0.05, 4}}) {
        for (const double thickness : {0.0, 1.0, 300.0, 1e5}) {
          const Rgb loss = SpectralLoss({1.6, index, thickness}, SameSubstrate(below), c);
          const Rgb gaussian = BelcourBarlaLoss({1.6, index, thickness}, SameSubstrate(below), c);
          CAPTURE(c, index, below.eta, thickness, loss, gaussian);
          // Colours leave the gamut, but not by much.
          for (int i = 0; i < 3; ++i) REQUIRE((loss[i] >= -0.2 && loss[i] <= 1.2));
          for (int i = 0; i < 3; ++i) REQUIRE((gaussian[i] >= -0.2 && gaussian[i] <= 1.8));
        }
      }
    }
  }
}

TEST_CASE("near grazing incidence 1 - R falls with the cosine, and is not rounded away") {
  for (const ThinFilm& film :
       {ThinFilm{1, 1.4, 400}, ThinFilm{1, 2.1, 3000}, ThinFilm{1.6, 1.4, 60}}) {
    const Substrate below{film.outside * 1.1, 0};
    const double slope = AiryReflectance(film, below, 1e-6, 500).loss / 1e-6;
    for (const double c : {1e-8, 1e-12, 1e-200}) {
      CHECK(AiryReflectance(film, below, c, 500).loss == Approx(slope * c).epsilon(1e-4));
      const Rgb colour = SpectralLoss(film, SameSubstrate(below), c) / c;
      const Rgb want = SpectralLossByQuadrature(film, SameSubstrate(below), 1e-8) / 1e-8;
      for (int i = 0; i < 3; ++i) CHECK(colour[i] == Approx(want[i]).epsilon(1e-4));
    }
    CHECK(AiryReflectance(film, below, 0, 500).loss == 0);
    CHECK(AiryReflectance(film, below, 0, 500).reflected == 1);
  }
}

TEST_CASE("total reflection happens at either interface") {
  // At the substrate: whatever the film.
  const Substrate below{1.3, 0};
  for (const double index : {1.2, 1.45, 1.9}) {
    const ThinFilm film{1.6, index, 350};
    const double critical = CriticalCosine(film, below);
    CHECK(critical == Approx(std::sqrt(1 - (1.3 / 1.6) * (1.3 / 1.6))));
    CHECK(AiryReflectance(film, below, critical * 0.999, 500).loss == 0);
    CHECK(AiryReflectance(film, below, critical * 1.001, 500).loss > 1e-4);
  }
  CHECK(CriticalCosine({1, 1.5, 100}, below) == 0);
  CHECK(CriticalCosine({1.6, 1.5, 100}, {1.3, 0.1}) == 0);
  // At the film: light tunnels through thin ones, and less the thicker they are.
  const Substrate glass{1.6, 0};
  const double c = 0.3;
  const double decay = std::sqrt(1.6 * 1.6 * (1 - c * c) - 1.1 * 1.1);
  double before = 1;
  for (const double thickness : {100.0, 300.0, 1000.0, 2000.0}) {
    const double loss = AiryReflectance({1.6, 1.1, thickness}, glass, c, 500).loss;
    CHECK(loss < before);
    before = loss;
  }
  const double thicker = AiryReflectance({1.6, 1.1, 2500}, glass, c, 500).loss;
  CHECK(thicker / before == Approx(std::exp(-4 * M_PI * decay * 500 / 500)).epsilon(1e-6));
}

TEST_CASE("white is white, and Belcour and Barla's series sums to Airy's") {
  for (const Illuminant illuminant : {Illuminant::kEqualEnergy, Illuminant::kD65}) {
    Rgb sum(0, 0, 0);
    for (int w = 360; w <= 830; ++w) sum += ChannelSensitivity(illuminant, w);
    CHECK(LargestDifference(sum, Rgb(1, 1, 1)) <= 1e-13);
    const auto at_0 = CoherenceOf(illuminant).Envelope(0);
    for (size_t c = 0; c < 3; ++c) CHECK(std::abs(at_0[c] - 1.0) <= 1e-12);
  }

  // A film of thickness 0 is all terms at their largest: the interface without film.
  const Substrate metal{0.3, 3};
  for (const auto channels :
       {BelcourBarlaOptions::Channels::kCieRgb, BelcourBarlaOptions::Channels::kRec709}) {
    const double c = 0.6;
    const Rgb loss = BelcourBarlaLoss({1, 1.5, 0}, SameSubstrate(metal), c, {400, channels});
    const double bare = FresnelConductor(c, 1 - c, metal.eta, metal.k);
    CHECK(LargestDifference(loss, Rgb(1, 1, 1) * (1 - bare)) <= 1e-10);
    // Their Gaussians are near the CIE's functions.
    const ThinFilm film{1, 1.5, 350};
    const Rgb gaussian = BelcourBarlaLoss(film, SameSubstrate(metal), c, {30, channels});
    const Rgb spectral = SpectralLoss(film, SameSubstrate(metal), c);
    CHECK(LargestDifference(gaussian, spectral) <=
          (channels == BelcourBarlaOptions::Channels::kRec709 ? 0.02 : 0.1));
  }
}

}  // namespace
}  // namespace nacre
