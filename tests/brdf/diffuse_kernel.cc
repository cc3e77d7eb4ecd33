// SPDX-License-Identifier: Apache-2.0
// tests/brdf/diffuse_kernel.cc: the loop behind diffuse_kernel.h.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "brdf/diffuse_kernel.cc"
#include "hwy/foreach_target.h"

#include "hwy/highway.h"

#include "base/target_ops-inl.h"
#include "brdf/burley-inl.h"
#include "brdf/diffuse_kernel.h"
#include "brdf/eon-inl.h"
#include "queries-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {

void EvaluateDiffuseT(const std::vector<DiffuseQuery>& queries,
                      std::vector<DiffuseAnswer>* answers) {
  AskInPackets<float>(queries, answers, [](const auto& packet) {
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
  std::vector<DiffuseAnswer> answers(queries.size());
  HWY_DYNAMIC_DISPATCH(EvaluateDiffuseT)(queries, &answers);
  return answers;
}
}  // namespace nacre
#endif
