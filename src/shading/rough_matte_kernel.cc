// SPDX-License-Identifier: Apache-2.0
// shading/rough_matte_kernel.cc: rough matte surfaces: Oren-Nayar (EON) and Burley's.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shading/rough_matte_kernel.cc"
#include "hwy/foreach_target.h"

#include "hwy/highway.h"

#include "shading/packets-inl.h"
#include "shading/rough_diffuse-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {

template <DiffuseForm kForm, class Number>
struct RoughMatte {
  static constexpr bool kReadsIrradiance = false;
  using Incident = IncidentV;
  using View = typename RoughDiffuse<kForm>::View;
  const RoughMatteUniformsOf<Number> uniforms;  // a copy: nothing that a kernel stores is in it

  HWY_INLINE View SeenBy(FloatTag d, const PacketV& p, const Surface&) const {
    return RoughDiffuse<kForm>::SeenBy(d, p);
  }
  HWY_INLINE DiffuseV Reflect(FloatTag d, const View& view, const PacketV& p, const IncidentV& in,
                              size_t k) const {
    const FloatV roughness = hn::Set(d, uniforms.roughness);
    const SpreadV spread = RoughDiffuse<kForm>::Spread(d, view, p, in, roughness);
    // Grazing light spreads by as much more as its weight is less: their product stays in range.
    const RgbV lambert = RgbAt(d, uniforms.lights[k].diffuse, p.i);
    if constexpr (kForm == DiffuseForm::kBurley) {
      return {ScaledPart(lambert, hn::Mul(spread.single, in.weight))};
    } else {
      const RgbV by_color = SpreadRgb(spread, RgbAt(d, uniforms.ratio, p.i));
      return {{lambert, ScaleRgb(by_color, in.weight)}};
    }
  }
};

template <class Number>
void ShadeRoughMatteOf(const RoughMatteUniformsOf<Number>& uniforms, const ShadeRange& range) {
  if (uniforms.form == DiffuseForm::kBurley) {
    ShadePackets(FloatTag(), RoughMatte<DiffuseForm::kBurley, Number>{uniforms}, range);
  } else {
    ShadePackets(FloatTag(), RoughMatte<DiffuseForm::kOrenNayar, Number>{uniforms}, range);
  }
}

void ShadeRoughMatteT(const RoughMatteUniforms& uniforms, const ShadeRange& range) {
  ShadeRoughMatteOf(uniforms, range);
}

void ShadeRoughMatteMapsT(const RoughMatteUniformsOf<const float*>& uniforms,
                          const ShadeRange& range) {
  ShadeRoughMatteOf(uniforms, range);
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nacre {
HWY_EXPORT(ShadeRoughMatteT);
HWY_EXPORT(ShadeRoughMatteMapsT);
void ShadeRoughMatte(const RoughMatteUniforms& uniforms, const ShadeRange& range) {
  HWY_DYNAMIC_DISPATCH(ShadeRoughMatteT)(uniforms, range);
}
void ShadeRoughMatteMaps(const RoughMatteUniformsOf<const float*>& uniforms,
                         const ShadeRange& range) {
  HWY_DYNAMIC_DISPATCH(ShadeRoughMatteMapsT)(uniforms, range);
}
}  // namespace nacre
#endif
