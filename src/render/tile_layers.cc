#include "render/tile_layers.h"

#include <algorithm>
#include <limits>

namespace nacre {
namespace {

void AddSoa(const Soa3<float>& a, size_t count, Soa3<float>* sum) {
  for (size_t i = 0; i < count; ++i) {
    sum->x[i] += a.x[i];
    sum->y[i] += a.y[i];
    sum->z[i] += a.z[i];
  }
}

// Gives rays [begin, end) the same value.
void FillRays(const Rgb& value, size_t count, Soa3<double>* rays) {
  std::fill_n(rays->x.data(), count, value.x);
  std::fill_n(rays->y.data(), count, value.y);
  std::fill_n(rays->z.data(), count, value.z);
}

void PutRay(const Rgb& value, size_t ray, Soa3<double>* rays) {
  rays->x[ray] = value.x;
  rays->y[ray] = value.y;
  rays->z[ray] = value.z;
}

Rgb At(const Soa3<float>& soa, size_t i) { return {soa.x[i], soa.y[i], soa.z[i]}; }

// Layers hold floats; what they add up to is computed from the same floats.
Rgb RoundToFloat(const Rgb& value) { return Rgb(Imath::C3f(value)); }

// The value of an averaged layer at hit i of a run, in double: the beauty is the exact sum of the
// other layers' floats, so after the film's average each is rounded once, whatever the filter's
// weights cancel. It never depends on which layers are asked for.
Rgb LayerValue(const Layer& layer, size_t light_layer, const ShadingMaterial& constants,
               const TileScratch& s, size_t i) {
  switch (layer.kind) {
    case LayerKind::kBeauty:
      return At(s.total.diffuse, i) + At(s.total.specular, i) + RoundToFloat(constants.ambient) +
             RoundToFloat(constants.emission);
    case LayerKind::kAlpha:
      return {1, 0, 0};
    case LayerKind::kDiffuse:
      return At(s.total.diffuse, i);
    case LayerKind::kSpecular:
      return At(s.total.specular, i);
    case LayerKind::kAmbient:
      return RoundToFloat(constants.ambient);
    case LayerKind::kEmission:
      return RoundToFloat(constants.emission);
    case LayerKind::kAlbedo:
      return RoundToFloat(constants.albedo);
    case LayerKind::kLight:
      return At(s.per_light[light_layer], i);
    default:
      return At(s.surface.normal, i);
  }
}

// What a layer shows where nothing is hit.
Rgb BackgroundOf(const Layer& layer, const Scene& scene) {
  const bool shows = layer.kind == LayerKind::kBeauty || layer.kind == LayerKind::kEmission;
  return shows ? RoundToFloat(scene.background) : Rgb(0, 0, 0);
}

// What P, Z and ids of a pixel are taken from.
struct NearestHit {
  size_t hit = std::numeric_limits<size_t>::max();
  MaterialId material;
};

void PutNearest(const RenderPlan& plan, const TileScratch& s, const NearestHit& nearest,
                size_t pixel, StripFilm* film) {
  const size_t i = nearest.hit;
  const Vec3d relative(s.hits.position.x[i], s.hits.position.y[i], s.hits.position.z[i]);
  const Vec3d world = relative + plan.scene->camera.position;
  size_t plane = 0;
  size_t id = 0;
  for (const Layer& layer : plan.layers) {
    if (layer.kind == LayerKind::kPosition) {
      for (int c = 0; c < 3; ++c) film->nearest[plane++][pixel] = static_cast<float>(world[c]);
    } else if (layer.kind == LayerKind::kDepth) {
      film->nearest[plane++][pixel] = static_cast<float>(relative ^ plan.camera.forward);
    } else if (layer.kind == LayerKind::kObjectId) {
      film->ids[id++][pixel] = s.hits.object[i] + 1;
    } else if (layer.kind == LayerKind::kMaterialId) {
      film->ids[id++][pixel] = nearest.material.index + 1;
    }
  }
}

// Takes P, Z and ids from the hit nearest to its pixel's centre. Rays are walked in the order of
// their samples, so ties go to the first one, whatever the tile.
void AddNearest(const RenderPlan& plan, const TileRound& round, TileScratch* scratch,
                StripFilm* film) {
  TileScratch& s = *scratch;
  constexpr uint32_t kMiss = std::numeric_limits<uint32_t>::max();
  std::fill_n(s.hit_of_ray.data(), s.rays.count, kMiss);
  for (size_t i = 0; i < s.hits.count; ++i) s.hit_of_ray[s.hits.ray[i]] = static_cast<uint32_t>(i);
  size_t ray = 0;
  for (int y = round.tile.y0; y < round.tile.y1; ++y) {
    for (int x = round.tile.x0; x < round.tile.x1; ++x) {
      const size_t pixel =
          static_cast<size_t>(y - film->window.y0) * static_cast<size_t>(film->window.width()) +
          static_cast<size_t>(x - film->window.x0);
      NearestHit nearest;
      for (int sample = 0; sample < round.samples; ++sample, ++ray) {
        if (s.hit_of_ray[ray] == kMiss) continue;
        const double dx = s.film_x[ray] - (x + 0.5);
        const double dy = s.film_y[ray] - (y + 0.5);
        const double distance = dx * dx + dy * dy;
        if (!(distance < film->nearest_distance[pixel])) continue;
        film->nearest_distance[pixel] = distance;
        nearest = {s.hit_of_ray[ray], s.runs[s.run_of_ray[ray]].material};
      }
      if (nearest.material.valid()) PutNearest(plan, s, nearest, pixel, film);
    }
  }
}

}  // namespace

void KeepLightLayer(size_t light_layer, TileScratch* scratch) {
  TileScratch& s = *scratch;
  const size_t count = s.hits.count;
  AddSoa(s.single.diffuse, count, &s.per_light[light_layer]);
  AddSoa(s.single.specular, count, &s.per_light[light_layer]);
  AddSoa(s.single.diffuse, count, &s.total.diffuse);
  AddSoa(s.single.specular, count, &s.total.specular);
}

void AddToFilm(const RenderPlan& plan, const TileRound& round, TileScratch* scratch,
               StripFilm* film) {
  TileScratch& s = *scratch;
  auto sums = film->sums.begin();
  size_t light_layer = 0;
  for (const Layer& layer : plan.layers) {
    if (!IsAveraged(layer.kind)) continue;
    FillRays(BackgroundOf(layer, *plan.scene), s.rays.count, &s.ray_values);
    if (s.hits.count > 0) {
      for (const MaterialRun& run : s.runs) {
        const ShadingMaterial& constants = plan.materials[run.material.index];
        for (size_t i = run.begin; i < run.end; ++i) {
          PutRay(LayerValue(layer, light_layer, constants, s, i), s.hits.ray[i], &s.ray_values);
        }
      }
    }
    if (layer.kind == LayerKind::kLight) ++light_layer;
    AddToChannel(round, s.ray_values.x.data(), film->window, &*sums++);
    if (layer.kind == LayerKind::kAlpha) continue;
    AddToChannel(round, s.ray_values.y.data(), film->window, &*sums++);
    AddToChannel(round, s.ray_values.z.data(), film->window, &*sums++);
  }
  if (!film->nearest_distance.empty()) AddNearest(plan, round, scratch, film);
}

void AddBackground(const RenderPlan& plan, const Window& tile, StripFilm* film) {
  auto sums = film->sums.begin();
  for (const Layer& layer : plan.layers) {
    if (!IsAveraged(layer.kind)) continue;
    const Rgb sum = BackgroundOf(layer, *plan.scene) * double(plan.scene->image.spp);
    const int channels = layer.kind == LayerKind::kAlpha ? 1 : 3;
    for (int c = 0; c < channels; ++c, ++sums) {
      if (sum[c] == 0) continue;
      for (int y = tile.y0; y < tile.y1; ++y) {
        const auto row =
            static_cast<size_t>(y - film->window.y0) * static_cast<size_t>(film->window.width());
        const auto column = static_cast<size_t>(tile.x0 - film->window.x0);
        std::fill_n(sums->data() + row + column, tile.width(), sum[c]);
      }
    }
  }
}

}  // namespace nacre
