// SPDX-License-Identifier: Apache-2.0
#include "render/footprint.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace nacre {
namespace {

// The block and the filter's reach around its pixels' centres.
struct Footprint {
  double x0, y0, x1, y1;
};

Footprint FootprintOf(const Window& block, double reach) {
  return {block.x0 + 0.5 - reach, block.y0 + 0.5 - reach, block.x1 - 0.5 + reach,
          block.y1 - 0.5 + reach};
}

// The cone around a footprint: the film is flat, so the farthest ray goes through a corner.
struct FootprintCone {
  Vec3d axis;
  double half_angle;
};

FootprintCone ConeOf(const CameraFrame& frame, const Footprint& f) {
  const auto direction = [&](double x, double y) {
    return (frame.corner + frame.step_x * x + frame.step_y * y).normalized();
  };
  FootprintCone cone{direction((f.x0 + f.x1) / 2, (f.y0 + f.y1) / 2), 0};
  double cosine = 1;
  for (const double x : {f.x0, f.x1}) {
    for (const double y : {f.y0, f.y1}) cosine = std::min(cosine, cone.axis.dot(direction(x, y)));
  }
  // The cosine's rounding, at small angles, is that of its square root.
  cone.half_angle = std::acos(cosine) + 1e-7;
  return cone;
}

bool IsBeside(const FramePlan& plan, const Footprint& f, const FootprintCone& cone,
              const SpherePicture& picture) {
  const ProjectedBounds& b = picture.bounds;
  if (!b.visible || f.x1 < b.x0 || b.x1 < f.x0 || f.y1 < b.y0 || b.y1 < f.y0) return true;
  if (plan.camera.projection != Projection::kPerspective) return false;
  const double cosine = std::clamp(cone.axis.dot(picture.axis), -1.0, 1.0);
  return std::acos(cosine) > picture.half_angle + cone.half_angle + 1e-7;
}

// How many of the footprints' corners hit, block by block: a sphere's picture is convex, so where
// it has all four it covers the block.
void CountCorners(const FramePlan& plan, const Window& cell, const TileWork& work,
                  CellScratch* cell_scratch, int (&counts)[kCellBlocks]) {
  FilmBatch& corners = cell_scratch->corners;
  for (size_t block = 0; block < kCellBlocks; ++block) {
    const Footprint f = FootprintOf(BlockWindow(cell, block), plan.adaptive.reach);
    const double x[4] = {f.x0, f.x1, f.x0, f.x1};
    const double y[4] = {f.y0, f.y0, f.y1, f.y1};
    std::copy_n(x, 4, corners.x.data() + 4 * block);
    std::copy_n(y, 4, corners.y.data() + 4 * block);
  }
  corners.count = 4 * kCellBlocks;
  HitBatch& hits = cell_scratch->corner_hits.batch;
  plan.hits.intersector->HitsInTile(work.sight.spheres, corners,
                                    {&hits, &cell_scratch->corner_hits.directions, false, false});
  for (size_t i = 0; i < hits.count; ++i) ++counts[hits.ray[i] / 4];
}

// Whether no light's shadow can fall on the sphere.
bool IsNeverShadowed(const FramePlan& plan, uint32_t sphere) {
  return std::all_of(
      plan.direct.lights.begin(), plan.direct.lights.end(),
      [&](const PlannedPunctualLight& light) { return NeverShadowed(light, sphere); });
}

// Whether the spheres' surfaces may meet: in a curve that is no outline.
bool Touch(const TraceSphere& a, const TraceSphere& b) {
  return !((a.center - b.center).length() > (a.radius + b.radius) * (1 + 1e-9));
}

// Whether the plane in which parallel rays begin cuts the sphere: where it does is an edge.
bool IsCut(const CameraFrame& frame, const TraceSphere& sphere) {
  return frame.projection == Projection::kOrthographic &&
         !(std::abs(sphere.center.dot(frame.forward)) > sphere.radius);
}

// Whether only outlines can cross a part of the film where no more than these spheres are seen.
bool HasNoEdgeBetweenOutlines(const FramePlan& plan,
                              const std::vector<const TileCandidate*>& spheres) {
  for (size_t i = 0; i < spheres.size(); ++i) {
    if (!IsNeverShadowed(plan, spheres[i]->primitive)) return false;
    if (IsCut(plan.camera, spheres[i]->sphere)) return false;
    for (size_t k = 0; k < i; ++k) {
      if (Touch(spheres[i]->sphere, spheres[k]->sphere)) return false;
    }
  }
  return true;
}

// The largest second differences of a block's values along rows and columns, added.
double Curvature(const double* v) {
  double along_x = 0, along_y = 0;
  constexpr std::ptrdiff_t kSide = kBlockSide;
  for (std::ptrdiff_t i = 0; i < kSide; ++i) {
    for (std::ptrdiff_t j = 1; j + 1 < kSide; ++j) {
      const double* row = v + i * kSide + j;
      const double* column = v + j * kSide + i;
      along_x = std::max(along_x, std::abs(row[-1] - 2 * row[0] + row[1]));
      along_y = std::max(along_y, std::abs(column[-kSide] - 2 * column[0] + column[kSide]));
    }
  }
  return along_x + along_y;
}

bool IsFlat(const AdaptivePlan& plan, const double* values) {
  double darkest = std::abs(values[0]);
  for (size_t i = 1; i < kBlockPixels; ++i) darkest = std::min(darkest, std::abs(values[i]));
  // Written so that NaN is not flat.
  return plan.center_error * Curvature(values) <= Wanted({plan.max_error, plan.white}, darkest);
}

// Whether the normals of the block's hits turn by a small part of the lobe from pixel to pixel.
bool ResolvesLobe(const Soa3<float>& normals, const uint32_t* hits, double width) {
  const auto turn2 = [&](size_t i, size_t k) {
    const double x = normals.x[hits[i]] - normals.x[hits[k]];
    const double y = normals.y[hits[i]] - normals.y[hits[k]];
    const double z = normals.z[hits[i]] - normals.z[hits[k]];
    return x * x + y * y + z * z;
  };
  double most = 0;
  for (size_t i = 0; i < kBlockPixels; ++i) {
    if (i % kBlockSide != 0) most = std::max(most, turn2(i, i - 1));
    if (i >= kBlockSide) most = std::max(most, turn2(i, i - kBlockSide));
  }
  return 16 * most <= width * width;
}

}  // namespace

uint32_t FindPlainBlocks(const FramePlan& plan, const Window& cell, uint32_t blocks, TileWork* work,
                         CellScratch* cell_scratch) {
  cell_scratch->outlines_only = 0;
  if (!plan.adaptive.footprints || !cell_scratch->pictures) return 0;
  int corners[kCellBlocks] = {};
  CountCorners(plan, cell, *work, cell_scratch, corners);
  uint32_t plain = 0;
  std::vector<const TileCandidate*> met;
  for (uint32_t left = blocks; left != 0; left &= left - 1) {
    const auto block = static_cast<size_t>(__builtin_ctz(left));
    const uint32_t bit = 1u << block;
    const Footprint f = FootprintOf(BlockWindow(cell, block), plan.adaptive.reach);
    const FootprintCone cone = ConeOf(plan.camera, f);
    met.clear();
    for (const SpherePicture& picture : *cell_scratch->pictures) {
      if (!IsBeside(plan, f, cone, picture)) met.push_back(picture.candidate);
    }
    if (!HasNoEdgeBetweenOutlines(plan, met)) continue;
    cell_scratch->outlines_only |= bit;
    const bool covered = met.size() == 1 && corners[block] == 4 && !met[0]->around_camera;
    if ((met.empty() && corners[block] == 0) || covered) plain |= bit;
  }
  return plain;
}

bool IsSmooth(const FramePlan& plan, size_t first_ray, const Soa3<double>& values,
              const uint32_t* hit_of_ray, const TileWork& s) {
  const uint32_t* const hits = hit_of_ray + first_ray;
  if (hits[0] == kNoHit) return true;  // beside all spheres
  const MaterialId material = MaterialAt(plan.surfaces, s.surfaces.hits.primitive[hits[0]], 0);
  return IsFlat(plan.adaptive, values.x.data() + first_ray) &&
         IsFlat(plan.adaptive, values.y.data() + first_ray) &&
         IsFlat(plan.adaptive, values.z.data() + first_ray) &&
         ResolvesLobe(s.surfaces.surface.normal, hits, plan.adaptive.widths[material.index]);
}

}  // namespace nacre
