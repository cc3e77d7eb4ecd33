// SPDX-License-Identifier: Apache-2.0
// tests/brdf/energy_kernel.cc: the loops over arrays behind energy_kernel.h.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "brdf/energy_kernel.cc"
#include "hwy/foreach_target.h"

#include "hwy/highway.h"

#include "brdf/albedo-inl.h"
#include "brdf/energy_kernel.h"
#include "brdf/fresnel-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {

using D = hn::ScalableTag<float>;
using V = hn::Vec<D>;

// Up to a whole vector of get(i), the last one repeated.
template <class Get>
V Gather(size_t first, size_t size, Get get) {
  alignas(64) float lanes[16];
  for (size_t i = 0; i < hn::Lanes(D()); ++i)
    lanes[i] = get(first + i < size ? first + i : size - 1);
  return hn::Load(D(), lanes);
}

template <class Output>
void Scatter(V value, size_t first, float Output::*member, std::vector<Output>* outputs) {
  alignas(64) float lanes[16];
  hn::Store(value, D(), lanes);
  for (size_t i = 0; i < hn::Lanes(D()) && first + i < outputs->size(); ++i) {
    (*outputs)[first + i].*member = lanes[i];
  }
}

void EvaluateFresnelT(const std::vector<FresnelInput>& inputs,
                      std::vector<FresnelOutput>* outputs) {
  const D d;
  for (size_t first = 0; first < inputs.size(); first += hn::Lanes(d)) {
    const auto get = [&](float FresnelInput::*member) {
      return Gather(first, inputs.size(), [&](size_t i) { return inputs[i].*member; });
    };
    const V c = get(&FresnelInput::v_dot_h);
    const V m = get(&FresnelInput::one_minus_vh);
    const V eta = get(&FresnelInput::eta);
    const V f0 = get(&FresnelInput::f0);
    Scatter(FresnelDielectric(d, c, m, eta), first, &FresnelOutput::dielectric, outputs);
    Scatter(FresnelConductor(d, c, m, eta, get(&FresnelInput::k)), first, &FresnelOutput::conductor,
            outputs);
    Scatter(FresnelSchlick(d, f0, hn::Set(d, 1.0f), Power5(m)), first, &FresnelOutput::schlick,
            outputs);
    Scatter(FresnelF82(d, c, m, f0, get(&FresnelInput::slope)), first, &FresnelOutput::f82,
            outputs);
  }
}

void EvaluateAlbedosT(const FresnelAlbedoFit& fit, const std::vector<float>& n_dot_v,
                      std::vector<AlbedoOutput>* outputs) {
  const D d;
  for (size_t first = 0; first < n_dot_v.size(); first += hn::Lanes(d)) {
    const V mu = Gather(first, n_dot_v.size(), [&](size_t i) { return n_dot_v[i]; });
    const V one = AlbedoOne(d, fit.lobe, mu);
    Scatter(one, first, &AlbedoOutput::one, outputs);
    Scatter(AlbedoLoss(d, fit.lobe, mu), first, &AlbedoOutput::loss, outputs);
    Scatter(AlbedoSchlick(d, fit.lobe, mu), first, &AlbedoOutput::schlick, outputs);
    Scatter(AlbedoFresnel(d, fit, mu), first, &AlbedoOutput::fresnel, outputs);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nacre {
HWY_EXPORT(EvaluateFresnelT);
HWY_EXPORT(EvaluateAlbedosT);
std::vector<FresnelOutput> EvaluateFresnel(const std::vector<FresnelInput>& inputs) {
  std::vector<FresnelOutput> outputs(inputs.size());
  HWY_DYNAMIC_DISPATCH(EvaluateFresnelT)(inputs, &outputs);
  return outputs;
}
std::vector<AlbedoOutput> EvaluateAlbedos(const FresnelAlbedoFit& fit,
                                          const std::vector<float>& n_dot_v) {
  std::vector<AlbedoOutput> outputs(n_dot_v.size());
  HWY_DYNAMIC_DISPATCH(EvaluateAlbedosT)(fit, n_dot_v, &outputs);
  return outputs;
}
}  // namespace nacre
#endif
