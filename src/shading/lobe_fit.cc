// SPDX-License-Identifier: Apache-2.0
#include "shading/lobe_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <vector>

#include "brdf/albedo.h"
#include "brdf/phong.h"
#include "scene/limits.h"
#include "shading/golden.h"
#include "shading/lobe_residual.h"

namespace nacre {
namespace {

// The original's lobe at the samples of all views. With their weights, the squared differences add
// up to the square of MaterialResidual::rms, except for its denominator.
struct LobeTable {
  struct Entry {
    Vec3d to_view;
    LobeSample sample;
    Rgb lobe;  // BRDF n.l
  };
  std::vector<Entry> entries;
  double alpha = 1;
};

LobeTable Tabulate(const Material& original) {
  const ShadingMaterial prepared = PrepareMaterial(original);
  LobeTable table;
  table.alpha = LobeAlpha(original);
  for (const auto& [view_deg, weight] : HighlightViews()) {
    const Vec3d to_view = ViewDirection(view_deg);
    for (LobeSample sample : MakeLobeSamples(1.5 * table.alpha, view_deg)) {
      const Rgb lobe = Reflect(prepared, Vec3d(0, 0, 1), sample.to_light, to_view).specular;
      sample.weight *= weight;
      table.entries.push_back({to_view, sample, lobe});
    }
  }
  return table;
}

// Finds the strength of each channel in [0, 1] that minimises the error, a quadratic function.
FittedLobe SolvePhong(const LobeTable& table, PhongModel model, double shininess) {
  Material unit;
  unit.model = PhongMaterial{.model = model, .kd = Rgb(0), .ks = Rgb(1), .shininess = shininess};
  const ShadingMaterial prepared = PrepareMaterial(unit);
  Rgb cross(0);
  Rgb squares(0);
  double own = 0;
  for (const LobeTable::Entry& entry : table.entries) {
    const double g =
        Reflect(prepared, Vec3d(0, 0, 1), entry.sample.to_light, entry.to_view).specular.x;
    cross += entry.lobe * (g * entry.sample.weight);
    squares += entry.lobe * entry.lobe * entry.sample.weight;
    own += g * g * entry.sample.weight;
  }
  FittedLobe fit;
  fit.width = shininess;
  for (int c = 0; c < 3; ++c) {
    fit.strength[c] = own > 0 ? std::clamp(cross[c] / own, 0.0, 1.0) : 0;
    const double s = fit.strength[c];
    fit.error += squares[c] - 2 * s * cross[c] + s * s * own;
  }
  return fit;
}

// The GGX lobe is a polynomial of F0: terms[0] + F0 terms[1] + F0^2 terms[2]. These are the
// products of the terms with one another and with the original.
struct GgxMoments {
  std::array<std::array<double, 3>, 3> own{};
  std::array<Rgb, 3> cross{Rgb(0), Rgb(0), Rgb(0)};
  Rgb squares{0, 0, 0};

  double Error(int channel, double f0) const {
    const std::array<double, 3> powers = {1, f0, f0 * f0};
    double error = squares[channel];
    for (size_t i = 0; i < 3; ++i) {
      error -= 2 * powers[i] * cross[i][channel];
      for (size_t j = 0; j < 3; ++j) error += powers[i] * powers[j] * own[i][j];
    }
    return error;
  }
};

GgxMoments MakeMoments(const LobeTable& table, double alpha) {
  const AlbedoFit albedo = MakeAlbedoFit(Shadowing::kHeightCorrelated, std::sqrt(alpha));
  const Vec3d normal(0, 0, 1);
  GgxMoments moments;
  for (const LobeTable::Entry& entry : table.entries) {
    const Vec3d& to_view = entry.to_view;
    const Vec3d& to_light = entry.sample.to_light;
    const Angles<double> a = ComputeAngles(normal, to_light, to_view);
    const double lobe = GgxDistribution(a, alpha) *
                        VisibilityHeightCorrelated(a.n_dot_l, a.n_dot_v, alpha) * to_light.z;
    const double one = AlbedoOne(albedo, to_view.z);
    const double more = AlbedoLoss(albedo, to_view.z) / one;  // Turquin's factor: 1 + F0 more
    const double grazing = lobe * SchlickWeight(a);
    const double head_on = lobe - grazing;
    const std::array<double, 3> terms = {grazing, head_on + more * grazing, more * head_on};
    const double weight = entry.sample.weight;
    for (size_t i = 0; i < 3; ++i) {
      moments.cross[i] += entry.lobe * (terms[i] * weight);
      for (size_t j = 0; j < 3; ++j) moments.own[i][j] += terms[i] * terms[j] * weight;
    }
    moments.squares += entry.lobe * entry.lobe * weight;
  }
  return moments;
}

FittedLobe SolveGgx(const LobeTable& table, double alpha) {
  const GgxMoments moments = MakeMoments(table, alpha);
  FittedLobe fit;
  fit.width = alpha;
  for (int c = 0; c < 3; ++c) {
    fit.strength[c] = GoldenMinimum([&](double f0) { return moments.Error(c, f0); }, 0, 1);
    fit.error += moments.Error(c, fit.strength[c]);
  }
  return fit;
}

// The best of solve(width) for widths within a factor of `reach` around `start`, in [least, most].
FittedLobe SearchWidth(double start, double reach, double least, double most,
                       const std::function<FittedLobe(double)>& solve) {
  const double low = std::log(std::clamp(start / reach, least, most));
  const double high = std::log(std::clamp(start * reach, least, most));
  const auto error = [&](double log_width) { return solve(std::exp(log_width)).error; };
  return solve(std::exp(ScannedMinimum(error, low, high, 24)));
}

}  // namespace

FittedLobe FitPhongLobe(const Material& original, PhongModel model) {
  const LobeTable table = Tabulate(original);
  const double start = std::max(ExponentFromAlpha(model, table.alpha), 0.05);
  return SearchWidth(start, 16, 0.01, limits::kExponent.max,
                     [&](double shininess) { return SolvePhong(table, model, shininess); });
}

FittedLobe FitGgxLobe(const Material& original) {
  const LobeTable table = Tabulate(original);
  constexpr double kLeast = 1e-5;  // Phong's exponents end at 1e9
  return SearchWidth(table.alpha, 4, kLeast, 1,
                     [&](double alpha) { return SolveGgx(table, alpha); });
}

}  // namespace nacre
