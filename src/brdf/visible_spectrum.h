// SPDX-License-Identifier: Apache-2.0
// brdf/visible_spectrum.h: what the channels of linear Rec. 709 see of a reflectance spectrum, and
// of the fringes in one.
#pragma once

#include <array>
#include <complex>
#include <cstdint>
#include <vector>

#include "base/vec.h"

namespace nacre {

inline constexpr double kShortestWavelength = 360;  // nm
inline constexpr double kLongestWavelength = 830;

// The light under which a reflectance spectrum becomes three numbers.
enum class Illuminant : uint8_t {
  kEqualEnergy,  // Belcour and Barla, MaterialX
  kD65,          // the white of Rec. 709
};

// What each channel of Rec. 709 makes of reflectance at this wavelength: the CIE 1931 colour
// matching functions times the light. Scaled so that a constant reflectance of 1 is the colour
// (1, 1, 1) under either illuminant; negative at some wavelengths, so that the colour of a
// reflectance may lie outside of [0, 1]. Between the tables' wavelengths, 5 nm apart, the colour
// matching functions are a natural cubic spline, which differs from the CIE's table of 1 nm by 1e-4
// in the fringes of thick films, and by 4e-6 elsewhere.
Rgb ChannelSensitivity(Illuminant illuminant, double wavelength_nm);

// The integral over the spectrum of sensitivity times exp(-2 pi i opd / wavelength): how the
// channels see fringes of this optical path difference. It is 1 at 0, and no more than 1e-5 beyond
// kCoherenceLength, where it is taken for 0.
//
// Computed from a table, which the first call for an illuminant makes in 3 ms: the
// frequencies of the spectrum lie within 40 % of one, about which the rest varies slowly. The
// table's error is 1e-6.
inline constexpr double kCoherenceLength = 60e3;  // nm

class Coherence {
 public:
  explicit Coherence(Illuminant illuminant);

  // The integral is exp(-2 pi i kMeanWavenumber opd) times Envelope(opd), for opd >= 0.
  static constexpr double kMeanWavenumber = 1.0 / 505;  // 1 / nm
  std::array<std::complex<double>, 3> Envelope(double opd_nm) const;

 private:
  struct Entry {
    std::array<double, 3> real{}, imaginary{};
  };
  std::vector<Entry> table_;
};

const Coherence& CoherenceOf(Illuminant illuminant);

}  // namespace nacre
