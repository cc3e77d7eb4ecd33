// SPDX-License-Identifier: Apache-2.0
// bench/textbook_kernel.cc: the kernels behind textbook_kernel.h.
#include "textbook_kernel.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "textbook_kernel.cc"
#include "hwy/foreach_target.h"

#include "hwy/highway.h"

#include "brdf/fresnel-inl.h"
#include "brdf/ggx-inl.h"
#include "shading/packets-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {

// Its numbers are copies: nothing that a kernel stores is in them.
struct TextbookGgx {
  using Incident = IncidentV;
  TextbookGgxLight light;
  float alpha2, k, pi_over_alpha2;

  HWY_INLINE ReflectedV Reflect(FloatTag d, const PacketV& p, const IncidentV& in) const {
    const FloatV one = hn::Set(d, 1.0f);
    const FloatV smallest = hn::Set(d, 1e-30f);
    const FloatV n_dot_v = hn::Max(FusedDot(p.normal, p.to_view), hn::Zero(d));
    const Vec3V<FloatV> u = in.toward.Plus(p.to_view);
    const FloatV scale = ReciprocalSqrt(d, hn::Max(FusedDot(u, u), smallest));
    const Vec3V<FloatV> h = Scale(u, scale);
    const FloatV n_dot_h = FusedDot(p.normal, h);
    const FloatV q = hn::MulAdd(hn::Mul(n_dot_h, n_dot_h), hn::Set(d, alpha2 - 1), one);
    const FloatV masking = VisibilityDenominatorSchlick(d, in.n_dot_l, n_dot_v, hn::Set(d, k),
                                                        hn::Set(d, pi_over_alpha2));
    const FloatV denominator = hn::Max(hn::Mul(hn::Mul(q, q), masking), smallest);
    const FloatV lobe = hn::Mul(in.weight, Reciprocal(d, denominator));
    const FloatV weight = Power5(hn::Sub(one, FusedDot(p.to_view, h)));
    const RgbV fresnel = MulAdd3(SetRgb(d, light.rest), weight, SetRgb(d, light.f0));
    const FloatV left = hn::Mul(hn::Sub(one, weight), in.weight);
    return {{ScaledPart(SetRgb(d, light.diffuse), left)}, ScaledPart(fresnel, lobe)};
  }
};

// Term by term.
struct WrittenGgx {
  using Incident = IncidentV;
  TextbookGgxLight light;
  float alpha2, k;

  static HWY_INLINE FloatV OneOver(FloatTag d, FloatV x) { return hn::Div(hn::Set(d, 1.0f), x); }

  static HWY_INLINE Vec3V<FloatV> Normalize(FloatTag d, const Vec3V<FloatV>& v) {
    return Scale(v, OneOver(d, hn::Sqrt(FusedDot(v, v))));
  }

  HWY_INLINE FloatV Shadowing(FloatTag d, FloatV cosine) const {
    return hn::Div(cosine, hn::MulAdd(cosine, hn::Set(d, 1 - k), hn::Set(d, k)));
  }

  HWY_INLINE ReflectedV Reflect(FloatTag d, const PacketV& p, const IncidentV& in) const {
    const FloatV zero = hn::Zero(d), one = hn::Set(d, 1.0f);
    const Vec3V<FloatV>& offset = in.toward.offset;
    const Vec3V<FloatV> l = Normalize(d, offset), h = Normalize(d, Add(l, p.to_view));
    const FloatV n_dot_l = hn::Max(FusedDot(p.normal, l), zero);
    const FloatV n_dot_v = hn::Max(FusedDot(p.normal, p.to_view), zero);
    const FloatV n_dot_h = hn::Max(FusedDot(p.normal, h), zero);
    const FloatV v_dot_h = hn::Max(FusedDot(p.to_view, h), zero);
    const FloatV q = hn::MulAdd(hn::Mul(n_dot_h, n_dot_h), hn::Set(d, alpha2 - 1), one);
    const FloatV distribution =
        hn::Div(hn::Set(d, alpha2), hn::Mul(hn::Set(d, 3.14159265f), hn::Mul(q, q)));
    const FloatV shadowing = hn::Mul(Shadowing(d, n_dot_l), Shadowing(d, n_dot_v));
    const FloatV four = hn::Mul(hn::Set(d, 4.0f), hn::Mul(n_dot_l, n_dot_v));
    const FloatV specular =
        hn::Div(hn::Mul(distribution, shadowing), hn::Max(four, hn::Set(d, 1e-7f)));
    const FloatV weight = hn::Mul(n_dot_l, OneOver(d, FusedDot(offset, offset)));
    const FloatV power = Power5(hn::Sub(one, v_dot_h));
    const RgbV fresnel = MulAdd3(SetRgb(d, light.rest), power, SetRgb(d, light.f0));
    const FloatV left = hn::Mul(hn::Sub(one, power), weight);
    return {{ScaledPart(SetRgb(d, light.diffuse), left)},
            ScaledPart(fresnel, hn::Mul(specular, weight))};
  }
};

// Phong's cosine as it is written, and what rounding leaves of 1 - c.
HWY_NOINLINE void FillNaivePhong(const LitHits& lit, size_t begin, size_t end, LobeBlock* block) {
  const FloatTag d;
  ForEachLit(d, lit, begin, end, [&](const PacketV& p, const LightV& light) HWY_ATTR {
    const TowardV& toward = light.toward;
    const FloatV n_dot_l = toward.Dot(p.normal);
    block->Store(d, p.i - begin, light, n_dot_l);
    const FloatV n_dot_v = FusedDot(p.normal, p.to_view);
    const FloatV l_dot_v = hn::Mul(FusedDot(toward.offset, p.to_view), toward.inverse_length);
    const FloatV cosine = hn::MulSub(hn::Add(n_dot_l, n_dot_l), n_dot_v, l_dot_v);
    block->StoreLobe(d, p.i - begin, {hn::Sub(hn::Set(d, 1.0f), cosine), cosine});
  });
}

// Blinn's likewise.
HWY_NOINLINE void FillNaiveBlinnPhong(const LitHits& lit, size_t begin, size_t end,
                                      LobeBlock* block) {
  const FloatTag d;
  ForEachLit(d, lit, begin, end, [&](const PacketV& p, const LightV& light) HWY_ATTR {
    block->Store(d, p.i - begin, light, light.toward.Dot(p.normal));
    const Vec3V<FloatV> u = light.toward.Plus(p.to_view);
    const FloatV scale = ReciprocalSqrt(d, hn::Max(FusedDot(u, u), hn::Set(d, 1e-30f)));
    const FloatV cosine = hn::Mul(FusedDot(p.normal, u), scale);
    block->StoreLobe(d, p.i - begin, {hn::Sub(hn::Set(d, 1.0f), cosine), cosine});
  });
}

template <void (*kFill)(const LitHits&, size_t, size_t, LobeBlock*)>
struct NaiveLobe {
  using Incident = LobeIncidentV;
  const PhongUniforms<float>& uniforms;

  HWY_INLINE bool ReadsLobe() const { return true; }
  HWY_INLINE void FillLobe(const LitHits& lit, size_t begin, size_t end, LobeBlock* block) const {
    kFill(lit, begin, end, block);
  }
  HWY_INLINE ReflectedV Reflect(FloatTag d, const PacketV&, const Incident& in) const {
    const FloatV lobe = LobePower(d, in.log2_cosine, hn::Set(d, uniforms.constants.shininess));
    return {{ScaledPart(SetRgb(d, uniforms.light.diffuse), in.weight)},
            ScaledPart(SetRgb(d, uniforms.light.specular), hn::Mul(lobe, in.irradiance))};
  }
};

void ShadeTextbookGgxT(const TextbookGgxUniforms& uniforms, const LitHits& lit) {
  const float alpha2 = uniforms.alpha2;
  const TextbookGgx ggx{*uniforms.light, alpha2, uniforms.k, 3.14159265f / alpha2};
  ShadePackets(FloatTag(), ggx, lit);
}

void ShadeWrittenGgxT(const TextbookGgxUniforms& uniforms, const LitHits& lit) {
  ShadePackets(FloatTag(), WrittenGgx{*uniforms.light, uniforms.alpha2, uniforms.k}, lit);
}

void ShadeNaivePhongT(const PhongUniforms<float>& uniforms, const LitHits& lit) {
  ShadePackets(FloatTag(), NaiveLobe<FillNaivePhong>{uniforms}, lit);
}

void ShadeNaiveBlinnPhongT(const PhongUniforms<float>& uniforms, const LitHits& lit) {
  ShadePackets(FloatTag(), NaiveLobe<FillNaiveBlinnPhong>{uniforms}, lit);
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nacre {
HWY_EXPORT(ShadeTextbookGgxT);
HWY_EXPORT(ShadeWrittenGgxT);
HWY_EXPORT(ShadeNaivePhongT);
HWY_EXPORT(ShadeNaiveBlinnPhongT);

void ShadeTextbookGgx(const TextbookGgxUniforms& uniforms, const LitHits& lit) {
  HWY_DYNAMIC_DISPATCH(ShadeTextbookGgxT)(uniforms, lit);
}

void ShadeWrittenGgx(const TextbookGgxUniforms& uniforms, const LitHits& lit) {
  HWY_DYNAMIC_DISPATCH(ShadeWrittenGgxT)(uniforms, lit);
}

void ShadeNaivePhong(const PhongUniforms<float>& uniforms, const LitHits& lit) {
  HWY_DYNAMIC_DISPATCH(ShadeNaivePhongT)(uniforms, lit);
}

void ShadeNaiveBlinnPhong(const PhongUniforms<float>& uniforms, const LitHits& lit) {
  HWY_DYNAMIC_DISPATCH(ShadeNaiveBlinnPhongT)(uniforms, lit);
}
}  // namespace nacre
#endif
