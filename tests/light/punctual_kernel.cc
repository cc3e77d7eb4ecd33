// SPDX-License-Identifier: Apache-2.0
// tests/light/punctual_kernel.cc: the loops behind punctual_kernel.h.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "light/punctual_kernel.cc"
#include "hwy/foreach_target.h"

#include "hwy/highway.h"

#include "light/punctual-inl.h"
#include "light/punctual_kernel.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {

void EvaluateAttenuationT(const std::vector<AttenuationTerms<float>>& terms,
                          const std::vector<float>& distances, std::vector<float>* out) {
  const hn::ScalableTag<float> d;
  for (size_t i = 0; i < terms.size(); ++i) {
    (*out)[i] = hn::GetLane(AttenuationFactor(d, terms[i], hn::Set(d, distances[i])));
  }
}

void EvaluateSpotT(const std::vector<ConeTerms<float>>& cones, const std::vector<float>& cosines,
                   std::vector<float>* out) {
  const hn::ScalableTag<float> d;
  for (size_t i = 0; i < cones.size(); ++i) {
    (*out)[i] = hn::GetLane(SpotFactor(d, cones[i], hn::Set(d, cosines[i])));
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nacre {
HWY_EXPORT(EvaluateAttenuationT);
HWY_EXPORT(EvaluateSpotT);

std::vector<float> EvaluateAttenuation(const std::vector<AttenuationTerms<float>>& terms,
                                       const std::vector<float>& distances) {
  std::vector<float> out(terms.size());
  HWY_DYNAMIC_DISPATCH(EvaluateAttenuationT)(terms, distances, &out);
  return out;
}

std::vector<float> EvaluateSpot(const std::vector<ConeTerms<float>>& cones,
                                const std::vector<float>& cosines) {
  std::vector<float> out(cones.size());
  HWY_DYNAMIC_DISPATCH(EvaluateSpotT)(cones, cosines, &out);
  return out;
}
}  // namespace nacre
#endif
