// SPDX-License-Identifier: Apache-2.0
#include "shading/log_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "scene/material_parameters.h"
#include "shading/lobe_residual.h"
#include "shading/scalar_bsdf.h"
#include "shading/share.h"

namespace nacre {
namespace {

// Names of scene/material_parameters.cc.
constexpr std::array<std::string_view, 3> kPhongNames = {"kd", "ks", "shininess"};
constexpr std::array<std::string_view, 4> kMetallicNames = {"base_color", "metallic", "roughness",
                                                            "specular"};
constexpr std::array<std::string_view, 3> kDielectricNames = {"base_color", "ior", "roughness"};
constexpr std::array<std::string_view, 5> kOpenPbrNames = {
    "base_color", "base_metalness", "specular_roughness", "specular_color", "specular_ior"};

// One number that is fitted: a channel of a parameter. Steps are even in its logarithm where its
// range spans decades.
struct FreeNumber {
  const MaterialParameter* parameter;
  int channel;  // -1: the parameter is a number
  double least, most;
  bool is_log;

  double Get(const Material& material) const {
    const double value = parameter->get(material)[std::max(channel, 0)];
    return is_log ? std::log(value) : value;
  }
  void Set(double value, Material* material) const {
    const double number = is_log ? std::exp(value) : value;
    Rgb rgb = channel < 0 ? Rgb(number) : parameter->get(*material);
    if (channel >= 0) rgb[channel] = number;
    parameter->set(*material, rgb);
  }
};

std::vector<FreeNumber> FreeNumbersOf(const MaterialModel& model) {
  std::vector<FreeNumber> numbers;
  for (const std::string_view name : LogFitParameters(model.name)) {
    const MaterialParameter* const parameter = FindParameter(model, name);
    double least = parameter->range.min, most = parameter->range.max;
    const bool is_log = name == "shininess" || name.ends_with("ior");
    if (name == "shininess") {
      least = 1;
      most = 1e4;
    } else if (name.ends_with("ior")) {
      least = 1.05;
      most = 3;
    } else if (name.ends_with("roughness")) {
      least = 0.02;  // a mirror's lobe has no values
    }
    if (is_log) {
      least = std::log(least);
      most = std::log(most);
    }
    for (int c = 0; c < (parameter->is_color ? 3 : 1); ++c) {
      numbers.push_back({parameter, parameter->is_color ? c : -1, least, most, is_log});
    }
  }
  return numbers;
}

struct LogPair {
  Vec3d to_light, to_view;
  Rgb log;  // of the original
};

Rgb LogOf(const ShadingMaterial& material, const Vec3d& l, const Vec3d& v) {
  const Rgb f = Reflect(material, Vec3d(0, 0, 1), l, v).Sum();
  return MakeRgb([&](int c) { return std::log1p(std::max(f[c], 0.0)); });
}

std::vector<LogPair> MakeLogPairs(const ShadingMaterial& original) {
  constexpr int kColumns = 24, kRows = 8;
  const double lowest = std::cos(80 * M_PI / 180);
  std::vector<LogPair> pairs;
  for (const double view_deg : {5, 20, 35, 50, 65, 75}) {
    const Vec3d v = ViewDirection(view_deg);
    for (int i = 0; i < kColumns; ++i) {
      const double x = (i + 0.5) / kColumns, theta = x * x * M_PI_2;
      for (int j = 0; j < kRows; ++j) {
        const double phi = M_PI * (j + 0.5) / kRows;
        const Vec3d h(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi),
                      std::cos(theta));
        const Vec3d l = Mirrored(v, h);
        if (!((v ^ h) > 0) || !(l.z > lowest)) continue;
        const Rgb log = LogOf(original, l, v);
        if (!IsBlack(log)) pairs.push_back({l, v, log});
      }
    }
  }
  return pairs;
}

std::vector<double> Residuals(const std::vector<LogPair>& pairs, const Material& material) {
  const ShadingMaterial prepared = PrepareMaterial(material);
  std::vector<double> residuals;
  residuals.reserve(3 * pairs.size());
  for (const LogPair& pair : pairs) {
    const Rgb difference = LogOf(prepared, pair.to_light, pair.to_view) - pair.log;
    for (int c = 0; c < 3; ++c) residuals.push_back(difference[c]);
  }
  return residuals;
}

double SumOfSquares(const std::vector<double>& residuals) {
  double sum = 0;
  for (const double r : residuals) sum += r * r;
  return sum;
}

// Solves the symmetric system by Gaussian elimination with pivots from the diagonal, which damping
// has made large.
std::vector<double> Solve(std::vector<std::vector<double>> a, std::vector<double> b) {
  const size_t n = b.size();
  for (size_t k = 0; k < n; ++k) {
    for (size_t i = k + 1; i < n; ++i) {
      const double factor = a[i][k] / a[k][k];
      for (size_t j = k; j < n; ++j) a[i][j] -= factor * a[k][j];
      b[i] -= factor * b[k];
    }
  }
  for (size_t k = n; k-- > 0;) {
    for (size_t j = k + 1; j < n; ++j) b[k] -= a[k][j] * b[j];
    b[k] /= a[k][k];
  }
  return b;
}

// Levenberg 1944 and Marquardt 1963, within the numbers' bounds; returns the sum of squares.
double Descend(const std::vector<LogPair>& pairs, const std::vector<FreeNumber>& numbers,
               int iterations, Material* material) {
  constexpr double kStep = 1e-4;
  const size_t n = numbers.size();
  std::vector<double> residuals = Residuals(pairs, *material);
  double error = SumOfSquares(residuals), damping = 1e-2;
  for (int iteration = 0; iteration < iterations && damping < 1e6; ++iteration) {
    std::vector<std::vector<double>> slopes;
    for (const FreeNumber& number : numbers) {
      Material moved = *material;
      const double at = number.Get(*material), range = number.most - number.least;
      const double step = at + kStep * range > number.most ? -kStep : kStep;
      number.Set(at + step * range, &moved);
      std::vector<double> slope = Residuals(pairs, moved);
      for (size_t i = 0; i < slope.size(); ++i) slope[i] = (slope[i] - residuals[i]) / step;
      slopes.push_back(std::move(slope));
    }
    std::vector<std::vector<double>> normal(n, std::vector<double>(n));
    std::vector<double> gradient(n);
    for (size_t a = 0; a < n; ++a) {
      for (size_t b = 0; b <= a; ++b) {
        double sum = 0;
        for (size_t i = 0; i < residuals.size(); ++i) sum += slopes[a][i] * slopes[b][i];
        normal[a][b] = normal[b][a] = sum;
      }
      for (size_t i = 0; i < residuals.size(); ++i) gradient[a] -= slopes[a][i] * residuals[i];
    }
    bool better = false;
    while (!better && damping < 1e6) {
      auto damped = normal;
      for (size_t a = 0; a < n; ++a) damped[a][a] += damping * (normal[a][a] + 1e-9 * (1 + error));
      const std::vector<double> step = Solve(damped, gradient);
      Material moved = *material;
      for (size_t a = 0; a < n; ++a) {
        const FreeNumber& number = numbers[a];
        const double range = number.most - number.least;
        number.Set(std::clamp(number.Get(*material) + step[a] * range, number.least, number.most),
                   &moved);
      }
      std::vector<double> next = Residuals(pairs, moved);
      const double next_error = SumOfSquares(next);
      better = next_error < error;
      if (!better) {
        damping *= 4;
        continue;
      }
      const bool settled = error - next_error < 1e-9 * error;
      *material = moved;
      residuals = std::move(next);
      error = next_error;
      damping = std::max(damping / 4, 1e-9);
      if (settled) return error;
    }
  }
  return error;
}

// Sets a parameter if the model has it.
void SetIfAny(const MaterialModel& model, std::string_view name, const Rgb& value,
              Material* material) {
  if (const MaterialParameter* const parameter = FindParameter(model, name)) {
    parameter->set(*material, value);
  }
}

// A material of the model with a lobe of this alpha and an albedo: of metal, or of plastic.
Material MakeStart(const MaterialModel& model, const Material& into, double alpha,
                   const Rgb& albedo, bool metal) {
  Material start = into;
  start.model = model.make().model;
  const auto set = [&](std::string_view name, const Rgb& value) {
    SetIfAny(model, name, value, &start);
  };
  const Rgb color = MakeRgb([&](int c) { return std::clamp(albedo[c], 0.01, 0.99); });
  set("base_color", color);
  set("metallic", Rgb(metal ? 0.95 : 0.05));
  set("base_metalness", Rgb(metal ? 0.95 : 0.05));
  set("roughness", Rgb(std::sqrt(alpha)));
  set("specular_roughness", Rgb(std::sqrt(alpha)));
  set("kd", metal ? Rgb(0.01) : color);
  set("ks", metal ? color : Rgb(0.04));
  set("ka", Rgb(0));
  set("ior", Rgb(metal ? 2.5 : 1.5));
  if (const auto* phong = std::get_if<PhongMaterial>(&start.model)) {
    const double exponent = ExponentFromAlpha(phong->model, alpha);
    set("shininess", Rgb(std::clamp(exponent, 1.0, 1e4)));
  }
  return start;
}

}  // namespace

std::span<const std::string_view> LogFitParameters(std::string_view model) {
  if (model.ends_with("phong")) return kPhongNames;
  if (model == "metallic_roughness") return kMetallicNames;
  if (model == "dielectric") return kDielectricNames;
  if (model == "open_pbr") return kOpenPbrNames;
  return {};
}

double LogResidual(const Material& original, const Material& other) {
  const std::vector<LogPair> pairs = MakeLogPairs(PrepareMaterial(original));
  if (pairs.empty()) return 0;
  return std::sqrt(SumOfSquares(Residuals(pairs, other)) / (3 * static_cast<double>(pairs.size())));
}

LogFit FitLog(const Material& original, std::string_view name, const Material& into) {
  const MaterialModel& model = *FindModel(name);
  const ShadingMaterial prepared = PrepareMaterial(original);
  const std::vector<LogPair> pairs = MakeLogPairs(prepared);
  const std::vector<FreeNumber> numbers = FreeNumbersOf(model);
  const double alpha = std::clamp(LobeAlpha(original), 0.001, 1.0);
  const Rgb albedo = ReflectedShare(prepared, ShareOf::kFurnace, 1);
  LogFit fit;
  double least = -1, least_guess = -1;
  // There are several minima: starts are of metal and plastic, with lobes narrower and wider.
  for (const bool metal : {false, true}) {
    for (const double factor : {1.0, 0.25, 4.0}) {
      const double width = std::clamp(factor * alpha, 0.001, 1.0);
      Material start = MakeStart(model, into, width, albedo, metal);
      if (factor == 1) {
        const double error = SumOfSquares(Residuals(pairs, start));
        if (least_guess < 0 || error < least_guess) {
          least_guess = error;
          fit.guess = start;
        }
      }
      const double error = Descend(pairs, numbers, 15, &start);
      if (least >= 0 && error >= least) continue;
      least = error;
      fit.fitted = start;
    }
  }
  Descend(pairs, numbers, 60, &fit.fitted);
  return fit;
}

}  // namespace nacre
