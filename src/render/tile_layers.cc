// SPDX-License-Identifier: Apache-2.0
#include "render/tile_layers.h"

#include <algorithm>
#include <limits>

#include "render/film_kernel.h"

namespace nacre {
namespace {

// The arrays do not overlap, which lets the compiler use vectors.
void AddArray(const float* __restrict a, size_t count, float* __restrict sum) {
  for (size_t i = 0; i < count; ++i) sum[i] += a[i];
}

void AddSoa(const Soa3<float>& a, size_t count, Soa3<float>* sum) {
  AddArray(a.x.data(), count, sum->x.data());
  AddArray(a.y.data(), count, sum->y.data());
  AddArray(a.z.data(), count, sum->z.data());
}

// Where a layer's values come from: the sum of two arrays of floats and two constants, in double.
// The beauty is the exact sum of the other layers' floats, so after the film's average each is
// rounded once, whatever the filter's weights cancel; but where RenderPlan::one_light rounds a
// sample's once more. It never depends on which layers are asked for.
struct LayerTerms {
  const Soa3<float>* first = nullptr;  // null: zeros
  const Soa3<float>* second = nullptr;
  Rgb constant{0, 0, 0}, further{0, 0, 0};
  // Of materials with maps, in place of the constants.
  const Soa3<float>* ambient = nullptr;
  const Soa3<float>* emission = nullptr;
};

// What hits reflect of all lights.
LayerTerms BeautyOf(const RenderPlan& plan, const TileScratch& s) {
  if (plan.one_light) return {.first = &s.total.sum};
  return {.first = &s.total.diffuse, .second = &s.total.specular};
}

// The same where maps give each hit its own constants.
LayerTerms MappedTermsOf(const RenderPlan& plan, const Layer& layer, const TileScratch& s) {
  switch (layer.kind) {
    case LayerKind::kBeauty: {
      LayerTerms terms = BeautyOf(plan, s);
      terms.ambient = &s.textures->ambient;
      terms.emission = &s.textures->emission;
      return terms;
    }
    case LayerKind::kAmbient:
      return {.first = &s.textures->ambient};
    case LayerKind::kEmission:
      return {.first = &s.textures->emission};
    case LayerKind::kAlbedo:
      return {.first = &s.textures->albedo};
    default:
      return {};
  }
}

bool IsMapped(LayerKind kind) {
  return kind == LayerKind::kBeauty || kind == LayerKind::kAmbient ||
         kind == LayerKind::kEmission || kind == LayerKind::kAlbedo;
}

LayerTerms TermsOf(const RenderPlan& plan, const Layer& layer, size_t light_layer,
                   const ShadingMaterial& constants, const TileScratch& s) {
  if (constants.mapped && IsMapped(layer.kind)) return MappedTermsOf(plan, layer, s);
  const Rgb ambient = RoundToFloat(constants.ambient);
  const Rgb emission = RoundToFloat(constants.emission);
  switch (layer.kind) {
    case LayerKind::kBeauty: {
      LayerTerms terms = BeautyOf(plan, s);
      terms.constant = ambient;
      terms.further = emission;
      return terms;
    }
    case LayerKind::kAlpha:
      return {.constant = {1, 0, 0}};
    case LayerKind::kDiffuse:
      return {.first = &s.total.diffuse};
    case LayerKind::kSpecular:
      return {.first = &s.total.specular};
    case LayerKind::kAmbient:
      return {.constant = ambient};
    case LayerKind::kEmission:
      return {.constant = emission};
    case LayerKind::kAlbedo:
      return {.constant = RoundToFloat(constants.albedo)};
    case LayerKind::kLight:
      return {.first = &s.per_light[light_layer]};
    default:
      return {.first = &s.surface.normal};
  }
}

const float* ChannelOrNull(const Soa3<float>* soa, int c) {
  if (soa == nullptr) return nullptr;
  return (c == 0 ? soa->x : c == 1 ? soa->y : soa->z).data();
}

// Channel c of a layer at the hits of a run.
void FillRun(const LayerTerms& terms, int c, const MaterialRun& run, double* values) {
  const float* const first = ChannelOrNull(terms.first, c);
  if (terms.ambient != nullptr) {
    AddFloats({first, ChannelOrNull(terms.second, c), ChannelOrNull(terms.ambient, c),
               ChannelOrNull(terms.emission, c)},
              run.begin, run.end, values);
  } else if (first == nullptr) {
    std::fill(values + run.begin, values + run.end, terms.constant[c] + terms.further[c]);
  } else {
    AddFloats(first, ChannelOrNull(terms.second, c), terms.constant[c], terms.further[c], run.begin,
              run.end, values);
  }
}

// Whether each of a run's layers is a sum of what its hits reflect and constants.
bool IsPlain(const RenderPlan& plan, const MaterialRun& run) {
  return !plan.materials[run.material.index].mapped;
}

// Finds the spans of a run; none goes beyond a row of `row` pixels.
void FindSpans(const MaterialRun& run, size_t row, TileScratch* s) {
  FindSpans({s->hits.ray.data(), run.begin, run.end}, s->film.window.pixel_count(), row,
            s->weights.data(), &s->spans);
}

HitValues ValuesOf(const LayerTerms& terms, int channels) {
  HitValues values{.channels = channels, .a = {}, .b = {}, .constant = {}, .further = {}};
  for (int c = 0; c < std::min(channels, 3); ++c) {
    values.a[c] = ChannelOrNull(terms.first, c);
    values.b[c] = ChannelOrNull(terms.second, c);
    values.constant[c] = terms.constant[c];
    values.further[c] = terms.further[c];
  }
  return values;
}

// Coverage is the layer behind the beauty, of all layers the first two: it is brought along.
int ChannelsWithCoverage(LayerKind kind) {
  return kind == LayerKind::kBeauty ? 4 : FloatChannels(kind);
}

// Adds a layer of a batch that FindSpans was asked about.
void AddRun(const RenderPlan& plan, const Layer& layer, size_t light_layer, double* const* sums,
            const TileScratch& s) {
  const ShadingMaterial& constants = plan.materials[s.runs[0].material.index];
  const LayerTerms terms = TermsOf(plan, layer, light_layer, constants, s);
  AddHits(ValuesOf(terms, ChannelsWithCoverage(layer.kind)), s.spans, sums);
}

// Adds a layer of any batch.
void AddRays(const RenderPlan& plan, const Layer& layer, size_t light_layer, double* const* sums,
             TileScratch* scratch) {
  Soa3<double>& values = GatherLayer(plan, layer, light_layer, Rgb(0, 0, 0), scratch);
  for (int c = 0; c < FloatChannels(layer.kind); ++c) {
    AddSamples(ChannelOf(values, c).data(), scratch->weights.data(),
               static_cast<int>(scratch->weights.size()), scratch->film.window.pixel_count(),
               sums[c]);
  }
}

// Makes values by ray of those by hit. `sky`: what the rays see that hit nothing, or null.
void SpreadHits(const Rgb& background, const Soa3<float>* sky, int channels, TileScratch* s) {
  const size_t hits = s->hits.count;
  const uint32_t* const ray = s->hits.ray.data();
  for (int c = 0; c < channels; ++c) {
    const double* const from = ChannelOf(s->hit_values, c).data();
    double* const to = ChannelOf(s->ray_values, c).data();
    if (sky != nullptr) {
      const AlignedArray<float>& seen = c == 0 ? sky->x : c == 1 ? sky->y : sky->z;
      std::copy_n(seen.data(), s->samples.count, to);
    } else {
      std::fill_n(to, s->samples.count, background[c]);
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

// Takes P, Z and ids of a pixel from a hit.
void PutNearest(const RenderPlan& plan, size_t hit, size_t pixel, TileScratch* scratch) {
  TileScratch& s = *scratch;
  const Vec3d relative(s.hits.position.x[hit], s.hits.position.y[hit], s.hits.position.z[hit]);
  const Vec3d world = relative + plan.scene->camera.position;
  const uint32_t primitive = s.hits.primitive[hit];
  const MaterialId material = MaterialAt(plan, primitive, s.samples.x[s.hits.ray[hit]]);
  size_t plane = 0;
  size_t id = 0;
  for (const Layer& layer : plan.layers) {
    if (layer.kind == LayerKind::kPosition) {
      for (int c = 0; c < 3; ++c) s.film.nearest[plane++][pixel] = static_cast<float>(world[c]);
    } else if (layer.kind == LayerKind::kDepth) {
      s.film.nearest[plane++][pixel] = static_cast<float>(relative ^ plan.camera.forward);
    } else if (layer.kind == LayerKind::kObjectId) {
      s.film.ids[id++][pixel] = ObjectOf(plan, primitive) + 1;
    } else if (layer.kind == LayerKind::kMaterialId) {
      s.film.ids[id++][pixel] = material.index + 1;
    }
  }
}

void ShowLight(const ReflectedRadiance& of_light, int light_layer, TileScratch* scratch) {
  Soa3<float>& layer = scratch->per_light[static_cast<size_t>(light_layer)];
  AddSoa(of_light.diffuse, scratch->hits.count, &layer);
  AddSoa(of_light.specular, scratch->hits.count, &layer);
}

void KeepLight(int light_layer, TileScratch* scratch) {
  TileScratch& s = *scratch;
  const size_t count = s.hits.count;
  if (light_layer >= 0) ShowLight(s.single, light_layer, &s);
  AddSoa(s.single.diffuse, count, &s.total.diffuse);
  AddSoa(s.single.specular, count, &s.total.specular);
}

void SeeSky(const RenderPlan& plan, TileScratch* scratch) {
  TileScratch& s = *scratch;
  if (plan.sky == nullptr || s.hits.count == s.samples.count) return;
  RayBatch& rays = s.sampled->sky_rays;
  MakeCameraRays(plan.camera, s.samples.x.data(), s.samples.y.data(), s.samples.count, &rays);
  SkyRadiance(*plan.sky, rays.direction, s.samples.count, &s.sampled->sky);
}

Soa3<double>& GatherLayer(const RenderPlan& plan, const Layer& layer, size_t light_layer,
                          const Rgb& background, TileScratch* scratch) {
  TileScratch& s = *scratch;
  const int channels = FloatChannels(layer.kind);
  if (s.hits.count > 0) {
    for (const MaterialRun& run : s.runs) {
      const LayerTerms terms =
          TermsOf(plan, layer, light_layer, plan.materials[run.material.index], s);
      for (int c = 0; c < channels; ++c) FillRun(terms, c, run, ChannelOf(s.hit_values, c).data());
    }
  }
  // Where every ray hits the same material, hits are in the order of rays.
  if (s.hits.count == s.samples.count && s.runs.size() == 1) return s.hit_values;
  const bool sees_sky = plan.sky != nullptr && ShowsBackground(layer);
  SpreadHits(background, sees_sky ? &s.sampled->sky : nullptr, channels, &s);
  return s.ray_values;
}

void AddToFilm(const RenderPlan& plan, TileScratch* scratch) {
  TileScratch& s = *scratch;
  if (s.hits.count == 0 && plan.sky == nullptr) return;
  // A pixel's samples are added in their order, whatever materials they hit.
  const bool in_order = s.hits.count > 0 && s.runs.size() == 1 && IsPlain(plan, s.runs[0]);
  if (in_order) FindSpans(s.runs[0], s.film.window.pixel_count(), &s);
  size_t sum = 0;
  size_t light_layer = 0;
  for (const Layer& layer : plan.layers) {
    if (!IsAveraged(layer.kind)) continue;
    double* sums[4] = {};
    for (int c = 0; c < ChannelsWithCoverage(layer.kind); ++c) {
      sums[c] = s.film.sums[sum + static_cast<size_t>(c)].data();
    }
    sum += static_cast<size_t>(FloatChannels(layer.kind));
    const bool sees_sky = plan.sky != nullptr && ShowsBackground(layer);
    if (in_order && !sees_sky) {
      const bool brought_along = layer.kind == LayerKind::kAlpha && plan.sky == nullptr;
      if (!brought_along) AddRun(plan, layer, light_layer, sums, s);
    } else if (s.hits.count > 0 || sees_sky) {
      AddRays(plan, layer, light_layer, sums, &s);
    }
    if (layer.kind == LayerKind::kLight) ++light_layer;
  }
  if (s.hits.count > 0 && s.film.nearest_distance.size() > 0) {
    AddNearest(
        plan, [&](uint32_t ray) { return RowPixel(s.film.window, ray); }, &s);
  }
}

bool PutOnlySamples(const RenderPlan& plan, TileScratch* scratch, Strip* strip) {
  TileScratch& s = *scratch;
  const auto plain = [&](const MaterialRun& run) { return IsPlain(plan, run); };
  if (!std::all_of(s.runs.begin(), s.runs.end(), plain)) return false;
  const Window& tile = s.film.window;
  if (s.hits.count < s.samples.count) FillBackground(plan, tile, strip);
  for (const MaterialRun& run : s.runs) {
    FindSpans(run, static_cast<size_t>(tile.width()), &s);
    const ShadingMaterial& constants = plan.materials[run.material.index];
    size_t color = 0, light_layer = 0;
    for (const Layer& layer : plan.layers) {
      if (layer.kind == LayerKind::kAlpha) continue;  // brought along
      const LayerTerms terms = TermsOf(plan, layer, light_layer, constants, s);
      const int channels = ChannelsWithCoverage(layer.kind);
      PixelRows<float> rows[4] = {};
      for (int c = 0; c < channels; ++c) {
        rows[c] = RowsIn(strip->window, tile, &strip->colors[color++]);
      }
      PutHits(ValuesOf(terms, channels), s.spans, rows);
      if (layer.kind == LayerKind::kLight) ++light_layer;
    }
  }
  return true;
}

void FillBackground(const RenderPlan& plan, const Window& tile, Strip* strip) {
  const double spp = plan.scene->image.spp;
  size_t color = 0;
  for (const Layer& layer : plan.layers) {
    const Rgb background = IsAveraged(layer.kind) ? BackgroundOf(layer, plan) : Rgb(0, 0, 0);
    // As the film averages it: the sum of spp floats, at most 2^16, is exact.
    const Rgb mean = background * spp * (1.0 / spp);
    for (int c = 0; c < FloatChannels(layer.kind); ++c) {
      FillPixels(static_cast<float>(mean[c]), RowsIn(strip->window, tile, &strip->colors[color++]));
    }
  }
  for (AlignedArray<uint32_t>& channel : strip->ids) {
    const PixelRows<uint32_t> rows = RowsIn(strip->window, tile, &channel);
    for (size_t y = 0; y < rows.height; ++y) {
      std::fill_n(rows.first + y * rows.stride, rows.width, 0u);
    }
  }
}

}  // namespace nacre
