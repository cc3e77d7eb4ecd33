// SPDX-License-Identifier: Apache-2.0
#include "render/rare_features.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <variant>
#include <vector>

#include "render/interval.h"
#include "sampling/pixel_filter.h"

namespace nacre {
namespace {

constexpr double kNoBound = std::numeric_limits<double>::infinity();

// Hits on rare things that a pixel must expect before the spread of its replicates tells of them:
// two in each, so that all agree by chance in one of 190 cases (Poisson).
constexpr double kExpectedHits = 2 * kReplicates;

// Spheres whose pictures are wider, in pixels, are found: 16 samples expect more hits than that.
constexpr double kWidestRare = 2;

// A picture as the square of the same area around the same place, in pixels.
struct SmallPicture {
  uint32_t material;
  double x, y, half_side;
};

double MeanRadiance(const EnvironmentMap& map) {
  double sum = 0;
  for (int y = 0; y < map.height; ++y) {
    double row = 0;
    for (int x = 0; x < map.width; ++x) {
      const EnvironmentTexel& t =
          map.texels[static_cast<size_t>(y) * static_cast<size_t>(map.width) +
                     static_cast<size_t>(x)];
      row += std::max({t.red, t.green, t.blue});
    }
    sum += row * TexelSolidAngle(map.width, map.height, y);
  }
  return sum / (4 * M_PI);
}

// A mirror ball's picture shows all directions alike, a matte one at most 4 times their mean.
double BrightestUnder(const SampledLight& light) {
  const double color = std::max({light.color.x, light.color.y, light.color.z});
  switch (light.form) {
    case SampledForm::kGradientSky:
    case SampledForm::kQuadraticSky:
      return kNoBound;
    case SampledForm::kPictureSky:
      return 4 * color * MeanRadiance(*light.sky.picture);
    default:
      return color;
  }
}

// The share of a pixel's samples, along one axis, that lie between two distances from its centre.
double ShareBetween(const PixelFilter& filter, double from, double to) {
  const auto below = [&](double x) {
    const double inside = FilterIntegral(filter, std::min(std::abs(x), filter.width / 2));
    return x < 0 ? -inside : inside;
  };
  return std::abs(below(to) - below(from));
}

std::vector<SmallPicture> SmallPicturesOf(const RenderPlan& plan,
                                          const TileCandidates& candidates) {
  std::vector<SmallPicture> small;
  const Projector projector = MakeProjector(plan.camera);
  for (const auto& cell : candidates.cells) {
    for (const TileCandidate& candidate : cell) {
      const FilmBounds b = Project(projector, candidate.sphere);
      const double width = b.x1 - b.x0, height = b.y1 - b.y0;
      if (!b.visible || !(width < kWidestRare && height < kWidestRare)) continue;
      small.push_back({MaterialAt(plan, candidate.primitive, (b.x0 + b.x1) / 2).index,
                       (b.x0 + b.x1) / 2, (b.y0 + b.y1) / 2,
                       std::sqrt(M_PI / 4 * width * height) / 2});
    }
  }
  std::stable_sort(small.begin(), small.end(), [](const SmallPicture& a, const SmallPicture& b) {
    return a.material < b.material;
  });
  return small;
}

// Adds the picture's share of the samples of each of the cell's pixels that it is in the reach of.
void AddShares(const PixelFilter& filter, const Window& cell, const SmallPicture& picture,
               double (&shares)[kCellSide][kCellSide]) {
  const double reach = filter.width / 2 + picture.half_side;
  const auto first = [&](double at, int from) {
    return std::max(static_cast<int>(std::floor(at - 0.5 - reach)), from);
  };
  const auto last = [&](double at, int to) {
    return std::min(static_cast<int>(std::ceil(at - 0.5 + reach)), to - 1);
  };
  for (int y = first(picture.y, cell.y0); y <= last(picture.y, cell.y1); ++y) {
    const double down = picture.y - (y + 0.5);
    const double of_rows = ShareBetween(filter, down - picture.half_side, down + picture.half_side);
    for (int x = first(picture.x, cell.x0); x <= last(picture.x, cell.x1); ++x) {
      const double across = picture.x - (x + 0.5);
      shares[y - cell.y0][x - cell.x0] +=
          of_rows * ShareBetween(filter, across - picture.half_side, across + picture.half_side);
    }
  }
}

}  // namespace

double BrightestObject(const RenderPlan& plan) {
  if (plan.adaptive.white < kNoBound) return plan.adaptive.white;
  double brightest = 0;
  for (const Material& material : plan.scene->materials) {
    const Rgb& e = material.emission;
    brightest = std::max({brightest, e.x, e.y, e.z});
  }
  for (const Light& light : plan.scene->lights) {
    if (IsPunctual(light)) return kNoBound;
    if (const auto* ambient = std::get_if<AmbientLight>(&light.kind)) {
      brightest += std::max({ambient->radiance.x, ambient->radiance.y, ambient->radiance.z});
    }
  }
  for (const PlannedSampledLight& light : plan.sampled_lights) {
    brightest += BrightestUnder(light.light);
  }
  return brightest;
}

void FindRareSpheres(const RenderPlan& plan, const Window& cell, const TileCandidates& candidates,
                     CellScratch* c) {
  std::fill_n(c->rare_samples, kCellPixels, 0.0);
  std::fill_n(c->rare_radiance, kCellPixels, 0.0);
  const std::vector<SmallPicture> small = SmallPicturesOf(plan, candidates);
  const double least_wanted = plan.adaptive.max_error * kDarkest;
  for (size_t i = 0; i < small.size();) {
    double shares[kCellSide][kCellSide] = {};
    const uint32_t material = small[i].material;
    for (; i < small.size() && small[i].material == material; ++i) {
      AddShares(plan.scene->image.filter, cell, small[i], shares);
    }
    for (uint32_t pixel = 0; pixel < kCellPixels; ++pixel) {
      const FilmPixel at = PixelOf(cell, pixel);
      const double share = shares[at.y - cell.y0][at.x - cell.x0];
      const double radiance = share * plan.adaptive.brightest;
      if (share == 0 || radiance * 2 <= least_wanted) continue;
      c->rare_samples[pixel] = std::max(c->rare_samples[pixel], kExpectedHits / share);
      c->rare_radiance[pixel] += radiance;
    }
  }
}

}  // namespace nacre
