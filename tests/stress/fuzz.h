// SPDX-License-Identifier: Apache-2.0
// tests/stress/fuzz.h: every reflection model under directions, parameters and lights drawn at
// random and from the list of values that break renderers, through the shading kernels of the
// active target. Models and parameters come from scene/material_parameters.h: new ones join by
// themselves.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

namespace nacre {

struct FuzzSettings {
  uint64_t draws = 1'000'000;  // of a model, a material, a hit and a light; rounded up
  uint64_t seed = 1;
  int threads = 0;
  bool flush_denormals = true;  // as the renderer's workers do; false: on one thread
  std::function<void(double)> on_progress;
};

struct FuzzResult {
  uint64_t draws = 0;
  uint64_t lit = 0;  // draws that light reaches
  uint64_t nan = 0;  // samples, as all that follow
  uint64_t negative = 0;
  uint64_t infinite = 0;       // though no lobe of the material reaches float's range
  uint64_t overflowed = 0;     // infinite where it may be: no fault
  uint64_t power_of_zero = 0;  // exponent 0, and the lobe is not the constant 1
  uint64_t moved = 0;          // whose bits depend on their place in the batch
  uint64_t hash = 0;           // of all bits; does not depend on threads
  std::string first_fault;

  bool Holds() const { return nan + negative + infinite + power_of_zero + moved == 0 && lit > 0; }
};

FuzzResult FuzzModels(const FuzzSettings& settings);

// One line.
std::string Describe(const FuzzResult& result);

}  // namespace nacre
