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
  const FloatTag d;
  const auto normal = PointersTo(surface->normal), to_view = PointersTo(surface->to_view);
  AlbedoBlock block;
  block.with_curve = scaled;
  for (; begin < end; begin += AlbedoBlock::kHits) {
    const size_t block_end = std::min(begin + AlbedoBlock::kHits, end);
    if (numbers.lobes.first != nullptr) {
      const auto cosines = [&](size_t i) HWY_ATTR {
        const BasisV<FloatV> frame =
            LobeFrame(d, LoadAt(d, normal, i), LoadSoa(d, surface->tangent, i));
        const Vec3V<FloatV> view = ToLocal(frame, LoadAt(d, to_view, i));
        return LobeCosinesV{view.z, view.x, view.y};
      };
      FillAnisotropic(numbers, begin, block_end, cosines, &block);
    } else {
      const auto n_dot_v = [&](size_t i) HWY_ATTR {
        return FusedDot(LoadAt(d, normal, i), LoadAt(d, to_view, i));
      };
      FillAlbedos(numbers, begin, block_end, n_dot_v, &block);
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
