// render/film_kernel.cc: the kernels of film_kernel.h.
#include "render/film_kernel.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/film_kernel.cc"
#include "hwy/foreach_target.h"

#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::ScalableTag<double>;
using V = hn::Vec<D>;
using F = hn::Rebind<float, D>;

void AddSamplesT(const double* values, const double* weights, int samples, size_t pixels,
                 bool first, double* sums) {
  const D d;
  for (size_t p = 0; p < pixels; p += hn::Lanes(d)) {
    V sum = first ? hn::Zero(d) : hn::Load(d, sums + p);
    const double* value = values + p;
    for (int s = 0; s < samples; ++s, value += pixels) {
      sum = hn::Add(sum, hn::Mul(hn::Set(d, weights[s]), hn::LoadU(d, value)));
    }
    hn::Store(sum, d, sums + p);
  }
}

void RoundSumsT(const double* sums, double scale, size_t count, float* out) {
  const D d;
  const V factor = hn::Set(d, scale);
  size_t i = 0;
  for (; i + hn::Lanes(d) <= count; i += hn::Lanes(d)) {
    hn::StoreU(hn::DemoteTo(F(), hn::Mul(hn::LoadU(d, sums + i), factor)), F(), out + i);
  }
  for (; i < count; ++i) out[i] = static_cast<float>(sums[i] * scale);
}

void AddFloatsT(const float* a, const float* b, double constant, double further, size_t begin,
                size_t end, double* to) {
  const D d;
  const V first = hn::Set(d, constant);
  const V second = hn::Set(d, further);
  for (size_t i = begin; i < end; i += hn::Lanes(d)) {
    const V sum =
        hn::Add(hn::PromoteTo(d, hn::LoadU(F(), a + i)), hn::PromoteTo(d, hn::LoadU(F(), b + i)));
    hn::StoreU(hn::Add(hn::Add(sum, first), second), d, to + i);
  }
}

void AddFloatsByHitT(const FloatsToAdd& floats, size_t begin, size_t end, double* to) {
  const D d;
  const auto load = [&](const float* from, size_t i)
                        HWY_ATTR { return hn::PromoteTo(d, hn::LoadU(F(), from + i)); };
  for (size_t i = begin; i < end; i += hn::Lanes(d)) {
    const V sum = hn::Add(load(floats.a, i), load(floats.b, i));
    hn::StoreU(hn::Add(hn::Add(sum, load(floats.constant, i)), load(floats.further, i)), d, to + i);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nacre {
HWY_EXPORT(AddSamplesT);
HWY_EXPORT(RoundSumsT);
HWY_EXPORT(AddFloatsT);
HWY_EXPORT(AddFloatsByHitT);

void AddSamples(const double* values, const double* weights, int samples, size_t pixels, bool first,
                double* sums) {
  HWY_DYNAMIC_DISPATCH(AddSamplesT)(values, weights, samples, pixels, first, sums);
}

void RoundSums(const double* sums, double scale, size_t count, float* out) {
  HWY_DYNAMIC_DISPATCH(RoundSumsT)(sums, scale, count, out);
}

void AddFloats(const float* a, const float* b, double constant, double further, size_t begin,
               size_t end, double* to) {
  HWY_DYNAMIC_DISPATCH(AddFloatsT)(a, b, constant, further, begin, end, to);
}

void AddFloats(const FloatsToAdd& floats, size_t begin, size_t end, double* to) {
  HWY_DYNAMIC_DISPATCH(AddFloatsByHitT)(floats, begin, end, to);
}
}  // namespace nacre
#endif
