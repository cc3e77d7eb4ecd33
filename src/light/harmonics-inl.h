// SPDX-License-Identifier: Apache-2.0
// light/harmonics-inl.h: irradiance from spherical harmonics on SIMD vectors. Scalar twin:
// harmonics.h.
#if defined(NACRE_LIGHT_HARMONICS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_LIGHT_HARMONICS_INL_H_
#undef NACRE_LIGHT_HARMONICS_INL_H_
#else
#define NACRE_LIGHT_HARMONICS_INL_H_
#endif

#include "base/vec3-inl.h"
#include "light/harmonics.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <class V>
using HarmonicBasisV = std::array<V, kHarmonics>;

template <class D, class V = hn::Vec<D>>
HWY_INLINE HarmonicBasisV<V> EvaluateHarmonics(D d, const Vec3V<V>& n) {
  const V k1 = hn::Set(d, 0.488602512f), k2 = hn::Set(d, 1.09254843f);
  const V k20 = hn::Set(d, 0.315391565f), three_k20 = hn::Set(d, 3 * 0.315391565f);
  const V k2_x = hn::Mul(k2, n.x), k2_y = hn::Mul(k2, n.y);
  const V half_k2 = hn::Set(d, 0.546274215f);
  return {hn::Set(d, 0.282094792f),
          hn::Mul(k1, n.y),
          hn::Mul(k1, n.z),
          hn::Mul(k1, n.x),
          hn::Mul(k2_x, n.y),
          hn::Mul(k2_y, n.z),
          hn::MulSub(three_k20, hn::Mul(n.z, n.z), k20),
          hn::Mul(k2_x, n.z),
          hn::Mul(half_k2, hn::Mul(hn::Sub(n.x, n.y), hn::Add(n.x, n.y)))};
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE Vec3V<V> Irradiance(D d, const IrradianceHarmonics<float>& harmonics,
                               const Vec3V<V>& normal) {
  const V zero = hn::Zero(d);
  const HarmonicBasisV<V> basis = EvaluateHarmonics(d, normal);
  Vec3V<V> sum{zero, zero, zero};
  for (size_t i = 0; i < kHarmonics; ++i) {
    const Imath::Vec3<float>& c = harmonics.coefficients[i];
    sum = {hn::MulAdd(basis[i], hn::Set(d, c.x), sum.x),
           hn::MulAdd(basis[i], hn::Set(d, c.y), sum.y),
           hn::MulAdd(basis[i], hn::Set(d, c.z), sum.z)};
  }
  return {hn::Max(sum.x, zero), hn::Max(sum.y, zero), hn::Max(sum.z, zero)};
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();
#endif
