// SPDX-License-Identifier: Apache-2.0
// tests/brdf/brdf_table_test.cc: the hard configurations of tables/brdf_hard.json, in double
// through the scalar twins and in float on every target.
#include <cmath>

#include "brdf/fresnel.h"
#include "brdf/ggx.h"
#include "brdf/phong.h"
#include "brdf/term_kernel.h"
#include "catch.h"
#include "tables.h"
#include "targets.h"

namespace nacre {
namespace {

struct Row {
  std::string id;
  Vec3d n, l, v;
  double shininess, roughness, f0;
  nlohmann::json ref, cond;
};

std::vector<Row> LoadRows() {
  std::vector<Row> rows;
  const nlohmann::json table = LoadTable("brdf_hard");
  for (const auto& json : table.at("rows")) {
    const auto vec = [&](const char* key) {
      return Vec3d(json[key][0].get<double>(), json[key][1].get<double>(),
                   json[key][2].get<double>());
    };
    rows.push_back({json["id"], vec("n"), vec("l"), vec("v"), json["exponent"].get<double>(),
                    json["roughness"].get<double>(), json["f0"].get<double>(), json["ref"],
                    json["cond"]});
  }
  REQUIRE_FALSE(rows.empty());
  return rows;
}

struct Values {
  double n_dot_l;
  double phong_gated, blinn_gated, phong_ungated, blinn_ungated;
  double lesson_spec_exact, hc_spec;
};

// What each value must be: the conditioned rule where the row has a condition number; where it
// has none (a delta lobe, an undefined half vector), finite and not negative.
void CheckRow(const Row& row, const Values& got, double u) {
  CAPTURE(row.id);
  const auto check = [&](const char* name, double value) {
    CAPTURE(name, value, row.ref.value(name, nlohmann::json()).dump(), u);
    const nlohmann::json cond = row.cond.value(name, nlohmann::json());
    const nlohmann::json ref = row.ref.value(name, nlohmann::json());
    if (cond.is_null() || ref.is_null() || ref == "inf") {
      CHECK((std::isfinite(value) && value >= 0));
    } else {
      CHECK(PassesConditionedRule(value, TableNumber(ref), TableNumber(cond), u));
    }
  };
  check("phong_gated", got.phong_gated);
  check("blinn_gated", got.blinn_gated);
  check("lesson_spec_exact", got.lesson_spec_exact);
  check("hc_spec", got.hc_spec);
  CHECK((std::isfinite(got.phong_ungated) && got.phong_ungated >= 0));
  CHECK((std::isfinite(got.blinn_ungated) && got.blinn_ungated >= 0));
}

// The angles and the terms that specular values are products of. The table has no condition numbers
// for these: they follow from what each is computed from. Null where the row has no finite value.
class TermCheck {
 public:
  TermCheck(const Row& row, double u) : row_(row), u_(u) {
    const auto dot_cond = [&](const Vec3d& a, const Vec3d& b, const char* name) {
      double sum = 0;
      for (int c = 0; c < 3; ++c) sum += std::abs(a[c] * b[c]);
      return 4 * sum / std::abs(Reference(name));  // two vectors, each normalised
    };
    const double v_dot_h = Reference("vh"), sine = std::sqrt(Reference("nxh2"));
    n_dot_l_ = dot_cond(row.n, row.l, "nl");
    n_dot_v_ = dot_cond(row.n, row.v, "nv");
    half_ = 4 / v_dot_h;  // l + v is 2 v.h long
    n_dot_h_ = 4 * (1 + half_) / std::abs(Reference("nh"));
    sine2_ = 4 * (1 + half_) / sine;
  }

  void CheckAngles(const Angles<double>& a) const {
    const double u_length = std::sqrt(a.u_squared);
    Column("nl", a.n_dot_l, n_dot_l_);
    Column("nv", a.n_dot_v, n_dot_v_);
    Column("nh", a.n_dot_u / u_length, n_dot_h_);
    Column("vh", VDotH(a), half_);
    const double sine2 = a.nxu_squared / a.u_squared;
    Column("nxh2", sine2, sine2_);
    if (a.n_dot_u > 0) Column("one_minus_nh", sine2 / (1 + a.n_dot_u / u_length), sine2_);
  }

  void CheckTerms(double distribution, double fresnel, double height_correlated) const {
    const double nh = Reference("nh"), sine2 = Reference("nxh2"),
                 alpha2 = std::pow(row_.roughness, 4);
    if (nh > 0) {
      const double flat = nh * nh * alpha2, share = sine2 / (flat + sine2);
      const double of_sine = share > 0 ? 2 * share * sine2_ : 0;
      Column("D", distribution, of_sine + 4 * (1 - share) * n_dot_h_ + 8);
    }
    const double vh = Reference("vh");
    if (std::isnan(vh)) return;
    // (1 - v.h)^5 from |l - v|^2 = 4 (1 - (v.h)^2).
    const double weight = Power5(1 - vh);
    const double rise = (1 - row_.f0) * weight / FresnelSchlick(row_.f0, weight);
    const double apart = 2 * std::sqrt(std::max((1 - vh) * (1 + vh), 0.0));
    Column("F_schlick", fresnel, apart > 0 ? 5 * rise * (half_ + 8 / apart) : 0);
    if (Reference("nl") > 0 && Reference("nv") > 0) {
      Column("V_corr", height_correlated, n_dot_l_ + n_dot_v_);
    }
  }

 private:
  // NaN where there is none.
  double Reference(const char* name) const {
    const nlohmann::json ref = row_.ref.value(name, nlohmann::json());
    const double value = ref.is_null() ? std::nan("") : TableNumber(ref);
    return std::isfinite(value) ? value : std::nan("");
  }

  // The conditioned rule, of values of either sign.
  void Column(const char* name, double got, double cond) const {
    const double reference = Reference(name);
    if (std::isnan(reference)) return;
    CAPTURE(row_.id, name, got, reference, cond, u_);
    const double sign = reference < 0 ? -1 : 1;
    // What is exactly 0 has no relative error: 64 roundings of 1.
    if (reference == 0) {
      CHECK(std::abs(got) <= 64 * u_);
    } else {
      CHECK(PassesConditionedRule(std::max(sign * got, 0.0), sign * reference, cond, u_));
    }
  }

  const Row& row_;
  double u_;
  double n_dot_l_, n_dot_v_, half_, n_dot_h_, sine2_;  // condition numbers
};

Values Evaluate(const Row& row) {
  // The table's vectors are rounded to float, and its references normalise them exactly first.
  const Vec3d n = row.n.normalized();
  const Vec3d l = row.l.normalized();
  const Vec3d v = row.v.normalized();
  const Angles<double> a = ComputeAngles(n, l, v);
  const double alpha = AlphaFromRoughness(row.roughness);
  const double n_dot_v = std::max(a.n_dot_v, 0.0);
  const double fresnel = FresnelSchlick(row.f0, SchlickWeight(a));
  const double distribution = GgxDistribution(a, alpha);
  const bool lit = a.n_dot_l > 0;
  const auto specular = [&](double visibility) {
    return lit ? distribution * fresnel * visibility : 0.0;
  };
  Values values;
  values.n_dot_l = a.n_dot_l;
  values.phong_ungated = PhongLobe(n, l, v, row.shininess);
  values.blinn_ungated = BlinnLobe(a, row.shininess);
  values.phong_gated = lit ? values.phong_ungated : 0.0;
  values.blinn_gated = lit ? values.blinn_ungated : 0.0;
  values.lesson_spec_exact = specular(VisibilitySchlick(
      a.n_dot_l, n_dot_v, SchlickK<double>(Shadowing::kSchlickDirect, row.roughness)));
  const double height_correlated = VisibilityHeightCorrelated(a.n_dot_l, n_dot_v, alpha);
  values.hc_spec = specular(height_correlated);
  const TermCheck check(row, kHalfUlpDouble);
  check.CheckAngles(a);
  check.CheckTerms(distribution, fresnel, height_correlated);
  return values;
}

TEST_CASE("tables may hold denormal numbers, and nothing that is no number") {
  CHECK(TableNumber("4.94065645841246544177e-324") == 0x1p-1074);
  CHECK(TableNumber("-2.5e-310") == -2.5e-310);
  CHECK(TableNumber("1e-400") == 0);
  CHECK(TableNumber(1e-310) == 1e-310);
  CHECK(TableNumber("0.1") == 0.1);
  CHECK_THROWS(TableNumber(""));
  CHECK_THROWS(TableNumber("1.5x"));
}

TEST_CASE("scalar twins pass the hard rows in double", "[table]") {
  for (const Row& row : LoadRows()) CheckRow(row, Evaluate(row), kHalfUlpDouble);
}

TEST_CASE("SIMD terms pass the hard rows in float on every target", "[table]") {
  const std::vector<Row> rows = LoadRows();
  std::vector<TermInput> inputs;
  for (const Row& row : rows) {
    // As the renderer makes them: unit in double, rounded to float.
    inputs.push_back({Vec3f(row.n.normalized()), Vec3f(row.l.normalized()),
                      Vec3f(row.v.normalized()), static_cast<float>(row.shininess),
                      static_cast<float>(row.roughness), static_cast<float>(row.f0)});
  }
  ForEachTarget([&](Target) {
    const std::vector<TermOutput> outputs = EvaluateTerms(inputs);
    for (size_t i = 0; i < rows.size(); ++i) {
      const TermOutput& out = outputs[i];
      const float n_dot_l = inputs[i].n ^ inputs[i].l;
      const bool lit = n_dot_l > 0;
      // A delta lobe is the kernel's business: it shows nothing of a punctual light.
      const bool delta = IsDeltaLobe(AlphaFromRoughness(inputs[i].roughness));
      const float specular = lit && !delta ? out.distribution * out.fresnel : 0.0f;
      Values values;
      values.n_dot_l = n_dot_l;
      values.phong_ungated = out.phong;
      values.blinn_ungated = out.blinn;
      values.phong_gated = lit ? out.phong : 0.0;
      values.blinn_gated = lit ? out.blinn : 0.0;
      values.lesson_spec_exact = specular == 0 ? 0.0f : specular * out.schlick_direct;
      values.hc_spec = specular == 0 ? 0.0f : specular * out.height_correlated;
      CheckRow(rows[i], values, kHalfUlpFloat);
      TermCheck(rows[i], kHalfUlpFloat)
          .CheckTerms(out.distribution, out.fresnel, out.height_correlated);
    }
  });
}

}  // namespace
}  // namespace nacre
