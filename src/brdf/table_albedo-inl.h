// SPDX-License-Identifier: Apache-2.0
// brdf/table_albedo-inl.h: albedos of tabulated Fresnel curves on SIMD vectors of floats. Scalar
// twin: brdf/table_albedo.h.
#if defined(NACRE_BRDF_TABLE_ALBEDO_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_BRDF_TABLE_ALBEDO_INL_H_
#undef NACRE_BRDF_TABLE_ALBEDO_INL_H_
#else
#define NACRE_BRDF_TABLE_ALBEDO_INL_H_
#endif

#include "brdf/albedo-inl.h"
#include "brdf/anisotropic_albedo-inl.h"
#include "brdf/fresnel_table-inl.h"
#include "brdf/table_albedo.h"

HWY_BEFORE_NAMESPACE();
namespace nacre::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// What a mirror reflects along its normal direction at this cosine.
template <class D, class V = hn::Vec<D>>
HWY_INLINE Vec3V<V> TableReflectance(D d, const FresnelTable& table, V cosine) {
  const Vec3V<V> loss = FresnelTableLoss(d, table, cosine);
  const V one = hn::Set(d, 1.0f);
  return {hn::Sub(one, loss.x), hn::Sub(one, loss.y), hn::Sub(one, loss.z)};
}

// The albedos of lanes that share a fit.
template <class D, class V = hn::Vec<D>>
HWY_INLINE Vec3V<V> TableAlbedo(D d, const TableAlbedoFit& fit, const AlbedoFit& lobe,
                                const FresnelTable& table, V one, const AlbedoVariablesV<V>& x) {
  const Vec3V<V> mirror = TableReflectance(d, table, x.n_dot_v);
  return {AlbedoNearMirror(d, lobe, fit.wider[0], mirror.x, one, x),
          AlbedoNearMirror(d, lobe, fit.wider[1], mirror.y, one, x),
          AlbedoNearMirror(d, lobe, fit.wider[2], mirror.z, one, x)};
}

// The same of lanes with a roughness each, whose lobes are `lobe`. Their curves are blended lane by
// lane.
template <class D, class V = hn::Vec<D>>
HWY_INLINE Vec3V<V> TableAlbedo(D d, const TableAlbedoCurves& curves, const AlbedoFitLanes& lobe,
                                const FresnelTable& table, V one, const AlbedoVariablesV<V>& x) {
  constexpr size_t kMost = hn::MaxLanes(d);
  HWY_ALIGN float z[kMost], wider[3][kMost];
  hn::Store(x.z, d, z);
  for (size_t k = 0; k < hn::Lanes(d); ++k) {
    // Lanes beyond the hits hold anything.
    const float alpha = lobe.shape.offset[k] / kAlbedoOffsetOverAlpha;
    const bool is_hit = alpha >= 0 && alpha <= 1;
    const TableAlbedoFit fit = BlendTableAlbedo(curves, std::sqrt(is_hit ? double{alpha} : 0));
    for (size_t c = 0; c < 3; ++c)
      wider[c][k] = nacre::EvaluateAlbedoPolynomial(fit.wider[c], z[k]);
  }
  const Vec3V<V> mirror = TableReflectance(d, table, x.n_dot_v);
  const auto near_mirror = [&](V at_mirror, size_t c) HWY_ATTR {
    const V added = hn::Load(d, wider[c]);
    const V masked = HasMasking(lobe.shape) ? hn::Mul(added, x.factor) : added;
    const V albedo = hn::MulAdd(at_mirror, one, masked);
    return hn::Min(hn::Max(albedo, hn::Zero(d)), hn::Set(d, 1.0f));
  };
  return {near_mirror(mirror.x, 0), near_mirror(mirror.y, 1), near_mirror(mirror.z, 2)};
}

// The albedos of an anisotropic lobe.
template <class D, class Variables, class V = hn::Vec<D>>
HWY_INLINE Vec3V<V> TableAlbedo(D d, const std::array<AnisotropicFresnelCurve, 3>& fit,
                                const FresnelTable& table, V one, const Variables& x) {
  const Vec3V<V> mirror = TableReflectance(d, table, x.n_dot_x);
  return {AlbedoFresnel(d, fit[0], one, mirror.x, x), AlbedoFresnel(d, fit[1], one, mirror.y, x),
          AlbedoFresnel(d, fit[2], one, mirror.z, x)};
}

}  // namespace nacre::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
