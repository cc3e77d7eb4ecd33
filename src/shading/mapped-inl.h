// SPDX-License-Identifier: Apache-2.0
// shading/mapped-inl.h: what the kernels of materials with maps share: loops over the hits of a
// run, and what every material has of its colour.
#if defined(NACRE_SHADING_MAPPED_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_SHADING_MAPPED_INL_H_
#undef NACRE_SHADING_MAPPED_INL_H_
#else
#define NACRE_SHADING_MAPPED_INL_H_
#endif

#include <algorithm>
#include <cstddef>

#include "hwy/highway.h"

#include "brdf/eon.h"
#include "shading/texture_kernels.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {
namespace {

// One channel of hits [begin, end).
template <class T>
T* Channel(Soa3<T>& soa, int c) {
  return (c == 0 ? soa.x : c == 1 ? soa.y : soa.z).data();
}
template <class T>
const T* Channel(const Soa3<T>& soa, int c) {
  return (c == 0 ? soa.x : c == 1 ? soa.y : soa.z).data();
}

struct Hits {
  size_t begin, end;

  // to[i] = of(i).
  template <class T, class Of>
  HWY_INLINE void Fill(T* HWY_RESTRICT to, const Of& of) const {
    for (size_t i = begin; i < end; ++i) to[i] = static_cast<T>(of(i));
  }
};

HWY_INLINE void FillRgb(const Hits& hits, const Rgb& value, Soa3<double>* to) {
  for (int c = 0; c < 3; ++c)
    std::fill(Channel(*to, c) + hits.begin, Channel(*to, c) + hits.end, value[c]);
}

HWY_INLINE void FillNumber(const Hits& hits, double value, AlignedArray<double>* to) {
  std::fill(to->data() + hits.begin, to->data() + hits.end, value);
}

// What the layers of these names show: the albedo, and of the ambient light what a colour reflects.
HWY_INLINE void FinishLayers(const TexturedRun& run, const Rgb& of_albedo, const Rgb& of_ambient,
                             HitTextures* t) {
  const Hits hits{run.begin, run.end};
  for (int c = 0; c < 3; ++c) {
    const double* const color = Channel(t->diffuse, c);
    hits.Fill(Channel(t->albedo, c), [&](size_t i) { return color[i] * of_albedo[c]; });
    const double radiance = run.material.ambient_radiance[c];
    hits.Fill(Channel(t->ambient, c),
              [&](size_t i) { return color[i] * of_ambient[c] * radiance; });
  }
}

// EonMultipleRatio of the colours; roughness(i) is that of a hit.
template <class Roughness>
void FinishRatio(const TexturedRun& run, const Roughness& roughness, HitTextures* t) {
  for (int c = 0; c < 3; ++c) {
    const double* const color = Channel(t->diffuse, c);
    Hits{run.begin, run.end}.Fill(Channel(t->base_ratio, c), [&](size_t i) {
      return EonMultipleRatio(color[i], roughness(i));
    });
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();
#endif
