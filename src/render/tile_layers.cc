#include "render/tile_layers.h"

#include <algorithm>

namespace nacre {
namespace {

// The layer of a light among the light layers, or their number.
size_t LightLayerIndex(const RenderPlan& plan, size_t light) {
  size_t index = 0;
  for (const Layer& layer : plan.layers) {
    if (layer.kind != LayerKind::kLight) continue;
    if (layer.light == light) return index;
    ++index;
  }
  return index;
}

void AddSoa(const Soa3<float>& a, size_t count, Soa3<float>* sum) {
  for (size_t i = 0; i < count; ++i) {
    sum->x[i] += a.x[i];
    sum->y[i] += a.y[i];
    sum->z[i] += a.z[i];
  }
}

void FillConstant(const Rgb& value, size_t begin, size_t end, Soa3<float>* to) {
  std::fill(to->x.data() + begin, to->x.data() + end, static_cast<float>(value.x));
  std::fill(to->y.data() + begin, to->y.data() + end, static_cast<float>(value.y));
  std::fill(to->z.data() + begin, to->z.data() + end, static_cast<float>(value.z));
}

// Beauty: (diffuse + specular) + (ambient + emission), the same sum whatever else is asked for.
void MakeBeauty(const RenderPlan& plan, const TileScratch& s, Soa3<float>* to) {
  for (const MaterialRun& run : s.runs) {
    const MaterialConstants& constants = plan.materials[run.material.index];
    const Rgb constant = constants.ambient + constants.emission;
    const float r = static_cast<float>(constant.x);
    const float g = static_cast<float>(constant.y);
    const float b = static_cast<float>(constant.z);
    for (size_t i = run.begin; i < run.end; ++i) {
      to->x[i] = (s.total.diffuse.x[i] + s.total.specular.x[i]) + r;
      to->y[i] = (s.total.diffuse.y[i] + s.total.specular.y[i]) + g;
      to->z[i] = (s.total.diffuse.z[i] + s.total.specular.z[i]) + b;
    }
  }
}

// Fills a layer's value of every hit that is a constant of its material.
void MakeConstant(const RenderPlan& plan, const TileScratch& s, Rgb MaterialConstants::*member,
                  Soa3<float>* to) {
  for (const MaterialRun& run : s.runs) {
    FillConstant(plan.materials[run.material.index].*member, run.begin, run.end, to);
  }
}

// The values of an averaged layer at the hits. May return one of the scratch's own arrays.
const Soa3<float>& LayerValues(const RenderPlan& plan, const Layer& layer, size_t light_layer,
                               TileScratch* s) {
  Soa3<float>& values = s->hit_values;
  switch (layer.kind) {
    case LayerKind::kBeauty:
      MakeBeauty(plan, *s, &values);
      return values;
    case LayerKind::kAlpha:
      FillConstant(Rgb(1, 0, 0), 0, s->hits.count, &values);
      return values;
    case LayerKind::kDiffuse:
      return s->total.diffuse;
    case LayerKind::kSpecular:
      return s->total.specular;
    case LayerKind::kAmbient:
      MakeConstant(plan, *s, &MaterialConstants::ambient, &values);
      return values;
    case LayerKind::kEmission:
      MakeConstant(plan, *s, &MaterialConstants::emission, &values);
      return values;
    case LayerKind::kAlbedo:
      MakeConstant(plan, *s, &MaterialConstants::albedo, &values);
      return values;
    case LayerKind::kLight:
      return s->per_light[light_layer];
    default:
      return s->surface.normal;
  }
}

// Distributes a layer's values from hits to rays; rays that hit nothing show `background`.
void Scatter(const TileScratch& s, const Soa3<float>& values, const Rgb& background,
             Soa3<float>* to) {
  FillConstant(background, 0, s.rays.count, to);
  for (size_t i = 0; i < s.hits.count; ++i) {
    const uint32_t ray = s.hits.ray[i];
    to->x[ray] = values.x[i];
    to->y[ray] = values.y[i];
    to->z[ray] = values.z[i];
  }
}

// Takes P, Z and ids from hits nearer to their pixel's centre than what the film has. Ties go to
// the sample that comes first.
void AddNearest(const RenderPlan& plan, const TileRound& round, const TileScratch& s,
                StripFilm* film) {
  const Scene& scene = *plan.scene;
  const size_t tile_width = static_cast<size_t>(round.tile.width());
  for (const MaterialRun& run : s.runs) {
    for (size_t i = run.begin; i < run.end; ++i) {
      const size_t ray = s.hits.ray[i];
      const size_t in_tile = ray / static_cast<size_t>(round.samples);
      const int x = round.tile.x0 + static_cast<int>(in_tile % tile_width);
      const int y = round.tile.y0 + static_cast<int>(in_tile / tile_width);
      const double dx = s.film_x[ray] - (x + 0.5);
      const double dy = s.film_y[ray] - (y + 0.5);
      const float distance = static_cast<float>(dx * dx + dy * dy);
      const size_t pixel =
          static_cast<size_t>(y - film->window.y0) * static_cast<size_t>(film->window.width()) +
          static_cast<size_t>(x - film->window.x0);
      if (!(distance < film->nearest_distance[pixel])) continue;
      film->nearest_distance[pixel] = distance;
      const Vec3d relative(s.hits.position.x[i], s.hits.position.y[i], s.hits.position.z[i]);
      const Vec3d world = relative + scene.camera.position;
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
          film->ids[id++][pixel] = run.material.index + 1;
        }
      }
    }
  }
}

}  // namespace

bool WantsLightLayer(const RenderPlan& plan, size_t light) {
  return std::any_of(plan.layers.begin(), plan.layers.end(), [&](const Layer& layer) {
    return layer.kind == LayerKind::kLight && layer.light == light;
  });
}

void KeepLightLayer(const RenderPlan& plan, size_t light, TileScratch* scratch) {
  TileScratch& s = *scratch;
  const size_t count = s.hits.count;
  const size_t index = LightLayerIndex(plan, light);
  if (s.per_light.size() <= index) s.per_light.resize(index + 1);
  Soa3<float>& layer = s.per_light[index];
  FillConstant(Rgb(0, 0, 0), 0, count, &layer);
  AddSoa(s.single.diffuse, count, &layer);
  AddSoa(s.single.specular, count, &layer);
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
    const bool shows_background =
        layer.kind == LayerKind::kBeauty || layer.kind == LayerKind::kEmission;
    const Rgb background = shows_background ? plan.scene->background : Rgb(0, 0, 0);
    const size_t light = layer.kind == LayerKind::kLight ? light_layer++ : 0;
    if (s.hits.count > 0) {
      Scatter(s, LayerValues(plan, layer, light, &s), background, &s.ray_values);
    } else {
      FillConstant(background, 0, s.rays.count, &s.ray_values);
    }
    AddToChannel(round, s.ray_values.x.data(), film->window, &*sums++);
    if (layer.kind == LayerKind::kAlpha) continue;
    AddToChannel(round, s.ray_values.y.data(), film->window, &*sums++);
    AddToChannel(round, s.ray_values.z.data(), film->window, &*sums++);
  }
  if (!film->nearest_distance.empty()) AddNearest(plan, round, s, film);
}

}  // namespace nacre
