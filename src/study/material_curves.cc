// SPDX-License-Identifier: Apache-2.0
#include "study/material_curves.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "base/float_mode.h"
#include "brdf/ggx.h"
#include "brdf/phong.h"
#include "color/luminance.h"
#include "shading/lobe_residual.h"
#include "study/reflection.h"

namespace nacre {
namespace {

const Vec3d kNormal(0, 0, 1);
constexpr double kGrazing = 89.9;  // degrees: at 90 there is no light

const MicrofacetModel* MicrofacetOf(const ShadingMaterial& material) {
  return std::get_if<MicrofacetModel>(&material.model);
}

// Adds curves of a material computed by the scalar twins and, if requested, by the SIMD kernel.
template <class Value>
void AddReflectionCurves(const NamedMaterial& named, const std::string& suffix,
                         const std::vector<double>& angles, const CurveOptions& options,
                         const Value& value, Plot* plot) {
  plot->curves.push_back(MakeCurve(named.label + suffix, angles,
                                   [&](double degrees) { return value(Reflect, degrees); }));
  if (!options.kernel) return;
  const FlushDenormals flush;
  // Only a few marks, which do not hide the curve.
  std::vector<double> some;
  for (size_t i = 0; i < angles.size(); i += 12) some.push_back(angles[i]);
  Curve curve = MakeCurve(named.label + suffix + ", SIMD kernel", some,
                          [&](double degrees) { return value(ReflectByKernel, degrees); });
  curve.style = CurveStyle::kMarks;
  curve.look = static_cast<int>(plot->curves.size()) - 1;
  plot->curves.push_back(std::move(curve));
}

std::string AngleSuffix(const CurveOptions& options, const char* what, double angle) {
  return options.angles_deg.size() > 1 ? fmt::format(", {} {:g}°", what, angle) : "";
}

// The range of angles around the mirror direction in degrees. The light turns twice as fast as the
// half vector, and at eight times alpha, GGX has fallen to 1/4000 of its peak.
double HalfRange(const Material& first) {
  return std::max(2 * 8 * LobeAlpha(first) * 180 / M_PI, 0.1);
}

Curve LobeCurve(const NamedLobe& lobe, double view_deg, double from, double to) {
  const ShadingMaterial material = PrepareMaterial(lobe.material);
  return MakeCurve(lobe.label, Steps(from, to, 480), [&](double degrees) {
    return Luminance(
        Reflect(material, Vec3d(0, 0, 1), DirectionAt(degrees), DirectionAt(-view_deg)).specular);
  });
}

}  // namespace

double ValueOf(const Rgb& rgb, ColorChannel channel) {
  if (channel == ColorChannel::kLuminance) return Luminance(rgb);
  return rgb[static_cast<int>(channel) - static_cast<int>(ColorChannel::kRed)];
}

Plot BrdfPlot(const std::vector<NamedMaterial>& materials, const CurveOptions& options) {
  Plot plot;
  plot.x = {.label = "angle of the light (degrees)", .low = -90, .high = 90, .step = 30};
  plot.y = {.label = options.times_cosine ? "BRDF times cosine of the light (1/sr)" : "BRDF (1/sr)",
            .log = options.log};
  const std::vector<double> angles = Steps(-kGrazing, kGrazing, 720);
  for (const NamedMaterial& named : materials) {
    for (const double view : options.angles_deg) {
      const auto value = [&](const auto& reflect, double degrees) {
        const Vec3d to_light = DirectionAt(degrees);
        const Rgb sum = reflect(named.material, kNormal, to_light, DirectionAt(-view)).Sum();
        return ValueOf(sum, options.channel) / (options.times_cosine ? 1 : to_light.z);
      };
      AddReflectionCurves(named, AngleSuffix(options, "viewer", view), angles, options, value,
                          &plot);
    }
  }
  for (const double view : options.angles_deg) {
    plot.rules.push_back({Rule::Across::kX, view, view == 0 ? "viewer, mirrored" : "mirror"});
    if (view != 0) plot.rules.push_back({Rule::Across::kX, -view, "viewer"});
  }
  if (!options.log) plot.y.low = 0;
  return plot;
}

Plot PolarPlot(const std::vector<NamedMaterial>& materials, const CurveOptions& options) {
  Plot plot;
  plot.polar = true;
  plot.y.label = "reflected radiance per unit of irradiance from the light (1/sr)";
  const std::vector<double> angles = Steps(-kGrazing, kGrazing, 720);
  for (const NamedMaterial& named : materials) {
    for (const double light : options.angles_deg) {
      const Vec3d to_light = DirectionAt(-light);
      const auto value = [&](const auto& reflect, double degrees) {
        const Reflection reflection =
            reflect(named.material, kNormal, to_light, DirectionAt(degrees));
        return ValueOf(reflection.Sum(), options.channel);
      };
      AddReflectionCurves(named, AngleSuffix(options, "light", light), angles, options, value,
                          &plot);
    }
  }
  for (const double light : options.angles_deg) {
    plot.rules.push_back({Rule::Across::kX, -light, "light"});
  }
  return plot;
}

bool HasDistribution(const ShadingMaterial& material) {
  if (const auto* phong = std::get_if<PhongFamilyModel>(&material.model)) {
    return phong->model == PhongModel::kBlinnPhong;
  }
  const MicrofacetModel* const model = MicrofacetOf(material);
  return model != nullptr && !model->delta;
}

Plot DistributionPlot(const std::vector<NamedMaterial>& materials) {
  Plot plot;
  plot.x = {
      .label = "angle of the microfacet's normal (degrees)", .low = 0, .high = 90, .step = 15};
  plot.y = {.label = "distribution of normals D (1/sr)", .log = true, .low = 1e-4};
  for (const NamedMaterial& named : materials) {
    if (!HasDistribution(named.material)) continue;
    plot.curves.push_back(MakeCurve(named.label, Steps(0, 90, 720), [&](double degrees) {
      // Light and viewer are both along the half vector.
      const Vec3d half = DirectionAt(degrees);
      const Angles<double> a = ComputeAngles(kNormal, half, half);
      if (const MicrofacetModel* const model = MicrofacetOf(named.material)) {
        return GgxDistribution(a, model->alpha);
      }
      // (n + 2) / 2 pi times the lobe is normalised: int D n.h dh = 1.
      const auto& phong = std::get<PhongFamilyModel>(named.material.model);
      return PhongNormalization(phong.shininess) * BlinnLobe(a, phong.shininess);
    }));
  }
  return plot;
}

bool HasMicrofacets(const ShadingMaterial& material) { return MicrofacetOf(material) != nullptr; }

Plot MaskingPlot(const std::vector<NamedMaterial>& materials) {
  Plot plot;
  plot.x = {.label = "angle of light and viewer (degrees)", .low = 0, .high = 90, .step = 15};
  plot.y = {.label = "G: share of microfacets lit and seen (1: all)", .low = 0, .high = 1};
  for (const NamedMaterial& named : materials) {
    if (!HasMicrofacets(named.material)) continue;
    const MicrofacetModel& model = *MicrofacetOf(named.material);
    plot.curves.push_back(MakeCurve(named.label, Steps(0, kGrazing, 899), [&](double degrees) {
      const double cosine = DirectionAt(degrees).z;
      return 4 * cosine * cosine * VisibilityOf(model, cosine, cosine);
    }));
  }
  return plot;
}

Plot FresnelPlot(const std::vector<NamedMaterial>& materials, ColorChannel channel) {
  Plot plot;
  plot.x = {.label = "angle of incidence (degrees)", .low = 0, .high = 90, .step = 15};
  plot.y = {.label = "reflectance (1: all)", .low = 0, .high = 1};
  for (const NamedMaterial& named : materials) {
    if (!HasMicrofacets(named.material)) continue;
    const MicrofacetModel& model = *MicrofacetOf(named.material);
    plot.curves.push_back(MakeCurve(named.label, Steps(0, 90, 720), [&](double degrees) {
      const double half_sine = std::sin(degrees * M_PI / 360);
      const double one_minus_cosine = 2 * half_sine * half_sine;
      return ValueOf(FresnelOf(model, 1 - one_minus_cosine, one_minus_cosine), channel);
    }));
  }
  return plot;
}

Plot AlbedoPlot(const std::vector<NamedMaterial>& materials, ShareOf what, ColorChannel channel) {
  Plot plot;
  const bool furnace = what == ShareOf::kFurnace;
  plot.x = {.label = furnace ? "angle of the viewer (degrees)" : "angle of the light (degrees)",
            .low = 0,
            .high = 90,
            .step = 15};
  plot.y = {.label = furnace ? "radiance over the furnace’s (1: all)"
                             : "share of the light that is reflected (1: all)",
            .low = 0};
  for (const NamedMaterial& named : materials) {
    plot.curves.push_back(MakeCurve(named.label, Steps(0, 89, 89), [&](double degrees) {
      return ValueOf(ReflectedShare(named.material, what, DirectionAt(degrees).z), channel);
    }));
  }
  plot.rules.push_back({Rule::Across::kY, 1, "all of the light"});
  return plot;
}

Figure LobeFigure(const std::vector<NamedLobe>& lobes) {
  const double reach = HalfRange(lobes.front().material);
  Figure figure;
  figure.columns = 2;
  figure.width = 1700;
  figure.height = 1300;
  for (const double view_deg : kResidualViewsDeg) {
    const double from = std::max(view_deg - reach, -kGrazing);
    const double to = std::min(view_deg + reach, kGrazing);
    Plot plot;
    plot.title = fmt::format("viewer at {:g}°", view_deg);
    plot.x = {.label = "angle of the light (degrees)",
              .low = from == -kGrazing ? -90 : from,
              .high = to == kGrazing ? 90 : to};
    plot.y = {.label = "specular radiance per irradiance (1/sr)", .low = 0};
    double largest = 0;
    for (const NamedLobe& lobe : lobes) {
      plot.curves.push_back(LobeCurve(lobe, view_deg, from, to));
      largest = std::max(largest, std::ranges::max(plot.curves.back().y));
    }
    if (largest > 0) plot.y.high = 1.5 * largest;  // leaves room for the legend above the lobes
    plot.rules.push_back({Rule::Across::kX, view_deg, "mirror"});
    figure.panels.push_back(std::move(plot));
  }
  return figure;
}

// --- BRDFs as pictures of their most informative slice.

namespace {

constexpr int kSlicePoints = 180;       // along each axis, centred in half degrees
constexpr double kGrazingCosine = 0.1;  // a direction 84 degrees from the normal
constexpr double kDecades = 1e4;        // maximum of the scale, as in heat maps of errors

Field FieldOf(const ShadingMaterial& material, ColorChannel channel) {
  Field field;
  field.label = "BRDF (1/sr)";
  for (int row = 0; row < kSlicePoints; ++row) {
    for (int column = 0; column < kSlicePoints; ++column) {
      const double theta_h = 90 * (column + 0.5) / kSlicePoints;
      const double theta_d = 90 * (row + 0.5) / kSlicePoints;
      const auto [to_light, to_view] = DirectionsOfSlice(theta_h, theta_d);
      const Rgb sum = Reflect(material, Vec3d(0, 0, 1), to_light, to_view).Sum();
      field.x.push_back(theta_h);
      field.y.push_back(theta_d);
      field.values.push_back(ValueOf(sum, channel) / to_light.z);
    }
  }
  return field;
}

// Sets the scale to powers of ten around all values except those for grazing light, at most
// kDecades apart: for grazing light, BRDFs grow as 1 / n.l in any model, and would leave no colours
// for the rest.
void SetScale(std::vector<Plot>* plots) {
  double high = 0;
  double low = std::numeric_limits<double>::infinity();
  for (const Plot& plot : *plots) {
    const Field& field = *plot.field;
    for (size_t i = 0; i < field.values.size(); ++i) {
      const double value = field.values[i];
      const double n_dot_l = DirectionsOfSlice(field.x[i], field.y[i]).to_light.z;
      if (!(value > 0) || n_dot_l < kGrazingCosine) continue;
      high = std::max(high, value);
      low = std::min(low, value);
    }
  }
  if (high == 0) high = low = 1;  // all black
  high = std::pow(10, std::ceil(std::log10(high)));
  low = std::pow(10, std::floor(std::log10(low)));
  // At least one decade, since a scale has two different ends.
  low = std::clamp(low, high / kDecades, high / 10);
  for (Plot& plot : *plots) {
    plot.field->low = low;
    plot.field->high = high;
  }
}

}  // namespace

SliceDirections DirectionsOfSlice(double theta_h_deg, double theta_d_deg) {
  const double h = theta_h_deg * M_PI / 180;
  const double d = theta_d_deg * M_PI / 180;
  const Vec3d along_half = Vec3d(std::sin(h), 0, std::cos(h)) * std::cos(d);
  const Vec3d across(0, std::sin(d), 0);
  return {along_half + across, along_half - across};
}

std::vector<Plot> SlicePlots(const std::vector<NamedMaterial>& materials, ColorChannel channel) {
  std::vector<Plot> plots;
  plots.reserve(materials.size());
  for (const NamedMaterial& named : materials) {
    Plot plot;
    plot.title = named.label;
    plot.x = {.label = "half vector from the normal (degrees)", .low = 0, .high = 90, .step = 15};
    plot.y = {.label = "light from the half vector (degrees)", .low = 0, .high = 90, .step = 15};
    plot.field = FieldOf(named.material, channel);
    plots.push_back(std::move(plot));
  }
  SetScale(&plots);
  return plots;
}

}  // namespace nacre
