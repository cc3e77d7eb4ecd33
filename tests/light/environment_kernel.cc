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

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {

using D = hn::ScalableTag<float>;
using V = hn::Vec<D>;
constexpr size_t kMaxLanes = 32;

Vec3V<V> Load(const std::vector<Vec3f>& vectors, size_t first) {
  alignas(64) float lanes[3][kMaxLanes];
  for (size_t i = 0; i < hn::Lanes(D()); ++i) {
    const Vec3f& v = vectors[std::min(first + i, vectors.size() - 1)];
    for (int c = 0; c < 3; ++c) lanes[c][i] = v[c];
  }
  return Load3(D(), lanes[0], lanes[1], lanes[2]);
}

// Calls store(index, lane) for each element of a vector of results.
template <class Store>
void ForLanes(size_t first, size_t count, const Store& store) {
  for (size_t i = 0; i < hn::Lanes(D()) && first + i < count; ++i) store(first + i, i);
}

void LookUpTexelsT(const EnvironmentMap& map, const std::vector<Vec3f>& directions,
                   std::vector<EnvironmentTexel>* out) {
  const D d;
  for (size_t first = 0; first < directions.size(); first += hn::Lanes(d)) {
    const EnvironmentTexelV<V> texel = TexelAt(d, map, Load(directions, first));
    alignas(64) float lanes[4][kMaxLanes];
    hn::Store(texel.red, d, lanes[0]);
    hn::Store(texel.green, d, lanes[1]);
    hn::Store(texel.blue, d, lanes[2]);
    hn::Store(texel.pdf, d, lanes[3]);
    ForLanes(first, out->size(), [&](size_t index, size_t i) {
      (*out)[index] = {lanes[0][i], lanes[1][i], lanes[2][i], lanes[3][i]};
    });
  }
}

void SampleEnvironmentsT(const EnvironmentMap& map, const std::vector<uint32_t>& bits0,
                         const std::vector<uint32_t>& bits1,
                         std::vector<EnvironmentSample<float>>* out) {
  const D d;
  for (size_t first = 0; first < bits0.size(); first += hn::Lanes(d)) {
    uint32_t b0[kMaxLanes], b1[kMaxLanes];
    for (size_t i = 0; i < hn::Lanes(d); ++i) {
      b0[i] = bits0[std::min(first + i, bits0.size() - 1)];
      b1[i] = bits1[std::min(first + i, bits1.size() - 1)];
    }
    const EnvironmentSampleV<V> sample = SampleEnvironment(d, map, b0, b1);
    alignas(64) float lanes[7][kMaxLanes];
    Store3(sample.to_light, d, lanes[0], lanes[1], lanes[2]);
    hn::Store(sample.texel.red, d, lanes[3]);
    hn::Store(sample.texel.green, d, lanes[4]);
    hn::Store(sample.texel.blue, d, lanes[5]);
    hn::Store(sample.texel.pdf, d, lanes[6]);
    ForLanes(first, out->size(), [&](size_t index, size_t i) {
      (*out)[index] = {Vec3f(lanes[0][i], lanes[1][i], lanes[2][i]),
                       {lanes[3][i], lanes[4][i], lanes[5][i], lanes[6][i]}};
    });
  }
}

template <class Sky>
void Evaluate(const Sky& sky, const std::vector<Vec3f>& directions, std::vector<Vec3f>* out) {
  const D d;
  for (size_t first = 0; first < directions.size(); first += hn::Lanes(d)) {
    const Vec3V<V> direction = Load(directions, first);
    alignas(64) float lanes[2][kMaxLanes];
    hn::Store(Radiance(d, sky, direction), d, lanes[0]);
    hn::Store(Irradiance(d, sky, direction), d, lanes[1]);
    ForLanes(first, out->size(),
             [&](size_t index, size_t i) { (*out)[index] = Vec3f(lanes[0][i], lanes[1][i], 0); });
  }
}

void EvaluateGradientT(const GradientSkyTerms<float>& sky, const std::vector<Vec3f>& directions,
                       std::vector<Vec3f>* out) {
  Evaluate(sky, directions, out);
}
void EvaluateQuadraticT(const QuadraticSkyTerms<float>& sky, const std::vector<Vec3f>& directions,
                        std::vector<Vec3f>* out) {
  Evaluate(sky, directions, out);
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
  std::vector<EnvironmentTexel> out(directions.size());
  HWY_DYNAMIC_DISPATCH(LookUpTexelsT)(map, directions, &out);
  return out;
}
std::vector<EnvironmentSample<float>> SampleEnvironments(const EnvironmentMap& map,
                                                         const std::vector<uint32_t>& bits0,
                                                         const std::vector<uint32_t>& bits1) {
  std::vector<EnvironmentSample<float>> out(bits0.size());
  HWY_DYNAMIC_DISPATCH(SampleEnvironmentsT)(map, bits0, bits1, &out);
  return out;
}
std::vector<Vec3f> EvaluateSky(const GradientSkyTerms<float>& sky,
                               const std::vector<Vec3f>& directions) {
  std::vector<Vec3f> out(directions.size());
  HWY_DYNAMIC_DISPATCH(EvaluateGradientT)(sky, directions, &out);
  return out;
}
std::vector<Vec3f> EvaluateSky(const QuadraticSkyTerms<float>& sky,
                               const std::vector<Vec3f>& directions) {
  std::vector<Vec3f> out(directions.size());
  HWY_DYNAMIC_DISPATCH(EvaluateQuadraticT)(sky, directions, &out);
  return out;
}
}  // namespace nacre
#endif
