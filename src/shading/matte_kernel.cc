// SPDX-License-Identifier: Apache-2.0
// shading/matte_kernel.cc: Lambert's cosine law, and rough matte surfaces: Oren-Nayar (EON) and
// Burley's.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shading/matte_kernel.cc"
#include "hwy/foreach_target.h"

#include "hwy/highway.h"

#include "shading/packets-inl.h"
#include "shading/rough_diffuse-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {

template <class Number>
struct Lambert {
  using Incident = IncidentV;
  const MatteLight<Number> light;

  HWY_INLINE DiffuseV Reflect(FloatTag d, const PacketV& p, const IncidentV& in) const {
    return {ScaledPart(RgbAt(d, light.diffuse, p.i), in.weight)};
  }
};

template <DiffuseForm kForm, class Number>
struct RoughMatte {
  using Incident = IncidentV;
  const MatteUniforms<Number> uniforms;  // a copy, which no store can alias

  HWY_INLINE DiffuseV Reflect(FloatTag d, const PacketV& p, const IncidentV& in) const {
    const FloatV roughness = NumberAt(d, uniforms.constants.roughness, p.i);
    const SpreadV spread = RoughSpread<kForm>(d, p, in, roughness);
    // At grazing light the spread grows as much as the weight falls: their product stays in range.
    const RgbV lambert = RgbAt(d, uniforms.light.diffuse, p.i);
    if constexpr (kForm == DiffuseForm::kBurley) {
      return {ScaledPart(lambert, hn::Mul(spread.single, in.weight))};
    } else {
      const RgbV by_color = SpreadRgb(spread, RgbAt(d, uniforms.constants.ratio, p.i));
      return {{lambert, Scale(by_color, in.weight)}};
    }
  }
};

template <class Number>
void ShadeMatteOf(const MatteUniforms<Number>& uniforms, const LitHits& lit) {
  switch (uniforms.form) {
    case DiffuseForm::kLambert:
      return ShadePackets(FloatTag(), Lambert<Number>{uniforms.light}, lit);
    case DiffuseForm::kOrenNayar:
      return ShadePackets(FloatTag(), RoughMatte<DiffuseForm::kOrenNayar, Number>{uniforms}, lit);
    case DiffuseForm::kBurley:
      return ShadePackets(FloatTag(), RoughMatte<DiffuseForm::kBurley, Number>{uniforms}, lit);
  }
}

constexpr auto& ShadeMatteT = ShadeMatteOf<float>;
constexpr auto& ShadeMatteMapsT = ShadeMatteOf<float*>;

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nacre {
HWY_EXPORT(ShadeMatteT);
HWY_EXPORT(ShadeMatteMapsT);
void ShadeMatte(const MatteUniforms<float>& uniforms, const LitHits& lit) {
  HWY_DYNAMIC_DISPATCH(ShadeMatteT)(uniforms, lit);
}
void ShadeMatte(const MatteUniforms<float*>& uniforms, const LitHits& lit) {
  HWY_DYNAMIC_DISPATCH(ShadeMatteMapsT)(uniforms, lit);
}
}  // namespace nacre
#endif
