// SPDX-License-Identifier: Apache-2.0
// tests/brdf/diffuse_kernel.cc: the loop behind diffuse_kernel.h.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "brdf/diffuse_kernel.cc"
#include "hwy/foreach_target.h"

#include <cmath>

#include "hwy/highway.h"

#include "base/target_ops-inl.h"
#include "brdf/burley-inl.h"
#include "brdf/diffuse_kernel.h"
#include "brdf/eon-inl.h"
#include "queries-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {

// The scalar twins of these two are the whole BRDFs. Kernels form them of the same terms, some of
// which they compute once for all lights.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V BurleyDiffuse(D d, const AnglesV<V>& a, V roughness) {
  using T = hn::TFromD<D>;
  const V zero = hn::Zero(d);
  const auto above = hn::And(hn::Gt(a.n_dot_l, zero), hn::Gt(a.n_dot_v, zero));
  const V product = BurleySpread(d, a.u_squared, BurleyGrazing(d, a.n_dot_l),
                                 BurleyGrazing(d, a.n_dot_v), roughness);
  return hn::IfThenElseZero(above, hn::Mul(product, hn::Set(d, T(M_1_PI))));
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE V Eon(D d, const AnglesV<V>& a, V albedo, V roughness) {
  const V zero = hn::Zero(d);
  const V one = hn::Set(d, 1.0f);
  const auto above = hn::And(hn::Gt(a.n_dot_l, zero), hn::Gt(a.n_dot_v, zero));
  const V n_dot_l = hn::IfThenElse(above, a.n_dot_l, one);
  const V n_dot_v = hn::IfThenElse(above, a.n_dot_v, one);
  const V l_dot_v = hn::NegMulAdd(hn::Set(d, 0.5f), a.lv_squared, one);
  const V scale = EonScale(d, roughness);
  const V single = EonSingleSpread(d, n_dot_l, n_dot_v, l_dot_v, roughness, scale);
  const V multiple =
      hn::Mul(EonMultipleAlbedo(d, albedo, roughness, scale),
              EonMultipleSpread(d, EonLoss(d, n_dot_l), EonLoss(d, n_dot_v), roughness, scale));
  const V sum = hn::MulAdd(albedo, single, multiple);
  return hn::IfThenElseZero(above, hn::Mul(sum, hn::Set(d, static_cast<float>(M_1_PI))));
}

std::vector<DiffuseAnswer> EvaluateDiffuseT(const std::vector<DiffuseQuery>& queries) {
  return AskInPackets<float, DiffuseAnswer>(queries, [](const auto& packet) {
    const hn::ScalableTag<float> d;
    const auto a = ComputeAngles(d, packet.Vector(&DiffuseQuery::n),
                                 packet.Vector(&DiffuseQuery::l), packet.Vector(&DiffuseQuery::v));
    const auto roughness = packet.Number(&DiffuseQuery::roughness);
    packet.Store(Eon(d, a, packet.Number(&DiffuseQuery::albedo), roughness), &DiffuseAnswer::eon);
    packet.Store(BurleyDiffuse(d, a, roughness), &DiffuseAnswer::burley);
  });
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nacre {
HWY_EXPORT(EvaluateDiffuseT);
std::vector<DiffuseAnswer> EvaluateDiffuse(const std::vector<DiffuseQuery>& queries) {
  return HWY_DYNAMIC_DISPATCH(EvaluateDiffuseT)(queries);
}
}  // namespace nacre
#endif
