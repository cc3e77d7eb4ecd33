// SPDX-License-Identifier: Apache-2.0
// visibility/intersector.cc: dispatches queries to the shell tree, BVHs, bins or lists.
#include "visibility/intersector.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

#include "base/parallel.h"
#include "scene/scene.h"
#include "visibility/box_trees.h"
#include "visibility/geometry.h"
#include "visibility/refine_kernel.h"
#include "visibility/shell_tree.h"

namespace nacre {

// An entry is the index of a sphere and its pixel rows.
static constexpr size_t kMaxCameraBinEntries =
    kMaxCameraBinBytes / (sizeof(uint32_t) + sizeof(uint16_t));

// On the heap, because BVHs hold pointers to the geometry.
struct Intersector::State {
  IntersectorSettings settings;
  TraceGeometry geometry;
  bool nested = false;
  // Since AreNested was last asked: how many spheres have changed, and the extent then.
  size_t changes = 0;
  double asked_extent = 0;
  std::vector<LightOccluders> occluders;  // by index of the light
  std::vector<LightOccluders> forgotten;  // kept until the next FindOccluders
  CameraFrame camera;
  SphereBins bins;
  bool tree = false;              // BuildTree was called
  std::optional<BoxTrees> boxes;  // nullopt if no BVH is needed

  bool HasShells() const { return !geometry.shells.empty(); }
  void BuildBoxes(BoxTree tree, CancelPointer cancel) {
    if (!boxes) boxes.emplace(&geometry, settings.one_by_one);
    boxes->Build(tree, settings.threads, cancel);
  }
};

Intersector::Intersector(const Scene& scene, const Vec3d& camera_position,
                         const IntersectorSettings& settings)
    : state_(std::make_unique<State>()) {
  State& s = *state_;
  s.settings = settings;
  s.geometry = MakeTraceGeometry(scene, camera_position, settings.threads);
  s.geometry.eye_reach = std::min(settings.eye_reach, 2 * s.geometry.extent);
  s.nested = s.HasShells();
  s.asked_extent = s.geometry.extent;
  if (settings.tree) BuildTree();
}

void Intersector::BuildTree(CancelPointer cancel) {
  State& s = *state_;
  if (s.tree) return;
  TraceGeometry& geometry = s.geometry;
  const bool shells = s.settings.shells || EmbreeVersion() == nullptr;
  if (shells && !s.HasShells()) geometry.shells = BuildShellTree(geometry.spheres);
  const bool spheres_in_boxes = !geometry.spheres.empty() && !s.HasShells();
  if (spheres_in_boxes || !geometry.triangles.empty()) s.BuildBoxes(BoxTree::kAll, cancel);
  s.tree = true;
}

bool Intersector::MoveTo(const Scene& scene, const Vec3d& camera_position) {
  State& s = *state_;
  if (camera_position == s.geometry.eye) return true;
  if (s.HasShells() || (s.boxes && !s.boxes->Serve(camera_position))) return false;
  s.bins = {};
  MoveGeometry(scene, camera_position, s.settings.threads, &s.geometry);
  ForgetOccluders();
  // Spheres that are nearly nested may become nested where their coordinates are rounded to fewer
  // digits, farther from the eye.
  if (s.geometry.extent <= 2 * s.asked_extent) return true;
  s.asked_extent = s.geometry.extent;
  return !AreNested(s.geometry.spheres);
}

bool Intersector::ChangeSpheres(const Scene& scene, const Vec3d& camera_position) {
  State& s = *state_;
  constexpr size_t kMost = 16;
  const bool meshes = !scene.meshes.empty() || !s.geometry.positions.empty();
  if (meshes || s.tree || s.boxes || s.HasShells()) return false;
  if (camera_position != s.geometry.eye) return false;
  const auto changed = nacre::ChangeSpheres(scene, kMost, s.settings.threads, &s.geometry);
  if (!changed) return false;
  if (!s.bins.end.empty() && !ChangeBins(*changed, kMaxCameraBinEntries, &s.bins)) return false;
  ForgetOccluders();
  for (LightOccluders& light : s.forgotten) {
    if (light.bins && !TakeChanged(*changed, &*light.bins)) light.bins.reset();
  }
  // AreNested looks at a sample: a few changes at a time cannot matter to it.
  constexpr size_t kMostUnseen = 64;
  s.changes += changed->size();
  if (s.changes <= kMostUnseen) return true;
  s.changes = 0;
  return !AreNested(s.geometry.spheres);
}

bool Intersector::EyeIsOutside() const { return state_->geometry.eye_outside; }

bool Intersector::SpheresAreNested() const { return state_->nested; }

bool Intersector::HasTree() const { return state_->tree; }

bool Intersector::HasShells() const { return state_->HasShells(); }

void Intersector::BuildTriangleTree(CancelPointer cancel) {
  state_->BuildBoxes(BoxTree::kTriangles, cancel);
}

Intersector::~Intersector() = default;
Intersector::Intersector(Intersector&&) noexcept = default;
Intersector& Intersector::operator=(Intersector&&) noexcept = default;

void Intersector::Closest(const RayBatch& rays, ClosestHits* hits) const {
  const State& s = *state_;
  std::fill(hits->t.begin(), hits->t.end(), std::numeric_limits<double>::infinity());
  std::fill(hits->primitive.begin(), hits->primitive.end(), kNoPrimitive);
  if (s.HasShells()) NearerInShells(s.geometry, rays, hits);
  if (s.boxes) s.boxes->FindNearer(BoxTree::kAll, rays, hits);
}

void Intersector::NearerTriangles(const RayBatch& rays, ClosestHits* hits) const {
  std::fill(hits->primitive.begin(), hits->primitive.end(), kNoPrimitive);
  state_->boxes->FindNearer(BoxTree::kTriangles, rays, hits);
}

bool Intersector::SphereIsFirst(uint32_t sphere, const RayBatch& rays, size_t ray, double t) const {
  return DepthOn(state_->geometry.spheres[sphere], rays, ray) <= t;
}

bool Intersector::BinForCamera(const CameraFrame& frame, const Window& window,
                               double sample_margin) {
  state_->camera = frame;
  return BinSpheres(state_->geometry, frame, window, sample_margin, kMaxCameraBinEntries,
                    state_->settings.threads, &state_->bins);
}

bool Intersector::EnterTile(const Window& tile, TileRays rays, TileCandidates* candidates) const {
  return GatherTile(state_->geometry, state_->bins, state_->camera, tile, rays, candidates);
}

void Intersector::HitsInTile(const TileCandidates& candidates, const FilmBatch& film,
                             const HitOutput& to) const {
  TraceTile(state_->camera, state_->bins, candidates, film, to);
}

void Intersector::Refine(const RayBatch& rays, const ClosestHits& closest,
                         const uint32_t* ray_indices, size_t count, const HitOutput& to) const {
  RefineHits({state_->geometry, rays, closest, ray_indices, count}, to);
}

void Intersector::FindOccluders(const std::vector<const Light*>& lights, bool outward) {
  State& s = *state_;
  const bool few = s.geometry.spheres.size() <= kMaxListedSpheres;
  // Many lights are distributed among the threads; a few follow one another, each on all threads.
  const bool many = lights.size() >= 8;
  const int inner = many ? 1 : s.settings.threads;
  const size_t room = kBinEntryBudget / std::max<size_t>(lights.size(), 4);
  std::vector<LightOccluders> forgotten = std::exchange(s.forgotten, {});
  forgotten.resize(std::max(forgotten.size(), lights.size()));
  s.occluders.resize(lights.size());
  ParallelFor(lights.size(), many ? s.settings.threads : 1, [&](size_t i) {
    LightOccluders& occluders = s.occluders[i];
    const ShadowLight target = MakeShadowLight(*lights[i], s.geometry.eye);
    occluders.light = target;
    occluders.light_in_world = MakeShadowLight(*lights[i], Vec3d(0));
    if (few) occluders.lists = ListOccluders(s.geometry, target, outward);
    if (few && occluders.lists.longest <= kMaxListLength) return;
    LightOccluders& before = forgotten[i];
    if (before.bins && before.light_in_world == occluders.light_in_world &&
        MoveBins(s.geometry, &*before.bins)) {
      occluders.bins = std::move(before.bins);
      return;
    }
    occluders.bins = BinForLight(s.geometry, target, room, inner);
  });
}

void Intersector::FindOccludersOfBall(const std::optional<LightBall>& ball,
                                      const PrimitiveRange& target, bool outward) {
  State& s = *state_;
  s.occluders.emplace_back().lists = ListOccludersOfBall(s.geometry, ball, target, outward);
}

void Intersector::ForgetOccluders() {
  State& s = *state_;
  if (s.occluders.empty()) return;
  s.forgotten = std::move(s.occluders);
  s.occluders.clear();
}

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
  const State& s = *state_;
  if (rays->light != kAnyLight) {
    const LightOccluders& occluders = s.occluders[rays->light];
    if (occluders.bins) return OccludedByBins(s.geometry, *occluders.bins, rays);
    return OccludedByLists(s.geometry, occluders.lists, rays);
  }
  std::fill(rays->occluded.begin(), rays->occluded.end(), uint8_t{0});
  if (s.HasShells()) OccludedInShells(s.geometry, rays);
  if (s.boxes) s.boxes->FindOccluded(rays);
}

}  // namespace nacre
