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
namespace nacre::HWY_NAMESPACE {
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

// FloatTexels, ByteTexels and WordTexels read a level whose values are of one kind. Find takes the
// index of a texel's first channel; Value decodes a channel from the result of Find.
template <class D>
struct FloatTexels {
  const float* values;

  HWY_INLINE TexelIndex<D> Find(TexelIndex<D> at) const { return at; }
  HWY_INLINE TexelFloat<D> Value(TexelIndex<D> found, int channel) const {
    return hn::GatherIndex(TexelFloatTag<D>(), values + channel, found);
  }
};

// Find gathers the codes of all channels at once.
template <class D>
struct ByteTexels {
  const int32_t* codes;
  const float* table;

  HWY_INLINE TexelIndex<D> Find(TexelIndex<D> at) const {
    return hn::GatherOffset(TexelIndexTag<D>(), codes, at);
  }
  HWY_INLINE TexelFloat<D> Value(TexelIndex<D> found, int channel) const {
    const auto code =
        hn::And(hn::ShiftRightSame(found, 8 * channel), hn::Set(TexelIndexTag<D>(), 0xff));
    return hn::GatherIndex(TexelFloatTag<D>(), table, code);
  }
};

template <class D>
struct WordTexels {
  const int32_t* codes;
  const float* table;

  HWY_INLINE TexelIndex<D> Find(TexelIndex<D> at) const { return hn::Add(at, at); }
  HWY_INLINE TexelFloat<D> Value(TexelIndex<D> found, int channel) const {
    const TexelIndexTag<D> di;
    const auto word = hn::GatherOffset(di, codes, hn::Add(found, hn::Set(di, 2 * channel)));
    return hn::GatherIndex(TexelFloatTag<D>(), table, hn::And(word, hn::Set(di, 0xffff)));
  }
};

template <class D, class Use>
HWY_INLINE void WithTexels(D, const TexelView& level, const Use& use) {
  if (level.kind == TexelKind::kBytes) {
    use(ByteTexels<D>{static_cast<const int32_t*>(level.data), level.table});
  } else if (level.kind == TexelKind::kWords) {
    use(WordTexels<D>{static_cast<const int32_t*>(level.data), level.table});
  } else {
    use(FloatTexels<D>{static_cast<const float*>(level.data)});
  }
}

// The four texels of a bilinear look-up, as indices or as results of Find, and their weights, which
// are the same for all channels. A nearest look-up reads `near_near` only.
template <class D>
struct FootprintV {
  TexelIndex<D> near_near, far_near, near_far, far_far;  // along u, along v
  TexelFloat<D> weight_u, weight_v;
};

template <class D, class V = hn::Vec<D>>
HWY_INLINE FootprintV<D> FindFootprint(D d, const TexelView& level, const SampleSettings& settings,
                                       V u, V v) {
  const TexelIndexTag<D> di;
  const auto width = hn::Set(di, level.width), channels = hn::Set(di, level.channels);
  const TapsV<D> x = FindTaps(d, u, width, settings.wrap_u);
  const TapsV<D> y = FindTaps(d, v, hn::Set(di, level.height), settings.wrap_v);
  const auto index = [&](TexelIndex<D> column, TexelIndex<D> row) HWY_ATTR {
    return hn::Mul(hn::Add(hn::Mul(row, width), column), channels);
  };
  return {index(x.near, y.near),
          index(x.far, y.near),
          index(x.near, y.far),
          index(x.far, y.far),
          x.weight,
          y.weight};
}

template <class D, class Texels>
HWY_INLINE FootprintV<D> FindTexels(D, const Texels& texels, const FootprintV<D>& at) {
  return {texels.Find(at.near_near),
          texels.Find(at.far_near),
          texels.Find(at.near_far),
          texels.Find(at.far_far),
          at.weight_u,
          at.weight_v};
}

template <class D, class Texels>
HWY_INLINE TexelFloat<D> BilinearChannel(D, const Texels& texels, const FootprintV<D>& found,
                                         int channel) {
  const auto row = [&](TexelIndex<D> near, TexelIndex<D> far) HWY_ATTR {
    const auto a = texels.Value(near, channel);
    return hn::MulAdd(found.weight_u, hn::Sub(texels.Value(far, channel), a), a);
  };
  const auto near = row(found.near_near, found.far_near);
  return hn::MulAdd(found.weight_v, hn::Sub(row(found.near_far, found.far_far), near), near);
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
  // Clamped to 2^40, more than any image has texels. This form turns NaN into 2^40, too.
  const V most = hn::Set(df, 0x1p40f), one = hn::Set(df, 1.0f);
  const auto keep = [&](V x) HWY_ATTR { return hn::IfThenElse(hn::Lt(x, most), x, most); };
  const V longer = hn::Max(hn::Max(keep(a), keep(b)), one);
  const V last = hn::Set(df, static_cast<float>(image.levels.size() - 1));
  return hn::Min(hn::Mul(Log2(df, longer), hn::Set(df, 0.5f)), last);
}

// Calls store(channel, value, lanes) for the channels 0 .. channels - 1, with masks that together
// hold each of the first `count` lanes once. Channels that the image lacks are copies of its last
// one. (u, v) need not be wrapped; mip_level is 0 unless the look-up is trilinear.
template <class D, class V = hn::Vec<D>, class Store>
HWY_INLINE void SampleImage(D d, const MipChain& image, const SampleSettings& settings,
                            TexelFloat<D> mip_level, V u, V v, size_t count, int channels,
                            const Store& store) {
  const TexelFloatTag<D> df;
  const TexelIndexTag<D> di;
  const V wrapped_u = WrapCoordinate(d, u, settings.wrap_u);
  const V wrapped_v = WrapCoordinate(d, v, settings.wrap_v);
  const auto find = [&](const TexelView& level) HWY_ATTR {
    return FindFootprint(d, level, settings, wrapped_u, wrapped_v);
  };
  const auto channel = [&](int c) { return c < image.channels ? c : image.channels - 1; };
  // Lanes at the same level are looked up together: levels differ in kind, and those that no lane
  // needs are not made.
  const int32_t last = static_cast<int32_t>(image.levels.size()) - 1;
  const auto done = hn::Set(di, last + 1);
  auto left = hn::IfThenElse(hn::FirstN(di, count), hn::ConvertTo(di, mip_level), done);
  for (int32_t number; (number = hn::GetLane(hn::MinOfLanes(di, left))) <= last;) {
    const auto is_here = hn::Eq(left, hn::Set(di, number));
    left = hn::IfThenElse(is_here, done, left);
    const auto lanes = hn::RebindMask(df, is_here);
    const auto t = hn::Sub(mip_level, hn::Set(df, static_cast<float>(number)));
    const bool between = !hn::AllFalse(df, hn::And(lanes, hn::Gt(t, hn::Zero(df))));
    const TexelView level = image.Level(static_cast<size_t>(number));
    const FootprintV<D> at = find(level);
    WithTexels(d, level, [&](const auto& texels) HWY_ATTR {
      if (settings.filter == TextureFilter::kNearest) {
        const auto found = texels.Find(at.near_near);
        for (int c = 0; c < channels; ++c) store(c, texels.Value(found, channel(c)), lanes);
        return;
      }
      const FootprintV<D> near = FindTexels(d, texels, at);
      if (!between) {
        for (int c = 0; c < channels; ++c) {
          store(c, BilinearChannel(d, texels, near, channel(c)), lanes);
        }
        return;
      }
      const TexelView next = image.Level(static_cast<size_t>(number) + 1);
      const FloatTexels<D> next_texels{static_cast<const float*>(next.data)};
      const FootprintV<D> far = find(next);
      for (int c = 0; c < channels; ++c) {
        const auto a = BilinearChannel(d, texels, near, channel(c));
        const auto b = BilinearChannel(d, next_texels, far, channel(c));
        store(c, hn::MulAdd(t, hn::Sub(b, a), a), lanes);
      }
    });
  }
}

}  // namespace nacre::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
