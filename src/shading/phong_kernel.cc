// SPDX-License-Identifier: Apache-2.0
// shading/phong_kernel.cc: Phong, modified Phong and Blinn-Phong.
#include <type_traits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shading/phong_kernel.cc"
#include "hwy/foreach_target.h"

#include "hwy/highway.h"

#include "brdf/phong-inl.h"
#include "shading/packets-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {

// Stores the light on a block's hits and the cosines of their lobes, in one loop, so that the
// direction to the light need not be loaded again.
HWY_NOINLINE void FillPhong(const LitHits& lit, size_t begin, size_t end, LobeBlock* block) {
  const FloatTag d;
  ForEachLit(d, lit, begin, end, [&](const PacketV& p, const LightV& light) HWY_ATTR {
    const auto& [offset, inverse_length] = light.toward;
    block->Store(d, p.i - begin, light, light.toward.Dot(p.normal));
    block->StoreLobe(
        d, p.i - begin,
        PhongCosine(d, SquaredFromReflection(p.normal, offset, inverse_length, p.to_view)));
  });
}

HWY_NOINLINE void FillBlinn(const LitHits& lit, size_t begin, size_t end, LobeBlock* block) {
  const FloatTag d;
  FillLight(lit, begin, end, block);
  ForHalfAngles(lit, begin, end, *block,
                [&](size_t at, const HalfAnglesV<FloatV>& half, FloatV)
                    HWY_ATTR { block->StoreLobe(d, at, BlinnSquaredCosine(d, half)); });
}

template <PhongModel kModel, class Number>
struct PhongFamily {
  using Incident = LobeIncidentV;
  const PhongUniforms<Number>& uniforms;

  // Whether cosines of wide lobes are needed. If all lobes have the same exponent, either all are
  // sharp, and their cosines are in uniforms.sharp, or none is.
  HWY_INLINE bool ReadsLobe() const {
    return !std::is_same_v<Number, float> || uniforms.sharp == nullptr;
  }

  HWY_INLINE FloatV Log2Cosine(FloatTag d, const PacketV& p, const Incident& in) const {
    const SharpLobeTerms* const sharp = uniforms.sharp;
    if (sharp == nullptr) return in.log2_cosine;
    const LobeCosineV<FloatV> exact{hn::LoadU(d, sharp->one_minus_cos.data() + p.i),
                                    hn::LoadU(d, sharp->cos.data() + p.i)};
    const FloatV log2 = LobeLog2(d, exact);
    if constexpr (std::is_same_v<Number, float>) return log2;
    const auto is_sharp = hn::Ge(exact.one_minus_c, hn::Zero(d));
    return hn::IfThenElse(is_sharp, log2, in.log2_cosine);
  }

  HWY_INLINE void FillLobe(const LitHits& lit, size_t begin, size_t end, LobeBlock* block) const {
    const auto fill = kModel == PhongModel::kBlinnPhong ? FillBlinn : FillPhong;
    fill(lit, begin, end, block);
  }

  HWY_INLINE ReflectedV Reflect(FloatTag d, const PacketV& p, const Incident& in) const {
    const FloatV log2 = Log2Cosine(d, p, in);
    const FloatV shininess = NumberAt(d, uniforms.constants.shininess, p.i);
    const FloatV lobe = kModel == PhongModel::kBlinnPhong ? LobePowerOfSquare(d, log2, shininess)
                                                          : LobePower(d, log2, shininess);
    // The irradiance is 0 where n.l <= 0, which cuts off the lobes that have no factor of n.l.
    const FloatV light = kModel == PhongModel::kModifiedPhong ? in.weight : in.irradiance;
    return {{ScaledPart(RgbAt(d, uniforms.light.diffuse, p.i), in.weight)},
            ScaledPart(RgbAt(d, uniforms.light.specular, p.i), hn::Mul(lobe, light))};
  }
};

template <class Number>
void ShadePhongOf(const PhongUniforms<Number>& uniforms, const LitHits& lit) {
  switch (uniforms.model) {
    case PhongModel::kPhong:
      return ShadePackets(FloatTag(), PhongFamily<PhongModel::kPhong, Number>{uniforms}, lit);
    case PhongModel::kModifiedPhong:
      return ShadePackets(FloatTag(), PhongFamily<PhongModel::kModifiedPhong, Number>{uniforms},
                          lit);
    case PhongModel::kBlinnPhong:
      return ShadePackets(FloatTag(), PhongFamily<PhongModel::kBlinnPhong, Number>{uniforms}, lit);
  }
}

constexpr auto& ShadePhongT = ShadePhongOf<float>;
constexpr auto& ShadePhongMapsT = ShadePhongOf<float*>;

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nacre {
HWY_EXPORT(ShadePhongT);
HWY_EXPORT(ShadePhongMapsT);
void ShadePhong(const PhongUniforms<float>& uniforms, const LitHits& lit) {
  HWY_DYNAMIC_DISPATCH(ShadePhongT)(uniforms, lit);
}
void ShadePhong(const PhongUniforms<float*>& uniforms, const LitHits& lit) {
  HWY_DYNAMIC_DISPATCH(ShadePhongMapsT)(uniforms, lit);
}
}  // namespace nacre
#endif
