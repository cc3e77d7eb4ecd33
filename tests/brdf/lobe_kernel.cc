// SPDX-License-Identifier: Apache-2.0
// tests/brdf/lobe_kernel.cc: the loop behind lobe_kernel.h.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "brdf/lobe_kernel.cc"
#include "hwy/foreach_target.h"

#include "hwy/highway.h"

#include "base/target_ops-inl.h"
#include "brdf/lobe_kernel.h"
#include "brdf/lobe_sampling-inl.h"
#include "queries-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {

using D = hn::ScalableTag<float>;
using V = hn::Vec<D>;

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
      return GgxVisiblePdf(d, GgxDistribution(d, a, in.width), a.n_dot_v, in.width);
    case Lobe::kPhong: {
      const auto cosine = PhongCosine(d, SquaredFromReflection(in.n, in.l, in.v));
      return PhongLobePdf(d, PhongLobe(d, cosine, in.width), in.width);
    }
    case Lobe::kBlinn:
      return BlinnLobePdf(d, BlinnLobe(d, BlinnSquaredCosine(d, a), in.width), a, in.width);
    case Lobe::kKullaConty:
      return KullaContyPdf(d, a.n_dot_l, in.width);
  }
  return in.width;
}

std::vector<LobeAnswer> AskLobeT(Lobe lobe, const std::vector<LobeQuery>& queries) {
  return AskInPackets<float, LobeAnswer>(queries, [=](const auto& packet) {
    const Inputs in{packet.Vector(&LobeQuery::n),  packet.Vector(&LobeQuery::v),
                    packet.Vector(&LobeQuery::l),  packet.Number(&LobeQuery::width),
                    packet.Number(&LobeQuery::u0), packet.Number(&LobeQuery::u1)};
    packet.Store3(SampleOf(lobe, in), &LobeAnswer::sample);
    packet.Store(PdfOf(lobe, in), &LobeAnswer::pdf);
  });
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nacre {
HWY_EXPORT(AskLobeT);
std::vector<LobeAnswer> AskLobe(Lobe lobe, const std::vector<LobeQuery>& queries) {
  return HWY_DYNAMIC_DISPATCH(AskLobeT)(lobe, queries);
}
}  // namespace nacre
#endif
