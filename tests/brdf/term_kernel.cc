// SPDX-License-Identifier: Apache-2.0
// tests/brdf/term_kernel.cc: the loop over arrays behind term_kernel.h.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "brdf/term_kernel.cc"
#include "hwy/foreach_target.h"

#include "hwy/highway.h"

#include "brdf/fresnel-inl.h"
#include "brdf/ggx-inl.h"
#include "brdf/ggx.h"
#include "brdf/phong-inl.h"
#include "brdf/term_kernel.h"
#include "queries-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {

std::vector<TermOutput> EvaluateTermsT(const std::vector<TermInput>& inputs) {
  return AskInPackets<float, TermOutput>(inputs, [](const auto& packet) {
    const hn::ScalableTag<float> d;
    const auto zero = hn::Zero(d), one = hn::Set(d, 1.0f);
    const auto n = packet.Vector(&TermInput::n), l = packet.Vector(&TermInput::l);
    const auto v = packet.Vector(&TermInput::v);
    const auto shininess = packet.Number(&TermInput::shininess);
    const auto alpha =
        packet.Number([](const TermInput& in) { return in.roughness * in.roughness; });
    const auto schlick_k = [&](Shadowing shadowing) {
      return packet.Number([=](const TermInput& in) { return SchlickK(shadowing, in.roughness); });
    };
    const auto a = ComputeAngles(d, n, l, v);
    const auto n_dot_v = hn::Max(a.n_dot_v, zero);
    const auto by_schlick = [&](Shadowing shadowing) {
      const auto k = schlick_k(shadowing);
      return hn::Div(one, VisibilityDenominatorSchlick(d, a.n_dot_l, n_dot_v, k, one));
    };
    packet.Store(PhongLobe(d, PhongCosine(d, SquaredFromReflection(n, l, v)), shininess),
                 &TermOutput::phong);
    packet.Store(BlinnLobe(d, BlinnSquaredCosine(d, a), shininess), &TermOutput::blinn);
    packet.Store(GgxDistribution(d, a, alpha), &TermOutput::distribution);
    packet.Store(
        hn::Div(one, VisibilityDenominatorHeightCorrelated(d, a.n_dot_l, n_dot_v, alpha, one)),
        &TermOutput::height_correlated);
    packet.Store(hn::Div(one, VisibilityDenominatorSeparable(d, a.n_dot_l, n_dot_v, alpha, one)),
                 &TermOutput::separable);
    packet.Store(by_schlick(Shadowing::kSchlickDirect), &TermOutput::schlick_direct);
    packet.Store(by_schlick(Shadowing::kSchlickIbl), &TermOutput::schlick_ibl);
    packet.Store(FresnelSchlick(d, packet.Number(&TermInput::f0), one, SchlickWeight(d, a)),
                 &TermOutput::fresnel);
    packet.Store(a.u_squared, &TermOutput::u_squared);
  });
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nacre {
HWY_EXPORT(EvaluateTermsT);
std::vector<TermOutput> EvaluateTerms(const std::vector<TermInput>& inputs) {
  return HWY_DYNAMIC_DISPATCH(EvaluateTermsT)(inputs);
}
}  // namespace nacre
#endif
