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
void SpreadByForm(Number roughness, const LitHits& lit, BaseSpread* to) {
  const FloatTag d;
  ForEachLit(d, lit, lit.begin, lit.end, [&](const PacketV& p, const LightV& light) HWY_ATTR {
    const IncidentV in = MakeIncident(d, light, p.normal);
    const SpreadV spread = RoughSpread<kForm>(d, p, in, NumberAt(d, roughness, p.i));
    hn::StoreU(spread.single, d, to->single.data() + p.i);
    hn::StoreU(spread.multiple, d, to->multiple.data() + p.i);
  });
}

template <class Number>
void SpreadOf(DiffuseForm form, Number roughness, const LitHits& lit, BaseSpread* to) {
  const auto spread = form == DiffuseForm::kBurley ? SpreadByForm<DiffuseForm::kBurley, Number>
                                                   : SpreadByForm<DiffuseForm::kOrenNayar, Number>;
  spread(roughness, lit, to);
}
constexpr auto& SpreadBaseT = SpreadOf<float>;
constexpr auto& SpreadBaseMapsT = SpreadOf<const float*>;

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nacre {
HWY_EXPORT(SpreadBaseT);
HWY_EXPORT(SpreadBaseMapsT);
void SpreadBase(DiffuseForm form, float roughness, const LitHits& lit, BaseSpread* to) {
  HWY_DYNAMIC_DISPATCH(SpreadBaseT)(form, roughness, lit, to);
}
void SpreadBase(DiffuseForm form, const float* roughness, const LitHits& lit, BaseSpread* to) {
  HWY_DYNAMIC_DISPATCH(SpreadBaseMapsT)(form, roughness, lit, to);
}
}  // namespace nacre
#endif
