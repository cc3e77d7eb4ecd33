// SPDX-License-Identifier: Apache-2.0
// tests/light/area_kernel.cc: the loops behind area_kernel.h.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "light/area_kernel.cc"
#include "hwy/foreach_target.h"

#include "hwy/highway.h"

#include "base/target_ops-inl.h"
#include "light/area_kernel.h"
#include "light/disk_light-inl.h"
#include "light/polygon_irradiance-inl.h"
#include "light/sphere_light-inl.h"
#include "queries-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {

using D = hn::ScalableTag<float>;
using V = hn::Vec<D>;

template <class Light>
using Packet = QueryPacket<LightQuery<Light>, LightAnswer, float>;

SphereLightV<V> LightOf(const Packet<SphereLight<float>>& p) {
  return {p.Vector([](const auto& q) { return q.light.centre; }),
          p.Number([](const auto& q) { return q.light.radius; })};
}
RectangleLightV<V> LightOf(const Packet<RectangleLight<float>>& p) {
  return {p.Vector([](const auto& q) { return q.light.corner; }),
          p.Vector([](const auto& q) { return q.light.edge_x; }),
          p.Vector([](const auto& q) { return q.light.edge_y; })};
}
TriangleLightV<V> LightOf(const Packet<TriangleLight<float>>& p) {
  return {p.Vector([](const auto& q) { return q.light.corner; }),
          p.Vector([](const auto& q) { return q.light.edge_x; }),
          p.Vector([](const auto& q) { return q.light.edge_y; })};
}
DiskLightV<V> LightOf(const Packet<DiskLight<float>>& p) {
  return {p.Vector([](const auto& q) { return q.light.centre; }),
          p.Vector([](const auto& q) { return q.light.normal; }),
          p.Number([](const auto& q) { return q.light.radius; })};
}

template <class LightV>
V SolidAngleOf(const LightV& light) {
  return SolidAngle(D(), light);
}
V SolidAngleOf(const RectangleLightV<V>& light) {
  return SolidAngle(D(), ViewOf(D(), ScaleToUnit(D(), light).light));
}
V SolidAngleOf(const DiskLightV<V>&) { return hn::Zero(D()); }

template <class Query>
std::vector<LightAnswer> Ask(const std::vector<Query>& queries) {
  return AskInPackets<float, LightAnswer>(queries, [](const auto& packet) {
    const D d;
    const auto light = LightOf(packet);
    const AreaSampleV<V> sample =
        SampleLight(d, light, packet.Number(&Query::u0), packet.Number(&Query::u1));
    packet.Store3(
        sample.to_light, [](LightAnswer & a) -> auto& { return a.sample.to_light; });
    packet.Store(
        sample.distance, [](LightAnswer & a) -> auto& { return a.sample.distance; });
    packet.Store(
        sample.inverse_pdf, [](LightAnswer & a) -> auto& { return a.sample.inverse_pdf; });
    packet.Store(
        sample.cos_light, [](LightAnswer & a) -> auto& { return a.sample.cos_light; });
    packet.Store(LightPdf(d, light, packet.Vector(&Query::direction)), &LightAnswer::pdf);
    packet.Store(SolidAngleOf(light), &LightAnswer::solid_angle);
    packet.Store(Irradiance(d, light, packet.Vector(&Query::normal)), &LightAnswer::irradiance);
  });
}

std::vector<LightAnswer> AskSpheresT(const std::vector<LightQuery<SphereLight<float>>>& queries) {
  return Ask(queries);
}
std::vector<LightAnswer> AskRectanglesT(
    const std::vector<LightQuery<RectangleLight<float>>>& queries) {
  return Ask(queries);
}
std::vector<LightAnswer> AskDisksT(const std::vector<LightQuery<DiskLight<float>>>& queries) {
  return Ask(queries);
}
std::vector<LightAnswer> AskTrianglesT(
    const std::vector<LightQuery<TriangleLight<float>>>& queries) {
  return Ask(queries);
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
  return HWY_DYNAMIC_DISPATCH(AskSpheresT)(queries);
}
std::vector<LightAnswer> AskLights(const std::vector<LightQuery<RectangleLight<float>>>& queries) {
  return HWY_DYNAMIC_DISPATCH(AskRectanglesT)(queries);
}
std::vector<LightAnswer> AskLights(const std::vector<LightQuery<DiskLight<float>>>& queries) {
  return HWY_DYNAMIC_DISPATCH(AskDisksT)(queries);
}
std::vector<LightAnswer> AskLights(const std::vector<LightQuery<TriangleLight<float>>>& queries) {
  return HWY_DYNAMIC_DISPATCH(AskTrianglesT)(queries);
}
}  // namespace nacre
#endif
