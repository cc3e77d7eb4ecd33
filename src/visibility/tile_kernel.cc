// visibility/tile_kernel.cc: packets of camera rays against the candidates of their cell.
#include "visibility/tile_kernel.h"

#include <algorithm>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "visibility/tile_kernel.cc"
#include "hwy/foreach_target.h"

#include "visibility/fill_packet-inl.h"
#include "visibility/sphere_packet-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;

// The distance from the camera beyond which no lane of the packet looks: t |direction| of the best
// hits, rounded up; infinite while any lane has none.
HWY_INLINE double Reach(const Packet& packet, uint32_t lanes) {
  double reach2 = 0;
  for (; lanes != 0; lanes &= lanes - 1) {
    const int lane = __builtin_ctz(lanes);
    reach2 = std::max(reach2, packet.best_t[lane] * packet.best_t[lane] / packet.inverse_dd[lane]);
  }
  return std::sqrt(reach2) * (1 + 1e-6);
}

HWY_INLINE void TraceCell(const std::vector<TileCandidate>& candidates, uint32_t lanes,
                          Packet* packet) {
  double reach = std::numeric_limits<double>::infinity();
  uint32_t since_reach = 0;
  for (const TileCandidate& candidate : candidates) {
    if (candidate.near > reach) return;
    IntersectLanes(candidate.sphere, candidate.primitive, lanes, packet);
    // Now and then: it costs as much as a proposal.
    if ((++since_reach & 3) == 0) reach = Reach(*packet, lanes);
  }
}

void TraceTileT(const TraceGeometry& geometry, const SphereBins& bins,
                const TileCandidates& candidates, int samples, const RayBatch& rays,
                ClosestHits* hits) {
  Packet packet;
  packet.width = kMaxPacketWidth;
  packet.geometry = &geometry;
  const Window& tile = candidates.tile;
  const size_t width = packet.Width();
  const auto pixels_across = static_cast<size_t>(tile.width());
  const auto samples_each = static_cast<size_t>(samples);
  for (size_t first = 0; first < rays.count; first += width) {
    packet.best_t = hits->t.data() + first;
    packet.best_primitive = hits->primitive.data() + first;
    std::fill_n(packet.best_t, width, std::numeric_limits<double>::infinity());
    std::fill_n(packet.best_primitive, width, kNoPrimitive);
    // The packet's cells: those of its pixels, or, where it goes on in the next row, the tile's.
    const size_t count = std::min(width, rays.count - first);
    const size_t first_pixel = first / samples_each;
    const size_t last_pixel = (first + count - 1) / samples_each;
    size_t begin = 0;
    size_t end = candidates.cells.size();
    if (first_pixel / pixels_across == last_pixel / pixels_across) {
      const auto cell = [&](size_t pixel) {
        const int x = tile.x0 + static_cast<int>(pixel % pixels_across) - bins.window.x0;
        return static_cast<size_t>(x / kCellSize - candidates.first_column);
      };
      begin = cell(first_pixel);
      end = cell(last_pixel) + 1;
    }
    const bool none = std::all_of(candidates.cells.begin() + static_cast<std::ptrdiff_t>(begin),
                                  candidates.cells.begin() + static_cast<std::ptrdiff_t>(end),
                                  [](const auto& cell) { return cell.empty(); });
    if (none) continue;
    FillPacket(rays, first, &packet);
    const uint32_t lanes = (1u << count) - 1;
    for (size_t cell = begin; cell < end; ++cell) {
      TraceCell(candidates.cells[cell], lanes, &packet);
    }
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nacre {
namespace {

// A float not above the sphere's nearest distance: along the view where all rays go that way.
float NearBound(const TraceSphere& sphere, const CameraFrame& frame) {
  const double distance = frame.projection == Projection::kPerspective
                              ? sphere.center.length()
                              : sphere.center.dot(frame.forward);
  const double near = distance - sphere.radius - 1e-6 * (std::abs(distance) + sphere.radius);
  return static_cast<float>(std::max(near, 0.0)) * (1 - 0x1p-22f);
}

}  // namespace

HWY_EXPORT(TraceTileT);

bool GatherTile(const TraceGeometry& geometry, const SphereBins& bins, const CameraFrame& frame,
                const Window& tile, TileCandidates* candidates) {
  const int row = (tile.y0 - bins.window.y0) / kCellSize;
  const int first = (tile.x0 - bins.window.x0) / kCellSize;
  const int last = (tile.x1 - 1 - bins.window.x0) / kCellSize;
  candidates->tile = tile;
  candidates->first_column = first;
  candidates->cells.resize(static_cast<size_t>(last - first + 1));
  bool any = false;
  for (int column = first; column <= last; ++column) {
    std::vector<TileCandidate>& cell = candidates->cells[static_cast<size_t>(column - first)];
    cell.clear();
    const size_t number = bins.Cell(column, row);
    for (uint32_t i = bins.Begin(number); i < bins.end[number]; ++i) {
      const uint32_t sphere = bins.spheres[i];
      const TraceSphere& traced = geometry.spheres[sphere];
      cell.push_back({traced, sphere, NearBound(traced, frame)});
    }
    std::sort(cell.begin(), cell.end(),
              [](const TileCandidate& a, const TileCandidate& b) { return a.near < b.near; });
    any = any || !cell.empty();
  }
  return any;
}

void TraceTile(const TraceGeometry& geometry, const SphereBins& bins,
               const TileCandidates& candidates, int samples, const RayBatch& rays,
               ClosestHits* hits) {
  HWY_DYNAMIC_DISPATCH(TraceTileT)(geometry, bins, candidates, samples, rays, hits);
}
}  // namespace nacre
#endif
