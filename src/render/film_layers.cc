// SPDX-License-Identifier: Apache-2.0
#include "render/film_layers.h"

#include <algorithm>
#include <limits>

#include "render/film_kernel.h"

namespace nacre {
namespace {

// The values of a layer: an array of floats and two constants, which are added in double. The
// radiance that a sample reflects is rounded to float, as kernels store it, and the average of
// samples once more. The beauty never depends on which layers are rendered.
struct LayerValues {
  const Soa3<float>* values = nullptr;  // null: zeros
  Rgb constant{0, 0, 0}, constant2{0, 0, 0};
  // These replace the constants where materials are mapped.
  const Soa3<float>* ambient = nullptr;
  const Soa3<float>* emission = nullptr;
};

LayerValues ValuesShown(const Layer& layer, const ShadingMaterial& constants,
                        const ShadedBatch& s) {
  // If not null, each hit has its own ambient, emission and albedo.
  const HitParameters* const maps =
      constants.by_hit.parameters ? s.surfaces.textures.get() : nullptr;
  const Rgb ambient = constants.in_ambient
                          ? RoundToFloat(constants.of_ambient * s.plan.textures.ambient)
                          : Rgb(0, 0, 0);
  const Rgb emission = RoundToFloat(constants.emission);
  LayerValues shown;
  switch (layer.kind) {
    case LayerKind::kBeauty:
      shown.values = &s.radiance.total.sum;
      if (maps != nullptr) {
        shown.ambient = &maps->ambient;
        shown.emission = &maps->emission;
      } else {
        shown.constant = ambient;
        shown.constant2 = emission;
      }
      return shown;
    case LayerKind::kAlpha:
      return {.constant = {1, 0, 0}};
    case LayerKind::kDiffuse:
      return {.values = &s.radiance.total.diffuse};
    case LayerKind::kSpecular:
      return {.values = &s.radiance.total.specular};
    case LayerKind::kAmbient:
      if (maps != nullptr) return {.values = &maps->ambient};
      return {.constant = ambient};
    case LayerKind::kEmission:
      if (maps != nullptr) return {.values = &maps->emission};
      return {.constant = emission};
    case LayerKind::kAlbedo:
      if (maps != nullptr) return {.values = &maps->albedo};
      return {.constant = RoundToFloat(constants.albedo)};
    case LayerKind::kLight:
      return {.values = &s.radiance.per_light[layer.number]};
    case LayerKind::kTangent:
      if (!constants.by_hit.tangent) return {};
      return {.values = &s.surfaces.surface.tangent};
    default:
      return {.values = &s.surfaces.surface.normal};
  }
}

const float* ChannelOrNull(const Soa3<float>* soa, int c) {
  return soa == nullptr ? nullptr : ChannelOf(*soa, c).data();
}

// Fills in channel c of a layer at the hits of a run.
void FillRun(const LayerValues& shown, int c, const MaterialRun& run, double* values) {
  const float* const from = ChannelOrNull(shown.values, c);
  if (shown.ambient != nullptr) {
    AddFloats({from, ChannelOrNull(shown.ambient, c), ChannelOrNull(shown.emission, c)}, run.begin,
              run.end, values);
  } else if (from == nullptr) {
    std::fill(values + run.begin, values + run.end, shown.constant[c] + shown.constant2[c]);
  } else {
    AddFloats(from, shown.constant[c], shown.constant2[c], run.begin, run.end, values);
  }
}

// Whether ambient light, emission and albedo are the same at all hits of the run: no maps change
// them.
bool HasConstants(const MaterialRun& run) { return !run.shading->by_hit.parameters; }

// Finds the spans of a run in a tile of `pixels` pixels. No span crosses the end of a row of `row`
// pixels.
void FindRunSpans(const MaterialRun& run, size_t pixels, size_t row, const ShadedBatch& batch,
                  LayerRoom* room) {
  FindHitSpans({batch.hits().ray.data(), run.begin, run.end}, pixels, row,
               batch.samples.weights.data(), &room->spans);
}

HitValues ValuesOf(const LayerValues& shown, int channels) {
  HitValues values{.channels = channels, .values = {}, .constant = {}, .constant2 = {}};
  for (int c = 0; c < std::min(channels, 3); ++c) {
    values.values[c] = ChannelOrNull(shown.values, c);
    values.constant[c] = shown.constant[c];
    values.constant2[c] = shown.constant2[c];
  }
  return values;
}

// Beauty and coverage are the first two layers. Coverage is written together with the beauty.
int ChannelsWithCoverage(LayerKind kind) {
  return kind == LayerKind::kBeauty ? 4 : FloatChannels(kind);
}

// Adds a layer of a batch whose only run has the spans in `room`.
void AddRun(const Layer& layer, const ShadedBatch& batch, const LayerRoom& room,
            double* const* sums) {
  const LayerValues shown = ValuesShown(layer, *batch.surfaces.runs[0].shading, batch);
  AddHits(ValuesOf(shown, ChannelsWithCoverage(layer.kind)), room.spans, sums);
}

// Adds a layer of any batch of a tile of `pixels` pixels.
void AddRays(const FilmPlan& plan, const Layer& layer, size_t pixels, const ShadedBatch& batch,
             LayerRoom* room, double* const* sums) {
  Soa3<double>& values = GatherLayer(plan, layer, Rgb(0, 0, 0), batch, room);
  const std::vector<double>& weights = batch.samples.weights;
  for (int c = 0; c < FloatChannels(layer.kind); ++c) {
    AddSamples(ChannelOf(values, c).data(), weights.data(), static_cast<int>(weights.size()),
               pixels, sums[c]);
  }
}

// Scatters values by hit to values by ray. Rays that hit nothing get the sky's radiance, or the
// background if `sky` is null.
void ScatterToRays(const Rgb& background, const Soa3<float>* sky, int channels,
                   const ShadedBatch& batch, LayerRoom* room) {
  const size_t hits = batch.hits().count, samples = batch.samples.film.count;
  const uint32_t* const ray = batch.hits().ray.data();
  for (int c = 0; c < channels; ++c) {
    const double* const from = ChannelOf(room->hit_values, c).data();
    double* const to = ChannelOf(room->ray_values, c).data();
    if (sky != nullptr) {
      std::copy_n(ChannelOf(*sky, c).data(), samples, to);
    } else {
      std::fill_n(to, samples, background[c]);
    }
    for (size_t i = 0; i < hits; ++i) to[ray[i]] = from[i];
  }
}

// The pixel that a ray of a tile's round belongs to.
FilmPixel RowPixel(const Window& tile, uint32_t ray) {
  const auto pixel = ray % static_cast<uint32_t>(tile.pixel_count());
  const auto width = static_cast<uint32_t>(tile.width());
  return {pixel, tile.x0 + static_cast<int>(pixel % width),
          tile.y0 + static_cast<int>(pixel / width)};
}

}  // namespace

void StoreNearest(const FilmPlan& plan, const ShadedBatch& batch, size_t hit, size_t pixel,
                  TileFilm* film) {
  const PrimitiveNumbers& primitives = batch.plan.primitives;
  const Soa3<double>& position = batch.hits().position;
  const Vec3d relative(position.x[hit], position.y[hit], position.z[hit]);
  const Vec3d world = relative + primitives.scene->camera.position;
  const uint32_t primitive = batch.hits().primitive[hit];
  const double film_x = batch.samples.film.x[batch.hits().ray[hit]];
  const MaterialId material = MaterialAt(batch.plan, primitive, film_x);
  size_t plane = 0;
  size_t id = 0;
  for (const Layer& layer : plan.layers) {
    if (layer.kind == LayerKind::kPosition) {
      for (int c = 0; c < 3; ++c) film->nearest[plane++][pixel] = static_cast<float>(world[c]);
    } else if (layer.kind == LayerKind::kDepth) {
      film->nearest[plane++][pixel] = static_cast<float>(relative ^ plan.camera.forward);
    } else if (layer.kind == LayerKind::kObjectId) {
      film->ids[id++][pixel] = ObjectOf(primitives, primitive) + 1;
    } else if (layer.kind == LayerKind::kMaterialId) {
      film->ids[id++][pixel] = material.index + 1;
    }
  }
}

Soa3<double>& GatherLayer(const FilmPlan& plan, const Layer& layer, const Rgb& background,
                          const ShadedBatch& batch, LayerRoom* room) {
  const std::vector<MaterialRun>& runs = batch.surfaces.runs;
  const int channels = FloatChannels(layer.kind);
  const size_t hits = batch.hits().count;
  if (hits > 0) {
    for (const MaterialRun& run : runs) {
      const LayerValues shown = ValuesShown(layer, *run.shading, batch);
      for (int c = 0; c < channels; ++c) {
        FillRun(shown, c, run, ChannelOf(room->hit_values, c).data());
      }
    }
  }
  // If every ray hits and there is one run, hits are in the order of the rays.
  if (hits == batch.samples.film.count && runs.size() == 1) return room->hit_values;
  const bool sees_sky = plan.sky && ShowsBackground(layer);
  ScatterToRays(background, sees_sky ? &batch.radiance.sky : nullptr, channels, batch, room);
  return room->ray_values;
}

void AddToFilm(const FilmPlan& plan, const ShadedBatch& batch, LayerRoom* room, TileFilm* film) {
  const size_t hits = batch.hits().count, pixels = batch.samples.film.pixels;
  if (hits == 0 && !plan.sky) return;
  const std::vector<MaterialRun>& runs = batch.surfaces.runs;
  // A pixel's samples must be added in their order, whichever materials they hit: with several runs
  // values are scattered to rays first.
  const bool in_order = hits > 0 && runs.size() == 1 && HasConstants(runs[0]);
  if (in_order) FindRunSpans(runs[0], pixels, pixels, batch, room);
  size_t sum = 0;
  for (const Layer& layer : plan.layers) {
    if (!IsAveraged(layer.kind)) continue;
    double* sums[4] = {};
    for (int c = 0; c < ChannelsWithCoverage(layer.kind); ++c) {
      sums[c] = film->sums[sum + static_cast<size_t>(c)].data();
    }
    sum += static_cast<size_t>(FloatChannels(layer.kind));
    const bool sees_sky = plan.sky && ShowsBackground(layer);
    if (in_order && !sees_sky) {
      const bool is_added = layer.kind == LayerKind::kAlpha && !plan.sky;
      if (!is_added) AddRun(layer, batch, *room, sums);
    } else if (hits > 0 || sees_sky) {
      AddRays(plan, layer, pixels, batch, room, sums);
    }
  }
  AddNearest(
      plan, batch, [&](uint32_t ray) { return RowPixel(film->window, ray); }, room, film);
}

bool StoreOnlySamples(const FilmPlan& plan, const ShadedBatch& batch, const Window& tile,
                      LayerRoom* room, Strip* strip) {
  const std::vector<MaterialRun>& runs = batch.surfaces.runs;
  if (!std::all_of(runs.begin(), runs.end(), HasConstants)) return false;
  if (batch.hits().count < batch.samples.film.count) FillBackground(plan, tile, strip);
  for (const MaterialRun& run : runs) {
    FindRunSpans(run, tile.pixel_count(), static_cast<size_t>(tile.width()), batch, room);
    size_t color = 0;
    for (const Layer& layer : plan.layers) {
      if (layer.kind == LayerKind::kAlpha) continue;  // written with the beauty
      const LayerValues shown = ValuesShown(layer, *run.shading, batch);
      const int channels = ChannelsWithCoverage(layer.kind);
      PixelRows<float> rows[4] = {};
      for (int c = 0; c < channels; ++c) {
        rows[c] = RowsIn(strip->window, tile, strip->colors[color++]);
      }
      StoreHits(ValuesOf(shown, channels), room->spans, rows);
    }
  }
  return true;
}

}  // namespace nacre
