// SPDX-License-Identifier: Apache-2.0
// tests/brdf/measured_kernel.cc: the loop behind measured_kernel.h.
#include "brdf/measured_kernel.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "brdf/measured_kernel.cc"
#include "hwy/foreach_target.h"

#include "hwy/highway.h"

#include "brdf/measured-inl.h"
#include "queries-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {

std::vector<MeasuredAnswer> AskMeasuredT(const MeasuredBrdf& brdf,
                                         const std::vector<MeasuredQuery>& queries) {
  using D = hn::ScalableTag<float>;
  return AskInPackets<float, MeasuredAnswer>(queries, [&](const auto& packet) {
    const D d;
    const auto n = packet.Vector(&MeasuredQuery::n), t = packet.Vector(&MeasuredQuery::tangent);
    const auto l = packet.Vector(&MeasuredQuery::l), v = packet.Vector(&MeasuredQuery::v);
    packet.Store3(EvaluateMeasured(d, brdf, MeasuredInterpolation::kLinear, n, t, l, v),
                  &MeasuredAnswer::linear);
    packet.Store3(EvaluateMeasured(d, brdf, MeasuredInterpolation::kNearest, n, t, l, v),
                  &MeasuredAnswer::nearest);
    packet.Store3(SampleMeasured(d, brdf, n, t, v, packet.Number(&MeasuredQuery::u0),
                                 packet.Number(&MeasuredQuery::u1)),
                  &MeasuredAnswer::sample);
    packet.Store(MeasuredPdf(d, brdf, n, t, v, l), &MeasuredAnswer::pdf);
  });
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nacre {
HWY_EXPORT(AskMeasuredT);
std::vector<MeasuredAnswer> AskMeasured(const MeasuredBrdf& brdf,
                                        const std::vector<MeasuredQuery>& queries) {
  return HWY_DYNAMIC_DISPATCH(AskMeasuredT)(brdf, queries);
}
}  // namespace nacre
#endif
