// SPDX-License-Identifier: Apache-2.0
// shading/metallic_roughness_kernel.cc: GGX with Schlick's Fresnel curve, or with the F82 curve,
// which adds the dip of real metals before grazing incidence.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shading/metallic_roughness_kernel.cc"
#include "hwy/foreach_target.h"

#include "hwy/highway.h"

#include "shading/microfacet_kernel-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {

void ShadeSchlickT(const MicrofacetUniforms<float>& uniforms, const ShadeRange& range) {
  ShadeMicrofacet<FresnelForm::kSchlick>(uniforms, range);
}

void ShadeF82T(const MicrofacetUniforms<float>& uniforms, const ShadeRange& range) {
  ShadeMicrofacet<FresnelForm::kF82>(uniforms, range);
}

// For materials with maps.
void ShadeSchlickMapsT(const MicrofacetUniforms<float*>& uniforms, const ShadeRange& range) {
  ShadeMicrofacet<FresnelForm::kSchlick>(uniforms, range);
}

void ShadeF82MapsT(const MicrofacetUniforms<float*>& uniforms, const ShadeRange& range) {
  ShadeMicrofacet<FresnelForm::kF82>(uniforms, range);
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nacre {
HWY_EXPORT(ShadeSchlickT);
HWY_EXPORT(ShadeF82T);
HWY_EXPORT(ShadeSchlickMapsT);
HWY_EXPORT(ShadeF82MapsT);

void ShadeSchlick(const MicrofacetUniforms<float>& uniforms, const ShadeRange& range) {
  HWY_DYNAMIC_DISPATCH(ShadeSchlickT)(uniforms, range);
}

void ShadeF82(const MicrofacetUniforms<float>& uniforms, const ShadeRange& range) {
  HWY_DYNAMIC_DISPATCH(ShadeF82T)(uniforms, range);
}

void ShadeSchlick(const MicrofacetUniforms<float*>& uniforms, const ShadeRange& range) {
  HWY_DYNAMIC_DISPATCH(ShadeSchlickMapsT)(uniforms, range);
}

void ShadeF82(const MicrofacetUniforms<float*>& uniforms, const ShadeRange& range) {
  HWY_DYNAMIC_DISPATCH(ShadeF82MapsT)(uniforms, range);
}
}  // namespace nacre
#endif
