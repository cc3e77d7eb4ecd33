// SPDX-License-Identifier: Apache-2.0
// tests/light/area_kernel.cc: the loops behind area_kernel.h.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "light/area_kernel.cc"
#include "hwy/foreach_target.h"

#include "hwy/highway.h"

#include "base/target_ops-inl.h"
#include "light/area_kernel.h"
#include "light/irradiance-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {

using D = hn::ScalableTag<float>;
using V = hn::Vec<D>;
constexpr size_t kMaxLanes = 32;

// A vector of the member `member` of up to a vector of queries; the last query is repeated.
template <class Query, class Member>
V Column(const std::vector<Query>& queries, size_t first, Member member) {
  alignas(64) float lanes[kMaxLanes];
  for (size_t i = 0; i < hn::Lanes(D()); ++i) {
    lanes[i] = member(queries[std::min(first + i, queries.size() - 1)]);
  }
  return hn::Load(D(), lanes);
}

template <class Query, class Member>
Vec3V<V> Column3(const std::vector<Query>& queries, size_t first, Member member) {
  return {Column(queries, first, [&](const Query& q) { return member(q).x; }),
          Column(queries, first, [&](const Query& q) { return member(q).y; }),
          Column(queries, first, [&](const Query& q) { return member(q).z; })};
}

SphereLightV<V> LightColumn(const std::vector<LightQuery<SphereLight<float>>>& queries,
                            size_t first) {
  return {Column3(queries, first, [](const auto& q) { return q.light.centre; }),
          Column(queries, first, [](const auto& q) { return q.light.radius; })};
}

RectangleLightV<V> LightColumn(const std::vector<LightQuery<RectangleLight<float>>>& queries,
                               size_t first) {
  return {Column3(queries, first, [](const auto& q) { return q.light.corner; }),
          Column3(queries, first, [](const auto& q) { return q.light.edge_x; }),
          Column3(queries, first, [](const auto& q) { return q.light.edge_y; })};
}

TriangleLightV<V> LightColumn(const std::vector<LightQuery<TriangleLight<float>>>& queries,
                              size_t first) {
  return {Column3(queries, first, [](const auto& q) { return q.light.corner; }),
          Column3(queries, first, [](const auto& q) { return q.light.edge_x; }),
          Column3(queries, first, [](const auto& q) { return q.light.edge_y; })};
}

DiskLightV<V> LightColumn(const std::vector<LightQuery<DiskLight<float>>>& queries, size_t first) {
  return {Column3(queries, first, [](const auto& q) { return q.light.centre; }),
          Column3(queries, first, [](const auto& q) { return q.light.normal; }),
          Column(queries, first, [](const auto& q) { return q.light.radius; })};
}

template <class LightV>
V SolidAngleOf(const LightV& light) {
  return SolidAngle(D(), light);
}
V SolidAngleOf(const DiskLightV<V>&) { return hn::Zero(D()); }

template <class Query, class Answers>
void Ask(const std::vector<Query>& queries, Answers* answers) {
  const D d;
  for (size_t first = 0; first < queries.size(); first += hn::Lanes(d)) {
    const auto light = LightColumn(queries, first);
    const AreaSampleV<V> sample =
        SampleLight(d, light, Column(queries, first, [](const Query& q) { return q.u0; }),
                    Column(queries, first, [](const Query& q) { return q.u1; }));
    const V columns[] = {
        sample.to_light.x,
        sample.to_light.y,
        sample.to_light.z,
        sample.distance,
        sample.inverse_pdf,
        sample.cos_light,
        LightPdf(d, light, Column3(queries, first, [](const Query& q) { return q.direction; })),
        SolidAngleOf(light),
        Irradiance(d, light, Column3(queries, first, [](const Query& q) { return q.normal; }))};
    alignas(64) float lanes[std::size(columns)][kMaxLanes];
    for (size_t c = 0; c < std::size(columns); ++c) hn::Store(columns[c], d, lanes[c]);
    for (size_t i = 0; i < hn::Lanes(d) && first + i < queries.size(); ++i) {
      (*answers)[first + i] = {
          {Vec3f(lanes[0][i], lanes[1][i], lanes[2][i]), lanes[3][i], lanes[4][i], lanes[5][i]},
          lanes[6][i],
          lanes[7][i],
          lanes[8][i]};
    }
  }
}

void AskSpheresT(const std::vector<LightQuery<SphereLight<float>>>& queries,
                 std::vector<LightAnswer>* answers) {
  Ask(queries, answers);
}
void AskRectanglesT(const std::vector<LightQuery<RectangleLight<float>>>& queries,
                    std::vector<LightAnswer>* answers) {
  Ask(queries, answers);
}
void AskDisksT(const std::vector<LightQuery<DiskLight<float>>>& queries,
               std::vector<LightAnswer>* answers) {
  Ask(queries, answers);
}
void AskTrianglesT(const std::vector<LightQuery<TriangleLight<float>>>& queries,
                   std::vector<LightAnswer>* answers) {
  Ask(queries, answers);
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nacre {
HWY_EXPORT(AskSpheresT);
HWY_EXPORT(AskRectanglesT);
HWY_EXPORT(AskDisksT);
HWY_EXPORT(AskTrianglesT);

std::vector<LightAnswer> AskLights(const std::vector<LightQuery<SphereLight<float>>>& queries) {
  std::vector<LightAnswer> answers(queries.size());
  HWY_DYNAMIC_DISPATCH(AskSpheresT)(queries, &answers);
  return answers;
}
std::vector<LightAnswer> AskLights(const std::vector<LightQuery<RectangleLight<float>>>& queries) {
  std::vector<LightAnswer> answers(queries.size());
  HWY_DYNAMIC_DISPATCH(AskRectanglesT)(queries, &answers);
  return answers;
}
std::vector<LightAnswer> AskLights(const std::vector<LightQuery<DiskLight<float>>>& queries) {
  std::vector<LightAnswer> answers(queries.size());
  HWY_DYNAMIC_DISPATCH(AskDisksT)(queries, &answers);
  return answers;
}
std::vector<LightAnswer> AskLights(const std::vector<LightQuery<TriangleLight<float>>>& queries) {
  std::vector<LightAnswer> answers(queries.size());
  HWY_DYNAMIC_DISPATCH(AskTrianglesT)(queries, &answers);
  return answers;
}
}  // namespace nacre
#endif
