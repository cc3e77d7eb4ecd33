// SPDX-License-Identifier: Apache-2.0
#include "render/rare_texels.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "light/environment.h"
#include "render/filter_shares.h"
#include "render/probes.h"
#include "render/texel_maps.h"
#include "scene/mesh.h"
#include "scene/texture_mapping.h"

namespace nacre {
namespace {

// The pixels of a cell, and those around it that the filters of its pixels cover the middles of.
Window PixelsAround(const Window& cell, const Window& frame, double filter_radius) {
  const int border = static_cast<int>(std::ceil(filter_radius - 0.5));
  return Intersect({cell.x0 - border, cell.y0 - border, cell.x1 + border, cell.y1 + border}, frame);
}

struct FilmRay {
  Vec3d origin, direction;
};

FilmRay RayThrough(const CameraFrame& camera, double x, double y) {
  const Vec3d place = camera.corner + camera.step_x * x + camera.step_y * y;
  if (camera.projection == Projection::kPerspective) return {Vec3d(0, 0, 0), place};
  return {place, camera.forward};
}

// The point of a primitive's plane or sphere that the ray meets, relative to the camera.
Vec3d MeetPrimitive(const FramePlan& plan, uint32_t primitive, const FilmRay& ray) {
  const Scene& scene = *plan.scene;
  if (!IsSphere(plan.surfaces.primitives, primitive)) {
    const TriangleRef triangle = TriangleOf(plan.surfaces.primitives, primitive);
    const Vec3d normal = FaceNormal(*triangle.mesh, triangle.triangle);
    const Vec3d corner = triangle.mesh->positions[triangle.Vertex(0)] - scene.camera.position;
    const double t = (corner - ray.origin).dot(normal) / ray.direction.dot(normal);
    return ray.origin + ray.direction * t;
  }
  const Sphere& sphere = scene.spheres[primitive];
  const Vec3d from_center = ray.origin - (sphere.center - scene.camera.position);
  const double dd = ray.direction.dot(ray.direction), half_b = from_center.dot(ray.direction);
  const double c = from_center.dot(from_center) - sphere.radius * sphere.radius;
  const double root = std::sqrt(std::max(half_b * half_b - dd * c, 0.0));
  return ray.origin + ray.direction * ((c > 0 ? -half_b - root : -half_b + root) / dd);
}

// (u, v) at a point of the primitive, not wrapped.
Vec2d MapPoint(const FramePlan& plan, uint32_t primitive, const Texture& texture,
               const Vec3d& point) {
  const Scene& scene = *plan.scene;
  const Vec3d in_world = point + scene.camera.position;
  if (IsSphere(plan.surfaces.primitives, primitive)) {
    const Sphere& sphere = scene.spheres[primitive];
    return MapToTexture(texture, (in_world - sphere.center) / sphere.radius);
  }
  if (texture.mapping != MappingKind::kUv) {
    return MapToTexture(texture, (in_world - texture.center) / texture.size);
  }
  const TriangleRef triangle = TriangleOf(plan.surfaces.primitives, primitive);
  const Mesh& mesh = *triangle.mesh;
  const auto& uvs = texture.second_uvs && !mesh.second_uvs.empty() ? mesh.second_uvs : mesh.uvs;
  const Vec3d& a = mesh.positions[triangle.Vertex(0)];
  const Vec3d e1 = mesh.positions[triangle.Vertex(1)] - a;
  const Vec3d e2 = mesh.positions[triangle.Vertex(2)] - a;
  const Vec3d n = e1.cross(e2), from_a = in_world - a;
  const double b1 = e2.cross(n).dot(from_a) / n.length2();
  const double b2 = n.cross(e1).dot(from_a) / n.length2();
  const Vec2d uv = uvs[triangle.Vertex(0)];
  return TransformOf(texture).Apply(uv + (uvs[triangle.Vertex(1)] - uv) * b1 +
                                    (uvs[triangle.Vertex(2)] - uv) * b2);
}

// (u, v) at the middle of a pixel, not wrapped, and their derivatives along the film.
struct MappedPixel {
  Vec2d uv, dx, dy;
};

// `at`: (u, v) at an offset from the middle, in pixels.
template <class At>
MappedPixel MapPixel(const At& at) {
  constexpr double kStep = 1.0 / 64;  // so small that a seam hardly ever lies on it
  const Vec2d uv = at(0, 0);
  return {uv, (at(kStep, 0) - uv) / kStep, (at(0, kStep) - uv) / kStep};
}

// The offset at which (u, v) are what they would be at `offset` if they were linear: by Newton's
// method. Where it leads elsewhere, as across a seam, `offset` itself.
template <class At>
Vec2d Aim(const MappedPixel& pixel, const At& at, const Vec2d& offset) {
  const Vec2d target = pixel.uv + pixel.dx * offset.x + pixel.dy * offset.y;
  const double determinant = pixel.dx.cross(pixel.dy);
  Vec2d found = offset;
  for (int i = 0; i < 3; ++i) {
    const Vec2d off = at(found.x, found.y) - target;
    found -= Vec2d(off.cross(pixel.dy), pixel.dx.cross(off)) / determinant;
  }
  return (found - offset).length() < 0.5 ? found : offset;
}

// A pixel in whose middle texels were found, and where.
struct FoundTexels {
  int x, y;
  TexelCluster cluster;
};

class TexelFinder {
 public:
  TexelFinder(const FramePlan& plan, std::vector<FoundTexels>* found)
      : plan_(plan), maps_(*plan.adaptive.texel_maps), found_(found) {}

  // In the maps of what the ray through the middle of the pixel meets.
  void SearchMaps(int x, int y, uint32_t primitive, const std::vector<TexelMap>& maps,
                  bool whole_image) {
    for (const TexelMap& map : maps) {
      const Texture& texture = plan_.scene->textures[map.texture.index];
      const auto at = [&](double dx, double dy) {
        const FilmRay ray = RayThrough(plan_.camera, x + 0.5 + dx, y + 0.5 + dy);
        return MapPoint(plan_, primitive, texture, MeetPrimitive(plan_, primitive, ray));
      };
      const MappedPixel pixel = MapPixel(at);
      size_t level = 0;
      if (texture.sampling.filter == TextureFilter::kTrilinear && !whole_image) {
        const Vec2d dx = pixel.dx * plan_.surfaces.textures.footprint;
        const Vec2d dy = pixel.dy * plan_.surfaces.textures.footprint;
        level = static_cast<size_t>(MipLevelOf(*plan_.scene->images[texture.image.index].texels,
                                               TextureFootprint<double>{dx.x, dx.y, dy.x, dy.y}));
      }
      Search(x, y, pixel, at, GridOf(*plan_.scene, map.texture, level),
             level == 0 ? maps_.extremes[map.texture.index].get() : nullptr, map.measures);
    }
  }

  // In the sky that the pixel shows.
  void SearchSky(int x, int y) {
    const ShadingSky& sky = plan_.direct.sampled_lights[*plan_.direct.sky].light.sky;
    const auto on_map = [&](double dx, double dy) {
      const Vec3d to = RayThrough(plan_.camera, x + 0.5 + dx, y + 0.5 + dy).direction;
      const auto [u, v] =
          LatLongFromDirection(Vec3d(to.x * sky.cos_rotation - to.z * sky.sin_rotation, to.y,
                                     to.z * sky.cos_rotation + to.x * sky.sin_rotation));
      return Vec2d(u, v);
    };
    const Vec2d middle = on_map(0, 0);
    const auto at = [&](double dx, double dy) {
      const Vec2d uv = on_map(dx, dy);
      return Vec2d(uv.x - std::round(uv.x - middle.x), uv.y);  // on the same side of the seam
    };
    Search(x, y, MapPixel(at), at, maps_.sky, maps_.sky_extremes.get(), maps_.sky_measures);
  }

 private:
  template <class At>
  void Search(int x, int y, const MappedPixel& pixel, const At& at, const TexelGrid& grid,
              const TexelExtremes* extremes, const std::vector<TexelMeasure>& measures) {
    const double w = grid.texels.width, h = grid.texels.height;
    clusters_.clear();
    FindTexelClusters(grid, extremes,
                      {pixel.uv.x * w, pixel.uv.y * h, pixel.dx.x * w, pixel.dx.y * h,
                       pixel.dy.x * w, pixel.dy.y * h},
                      measures, &room_, &clusters_);
    const size_t first = found_->size();
    for (const TexelCluster& cluster : clusters_) {
      // A white texel is the extreme of three channels.
      const auto known = std::find_if(
          found_->begin() + static_cast<ptrdiff_t>(first), found_->end(),
          [&](const FoundTexels& other) { return other.cluster.offset == cluster.offset; });
      if (known == found_->end()) {
        found_->push_back({x, y, cluster});
      } else {
        known->cluster.share = std::min(known->cluster.share, cluster.share);
      }
    }
    for (size_t i = first; i < found_->size(); ++i) {
      Vec2d& offset = (*found_)[i].cluster.offset;
      offset = Aim(pixel, at, offset);
    }
  }

  const FramePlan& plan_;
  const TexelMaps& maps_;
  std::vector<FoundTexels>* found_;
  std::vector<TexelCluster> clusters_;
  TexelSearchRoom room_;
};

// Traces a ray through the middle of each pixel of the window.
void TraceMiddles(const FramePlan& plan, const Window& window, bool holes_are_solid, TileWork* work,
                  RenderStats* stats) {
  FilmBatch& film = work->samples.film;
  film.count = 0;
  for (int y = window.y0; y < window.y1; ++y) {
    for (int x = window.x0; x < window.x1; ++x, ++film.count) {
      film.x[film.count] = x + 0.5;
      film.y[film.count] = y + 0.5;
    }
  }
  stats->camera_rays += film.count;
  work->trace_room.rays.holes_are_solid = holes_are_solid;
  TraceCamera(plan.hits, work->shapes, film, &work->trace_room, &work->hits);
  work->trace_room.rays.holes_are_solid = false;
}

std::vector<FoundTexels> SearchPixels(const FramePlan& plan, const Window& window, TileWork* work,
                                      RenderStats* stats) {
  const TexelMaps& maps = *plan.adaptive.texel_maps;
  std::vector<FoundTexels> found;
  TexelFinder finder(plan, &found);
  const HitBatch& hits = work->hits.batch;
  const auto column = [&](size_t ray) {
    return window.x0 + static_cast<int>(ray) % window.width();
  };
  const auto row = [&](size_t ray) { return window.y0 + static_cast<int>(ray) / window.width(); };
  const auto search_hits = [&](const std::vector<std::vector<TexelMap>>& of, bool whole_image) {
    for (size_t i = 0; i < hits.count; ++i) {
      const size_t ray = hits.ray[i];
      const uint32_t material = MaterialAt(plan.surfaces, hits.primitive[i], column(ray)).index;
      if (of[material].empty()) continue;
      finder.SearchMaps(column(ray), row(ray), hits.primitive[i], of[material], whole_image);
    }
  };
  if (maps.any_looks || maps.sky_extremes) {
    TraceMiddles(plan, window, false, work, stats);
    if (maps.any_looks) search_hits(maps.looks, false);
    if (maps.sky_extremes) {
      size_t hit = 0;
      for (size_t ray = 0; ray < work->samples.film.count; ++ray) {
        if (hit < hits.count && hits.ray[hit] == ray) {
          ++hit;
        } else {
          finder.SearchSky(column(ray), row(ray));
        }
      }
    }
  }
  if (maps.any_opacity && work->shapes.triangles) {
    TraceMiddles(plan, window, true, work, stats);
    search_hits(maps.opacities, true);
  }
  return found;
}

}  // namespace

void FindRareTexels(const FramePlan& plan, const Window& cell, TileWork* work, CellState* c,
                    StageClock* clock, RenderStats* stats) {
  if (plan.adaptive.texel_maps == nullptr) return;
  const Window window = PixelsAround(cell, plan.frame, plan.adaptive.filter_radius);
  const std::vector<FoundTexels> found = SearchPixels(plan, window, work, stats);
  clock->Charge(Stage::kSample);
  std::vector<Probe> probes;
  for (const FoundTexels& texels : found) {
    probes.push_back({texels.x + 0.5 + texels.cluster.offset.x,
                      texels.y + 0.5 + texels.cluster.offset.y,
                      static_cast<uint32_t>(IndexIn(plan.frame, texels.x, texels.y))});
  }
  TraceProbes(plan, &probes, work, clock, stats);
  for (size_t i = 0; i < found.size(); ++i) {
    // As if the texels that look alike were spread evenly over the pixel.
    const FilmBox pixel{found[i].x + 0.5, found[i].y + 0.5, 0.5, 0.5};
    ForEachShare(plan.scene->image.filter, cell, pixel, [&](int column, int row, double share) {
      const double of_texels = share * found[i].cluster.share;
      if (of_texels == 0) return;
      c->rare_parts.push_back({PixelAt(column, row), of_texels, probes[i].radiance * of_texels});
    });
  }
}

}  // namespace nacre
