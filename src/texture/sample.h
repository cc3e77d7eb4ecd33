// SPDX-License-Identifier: Apache-2.0
// texture/sample.h: a texture's value at (u, v): wrapping, nearest, bilinear and trilinear. SIMD
// twin: sample-inl.h.
//
// Texel i of a row of W has its centre at u = (i + 1/2) / W, so a repeated image has period 1 and
// its mirror images join without a seam.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "texture/texels.h"

namespace nacre {

// How coordinates outside of [0, 1] are wrapped.
enum class Wrap : uint8_t { kRepeat, kClamp, kMirror };

enum class TextureFilter : uint8_t {
  kNearest,    // the texel that (u, v) lies in
  kBilinear,   // between the four nearest texel centres
  kTrilinear,  // bilinear in the two mip levels with texels about as large as a pixel, and between
};

struct SampleSettings {
  TextureFilter filter = TextureFilter::kTrilinear;
  Wrap wrap_u = Wrap::kRepeat;
  Wrap wrap_v = Wrap::kRepeat;
  friend bool operator==(const SampleSettings&, const SampleSettings&) = default;
};

// u wrapped to [0, 1]. NaN gives 0, and so do infinities unless they are clamped. Whole periods are
// subtracted exactly; the result for a u of 2^30 has the digits that u itself had.
template <typename Real>
Real WrapCoordinate(Real u, Wrap wrap) {
  Real wrapped = u;
  if (wrap == Wrap::kRepeat) {
    wrapped = u - std::floor(u);
  } else if (wrap == Wrap::kMirror) {
    const Real in_period = u - 2 * std::floor(u / 2);
    wrapped = in_period > 1 ? 2 - in_period : in_period;
  } else if (u > 1) {
    wrapped = 1;
  }
  return wrapped >= 0 ? wrapped : 0;
}

// The two taps of a linear look-up along one axis: the texel that a wrapped coordinate lies in, and
// its neighbour on the nearer side, with a weight of at most 1/2. Values are interpolated as
// differences from the nearer texel, so that equal texels give exactly their value.
template <typename Real>
struct Taps {
  int near, far;
  Real weight;  // the weight of `far`
};

template <typename Real>
Taps<Real> FindTaps(Real wrapped, int size, Wrap wrap) {
  const Real x = wrapped * static_cast<Real>(size);
  Taps<Real> taps;
  taps.near = std::min(static_cast<int>(x), size - 1);  // 1 is the end of the last texel
  const Real offset = x - static_cast<Real>(taps.near) - Real(0.5);
  taps.far = taps.near + (offset < 0 ? -1 : 1);
  if (wrap == Wrap::kRepeat) {
    taps.far = taps.far < 0 ? size - 1 : taps.far == size ? 0 : taps.far;
  } else {
    taps.far = std::clamp(taps.far, 0, size - 1);
  }
  taps.weight = std::abs(offset);
  return taps;
}

template <typename Real>
Real SampleNearest(const MipChain& image, size_t level, const SampleSettings& settings, Real u,
                   Real v, int channel) {
  const TexelView l = image.Level(level);
  const auto x = FindTaps(WrapCoordinate(u, settings.wrap_u), l.width, settings.wrap_u);
  const auto y = FindTaps(WrapCoordinate(v, settings.wrap_v), l.height, settings.wrap_v);
  return l.At(x.near, y.near, channel);
}

template <typename Real>
Real SampleBilinear(const MipChain& image, size_t level, const SampleSettings& settings, Real u,
                    Real v, int channel) {
  const TexelView l = image.Level(level);
  const auto x = FindTaps(WrapCoordinate(u, settings.wrap_u), l.width, settings.wrap_u);
  const auto y = FindTaps(WrapCoordinate(v, settings.wrap_v), l.height, settings.wrap_v);
  const auto row = [&](int at) {
    const Real near = l.At(x.near, at, channel);
    return near + x.weight * (l.At(x.far, at, channel) - near);
  };
  const Real near = row(y.near);
  return near + y.weight * (row(y.far) - near);
}

// The change of (u, v) from a sample's pixel to the next one, to the right (x) and downwards (y).
template <typename Real>
struct TextureFootprint {
  Real du_dx, dv_dx, du_dy, dv_dy;
};

// The mip level whose texels are as long as the longer side of the footprint; 0 is the image
// itself. Unbounded footprints get the last level.
template <typename Real>
Real MipLevelOf(const MipChain& image, const TextureFootprint<Real>& f) {
  const Real w = static_cast<Real>(image.levels[0].width);
  const Real h = static_cast<Real>(image.levels[0].height);
  const auto squared = [&](Real du, Real dv) { return (du * w) * (du * w) + (dv * h) * (dv * h); };
  const Real longer = std::max(squared(f.du_dx, f.dv_dx), squared(f.du_dy, f.dv_dy));
  const Real last = static_cast<Real>(image.levels.size() - 1);
  if (longer <= 1) return 0;
  const Real level = std::log2(longer) / 2;
  return level < last ? level : last;
}

template <typename Real>
Real SampleTrilinear(const MipChain& image, const SampleSettings& settings, Real mip_level, Real u,
                     Real v, int channel) {
  const auto level = static_cast<size_t>(mip_level);
  const size_t next = std::min(level + 1, image.levels.size() - 1);
  const Real near = SampleBilinear(image, level, settings, u, v, channel);
  const Real far = SampleBilinear(image, next, settings, u, v, channel);
  return near + (mip_level - static_cast<Real>(level)) * (far - near);
}

// Samples with the filter of the settings; only the trilinear one reads `mip_level`.
template <typename Real>
Real SampleChannel(const MipChain& image, const SampleSettings& settings, Real mip_level, Real u,
                   Real v, int channel) {
  switch (settings.filter) {
    case TextureFilter::kNearest:
      return SampleNearest(image, 0, settings, u, v, channel);
    case TextureFilter::kBilinear:
      return SampleBilinear(image, 0, settings, u, v, channel);
    default:
      return SampleTrilinear(image, settings, mip_level, u, v, channel);
  }
}

// The derivatives of the first channel with respect to u and v, by central differences over one
// texel of the level. Unlike the derivatives of a bilinear surface, they have no steps at the texel
// centres.
template <typename Real>
void SampleSlopes(const MipChain& image, const SampleSettings& settings, Real mip_level, Real u,
                  Real v, Real* du, Real* dv) {
  const auto at = [&](Real x, Real y) {
    return SampleChannel(image, settings, mip_level, x, y, 0);
  };
  const Real texels = settings.filter == TextureFilter::kTrilinear ? std::exp2(mip_level) : Real(1);
  const Real step_u = texels / static_cast<Real>(image.levels[0].width);
  const Real step_v = texels / static_cast<Real>(image.levels[0].height);
  *du = (at(u + step_u / 2, v) - at(u - step_u / 2, v)) / step_u;
  *dv = (at(u, v + step_v / 2) - at(u, v - step_v / 2)) / step_v;
}

}  // namespace nacre
