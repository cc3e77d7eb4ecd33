// SPDX-License-Identifier: Apache-2.0
#include "render/footprint.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include <Imath/ImathBox.h>

namespace nacre {
namespace {

// The part of the film, in pixels, that the samples of a block lie in.
using Footprint = Imath::Box2d;

Footprint FootprintOf(const Window& block, double filter_radius) {
  return {Vec2d(block.x0 + 0.5 - filter_radius, block.y0 + 0.5 - filter_radius),
          Vec2d(block.x1 - 0.5 + filter_radius, block.y1 - 0.5 + filter_radius)};
}

// A cone around a footprint's rays. The film is flat, so the rays farthest from the axis go
// through the corners.
struct FootprintCone {
  Vec3d axis;
  double half_angle;
};

FootprintCone BoundingCone(const CameraFrame& frame, const Footprint& f) {
  const auto direction = [&](double x, double y) {
    return (frame.corner + frame.step_x * x + frame.step_y * y).normalized();
  };
  FootprintCone cone{direction(f.center().x, f.center().y), 0};
  double cosine = 1;
  for (const double x : {f.min.x, f.max.x}) {
    for (const double y : {f.min.y, f.max.y})
      cosine = std::min(cosine, cone.axis.dot(direction(x, y)));
  }
  // At small angles the cosine's rounding error becomes its square root in the angle.
  cone.half_angle = std::acos(cosine) + 1e-7;
  return cone;
}

// Whether no ray of the footprint can hit the sphere.
bool MissesSphere(const FramePlan& plan, const Footprint& f, const FootprintCone& cone,
                  const SphereProjection& projection) {
  const ProjectedBounds& b = projection.bounds;
  if (!b.visible || f.max.x < b.x0 || b.x1 < f.min.x || f.max.y < b.y0 || b.y1 < f.min.y)
    return true;
  if (plan.camera.projection != Projection::kPerspective) return false;
  const double cosine = std::clamp(cone.axis.dot(projection.axis), -1.0, 1.0);
  return std::acos(cosine) > projection.half_angle + cone.half_angle + 1e-7;
}

// Counts, for each block, the corners of its footprint that hit. The projection of a sphere is
// convex: if all four corners hit the same sphere, it covers the block.
void CountCornerHits(const FramePlan& plan, const Window& cell, TileWork* work,
                     int (&counts)[kCellBlocks]) {
  FilmBatch& corners = work->samples.film;
  for (size_t block = 0; block < kCellBlocks; ++block) {
    const Footprint f = FootprintOf(BlockWindow(cell, block), plan.adaptive.filter_radius);
    const double x[4] = {f.min.x, f.max.x, f.min.x, f.max.x};
    const double y[4] = {f.min.y, f.min.y, f.max.y, f.max.y};
    std::copy_n(x, 4, corners.x.data() + 4 * block);
    std::copy_n(y, 4, corners.y.data() + 4 * block);
  }
  corners.count = 4 * kCellBlocks;
  HitBatch& hits = work->hits.batch;
  plan.hits.shapes.intersector->HitsInTile(work->shapes.spheres, corners,
                                           {&hits, &work->hits.directions, false, false});
  for (size_t i = 0; i < hits.count; ++i) ++counts[hits.ray[i] / 4];
}

// Whether no light's shadow can fall on the sphere.
bool IsUnshadowed(const FramePlan& plan, uint32_t sphere) {
  return std::ranges::all_of(plan.direct.shadows.punctual, [&](const LightShadows& light) {
    return NeverShadowed(light, sphere);
  });
}

// Whether the spheres may intersect, in a curve that is an edge but no outline.
bool MayIntersect(const TraceSphere& a, const TraceSphere& b) {
  return !((a.center - b.center).length() > (a.radius + b.radius) * (1 + 1e-9));
}

// Whether the plane in which an orthographic camera's rays start cuts the sphere: the cut is an
// edge.
bool IsCutByCamera(const CameraFrame& frame, const TraceSphere& sphere) {
  return frame.projection == Projection::kOrthographic &&
         !(std::abs(sphere.center.dot(frame.forward)) > sphere.radius);
}

// Whether the only edges in a part of the film are outlines, if only these spheres are visible
// there.
bool HasOnlyOutlines(const FramePlan& plan, const std::vector<const TileCandidate*>& spheres) {
  for (size_t i = 0; i < spheres.size(); ++i) {
    if (!IsUnshadowed(plan, spheres[i]->primitive)) return false;
    if (IsCutByCamera(plan.camera, spheres[i]->sphere)) return false;
    for (size_t k = 0; k < i; ++k) {
      if (MayIntersect(spheres[i]->sphere, spheres[k]->sphere)) return false;
    }
  }
  return true;
}

// The largest second difference of a block's values along rows plus that along columns.
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

// Whether the curvature of the values is within the tolerance.
bool HasSmallCurvature(const AdaptivePlan& plan, const double* values) {
  double darkest = std::abs(values[0]);
  for (size_t i = 1; i < kBlockPixels; ++i) darkest = std::min(darkest, std::abs(values[i]));
  // Written so that NaN is refused.
  return plan.center_error * Curvature(values) <=
         ToleranceAt({plan.max_error, plan.white}, darkest);
}

// Whether normals turn from pixel to pixel by at most a quarter of the lobe's width.
bool ResolvesLobe(const Soa3<float>& normals, const uint32_t* hits, double width) {
  const auto distance2 = [&](size_t i, size_t k) {
    const double x = normals.x[hits[i]] - normals.x[hits[k]];
    const double y = normals.y[hits[i]] - normals.y[hits[k]];
    const double z = normals.z[hits[i]] - normals.z[hits[k]];
    return x * x + y * y + z * z;
  };
  double largest = 0;
  for (size_t i = 0; i < kBlockPixels; ++i) {
    if (i % kBlockSide != 0) largest = std::max(largest, distance2(i, i - 1));
    if (i >= kBlockSide) largest = std::max(largest, distance2(i, i - kBlockSide));
  }
  return 16 * largest <= width * width;
}

}  // namespace

BlockEdges FindEdges(const FramePlan& plan, const Window& cell, uint32_t blocks,
                     const CellProjections& projections, TileWork* work) {
  BlockEdges edges;
  if (!plan.adaptive.footprints || !projections) return edges;
  int corners[kCellBlocks] = {};
  CountCornerHits(plan, cell, work, corners);
  std::vector<const TileCandidate*> visible;
  ForEachBlock(blocks, [&](size_t block) {
    const uint32_t bit = 1u << block;
    const Footprint f = FootprintOf(BlockWindow(cell, block), plan.adaptive.filter_radius);
    const FootprintCone cone = BoundingCone(plan.camera, f);
    visible.clear();
    for (const SphereProjection& projection : *projections) {
      if (!MissesSphere(plan, f, cone, projection)) visible.push_back(projection.candidate);
    }
    if (!HasOnlyOutlines(plan, visible)) return;
    edges.only_outlines |= bit;
    const bool covered = visible.size() == 1 && corners[block] == 4 && !visible[0]->around_camera;
    if ((visible.empty() && corners[block] == 0) || covered) edges.none |= bit;
  });
  return edges;
}

bool IsSmooth(const FramePlan& plan, size_t first_ray, const Soa3<double>& values,
              const uint32_t* hit_of_ray, const TileWork& work) {
  const uint32_t* const hits = hit_of_ray + first_ray;
  if (hits[0] == kNoHit) return true;  // the block lies beside all spheres
  const MaterialId material = MaterialAt(plan.surfaces, work.surfaces.hits.primitive[hits[0]], 0);
  return HasSmallCurvature(plan.adaptive, values.x.data() + first_ray) &&
         HasSmallCurvature(plan.adaptive, values.y.data() + first_ray) &&
         HasSmallCurvature(plan.adaptive, values.z.data() + first_ray) &&
         ResolvesLobe(work.surfaces.surface.normal, hits,
                      plan.adaptive.highlights.lobe_widths[material.index]);
}

}  // namespace nacre
