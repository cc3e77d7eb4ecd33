// SPDX-License-Identifier: Apache-2.0
// shading/conductor_kernel.cc: GGX with the exact Fresnel equations of a conductor.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shading/conductor_kernel.cc"
#include "hwy/foreach_target.h"

#include "hwy/highway.h"

#include "shading/microfacet_kernel-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {

void ShadeConductorT(const MicrofacetUniforms<float>& uniforms, const ShadeRange& range) {
  ShadeMicrofacet<FresnelForm::kConductor>(uniforms, range);
}

// For materials with maps.
void ShadeConductorMapsT(const MicrofacetUniforms<float*>& uniforms, const ShadeRange& range) {
  ShadeMicrofacet<FresnelForm::kConductor>(uniforms, range);
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nacre {
HWY_EXPORT(ShadeConductorT);
HWY_EXPORT(ShadeConductorMapsT);

void ShadeConductor(const MicrofacetUniforms<float>& uniforms, const ShadeRange& range) {
  HWY_DYNAMIC_DISPATCH(ShadeConductorT)(uniforms, range);
}

void ShadeConductor(const MicrofacetUniforms<float*>& uniforms, const ShadeRange& range) {
  HWY_DYNAMIC_DISPATCH(ShadeConductorMapsT)(uniforms, range);
}
}  // namespace nacre
#endif
