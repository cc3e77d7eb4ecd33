// SPDX-License-Identifier: Apache-2.0
// textbook/faults.h: the faults of the founding lesson's program, with a switch for each, so that
// their effects on a picture can be measured separately.
//
// This folder contains only the lesson's program in C++: scalar, in double, without sharing code
// with the renderer. The renderer never includes it.
#pragma once

#include <span>

namespace nacre {

// On: as in the lesson. Off: correct. "E4" and so on are the numbers of the faults in `nacre
// explain textbook`.
struct TextbookFaults {
  // The reflection models.
  bool schlick_geometry = true;  // E2: Schlick's G, k = (r + 1)^2 / 8; off: height-correlated Smith
  bool denominator_epsilon = true;  // E4: 4 n.l n.v + 0.0001
  bool distribution_floor = true;   // E5: D's denominator is at least 1e-10
  bool v_dot_h_floor = true;        // E5: v.h is at least 0.001
  bool ungated_specular = true;     // E12: Phong's highlight even if the light is below
  bool clip_in_shading = true;      // E10: Phong's colour is clipped to [0, 1]
  bool normalize_epsilon = true;    // E16: vectors shorter than 1e-10 are not normalised

  // Light and its units.
  bool phong_without_pi = true;     // E9: kd and ks are reflectances times pi; off: kd / pi, and a
                                    // normalised lobe (Lafortune and Willems 1994)
  bool pbr_without_ambient = true;  // E9: ambient light falls on the Phong half only
  bool no_falloff = true;           // E15: off: 1 / d^2, with the same irradiance at the spheres'
                                    // centre

  // Cameras and spheres.
  bool pixel_corners = true;      // E13: rays through x / W; off: (x + 1/2) / W
  bool shared_grid_point = true;  // E14: all spheres of the grid are shaded at the same point
  bool perspective_view = true;   // E14: shaded as seen from the origin, but drawn as if from
                                  // infinity
  bool no_far_root = true;        // E28: from inside, spheres are not hit

  // From radiance to the file.
  bool encode_per_light = true;  // E8: tone map and gamma in the shading, for each light; off:
                                 // once, for the sum of all lights
  bool raw_left_half = true;   // E9: the Phong half and the background are neither tone-mapped nor
                               // encoded
  bool gamma22 = true;         // E24: x^(1/2.2); off: the exact sRGB curve
  bool png_truncation = true;  // E30: x * 255 truncated; off: rounded

  // Where the lesson's text and its program disagree, the program is followed. On: follows the
  // text.
  bool k_from_words = false;        // E1: k = (r^2 + 1)^2 / 8
  bool ambient_from_words = false;  // E26: ambient light has the light's colour
};

struct FaultSwitch {
  const char* name;   // "denominator_epsilon"
  const char* fault;  // "E4"
  bool TextbookFaults::*member;
};

// The faults of the program: every switch except the last two.
std::span<const FaultSwitch> FaultSwitches();

// The lesson without any faults.
TextbookFaults NoFaults();

// The lesson without this fault.
TextbookFaults Without(bool TextbookFaults::*fault);

}  // namespace nacre
