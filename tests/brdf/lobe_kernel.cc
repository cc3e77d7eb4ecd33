// SPDX-License-Identifier: Apache-2.0
// tests/brdf/lobe_kernel.cc: the loop behind lobe_kernel.h.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "brdf/lobe_kernel.cc"
#include "hwy/foreach_target.h"

#include "hwy/highway.h"

#include "base/target_ops-inl.h"
#include "brdf/lobe_kernel.h"
#include "brdf/lobe_sampling-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {

using D = hn::ScalableTag<float>;
using V = hn::Vec<D>;
constexpr size_t kMaxLanes = 32;

template <class Member>
V Column(const std::vector<LobeQuery>& queries, size_t first, Member member) {
  alignas(64) float lanes[kMaxLanes];
  for (size_t i = 0; i < hn::Lanes(D()); ++i) {
    lanes[i] = member(queries[std::min(first + i, queries.size() - 1)]);
  }
  return hn::Load(D(), lanes);
}

Vec3V<V> Column3(const std::vector<LobeQuery>& queries, size_t first, Vec3f LobeQuery::*vector) {
  return {Column(queries, first, [=](const LobeQuery& q) { return (q.*vector).x; }),
          Column(queries, first, [=](const LobeQuery& q) { return (q.*vector).y; }),
          Column(queries, first, [=](const LobeQuery& q) { return (q.*vector).z; })};
}

struct Inputs {
  Vec3V<V> n, v, l;
  V width, u0, u1;
};

Vec3V<V> SampleOf(Lobe lobe, const Inputs& in) {
  const D d;
  switch (lobe) {
    case Lobe::kCosine:
      return SampleCosine(d, in.n, in.u0, in.u1);
    case Lobe::kGgx:
      return SampleGgxVisible(d, in.n, in.v, in.width, in.u0, in.u1);
    case Lobe::kPhong:
      return SamplePhongLobe(d, in.n, in.v, in.width, in.u0, in.u1);
    case Lobe::kBlinn:
      return SampleBlinnLobe(d, in.n, in.v, in.width, in.u0, in.u1);
    case Lobe::kKullaConty:
      return SampleKullaConty(d, in.n, in.width, in.u0, in.u1);
  }
  return in.n;
}

V PdfOf(Lobe lobe, const Inputs& in) {
  const D d;
  const AnglesV<V> a = ComputeAngles(d, in.n, in.l, in.v);
  switch (lobe) {
    case Lobe::kCosine:
      return CosinePdf(d, a.n_dot_l);
    case Lobe::kGgx:
      return GgxVisiblePdf(d, a, in.width);
    case Lobe::kPhong:
      return PhongLobePdf(d, in.n, in.v, in.l, in.width);
    case Lobe::kBlinn:
      return BlinnLobePdf(d, a, in.width);
    case Lobe::kKullaConty:
      return KullaContyPdf(d, a.n_dot_l, in.width);
  }
  return in.width;
}

void AskLobeT(Lobe lobe, const std::vector<LobeQuery>& queries, std::vector<LobeAnswer>* answers) {
  const D d;
  for (size_t first = 0; first < queries.size(); first += hn::Lanes(d)) {
    const Inputs in{Column3(queries, first, &LobeQuery::n),
                    Column3(queries, first, &LobeQuery::v),
                    Column3(queries, first, &LobeQuery::l),
                    Column(queries, first, [](const LobeQuery& q) { return q.width; }),
                    Column(queries, first, [](const LobeQuery& q) { return q.u0; }),
                    Column(queries, first, [](const LobeQuery& q) { return q.u1; })};
    const Vec3V<V> sample = SampleOf(lobe, in);
    alignas(64) float lanes[4][kMaxLanes];
    hn::Store(sample.x, d, lanes[0]);
    hn::Store(sample.y, d, lanes[1]);
    hn::Store(sample.z, d, lanes[2]);
    hn::Store(PdfOf(lobe, in), d, lanes[3]);
    for (size_t i = 0; i < hn::Lanes(d) && first + i < queries.size(); ++i) {
      (*answers)[first + i] = {Vec3f(lanes[0][i], lanes[1][i], lanes[2][i]), lanes[3][i]};
    }
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nacre {
HWY_EXPORT(AskLobeT);
std::vector<LobeAnswer> AskLobe(Lobe lobe, const std::vector<LobeQuery>& queries) {
  std::vector<LobeAnswer> answers(queries.size());
  HWY_DYNAMIC_DISPATCH(AskLobeT)(lobe, queries, &answers);
  return answers;
}
}  // namespace nacre
#endif
