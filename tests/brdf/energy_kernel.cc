// SPDX-License-Identifier: Apache-2.0
// tests/brdf/energy_kernel.cc: the loops over arrays behind energy_kernel.h.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "brdf/energy_kernel.cc"
#include "hwy/foreach_target.h"

#include "hwy/highway.h"

#include "brdf/albedo-inl.h"
#include "brdf/energy_kernel.h"
#include "brdf/fresnel-inl.h"
#include "brdf/fresnel_table-inl.h"
#include "queries-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {

std::vector<FresnelOutput> EvaluateFresnelT(const std::vector<FresnelInput>& inputs) {
  return AskInPackets<float, FresnelOutput>(inputs, [](const auto& packet) {
    const hn::ScalableTag<float> d;
    const auto c = packet.Number(&FresnelInput::v_dot_h);
    const auto m = packet.Number(&FresnelInput::one_minus_vh);
    const auto eta = packet.Number(&FresnelInput::eta), k = packet.Number(&FresnelInput::k);
    const auto f0 = packet.Number(&FresnelInput::f0);
    packet.Store(FresnelDielectric(d, c, m, eta), &FresnelOutput::dielectric);
    packet.Store(FresnelConductor(d, c, m, eta, k), &FresnelOutput::conductor);
    packet.Store(FresnelSchlick(d, f0, hn::Set(d, 1.0f), Power5(m)), &FresnelOutput::schlick);
    packet.Store(FresnelF82(d, c, m, f0, packet.Number(&FresnelInput::slope)), &FresnelOutput::f82);
  });
}

std::vector<AlbedoOutput> EvaluateAlbedosT(const FresnelAlbedoFit& fit,
                                           const std::vector<float>& n_dot_v) {
  return AskInPackets<float, AlbedoOutput>(n_dot_v, [&](const auto& packet) {
    const hn::ScalableTag<float> d;
    const auto mu = packet.Number([](float cosine) { return cosine; });
    const auto x = ComputeAlbedoVariables(d, fit.lobe.shape, mu);
    const auto one = AlbedoOne(d, fit.lobe, x);
    packet.Store(one, &AlbedoOutput::one);
    packet.Store(AlbedoLoss(d, fit.lobe, x), &AlbedoOutput::loss);
    packet.Store(AlbedoSchlick(d, fit.lobe, one, x), &AlbedoOutput::schlick);
    packet.Store(AlbedoFresnel(d, fit, one, x), &AlbedoOutput::fresnel);
  });
}

std::vector<Vec3f> EvaluateFresnelTableT(const FresnelTable& table,
                                         const std::vector<float>& v_dot_h) {
  return AskInPackets<float, Vec3f>(v_dot_h, [&](const auto& packet) {
    const auto cosine = packet.Number([](float number) { return number; });
    packet.Store3(FresnelTableLoss(hn::ScalableTag<float>(), table, cosine),
                  [](Vec3f& loss) -> Vec3f& { return loss; });
  });
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nacre {
HWY_EXPORT(EvaluateFresnelT);
HWY_EXPORT(EvaluateAlbedosT);
HWY_EXPORT(EvaluateFresnelTableT);
std::vector<FresnelOutput> EvaluateFresnel(const std::vector<FresnelInput>& inputs) {
  return HWY_DYNAMIC_DISPATCH(EvaluateFresnelT)(inputs);
}
std::vector<AlbedoOutput> EvaluateAlbedos(const FresnelAlbedoFit& fit,
                                          const std::vector<float>& n_dot_v) {
  return HWY_DYNAMIC_DISPATCH(EvaluateAlbedosT)(fit, n_dot_v);
}
std::vector<Vec3f> EvaluateFresnelTable(const FresnelTable& table,
                                        const std::vector<float>& v_dot_h) {
  return HWY_DYNAMIC_DISPATCH(EvaluateFresnelTableT)(table, v_dot_h);
}
}  // namespace nacre
#endif
