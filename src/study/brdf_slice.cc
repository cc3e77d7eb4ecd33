// SPDX-License-Identifier: Apache-2.0
#include "study/brdf_slice.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace nacre {
namespace {

constexpr int kSlicePoints = 180;       // along each axis, centred in half degrees
constexpr double kGrazingCosine = 0.1;  // a direction 84 degrees from the normal
constexpr double kDecades = 1e4;        // maximum of the scale, as in heat maps of errors

Field FieldOf(const ShadingMaterial& material, ColorChannel channel) {
  Field field;
  field.label = "BRDF (1/sr)";
  constexpr size_t kCount = size_t{kSlicePoints} * kSlicePoints;
  field.x.reserve(kCount);
  field.y.reserve(kCount);
  field.values.reserve(kCount);
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
