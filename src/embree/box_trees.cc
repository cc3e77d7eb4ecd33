// SPDX-License-Identifier: Apache-2.0
// embree/box_trees.cc: sets up Embree's scenes: bounds and callbacks.
#include "visibility/box_trees.h"

#include <algorithm>
#include <atomic>
#include <utility>

#include "base/cancel.h"
#include "base/error.h"
#include "base/handover.h"
#include "embree/embree_api.h"
#include "embree/embree_device.h"
#include "embree/primitives.h"
#include "embree/tbb_threads.h"
#include "embree/trace_kernel.h"

namespace nacre {
namespace {

struct ReleaseScene {
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};
using ScenePointer = std::unique_ptr<RTCSceneTy, ReleaseScene>;

// An upper bound of the distance at which rays start from the origin of a BVH that is built now,
// which is the camera's position. A camera at a distance of `reach` from there sees nothing farther
// away than the extent plus `reach`, and its rays start no farther from it. The last term is for
// flat lights, which move with the camera: they are lifted by 2^-44 times sums of the coordinates
// of the camera and of their own (scene/light_shapes.h), altogether by less than 2^-42 times the
// distance of the farthest point from the world's origin; u times the term is no less than that.
double OriginExtent(const TraceGeometry& geometry) {
  const double reach = geometry.eye_reach;
  if (reach == 0) return geometry.extent;
  const double extent = geometry.extent + 2 * reach;
  return extent + 0x1p-18 * (geometry.eye.length() + extent);
}

// The margin of the bounds of a primitive whose points are within `max_distance` of the BVH's
// origin: twice the distance that a float ray strays from the true one up to these points p. Its
// origin o is off by u |o| and its direction by u |p - o|, with |o| at most OriginExtent. The other
// half is for the rounding of the bounds themselves, and of the doubles that are relative to a
// camera elsewhere.
double BoundsMargin(const TraceGeometry& geometry, double max_distance) {
  return 2 * kFloatUnit * (2 * OriginExtent(geometry) + max_distance);
}

void SetBounds(const Vec3d& lower, const Vec3d& upper, double margin, RTCBounds* bounds) {
  bounds->lower_x = static_cast<float>(lower.x - margin);
  bounds->lower_y = static_cast<float>(lower.y - margin);
  bounds->lower_z = static_cast<float>(lower.z - margin);
  bounds->upper_x = static_cast<float>(upper.x + margin);
  bounds->upper_y = static_cast<float>(upper.y + margin);
  bounds->upper_z = static_cast<float>(upper.z + margin);
}

void SphereBounds(const RTCBoundsFunctionArguments* args) {
  TakeOver(args->geometryUserPtr);
  const auto& geometry = *static_cast<const TraceGeometry*>(args->geometryUserPtr);
  const auto& [center, radius] = geometry.spheres[args->primID];
  SetBounds(center - Vec3d(radius), center + Vec3d(radius),
            BoundsMargin(geometry, center.length() + radius), args->bounds_o);
  HandOver(args->geometryUserPtr);
}

void TriangleBounds(const RTCBoundsFunctionArguments* args) {
  const auto& primitives = *static_cast<const TrianglePrimitives*>(args->geometryUserPtr);
  const TraceGeometry& geometry = *primitives.geometry;
  TakeOver(&geometry);
  const uint32_t* const first = &primitives.first[args->primID];
  Vec3d lower = geometry.positions[geometry.triangles[first[0]][0]], upper = lower;
  double max_distance = 0;
  for (uint32_t triangle = first[0]; triangle < first[1]; ++triangle) {
    for (const uint32_t corner : geometry.triangles[triangle]) {
      const Vec3d& position = geometry.positions[corner];
      for (int i = 0; i < 3; ++i) {
        lower[i] = std::min(lower[i], position[i]);
        upper[i] = std::max(upper[i], position[i]);
      }
      max_distance = std::max(max_distance, position.length());
    }
  }
  SetBounds(lower, upper, BoundsMargin(geometry, max_distance), args->bounds_o);
  HandOver(&geometry);
}

// From this many shapes on, incoherent rays are faster one by one than in packets, which visit all
// boxes that any of their rays meets. Measured (waiting_bench packets) with random rays on SSE4,
// AVX2 and AVX-512: one by one they take 0.4 to 0.9 times as long, less if there are more shapes.
// With light from all directions on neighbouring pixels and packets of 16, 3000 spheres take 0.7
// times as long, a million triangles 0.8 times, but some thousand triangles 1.1 times.
constexpr size_t kLargeSpheres = 64, kLargeTriangles = size_t{1} << 16;

// Ends a build that is cancelled, and remembers that it did, because the flag may be taken back.
struct BuildMonitor {
  CancelPointer cancel;
  std::atomic<bool> ended = false;

  // Embree's threads call this again and again; false ends the build.
  static bool GoesOn(void* self, double /*done*/) {
    auto* const monitor = static_cast<BuildMonitor*>(self);
    if (IsCancelled(monitor->cancel)) monitor->ended = true;
    return !monitor->ended;
  }
};

void Attach(RTCDevice device, RTCScene scene, const void* user, size_t count,
            RTCBoundsFunction bounds, const PrimitiveCallbacks& callbacks) {
  if (count == 0) return;
  RTCGeometry shapes = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(shapes, static_cast<unsigned>(count));
  rtcSetGeometryUserData(shapes, const_cast<void*>(user));
  rtcSetGeometryBoundsFunction(shapes, bounds, nullptr);
  rtcSetGeometryIntersectFunction(shapes, callbacks.intersect);
  rtcSetGeometryOccludedFunction(shapes, callbacks.occluded);
  rtcCommitGeometry(shapes);
  rtcAttachGeometry(scene, shapes);
  rtcReleaseGeometry(shapes);
}

}  // namespace

// Embree holds pointers to the geometry; scenes must be released before the device.
struct BoxTrees::State {
  struct Tree {
    ScenePointer scene;
    Vec3d origin{0, 0, 0};  // in the world: the camera's position when it was built
  };
  const TraceGeometry* geometry;
  std::optional<bool> one_by_one;
  TrianglePrimitives triangle_primitives;  // empty until a BVH is built
  EmbreeDevice device;
  Tree all, triangles;

  Tree& TreeOf(BoxTree tree) { return tree == BoxTree::kAll ? all : triangles; }
  TraceScene Traced(BoxTree tree) {
    const Tree& of = TreeOf(tree);
    const bool is_large = one_by_one.value_or(geometry->triangles.size() >= kLargeTriangles ||
                                              (tree == BoxTree::kAll && geometry->shells.empty() &&
                                               geometry->spheres.size() >= kLargeSpheres));
    return {of.scene.get(), device.packet_width(), geometry, is_large, geometry->eye - of.origin};
  }
};

const char* EmbreeVersion() { return RTC_VERSION_STRING; }

BoxTrees::BoxTrees(const TraceGeometry* geometry, std::optional<bool> one_by_one)
    : state_(std::make_unique<State>()) {
  state_->geometry = geometry;
  state_->one_by_one = one_by_one;
}
BoxTrees::~BoxTrees() = default;

void BoxTrees::Build(BoxTree tree, int threads, CancelPointer cancel) {
  EmbreeDevice& device = state_->device;
  const TraceGeometry* const geometry = state_->geometry;
  State::Tree& to = state_->TreeOf(tree);
  if (to.scene) return;
  ScenePointer built(rtcNewScene(device.get()));
  device.ThrowIfFailed();
  rtcSetSceneFlags(built.get(), RTC_SCENE_FLAG_ROBUST);
  if (tree == BoxTree::kAll && geometry->shells.empty()) {
    Attach(device.get(), built.get(), geometry, geometry->spheres.size(), &SphereBounds,
           SphereCallbacks());
  }
  TrianglePrimitives& primitives = state_->triangle_primitives;
  if (primitives.first.empty()) primitives = MakeTrianglePrimitives(geometry);
  Attach(device.get(), built.get(), &primitives, primitives.size(), &TriangleBounds,
         TriangleCallbacks());
  BuildMonitor monitor{cancel};
  rtcSetSceneProgressMonitorFunction(built.get(), &BuildMonitor::GoesOn, &monitor);
  HandOver(geometry);
  WithThreads(threads, [&] { rtcJoinCommitScene(built.get()); });
  TakeOver(geometry);
  rtcSetSceneProgressMonitorFunction(built.get(), nullptr, nullptr);
  try {
    device.ThrowIfFailed();
  } catch (const Error&) {
    // The scene is leaked: if memory ran out while TBB made a task, the scene's task group counts a
    // task that does not exist, and releasing the scene would wait for it forever.
    [[maybe_unused]] const RTCScene left = built.release();
    throw;
  }
  if (monitor.ended) throw Cancelled{};
  to = {std::move(built), geometry->eye};
}

bool BoxTrees::Serve(const Vec3d& eye) const {
  const auto serves = [&](const State::Tree& tree) {
    return !tree.scene || (eye - tree.origin).length() <= state_->geometry->eye_reach;
  };
  return serves(state_->all) && serves(state_->triangles);
}

void BoxTrees::FindNearer(BoxTree tree, const RayBatch& rays, ClosestHits* hits) const {
  TraceNearer(state_->Traced(tree), rays, hits);
}

void BoxTrees::FindOccluded(ShadowRayBatch* rays) const {
  TraceOccluded(state_->Traced(BoxTree::kAll), rays);
}

}  // namespace nacre
