// SPDX-License-Identifier: Apache-2.0
// shading/rough_base_kernel.cc: the factors of rough diffuse bases of microfacet materials
// (BaseSpread), computed before the kernel of the lobe runs. Few bases are rough, so the kernels of
// lobes are not burdened with them.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shading/rough_base_kernel.cc"
#include "hwy/foreach_target.h"

#include "hwy/highway.h"

#include "shading/rough_diffuse-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {
namespace {

template <DiffuseForm kForm, class Number>
void SpreadOf(Number roughness, const ShadeRange& range, BaseSpread* to) {
  const FloatTag d;
  ForEachLit(d, range, range.begin, range.end, [&](const PacketV& p, const LightV& light) HWY_ATTR {
    const auto view = RoughDiffuse<kForm>::SeenBy(d, p);
    const IncidentV in = MakeIncident(d, light, p.normal);
    const SpreadV spread = RoughDiffuse<kForm>::Spread(d, view, p, in, NumberAt(d, roughness, p.i));
    hn::StoreU(spread.single, d, to->single.data() + p.i);
    hn::StoreU(spread.multiple, d, to->multiple.data() + p.i);
  });
}

template <class Number>
void SpreadOf(DiffuseForm form, Number roughness, const ShadeRange& range, BaseSpread* to) {
  if (form == DiffuseForm::kBurley) {
    SpreadOf<DiffuseForm::kBurley>(roughness, range, to);
  } else {
    SpreadOf<DiffuseForm::kOrenNayar>(roughness, range, to);
  }
}

void SpreadBaseT(DiffuseForm form, float roughness, const ShadeRange& range, BaseSpread* to) {
  SpreadOf(form, roughness, range, to);
}

void SpreadBaseMapsT(DiffuseForm form, const float* roughness, const ShadeRange& range,
                     BaseSpread* to) {
  SpreadOf(form, roughness, range, to);
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nacre {
HWY_EXPORT(SpreadBaseT);
HWY_EXPORT(SpreadBaseMapsT);
void SpreadBase(DiffuseForm form, float roughness, const ShadeRange& range, BaseSpread* to) {
  HWY_DYNAMIC_DISPATCH(SpreadBaseT)(form, roughness, range, to);
}
void SpreadBase(DiffuseForm form, const float* roughness, const ShadeRange& range, BaseSpread* to) {
  HWY_DYNAMIC_DISPATCH(SpreadBaseMapsT)(form, roughness, range, to);
}
}  // namespace nacre
#endif
