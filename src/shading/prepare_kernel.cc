// SPDX-License-Identifier: Apache-2.0
// shading/prepare_kernel.cc: terms of microfacet materials that do not depend on the light: the
// weight of multiple scattering and the base's share of the light, computed once per hit.
#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shading/prepare_kernel.cc"
#include "hwy/foreach_target.h"

#include "hwy/highway.h"

#include "brdf/ggx_anisotropic-inl.h"
#include "shading/microfacet_albedo-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {

// Stores at most `count` lanes, because a packet may extend into the next run.
HWY_INLINE void StoreLanes(FloatTag d, size_t count, FloatV value, float* to) {
  if (count >= hn::Lanes(d)) {
    hn::StoreU(value, d, to);
  } else {
    hn::BlendedStore(value, hn::FirstN(d, count), d, to);
  }
}

// The weight of multiple scattering. Kulla and Conty's includes the scale of their lobe,
// 1 / (pi (1 - E_avg)): for a smooth surface, that times a light would leave float's range before
// the small losses bring it back.
HWY_INLINE FloatV Multiple(FloatTag d, Compensation compensation, const AlbedoV& albedo,
                           FloatV scale) {
  switch (compensation) {
    case Compensation::kTurquin:
      return hn::Mul(albedo.loss, Reciprocal(d, albedo.one));
    case Compensation::kKullaConty:
      return hn::Mul(albedo.loss, scale);
    case Compensation::kNone:
      break;
  }
  return hn::Zero(d);
}

// The variables and the albedo of hits i..., by the model's fit or by that of each hit.
template <class Number>
HWY_INLINE AlbedoVariablesV<FloatV> VariablesAt(FloatTag d,
                                                const MicrofacetNumbers<Number>& numbers, size_t i,
                                                FloatV n_dot_v) {
  const MicrofacetModel& model = numbers.model;
  if (numbers.fit == nullptr) return ComputeAlbedoVariables(d, model.albedo.lobe.shape, n_dot_v);
  return ComputeAlbedoVariables(d, FitAt(numbers.fit, i, model.shadowing).shape, n_dot_v);
}
template <class Number>
HWY_INLINE AlbedoV AlbedoAt(FloatTag d, const MicrofacetNumbers<Number>& numbers, size_t i,
                            const AlbedoVariablesV<FloatV>& x) {
  const MicrofacetModel& model = numbers.model;
  const FloatV f90 = NumberAt(d, numbers.dielectric_f90, i);
  if (numbers.fit == nullptr) return EvaluateAlbedo(d, model, model.albedo.lobe, f90, x);
  return EvaluateAlbedo(d, model, FitAt(numbers.fit, i, model.shadowing), f90, x);
}

// The intermediate results of a block of hits: the albedo is a long chain of dependent operations,
// which is cut into several loops as shading is (packets-inl.h).
struct AlbedoBlock {
  static constexpr size_t kHits = 128;  // a multiple of every target's lanes
  alignas(64) float z[kHits], n_dot_v[kHits], factor[kHits];
  alignas(64) float one[kHits], loss[kHits], scale[kHits], bias[3][kHits];

  HWY_INLINE void Store(FloatTag d, size_t at, const AlbedoVariablesV<FloatV>& x) {
    hn::Store(x.z, d, z + at);
    hn::Store(x.n_dot_v, d, n_dot_v + at);
    hn::Store(x.factor, d, factor + at);
  }
  HWY_INLINE AlbedoVariablesV<FloatV> Variables(FloatTag d, size_t at) const {
    return {hn::Load(d, z + at), hn::Load(d, n_dot_v + at), hn::Load(d, factor + at)};
  }
  HWY_INLINE void Store(FloatTag d, size_t at, const AlbedoV& albedo) {
    hn::Store(albedo.one, d, one + at);
    hn::Store(albedo.loss, d, loss + at);
    hn::Store(albedo.scale, d, scale + at);
    hn::Store(albedo.bias.x, d, bias[0] + at);
    hn::Store(albedo.bias.y, d, bias[1] + at);
    hn::Store(albedo.bias.z, d, bias[2] + at);
  }
  HWY_INLINE AlbedoV Albedo(FloatTag d, size_t at) const {
    return {hn::Load(d, one + at),
            hn::Load(d, loss + at),
            hn::Load(d, scale + at),
            {hn::Load(d, bias[0] + at), hn::Load(d, bias[1] + at), hn::Load(d, bias[2] + at)}};
  }
};

template <class Number>
HWY_INLINE void FillVariables(const MicrofacetNumbers<Number>& numbers, size_t begin, size_t end,
                              const Surface& surface, AlbedoBlock* block) {
  const FloatTag d;
  const auto normal = PointersTo(surface.normal), to_view = PointersTo(surface.to_view);
  for (size_t i = begin; i < end; i += hn::Lanes(d)) {
    const FloatV n_dot_v = FusedDot(LoadAt(d, normal, i), LoadAt(d, to_view, i));
    block->Store(d, i - begin, VariablesAt(d, numbers, i, n_dot_v));
  }
}

template <class Number>
HWY_INLINE void FillAlbedos(const MicrofacetNumbers<Number>& numbers, size_t begin, size_t end,
                            AlbedoBlock* block) {
  const FloatTag d;
  for (size_t i = begin; i < end; i += hn::Lanes(d)) {
    block->Store(d, i - begin, AlbedoAt(d, numbers, i, block->Variables(d, i - begin)));
  }
}

// Both steps for anisotropic lobes, which are few.
template <class Number>
HWY_INLINE void FillAnisotropic(const MicrofacetNumbers<Number>& numbers, size_t begin, size_t end,
                                const Surface& surface, AlbedoBlock* block) {
  const FloatTag d;
  const auto normal = PointersTo(surface.normal), to_view = PointersTo(surface.to_view);
  for (size_t i = begin; i < end; i += hn::Lanes(d)) {
    const BasisV<FloatV> frame = LobeFrame(d, LoadAt(d, normal, i), LoadSoa(d, surface.tangent, i));
    const Vec3V<FloatV> view = ToLocal(frame, LoadAt(d, to_view, i));
    const FloatV f90 = NumberAt(d, numbers.dielectric_f90, i);
    block->Store(d, i - begin,
                 EvaluateAlbedo(d, numbers.model, numbers.lobes, i, f90,
                                LobeCosinesV{view.z, view.x, view.y}));
  }
}

// kScaled is true for DiffuseCoupling::kAlbedoScaled; other couplings do not read
// Surface::transmittance. F0 and F_ms are those of the dielectric, which covers the base.
template <bool kScaled, class Number>
HWY_INLINE void PrepareBlock(const MicrofacetNumbers<Number>& numbers, size_t begin, size_t end,
                             const AlbedoBlock& block, Surface* surface) {
  const FloatTag d;
  float* const HWY_RESTRICT multiples = surface->multiple.data();
  float* const base[3] = {surface->transmittance.x.data(), surface->transmittance.y.data(),
                          surface->transmittance.z.data()};
  const Compensation compensation = numbers.model.compensation;
  const bool has_cover = HasCover(numbers.model.fresnel);
  for (size_t i = begin; i < end; i += hn::Lanes(d)) {
    const AlbedoV albedo = block.Albedo(d, i - begin);
    const FloatV multiple = Multiple(d, compensation, albedo, NumberAt(d, numbers.multiple, i));
    StoreLanes(d, end - i, multiple, multiples + i);
    if constexpr (!kScaled) continue;
    for (int c = 0; c < 3; ++c) {
      const FloatV f0 = NumberAt(d, numbers.dielectric_f0[c], i);
      const FloatV bias = hn::Load(d, block.bias[c] + (i - begin));
      const FloatV cover = has_cover ? NumberAt(d, numbers.cover[c], i) : hn::Set(d, 1.0f);
      const FloatV left =
          compensation == Compensation::kKullaConty
              ? KullaContyBase(d, albedo, bias, f0,
                               NumberAt(d, numbers.dielectric_f_multiple[c], i), cover)
              : TurquinBase(d, albedo, bias, f0, multiple, cover);
      StoreLanes(d, end - i, left, base[c] + i);
    }
  }
}

template <class Number>
void PrepareRange(const MicrofacetNumbers<Number>& numbers, size_t begin, size_t end,
                  Surface* surface) {
  const bool scaled = numbers.model.coupling == DiffuseCoupling::kAlbedoScaled;
  AlbedoBlock block;
  for (; begin < end; begin += AlbedoBlock::kHits) {
    const size_t block_end = std::min(begin + AlbedoBlock::kHits, end);
    if (numbers.lobes.first != nullptr) {
      FillAnisotropic(numbers, begin, block_end, *surface, &block);
    } else {
      FillVariables(numbers, begin, block_end, *surface, &block);
      FillAlbedos(numbers, begin, block_end, &block);
    }
    if (scaled) {
      PrepareBlock<true>(numbers, begin, block_end, block, surface);
    } else {
      PrepareBlock<false>(numbers, begin, block_end, block, surface);
    }
  }
}
constexpr auto& PrepareMicrofacetT = PrepareRange<float>;
constexpr auto& PrepareMicrofacetMapsT = PrepareRange<float*>;

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nacre {
HWY_EXPORT(PrepareMicrofacetT);
HWY_EXPORT(PrepareMicrofacetMapsT);
void PrepareMicrofacet(const MicrofacetNumbers<float>& numbers, size_t begin, size_t end,
                       Surface* surface) {
  HWY_DYNAMIC_DISPATCH(PrepareMicrofacetT)(numbers, begin, end, surface);
}
void PrepareMicrofacet(const MicrofacetNumbers<float*>& numbers, size_t begin, size_t end,
                       Surface* surface) {
  HWY_DYNAMIC_DISPATCH(PrepareMicrofacetMapsT)(numbers, begin, end, surface);
}
}  // namespace nacre
#endif
