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

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {

using D = hn::ScalableTag<float>;
using V = hn::Vec<D>;
constexpr size_t kMaxLanes = 32;

template <class Member>
V Column(const std::vector<DiffuseQuery>& queries, size_t first, Member member) {
  alignas(64) float lanes[kMaxLanes];
  for (size_t i = 0; i < hn::Lanes(D()); ++i) {
    lanes[i] = member(queries[std::min(first + i, queries.size() - 1)]);
  }
  return hn::Load(D(), lanes);
}

Vec3V<V> Column3(const std::vector<DiffuseQuery>& queries, size_t first,
                 Vec3f DiffuseQuery::*vector) {
  return {Column(queries, first, [=](const DiffuseQuery& q) { return (q.*vector).x; }),
          Column(queries, first, [=](const DiffuseQuery& q) { return (q.*vector).y; }),
          Column(queries, first, [=](const DiffuseQuery& q) { return (q.*vector).z; })};
}

void EvaluateDiffuseT(const std::vector<DiffuseQuery>& queries,
                      std::vector<DiffuseAnswer>* answers) {
  const D d;
  for (size_t first = 0; first < queries.size(); first += hn::Lanes(d)) {
    const AnglesV<V> a = ComputeAngles(d, Column3(queries, first, &DiffuseQuery::n),
                                       Column3(queries, first, &DiffuseQuery::l),
                                       Column3(queries, first, &DiffuseQuery::v));
    const V roughness = Column(queries, first, [](const DiffuseQuery& q) { return q.roughness; });
    const V albedo = Column(queries, first, [](const DiffuseQuery& q) { return q.albedo; });
    alignas(64) float lanes[2][kMaxLanes];
    hn::Store(Eon(d, a, albedo, roughness), d, lanes[0]);
    hn::Store(BurleyDiffuse(d, a, roughness), d, lanes[1]);
    for (size_t i = 0; i < hn::Lanes(d) && first + i < queries.size(); ++i) {
      (*answers)[first + i] = {lanes[0][i], lanes[1][i]};
    }
  }
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
