// SPDX-License-Identifier: Apache-2.0
// bench/embree_baseline.cc: what Embree alone needs for a frame of camera rays: its built-in
// spheres, or user geometry with a test in float; packets of 16 rays made in float, the coherent
// flag, the closest hit and nothing after it. Building the tree is left out. One thread.
#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include "base/float_mode.h"
#include "embree_tree.h"
#include "float_visibility.h"
#include "render/camera.h"
#include "visibility_scenes.h"

namespace nacre {
namespace {

ScenePointer BuildSpherePoints(const Scene& scene, const std::vector<FloatSphere>& spheres,
                               RTCDevice device) {
  RTCGeometry points = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_SPHERE_POINT);
  auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(
      points, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, 4 * sizeof(float), spheres.size()));
  for (size_t i = 0; i < spheres.size(); ++i) {
    vertices = std::copy_n(spheres[i].center, 3, vertices);
    *vertices++ = static_cast<float>(scene.spheres[i].radius);
  }
  return BuildTree(points, device);
}

void SphereBounds(const RTCBoundsFunctionArguments* args) {
  const auto& sphere = static_cast<const FloatSphere*>(args->geometryUserPtr)[args->primID];
  const float radius = std::sqrt(sphere.radius2) * (1 + 0x1p-20f);
  RTCBounds& box = *args->bounds_o;
  box.lower_x = sphere.center[0] - radius;
  box.lower_y = sphere.center[1] - radius;
  box.lower_z = sphere.center[2] - radius;
  box.upper_x = sphere.center[0] + radius;
  box.upper_y = sphere.center[1] + radius;
  box.upper_z = sphere.center[2] + radius;
}

ScenePointer BuildUserSpheres(const Scene&, const std::vector<FloatSphere>& spheres,
                              RTCDevice device) {
  RTCGeometry user = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(user, static_cast<unsigned>(spheres.size()));
  rtcSetGeometryUserData(user, const_cast<FloatSphere*>(spheres.data()));
  rtcSetGeometryBoundsFunction(user, SphereBounds, nullptr);
  rtcSetGeometryIntersectFunction(user, IntersectFloatSphere);
  return BuildTree(user, device);
}

// A perspective camera in float: the direction through a pixel's centre is
// corner + (x + 1/2) step_x + (y + 1/2) step_y.
struct FloatCamera {
  Imath::V3f corner, step_x, step_y;
};

constexpr unsigned kPacket = 16;
static_assert(kFrameWidth % kPacket == 0);

// 16 rays beside each other, beginning at pixel (x0, y).
void MakePacket(const FloatCamera& camera, int x0, int y, RTCRayHit16* packet) {
  const Imath::V3f row = camera.corner + camera.step_y * (static_cast<float>(y) + 0.5f);
  for (unsigned i = 0; i < kPacket; ++i) {
    const float x = static_cast<float>(x0) + static_cast<float>(i) + 0.5f;
    packet->ray.org_x[i] = 0;
    packet->ray.org_y[i] = 0;
    packet->ray.org_z[i] = 0;
    packet->ray.dir_x[i] = row.x + camera.step_x.x * x;
    packet->ray.dir_y[i] = row.y + camera.step_x.y * x;
    packet->ray.dir_z[i] = row.z + camera.step_x.z * x;
    packet->ray.tnear[i] = 0;
    packet->ray.tfar[i] = INFINITY;
    packet->ray.time[i] = 0;
    packet->ray.mask[i] = 0xffffffffu;
    packet->ray.flags[i] = 0;
    packet->hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
    packet->hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
  }
}

// Traces the frame's packets; returns the hits.
int64_t TraceFrame(const FloatCamera& camera, RTCScene tree, EmbreeContext* context) {
  alignas(64) int valid[kPacket];
  std::fill(valid, valid + kPacket, -1);
  RTCRayHit16 packet;
  int64_t hits = 0;
  for (int y = 0; y < kFrameHeight; ++y) {
    for (int x = 0; x < kFrameWidth; x += static_cast<int>(kPacket)) {
      MakePacket(camera, x, y, &packet);
      IntersectPacket(static_cast<int>(kPacket), valid, tree, context, &packet);
      for (const unsigned id : packet.hit.geomID) hits += id != RTC_INVALID_GEOMETRY_ID;
    }
  }
  return hits;
}

using MakeTree = ScenePointer (*)(const Scene&, const std::vector<FloatSphere>&, RTCDevice);

void BenchEmbree(benchmark::State& state, const SphereScene& which, MakeTree make_tree) {
  const FlushDenormals flush;
  const DevicePointer device = MakeDevice();
  const Scene scene = MakeSphereScene(which);
  const std::vector<FloatSphere> spheres = FloatSpheres(scene);
  const ScenePointer tree = make_tree(scene, spheres, device.get());
  const CameraFrame frame = MakeCameraFrame(scene.camera, kFrameWidth, kFrameHeight);
  const FloatCamera camera{Imath::V3f(frame.corner), Imath::V3f(frame.step_x),
                           Imath::V3f(frame.step_y)};
  EmbreeContext context;
  InitContext(&context);
  int64_t hits = 0;
  for (auto _ : state) {
    hits = TraceFrame(camera, tree.get(), &context);
    benchmark::DoNotOptimize(hits);
  }
  state.SetItemsProcessed(state.iterations() * kFrameWidth * kFrameHeight);
  state.counters["hits"] = static_cast<double>(hits);
}

const bool kRegistered = [] {
  for (const SphereScene& which : SphereScenes()) {
    const std::string scene = which.name;
    benchmark::RegisterBenchmark(("visibility/embree_sphere_point/" + scene).c_str(), BenchEmbree,
                                 which, BuildSpherePoints)
        ->Unit(benchmark::kMillisecond);
    benchmark::RegisterBenchmark(("visibility/embree_float_user/" + scene).c_str(), BenchEmbree,
                                 which, BuildUserSpheres)
        ->Unit(benchmark::kMillisecond);
  }
  return true;
}();

}  // namespace
}  // namespace nacre
