// SPDX-License-Identifier: Apache-2.0
// texture/sample-inl.h: texture look-ups on SIMD vectors. Scalar twin: sample.h.
//
// Coordinates are doubles until the texel is found, so that 65536 texels a side can be
// distinguished for any (u, v); weights and values are floats. All lanes sample the same image.
#if defined(NACRE_TEXTURE_SAMPLE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_TEXTURE_SAMPLE_INL_H_
#undef NACRE_TEXTURE_SAMPLE_INL_H_
#else
#define NACRE_TEXTURE_SAMPLE_INL_H_
#endif

#include "base/math-inl.h"
#include "texture/sample.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <class D>
using TexelFloatTag = hn::Rebind<float, D>;
template <class D>
using TexelIndexTag = hn::Rebind<int32_t, D>;
template <class D>
using TexelFloat = hn::Vec<TexelFloatTag<D>>;
template <class D>
using TexelIndex = hn::Vec<TexelIndexTag<D>>;

template <class D, class V = hn::Vec<D>>
HWY_INLINE V WrapCoordinate(D d, V u, Wrap wrap) {
  const V zero = hn::Zero(d), one = hn::Set(d, 1.0);
  V wrapped = u;
  if (wrap == Wrap::kRepeat) {
    wrapped = hn::Sub(u, hn::Floor(u));
  } else if (wrap == Wrap::kMirror) {
    const V half = hn::Floor(hn::Mul(u, hn::Set(d, 0.5)));
    const V in_period = hn::Sub(u, hn::Add(half, half));
    wrapped =
        hn::IfThenElse(hn::Gt(in_period, one), hn::Sub(hn::Set(d, 2.0), in_period), in_period);
  } else {
    wrapped = hn::IfThenElse(hn::Gt(u, one), one, u);
  }
  return hn::IfThenElseZero(hn::Ge(wrapped, zero), wrapped);
}

// A mip level in each lane.
template <class D>
struct MipLevelV {
  TexelIndex<D> width, height, first;
};

template <class D>
struct TapsV {
  TexelIndex<D> near, far;
  TexelFloat<D> weight;
};

template <class D, class V = hn::Vec<D>>
HWY_INLINE TapsV<D> FindTaps(D d, V wrapped, TexelIndex<D> size, Wrap wrap) {
  const TexelIndexTag<D> di;
  const TexelFloatTag<D> df;
  const auto zero = hn::Zero(di), one = hn::Set(di, 1);
  const auto last = hn::Sub(size, one);
  const V x = hn::Mul(wrapped, hn::PromoteTo(d, size));
  TapsV<D> taps;
  taps.near = hn::Min(hn::DemoteTo(di, x), last);
  const V offset = hn::Sub(hn::Sub(x, hn::PromoteTo(d, taps.near)), hn::Set(d, 0.5));
  taps.weight = hn::DemoteTo(df, hn::Abs(offset));
  // 1 or, below the middle of the texel, -1.
  const auto step = hn::DemoteTo(di, hn::CopySign(hn::Set(d, 1.0), offset));
  const auto far = hn::Add(taps.near, step);
  if (wrap == Wrap::kRepeat) {
    const auto wrapped_up = hn::IfThenElseZero(hn::Lt(far, size), far);
    taps.far = hn::IfThenElse(hn::Lt(far, zero), last, wrapped_up);
  } else {
    taps.far = hn::Min(hn::Max(far, zero), last);
  }
  return taps;
}

// The index of the first channel of a texel.
template <class D>
HWY_INLINE TexelIndex<D> TexelIndexAt(const MipLevelV<D>& level, TexelIndex<D> x, TexelIndex<D> y,
                                      TexelIndex<D> channels) {
  return hn::Add(level.first, hn::Mul(hn::Add(hn::Mul(y, level.width), x), channels));
}

// The four texels of a bilinear look-up and their weights, the same for all channels. A nearest
// look-up reads `near_near` only.
template <class D>
struct FootprintV {
  TexelIndex<D> near_near, far_near, near_far, far_far;  // along u, along v
  TexelFloat<D> weight_u, weight_v;
};

template <class D, class V = hn::Vec<D>>
HWY_INLINE FootprintV<D> FindFootprint(D d, const MipChain& image, const MipLevelV<D>& level,
                                       const SampleSettings& settings, V u, V v) {
  const TexelIndexTag<D> di;
  const auto channels = hn::Set(di, image.channels);
  const TapsV<D> x = FindTaps(d, u, level.width, settings.wrap_u);
  const TapsV<D> y = FindTaps(d, v, level.height, settings.wrap_v);
  return {TexelIndexAt<D>(level, x.near, y.near, channels),
          TexelIndexAt<D>(level, x.far, y.near, channels),
          TexelIndexAt<D>(level, x.near, y.far, channels),
          TexelIndexAt<D>(level, x.far, y.far, channels),
          x.weight,
          y.weight};
}

template <class D>
HWY_INLINE TexelFloat<D> BilinearChannel(D, const float* HWY_RESTRICT values,
                                         const FootprintV<D>& f) {
  const TexelFloatTag<D> df;
  const auto row = [&](TexelIndex<D> near, TexelIndex<D> far) HWY_ATTR {
    const auto a = hn::GatherIndex(df, values, near);
    return hn::MulAdd(f.weight_u, hn::Sub(hn::GatherIndex(df, values, far), a), a);
  };
  const auto near = row(f.near_near, f.far_near);
  return hn::MulAdd(f.weight_v, hn::Sub(row(f.near_far, f.far_far), near), near);
}

template <class D>
HWY_INLINE MipLevelV<D> WholeImage(D, const MipChain& image) {
  const TexelIndexTag<D> di;
  const MipLevel& l = image.levels[0];
  return {hn::Set(di, l.width), hn::Set(di, l.height), hn::Set(di, l.first)};
}

static_assert(sizeof(MipLevel) == 3 * sizeof(int32_t));

template <class D>
HWY_INLINE MipLevelV<D> MipLevelAt(D, const MipChain& image, TexelIndex<D> level) {
  const TexelIndexTag<D> di;
  const int32_t* const table = &image.levels[0].width;
  const auto at = hn::Add(hn::Add(level, level), level);
  const auto one = hn::Set(di, 1);
  return {hn::GatherIndex(di, table, at), hn::GatherIndex(di, table, hn::Add(at, one)),
          hn::GatherIndex(di, table, hn::Add(at, hn::Add(one, one)))};
}

// MipLevelOf for footprints in float. The logarithm has an error of 2e-7.
template <class D, class V = TexelFloat<D>>
HWY_INLINE V MipLevelOf(D, const MipChain& image, const TextureFootprint<V>& f) {
  const TexelFloatTag<D> df;
  const V w = hn::Set(df, static_cast<float>(image.levels[0].width));
  const V h = hn::Set(df, static_cast<float>(image.levels[0].height));
  const auto squared = [&](V du, V dv) HWY_ATTR {
    const V x = hn::Mul(du, w), y = hn::Mul(dv, h);
    return hn::MulAdd(x, x, hn::Mul(y, y));
  };
  const V a = squared(f.du_dx, f.dv_dx), b = squared(f.du_dy, f.dv_dy);
  // Clamped to 2^40, more than any image has texels. In this form NaN becomes that, too.
  const V most = hn::Set(df, 0x1p40f), one = hn::Set(df, 1.0f);
  const auto keep = [&](V x) HWY_ATTR { return hn::IfThenElse(hn::Lt(x, most), x, most); };
  const V longer = hn::Max(hn::Max(keep(a), keep(b)), one);
  const V last = hn::Set(df, static_cast<float>(image.levels.size() - 1));
  return hn::Min(hn::Mul(Log2(df, longer), hn::Set(df, 0.5f)), last);
}

// Calls store(channel, value) for the channels 0 .. count - 1. Channels that the image lacks are
// copies of its last one. (u, v) need not be wrapped; mip_level is used by trilinear look-ups only.
template <class D, class V = hn::Vec<D>, class Store>
HWY_INLINE void SampleImage(D d, const MipChain& image, const SampleSettings& settings,
                            TexelFloat<D> mip_level, V u, V v, int count, const Store& store) {
  const TexelFloatTag<D> df;
  const TexelIndexTag<D> di;
  const V wrapped_u = WrapCoordinate(d, u, settings.wrap_u);
  const V wrapped_v = WrapCoordinate(d, v, settings.wrap_v);
  const float* const values = image.values.data();
  const auto find = [&](const MipLevelV<D>& level) HWY_ATTR {
    return FindFootprint(d, image, level, settings, wrapped_u, wrapped_v);
  };
  const auto channel = [&](int c) {
    return values + (c < image.channels ? c : image.channels - 1);
  };
  if (settings.filter == TextureFilter::kNearest) {
    const FootprintV<D> at = find(WholeImage(d, image));
    for (int c = 0; c < count; ++c) store(c, hn::GatherIndex(df, channel(c), at.near_near));
  } else if (settings.filter == TextureFilter::kBilinear ||
             hn::AllTrue(df, hn::Le(mip_level, hn::Zero(df)))) {
    const FootprintV<D> at = find(WholeImage(d, image));
    for (int c = 0; c < count; ++c) store(c, BilinearChannel(d, channel(c), at));
  } else {
    const auto level = hn::ConvertTo(di, mip_level);
    const auto last = hn::Set(di, static_cast<int32_t>(image.levels.size()) - 1);
    const auto next = hn::Min(hn::Add(level, hn::Set(di, 1)), last);
    const FootprintV<D> near = find(MipLevelAt(d, image, level));
    const FootprintV<D> far = find(MipLevelAt(d, image, next));
    const auto t = hn::Sub(mip_level, hn::ConvertTo(df, level));
    for (int c = 0; c < count; ++c) {
      const auto a = BilinearChannel(d, channel(c), near);
      store(c, hn::MulAdd(t, hn::Sub(BilinearChannel(d, channel(c), far), a), a));
    }
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();
#endif
