// SPDX-License-Identifier: Apache-2.0
#include "textbook/conventions.h"

#include <algorithm>
#include <cmath>

#include "base/vec.h"
#include "textbook/shading.h"

namespace nacre {
namespace {

constexpr double kDegreesPerRadian = 180 / M_PI;

// A number that counts the operations done with it.
struct Counted {
  double value = 0;
  static inline OperationCount count;
};
Counted operator+(Counted a, Counted b) {
  ++Counted::count.additions;
  return {a.value + b.value};
}
Counted operator-(Counted a, Counted b) {
  ++Counted::count.additions;
  return {a.value - b.value};
}
Counted operator*(Counted a, Counted b) {
  ++Counted::count.multiplications;
  return {a.value * b.value};
}
Counted operator/(Counted a, Counted b) {
  ++Counted::count.divisions;
  return {a.value / b.value};
}
Counted SquareRoot(Counted a) {
  ++Counted::count.roots;
  return {std::sqrt(a.value)};
}

struct CountedVec {
  Counted x, y, z;
};
Counted Dot(const CountedVec& a, const CountedVec& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

const CountedVec kNormal{{0}, {0}, {1}};
const CountedVec kToLight{{0.6}, {0}, {0.8}};
const CountedVec kToView{{0}, {0.6}, {0.8}};

}  // namespace

double DirectKOfWords(double roughness) { return DirectKOfProgram(roughness * roughness); }
double DirectKOfProgram(double roughness) { return (roughness + 1) * (roughness + 1) / 8; }
double AmbientKOfWords(double roughness) { return std::pow(roughness, 4) / 2; }
double AmbientKOfSource(double roughness) { return roughness * roughness / 2; }

double EpsilonLoss(double n_dot_l, double n_dot_v) {
  return 0.0001 / (4 * n_dot_l * n_dot_v + 0.0001);
}

double FloorFactor(double roughness) {
  const TextbookAngles peak{.n_dot_l = 1, .n_dot_v = 1, .n_dot_h = 1, .v_dot_h = 1, .sin2_h = 0};
  const TextbookFaults lesson;
  return TextbookDistribution(peak, roughness, Without(&TextbookFaults::distribution_floor)) /
         TextbookDistribution(peak, roughness, lesson);
}

// The solution of pi alpha^4 = 1e-10 with alpha = r^2.
double FloorRoughness() { return std::pow(1e-10 / M_PI, 1.0 / 8); }

// |edge x edge| = edge^2 sin(60 deg).
double ShortestTriangleEdge(double epsilon) { return std::sqrt(epsilon / std::sqrt(0.75)); }

double AttenuationLoss(double distance) {
  return 1 - TextbookAttenuation(distance) * distance * distance;
}

double UnnormalizedLightLength() { return Vec3d(1, -1, 1).length(); }

double TexelShift(int width) {
  double largest = 0;
  constexpr int kSteps = 1000;
  for (int i = 0; i <= kSteps; ++i) {
    const double u = static_cast<double>(i) / kSteps;
    largest = std::max(largest, std::abs(u * (width - 1) - (u * width - 0.5)));
  }
  return largest;
}

double TexelPeriodLoss(int width) { return 1.0 / width; }

double FlatMapTiltPerAxisDeg() {
  const double x = 2 * 128.0 / 255 - 1;
  return std::atan(x) * kDegreesPerRadian;
}

double FlatMapTiltDeg() {
  const double x = 2 * 128.0 / 255 - 1;
  return std::atan(std::hypot(x, x)) * kDegreesPerRadian;
}

double DisplacedNormalErrorDeg(double amplitude, double wavelength) {
  return std::atan(amplitude * 2 * M_PI / wavelength) * kDegreesPerRadian;
}

GammaError LargestGammaError() {
  GammaError error;
  const TextbookFaults lesson;
  const TextbookFaults exact = Without(&TextbookFaults::gamma22);
  constexpr int kSteps = 100000;
  for (int i = 0; i <= kSteps; ++i) {
    const double x = static_cast<double>(i) / kSteps;
    const double radiance = x / (1 - x);  // its Reinhard curve gives x
    if (!std::isfinite(radiance)) continue;
    const double difference =
        std::abs(TextbookEncode(radiance, lesson) - TextbookEncode(radiance, exact));
    if (difference > error.difference) error = {difference, x};
  }
  return error;
}

int PixelsDrawnTwice(int side) {
  int twice = 0;
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      const double edge = (x + 0.5) - (y + 0.5);  // distance from the diagonal; >= 0 inside one
                                                  // half
      twice += (edge >= 0) && (-edge >= 0);
    }
  }
  return twice;
}

// R = 2 (N.L) N - L; R.V.
OperationCount CountPhongCosine() {
  Counted::count = {};
  const Counted twice = Counted{2} * Dot(kNormal, kToLight);
  const CountedVec r{twice * kNormal.x - kToLight.x, twice * kNormal.y - kToLight.y,
                     twice * kNormal.z - kToLight.z};
  Dot(r, kToView);
  return Counted::count;
}

// H = (L + V) / |L + V|; N.H, divided once: N.(L + V) / |L + V|.
OperationCount CountBlinnCosine() {
  Counted::count = {};
  const CountedVec u{kToLight.x + kToView.x, kToLight.y + kToView.y, kToLight.z + kToView.z};
  const Counted cosine = Dot(kNormal, u) / SquareRoot(Dot(u, u));
  static_cast<void>(cosine);
  return Counted::count;
}

}  // namespace nacre
