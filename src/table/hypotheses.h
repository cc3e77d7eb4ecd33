// SPDX-License-Identifier: Apache-2.0
// table/hypotheses.h: the mistakes that implementers of a BRDF make, each as a change of what is
// evaluated, and the choices that implementations differ in.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "table/variant.h"

namespace nacre {

enum class HypothesisKind : uint8_t {
  kMistake,
  kChoice,  // one option of the model, such as the form of Smith's term
  kRules,   // all options of OpenPBR, as one implementation has them
};

struct Hypothesis {
  HypothesisKind kind = HypothesisKind::kMistake;
  std::string text;  // what the other program does: "all of f is multiplied by pi"
  std::function<void(Variant*)> apply;
};

// All that may make a difference for this material, simpler ones first; choices also name what the
// material has. They may be combined, one applied after the other.
std::vector<Hypothesis> HypothesesOf(const Material& material);

}  // namespace nacre
