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
  struct View {};
  const MatteLight<Number> light;

  HWY_INLINE View SeenBy(FloatTag, const PacketV&, const Surface&) const { return {}; }
  HWY_INLINE DiffuseV Reflect(FloatTag d, const View&, const PacketV& p,
                              const IncidentV& in) const {
    return {ScaledPart(RgbAt(d, light.diffuse, p.i), in.weight)};
  }
};

template <DiffuseForm kForm, class Number>
struct RoughMatte {
  using Incident = IncidentV;
  using View = typename RoughDiffuse<kForm>::View;
  const MatteUniforms<Number> uniforms;  // a copy, which no store can alias

  HWY_INLINE View SeenBy(FloatTag d, const PacketV& p, const Surface&) const {
    return RoughDiffuse<kForm>::SeenBy(d, p);
  }
  HWY_INLINE DiffuseV Reflect(FloatTag d, const View& view, const PacketV& p,
                              const IncidentV& in) const {
    const FloatV roughness = NumberAt(d, uniforms.constants.roughness, p.i);
    const SpreadV spread = RoughDiffuse<kForm>::Spread(d, view, p, in, roughness);
    // At grazing light the spread grows as much as the weight falls: their product stays in range.
    const RgbV lambert = RgbAt(d, uniforms.light.diffuse, p.i);
    if constexpr (kForm == DiffuseForm::kBurley) {
      return {ScaledPart(lambert, hn::Mul(spread.single, in.weight))};
    } else {
      const RgbV by_color = SpreadRgb(spread, RgbAt(d, uniforms.constants.ratio, p.i));
      return {{lambert, ScaleRgb(by_color, in.weight)}};
    }
  }
};

template <class Number>
void ShadeMatteOf(const MatteUniforms<Number>& uniforms, const ShadeRange& range) {
  switch (uniforms.form) {
    case DiffuseForm::kLambert:
      return ShadePackets(FloatTag(), Lambert<Number>{uniforms.light}, range);
    case DiffuseForm::kOrenNayar:
      return ShadePackets(FloatTag(), RoughMatte<DiffuseForm::kOrenNayar, Number>{uniforms}, range);
    case DiffuseForm::kBurley:
      return ShadePackets(FloatTag(), RoughMatte<DiffuseForm::kBurley, Number>{uniforms}, range);
  }
}

void ShadeMatteT(const MatteUniforms<float>& uniforms, const ShadeRange& range) {
  ShadeMatteOf(uniforms, range);
}

void ShadeMatteMapsT(const MatteUniforms<float*>& uniforms, const ShadeRange& range) {
  ShadeMatteOf(uniforms, range);
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nacre {
HWY_EXPORT(ShadeMatteT);
HWY_EXPORT(ShadeMatteMapsT);
void ShadeMatte(const MatteUniforms<float>& uniforms, const ShadeRange& range) {
  HWY_DYNAMIC_DISPATCH(ShadeMatteT)(uniforms, range);
}
void ShadeMatte(const MatteUniforms<float*>& uniforms, const ShadeRange& range) {
  HWY_DYNAMIC_DISPATCH(ShadeMatteMapsT)(uniforms, range);
}
}  // namespace nacre
#endif
