// shading/phong_kernel.cc: Phong, modified Phong and Blinn-Phong.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shading/phong_kernel.cc"
#include "hwy/foreach_target.h"

#include "hwy/highway.h"

#include "brdf/phong-inl.h"
#include "shading/range-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {

template <PhongModel kModel>
struct PhongFamily {
  static constexpr bool kHasSpecular = true;
  struct View {};
  const PhongUniforms& uniforms;

  HWY_INLINE View SeenBy(FloatTag, const PacketV&, const Surface&) const { return {}; }

  HWY_INLINE LobeCosineV<FloatV> Cosine(FloatTag d, const PacketV& p, const IncidentV& in) const {
    const NarrowLobes* const narrow = uniforms.narrow;
    if (narrow != nullptr) {
      return {hn::LoadU(d, narrow->first.data() + p.i), hn::LoadU(d, narrow->second.data() + p.i)};
    }
    if constexpr (kModel == PhongModel::kBlinnPhong) {
      return BlinnSquaredCosine(d, ComputeAngles(d, p.normal, in.to_light, p.to_view));
    } else {
      return PhongCosine(d, p.normal, in.to_light, p.to_view);
    }
  }

  HWY_INLINE RadianceV Reflect(FloatTag d, const View&, const PacketV& p, const IncidentV& in,
                               size_t k) const {
    const LobeCosineV<FloatV> cosine = Cosine(d, p, in);
    const FloatV shininess = hn::Set(d, uniforms.shininess);
    const FloatV lobe = kModel == PhongModel::kBlinnPhong ? BlinnLobe(d, cosine, shininess)
                                                          : PhongLobe(d, cosine, shininess);
    // The irradiance is 0 where n.l <= 0: that gates the lobes without a cosine of their own.
    const FloatV light = kModel == PhongModel::kModifiedPhong ? in.weight : in.irradiance;
    const PhongLight& by = uniforms.lights[k];
    return {ScaleRgb(SetRgb(d, by.diffuse), in.weight),
            ScaleRgb(SetRgb(d, by.specular), hn::Mul(lobe, light))};
  }
};

void ShadePhongT(const PhongUniforms& uniforms, const ShadeRange& range) {
  switch (uniforms.model) {
    case PhongModel::kPhong:
      return ShadePackets(FloatTag(), PhongFamily<PhongModel::kPhong>{uniforms}, range);
    case PhongModel::kModifiedPhong:
      return ShadePackets(FloatTag(), PhongFamily<PhongModel::kModifiedPhong>{uniforms}, range);
    case PhongModel::kBlinnPhong:
      return ShadePackets(FloatTag(), PhongFamily<PhongModel::kBlinnPhong>{uniforms}, range);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nacre {
HWY_EXPORT(ShadePhongT);
void ShadePhong(const PhongUniforms& uniforms, const ShadeRange& range) {
  HWY_DYNAMIC_DISPATCH(ShadePhongT)(uniforms, range);
}
}  // namespace nacre
#endif
