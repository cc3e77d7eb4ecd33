// SPDX-License-Identifier: Apache-2.0
// tests/brdf/layer_kernel.cc: the loop behind layer_kernel.h.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "brdf/layer_kernel.cc"
#include "hwy/foreach_target.h"

#include "hwy/highway.h"

#include "brdf/fuzz-inl.h"
#include "brdf/layer_kernel.h"
#include "brdf/sheen-inl.h"
#include "queries-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {

template <typename T>
std::vector<LayerAnswer<T>> Evaluate(RoughnessOf roughness_of,
                                     const std::vector<LayerQuery<T>>& queries) {
  using Query = LayerQuery<T>;
  using Answer = LayerAnswer<T>;
  return AskInPackets<T, LayerAnswer<T>>(queries, [=](const auto& packet) {
    const hn::ScalableTag<T> d;
    using V = hn::Vec<decltype(d)>;
    const bool each = roughness_of == RoughnessOf::kEach;
    const AnglesV<V> a = ComputeAngles(d, packet.Vector(&Query::n), packet.Vector(&Query::l),
                                       packet.Vector(&Query::v));
    const Charlie<V> charlie =
        each ? MakeCharlie(d, packet.Number(&Query::roughness))
             : BroadcastCharlie(d, nacre::MakeCharlie(double{packet.At(0).roughness}));
    packet.Store(CharlieDistribution(d, a, charlie.alpha), &Answer::distribution);
    packet.Store(CharlieLobe(d, charlie, a), &Answer::sheen);
    const V cosine_lambda_v = CharlieCosineLambda(d, charlie, a.n_dot_v);
    packet.Store(cosine_lambda_v, &Answer::cosine_lambda_v);
    const V albedo_v = CharlieAlbedo(d, charlie, a.n_dot_v, cosine_lambda_v);
    const V albedo_l = CharlieAlbedo(d, charlie, a.n_dot_l);
    packet.Store(albedo_v, &Answer::sheen_albedo_v);
    packet.Store(albedo_l, &Answer::sheen_albedo_l);
    const SheenScale<V> scale =
        ScaleSheen(d, packet.Number(&Query::largest_channel), albedo_v, albedo_l);
    packet.Store(scale.lobe, &Answer::sheen_scale);
    packet.Store(scale.below, &Answer::below_sheen);
    const Fuzz<V> fuzz = each ? MakeFuzz(d, packet.Number(&Query::roughness))
                              : BroadcastFuzz(d, nacre::MakeFuzz(double{packet.At(0).roughness}));
    const FuzzView<V> view = FuzzFromView(d, fuzz, a.n_dot_v);
    packet.Store(view.albedo, &Answer::fuzz_albedo);
    packet.Store(view.a, &Answer::fuzz_a);
    packet.Store(view.tilt, &Answer::fuzz_tilt);
    packet.Store(FuzzLobe(d, view, a), &Answer::fuzz);
    packet.Store(FuzzPdf(d, view, a), &Answer::fuzz_pdf);
  });
}

std::vector<LayerAnswer<float>> EvaluateFloatT(RoughnessOf roughness,
                                               const std::vector<LayerQuery<float>>& queries) {
  return Evaluate(roughness, queries);
}
std::vector<LayerAnswer<double>> EvaluateDoubleT(RoughnessOf roughness,
                                                 const std::vector<LayerQuery<double>>& queries) {
  return Evaluate(roughness, queries);
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nacre {
HWY_EXPORT(EvaluateFloatT);
HWY_EXPORT(EvaluateDoubleT);
template <>
std::vector<LayerAnswer<float>> EvaluateLayers(RoughnessOf roughness,
                                               const std::vector<LayerQuery<float>>& queries) {
  return HWY_DYNAMIC_DISPATCH(EvaluateFloatT)(roughness, queries);
}
template <>
std::vector<LayerAnswer<double>> EvaluateLayers(RoughnessOf roughness,
                                                const std::vector<LayerQuery<double>>& queries) {
  return HWY_DYNAMIC_DISPATCH(EvaluateDoubleT)(roughness, queries);
}
}  // namespace nacre
#endif
