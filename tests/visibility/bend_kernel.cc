// SPDX-License-Identifier: Apache-2.0
// tests/visibility/bend_kernel.cc: the loop behind bend_kernel.h.
#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "visibility/bend_kernel.cc"
#include "hwy/foreach_target.h"

#include "hwy/highway.h"

#include "hit/shading_normal-inl.h"
#include "visibility/bend_kernel.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {

using BendTag = hn::ScalableTag<double>;
using BendV = hn::Vec<BendTag>;

Vec3V<BendV> Gather(const std::vector<BendQuery>& queries, size_t first, Vec3d BendQuery::*vector) {
  const BendTag d;
  alignas(64) double lanes[3][16];
  for (size_t i = 0; i < hn::Lanes(d); ++i) {
    const Vec3d& from = queries[std::min(first + i, queries.size() - 1)].*vector;
    for (int c = 0; c < 3; ++c) lanes[c][i] = from[c];
  }
  return Load3(d, lanes[0], lanes[1], lanes[2]);
}

void AskT(const std::vector<BendQuery>& queries, bool grazing, std::vector<Vec3d>* answers) {
  const BendTag d;
  for (size_t first = 0; first < queries.size(); first += hn::Lanes(d)) {
    const Vec3V<BendV> normal = Gather(queries, first, &BendQuery::normal);
    const Vec3V<BendV> to_view = Gather(queries, first, &BendQuery::to_view);
    const Vec3V<BendV> bent =
        grazing ? GrazingView(d, normal, to_view)
                : BendNormal(d, normal, Gather(queries, first, &BendQuery::surface), to_view);
    alignas(64) double lanes[3][16];
    Store3(bent, d, lanes[0], lanes[1], lanes[2]);
    for (size_t i = 0; i < hn::Lanes(d) && first + i < queries.size(); ++i) {
      answers->push_back(Vec3d(lanes[0][i], lanes[1][i], lanes[2][i]));
    }
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nacre {
HWY_EXPORT(AskT);
std::vector<Vec3d> AskBend(const std::vector<BendQuery>& queries) {
  std::vector<Vec3d> answers;
  HWY_DYNAMIC_DISPATCH(AskT)(queries, false, &answers);
  return answers;
}
std::vector<Vec3d> AskGrazing(const std::vector<BendQuery>& queries) {
  std::vector<Vec3d> answers;
  HWY_DYNAMIC_DISPATCH(AskT)(queries, true, &answers);
  return answers;
}
}  // namespace nacre
#endif
