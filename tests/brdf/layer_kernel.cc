// SPDX-License-Identifier: Apache-2.0
// tests/brdf/layer_kernel.cc: the loop behind layer_kernel.h.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "brdf/layer_kernel.cc"
#include "hwy/foreach_target.h"

#include "hwy/highway.h"

#include "brdf/layer_kernel.h"
#include "brdf/sheen-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {

constexpr size_t kMaxLanes = 32;

// Up to a whole vector of queries from `first` on, the last one repeated.
template <typename T>
struct Packet {
  using D = hn::ScalableTag<T>;
  using V = hn::Vec<D>;
  const std::vector<LayerQuery<T>>& queries;
  size_t first;

  const LayerQuery<T>& At(size_t lane) const {
    return queries[std::min(first + lane, queries.size() - 1)];
  }
  template <class Member>
  V Column(const Member& member) const {
    alignas(64) T lanes[kMaxLanes];
    for (size_t i = 0; i < hn::Lanes(D()); ++i) lanes[i] = member(At(i));
    return hn::Load(D(), lanes);
  }
  V Number(T LayerQuery<T>::*number) const {
    return Column([=](const LayerQuery<T>& q) { return q.*number; });
  }
  Vec3V<V> Vector(Imath::Vec3<T> LayerQuery<T>::*vector) const {
    return {Column([=](const LayerQuery<T>& q) { return (q.*vector).x; }),
            Column([=](const LayerQuery<T>& q) { return (q.*vector).y; }),
            Column([=](const LayerQuery<T>& q) { return (q.*vector).z; })};
  }
};

template <typename T>
void Evaluate(RoughnessOf roughness_of, const std::vector<LayerQuery<T>>& queries,
              std::vector<LayerAnswer<T>>* answers) {
  using Query = LayerQuery<T>;
  using Answer = LayerAnswer<T>;
  const hn::ScalableTag<T> d;
  using V = hn::Vec<decltype(d)>;
  for (size_t first = 0; first < queries.size(); first += hn::Lanes(d)) {
    const Packet<T> packet{queries, first};
    const bool each = roughness_of == RoughnessOf::kEach;
    const V roughness =
        each ? packet.Number(&Query::roughness) : hn::Set(d, packet.At(0).roughness);
    const AnglesV<V> a = ComputeAngles(d, packet.Vector(&Query::n), packet.Vector(&Query::l),
                                       packet.Vector(&Query::v));
    const CharlieV<V> charlie =
        each ? MakeCharlie(d, roughness)
             : BroadcastCharlie(d, nacre::MakeCharlie(double{packet.At(0).roughness}));
    const auto write = [&](T Answer::*member, V value) {
      alignas(64) T lanes[kMaxLanes];
      hn::Store(value, d, lanes);
      for (size_t i = 0; i < hn::Lanes(d) && first + i < queries.size(); ++i) {
        (*answers)[first + i].*member = lanes[i];
      }
    };
    write(&Answer::distribution, CharlieDistribution(d, a, charlie.alpha));
    write(&Answer::sheen, CharlieLobe(d, charlie, a));
    const V cosine_lambda_v = CharlieCosineLambda(d, charlie, a.n_dot_v);
    write(&Answer::cosine_lambda_v, cosine_lambda_v);
    const V albedo_v = CharlieAlbedo(d, charlie, a.n_dot_v, cosine_lambda_v);
    const V albedo_l = CharlieAlbedo(d, charlie, a.n_dot_l);
    write(&Answer::sheen_albedo_v, albedo_v);
    write(&Answer::sheen_albedo_l, albedo_l);
    const SheenScaleV<V> scale =
        ScaleSheen(d, packet.Number(&Query::largest_channel), albedo_v, albedo_l);
    write(&Answer::sheen_scale, scale.lobe);
    write(&Answer::below_sheen, scale.below);
  }
}

void EvaluateFloatT(RoughnessOf roughness, const std::vector<LayerQuery<float>>& queries,
                    std::vector<LayerAnswer<float>>* answers) {
  Evaluate(roughness, queries, answers);
}
void EvaluateDoubleT(RoughnessOf roughness, const std::vector<LayerQuery<double>>& queries,
                     std::vector<LayerAnswer<double>>* answers) {
  Evaluate(roughness, queries, answers);
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
  std::vector<LayerAnswer<float>> answers(queries.size());
  HWY_DYNAMIC_DISPATCH(EvaluateFloatT)(roughness, queries, &answers);
  return answers;
}
template <>
std::vector<LayerAnswer<double>> EvaluateLayers(RoughnessOf roughness,
                                                const std::vector<LayerQuery<double>>& queries) {
  std::vector<LayerAnswer<double>> answers(queries.size());
  HWY_DYNAMIC_DISPATCH(EvaluateDoubleT)(roughness, queries, &answers);
  return answers;
}
}  // namespace nacre
#endif
