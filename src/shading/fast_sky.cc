// SPDX-License-Identifier: Apache-2.0
#include "shading/fast_sky.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "base/basis.h"
#include "base/parallel.h"
#include "brdf/lobe_sampling.h"
#include "sampling/sobol.h"
#include "shading/mapped.h"
#include "shading/scalar_material.h"

namespace nacre {
namespace {

constexpr size_t kNormals = 16;
constexpr double kViewCosines[] = {0.95, 0.6, 0.25};
// The estimates' own error is some thousandths, far below what they measure.
constexpr uint32_t kLobeSamples = 512;

constexpr int kImageRows = 64;  // of a sky by formula

// What the sky shows, as a multiple of its colour, along directions as a picture has them.
Vec3d SkyAt(const SampledLight& light, const Vec3d& l) {
  switch (light.form) {
    case SampledForm::kPictureSky: {
      const EnvironmentTexel& texel = TexelAt(*light.sky.picture, l);
      return {texel.red, texel.green, texel.blue};
    }
    case SampledForm::kGradientSky: {
      const Vec3f to_light(l);
      const auto& channels = light.sky.gradient;
      return {Radiance(channels[0], to_light), Radiance(channels[1], to_light),
              Radiance(channels[2], to_light)};
    }
    case SampledForm::kQuadraticSky:
      return Vec3d(std::max(Radiance(light.sky.quadratic, Vec3f(l)), 0.0f));
    default:
      return Vec3d(1);
  }
}

// What the lobe reflects of the sky, by both ways of choosing that it has and the balance
// heuristic. Directions are as SkyAt has them.
Vec3d SampleTruth(const ShadingMaterial& material, const SampledLight& light, const Vec3d& normal,
                  const Vec3d& to_view) {
  const double alpha = std::get<MicrofacetModel>(material.model).alpha;
  const EnvironmentMap* const map = light.sky.picture.get();
  Vec3d sum(0);
  const auto add = [&](const Vec3d& to_light) {
    const double density = GgxVisiblePdf(normal, to_view, to_light, alpha) +
                           (map != nullptr ? double{TexelAt(*map, to_light).pdf} : 0.0);
    if (!(density > 0)) return;
    sum +=
        SkyAt(light, to_light) * (Reflect(material, normal, to_light, to_view).specular / density);
  };
  for (uint32_t i = 0; i < kLobeSamples; ++i) {
    const Vec2d lobe = SobolSample2D(i, 0, 1), by_light = SobolSample2D(i, 1, 1);
    add(SampleGgxVisible(normal, to_view, alpha, lobe.x, lobe.y));
    if (map == nullptr) continue;
    const auto sample = SampleEnvironment<double>(*map, by_light.x, by_light.y);
    if (sample.texel.pdf > 0) add(sample.to_light);
  }
  return sum / double{kLobeSamples};
}

// Normals even over the sphere, by a spiral of the golden angle; views at the cosine from them.
struct SurfacePoint {
  Vec3d normal, to_view;
};

SurfacePoint PointAt(size_t i) {
  const size_t k = i / std::size(kViewCosines);
  const double cosine = kViewCosines[i % std::size(kViewCosines)];
  const double y = 1 - (2 * static_cast<double>(k) + 1) / kNormals;
  const double r = std::sqrt((1 - y) * (1 + y));
  const double phi = static_cast<double>(k) * M_PI * (3 - std::sqrt(5.0));
  const Vec3d normal(r * std::sin(phi), y, r * std::cos(phi));
  const double turn = static_cast<double>(i), sine = std::sqrt((1 - cosine) * (1 + cosine));
  return {normal,
          BasisAbout(normal).ToWorld({sine * std::cos(turn), sine * std::sin(turn), cosine})};
}

Vec3d SplitSum(const ShadingMaterial& material, const SampledLight& light,
               const SurfacePoint& point) {
  const auto& model = std::get<MicrofacetModel>(material.model);
  const PrefilteredMap* const lobe = FindLobe(*light.sky.fast, model.alpha);
  Vec3d radiance(1);
  if (lobe != nullptr) radiance = LookUp(*lobe, Mirrored(point.to_view, point.normal));
  for (int c = 0; c < 3; ++c) radiance[c] *= LobeAlbedo(model, point.normal ^ point.to_view, c);
  return radiance;
}

}  // namespace

bool HasFastLobe(const ShadingMaterial& material) {
  const auto* model = std::get_if<MicrofacetModel>(&material.model);
  return model != nullptr && !HasMappedModel(material) && !material.turned && !model->delta &&
         model->alpha >= kLeastPrefilterAlpha;
}

bool HasFastLobe(const SampledLight& light, const ShadingMaterial& material) {
  if (light.sky.fast == nullptr || !HasFastLobe(material)) return false;
  return light.form == SampledForm::kConstantSky ||
         FindLobe(*light.sky.fast, std::get<MicrofacetModel>(material.model).alpha) != nullptr;
}

const PrefilteredMap* FindLobe(const FastSky& sky, double alpha) {
  const auto lobe = std::find_if(sky.lobes.begin(), sky.lobes.end(),
                                 [&](const PrefilteredMap& map) { return map.alpha == alpha; });
  return lobe == sky.lobes.end() ? nullptr : &*lobe;
}

std::shared_ptr<const EnvironmentMap> ImageOf(const SampledLight& light) {
  if (light.form == SampledForm::kPictureSky) return light.sky.picture;
  std::vector<Vec3f> texels;
  texels.reserve(size_t{2} * kImageRows * kImageRows);
  for (int y = 0; y < kImageRows; ++y) {
    for (int x = 0; x < 2 * kImageRows; ++x) {
      texels.emplace_back(
          SkyAt(light, DirectionFromLatLong((x + 0.5) / (2 * kImageRows), (y + 0.5) / kImageRows)));
    }
  }
  return std::make_shared<EnvironmentMap>(MakeEnvironmentMap(2 * kImageRows, kImageRows, texels));
}

FastLobeError CompareEstimates(std::span<const Vec3d> truth, std::span<const Vec3d> fast) {
  Vec3d mean(0);
  for (const Vec3d& radiance : truth) mean += radiance / static_cast<double>(truth.size());
  FastLobeError error{truth.size(), 0, 0};
  double squares = 0, count = 0;
  for (size_t i = 0; i < truth.size(); ++i) {
    for (int c = 0; c < 3; ++c) {
      if (!(mean[c] > 0)) continue;
      const double relative = std::abs(fast[i][c] - truth[i][c]) / mean[c];
      error.worst = std::max(error.worst, relative);
      squares += relative * relative;
      count += 1;
    }
  }
  error.rms = count > 0 ? std::sqrt(squares / count) : 0;
  return error;
}

FastLobeError MeasureFastLobe(const ShadingMaterial& material, const SampledLight& light,
                              int threads) {
  constexpr size_t kPoints = kNormals * std::size(kViewCosines);
  std::vector<Vec3d> truth(kPoints), fast(kPoints);
  ParallelFor(kPoints, threads, [&](size_t i) {
    const SurfacePoint point = PointAt(i);
    truth[i] = SampleTruth(material, light, point.normal, point.to_view);
    fast[i] = SplitSum(material, light, point);
  });
  return CompareEstimates(truth, fast);
}

}  // namespace nacre
