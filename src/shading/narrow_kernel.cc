// SPDX-License-Identifier: Apache-2.0
// shading/narrow_kernel.cc: the half-vector terms of narrow lobes, in double: float directions
// are 6e-8 rad coarse, and a highlight 1e-4 rad wide shows it.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shading/narrow_kernel.cc"
#include "hwy/foreach_target.h"

#include "hwy/highway.h"

#include "brdf/ggx-inl.h"
#include "brdf/phong-inl.h"
#include "shading/kernels.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using DoubleTag = hn::ScalableTag<double>;
using DoubleV = hn::Vec<DoubleTag>;
using HalfFloatTag = hn::Rebind<float, DoubleTag>;  // as many floats as a vector has doubles

struct Directions {
  Vec3V<DoubleV> normal, to_light, to_view;
};

HWY_INLINE void StoreRounded(DoubleTag, DoubleV value, float* to) {
  const HalfFloatTag df;
  hn::StoreU(hn::DemoteTo(df, value), df, to);
}

// A direction that was chosen in float is that direction, to the last digit.
HWY_INLINE Vec3V<DoubleV> PromoteGiven(const LightOnBatch& light, size_t i) {
  const DoubleTag d;
  const HalfFloatTag df;
  const Soa3<float>& l = light.evaluated->to_light;
  return {hn::PromoteTo(d, hn::LoadU(df, l.x.data() + i)),
          hn::PromoteTo(d, hn::LoadU(df, l.y.data() + i)),
          hn::PromoteTo(d, hn::LoadU(df, l.z.data() + i))};
}

// Calls form(directions, i) for each packet of the range. Arrays are padded, and what a packet
// writes past the end of its run is scratch.
template <class Form>
HWY_INLINE void ForEachHit(const ShadeRange& range, const Form& form) {
  const DoubleTag d;
  const auto load = [&](const Soa3<double>& soa, size_t i) HWY_ATTR {
    return LoadU3(d, soa.x.data() + i, soa.y.data() + i, soa.z.data() + i);
  };
  const ShadingLight& light = *range.lights[0].light;
  const bool far = light.form == LightForm::kDirectional;
  const Vec3d& from = far ? light.to_light : light.position;
  const Vec3V<DoubleV> origin{hn::Set(d, from.x), hn::Set(d, from.y), hn::Set(d, from.z)};
  const DoubleV one = hn::Set(d, 1.0);
  const auto offset_at = [&](size_t i) HWY_ATTR {
    if (light.form == LightForm::kGiven) return PromoteGiven(range.lights[0], i);
    return far ? origin : Sub(origin, load(range.hits.position, i));
  };
  for (size_t i = range.begin; i < range.end; i += hn::Lanes(d)) {
    const Vec3V<DoubleV> offset = offset_at(i);
    const DoubleV squared = FusedDot(offset, offset);
    const DoubleV distance = hn::Sqrt(squared);
    // A light exactly at the hit has no direction, and no irradiance.
    const auto apart = hn::Gt(squared, hn::Zero(d));
    const DoubleV scale = hn::Div(one, hn::IfThenElse(apart, distance, one));
    form(Directions{load(range.hits.normal, i), Scale(offset, scale), load(range.hits.to_view, i)},
         i);
  }
}

void NarrowGgxT(double alpha, const ShadeRange& range, NarrowLobes* lobes) {
  const DoubleTag d;
  const DoubleV alpha_v = hn::Set(d, alpha);
  ForEachHit(range, [&](const Directions& at, size_t i) HWY_ATTR {
    const AnglesV<DoubleV> angles = ComputeAngles(d, at.normal, at.to_light, at.to_view);
    StoreRounded(d, GgxDistribution(d, angles, alpha_v), lobes->first.data() + i);
  });
}

void NarrowGgxMapsT(const double* alphas, const ShadeRange& range, NarrowLobes* lobes) {
  const DoubleTag d;
  const DoubleV zero = hn::Zero(d);
  ForEachHit(range, [&](const Directions& at, size_t i) HWY_ATTR {
    const DoubleV alpha = hn::LoadU(d, alphas + i);
    const AnglesV<DoubleV> angles = ComputeAngles(d, at.normal, at.to_light, at.to_view);
    const DoubleV distribution = GgxDistribution(d, angles, hn::Max(alpha, zero));
    StoreRounded(d, hn::IfThenElse(hn::Ge(alpha, zero), distribution, hn::Set(d, -1.0)),
                 lobes->first.data() + i);
  });
}

HWY_INLINE LobeCosineV<DoubleV> CosineAt(PhongModel model, const Directions& at) {
  const DoubleTag d;
  if (model == PhongModel::kBlinnPhong) {
    return BlinnSquaredCosine(d, ComputeAngles(d, at.normal, at.to_light, at.to_view));
  }
  return PhongCosine(d, SquaredFromReflection(at.normal, at.to_light, at.to_view));
}

void NarrowPhongMapsT(PhongModel model, const double* exponents, const ShadeRange& range,
                      NarrowLobes* lobes) {
  const DoubleTag d;
  ForEachHit(range, [&](const Directions& at, size_t i) HWY_ATTR {
    const LobeCosineV<DoubleV> cosine = CosineAt(model, at);
    const auto narrow =
        hn::Gt(hn::LoadU(d, exponents + i), hn::Set(d, double{kDoubleTermsShininess}));
    StoreRounded(d, hn::IfThenElse(narrow, cosine.one_minus_c, hn::Set(d, -1.0)),
                 lobes->first.data() + i);
    StoreRounded(d, cosine.c, lobes->second.data() + i);
  });
}

void NarrowPhongT(PhongModel model, const ShadeRange& range, NarrowLobes* lobes) {
  const DoubleTag d;
  ForEachHit(range, [&](const Directions& at, size_t i) HWY_ATTR {
    const LobeCosineV<DoubleV> cosine = CosineAt(model, at);
    StoreRounded(d, cosine.one_minus_c, lobes->first.data() + i);
    StoreRounded(d, cosine.c, lobes->second.data() + i);
  });
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nacre {
HWY_EXPORT(NarrowGgxT);
HWY_EXPORT(NarrowPhongT);
HWY_EXPORT(NarrowGgxMapsT);
HWY_EXPORT(NarrowPhongMapsT);

void NarrowGgx(double alpha, const ShadeRange& range, NarrowLobes* lobes) {
  HWY_DYNAMIC_DISPATCH(NarrowGgxT)(alpha, range, lobes);
}

void NarrowPhong(PhongModel model, const ShadeRange& range, NarrowLobes* lobes) {
  HWY_DYNAMIC_DISPATCH(NarrowPhongT)(model, range, lobes);
}

void NarrowGgx(const double* alphas, const ShadeRange& range, NarrowLobes* lobes) {
  HWY_DYNAMIC_DISPATCH(NarrowGgxMapsT)(alphas, range, lobes);
}

void NarrowPhong(PhongModel model, const double* exponents, const ShadeRange& range,
                 NarrowLobes* lobes) {
  HWY_DYNAMIC_DISPATCH(NarrowPhongMapsT)(model, exponents, range, lobes);
}
}  // namespace nacre
#endif
