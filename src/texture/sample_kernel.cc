// SPDX-License-Identifier: Apache-2.0
// texture/sample_kernel.cc: the loops of sample_kernel.h.
#include "texture/sample_kernel.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "texture/sample_kernel.cc"
#include "hwy/foreach_target.h"

#include "hwy/highway.h"

#include "texture/sample-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre::HWY_NAMESPACE {

template <class D>
HWY_INLINE TexelFloat<D> LevelAt(D d, const MipChain& image, const SampleSettings& settings,
                                 const SamplePoints& points, size_t i) {
  const TexelFloatTag<D> df;
  if (settings.filter != TextureFilter::kTrilinear) return hn::Zero(df);
  const auto& f = points.footprint;
  const auto load = [&](const float* from) HWY_ATTR { return hn::LoadU(df, from + i); };
  return MipLevelOf(
      d, image,
      TextureFootprint<TexelFloat<D>>{load(f.du_dx), load(f.dv_dx), load(f.du_dy), load(f.dv_dy)});
}

void SampleSlopesT(const MipChain& image, const SampleSettings& settings,
                   const SamplePoints& points, float* to_u, float* to_v) {
  const hn::ScalableTag<double> d;
  const TexelFloatTag<decltype(d)> df;
  using V = hn::Vec<decltype(d)>;
  const V half = hn::Set(d, 0.5);
  for (size_t i = 0; i < points.count; i += hn::Lanes(d)) {
    const auto level = LevelAt(d, image, settings, points, i);
    const V texels = hn::PromoteTo(d, Exp2(df, level));
    const V u = hn::LoadU(d, points.u + i), v = hn::LoadU(d, points.v + i);
    const auto at = [&](V x, V y) HWY_ATTR {
      auto height = hn::Zero(df);
      SampleImage(d, image, settings, level, x, y, points.count - i, 1,
                  [&](int, auto value, auto lanes)
                      HWY_ATTR { height = hn::IfThenElse(lanes, value, height); });
      return hn::PromoteTo(d, height);
    };
    const auto slope = [&](int size, bool along_u, float* to) HWY_ATTR {
      const V step = hn::Mul(texels, hn::Set(d, 1.0 / size));
      const V shift = hn::Mul(step, half);
      const V after = along_u ? at(hn::Add(u, shift), v) : at(u, hn::Add(v, shift));
      const V before = along_u ? at(hn::Sub(u, shift), v) : at(u, hn::Sub(v, shift));
      hn::StoreU(hn::DemoteTo(df, hn::Div(hn::Sub(after, before), step)), df, to + i);
    };
    slope(image.levels[0].width, true, to_u);
    slope(image.levels[0].height, false, to_v);
  }
}

void SampleTextureT(const MipChain& image, const SampleSettings& settings,
                    const SamplePoints& points, int channels, float* const* to) {
  const hn::ScalableTag<double> d;
  const TexelFloatTag<decltype(d)> df;
  for (size_t i = 0; i < points.count; i += hn::Lanes(d)) {
    const auto level = LevelAt(d, image, settings, points, i);
    SampleImage(d, image, settings, level, hn::LoadU(d, points.u + i), hn::LoadU(d, points.v + i),
                points.count - i, channels, [&](int c, auto value, auto lanes) HWY_ATTR {
                  hn::BlendedStore(value, lanes, df, to[c] + i);
                });
  }
}

}  // namespace nacre::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nacre {
HWY_EXPORT(SampleTextureT);
HWY_EXPORT(SampleSlopesT);

void SampleTexture(const MipChain& image, const SampleSettings& settings,
                   const SamplePoints& points, int channels, float* const* to) {
  HWY_DYNAMIC_DISPATCH(SampleTextureT)(image, settings, points, channels, to);
}

void SampleSlopes(const MipChain& image, const SampleSettings& settings, const SamplePoints& points,
                  float* to_u, float* to_v) {
  HWY_DYNAMIC_DISPATCH(SampleSlopesT)(image, settings, points, to_u, to_v);
}
}  // namespace nacre
#endif
