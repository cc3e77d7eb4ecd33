// SPDX-License-Identifier: Apache-2.0
// tests/texture/lesson.h: nearest and bilinear look-ups as lessons write them: texels at the whole
// numbers of u (W - 1), so that u = 0 and u = 1 are the centres of the first and the last texel. A
// repeated image then shows both of these at its seam, and its period is W - 1 texels. For
// comparison only; the renderer's look-ups are those of texture/sample.h.
#pragma once

#include <algorithm>
#include <cmath>
#include <utility>

#include "texture/sample.h"

namespace nacre {

// (1 - t) a + t b: exact at t = 0 and t = 1.
template <typename Real>
Real LessonLerp(Real a, Real b, Real t) {
  return (1 - t) * a + t * b;
}

// Where the lesson looks in the finest level: in texels, from the centre of the first.
template <typename Real>
std::pair<Real, Real> LessonPlace(const MipLevel& level, const SampleSettings& settings, Real u,
                                  Real v) {
  return {WrapCoordinate(u, settings.wrap_u) * static_cast<Real>(level.width - 1),
          WrapCoordinate(v, settings.wrap_v) * static_cast<Real>(level.height - 1)};
}

// Halves round away from 0, as C's round() does and not as Python's.
template <typename Real>
Real LessonNearest(const MipChain& image, const SampleSettings& settings, Real u, Real v,
                   int channel) {
  const auto [x, y] = LessonPlace(image.levels[0], settings, u, v);
  return image.Value(0, static_cast<int>(std::round(x)), static_cast<int>(std::round(y)), channel);
}

// The texel after the last one, which the lesson reads at u = 1, is the last one here.
template <typename Real>
Real LessonBilinear(const MipChain& image, const SampleSettings& settings, Real u, Real v,
                    int channel) {
  const MipLevel& l = image.levels[0];
  const auto [x, y] = LessonPlace(l, settings, u, v);
  const int x0 = static_cast<int>(x), y0 = static_cast<int>(y);
  const int x1 = std::min(x0 + 1, l.width - 1), y1 = std::min(y0 + 1, l.height - 1);
  const Real tx = x - static_cast<Real>(x0), ty = y - static_cast<Real>(y0);
  const auto row = [&](int at) {
    return LessonLerp<Real>(image.Value(0, x0, at, channel), image.Value(0, x1, at, channel), tx);
  };
  return LessonLerp(row(y0), row(y1), ty);
}

}  // namespace nacre
