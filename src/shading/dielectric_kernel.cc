// SPDX-License-Identifier: Apache-2.0
// shading/dielectric_kernel.cc: GGX with the exact Fresnel equations of a dielectric.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shading/dielectric_kernel.cc"
#include "hwy/foreach_target.h"

#include "hwy/highway.h"

#include "shading/microfacet_kernel-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {

void ShadeDielectricT(const MicrofacetUniforms<float>& uniforms, const ShadeRange& range) {
  ShadeMicrofacet<FresnelForm::kDielectric>(uniforms, range);
}

// For materials with maps.
void ShadeDielectricMapsT(const MicrofacetUniforms<float*>& uniforms, const ShadeRange& range) {
  ShadeMicrofacet<FresnelForm::kDielectric>(uniforms, range);
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nacre {
HWY_EXPORT(ShadeDielectricT);
HWY_EXPORT(ShadeDielectricMapsT);

void ShadeDielectric(const MicrofacetUniforms<float>& uniforms, const ShadeRange& range) {
  HWY_DYNAMIC_DISPATCH(ShadeDielectricT)(uniforms, range);
}

void ShadeDielectric(const MicrofacetUniforms<float*>& uniforms, const ShadeRange& range) {
  HWY_DYNAMIC_DISPATCH(ShadeDielectricMapsT)(uniforms, range);
}
}  // namespace nacre
#endif
