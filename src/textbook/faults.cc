// SPDX-License-Identifier: Apache-2.0
#include "textbook/faults.h"

namespace nacre {

std::span<const FaultSwitch> FaultSwitches() {
  using F = TextbookFaults;
  static constexpr FaultSwitch kSwitches[] = {
      {"schlick_geometry", "E2", &F::schlick_geometry},
      {"denominator_epsilon", "E4", &F::denominator_epsilon},
      {"distribution_floor", "E5", &F::distribution_floor},
      {"v_dot_h_floor", "E5", &F::v_dot_h_floor},
      {"encode_per_light", "E8", &F::encode_per_light},
      {"raw_left_half", "E9", &F::raw_left_half},
      {"phong_without_pi", "E9", &F::phong_without_pi},
      {"pbr_without_ambient", "E9", &F::pbr_without_ambient},
      {"clip_in_shading", "E10", &F::clip_in_shading},
      {"ungated_specular", "E12", &F::ungated_specular},
      {"pixel_corners", "E13", &F::pixel_corners},
      {"shared_grid_point", "E14", &F::shared_grid_point},
      {"perspective_view", "E14", &F::perspective_view},
      {"no_falloff", "E15", &F::no_falloff},
      {"normalize_epsilon", "E16", &F::normalize_epsilon},
      {"gamma22", "E24", &F::gamma22},
      {"no_far_root", "E28", &F::no_far_root},
      {"png_truncation", "E30", &F::png_truncation},
  };
  return kSwitches;
}

TextbookFaults NoFaults() {
  TextbookFaults faults;
  for (const FaultSwitch& fault : FaultSwitches()) faults.*fault.member = false;
  return faults;
}

TextbookFaults Without(bool TextbookFaults::*fault) {
  TextbookFaults faults;
  faults.*fault = false;
  return faults;
}

}  // namespace nacre
