// SPDX-License-Identifier: Apache-2.0
// compare/flip_color.h: the colour spaces and differences of FLIP (Andersson et al. 2020), in
// double. SIMD twin: flip_color-inl.h.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace nacre::flip {

using Triple = std::array<double, 3>;
using Matrix = std::array<Triple, 3>;

// Linear sRGB to XYZ under D65, as fractions that follow from the chromaticities of the primaries
// and the white in IEC 61966-2-1; the authors' own program uses the same.
inline constexpr Matrix kXyzFromRgb = {{
    {10135552.0 / 24577794, 8788810.0 / 24577794, 4435075.0 / 24577794},
    {2613072.0 / 12288897, 8788810.0 / 12288897, 887015.0 / 12288897},
    {1425312.0 / 73733382, 8788810.0 / 73733382, 70074185.0 / 73733382},
}};

constexpr Triple Multiply(const Matrix& m, const Triple& v) {
  Triple out{};
  for (size_t i = 0; i < 3; ++i) out[i] = m[i][0] * v[0] + m[i][1] * v[1] + m[i][2] * v[2];
  return out;
}

// XYZ of white, (1, 1, 1).
inline constexpr Triple kWhite = Multiply(kXyzFromRgb, {1, 1, 1});

// Computed by cofactors.
constexpr Matrix Inverse(const Matrix& m) {
  Matrix out{};
  for (size_t i = 0; i < 3; ++i) {
    for (size_t j = 0; j < 3; ++j) {
      const size_t r0 = (j + 1) % 3, r1 = (j + 2) % 3, c0 = (i + 1) % 3, c1 = (i + 2) % 3;
      out[i][j] = m[r0][c0] * m[r1][c1] - m[r0][c1] * m[r1][c0];
    }
  }
  const double determinant = m[0][0] * out[0][0] + m[0][1] * out[1][0] + m[0][2] * out[2][0];
  for (Triple& row : out) {
    for (double& value : row) value /= determinant;
  }
  return out;
}
inline constexpr Matrix kRgbFromXyz = Inverse(kXyzFromRgb);

// The opponent space YyCxCz, in which pictures are filtered: CIELAB without its cube root, so that
// it is linear. Y is -16 for black and 100 for white.
inline Triple YccFromRgb(const Triple& rgb) {
  Triple xyz = Multiply(kXyzFromRgb, rgb);
  for (size_t i = 0; i < 3; ++i) xyz[i] /= kWhite[i];
  return {116 * xyz[1] - 16, 500 * (xyz[0] - xyz[1]), 200 * (xyz[1] - xyz[2])};
}

inline Triple RgbFromYcc(const Triple& ycc) {
  const double y = (ycc[0] + 16) / 116;
  const Triple xyz = {(y + ycc[1] / 500) * kWhite[0], y * kWhite[1],
                      (y - ycc[2] / 200) * kWhite[2]};
  return Multiply(kRgbFromXyz, xyz);
}

// CIELAB with the Hunt effect: chroma is multiplied by L* / 100, because colours fade in the dark.
inline Triple HuntLabFromRgb(const Triple& rgb) {
  constexpr double kDelta = 6.0 / 29;
  Triple f = Multiply(kXyzFromRgb, rgb);
  for (size_t i = 0; i < 3; ++i) {
    const double t = f[i] / kWhite[i];
    f[i] = t > kDelta * kDelta * kDelta ? std::cbrt(t) : t / (3 * kDelta * kDelta) + 4.0 / 29;
  }
  const double lightness = 116 * f[1] - 16;
  return {lightness, 0.01 * lightness * 500 * (f[0] - f[1]),
          0.01 * lightness * 200 * (f[1] - f[2])};
}

// The visible colour of filtered values: colours that no display shows are clipped.
inline Triple SeenColor(const Triple& ycc) {
  Triple rgb = RgbFromYcc(ycc);
  for (double& value : rgb) value = std::clamp(value, 0.0, 1.0);
  return HuntLabFromRgb(rgb);
}

// Abasi et al. 2020, a distance for large differences: |dL| + sqrt(da^2 + db^2).
inline double HyabDistance(const Triple& a, const Triple& b) {
  return std::abs(a[0] - b[0]) + std::hypot(a[1] - b[1], a[2] - b[2]);
}

// The exponent of colour differences, and the fraction kShareOfMax of the largest difference to
// which the lower part kShareOfRange of the scale is assigned.
inline constexpr double kColorExponent = 0.7;
inline constexpr double kShareOfMax = 0.4;
inline constexpr double kShareOfRange = 0.95;

// The largest HyAB^0.7, which is that between green and blue.
inline double LargestDifference() {
  return std::pow(HyabDistance(HuntLabFromRgb({0, 1, 0}), HuntLabFromRgb({0, 0, 1})),
                  kColorExponent);
}

// Maps HyAB^0.7 to [0, 1] by two linear pieces. `largest`: LargestDifference().
inline double ColorError(double distance, double largest) {
  const double error = std::pow(distance, kColorExponent);
  const double knee = kShareOfMax * largest;
  if (error < knee) return kShareOfRange / knee * error;
  return kShareOfRange + (error - knee) / (largest - knee) * (1 - kShareOfRange);
}

// Combines the differences of edges and of points, given as magnitudes of gradients in [0, 1]: the
// larger one over sqrt 2, to the power of 0.5.
inline double FeatureError(double edges, double points) {
  return std::sqrt(std::max(std::abs(edges), std::abs(points)) / std::numbers::sqrt2);
}

// The final difference.
inline double Flip(double color_error, double feature_error) {
  return std::pow(color_error, 1 - feature_error);
}

}  // namespace nacre::flip
