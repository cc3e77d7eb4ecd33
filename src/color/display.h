// SPDX-License-Identifier: Apache-2.0
// color/display.h: from linear scene radiance to 8-bit display codes: exposure, tone operator,
// exact sRGB transfer curve.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>

#include <Imath/ImathColor.h>

#include "base/image.h"
#include "base/picture.h"
#include "color/tone.h"

namespace nacre {

struct DisplaySettings {
  ToneOperator tone = ToneOperator::kNeutral;
  double exposure_ev = 0;  // radiance is multiplied by 2^exposure_ev first; in [-60, 60]
  double white = 4;        // kReinhardExtended: the radiance that becomes white, > 0
};

// Linear display light in [0, 1]. Negative values count as 0, infinity is allowed, NaN is not.
template <typename Real>
Imath::Color3<Real> DisplayLight(const DisplaySettings& settings, Imath::Color3<Real> rgb) {
  const Real scale = static_cast<Real>(std::exp2(settings.exposure_ev));
  for (int c = 0; c < 3; ++c) rgb[c] = std::max(rgb[c], Real(0)) * scale;
  const auto each = [&](auto curve) -> Imath::Color3<Real> {
    return {curve(rgb.x), curve(rgb.y), curve(rgb.z)};
  };
  switch (settings.tone) {
    case ToneOperator::kNeutral:
      return ToneNeutral(rgb);
    case ToneOperator::kReinhard:
      return each([](Real x) { return ToneReinhard(x); });
    case ToneOperator::kReinhardExtended: {
      const Real white = static_cast<Real>(settings.white);
      return each([white](Real x) { return ToneReinhardExtended(x, white); });
    }
    case ToneOperator::kAces:
      return each([](Real x) { return ToneAces(x); });
    case ToneOperator::kAgx:
      return ToneAgx(rgb);
    case ToneOperator::kNone:
      return each([](Real x) { return std::min(x, Real(1)); });
  }
  return {};
}

// Encodes `count` pixels, given as three planes of any alignment and without padding, as 8-bit
// sRGB: 3 count interleaved bytes in `rgb8`, which overlaps no plane.
//
// The display light is that of DisplayLight<double>, computed in float with a relative error of
// 1e-6 or an absolute one of 1e-7 (AgX: 4e-6 or 1e-6), whichever is larger. The code of that float
// is exact (color/srgb8.h). With kNone at exposure 0 codes are therefore exact for every float;
// otherwise they are off by at most one, where the light is within the error of a code's threshold.
//
// Pixels with a NaN become magenta (255, 0, 255). Returns their number.
size_t EncodeDisplay(const DisplaySettings& settings, const float* r, const float* g,
                     const float* b, size_t count, uint8_t* rgb8);

// Turns `count` pixels, given as three planes of any alignment and without padding, into linear
// display light in place, with the errors that EncodeDisplay states. The result of a pixel with a
// NaN is unspecified.
void ShowLight(const DisplaySettings& settings, size_t count, float* r, float* g, float* b);

// Turns sRGB values, clamped to [0, 1], into linear light in place, within 6e-7.
void DecodeSrgb(size_t count, float* values);

// The picture that a display shows of the image's channels R, G and B, or of those of a layer.
inline Rgb8Picture ShowImage(const Image& image, const DisplaySettings& settings,
                             const std::string& layer = {}) {
  const std::string prefix = layer.empty() ? "" : layer + ".";
  const auto plane = [&](const char* channel) {
    return image.Find(prefix + channel)->samples.data();
  };
  Rgb8Picture picture{image.data.width(), image.data.height(), {}};
  picture.rgb8.resize(3 * image.data.pixel_count());
  EncodeDisplay(settings, plane("R"), plane("G"), plane("B"), image.data.pixel_count(),
                picture.rgb8.data());
  return picture;
}

}  // namespace nacre
