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

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {

using D = hn::ScalableTag<float>;
using V = hn::Vec<D>;

// Loads a member of up to a whole vector of inputs, the last one repeated.
template <class Member>
V Gather(const std::vector<TermInput>& inputs, size_t first, Member member) {
  alignas(64) float lanes[16];
  for (size_t i = 0; i < hn::Lanes(D()); ++i) {
    lanes[i] = member(inputs[first + i < inputs.size() ? first + i : inputs.size() - 1]);
  }
  return hn::Load(D(), lanes);
}

Vec3V<V> Gather3(const std::vector<TermInput>& inputs, size_t first, Vec3f TermInput::*vector) {
  return {Gather(inputs, first, [=](const TermInput& in) { return (in.*vector).x; }),
          Gather(inputs, first, [=](const TermInput& in) { return (in.*vector).y; }),
          Gather(inputs, first, [=](const TermInput& in) { return (in.*vector).z; })};
}

void EvaluateTermsT(const std::vector<TermInput>& inputs, std::vector<TermOutput>* outputs) {
  const D d;
  const V zero = hn::Zero(d);
  const V one = hn::Set(d, 1.0f);
  for (size_t first = 0; first < inputs.size(); first += hn::Lanes(d)) {
    const Vec3V<V> n = Gather3(inputs, first, &TermInput::n);
    const Vec3V<V> l = Gather3(inputs, first, &TermInput::l);
    const Vec3V<V> v = Gather3(inputs, first, &TermInput::v);
    const V shininess = Gather(inputs, first, [](const TermInput& in) { return in.shininess; });
    const V alpha =
        Gather(inputs, first, [](const TermInput& in) { return in.roughness * in.roughness; });
    const auto schlick_k = [&](Shadowing shadowing) {
      return Gather(inputs, first,
                    [=](const TermInput& in) { return SchlickK(shadowing, in.roughness); });
    };
    const V direct_k = schlick_k(Shadowing::kSchlickDirect);
    const V ibl_k = schlick_k(Shadowing::kSchlickIbl);
    const V f0 = Gather(inputs, first, [](const TermInput& in) { return in.f0; });
    const AnglesV<V> a = ComputeAngles(d, n, l, v);
    const V n_dot_v = hn::Max(a.n_dot_v, zero);
    const V values[] = {
        PhongLobe(d, PhongCosine(d, SquaredFromReflection(n, l, v)), shininess),
        BlinnLobe(d, BlinnSquaredCosine(d, a), shininess),
        GgxDistribution(d, a, alpha),
        hn::Div(one, VisibilityDenominatorHeightCorrelated(d, a.n_dot_l, n_dot_v, alpha, one)),
        hn::Div(one, VisibilityDenominatorSeparable(d, a.n_dot_l, n_dot_v, alpha, one)),
        hn::Div(one, VisibilityDenominatorSchlick(d, a.n_dot_l, n_dot_v, direct_k, one)),
        hn::Div(one, VisibilityDenominatorSchlick(d, a.n_dot_l, n_dot_v, ibl_k, one)),
        FresnelSchlick(d, f0, hn::Set(d, hn::TFromD<D>(1)), SchlickWeight(d, a)),
        a.u_squared,
    };
    float TermOutput::*const members[] = {
        &TermOutput::phong,        &TermOutput::blinn,
        &TermOutput::distribution, &TermOutput::height_correlated,
        &TermOutput::separable,    &TermOutput::schlick_direct,
        &TermOutput::schlick_ibl,  &TermOutput::fresnel,
        &TermOutput::u_squared,
    };
    for (size_t m = 0; m < std::size(members); ++m) {
      alignas(64) float lanes[16];
      hn::Store(values[m], d, lanes);
      for (size_t i = 0; i < hn::Lanes(d) && first + i < inputs.size(); ++i) {
        (*outputs)[first + i].*members[m] = lanes[i];
      }
    }
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nacre {
HWY_EXPORT(EvaluateTermsT);
std::vector<TermOutput> EvaluateTerms(const std::vector<TermInput>& inputs) {
  std::vector<TermOutput> outputs(inputs.size());
  HWY_DYNAMIC_DISPATCH(EvaluateTermsT)(inputs, &outputs);
  return outputs;
}
}  // namespace nacre
#endif
