// SPDX-License-Identifier: Apache-2.0
#include "shading/fast_area.h"

#include <algorithm>
#include <cmath>

#include "base/basis.h"
#include "base/parallel.h"
#include "brdf/lobe_sampling.h"
#include "sampling/sobol.h"
#include "shading/fast_area_kernels.h"
#include "shading/mapped.h"
#include "shading/scalar_material.h"
#include "shading/seen_light.h"

namespace nacre {
namespace {

constexpr size_t kDirections = 4;          // around the light, at each of
constexpr double kDistances[] = {1.5, 4};  // over its radius
constexpr double kTilts[] = {0, 0.3};      // of the normal away from where the highlight is
constexpr double kViewCosines[] = {0.9, 0.5, 0.15};  // of view and light, about
// The estimates' own error is about a hundredth, below what they measure.
constexpr uint32_t kLobeSamples = 256;

struct SurfacePoint {
  Vec3d position, normal, to_view;
};

// Surfaces that show the light's highlight, or its flank: normals about half-way between light and
// viewer.
SurfacePoint PointAt(const SampledLight& light, size_t i) {
  const bool rectangle = light.form == SampledForm::kRectangle;
  const bool flat = rectangle || light.form == SampledForm::kDisk;
  const Vec3d way = (light.edge_x + light.edge_y) / 2;
  const Vec3d center = rectangle ? light.place + way : light.place;
  const double radius = rectangle ? way.length() : light.radius;
  const auto take = [&](size_t count) {
    const size_t digit = i % count;
    i /= count;
    return digit;
  };
  const double cosine = kViewCosines[take(std::size(kViewCosines))];
  const double tilt = kTilts[take(std::size(kTilts))];
  const double distance = kDistances[take(std::size(kDistances))] * radius;
  // A spiral of the golden angle over the sphere, or the half that a flat light faces.
  const double phi = static_cast<double>(i) * M_PI * (3 - std::sqrt(5.0));
  const double height = (static_cast<double>(i) + 0.5) / kDirections;
  const double z = flat && !light.two_sided ? height : 2 * height - 1;
  const double r = std::sqrt((1 - z) * (1 + z));
  const Basis<double> about = BasisAbout(flat ? light.normal : Vec3d(0, 0, 1));
  const Vec3d from_light = about.ToWorld({r * std::cos(phi), r * std::sin(phi), z});
  const Basis<double> around = BasisAbout(-from_light);
  const double half = std::acos(cosine), turn = 2 * phi + 1;
  const auto lean = [&](double angle, double by) {
    return around.ToWorld(
        {std::sin(angle) * std::cos(by), std::sin(angle) * std::sin(by), std::cos(angle)});
  };
  const Vec3d normal = (lean(half, turn) + lean(1.0, turn + 2) * tilt).normalized();
  return {center + from_light * distance, normal, Mirrored(-from_light, lean(half, turn))};
}

Vec3d SampleTruth(const ShadingMaterial& material, const SeenLight& light,
                  const SurfacePoint& point) {
  const double alpha = std::get<MicrofacetModel>(material.model).alpha;
  Vec3d sum(0);
  const auto add = [&](const Vec3d& to_light) {
    const double by_light = light.Density(to_light);
    if (!(by_light > 0)) return;
    const double density = by_light + GgxVisiblePdf(point.normal, point.to_view, to_light, alpha);
    sum += Reflect(material, point.normal, to_light, point.to_view).specular / density;
  };
  for (uint32_t i = 0; i < kLobeSamples; ++i) {
    const Vec2d lobe = SobolSample2D(i, 0, 1), by_light = SobolSample2D(i, 1, 1);
    add(SampleGgxVisible(point.normal, point.to_view, alpha, lobe.x, lobe.y));
    add(light.Sample(by_light.x, by_light.y));
  }
  return sum / double{kLobeSamples};
}

// The part of LobeAlbedo that Fresnel's curve adds to its value at normal incidence.
double GrazingAlbedo(const MicrofacetModel& model, double n_dot_v, int channel) {
  const double one = AlbedoOne(model.albedo.lobe, n_dot_v);
  const double loss = AlbedoLoss(model.albedo.lobe, n_dot_v);
  const double f0 = model.f0[channel];
  double rest = f0 * one;
  if (model.compensation == Compensation::kTurquin) rest *= 1 + f0 * loss / one;
  if (model.compensation == Compensation::kKullaConty) rest += model.f_multiple[channel] * loss;
  return std::max(LobeAlbedo(model, n_dot_v, channel) - rest, 0.0);
}

Vec3d Transformed(const ShadingMaterial& material, const LtcRows& rows, const SeenLight& light,
                  const SurfacePoint& point) {
  const double n_dot_v = point.normal ^ point.to_view;
  if (!(n_dot_v > 0)) return Vec3d(0);
  const Vec3d across = point.to_view - point.normal * n_dot_v;
  Basis<double> frame = BasisAbout(point.normal);
  if (across.length() > 1e-5) {
    const Vec3d x = across.normalized();
    frame = {x, point.normal % x, point.normal};
  }
  const double one = light.Share(AtView(rows.one, static_cast<float>(n_dot_v)), frame);
  const double schlick = light.Share(AtView(rows.schlick, static_cast<float>(n_dot_v)), frame);
  const auto& model = std::get<MicrofacetModel>(material.model);
  Vec3d reflected;
  for (int c = 0; c < 3; ++c) {
    const double grazing = GrazingAlbedo(model, n_dot_v, c);
    reflected[c] = (LobeAlbedo(model, n_dot_v, c) - grazing) * one + grazing * schlick;
  }
  return reflected;
}

bool IsRound(const SampledLight& light) {
  return light.form == SampledForm::kSphere || light.form == SampledForm::kDisk;
}

}  // namespace

bool HasTransformedLobe(const SampledLight& light, const ShadingMaterial& material) {
  if (!light.transformed_cosines || HasMappedModel(material) || material.turned) return false;
  const auto* model = std::get_if<MicrofacetModel>(&material.model);
  return model != nullptr && !model->delta &&
         model->alpha >= kLeastLtcRoughness * kLeastLtcRoughness;
}

void TransformedReflectance(const SampledLight& light, const ShadingMaterial& material,
                            const LobeRange& range, LobeShares* shares, Soa3<float>* reflected) {
  const double alpha = std::get<MicrofacetModel>(material.model).alpha;
  const LtcRows rows = MakeLtcRows(std::sqrt(alpha));
  if (IsRound(light)) {
    RoundShares(rows, light, range, shares);
  } else {
    FlatShares(rows, light, range, shares);
  }
  FastReflectance(material, range, reflected, &shares->grazing);
  const auto weigh = [&](const AlignedArray<float>& grazing, AlignedArray<float>* value) {
    for (size_t i = range.begin; i < range.end; ++i) {
      (*value)[i] = ((*value)[i] - grazing[i]) * shares->one[i] + grazing[i] * shares->schlick[i];
    }
  };
  weigh(shares->grazing.x, &reflected->x);
  weigh(shares->grazing.y, &reflected->y);
  weigh(shares->grazing.z, &reflected->z);
}

FastLobeError MeasureTransformedLobe(const ShadingMaterial& material, const SampledLight& light,
                                     int threads) {
  constexpr size_t kPoints =
      kDirections * std::size(kDistances) * std::size(kTilts) * std::size(kViewCosines);
  const LtcRows rows = MakeLtcRows(std::sqrt(std::get<MicrofacetModel>(material.model).alpha));
  std::vector<Vec3d> truth(kPoints), fast(kPoints);
  ParallelFor(kPoints, threads, [&](size_t i) {
    const SurfacePoint point = PointAt(light, i);
    const SeenLight seen(light, point.position);
    truth[i] = SampleTruth(material, seen, point);
    fast[i] = Transformed(material, rows, seen, point);
  });
  return CompareEstimates(truth, fast);
}

}  // namespace nacre
