// SPDX-License-Identifier: Apache-2.0
// tests/visibility/bend_kernel.cc: the loop behind bend_kernel.h.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "visibility/bend_kernel.cc"
#include "hwy/foreach_target.h"

#include "hwy/highway.h"

#include "hit/shading_normal-inl.h"
#include "queries-inl.h"
#include "visibility/bend_kernel.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {

std::vector<Vec3d> AskT(const std::vector<BendQuery>& queries, bool grazing) {
  return AskInPackets<double, Vec3d>(queries, [=](const auto& packet) {
    const hn::ScalableTag<double> d;
    const auto normal = packet.Vector(&BendQuery::normal);
    const auto to_view = packet.Vector(&BendQuery::to_view);
    packet.Store3(
        grazing ? GrazingView(d, normal, to_view)
                : BendNormal(d, normal, packet.Vector(&BendQuery::surface), to_view),
        [](Vec3d & answer) -> auto& { return answer; });
  });
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nacre {
HWY_EXPORT(AskT);
std::vector<Vec3d> AskBend(const std::vector<BendQuery>& queries) {
  return HWY_DYNAMIC_DISPATCH(AskT)(queries, false);
}
std::vector<Vec3d> AskGrazing(const std::vector<BendQuery>& queries) {
  return HWY_DYNAMIC_DISPATCH(AskT)(queries, true);
}
}  // namespace nacre
#endif
