// SPDX-License-Identifier: Apache-2.0
#include "compare/flip.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/parallel.h"
#include "compare/flip_color.h"

namespace nacre {
namespace {

using flip::Triple;
constexpr double kPi = std::numbers::pi;

// Contrast sensitivity in space, with the constants of table 1: sums of a sqrt(pi / b) exp(-pi^2
// z^2 / b) at z degrees. Those of Y and of red against green have one term, blue against yellow
// two.
struct Sensitivity {
  double a1, b1, a2, b2;
};
constexpr Sensitivity kSensitivity[] = {
    {1, 0.0047, 0, 1}, {1, 0.0053, 0, 1}, {34.1, 0.04, 13.5, 0.025}};
constexpr double kWidestB = 0.04;

// The exponent of colour differences, and the share of the largest one, kShareOfMax,
// that the lower kShareOfRange of the scale is for.
constexpr double kColorExponent = 0.7;
constexpr double kShareOfMax = 0.4;
constexpr double kShareOfRange = 0.95;
// The width of the features that are seen, in degrees, and the exponent.
constexpr double kFeatureWidth = 0.082;
constexpr double kFeatureExponent = 0.5;

// One dimension of exp(-pi^2 z^2 / b): a Gaussian of sigma^2 = b / (2 pi^2).
Kernel SensitivityKernel(double b, double pixels_per_degree, int radius) {
  return GaussianKernel(std::sqrt(b / (2 * kPi * kPi)) * pixels_per_degree, radius);
}

// The filters are scaled to the sum of 1 over the square window, of which each term has a share.
double ShareOfFirst(const Sensitivity& s, double pixels_per_degree, int radius) {
  const auto volume = [&](double a, double b) {
    double sum = 0;
    for (int x = -radius; x <= radius; ++x) {
      const double z = x / pixels_per_degree;
      sum += std::exp(-kPi * kPi * z * z / b);
    }
    return a * std::sqrt(kPi / b) * sum * sum;
  };
  const double first = volume(s.a1, s.b1);
  return first / (first + volume(s.a2, s.b2));
}

// Three sigmas of the widest, for all.
int SensitivityRadius(double pixels_per_degree) {
  return static_cast<int>(std::ceil(3 * std::sqrt(kWidestB / (2 * kPi * kPi)) * pixels_per_degree));
}

Plane FilterSensitivity(const Plane& plane, const Sensitivity& s, double pixels_per_degree) {
  const int radius = SensitivityRadius(pixels_per_degree);
  const Kernel first = SensitivityKernel(s.b1, pixels_per_degree, radius);
  Plane out = Filter(plane, first, first);
  if (s.a2 == 0) return out;
  const double share = ShareOfFirst(s, pixels_per_degree, radius);
  const Kernel second = SensitivityKernel(s.b2, pixels_per_degree, radius);
  const Plane other = Filter(plane, second, second);
  for (size_t i = 0; i < out.size(); ++i)
    out.values[i] = std::lerp(other.values[i], out.values[i], share);
  return out;
}

Planes Map(const Planes& in, Triple (*function)(const Triple&)) {
  Planes out = in;
  ParallelFor(static_cast<size_t>(in[0].height), 0, [&](size_t row) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < in[0].width; ++x) {
      const Triple to = function({in[0].at(x, y), in[1].at(x, y), in[2].at(x, y)});
      for (size_t c = 0; c < 3; ++c) out[c].at(x, y) = to[c];
    }
  });
  return out;
}

// The colours as they are seen: what is too fine is gone, and what no display shows is clipped.
Triple SeenColor(const Triple& ycc) {
  Triple rgb = flip::RgbFromYcc(ycc);
  for (double& value : rgb) value = std::clamp(value, 0.0, 1.0);
  return flip::HuntLabFromRgb(rgb);
}

Planes SeenColors(const Planes& ycc, double pixels_per_degree) {
  Planes filtered;
  for (size_t c = 0; c < 3; ++c) {
    filtered[c] = FilterSensitivity(ycc[c], kSensitivity[c], pixels_per_degree);
  }
  return Map(filtered, SeenColor);
}

// Two pieces of a line over HyAB^0.7, to [0, 1]. The largest distance is that of green and blue.
double ColorError(const Triple& a, const Triple& b) {
  static const double largest =
      std::pow(flip::HyabDistance(flip::HuntLabFromRgb({0, 1, 0}), flip::HuntLabFromRgb({0, 0, 1})),
               kColorExponent);
  const double error = std::pow(flip::HyabDistance(a, b), kColorExponent);
  const double knee = kShareOfMax * largest;
  if (error < knee) return kShareOfRange / knee * error;
  return kShareOfRange + (error - knee) / (largest - knee) * (1 - kShareOfRange);
}

// Scales positive weights to the sum of 1, negative ones to -1.
Kernel Balance(Kernel kernel) {
  double positive = 0, negative = 0;
  for (const double weight : kernel) (weight > 0 ? positive : negative) += std::abs(weight);
  for (double& weight : kernel) weight /= weight > 0 ? positive : negative;
  return kernel;
}

// The size of the gradient (edges) and of the second derivatives (points)
// of a Gaussian, each scaled so that a step or a dot in [0, 1] gives at most 1.
struct Features {
  Plane edges, points;
};

Plane Norm(const Plane& luminance, const Kernel& derivative, const Kernel& smooth) {
  Plane norm = Filter(luminance, derivative, smooth);
  const Plane down = Filter(luminance, smooth, derivative);
  for (size_t i = 0; i < norm.size(); ++i) {
    norm.values[i] = std::hypot(norm.values[i], down.values[i]);
  }
  return norm;
}

double FeatureSigma(double pixels_per_degree) { return 0.5 * kFeatureWidth * pixels_per_degree; }

int FeatureRadius(double pixels_per_degree) {
  return static_cast<int>(std::ceil(3 * FeatureSigma(pixels_per_degree)));
}

Features FindFeatures(const Plane& y, double pixels_per_degree) {
  const double sigma = FeatureSigma(pixels_per_degree);
  const int radius = FeatureRadius(pixels_per_degree);
  const Kernel smooth = GaussianKernel(sigma, radius);
  Kernel edge = smooth, point = smooth;
  for (int x = -radius; x <= radius; ++x) {
    const auto i = static_cast<size_t>(x + radius);
    edge[i] *= -x;
    point[i] *= x * x / (sigma * sigma) - 1;
  }
  Plane luminance = y;
  for (double& value : luminance.values) value = (value + 16) / 116;
  return {Norm(luminance, Balance(edge), smooth), Norm(luminance, Balance(point), smooth)};
}

// (max(|edges|, |points|) / sqrt 2)^0.5, of the differences.
double FeatureError(const Features& a, const Features& b, size_t i) {
  const double edges = std::abs(a.edges.values[i] - b.edges.values[i]);
  const double points = std::abs(a.points.values[i] - b.points.values[i]);
  return std::pow(std::max(edges, points) / std::numbers::sqrt2, kFeatureExponent);
}

Planes RowsOf(const Planes& planes, int first, int end) {
  return {nacre::RowsOf(planes[0], first, end), nacre::RowsOf(planes[1], first, end),
          nacre::RowsOf(planes[2], first, end)};
}

// Of a picture, or of some rows of one.
Plane FlipRows(const Planes& reference, const Planes& test, double pixels_per_degree) {
  const Planes ycc_reference = Map(reference, flip::YccFromRgb);
  const Planes ycc_test = Map(test, flip::YccFromRgb);
  const Features features_reference = FindFeatures(ycc_reference[0], pixels_per_degree);
  const Features features_test = FindFeatures(ycc_test[0], pixels_per_degree);
  const Planes seen_reference = SeenColors(ycc_reference, pixels_per_degree);
  const Planes seen_test = SeenColors(ycc_test, pixels_per_degree);
  Plane map(reference[0].width, reference[0].height);
  for (size_t i = 0; i < map.size(); ++i) {
    const auto at = [i](const Planes& p) -> Triple {
      return {p[0].values[i], p[1].values[i], p[2].values[i]};
    };
    const double color = ColorError(at(seen_reference), at(seen_test));
    // The final difference: colour^(1 - feature).
    map.values[i] = std::pow(color, 1 - FeatureError(features_reference, features_test, i));
  }
  return map;
}

}  // namespace

Plane FlipMap(const Planes& reference, const Planes& test, double pixels_per_degree) {
  const int height = reference[0].height;
  const int radius =
      std::max(SensitivityRadius(pixels_per_degree), FeatureRadius(pixels_per_degree));
  Plane map(reference[0].width, height);
  for (const Band& band : BandsOf(height, radius)) {
    const Plane rows = FlipRows(RowsOf(reference, band.input_first, band.input_end),
                                RowsOf(test, band.input_first, band.input_end), pixels_per_degree);
    for (int y = band.first; y < band.end; ++y) {
      for (int x = 0; x < map.width; ++x) map.at(x, y) = rows.at(x, y - band.input_first);
    }
  }
  return map;
}

}  // namespace nacre
