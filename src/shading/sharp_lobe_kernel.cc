// SPDX-License-Identifier: Apache-2.0
// shading/sharp_lobe_kernel.cc: the half-vector terms of sharp lobes, in double: float directions
// have a resolution of 6e-8 rad, which is visible in a highlight 1e-4 rad wide.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shading/sharp_lobe_kernel.cc"
#include "hwy/foreach_target.h"

#include "hwy/highway.h"

#include "brdf/ggx-inl.h"
#include "brdf/phong-inl.h"
#include "shading/kernels.h"
#include "shading/soa-inl.h"

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

// Calls form(directions, i) for each packet of the range. Arrays are padded, and entries that a
// packet writes past the end of its run are not used.
template <class Form>
HWY_INLINE void ForEachHit(const ShadeRange& range, const Form& form) {
  const DoubleTag d;
  const ShadingLight& light = range.light;
  const bool far = light.form == LightForm::kDirectional;
  const Vec3d& from = far ? light.to_light : light.position;
  const Vec3V<DoubleV> origin{hn::Set(d, from.x), hn::Set(d, from.y), hn::Set(d, from.z)};
  const DoubleV one = hn::Set(d, 1.0);
  const auto offset_at = [&](size_t i) HWY_ATTR {
    // A direction that was sampled in float is exact as it is.
    if (light.form == LightForm::kGiven) {
      return PromoteSoa(d, range.on_hits->to_light, i);
    }
    return far ? origin : Sub(origin, LoadSoa(d, range.hits.position, i));
  };
  for (size_t i = range.begin; i < range.end; i += hn::Lanes(d)) {
    const Vec3V<DoubleV> offset = offset_at(i);
    const DoubleV squared = FusedDot(offset, offset);
    const DoubleV distance = hn::Sqrt(squared);
    // A light exactly at the hit has no direction, and no irradiance.
    const auto apart = hn::Gt(squared, hn::Zero(d));
    const DoubleV scale = hn::Div(one, hn::IfThenElse(apart, distance, one));
    form(Directions{LoadSoa(d, range.hits.normal, i), Scale(offset, scale),
                    LoadSoa(d, range.hits.to_view, i)},
         i);
  }
}

void FormSharpGgxT(double alpha, const ShadeRange& range, SharpLobeTerms* terms) {
  const DoubleTag d;
  const DoubleV alpha_v = hn::Set(d, alpha);
  ForEachHit(range, [&](const Directions& at, size_t i) HWY_ATTR {
    const AnglesV<DoubleV> angles = ComputeAngles(d, at.normal, at.to_light, at.to_view);
    StoreRounded(d, GgxDistribution(d, angles, alpha_v), terms->distribution.data() + i);
  });
}

void FormSharpGgxMapsT(const double* alphas, const ShadeRange& range, SharpLobeTerms* terms) {
  const DoubleTag d;
  const DoubleV zero = hn::Zero(d);
  ForEachHit(range, [&](const Directions& at, size_t i) HWY_ATTR {
    const DoubleV alpha = hn::LoadU(d, alphas + i);
    const AnglesV<DoubleV> angles = ComputeAngles(d, at.normal, at.to_light, at.to_view);
    const DoubleV distribution = GgxDistribution(d, angles, hn::Max(alpha, zero));
    StoreRounded(d, hn::IfThenElse(hn::Ge(alpha, zero), distribution, hn::Set(d, -1.0)),
                 terms->distribution.data() + i);
  });
}

HWY_INLINE LobeCosineV<DoubleV> CosineAt(PhongModel model, const Directions& at) {
  const DoubleTag d;
  if (model == PhongModel::kBlinnPhong) {
    return BlinnSquaredCosine(d, ComputeAngles(d, at.normal, at.to_light, at.to_view));
  }
  return PhongCosine(d, SquaredFromReflection(at.normal, at.to_light, at.to_view));
}

void FormSharpPhongMapsT(PhongModel model, const double* exponents, const ShadeRange& range,
                         SharpLobeTerms* terms) {
  const DoubleTag d;
  ForEachHit(range, [&](const Directions& at, size_t i) HWY_ATTR {
    const LobeCosineV<DoubleV> cosine = CosineAt(model, at);
    const auto sharp =
        hn::Gt(hn::LoadU(d, exponents + i), hn::Set(d, double{kDoubleTermsShininess}));
    StoreRounded(d, hn::IfThenElse(sharp, cosine.one_minus_c, hn::Set(d, -1.0)),
                 terms->one_minus_cos.data() + i);
    StoreRounded(d, cosine.c, terms->cos.data() + i);
  });
}

void FormSharpPhongT(PhongModel model, const ShadeRange& range, SharpLobeTerms* terms) {
  const DoubleTag d;
  ForEachHit(range, [&](const Directions& at, size_t i) HWY_ATTR {
    const LobeCosineV<DoubleV> cosine = CosineAt(model, at);
    StoreRounded(d, cosine.one_minus_c, terms->one_minus_cos.data() + i);
    StoreRounded(d, cosine.c, terms->cos.data() + i);
  });
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nacre {
HWY_EXPORT(FormSharpGgxT);
HWY_EXPORT(FormSharpPhongT);
HWY_EXPORT(FormSharpGgxMapsT);
HWY_EXPORT(FormSharpPhongMapsT);

void FormSharpGgx(double alpha, const ShadeRange& range, SharpLobeTerms* terms) {
  HWY_DYNAMIC_DISPATCH(FormSharpGgxT)(alpha, range, terms);
}

void FormSharpPhong(PhongModel model, const ShadeRange& range, SharpLobeTerms* terms) {
  HWY_DYNAMIC_DISPATCH(FormSharpPhongT)(model, range, terms);
}

void FormSharpGgx(const double* alphas, const ShadeRange& range, SharpLobeTerms* terms) {
  HWY_DYNAMIC_DISPATCH(FormSharpGgxMapsT)(alphas, range, terms);
}

void FormSharpPhong(PhongModel model, const double* exponents, const ShadeRange& range,
                    SharpLobeTerms* terms) {
  HWY_DYNAMIC_DISPATCH(FormSharpPhongMapsT)(model, exponents, range, terms);
}
}  // namespace nacre
#endif
