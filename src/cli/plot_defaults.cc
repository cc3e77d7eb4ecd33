// SPDX-License-Identifier: Apache-2.0
#include "cli/plot_defaults.h"

#include <fmt/format.h>

namespace nacre {
namespace {

PlotItem Metal(double roughness, const std::string& rest, const std::string& label) {
  return {label, fmt::format(R"({{"model": "metallic_roughness", "base_color": 1, "metallic": 1, )"
                             R"("roughness": {}{}}})",
                             roughness, rest)};
}

}  // namespace

std::vector<PlotItem> DefaultModels() {
  return {
      {"Lambert", R"({"model": "lambert", "albedo": 0.5})"},
      {"Phong, n = 32", R"({"model": "phong", "kd": 0.5, "ks": 0.3, "shininess": 32})"},
      {"Blinn-Phong, n = 128",
       R"({"model": "blinn_phong", "kd": 0.5, "ks": 0.3, "shininess": 128})"},
      {"GGX dielectric, roughness 0.35",
       R"({"model": "metallic_roughness", "base_color": 0.5, "roughness": 0.35})"},
      {"GGX metal, roughness 0.5",
       R"({"model": "metallic_roughness", "base_color": 0.9, "metallic": 1, "roughness": 0.5})"},
  };
}

std::vector<PlotItem> DefaultDistributions() {
  std::vector<PlotItem> items;
  for (const double roughness : {0.1, 0.2, 0.4, 0.7, 1.0}) {
    items.push_back(Metal(roughness, "", fmt::format("GGX, roughness {}", roughness)));
  }
  // The exponent 2 / alpha^2 - 2 gives the same peak as roughness 0.4.
  items.push_back({"Blinn-Phong, n = 76", R"({"model": "blinn_phong", "shininess": 76})"});
  return items;
}

std::vector<PlotItem> DefaultMaskings() {
  std::vector<PlotItem> items;
  for (const double roughness : {0.3, 0.8}) {
    for (const char* form : {"height_correlated", "separable", "schlick_direct", "schlick_ibl"}) {
      items.push_back(Metal(roughness, fmt::format(R"(, "shadowing": "{}")", form),
                            fmt::format("{}, roughness {}", form, roughness)));
    }
  }
  return items;
}

std::vector<PlotItem> DefaultAlbedos() {
  const std::string single = R"(, "compensation": "none")";
  return {
      Metal(0.4, single, "metal, roughness 0.4, one bounce"),
      Metal(0.7, single, "metal, roughness 0.7, one bounce"),
      Metal(1, single, "metal, roughness 1, one bounce"),
      Metal(1, "", "metal, roughness 1, compensated"),
      {"dielectric, base by 1 - F(v.h)",
       R"({"model": "metallic_roughness", "base_color": 1, "roughness": 0.3, )"
       R"("diffuse_coupling": "one_minus_fresnel"})"},
      {"dielectric, base by albedo",
       R"({"model": "metallic_roughness", "base_color": 1, "roughness": 0.3})"},
  };
}

std::vector<PlotItem> DefaultInterfaces() {
  return {
      {"Schlick's curve, F0 = 0.04", R"({"model": "metallic_roughness"})"},
      {"glass (1.5), exact", R"({"model": "dielectric", "preset": "glass"})"},
      {"diamond (2.417), exact", R"({"model": "dielectric", "preset": "diamond"})"},
      {"iron, exact", R"({"model": "conductor", "preset": "iron"})"},
      {"gold, exact", R"({"model": "conductor", "preset": "gold"})"},
      {"aluminium, exact", R"({"model": "conductor", "preset": "aluminium"})"},
  };
}

// All have intensity 1 at a large distance.
std::vector<PlotItem> DefaultLights() {
  return {
      {"point, 1 / d²", R"({"type": "point", "position": [0, 0, 0], "intensity": 1})"},
      {"point, 1 / (1 + 0.1 d²)",
       R"({"type": "point", "position": [0, 0, 0], "intensity": 1, )"
       R"("attenuation": {"constant": 1, "linear": 0, "quadratic": 0.1}})"},
      {"sphere, radius 0.5",
       R"({"type": "sphere", "center": [0, 0, 0], "radius": 0.5, "radiance": 1.2732395447351628})"},
      {"disk, radius 1",
       R"({"type": "disk", "center": [0, 0, 0], "facing": [0, -1, 0], "radius": 1, )"
       R"("radiance": 0.3183098861837907})"},
      {"rectangle, 4 by 0.25",
       R"({"type": "rectangle", "center": [0, 0, 0], "facing": [0, -1, 0], "up": [0, 0, -1], )"
       R"("width": 4, "height": 0.25, "radiance": 1})"},
  };
}

}  // namespace nacre
