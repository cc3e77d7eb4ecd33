// SPDX-License-Identifier: Apache-2.0
// visibility/tile_kernel.cc: traces the camera rays of a tile, in packets or against a single
// sphere, and writes their hits.
#include "visibility/tile_kernel.h"

#include <algorithm>
#include <cmath>
#include <optional>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "visibility/tile_kernel.cc"
#include "hwy/foreach_target.h"

#include "visibility/multi_sphere-inl.h"
#include "visibility/refine_kernel.h"
#include "visibility/single_sphere-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre::HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;

template <bool kPerspective>
HWY_INLINE void AppendHits(const CameraFrame& frame, const CameraPacket& packet, uint32_t first_ray,
                           const HitOutput& to) {
  const CameraDouble d;
  const int step = static_cast<int>(hn::Lanes(d));
  HitWriter writer(to);
  for (int lane = 0; lane < kCameraPacket; lane += step) {
    const uint32_t bits = (packet.hit >> lane) & ((1u << step) - 1);
    if (bits == 0) continue;
    const auto direction = ExactDirection<kPerspective>(d, frame, lane, packet);
    const auto inverse_length = hn::Load(d, packet.inverse_length + lane);
    const auto normal = Load3(d, packet.normal, lane);
    const auto radius = hn::Load(d, packet.signed_radius + lane);
    const auto position = [&]() HWY_ATTR {
      return SpherePosition(Load3(d, packet.center, lane), normal, radius);
    };
    writer.Surfaces(normal, Scale(direction, hn::Neg(inverse_length)), position, bits,
                    first_ray + static_cast<uint32_t>(lane));
    writer.Primitives(packet.primitive + lane, bits);
  }
}

// Fills the entries behind the last hit, up to a whole vector, with copies of it.
template <class T>
void PadSoa(size_t count, Soa3<T>* soa) {
  for (AlignedArray<T>* const array : {&soa->x, &soa->y, &soa->z}) {
    std::fill(array->begin() + count, array->begin() + RoundUp(count, kBatchPadding),
              (*array)[count - 1]);
  }
}

void PadHits(const HitOutput& to) {
  const size_t count = to.hits->count;
  if (count == 0) return;
  if (to.positions) PadSoa(count, &to.hits->position);
  PadSoa(count, &to.directions->normal);
  PadSoa(count, &to.directions->to_view);
  if (!to.exact_directions) return;
  PadSoa(count, &to.hits->normal);
  PadSoa(count, &to.hits->to_view);
}

// The cell's only candidate, if it lies in front of a perspective camera; else null.
template <bool kPerspective>
HWY_INLINE const TileCandidate* SingleSphereIn(const std::vector<TileCandidate>& cell) {
  return kPerspective && cell.size() == 1 && cell[0].in_front ? &cell[0] : nullptr;
}

// Traces the rays of the columns [x, x_end) of a pixel row, which may hit any spheres. `begin_ray`
// is the index of the first ray in the batch. packet->pixel_rows is the row within the cells. In a
// tile of one cell any consecutive rays may be passed, with all bits of pixel_rows set.
template <bool kPerspective>
HWY_NOINLINE void TraceRow(const CameraFrame& frame, const SphereBins& bins,
                           const TileCandidates& candidates, const FilmBatch& film,
                           size_t begin_ray, int x, int x_end, CameraPacket* packet,
                           const HitOutput& to) {
  const int left = candidates.tile.x0 - bins.window.x0;
  const auto cell_at = [&](int column) {
    return candidates.cells.data() + ((left + column) / kCellSize - candidates.first_column);
  };
  for (size_t first = begin_ray; x < x_end; x += kCameraPacket, first += kCameraPacket) {
    const int width = std::min(kCameraPacket, x_end - x);
    const std::vector<TileCandidate>* begin = cell_at(x);
    const std::vector<TileCandidate>* const end = cell_at(x + width - 1) + 1;
    while (begin != end && begin->empty()) ++begin;
    if (begin == end) continue;
    packet->lanes = (1u << width) - 1;
    packet->film_x = film.x.data() + first;
    packet->film_y = film.y.data() + first;
    TracePacket<kPerspective>(frame, begin, end, packet);
    if (packet->hit == 0) continue;
    AppendHits<kPerspective>(frame, *packet, static_cast<uint32_t>(first), to);
  }
}

template <bool kPerspective>
HWY_INLINE void TraceSamples(const CameraFrame& frame, const SphereBins& bins,
                             const TileCandidates& candidates, const FilmBatch& film,
                             SingleSphereBlock* block, const HitOutput& to) {
  const Window& tile = candidates.tile;
  const bool every_pixel = film.pixels == tile.pixel_count();
  const auto width = static_cast<uint32_t>(tile.width());
  const auto first_row = static_cast<uint32_t>((tile.y0 - bins.window.y0) % kCellSize);
  std::optional<CameraPacket> packet;  // large, and few tiles need it
  SingleSphereRays rays{nullptr, 0, 0};
  const auto trace_single = [&]() HWY_ATTR {
    if (rays.count > 0) AddSingleSphereRays(frame, film, rays, block, to);
    rays.count = 0;
  };
  for (size_t sample = 0; sample < film.count; sample += film.pixels) {
    auto next = static_cast<uint32_t>(sample);
    for (const PixelSpan& span : candidates.spans) {
      const uint32_t begin = every_pixel ? static_cast<uint32_t>(sample) + span.first : next;
      next += span.count;
      if (kPerspective && span.single_sphere != nullptr) {
        if (span.single_sphere != rays.candidate || begin != rays.first + rays.count) {
          trace_single();
          rays = {span.single_sphere, begin, 0};
        }
        rays.count += span.count;
        continue;
      }
      trace_single();
      TraceBlock(frame, film, block, to);
      if (!packet) packet.emplace();
      const auto x = static_cast<int>(span.first % width);
      packet->pixel_rows = 1u << (first_row + span.first / width);
      TraceRow<kPerspective>(frame, bins, candidates, film, begin, x,
                             x + static_cast<int>(span.count), &*packet, to);
    }
  }
  trace_single();
  TraceBlock(frame, film, block, to);
}

template <bool kPerspective>
HWY_INLINE void TraceAny(const CameraFrame& frame, const SphereBins& bins,
                         const TileCandidates& candidates, const FilmBatch& film,
                         SingleSphereBlock* block, const HitOutput& to) {
  const TileCandidate* const single = SingleSphereIn<kPerspective>(candidates.cells[0]);
  CameraPacket packet;
  if (single != nullptr) return TraceSingleSphere(frame, *single, film, &packet, block, to);
  const size_t width = kCameraPacket;
  packet.pixel_rows = ~0u;
  for (size_t first = 0; first < film.count; first += width) {
    const auto rays = static_cast<int>(std::min(width, film.count - first));
    TraceRow<kPerspective>(frame, bins, candidates, film, first, 0, rays, &packet, to);
  }
}

template <bool kPerspective>
HWY_INLINE void TraceRays(const CameraFrame& frame, const SphereBins& bins,
                          const TileCandidates& candidates, const FilmBatch& film,
                          const HitOutput& to) {
  SingleSphereBlock block;
  if (candidates.rays == TileRays::kSamples) {
    TraceSamples<kPerspective>(frame, bins, candidates, film, &block, to);
  } else {
    TraceAny<kPerspective>(frame, bins, candidates, film, &block, to);
  }
}

void TraceTileT(const CameraFrame& frame, const SphereBins& bins, const TileCandidates& candidates,
                const FilmBatch& film, const HitOutput& to) {
  to.hits->count = 0;
  to.hits->one_primitive = true;
  if (frame.projection == Projection::kPerspective) {
    TraceRays<true>(frame, bins, candidates, film, to);
  } else {
    TraceRays<false>(frame, bins, candidates, film, to);
  }
  PadHits(to);
}

}  // namespace
}  // namespace nacre::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nacre {
namespace {

// A float that is not below v, for v >= 0.
float UpperFloat(double v) { return static_cast<float>(v) * (1 + 0x1p-22f); }

// A lower bound, in float, of the distance from the camera at which rays meet the sphere; for an
// orthographic camera, of the depth.
float NearBound(const TraceSphere& sphere, double eye_distance, const CameraFrame& frame) {
  const double distance = frame.projection == Projection::kPerspective
                              ? eye_distance
                              : sphere.center.dot(frame.forward);
  const double near = distance - sphere.radius - 1e-6 * (std::abs(distance) + sphere.radius);
  return static_cast<float>(std::max(near, 0.0)) * (1 - 0x1p-22f);
}

// An upper bound of the coordinates of the rays' varying vectors, and of every sum in computing
// them. Film positions lie within the window extended by the pixel filter's radius, far less than
// 64 pixels.
double VaryingBound(const CameraFrame& frame, const Window& window) {
  return SumOfAbs(frame.corner) + SumOfAbs(frame.step_x) * (window.x1 + 64) +
         SumOfAbs(frame.step_y) * (window.y1 + 64);
}

// The radius plus an upper bound of the errors of the float test, with u = kFloatUnit. The varying
// vectors in float err by at most 8 u `varying`: two roundings of the factors and two of the sums.
// |direction| is at least 1, so the cross product with the centre, over that length, errs by (8 u
// varying + 8 u) |center|, and the dot product by no more. An orthographic ray's origin itself errs
// by 8 u varying, and its difference from the centre and the cross product by 16 u of both.
float RadiusBound(const TraceSphere& sphere, const CameraFrame& frame, double varying) {
  const double center = SumOfAbs(sphere.center);
  const double error = frame.projection == Projection::kPerspective
                           ? center * (8 * varying + 16)
                           : 8 * varying + 16 * (center + varying);
  return UpperFloat(sphere.radius + kFloatUnit * error);
}

TileCandidate MakeCandidate(const TraceSphere& sphere, uint32_t primitive, uint16_t pixel_rows,
                            const CameraFrame& frame, double varying, Products products) {
  TileCandidate candidate;
  candidate.sphere = sphere;
  candidate.radius2 = sphere.radius * sphere.radius;
  candidate.primitive = primitive;
  candidate.pixel_rows = pixel_rows;
  const double distance2 = Dot(sphere.center, sphere.center, products);
  const double distance = std::sqrt(distance2);
  // This has the sign of the product of the roots in TestSphere.
  candidate.around_camera = !(distance2 - candidate.radius2 > 0);
  candidate.in_front = IsInFront(sphere, frame.forward);
  candidate.near = NearBound(sphere, distance, frame);
  for (int c = 0; c < 3; ++c) candidate.center[c] = static_cast<float>(sphere.center[c]);
  candidate.radius_bound = RadiusBound(sphere, frame, varying);
  return candidate;
}

}  // namespace

HWY_EXPORT(TraceTileT);

bool GatherTile(const TraceGeometry& geometry, const SphereBins& bins, const CameraFrame& frame,
                const Window& tile, TileRays rays, TileCandidates* candidates) {
  const int row = (tile.y0 - bins.window.y0) / kCellSize;
  const int first = (tile.x0 - bins.window.x0) / kCellSize;
  const int last = (tile.x1 - 1 - bins.window.x0) / kCellSize;
  candidates->tile = tile;
  candidates->rays = rays;
  candidates->first_column = first;
  candidates->cells.resize(static_cast<size_t>(last - first) + 1);
  for (std::vector<TileCandidate>& cell : candidates->cells) cell.clear();
  candidates->spheres = 0;
  candidates->spans.clear();
  // The cells of a row are consecutive.
  const uint32_t entries = bins.end[bins.Cell(last, row)] - bins.Begin(bins.Cell(first, row));
  if (entries == 0) return false;
  candidates->projected.clear();
  candidates->projected.reserve(entries);
  const double varying = VaryingBound(frame, bins.window);
  const ProjectedTestView view = MakeProjectedTestView(frame);
  const Products products = TargetProducts();
  // The spheres of the cell to the left that have not been compared yet, and their candidates.
  uint32_t before = 0, before_end = 0;
  const TileCandidate* made = nullptr;
  for (int column = first; column <= last; ++column) {
    std::vector<TileCandidate>& cell = candidates->cells[static_cast<size_t>(column - first)];
    const size_t number = bins.Cell(column, row);
    for (uint32_t i = bins.Begin(number); i < bins.end[number]; ++i) {
      const uint32_t sphere = bins.spheres[i];
      while (before < before_end && bins.spheres[before] < sphere) ++before, ++made;
      if (before < before_end && bins.spheres[before] == sphere) {
        cell.push_back(*made);  // in the same row of cells, so its pixel rows are the same
        cell.back().in_cell_before = true;
        continue;
      }
      cell.push_back(MakeCandidate(geometry.spheres[sphere], sphere, bins.pixel_rows[i], frame,
                                   varying, products));
      if (UsesProjectedTest(geometry.spheres[sphere], view)) {
        candidates->projected.push_back(
            MakeProjectedSphere(geometry.spheres[sphere], view.forward));
        cell.back().projected = &candidates->projected.back();
      }
      ++candidates->spheres;
    }
    before = bins.Begin(number);
    before_end = bins.end[number];
    made = cell.data();
  }
  for (std::vector<TileCandidate>& cell : candidates->cells) {
    std::sort(cell.begin(), cell.end(),
              [](const TileCandidate& a, const TileCandidate& b) { return a.near < b.near; });
  }
  if (rays == TileRays::kSamples) FindPixelSpans(bins, candidates);
  return true;
}

void TraceTile(const CameraFrame& frame, const SphereBins& bins, const TileCandidates& candidates,
               const FilmBatch& film, const HitOutput& to) {
  HWY_DYNAMIC_DISPATCH(TraceTileT)(frame, bins, candidates, film, to);
}
}  // namespace nacre
#endif
