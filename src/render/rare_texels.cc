// SPDX-License-Identifier: Apache-2.0
// render/rare_texels.cc: finds the texels in a cell's pixels that are rare features: bright ones of
// an emission map, holes of a cut-out, stars of a sky.
//
// One ray through the middle of a pixel finds the part of each map that lies in the pixel. The
// texels there that differ most from the others (texture/texel_search.h) are probed by a ray each,
// which measures how they look under the scene's lights, whatever the map controls. In a normal map
// over a narrow lobe (roughness below 0.45) these are the texels that mirror a light, or the sun of
// a sky, to the eye. Not found are texels of surfaces that the middle of a pixel does not show,
// texels that are seen in mirrors, glints of bump maps, glints of normal maps on matte surfaces or
// between texels that are interpolated, and normals where more than 256 x 256 texels lie in a
// pixel.
#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "light/environment.h"
#include "render/filter_shares.h"
#include "render/highlights.h"
#include "render/probes.h"
#include "render/rare_features.h"
#include "render/texel_maps.h"
#include "scene/mesh.h"
#include "scene/texture_mapping.h"

namespace nacre {
namespace {

// The pixels of a cell, and those around it that the filters of its pixels reach.
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

// The point where the ray hits a primitive's plane or sphere, relative to the camera.
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

// The weights of the second and the third corner at a point of the triangle's plane.
Vec2d BarycentricsAt(const FramePlan& plan, const TriangleRef& triangle, const Vec3d& point) {
  const Mesh& mesh = *triangle.mesh;
  const Vec3d& a = mesh.positions[triangle.Vertex(0)];
  const Vec3d e1 = mesh.positions[triangle.Vertex(1)] - a;
  const Vec3d e2 = mesh.positions[triangle.Vertex(2)] - a;
  const Vec3d n = e1.cross(e2), from_a = point + plan.scene->camera.position - a;
  return {e2.cross(n).dot(from_a) / n.length2(), n.cross(e1).dot(from_a) / n.length2()};
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
  const std::vector<Vec2d>& uvs = UvsOf(mesh, texture.second_uvs);
  const Vec2d b = BarycentricsAt(plan, triangle, point);
  const Vec2d uv = uvs[triangle.Vertex(0)];
  return TransformOf(texture).Apply(uv + (uvs[triangle.Vertex(1)] - uv) * b.x +
                                    (uvs[triangle.Vertex(2)] - uv) * b.y);
}

// The vectors by which the components of a normal map are multiplied.
struct MapFrame {
  Vec3d tangent, bitangent, normal;
};

// The frame at a point of a primitive, given how the point and (u, v) change along the film; the
// same as that of hits (shading/normal_map_kernel.cc).
MapFrame FrameAt(const FramePlan& plan, uint32_t primitive, TextureId texture, const Vec3d& point,
                 const Vec3d& to_view, const Vec3d (&point_by)[2], const Vec2d (&uv_by)[2]) {
  const TextureScene& textures = plan.surfaces.textures;
  const PrimitiveNumbers& primitives = plan.surfaces.primitives;
  const Scene& scene = *plan.scene;
  const CornerTangents* made = nullptr;
  Vec3d normal, tangent(0);
  double sign = 0;
  if (IsSphere(primitives, primitive)) {
    const Sphere& sphere = scene.spheres[primitive];
    normal = (point + scene.camera.position - sphere.center) / sphere.radius;
  } else {
    const TriangleRef triangle = TriangleOf(primitives, primitive);
    const Mesh& mesh = *triangle.mesh;
    const Vec2d b = BarycentricsAt(plan, triangle, point);
    const double weights[3] = {1 - b.x - b.y, b.x, b.y};
    normal = HasSmoothNormals(mesh) ? Vec3d(0) : FaceNormal(mesh, triangle.triangle);
    if (!textures.mesh_tangents.empty()) {
      for (const MapTangents& of_map : textures.mesh_tangents[triangle.number]) {
        if (of_map.texture == texture.index) made = textures.tangents[of_map.tangents].get();
      }
    }
    for (size_t k = 0; k < 3; ++k) {
      if (HasSmoothNormals(mesh)) normal += mesh.normals[triangle.Vertex(k)] * weights[k];
      if (made == nullptr) continue;
      const Tangent& corner = made->tangents[made->corners[3 * size_t{triangle.triangle} + k]];
      tangent += corner.direction * weights[k];
      sign += corner.sign * weights[k];
    }
  }
  const double side = normal.dot(to_view) < 0 ? -1 : 1;
  if (made != nullptr) {
    return {tangent * side, normal.cross(tangent) * (sign < 0 ? -side : side), normal * side};
  }
  const Vec3d n = normal.normalized() * side;
  const Vec3d along_u = (point_by[0] * uv_by[1].y - point_by[1] * uv_by[0].y) *
                        (uv_by[0].cross(uv_by[1]) < 0 ? -1 : 1);
  const Vec3d along_v = (point_by[1] * uv_by[0].x - point_by[0] * uv_by[1].x) *
                        (uv_by[0].cross(uv_by[1]) < 0 ? -1 : 1);
  const Vec3d t = (along_u - n * along_u.dot(n)).normalized();
  return {t * side, n.cross(t) * (n.cross(t).dot(along_v) < 0 ? -side : side), n};
}

// The components of a unit normal with which a map in this frame gives the direction.
Vec3d InFrame(const MapFrame& frame, const Vec3d& direction) {
  const Vec3d by_tangent = frame.bitangent.cross(frame.normal);
  const Vec3d components(direction.dot(by_tangent),
                         direction.dot(frame.normal.cross(frame.tangent)),
                         direction.dot(frame.tangent.cross(frame.bitangent)));
  return (frame.tangent.dot(by_tangent) < 0 ? -components : components).normalized();
}

// (u, v) at the middle of a pixel, not wrapped, and their derivatives along the film.
struct MappedPixel {
  Vec2d uv, dx, dy;
};

TexelFootprint FootprintOn(const TexelGrid& grid, const MappedPixel& pixel) {
  const double w = grid.texels.width, h = grid.texels.height;
  return {pixel.uv.x * w, pixel.uv.y * h, pixel.dx.x * w,
          pixel.dx.y * h, pixel.dy.x * w, pixel.dy.y * h};
}

// at(dx, dy) is (u, v) at an offset from the middle, in pixels.
template <class At>
MappedPixel MapPixel(const At& at) {
  constexpr double kStep = 1.0 / 64;  // so small that a seam hardly ever lies on it
  const Vec2d uv = at(0, 0);
  return {uv, (at(kStep, 0) - uv) / kStep, (at(0, kStep) - uv) / kStep};
}

// Finds, by Newton's method, the offset at which (u, v) have the values that they would have at
// `offset` if they were linear. Returns `offset` itself where the method leads elsewhere, as across
// a seam.
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

// Texels that were found by the ray through the middle of a pixel.
struct FoundTexels {
  int x, y;
  TexelCluster cluster;
  bool of_normals;
};

class TexelFinder {
 public:
  TexelFinder(const FramePlan& plan, std::vector<FoundTexels>* found)
      : plan_(plan), maps_(*plan.adaptive.texel_maps), found_(found) {}

  // Searches the maps of the primitive that the ray through the middle of the pixel hits.
  void SearchMaps(int x, int y, uint32_t primitive, const std::vector<TexelMap>& maps,
                  bool whole_image) {
    for (const TexelMap& map : maps) {
      const Texture& texture = plan_.scene->textures[map.texture.index];
      const auto at = [&](double dx, double dy) {
        const FilmRay ray = RayThrough(plan_.camera, x + 0.5 + dx, y + 0.5 + dy);
        return MapPoint(plan_, primitive, texture, MeetPrimitive(plan_, primitive, ray));
      };
      const MappedPixel pixel = MapPixel(at);
      const auto level = whole_image ? 0 : static_cast<size_t>(MipLevelAt(texture, pixel));
      Search(x, y, pixel, at, GridOf(*plan_.scene, map.texture, level),
             level == 0 ? maps_.extremes[map.texture.index].get() : nullptr, map.measures);
    }
  }

  // Searches the normal maps of the primitive that the ray through the middle of the pixel hits.
  void SearchNormals(int x, int y, uint32_t primitive, const std::vector<LobeNormalMap>& maps) {
    for (const LobeNormalMap& map : maps) {
      const Texture& texture = plan_.scene->textures[map.map.texture.index];
      const SceneImage& image = plan_.scene->images[texture.image.index];
      const auto point_at = [&](double dx, double dy) {
        return MeetPrimitive(plan_, primitive,
                             RayThrough(plan_.camera, x + 0.5 + dx, y + 0.5 + dy));
      };
      const auto at = [&](double dx, double dy) {
        return MapPoint(plan_, primitive, texture, point_at(dx, dy));
      };
      const MappedPixel pixel = MapPixel(at);
      FindLobes(map, primitive, pixel, point_at);
      if (lobes_.empty()) continue;
      const double mip_level = MipLevelAt(texture, pixel);
      const TexelGrid grid =
          GridOf(*plan_.scene, map.map.texture, static_cast<size_t>(std::lround(mip_level)));
      const bool literal = map.map.convention == NormalMap::Convention::kLiteral;
      const double middle = literal ? 0.5 : double{image.middle};
      const auto normal_at = [&](const Vec2d& place) {
        Vec3d n;
        for (int c = 0; c < 3; ++c) {
          const double value =
              SampleChannel(*image.texels, texture.sampling, mip_level, place.x / grid.texels.width,
                            place.y / grid.texels.height, std::min(c, image.texels->channels - 1));
          n[c] = (value - middle) / (1 - middle) * (c < 2 ? map.map.scale : 1);
        }
        return n;
      };
      clusters_.clear();
      FindNormalClusters(grid, normal_at, FootprintOn(grid, pixel), lobes_,
                         plan_.adaptive.max_error / 2, &room_, &clusters_);
      AddFound(x, y, pixel, at, true);
    }
  }

  // Searches the sky that the pixel shows.
  void SearchSky(int x, int y) {
    const ShadingSky& sky = plan_.direct.lights.sampled[*plan_.direct.lights.sky].light.sky;
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
  double MipLevelAt(const Texture& texture, const MappedPixel& pixel) const {
    if (texture.sampling.filter != TextureFilter::kTrilinear) return 0;
    const Vec2d dx = pixel.dx * plan_.surfaces.textures.footprint;
    const Vec2d dy = pixel.dy * plan_.surfaces.textures.footprint;
    return MipLevelOf(*plan_.scene->images[texture.image.index].texels,
                      TextureFootprint<double>{dx.x, dx.y, dy.x, dy.y});
  }

  // Finds the lobes in which the map's normals may reflect lights to the eye. point_at(dx, dy) is
  // the point of the primitive at an offset from the pixel's middle.
  template <class PointAt>
  void FindLobes(const LobeNormalMap& map, uint32_t primitive, const MappedPixel& pixel,
                 const PointAt& point_at) {
    constexpr double kStep = 0.25;
    const bool perspective = plan_.camera.projection == Projection::kPerspective;
    const Vec3d points[3] = {point_at(0, 0), point_at(kStep, 0), point_at(0, kStep)};
    const Vec3d point_by[2] = {points[1] - points[0], points[2] - points[0]};
    const Vec2d uv_by[2] = {pixel.dx, pixel.dy};
    MapFrame frames[3];
    Vec3d to_view[3];
    for (size_t k = 0; k < 3; ++k) {
      to_view[k] = perspective ? -points[k].normalized() : -plan_.camera.forward;
      frames[k] =
          FrameAt(plan_, primitive, map.map.texture, points[k], to_view[k], point_by, uv_by);
    }
    lobes_.clear();
    const auto add_lobe = [&](const HighlightLight& light) {
      const auto ideal = [&](size_t k) {
        const Vec3d to_light =
            light.directional ? light.position : (light.position - points[k]).normalized();
        return InFrame(frames[k], (to_view[k] + to_light).normalized());
      };
      const Vec3d middle = ideal(0);
      const double width =
          std::hypot(map.width, HalfVectorTurn(light, (light.position - points[0]).length()));
      // There is also no lobe if `middle` is not finite, because there are no tangents.
      if (!(middle.z > 0 && width > 0)) return;
      lobes_.push_back({middle, (ideal(1) - middle) / kStep, (ideal(2) - middle) / kStep, width});
    };
    for (const HighlightLight& light : plan_.adaptive.highlights.lights) add_lobe(light);
    for (const HighlightLight& sun : maps_.suns) add_lobe(sun);
  }

  template <class At>
  void Search(int x, int y, const MappedPixel& pixel, const At& at, const TexelGrid& grid,
              const TexelExtremes* extremes, const std::vector<TexelMeasure>& measures) {
    clusters_.clear();
    FindTexelClusters(grid, extremes, FootprintOn(grid, pixel), measures, &room_, &clusters_);
    AddFound(x, y, pixel, at, false);
  }

  // Adds `clusters_`.
  template <class At>
  void AddFound(int x, int y, const MappedPixel& pixel, const At& at, bool of_normals) {
    const size_t first = found_->size();
    for (const TexelCluster& cluster : clusters_) {
      // A white texel is the extreme of three channels.
      const auto known = std::find_if(
          found_->begin() + static_cast<ptrdiff_t>(first), found_->end(),
          [&](const FoundTexels& other) { return other.cluster.offset == cluster.offset; });
      if (known == found_->end()) {
        found_->push_back({x, y, cluster, of_normals});
      } else {
        known->cluster.share = std::min(known->cluster.share, cluster.share);
        known->cluster.others |= cluster.others;
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
  std::vector<NormalLobe> lobes_;
  std::vector<TexelCluster> clusters_;
  TexelSearchRoom room_;
};

// Traces a ray through the middle of each pixel of the window.
void TraceMiddles(const FramePlan& plan, const Window& window, bool holes_are_solid,
                  TileWork* work) {
  FilmBatch& film = work->samples.film;
  film.count = 0;
  for (int y = window.y0; y < window.y1; ++y) {
    for (int x = window.x0; x < window.x1; ++x, ++film.count) {
      film.x[film.count] = x + 0.5;
      film.y[film.count] = y + 0.5;
    }
  }
  work->stats->camera_rays += film.count;
  work->trace_room.rays.holes_are_solid = holes_are_solid;
  TraceCamera(plan.hits, work->shapes, film, &work->trace_room, &work->hits);
  work->trace_room.rays.holes_are_solid = false;
}

std::vector<FoundTexels> SearchPixels(const FramePlan& plan, const Window& window, TileWork* work) {
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
      const uint32_t material =
          MaterialAt(plan.surfaces, hits.primitive[i], work->samples.film.x[ray]).index;
      finder.SearchMaps(column(ray), row(ray), hits.primitive[i], of[material], whole_image);
      if (whole_image) continue;
      finder.SearchNormals(column(ray), row(ray), hits.primitive[i], maps.normals[material]);
    }
  };
  if (maps.any_looks || maps.any_normals || maps.sky_extremes) {
    TraceMiddles(plan, window, false, work);
    search_hits(maps.looks, false);
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
    TraceMiddles(plan, window, true, work);
    search_hits(maps.opacities, true);
  }
  return found;
}

}  // namespace

void FindRareTexels(const FramePlan& plan, const Window& cell, TileWork* work,
                    KnownFeatures* known) {
  std::fill_n(known->has_other_texels, kCellPixels, false);
  if (plan.adaptive.texel_maps == nullptr) return;
  const Window window = PixelsAround(cell, plan.frame, plan.adaptive.filter_radius);
  const std::vector<FoundTexels> found = SearchPixels(plan, window, work);
  work->clock->Charge(Stage::kSample);
  std::vector<Probe> probes;
  for (const FoundTexels& texels : found) {
    probes.push_back({texels.x + 0.5 + texels.cluster.offset.x,
                      texels.y + 0.5 + texels.cluster.offset.y,
                      static_cast<uint32_t>(IndexIn(plan.frame, texels.x, texels.y))});
  }
  TraceProbes(plan, false, &probes, work);
  // Shares are computed as if texels that look alike were spread evenly over the pixel. Glints of
  // normal maps look much alike, so that those of several pixels are added up.
  struct Glints {
    double squares = 0;
    Rgb radiance{0, 0, 0};
  };
  Glints glints[kCellPixels];
  for (size_t i = 0; i < found.size(); ++i) {
    const FilmBox pixel{found[i].x + 0.5, found[i].y + 0.5, 0.5, 0.5};
    const Rgb& radiance = probes[i].radiance;
    ForEachShare(plan.scene->image.filter, cell, pixel, [&](uint32_t at, double share) {
      const double of_texels = share * found[i].cluster.share;
      if (of_texels == 0) return;
      known->has_other_texels[at] |= found[i].cluster.others;
      if (found[i].of_normals) {
        if (of_texels < 0) return;  // the filter has negative lobes
        glints[at].squares += of_texels * radiance.length2();
        glints[at].radiance += radiance * of_texels;
      } else {
        known->parts.push_back({at, of_texels, radiance * of_texels});
      }
    });
  }
  for (uint32_t pixel = 0; pixel < kCellPixels; ++pixel) {
    const auto& [squares, radiance] = glints[pixel];
    // A single feature of this share and radiance has the same mean and variance.
    if (squares > 0) known->parts.push_back({pixel, radiance.length2() / squares, radiance});
  }
}

}  // namespace nacre
