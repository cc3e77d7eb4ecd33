// SPDX-License-Identifier: Apache-2.0
// brdf/table/make_anisotropic_albedo_table.cc: the program that writes the table of
// brdf/anisotropic_albedo_table.h as C++, at build time, from the quadrature of
// brdf/anisotropic_albedo_integral.h.
//
// make_anisotropic_albedo_table FILE
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <vector>

#include "brdf/anisotropic_albedo.h"
#include "brdf/anisotropic_albedo_fit.h"
#include "brdf/anisotropic_albedo_integral.h"
#include "brdf/anisotropic_albedo_table.h"
#include "brdf/chebyshev.h"
#include "brdf/quadrature.h"

namespace nacre {
namespace {

GgxAlphas<double> AlphasAt(int i, int j) {
  // The entries of alpha 0 hold the limit, which is reached halfway to the next ones.
  const double root = std::max(i, 1) / (i == 0 ? 2.0 : 1.0) / kAlphaIntervals;
  const double x = kLargestAlbedoAlpha * root * root * root * root;
  const double ratio = static_cast<double>(j) / kRatioIntervals;
  return {x, x * std::max(ratio * ratio * ratio, kLeastFittedRatio)};
}

// Powers of the width, from 1 on, of sum_k binomial(5, k) (1 - w)^(5 - k) w^k values[k - 1].
std::array<double, kWidthTerms> FromBernstein(const std::array<double, kWidthTerms>& values) {
  constexpr double kBinomials[6][6] = {{1},          {1, 1},          {1, 2, 1},
                                       {1, 3, 3, 1}, {1, 4, 6, 4, 1}, {1, 5, 10, 10, 5, 1}};
  std::array<double, kWidthTerms> powers{};
  for (size_t k = 1; k <= 5; ++k) {
    for (size_t i = 0; i <= 5 - k; ++i) {
      const double sign = i % 2 == 0 ? 1 : -1;
      powers[k + i - 1] += kBinomials[5][k] * values[k - 1] * sign * kBinomials[5 - k][i];
    }
  }
  return powers;
}

// (1 - v.h)^5 is ((1 - w) + w (1 - c))^5, where c = v.h / w is the cosine of the angle between h
// and the view's part in the plane of n and t. The parts that a mirror has, with c = n.v / w, are
// those of (1 - n.v)^5 E.
std::array<WidthPolynomial, kSmithForms> StreakAt(int i) {
  const GgxAlphas<double> alpha = AlphasAt(i, 0);
  const AnisotropicAlbedoShape shape = MakeAnisotropicAlbedoShape(alpha);
  std::array<std::array<KappaValues, kWidthTerms>, kSmithForms> values;
  for (size_t k = 0; k < kKappaTerms; ++k) {
    const Vec3d v = DirectionAt(shape, ChebyshevNode(k, kKappaTerms), -1);
    const auto albedos = IntegrateAlbedos(alpha, v, kFineAnisotropicQuadrature);
    for (size_t form = 0; form < kSmithForms; ++form) {
      std::array<double, kWidthTerms> wider;
      double mirror = 1 - albedos[form].loss;
      for (size_t power = 0; power < kWidthTerms; ++power) {
        mirror *= 1 - v.z;
        wider[power] = albedos[form].powers[power] - mirror;
      }
      wider = FromBernstein(wider);
      for (size_t power = 0; power < kWidthTerms; ++power) values[form][power][k] = wider[power];
    }
  }
  std::array<WidthPolynomial, kSmithForms> streaks;
  for (size_t form = 0; form < kSmithForms; ++form) {
    for (size_t power = 0; power < kWidthTerms; ++power) {
      streaks[form][power] = InterpolateKappa(values[form][power]);
    }
  }
  return streaks;
}

// The means of the fitted curves over the hemisphere, so that the light lost along one direction
// agrees with the light returned along all others. Panels halve towards the horizon and towards the
// bitangent, where streaks bend.
void Average(const GgxAlphas<double>& alpha, const AnisotropicAlbedoFit& fit,
             AnisotropicAlbedoEntry* entry) {
  const auto panels = [](double finest) {
    return std::min(4 + static_cast<int>(std::log2(1 / finest)), 40);
  };
  const auto nodes = [](int count, int points) {
    const QuadratureRule& rule = GaussLegendre(points);
    QuadratureRule all;
    double end = 1;
    for (int panel = 0; panel < count; ++panel) {
      const double begin = panel == count - 1 ? 0 : end / 2;
      for (size_t i = 0; i < rule.x.size(); ++i) {
        all.x.push_back(begin + (end - begin) * rule.x[i]);
        all.w.push_back((end - begin) * rule.w[i]);
      }
      end = begin;
    }
    return all;
  };
  const QuadratureRule cosines = nodes(panels(std::min(alpha.x, 0.25)), 6);
  const QuadratureRule azimuths = nodes(std::min(panels(alpha.y / alpha.x) - 2, 8), 5);
  double loss = 0, schlick = 0;
  for (size_t i = 0; i < cosines.x.size(); ++i) {
    const double n = cosines.x[i], sin = std::sqrt(1 - n * n);
    for (size_t j = 0; j < azimuths.x.size(); ++j) {
      const double angle = M_PI_2 * azimuths.x[j];  // from the bitangent
      const auto x =
          ComputeAlbedoVariables(fit.shape, n, sin * std::sin(angle), sin * std::cos(angle));
      const double weight = 2 * n * cosines.w[i] * azimuths.w[j];
      loss += weight * AlbedoLoss(fit, x);
      schlick += weight * AlbedoSchlick(fit, AlbedoOne(fit, x), x);
    }
  }
  entry->loss_average = static_cast<float>(loss / AnisotropicLossScale(alpha));
  entry->schlick_average = static_cast<float>(schlick);
}

std::array<AnisotropicAlbedoEntry, kSmithForms> EntryAt(
    int i, int j, const std::array<WidthPolynomial, kSmithForms>& streaks) {
  const GgxAlphas<double> alpha = AlphasAt(i, j);
  const AnisotropicAlbedoShape shape = MakeAnisotropicAlbedoShape(alpha);
  std::array<std::array<KappaValues, kShareTerms>, kSmithForms> loss, schlick;
  for (size_t s = 0; s < kShareTerms; ++s) {
    for (size_t k = 0; k < kKappaTerms; ++k) {
      const Vec3d v =
          DirectionAt(shape, ChebyshevNode(k, kKappaTerms), ChebyshevNode(s, kShareTerms));
      const auto x = ComputeAlbedoVariables(shape, v.z, v.x, v.y);
      const auto albedos = IntegrateAlbedos(alpha, v);
      for (size_t form = 0; form < kSmithForms; ++form) {
        const double lost = albedos[form].loss;
        loss[form][s][k] = lost / x.factor;
        schlick[form][s][k] = (albedos[form].powers[4] - Power5(1 - v.z) * (1 - lost) -
                               x.width * EvaluatePolynomial(streaks[form], x.z, x.width)) /
                              x.rest;
      }
    }
  }
  std::array<AnisotropicAlbedoEntry, kSmithForms> entries;
  for (size_t form = 0; form < kSmithForms; ++form) {
    entries[form].loss = InterpolateKappa(loss[form]);
    entries[form].schlick = InterpolateKappa(schlick[form]);
    AnisotropicAlbedoFit fit;
    fit.shape = shape;
    fit.loss = entries[form].loss;
    fit.schlick = entries[form].schlick;
    fit.streak = streaks[form];
    Average(alpha, fit, &entries[form]);
  }
  return entries;
}

template <size_t kTerms>
void Print(std::FILE* file, const std::array<KappaPolynomial, kTerms>& polynomial) {
  std::fprintf(file, "{{");
  for (const KappaPolynomial& row : polynomial) {
    std::fprintf(file, "{");
    for (const float c : row) std::fprintf(file, "%.8eF,", double{c});
    std::fprintf(file, "},\n");
  }
  std::fprintf(file, "}},\n");
}

int WriteTable(const char* name) {
  std::FILE* file = std::fopen(name, "w");
  if (file == nullptr) return 1;
  std::vector<std::array<WidthPolynomial, kSmithForms>> streaks;
  std::vector<std::array<AnisotropicAlbedoEntry, kSmithForms>> entries;
  for (int i = 0; i <= kAlphaIntervals; ++i) {
    streaks.push_back(StreakAt(i));
    for (int j = 0; j <= kRatioIntervals; ++j) entries.push_back(EntryAt(i, j, streaks.back()));
  }
  std::fprintf(file,
               "// Generated by brdf/table/make_anisotropic_albedo_table.cc.\n"
               "#include \"brdf/anisotropic_albedo_table.h\"\n\nnamespace nacre {\n\n"
               "const AnisotropicAlbedoEntry kAnisotropicAlbedoTable[kSmithForms]"
               "[kAlphaIntervals + 1][kRatioIntervals + 1] = {\n");
  for (size_t form = 0; form < kSmithForms; ++form) {
    std::fprintf(file, "{");
    for (size_t i = 0; i < entries.size(); ++i) {
      if (i % (kRatioIntervals + 1) == 0) std::fprintf(file, i == 0 ? "{" : "},\n{");
      const AnisotropicAlbedoEntry& entry = entries[i][form];
      std::fprintf(file, "{");
      Print(file, entry.loss);
      Print(file, entry.schlick);
      std::fprintf(file, "%.8eF, %.8eF},\n", double{entry.loss_average},
                   double{entry.schlick_average});
    }
    std::fprintf(file, "}},\n");
  }
  std::fprintf(file,
               "};\n\nconst WidthPolynomial kStreakAlbedoTable[kSmithForms]"
               "[kAlphaIntervals + 1] = {\n");
  for (size_t form = 0; form < kSmithForms; ++form) {
    std::fprintf(file, "{");
    for (const auto& streak : streaks) Print(file, streak[form]);
    std::fprintf(file, "},\n");
  }
  std::fprintf(file, "};\n\n}  // namespace nacre\n");
  return std::fclose(file) == 0 ? 0 : 1;
}

}  // namespace
}  // namespace nacre

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: make_anisotropic_albedo_table FILE\n");
    return 2;
  }
  return nacre::WriteTable(argv[1]);
}
