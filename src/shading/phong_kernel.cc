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
void ShadePhongModel(const PhongUniforms& uniforms, const ShadeRange& range) {
  const FloatTag d;
  const RgbV diffuse = SetRgb(d, uniforms.diffuse);
  const RgbV specular = SetRgb(d, uniforms.specular);
  const FloatV shininess = hn::Set(d, uniforms.shininess);
  const NarrowLobes* const narrow = uniforms.narrow;
  ForEachPacket(d, range, [&](const LitPacket& p, size_t i, hn::Mask<FloatTag> mask) HWY_ATTR {
    const FloatV weight = hn::Mul(FusedDot(p.normal, p.to_light), p.irradiance);
    LobeCosineV<FloatV> cosine;
    if (narrow != nullptr) {
      cosine = {hn::LoadU(d, narrow->first.data() + i), hn::LoadU(d, narrow->second.data() + i)};
    } else if constexpr (kModel == PhongModel::kBlinnPhong) {
      cosine = BlinnSquaredCosine(d, ComputeAngles(d, p.normal, p.to_light, p.to_view));
    } else {
      cosine = PhongCosine(d, p.normal, p.to_light, p.to_view);
    }
    const FloatV lobe = kModel == PhongModel::kBlinnPhong ? BlinnLobe(d, cosine, shininess)
                                                          : PhongLobe(d, cosine, shininess);
    // The irradiance is 0 where n.l <= 0: that gates the lobes without a cosine of their own.
    const FloatV light = kModel == PhongModel::kModifiedPhong ? weight : p.irradiance;
    Accumulate(d, mask, ScaleRgb(diffuse, weight), i, &range.radiance->diffuse);
    Accumulate(d, mask, ScaleRgb(specular, hn::Mul(lobe, light)), i, &range.radiance->specular);
  });
}

void ShadePhongT(const PhongUniforms& uniforms, const ShadeRange& range) {
  switch (uniforms.model) {
    case PhongModel::kPhong:
      return ShadePhongModel<PhongModel::kPhong>(uniforms, range);
    case PhongModel::kModifiedPhong:
      return ShadePhongModel<PhongModel::kModifiedPhong>(uniforms, range);
    case PhongModel::kBlinnPhong:
      return ShadePhongModel<PhongModel::kBlinnPhong>(uniforms, range);
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
