// SPDX-License-Identifier: Apache-2.0
// tests/color/tone_kernel.cc: the loop over arrays behind tone_kernel.h.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "color/tone_kernel.cc"
#include "hwy/foreach_target.h"

#include <cmath>

#include "hwy/highway.h"

#include "base/aligned.h"
#include "color/tone-inl.h"
#include "color/tone_kernel.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {

// r, g and b hold a whole number of the widest vectors.
template <class Tone>
void ToneLoop(const Tone& tone, float scale, size_t count, float* r, float* g, float* b) {
  const hn::ScalableTag<float> d;
  for (size_t i = 0; i < count; i += hn::Lanes(d)) {
    auto red = hn::Mul(hn::LoadU(d, r + i), hn::Set(d, scale));
    auto green = hn::Mul(hn::LoadU(d, g + i), hn::Set(d, scale));
    auto blue = hn::Mul(hn::LoadU(d, b + i), hn::Set(d, scale));
    tone(d, red, green, blue);
    hn::StoreU(red, d, r + i);
    hn::StoreU(green, d, g + i);
    hn::StoreU(blue, d, b + i);
  }
}

void ToneLightT(const DisplaySettings& settings, size_t count, float* r, float* g, float* b) {
  const float scale = static_cast<float>(std::exp2(settings.exposure_ev));
  const auto run = [&](const auto& tone) HWY_ATTR { ToneLoop(tone, scale, count, r, g, b); };
  switch (settings.tone) {
    case ToneOperator::kNeutral:
      return run(NeutralTone());
    case ToneOperator::kReinhard:
      return run(ReinhardTone());
    case ToneOperator::kReinhardExtended:
      return run(ReinhardExtendedTone{ReinhardExtendedCurve(settings.white)});
    case ToneOperator::kAces:
      return run(AcesTone());
    case ToneOperator::kAgx:
      return run(AgxTone());
    case ToneOperator::kNone:
      return run(NoneTone());
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nacre {
HWY_EXPORT(ToneLightT);
void ToneLight(const DisplaySettings& settings, std::vector<float>* r, std::vector<float>* g,
               std::vector<float>* b) {
  const size_t count = r->size();
  for (std::vector<float>* plane : {r, g, b}) plane->resize(RoundUp(count, kBatchPadding));
  HWY_DYNAMIC_DISPATCH(ToneLightT)(settings, r->size(), r->data(), g->data(), b->data());
  for (std::vector<float>* plane : {r, g, b}) plane->resize(count);
}
}  // namespace nacre
#endif
