// SPDX-License-Identifier: Apache-2.0
// tests/color/tone_kernel_test.cc: the SIMD tone operators, on every target, against the tables
// and their twins in double.
#include "color/tone_kernel.h"

#include <cmath>
#include <limits>
#include <random>

#include "catch.h"
#include "tables.h"
#include "targets.h"

namespace nacre {
namespace {

using Color = Imath::Color3<double>;
constexpr float kInf = std::numeric_limits<float>::infinity();

constexpr ToneOperator kAllTones[] = {
    ToneOperator::kNeutral, ToneOperator::kReinhard, ToneOperator::kReinhardExtended,
    ToneOperator::kAces,    ToneOperator::kAgx,      ToneOperator::kNone};

// The largest error allowed at a value, by the rule of the tables: 4 half-ulps for Reinhard and its
// extended form, and otherwise 16 half-ulps or 1e-7 absolute. ACES rounds up to nine times without
// fused products, so that 4 half-ulps, which hold for the rows of the table, are now and then
// exceeded: 6. AgX, which is in no table and goes through five exponentials and logarithms of 3 to
// 4 ulps each and a matrix that subtracts: 64 half-ulps or 1e-6 absolute, as display.h says.
double Tolerance(ToneOperator tone, double value) {
  switch (tone) {
    case ToneOperator::kReinhard:
    case ToneOperator::kReinhardExtended:
      return 4 * kHalfUlpFloat * value;
    case ToneOperator::kAces:
      return 6 * kHalfUlpFloat * value;
    case ToneOperator::kAgx:
      return std::max(64 * kHalfUlpFloat * value, 1e-6);
    case ToneOperator::kNeutral:
      return std::max(16 * kHalfUlpFloat * value, 1e-7);
    case ToneOperator::kNone:
      return 0;
  }
  return 0;
}

struct Planes {
  std::vector<float> r, g, b;
  void Add(float red, float green, float blue) {
    r.push_back(red);
    g.push_back(green);
    b.push_back(blue);
  }
};

Planes RandomPlanes(size_t count) {
  std::mt19937 engine(7);
  std::uniform_real_distribution<float> log2_value(-20, 12);
  Planes planes;
  for (size_t i = 0; i < count; ++i) {
    const float grey = std::exp2(log2_value(engine));
    if (i % 4 == 0) {
      planes.Add(grey, grey, grey);
    } else {
      planes.Add(grey, std::exp2(log2_value(engine)),
                 i % 3 == 0 ? 0 : std::exp2(log2_value(engine)));
    }
  }
  return planes;
}

TEST_CASE("SIMD tone operators agree with their twins in double", "[color]") {
  const Planes in = RandomPlanes(200'000);
  ForEachTarget([&](Target) {
    for (const ToneOperator tone : kAllTones) {
      CAPTURE(ToneOperatorName(tone));
      DisplaySettings settings{.tone = tone};
      Planes out = in;
      ToneLight(settings, &out.r, &out.g, &out.b);
      double worst = 0;  // error over tolerance, or over 1 ulp of 1 where that is 0
      for (size_t i = 0; i < in.r.size(); ++i) {
        const Color expected = DisplayLight(settings, Color(in.r[i], in.g[i], in.b[i]));
        const Color got(out.r[i], out.g[i], out.b[i]);
        for (int c = 0; c < 3; ++c) {
          const double error = std::abs(got[c] - expected[c]);
          const double tolerance = Tolerance(tone, expected[c]);
          if (error > 0) worst = std::max(worst, tolerance > 0 ? error / tolerance : kInf);
        }
      }
      CHECK(worst <= 1);
    }
  });
}

TEST_CASE("SIMD Reinhard and ACES agree with the table", "[color][table]") {
  const auto rows = LoadTable("tonemap").at("scalar");
  Planes in;
  for (const auto& row : rows) {
    const auto x = static_cast<float>(TableNumber(row.at("x")));
    in.Add(x, x, x);
  }
  const std::pair<ToneOperator, const char*> columns[] = {
      {ToneOperator::kReinhard, "reinhard"},
      {ToneOperator::kReinhardExtended, "reinhard_ext_white4"},
      {ToneOperator::kAces, "aces_narkowicz_clamped"}};
  ForEachTarget([&](Target) {
    for (const auto& [tone, column] : columns) {
      DisplaySettings settings{.tone = tone};
      Planes out = in;
      ToneLight(settings, &out.r, &out.g, &out.b);
      for (size_t i = 0; i < rows.size(); ++i) {
        const double expected = std::min(TableNumber(rows[i].at(column)), 1.0);
        CAPTURE(column, in.r[i]);
        // The table's x are doubles: rounding them moves these curves, whose logarithmic slopes
        // are at most 1.3, by 1.3 half-ulps more.
        CHECK(std::abs(out.r[i] - expected) <= (4 + 1.3) * kHalfUlpFloat * expected);
      }
    }
  });
}

TEST_CASE("SIMD Neutral agrees with the table", "[color][table]") {
  const auto rows = LoadTable("tonemap").at("rgb");
  Planes in;
  for (const auto& row : rows) {
    const auto& rgb = row.at("rgb");
    in.Add(static_cast<float>(TableNumber(rgb[0])), static_cast<float>(TableNumber(rgb[1])),
           static_cast<float>(TableNumber(rgb[2])));
  }
  ForEachTarget([&](Target) {
    Planes out = in;
    ToneLight(DisplaySettings{}, &out.r, &out.g, &out.b);
    for (size_t i = 0; i < rows.size(); ++i) {
      const float got[] = {out.r[i], out.g[i], out.b[i]};
      for (size_t c = 0; c < 3; ++c) {
        const double expected = TableNumber(rows[i].at("khronos_pbr_neutral")[c]);
        CAPTURE(rows[i].at("rgb").dump(), c);
        CHECK(std::abs(got[c] - expected) <= Tolerance(ToneOperator::kNeutral, expected));
      }
    }
  });
}

TEST_CASE("SIMD operators are monotone on greys and stay in [0, 1]", "[color]") {
  Planes in;
  in.Add(0, 0, 0);
  for (int i = 0; i < 1'000'000; ++i) {
    const auto x = static_cast<float>(std::exp2(-149 + i * (276.999 / 999'999)));
    in.Add(x, x, x);
  }
  for (const float x : {std::numeric_limits<float>::max(), kInf}) in.Add(x, x, x);
  ForEachTarget([&](Target) {
    for (const ToneOperator tone : kAllTones) {
      CAPTURE(ToneOperatorName(tone));
      DisplaySettings settings{.tone = tone};
      Planes out = in;
      ToneLight(settings, &out.r, &out.g, &out.b);
      size_t outside = 0;
      float largest_drop = 0;
      for (size_t i = 0; i < in.r.size(); ++i) {
        for (const float value : {out.r[i], out.g[i], out.b[i]}) {
          outside += !(value >= 0 && value <= 1);
        }
        if (i > 0) largest_drop = std::max(largest_drop, out.g[i - 1] - out.g[i]);
      }
      CHECK(outside == 0);
      // Just below white the differences of the outputs are smaller than their errors.
      const bool rational = tone != ToneOperator::kNeutral && tone != ToneOperator::kAgx;
      CHECK(largest_drop <= (rational ? 0 : 2 * Tolerance(tone, 1)));
      CHECK(out.g.back() >= 1 - Tolerance(tone, 1));
    }
  });
}

TEST_CASE("SIMD operators take infinity in any channel", "[color]") {
  Planes in;
  for (const float x : {kInf, 3e38f, 1e19f, 0.0f, 1e-45f, 0.5f}) {
    in.Add(x, kInf, 0);
    in.Add(0, x, kInf);
    in.Add(kInf, kInf, x);
  }
  ForEachTarget([&](Target) {
    for (const ToneOperator tone : kAllTones) {
      DisplaySettings settings{.tone = tone};
      Planes out = in;
      ToneLight(settings, &out.r, &out.g, &out.b);
      for (size_t i = 0; i < in.r.size(); ++i) {
        CAPTURE(ToneOperatorName(tone), in.r[i], in.g[i], in.b[i]);
        for (const float value : {out.r[i], out.g[i], out.b[i]}) CHECK((value >= 0 && value <= 1));
      }
    }
  });
}

}  // namespace
}  // namespace nacre
