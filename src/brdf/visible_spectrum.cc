// SPDX-License-Identifier: Apache-2.0
#include "brdf/visible_spectrum.h"

#include <algorithm>
#include <cmath>

namespace nacre {
namespace {

constexpr double kTableStep = 5;
constexpr size_t kTableSize = 95;
static_assert(kShortestWavelength + kTableStep * (kTableSize - 1) == kLongestWavelength);

// CIE 1931 standard colorimetric observer (2 degrees), x, y and z from 360 to 830 nm in steps of
// 5 nm: CIE 018:2019, table 6; every fifth row of the data set 10.25039/CIE.DS.xvudnb9b.
constexpr double kObserver[kTableSize][3] = {{0.0001299, 3.917e-06, 0.0006061},
                                             {0.0002321, 6.965e-06, 0.001086},
                                             {0.0004149, 1.239e-05, 0.001946},
                                             {0.0007416, 2.202e-05, 0.003486},
                                             {0.001368, 3.9e-05, 0.006450001},
                                             {0.002236, 6.4e-05, 0.01054999},
                                             {0.004243, 0.00012, 0.02005001},
                                             {0.00765, 0.000217, 0.03621},
                                             {0.01431, 0.000396, 0.06785001},
                                             {0.02319, 0.00064, 0.1102},
                                             {0.04351, 0.00121, 0.2074},
                                             {0.07763, 0.00218, 0.3713},
                                             {0.13438, 0.004, 0.6456},
                                             {0.21477, 0.0073, 1.0390501},
                                             {0.2839, 0.0116, 1.3856},
                                             {0.3285, 0.01684, 1.62296},
                                             {0.34828, 0.023, 1.74706},
                                             {0.34806, 0.0298, 1.7826},
                                             {0.3362, 0.038, 1.77211},
                                             {0.3187, 0.048, 1.7441},
                                             {0.2908, 0.06, 1.6692},
                                             {0.2511, 0.0739, 1.5281},
                                             {0.19536, 0.09098, 1.28764},
                                             {0.1421, 0.1126, 1.0419},
                                             {0.09564, 0.13902, 0.8129501},
                                             {0.05795001, 0.1693, 0.6162},
                                             {0.03201, 0.20802, 0.46518},
                                             {0.0147, 0.2586, 0.3533},
                                             {0.0049, 0.323, 0.272},
                                             {0.0024, 0.4073, 0.2123},
                                             {0.0093, 0.503, 0.1582},
                                             {0.0291, 0.6082, 0.1117},
                                             {0.06327, 0.71, 0.07824999},
                                             {0.1096, 0.7932, 0.05725001},
                                             {0.1655, 0.862, 0.04216},
                                             {0.2257499, 0.9148501, 0.02984},
                                             {0.2904, 0.954, 0.0203},
                                             {0.3597, 0.9803, 0.0134},
                                             {0.4334499, 0.9949501, 0.008749999},
                                             {0.5120501, 1, 0.005749999},
                                             {0.5945, 0.995, 0.0039},
                                             {0.6784, 0.9786, 0.002749999},
                                             {0.7621, 0.952, 0.0021},
                                             {0.8425, 0.9154, 0.0018},
                                             {0.9163, 0.87, 0.001650001},
                                             {0.9786, 0.8163, 0.0014},
                                             {1.0263, 0.757, 0.0011},
                                             {1.0567, 0.6949, 0.001},
                                             {1.0622, 0.631, 0.0008},
                                             {1.0456, 0.5668, 0.0006},
                                             {1.0026, 0.503, 0.00034},
                                             {0.9384, 0.4412, 0.00024},
                                             {0.8544499, 0.381, 0.00019},
                                             {0.7514, 0.321, 0.0001},
                                             {0.6424, 0.265, 4.999999e-05},
                                             {0.5419, 0.217, 3e-05},
                                             {0.4479, 0.175, 2e-05},
                                             {0.3608, 0.1382, 1e-05},
                                             {0.2835, 0.107, 0},
                                             {0.2187, 0.0816, 0},
                                             {0.1649, 0.061, 0},
                                             {0.1212, 0.04458, 0},
                                             {0.0874, 0.032, 0},
                                             {0.0636, 0.0232, 0},
                                             {0.04677, 0.017, 0},
                                             {0.0329, 0.01192, 0},
                                             {0.0227, 0.00821, 0},
                                             {0.01584, 0.005723, 0},
                                             {0.01135916, 0.004102, 0},
                                             {0.008110916, 0.002929, 0},
                                             {0.005790346, 0.002091, 0},
                                             {0.004109457, 0.001484, 0},
                                             {0.002899327, 0.001047, 0},
                                             {0.00204919, 0.00074, 0},
                                             {0.001439971, 0.00052, 0},
                                             {0.0009999493, 0.0003611, 0},
                                             {0.0006900786, 0.0002492, 0},
                                             {0.0004760213, 0.0001719, 0},
                                             {0.0003323011, 0.00012, 0},
                                             {0.0002348261, 8.48e-05, 0},
                                             {0.0001661505, 6e-05, 0},
                                             {0.000117413, 4.24e-05, 0},
                                             {8.307527e-05, 3e-05, 0},
                                             {5.870652e-05, 2.12e-05, 0},
                                             {4.150994e-05, 1.499e-05, 0},
                                             {2.935326e-05, 1.06e-05, 0},
                                             {2.067383e-05, 7.4657e-06, 0},
                                             {1.455977e-05, 5.2578e-06, 0},
                                             {1.025398e-05, 3.7029e-06, 0},
                                             {7.221456e-06, 2.6078e-06, 0},
                                             {5.085868e-06, 1.8366e-06, 0},
                                             {3.581652e-06, 1.2934e-06, 0},
                                             {2.522525e-06, 9.1093e-07, 0},
                                             {1.776509e-06, 6.4153e-07, 0},
                                             {1.251141e-06, 4.5181e-07, 0}};

// CIE standard illuminant D65 at the same wavelengths: ISO/CIE 11664-2:2022, table 1. It is linear
// in between.
constexpr double kD65[kTableSize] = {
    46.6383, 49.3637, 52.0891, 51.0323, 49.9755, 52.3118, 54.6482, 68.7015, 82.7549, 87.1204,
    91.486,  92.4589, 93.4318, 90.057,  86.6823, 95.7736, 104.865, 110.936, 117.008, 117.41,
    117.812, 116.336, 114.861, 115.392, 115.923, 112.367, 108.811, 109.082, 109.354, 108.578,
    107.802, 106.296, 104.79,  106.239, 107.689, 106.047, 104.405, 104.225, 104.046, 102.023,
    100,     98.1671, 96.3342, 96.0611, 95.788,  92.2368, 88.6856, 89.3459, 90.0062, 89.8026,
    89.5991, 88.6489, 87.6987, 85.4936, 83.2886, 83.4939, 83.6992, 81.863,  80.0268, 80.1207,
    80.2146, 81.2462, 82.2778, 80.281,  78.2842, 74.0027, 69.7213, 70.6652, 71.6091, 72.979,
    74.349,  67.9765, 61.604,  65.7448, 69.8856, 72.4863, 75.087,  69.3398, 63.5927, 55.0054,
    46.4182, 56.6118, 66.8054, 65.0941, 63.3828, 63.8434, 64.304,  61.8779, 59.4519, 55.7054,
    51.959,  54.6998, 57.4406, 58.8765, 60.3125};

// x, y and 1 - x - y of the primaries of ITU-R BT.709.
constexpr double kPrimaries[3][3] = {{0.64, 0.33, 0.03}, {0.30, 0.60, 0.10}, {0.15, 0.06, 0.79}};

// A channel is the linear function of XYZ that is 0 for the other two primaries, the cross product
// of theirs, up to a factor that the normalisation sets.
double Channel(size_t channel, const double (&xyz)[3]) {
  const auto& a = kPrimaries[(channel + 1) % 3];
  const auto& b = kPrimaries[(channel + 2) % 3];
  return (a[1] * b[2] - a[2] * b[1]) * xyz[0] + (a[2] * b[0] - a[0] * b[2]) * xyz[1] +
         (a[0] * b[1] - a[1] * b[0]) * xyz[2];
}

// The channels of the table's wavelengths, before they are multiplied by the light and normalised,
// and their second derivatives in units of the step: a natural spline.
struct Spline {
  std::array<std::array<double, 3>, kTableSize> values{}, bends{};
};

Spline MakeSpline() {
  Spline spline;
  for (size_t c = 0; c < 3; ++c) {
    for (size_t i = 0; i < kTableSize; ++i) spline.values[i][c] = Channel(c, kObserver[i]);
    std::array<double, kTableSize> above{}, right{};  // Thomas' algorithm
    for (size_t i = 1; i + 1 < kTableSize; ++i) {
      const double difference =
          spline.values[i + 1][c] - 2 * spline.values[i][c] + spline.values[i - 1][c];
      const double pivot = 4 - above[i - 1];
      above[i] = 1 / pivot;
      right[i] = (6 * difference - right[i - 1]) / pivot;
    }
    for (size_t i = kTableSize - 2; i > 0; --i) {
      spline.bends[i][c] = right[i] - above[i] * spline.bends[i + 1][c];
    }
  }
  return spline;
}

// Sensitivity before it is normalised.
Rgb RawSensitivity(Illuminant illuminant, double wavelength_nm) {
  static const Spline kSpline = MakeSpline();
  const double position = (wavelength_nm - kShortestWavelength) / kTableStep;
  if (!(position >= 0 && position <= kTableSize - 1)) return {0, 0, 0};
  const size_t i = std::min(static_cast<size_t>(position), kTableSize - 2);
  const double t = position - static_cast<double>(i);
  const double u = 1 - t;
  const double power = illuminant == Illuminant::kD65 ? u * kD65[i] + t * kD65[i + 1] : 1;
  return MakeRgb([&](size_t c) {
    const double straight = u * kSpline.values[i][c] + t * kSpline.values[i + 1][c];
    const double bend =
        u * (u * u - 1) * kSpline.bends[i][c] + t * (t * t - 1) * kSpline.bends[i + 1][c];
    return power * (straight + bend / 6);
  });
}

// Wavelengths 1 nm apart.
constexpr size_t kNanometres = static_cast<size_t>(kLongestWavelength - kShortestWavelength) + 1;
constexpr double Nanometre(size_t i) { return kShortestWavelength + static_cast<double>(i); }

// The sum over wavelengths 1 nm apart, by which each channel is normalised.
Rgb TotalSensitivity(Illuminant illuminant) {
  Rgb sum(0, 0, 0);
  for (size_t i = 0; i < kNanometres; ++i) sum += RawSensitivity(illuminant, Nanometre(i));
  return sum;
}

constexpr double kEnvelopeStep = 32;  // nm
constexpr size_t kEnvelopeSize = static_cast<size_t>(kCoherenceLength / kEnvelopeStep) + 3;

}  // namespace

Rgb ChannelSensitivity(Illuminant illuminant, double wavelength_nm) {
  static const std::array<Rgb, 2> kTotals{TotalSensitivity(Illuminant::kEqualEnergy),
                                          TotalSensitivity(Illuminant::kD65)};
  return RawSensitivity(illuminant, wavelength_nm) / kTotals[static_cast<size_t>(illuminant)];
}

// Entry i is the envelope at opd (i - 1) kEnvelopeStep. Steps of 1 nm keep fringes apart up to an
// optical path difference of lambda^2 / 2 nm, which is more than kCoherenceLength.
Coherence::Coherence(Illuminant illuminant) : table_(kEnvelopeSize) {
  for (size_t i = 0; i < kNanometres; ++i) {
    const Rgb sensitivity = ChannelSensitivity(illuminant, Nanometre(i));
    const double turn = -2 * M_PI * kEnvelopeStep * (1 / Nanometre(i) - kMeanWavenumber);
    const double step_real = std::cos(turn), step_imaginary = std::sin(turn);
    double real = step_real, imaginary = -step_imaginary;
    for (Entry& entry : table_) {
      for (size_t c = 0; c < 3; ++c) {
        entry.real[c] += sensitivity[static_cast<int>(c)] * real;
        entry.imaginary[c] += sensitivity[static_cast<int>(c)] * imaginary;
      }
      const double next = real * step_real - imaginary * step_imaginary;
      imaginary = real * step_imaginary + imaginary * step_real;
      real = next;
    }
  }
}

std::array<std::complex<double>, 3> Coherence::Envelope(double opd_nm) const {
  if (!(opd_nm < kCoherenceLength)) return {};
  const double position = opd_nm / kEnvelopeStep;
  const size_t i = static_cast<size_t>(position);
  // Cubic interpolation through the entries before, at and behind the interval.
  const double t = position - static_cast<double>(i);
  const double w[4] = {-t * (t - 1) * (t - 2) / 6, (t + 1) * (t - 1) * (t - 2) / 2,
                       -(t + 1) * t * (t - 2) / 2, (t + 1) * t * (t - 1) / 6};
  std::array<std::complex<double>, 3> envelope;
  for (size_t c = 0; c < 3; ++c) {
    double real = 0, imaginary = 0;
    for (size_t j = 0; j < 4; ++j) {
      real += w[j] * table_[i + j].real[c];
      imaginary += w[j] * table_[i + j].imaginary[c];
    }
    envelope[c] = {real, imaginary};
  }
  return envelope;
}

const Coherence& CoherenceOf(Illuminant illuminant) {
  if (illuminant == Illuminant::kD65) {
    static const Coherence kOfD65(Illuminant::kD65);
    return kOfD65;
  }
  static const Coherence kOfEqualEnergy(Illuminant::kEqualEnergy);
  return kOfEqualEnergy;
}

}  // namespace nacre
