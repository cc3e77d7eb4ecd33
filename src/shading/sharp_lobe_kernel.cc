// SPDX-License-Identifier: Apache-2.0
// shading/sharp_lobe_kernel.cc: the half-vector terms of sharp lobes, in double: float directions
// have a resolution of 6e-8 rad, which is visible in a highlight 1e-4 rad wide.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shading/sharp_lobe_kernel.cc"
#include "hwy/foreach_target.h"

#include "hwy/highway.h"

#include "brdf/ggx-inl.h"
#include "brdf/ggx_anisotropic-inl.h"
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
HWY_INLINE void ForEachHit(const LitHits& lit, const Form& form) {
  const DoubleTag d;
  const ShadingLight& light = lit.light;
  const bool far = light.form == LightForm::kDirectional;
  const Vec3d& from = far ? light.to_light : light.position;
  const Vec3V<DoubleV> origin{hn::Set(d, from.x), hn::Set(d, from.y), hn::Set(d, from.z)};
  const DoubleV one = hn::Set(d, 1.0);
  const auto offset_at = [&](size_t i) HWY_ATTR {
    // A direction that was sampled in float is exact as it is.
    if (light.form == LightForm::kGiven) {
      return PromoteSoa(d, lit.on_hits->light_vector, i);
    }
    return far ? origin : Sub(origin, LoadSoa(d, lit.hits.position, i));
  };
  for (size_t i = lit.begin; i < lit.end; i += hn::Lanes(d)) {
    const Vec3V<DoubleV> offset = offset_at(i);
    const DoubleV squared = FusedDot(offset, offset);
    const DoubleV distance = hn::Sqrt(squared);
    // A light exactly at the hit has no direction, and no irradiance.
    const auto apart = hn::Gt(squared, hn::Zero(d));
    const DoubleV scale = hn::Div(one, hn::IfThenElse(apart, distance, one));
    form(Directions{LoadSoa(d, lit.hits.normal, i), Scale(offset, scale),
                    LoadSoa(d, lit.hits.to_view, i)},
         i);
  }
}

// A number that all hits share, or the numbers of hits i...
HWY_INLINE DoubleV NumberAt(double number, size_t) { return hn::Set(DoubleTag(), number); }
HWY_INLINE DoubleV NumberAt(const double* numbers, size_t i) {
  return hn::LoadU(DoubleTag(), numbers + i);
}

template <class Number>
void FormSharpGgxOf(Number alphas, const LitHits& lit, SharpLobeTerms* terms) {
  const DoubleTag d;
  const DoubleV zero = hn::Zero(d);
  ForEachHit(lit, [&](const Directions& at, size_t i) HWY_ATTR {
    const DoubleV alpha = NumberAt(alphas, i);
    const AnglesV<DoubleV> angles = ComputeAngles(d, at.normal, at.to_light, at.to_view);
    const DoubleV distribution = GgxDistribution(d, angles, hn::Max(alpha, zero));
    StoreRounded(d, hn::IfThenElse(hn::Ge(alpha, zero), distribution, hn::Set(d, -1.0)),
                 terms->distribution.data() + i);
  });
}
// The alphas of hits i...
HWY_INLINE GgxAlphasV<DoubleV> AlphasAt(const AnisotropicLobes& lobes, size_t i) {
  const DoubleTag d;
  if (lobes.stride == 0) {
    const GgxAlphas<double>& alpha = lobes.first->alpha;
    return MakeGgxAlphas(d, hn::Set(d, alpha.x), hn::Set(d, alpha.y));
  }
  HWY_ALIGN double x[hn::MaxLanes(d)], y[hn::MaxLanes(d)];
  for (size_t k = 0; k < hn::Lanes(d); ++k) {
    x[k] = lobes.At(i + k).alpha.x;
    y[k] = lobes.At(i + k).alpha.y;
  }
  return MakeGgxAlphas(d, hn::Load(d, x), hn::Load(d, y));
}

// Streaks are far narrower than float's directions resolve, and there is no limit of roughness from
// which on they would not be: all anisotropic lobes are computed in double.
void FormAnisotropicGgxT(const AnisotropicLobes& lobes, const LitHits& lit, SharpLobeTerms* terms) {
  const DoubleTag d;
  ForEachHit(lit, [&](const Directions& at, size_t i) HWY_ATTR {
    const BasisV<DoubleV> frame = LobeFrame(d, at.normal, PromoteSoa(d, lit.surface.tangent, i));
    const GgxAlphasV<DoubleV> alpha = AlphasAt(lobes, i);
    const FrameAnglesV<DoubleV> a = ComputeAngles(d, frame, at.to_light, at.to_view);
    StoreRounded(d, GgxDistribution(d, a, alpha), terms->distribution.data() + i);
    StoreRounded(d, SmithRootOfLight(d, a, alpha), terms->light_root.data() + i);
    StoreRounded(d, SmithRootOfView(d, a, alpha), terms->view_root.data() + i);
    StoreRounded(d, a.t_dot_l, terms->t_dot_l.data() + i);
    StoreRounded(d, a.b_dot_l, terms->b_dot_l.data() + i);
  });
}

constexpr auto& FormSharpGgxT = FormSharpGgxOf<double>;
constexpr auto& FormSharpGgxMapsT = FormSharpGgxOf<const double*>;

HWY_INLINE LobeCosineV<DoubleV> CosineAt(PhongModel model, const Directions& at) {
  const DoubleTag d;
  if (model == PhongModel::kBlinnPhong) {
    return BlinnSquaredCosine(d, ComputeAngles(d, at.normal, at.to_light, at.to_view));
  }
  return PhongCosine(d, SquaredFromReflection(at.normal, at.to_light, at.to_view));
}

template <class Number>
void FormSharpPhongOf(PhongModel model, Number exponents, const LitHits& lit,
                      SharpLobeTerms* terms) {
  const DoubleTag d;
  ForEachHit(lit, [&](const Directions& at, size_t i) HWY_ATTR {
    const LobeCosineV<DoubleV> cosine = CosineAt(model, at);
    const auto sharp = hn::Gt(NumberAt(exponents, i), hn::Set(d, double{kDoubleTermsShininess}));
    StoreRounded(d, hn::IfThenElse(sharp, cosine.one_minus_c, hn::Set(d, -1.0)),
                 terms->one_minus_cos.data() + i);
    StoreRounded(d, cosine.c, terms->cos.data() + i);
  });
}
constexpr auto& FormSharpPhongT = FormSharpPhongOf<double>;
constexpr auto& FormSharpPhongMapsT = FormSharpPhongOf<const double*>;

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nacre {
HWY_EXPORT(FormSharpGgxT);
HWY_EXPORT(FormSharpGgxMapsT);
HWY_EXPORT(FormAnisotropicGgxT);
HWY_EXPORT(FormSharpPhongT);
HWY_EXPORT(FormSharpPhongMapsT);

void FormSharpGgx(double alpha, const LitHits& lit, SharpLobeTerms* terms) {
  HWY_DYNAMIC_DISPATCH(FormSharpGgxT)(alpha, lit, terms);
}

void FormSharpGgx(const double* alphas, const LitHits& lit, SharpLobeTerms* terms) {
  HWY_DYNAMIC_DISPATCH(FormSharpGgxMapsT)(alphas, lit, terms);
}

void FormAnisotropicGgx(const AnisotropicLobes& lobes, const LitHits& lit, SharpLobeTerms* terms) {
  HWY_DYNAMIC_DISPATCH(FormAnisotropicGgxT)(lobes, lit, terms);
}

void FormSharpPhong(PhongModel model, double exponent, const LitHits& lit, SharpLobeTerms* terms) {
  HWY_DYNAMIC_DISPATCH(FormSharpPhongT)(model, exponent, lit, terms);
}

void FormSharpPhong(PhongModel model, const double* exponents, const LitHits& lit,
                    SharpLobeTerms* terms) {
  HWY_DYNAMIC_DISPATCH(FormSharpPhongMapsT)(model, exponents, lit, terms);
}
}  // namespace nacre
#endif
