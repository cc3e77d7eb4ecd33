// shading/lambert_kernel.cc: Lambert's cosine law.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shading/lambert_kernel.cc"
#include "hwy/foreach_target.h"

#include "hwy/highway.h"

#include "shading/range-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {

void ShadeLambertT(const LambertUniforms& uniforms, const ShadeRange& range) {
  const FloatTag d;
  const RgbV diffuse = SetRgb(d, uniforms.diffuse);
  ForEachPacket(d, range, [&](const LitPacket& p, size_t i, hn::Mask<FloatTag> mask) HWY_ATTR {
    const FloatV weight = hn::Mul(FusedDot(p.normal, p.to_light), p.irradiance);
    Accumulate(d, mask, ScaleRgb(diffuse, weight), i, &range.radiance->diffuse);
  });
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nacre {
HWY_EXPORT(ShadeLambertT);
void ShadeLambert(const LambertUniforms& uniforms, const ShadeRange& range) {
  HWY_DYNAMIC_DISPATCH(ShadeLambertT)(uniforms, range);
}
}  // namespace nacre
#endif
