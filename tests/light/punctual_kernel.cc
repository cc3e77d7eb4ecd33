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

void EvaluateSpotT(const std::vector<ConeTerms<double>>& cones,
                   const std::vector<double>& one_minus_cosines, std::vector<float>* out) {
  const hn::ScalableTag<float> d;
  const hn::ScalableTag<double> dd;
  for (size_t i = 0; i < cones.size(); ++i) {
    const double x = one_minus_cosines[i];
    const double t = hn::GetLane(PenumbraParameter(dd, cones[i], hn::Set(dd, x)));
    const auto set = [&](double value) HWY_ATTR { return hn::Set(d, static_cast<float>(value)); };
    (*out)[i] = hn::GetLane(SpotFactor(d, cones[i], set(t), set(x), set(1 - x)));
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

std::vector<float> EvaluateSpot(const std::vector<ConeTerms<double>>& cones,
                                const std::vector<double>& one_minus_cosines) {
  std::vector<float> out(cones.size());
  HWY_DYNAMIC_DISPATCH(EvaluateSpotT)(cones, one_minus_cosines, &out);
  return out;
}
}  // namespace nacre
#endif
