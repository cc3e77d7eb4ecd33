// SPDX-License-Identifier: Apache-2.0
// shading/lambert_kernel.cc: Lambert's cosine law.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shading/lambert_kernel.cc"
#include "hwy/foreach_target.h"

#include "hwy/highway.h"

#include "shading/packets-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {

template <class Number>
struct Lambert {
  struct View {};
  const LambertLightOf<Number>* HWY_RESTRICT lights;

  HWY_INLINE View SeenBy(FloatTag, const PacketV&, const Surface&) const { return {}; }
  HWY_INLINE DiffuseV Reflect(FloatTag d, const View&, const PacketV& p, const IncidentV& in,
                              size_t k) const {
    return {ScaledPart(RgbAt(d, lights[k].diffuse, p.i), in.weight)};
  }
};

void ShadeLambertT(const LambertLight* lights, const ShadeRange& range) {
  ShadeBriefly(FloatTag(), Lambert<float>{lights}, range);
}

void ShadeLambertMapsT(const LambertLightOf<const float*>& light, const ShadeRange& range) {
  ShadeBriefly(FloatTag(), Lambert<const float*>{&light}, range);
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nacre {
HWY_EXPORT(ShadeLambertT);
HWY_EXPORT(ShadeLambertMapsT);
void ShadeLambert(const LambertLight* lights, const ShadeRange& range) {
  HWY_DYNAMIC_DISPATCH(ShadeLambertT)(lights, range);
}
void ShadeLambertMaps(const LambertLightOf<const float*>& light, const ShadeRange& range) {
  HWY_DYNAMIC_DISPATCH(ShadeLambertMapsT)(light, range);
}
}  // namespace nacre
#endif
