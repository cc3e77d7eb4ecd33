// SPDX-License-Identifier: Apache-2.0
// tests/stress/fuzz_draws.h: the random and the special values that the fuzz draws.
#pragma once

#include <cmath>
#include <cstdint>

#include "base/vec.h"
#include "scene/material.h"
#include "scene/material_parameters.h"

namespace nacre {

// SplitMix64 (Steele, Lea and Flood 2014): the same numbers everywhere.
class FuzzRandom {
 public:
  explicit FuzzRandom(uint64_t seed) : state_(seed) {}

  uint64_t Bits() {
    uint64_t z = state_ += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }
  uint64_t Below(uint64_t end) { return Bits() % end; }
  bool OneIn(uint64_t n) { return Below(n) == 0; }
  double Uniform(double low, double high) {
    return low + (high - low) * static_cast<double>(Bits() >> 11) * 0x1p-53;
  }
  // Uniform in the logarithm.
  double Magnitude(double low, double high) {
    return std::exp(Uniform(std::log(low), std::log(high)));
  }
  // Unit, uniform over the sphere.
  Vec3d Direction() {
    for (;;) {
      const Vec3d v(Uniform(-1, 1), Uniform(-1, 1), Uniform(-1, 1));
      if (v.length() > 0.1 && v.length() < 1) return v.normalized();
    }
  }
  template <class T, size_t kCount>
  T Pick(const T (&values)[kCount]) {
    return values[Below(kCount)];
  }

 private:
  uint64_t state_;
};

// Unit to the rounding of double.
struct FuzzDirections {
  Vec3d normal, to_light, to_view;
};

// Three in four: three random directions. One in four: axes, signed zeros, denormal components,
// equal and opposed directions, grazing light and viewer, mirrors and nearly mirrors.
FuzzDirections DrawDirections(FuzzRandom* random);

// How far away the light is: mostly 1e-3 to 1e3, else from 0 to the largest length.
double DrawDistance(FuzzRandom* random);

// A light's colour from 0 to the largest radiance.
Rgb DrawLight(FuzzRandom* random);

// Of this model, with ends of ranges, zeros and known traps among the parameters.
Material DrawMaterial(const MaterialModel& model, FuzzRandom* random);

}  // namespace nacre
