// SPDX-License-Identifier: Apache-2.0
// visibility/intersector.cc: sets Embree's scenes up: bounds, callbacks.
#include "visibility/intersector.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "base/error.h"
#include "base/handover.h"
#include "base/parallel.h"
#include "visibility/embree_api.h"
#include "visibility/embree_device.h"
#include "visibility/geometry.h"
#include "visibility/packet.h"
#include "visibility/refine_kernel.h"
#include "visibility/shell_kernel.h"
#include "visibility/sphere_kernel.h"
#include "visibility/trace_kernel.h"
#include "visibility/triangle_kernel.h"

namespace nacre {
namespace {

struct ReleaseScene {
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};
using ScenePointer = std::unique_ptr<RTCSceneTy, ReleaseScene>;

// How far the float ray strays from the true one, at or before points within `reach` of the
// camera: its origin by u |o| and its direction by u |p - o|, with |o| at most the extent. Twice
// that, for the rounding of the bounds themselves.
double BoundsMargin(const TraceGeometry& geometry, double reach) {
  return 2 * kFloatUnit * (2 * geometry.extent + reach);
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

// Of all spheres at once.
void ShellBounds(const RTCBoundsFunctionArguments* args) {
  TakeOver(args->geometryUserPtr);
  const auto& geometry = *static_cast<const TraceGeometry*>(args->geometryUserPtr);
  const Shell& all = geometry.shells.nodes.front().shell;
  SetBounds(all.center - Vec3d(all.outer), all.center + Vec3d(all.outer),
            BoundsMargin(geometry, all.center.length() + all.outer), args->bounds_o);
  HandOver(args->geometryUserPtr);
}

void TriangleBounds(const RTCBoundsFunctionArguments* args) {
  TakeOver(args->geometryUserPtr);
  const auto& geometry = *static_cast<const TraceGeometry*>(args->geometryUserPtr);
  const auto& corners = geometry.triangles[args->primID];
  Vec3d lower = geometry.positions[corners[0]], upper = lower;
  double reach = 0;
  for (const uint32_t corner : corners) {
    const Vec3d& position = geometry.positions[corner];
    for (int i = 0; i < 3; ++i) {
      lower[i] = std::min(lower[i], position[i]);
      upper[i] = std::max(upper[i], position[i]);
    }
    reach = std::max(reach, position.length());
  }
  SetBounds(lower, upper, BoundsMargin(geometry, reach), args->bounds_o);
  HandOver(args->geometryUserPtr);
}

void Attach(RTCDevice device, RTCScene scene, TraceGeometry* geometry, size_t count,
            RTCBoundsFunction bounds, const PrimitiveCallbacks& callbacks) {
  if (count == 0) return;
  RTCGeometry shapes = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(shapes, static_cast<unsigned>(count));
  rtcSetGeometryUserData(shapes, geometry);
  rtcSetGeometryBoundsFunction(shapes, bounds, nullptr);
  rtcSetGeometryIntersectFunction(shapes, callbacks.intersect);
  rtcSetGeometryOccludedFunction(shapes, callbacks.occluded);
  rtcCommitGeometry(shapes);
  rtcAttachGeometry(scene, shapes);
  rtcReleaseGeometry(shapes);
}

}  // namespace

// Embree holds pointers to the geometry; the scene goes before the device.
struct Intersector::State {
  IntersectorSettings settings;
  Vec3d camera_position{0, 0, 0};
  TraceGeometry geometry;
  std::vector<LightOccluders> occluders;  // by number of the light
  CameraFrame camera;
  SphereBins bins;
  std::optional<EmbreeDevice> device;
  ScenePointer scene, triangle_scene;
  int packet_width = 0;

  bool HasShells() const { return !geometry.shells.empty(); }

  TraceScene Traced() const { return {scene.get(), packet_width, &geometry}; }

  // A committed scene of the spheres, if they are asked for, and of the triangles.
  ScenePointer Build(bool with_spheres);
};

ScenePointer Intersector::State::Build(bool with_spheres) {
  if (!device) {
    device.emplace();
    packet_width = device->packet_width();
  }
  ScenePointer built(rtcNewScene(device->get()));
  device->ThrowIfFailed();
  rtcSetSceneFlags(built.get(), RTC_SCENE_FLAG_ROBUST);
  if (with_spheres && HasShells()) {
    Attach(device->get(), built.get(), &geometry, 1, &ShellBounds, ShellCallbacks());
  } else if (with_spheres) {
    Attach(device->get(), built.get(), &geometry, geometry.spheres.size(), &SphereBounds,
           SphereCallbacks());
  }
  Attach(device->get(), built.get(), &geometry, geometry.triangles.size(), &TriangleBounds,
         TriangleCallbacks());
  HandOver(&geometry);
  WithThreads(settings.threads, [&] { rtcJoinCommitScene(built.get()); });
  TakeOver(&geometry);
  try {
    device->ThrowIfFailed();
  } catch (const Error&) {
    // Left behind: where memory ran out as TBB made a task, the scene's task group counts a task
    // that never was, and to release the scene would wait for it for ever.
    [[maybe_unused]] const RTCScene left = built.release();
    throw;
  }
  return built;
}

Intersector::Intersector(const Scene& scene, const Vec3d& camera_position,
                         const IntersectorSettings& settings)
    : state_(std::make_unique<State>()) {
  State& s = *state_;
  s.settings = settings;
  s.camera_position = camera_position;
  s.geometry = MakeTraceGeometry(scene, camera_position, settings.threads);
  if (settings.embree) BuildTree();
}

void Intersector::BuildTree() {
  if (!state_->scene) state_->scene = state_->Build(true);
}

bool Intersector::SpheresAreNested() const { return state_->HasShells(); }

void Intersector::BuildTriangleTree() {
  if (!state_->triangle_scene) state_->triangle_scene = state_->Build(false);
}

Intersector::~Intersector() = default;
Intersector::Intersector(Intersector&&) noexcept = default;
Intersector& Intersector::operator=(Intersector&&) noexcept = default;

void Intersector::Closest(const RayBatch& rays, ClosestHits* hits) const {
  TraceClosest(state_->Traced(), rays, hits);
}

void Intersector::NearerTriangles(const RayBatch& rays, ClosestHits* hits) const {
  const State& s = *state_;
  TraceNearer({s.triangle_scene.get(), s.packet_width, &s.geometry}, rays, hits);
}

bool Intersector::SphereIsFirst(uint32_t sphere, const RayBatch& rays, size_t ray, double t) const {
  return DepthOn(state_->geometry.spheres[sphere], rays, ray) <= t;
}

bool Intersector::BinForCamera(const CameraFrame& frame, const Window& window, double reach) {
  // 256 MiB; beyond that a tree is better.
  constexpr size_t kMaxEntries = size_t{1} << 26;
  state_->camera = frame;
  return BinSpheres(state_->geometry, frame, window, reach, kMaxEntries, state_->settings.threads,
                    &state_->bins);
}

bool Intersector::EnterTile(const Window& tile, TileRays rays, TileCandidates* candidates) const {
  return GatherTile(state_->geometry, state_->bins, state_->camera, tile, rays, candidates);
}

void Intersector::HitsInTile(const TileCandidates& candidates, const FilmBatch& film,
                             const HitsTo& to) const {
  TraceTile(state_->camera, state_->bins, candidates, film, to);
}

void Intersector::Refine(const RayBatch& rays, const ClosestHits& closest,
                         const uint32_t* ray_indices, size_t count, const HitsTo& to) const {
  RefineHits({state_->geometry, rays, closest, ray_indices, count}, to);
}

void Intersector::FindOccluders(const std::vector<const Light*>& lights, bool outward) {
  State& s = *state_;
  const bool few = s.geometry.spheres.size() <= kMaxListedSpheres;
  // Many lights are shared out among the threads; few have all of them, one after the other.
  const bool many = lights.size() >= 8;
  const int inner = many ? 1 : s.settings.threads;
  const size_t room = kBinRoom / std::max<size_t>(lights.size(), 4);
  s.occluders.resize(lights.size());
  ParallelFor(lights.size(), many ? s.settings.threads : 1, [&](size_t i) {
    LightOccluders& occluders = s.occluders[i];
    const ShadowLight target = MakeShadowLight(*lights[i], s.camera_position);
    occluders.light = target;
    if (few) occluders.lists = ListOccluders(s.geometry, target, outward);
    if (few && occluders.lists.longest <= kMaxListed) return;
    occluders.bins = BinForLight(s.geometry, target, room, inner);
  });
}

void Intersector::FindOccludersOfBall(const std::optional<LightBall>& ball,
                                      const PrimitiveRange& target, bool outward) {
  State& s = *state_;
  s.occluders.push_back({{}, {}, ListOccludersOfBall(s.geometry, ball, target, outward)});
}

void Intersector::ForgetOccluders() { state_->occluders.clear(); }

const LightOccluders& Intersector::Occluders(uint32_t light) const {
  return state_->occluders[light];
}

bool Intersector::MayOcclude(uint32_t light, const HitBatch& hits) const {
  if (light == kAnyLight) return true;
  const State& s = *state_;
  const LightOccluders& occluders = s.occluders[light];
  return occluders.bins || MayShadow(s.geometry, occluders.lists, occluders.light, hits);
}

void Intersector::Occluded(ShadowRayBatch* rays) const {
  if (rays->light == kAnyLight) return TraceOccluded(state_->Traced(), rays);
  const LightOccluders& occluders = state_->occluders[rays->light];
  if (occluders.bins) return OccludedByBins(state_->geometry, *occluders.bins, rays);
  OccludedByLists(state_->geometry, occluders.lists, rays);
}

}  // namespace nacre
