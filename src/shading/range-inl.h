// shading/range-inl.h: what all shading kernels share: the loop over a range of hits, loading a
// hit's vectors and adding to its radiance.
#if defined(NACRE_SHADING_RANGE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_SHADING_RANGE_INL_H_
#undef NACRE_SHADING_RANGE_INL_H_
#else
#define NACRE_SHADING_RANGE_INL_H_
#endif

#include "brdf/angles-inl.h"
#include "shading/kernels.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using FloatTag = hn::ScalableTag<float>;
using FloatV = hn::Vec<FloatTag>;

// A packet of hits and the light on it.
struct LitPacket {
  Vec3V<FloatV> normal, to_view, to_light;
  FloatV irradiance;
};

struct RgbV {
  FloatV r, g, b;
};

HWY_INLINE RgbV SetRgb(FloatTag d, const float (&rgb)[3]) {
  return {hn::Set(d, rgb[0]), hn::Set(d, rgb[1]), hn::Set(d, rgb[2])};
}

HWY_INLINE RgbV SetRgb(FloatTag d, const Rgb& rgb) {
  return {hn::Set(d, static_cast<float>(rgb.x)), hn::Set(d, static_cast<float>(rgb.y)),
          hn::Set(d, static_cast<float>(rgb.z))};
}

HWY_INLINE RgbV LoadRgb(FloatTag d, const Soa3<float>& soa, size_t i) {
  return {hn::LoadU(d, soa.x.data() + i), hn::LoadU(d, soa.y.data() + i),
          hn::LoadU(d, soa.z.data() + i)};
}

HWY_INLINE RgbV ScaleRgb(const RgbV& color, FloatV s) {
  return {hn::Mul(color.r, s), hn::Mul(color.g, s), hn::Mul(color.b, s)};
}

// Adds `value` in the lanes that belong to the range. The sum is an Add of its own, never fused
// with the product before it: a light then adds the same bits whether it is summed with the
// others or kept apart in a layer.
HWY_INLINE void Accumulate(FloatTag d, hn::Mask<FloatTag> mask, const RgbV& value, size_t i,
                           Soa3<float>* sum) {
  const auto add = [&](FloatV v, float* to) HWY_ATTR {
    hn::StoreU(hn::Add(hn::LoadU(d, to), hn::IfThenElseZero(mask, v)), d, to);
  };
  add(value.r, sum->x.data() + i);
  add(value.g, sum->y.data() + i);
  add(value.b, sum->z.data() + i);
}

// Calls shade(packet, i, mask) for each packet of the range. Arrays are padded to whole vectors
// and ranges of a batch follow one another, so a packet may reach past its range: `mask` holds
// the lanes that belong to it.
template <class Shade>
HWY_INLINE void ForEachPacket(FloatTag d, const ShadeRange& range, const Shade& shade) {
  const Soa3<float>& n = range.surface.normal;
  const Soa3<float>& v = range.surface.to_view;
  const Soa3<float>& l = range.light.to_light;
  for (size_t i = range.begin; i < range.end; i += hn::Lanes(d)) {
    const LitPacket packet{LoadU3(d, n.x.data() + i, n.y.data() + i, n.z.data() + i),
                           LoadU3(d, v.x.data() + i, v.y.data() + i, v.z.data() + i),
                           LoadU3(d, l.x.data() + i, l.y.data() + i, l.z.data() + i),
                           hn::LoadU(d, range.light.irradiance.data() + i)};
    shade(packet, i, hn::FirstN(d, range.end - i));
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();
#endif
