// SPDX-License-Identifier: Apache-2.0
// tests/light/environment_kernel.cc: the loops behind environment_kernel.h.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "light/environment_kernel.cc"
#include "hwy/foreach_target.h"

#include "hwy/highway.h"

#include "base/target_ops-inl.h"
#include "light/environment-inl.h"
#include "light/environment_kernel.h"
#include "light/sky-inl.h"
#include "queries-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {

using D = hn::ScalableTag<float>;
using V = hn::Vec<D>;
// The direction that is a query.
const Vec3f& Itself(const Vec3f& direction) { return direction; }

std::vector<EnvironmentTexel> LookUpTexelsT(const EnvironmentMap& map,
                                            const std::vector<Vec3f>& directions) {
  return AskInPackets<float, EnvironmentTexel>(directions, [&](const auto& packet) {
    const EnvironmentTexelV<V> texel = TexelAt(D(), map, packet.Vector(Itself));
    packet.Store(texel.red, &EnvironmentTexel::red);
    packet.Store(texel.green, &EnvironmentTexel::green);
    packet.Store(texel.blue, &EnvironmentTexel::blue);
    packet.Store(texel.pdf, &EnvironmentTexel::pdf);
  });
}

std::vector<EnvironmentSample<float>> SampleEnvironmentsT(const EnvironmentMap& map,
                                                          const std::vector<uint32_t>& bits0,
                                                          const std::vector<uint32_t>& bits1) {
  return AskInPackets<float, EnvironmentSample<float>>(bits0, [&](const auto& packet) {
    uint32_t b0[packet.kMaxLanes], b1[packet.kMaxLanes];
    for (size_t i = 0; i < hn::Lanes(D()); ++i) {
      b0[i] = packet.At(i);
      b1[i] = bits1[std::min(packet.first + i, bits1.size() - 1)];
    }
    using Sample = EnvironmentSample<float>;
    const EnvironmentSampleV<V> sample = SampleEnvironment(D(), map, b0, b1);
    packet.Store3(sample.to_light, &Sample::to_light);
    packet.Store(
        sample.texel.red, [](Sample & s) -> auto& { return s.texel.red; });
    packet.Store(
        sample.texel.green, [](Sample & s) -> auto& { return s.texel.green; });
    packet.Store(
        sample.texel.blue, [](Sample & s) -> auto& { return s.texel.blue; });
    packet.Store(
        sample.texel.pdf, [](Sample & s) -> auto& { return s.texel.pdf; });
  });
}

template <class Sky>
std::vector<Vec3f> Evaluate(const Sky& sky, const std::vector<Vec3f>& directions) {
  return AskInPackets<float, Vec3f>(directions, [&](const auto& packet) {
    const Vec3V<V> direction = packet.Vector(Itself);
    packet.Store(Radiance(D(), sky, direction), &Vec3f::x);
    packet.Store(Irradiance(D(), sky, direction), &Vec3f::y);
  });
}

std::vector<Vec3f> EvaluateGradientT(const GradientSkyTerms<float>& sky,
                                     const std::vector<Vec3f>& directions) {
  return Evaluate(sky, directions);
}
std::vector<Vec3f> EvaluateQuadraticT(const QuadraticSkyTerms<float>& sky,
                                      const std::vector<Vec3f>& directions) {
  return Evaluate(sky, directions);
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nacre {
HWY_EXPORT(LookUpTexelsT);
HWY_EXPORT(SampleEnvironmentsT);
HWY_EXPORT(EvaluateGradientT);
HWY_EXPORT(EvaluateQuadraticT);

std::vector<EnvironmentTexel> LookUpTexels(const EnvironmentMap& map,
                                           const std::vector<Vec3f>& directions) {
  return HWY_DYNAMIC_DISPATCH(LookUpTexelsT)(map, directions);
}
std::vector<EnvironmentSample<float>> SampleEnvironments(const EnvironmentMap& map,
                                                         const std::vector<uint32_t>& bits0,
                                                         const std::vector<uint32_t>& bits1) {
  return HWY_DYNAMIC_DISPATCH(SampleEnvironmentsT)(map, bits0, bits1);
}
std::vector<Vec3f> EvaluateSky(const GradientSkyTerms<float>& sky,
                               const std::vector<Vec3f>& directions) {
  return HWY_DYNAMIC_DISPATCH(EvaluateGradientT)(sky, directions);
}
std::vector<Vec3f> EvaluateSky(const QuadraticSkyTerms<float>& sky,
                               const std::vector<Vec3f>& directions) {
  return HWY_DYNAMIC_DISPATCH(EvaluateQuadraticT)(sky, directions);
}
}  // namespace nacre
#endif
