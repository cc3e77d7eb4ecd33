// SPDX-License-Identifier: Apache-2.0
#include "study/material_curves.h"

#include <cmath>

#include <fmt/format.h>

#include "base/parallel.h"
#include "brdf/ggx.h"
#include "brdf/phong.h"
#include "color/luminance.h"

namespace nacre {
namespace {

const Vec3d kNormal(0, 0, 1);
constexpr double kGrazing = 89.9;  // degrees: at 90 there is no light

std::vector<double> Steps(double from, double to, double step) {
  const int count = static_cast<int>(std::lround((to - from) / step));
  std::vector<double> values;
  values.reserve(static_cast<size_t>(count) + 1);
  for (int i = 0; i <= count; ++i) values.push_back(from + (to - from) * i / count);
  return values;
}

template <class Function>
Curve MakeCurve(const std::string& title, const std::vector<double>& x, const Function& f) {
  Curve curve;
  curve.title = title;
  curve.x = x;
  curve.y.reserve(x.size());
  for (const double value : x) curve.y.push_back(f(value));
  return curve;
}

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

}  // namespace

double ValueOf(const Rgb& rgb, ColorChannel channel) {
  switch (channel) {
    case ColorChannel::kRed:
      return rgb.x;
    case ColorChannel::kGreen:
      return rgb.y;
    case ColorChannel::kBlue:
      return rgb.z;
    case ColorChannel::kLuminance:
      break;
  }
  return Luminance(rgb);
}

Plot BrdfPlot(const std::vector<NamedMaterial>& materials, const CurveOptions& options) {
  Plot plot;
  plot.x = {.label = "angle of the light (degrees)", .low = -90, .high = 90, .step = 30};
  plot.y = {.label = options.times_cosine ? "BRDF times cosine of the light (1/sr)" : "BRDF (1/sr)",
            .log = options.log};
  const std::vector<double> angles = Steps(-kGrazing, kGrazing, 2 * kGrazing / 720);
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
  const std::vector<double> angles = Steps(-kGrazing, kGrazing, 2 * kGrazing / 720);
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
    plot.curves.push_back(MakeCurve(named.label, Steps(0, 90, 0.125), [&](double degrees) {
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

bool HasMasking(const ShadingMaterial& material) { return MicrofacetOf(material) != nullptr; }

Plot MaskingPlot(const std::vector<NamedMaterial>& materials) {
  Plot plot;
  plot.x = {.label = "angle of light and viewer (degrees)", .low = 0, .high = 90, .step = 15};
  plot.y = {.label = "G: share of microfacets lit and seen (1: all)", .low = 0, .high = 1};
  for (const NamedMaterial& named : materials) {
    if (!HasMasking(named.material)) continue;
    const MicrofacetModel& model = *MicrofacetOf(named.material);
    plot.curves.push_back(MakeCurve(named.label, Steps(0, kGrazing, 0.1), [&](double degrees) {
      const double cosine = DirectionAt(degrees).z;
      return 4 * cosine * cosine * VisibilityOf(model, cosine, cosine);
    }));
  }
  return plot;
}

bool HasFresnel(const ShadingMaterial& material) { return MicrofacetOf(material) != nullptr; }

Plot FresnelPlot(const std::vector<NamedMaterial>& materials, ColorChannel channel) {
  Plot plot;
  plot.x = {.label = "angle of incidence (degrees)", .low = 0, .high = 90, .step = 15};
  plot.y = {.label = "reflectance (1: all)", .low = 0, .high = 1};
  for (const NamedMaterial& named : materials) {
    if (!HasFresnel(named.material)) continue;
    const MicrofacetModel& model = *MicrofacetOf(named.material);
    plot.curves.push_back(MakeCurve(named.label, Steps(0, 90, 0.125), [&](double degrees) {
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
    plot.curves.push_back(MakeCurve(named.label, Steps(0, 89, 1), [&](double degrees) {
      return ValueOf(ReflectedShare(named.material, what, DirectionAt(degrees).z), channel);
    }));
  }
  plot.rules.push_back({Rule::Across::kY, 1, "all of the light"});
  return plot;
}

}  // namespace nacre
