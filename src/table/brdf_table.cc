// SPDX-License-Identifier: Apache-2.0
#include "table/brdf_table.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include <fmt/format.h>

#include "base/version.h"
#include "scene/material_parameters.h"
#include "scene/open_pbr.h"
#include "shading/scalar_bsdf.h"
#include "table/variant.h"

namespace nacre {
namespace {

constexpr int kFormatVersion = 1;
const Vec3d kUp(0, 0, 1);

Json NumberOrColor(const MaterialParameter& parameter, const Rgb& value) {
  if (!parameter.is_color) return value.x;
  return Json::array({value.x, value.y, value.z});
}

// The rules whose options a material has all; null if they are nobody's.
Json RulesOf(const Material& material, const MaterialChoice& rules, const MaterialModel& model) {
  for (size_t option = 0; option < rules.options.size(); ++option) {
    Material other = material;
    rules.set(other, option);
    bool same = true;
    for (const MaterialChoice& choice : model.choices) {
      same = same && (choice.get == nullptr || choice.get(other) == choice.get(material));
    }
    if (same) return rules.options[option];
  }
  return nullptr;
}

// The maps that are left out, by name.
Json MapsOf(const Material& material, const MaterialModel& model) {
  Json names = Json::array();
  for (const MaterialMap& map : model.maps) {
    if (map.get(material).valid()) names.push_back(map.name);
  }
  for (const MaterialNormalMap& map : model.normal_maps) {
    if (NormalMapOf(map, material).texture.valid()) names.push_back(map.name);
  }
  if (material.bump_map.texture.valid()) names.push_back("bump_map");
  return names;
}

// The lobes that are perfect mirrors, with what they reflect along the normal.
Json MirrorsOf(const ShadingMaterial& material) {
  Json mirrors = Json::object();
  const auto add = [&](const std::string& name, const ShadingMaterial& of) {
    if (!HasDeltaLobe(of)) return;
    const Rgb f0 = MirrorReflectance(std::get<MicrofacetModel>(of.model), 1);
    mirrors[name] = Json::array({f0.x, f0.y, f0.z});
  };
  add("specular", material);
  for (size_t k = 0; k < material.coats.size(); ++k) {
    add(k == 0 ? "coat" : fmt::format("coat{}", k + 1), *material.coats[k]);
  }
  return mirrors;
}

void AddRgb(const Rgb& rgb, std::vector<double>* values) {
  values->insert(values->end(), {rgb.x, rgb.y, rgb.z});
}

void AddPair(const DirectionPair& pair, std::vector<double>* values) {
  for (const Vec3d& v : {pair.to_light, pair.to_view}) {
    values->insert(values->end(), {v.x, v.y, v.z});
  }
}

std::vector<std::string> ColumnsOf(const PreparedVariant& prepared, bool albedo) {
  std::vector<std::string> columns = {"light_x", "light_y", "light_z",
                                      "view_x",  "view_y",  "view_z"};
  const auto add = [&](const std::string& name) {
    for (const char* channel : {"_r", "_g", "_b"}) columns.push_back(name + channel);
  };
  add("f");
  for (const std::string& lobe : prepared.lobes()) add(lobe);
  columns.emplace_back("pdf");
  if (albedo) add("albedo");
  return columns;
}

}  // namespace

Json WholeMaterialJson(const Material& material) {
  if (material.user) return {{"model", "function"}};
  const MaterialModel& model = *ModelOf(material);
  Json json = {{"model", model.name}};
  if (const auto* measured = std::get_if<MeasuredMaterial>(&material.model)) {
    json["file"] = measured->file;
  }
  for (const MaterialParameter& parameter : model.parameters) {
    json[std::string(parameter.name)] = NumberOrColor(parameter, parameter.get(material));
  }
  for (const MaterialChoice& choice : model.choices) {
    if (choice.get == nullptr) continue;
    json[std::string(choice.name)] = choice.options[choice.get(material)];
  }
  return json;
}

Json HeaderOf(const Material& material) {
  const PreparedVariant prepared({.material = material});
  Json header = {{"nacre_table", kFormatVersion},
                 {"nacre", fmt::format("{} ({})", kVersion, kCommit)},
                 {"material", WholeMaterialJson(material)}};
  if (!material.user) {
    const MaterialModel& model = *ModelOf(material);
    for (const MaterialChoice& choice : model.choices) {
      if (choice.name == "rules") header["rules"] = RulesOf(material, choice, model);
    }
    if (std::holds_alternative<MicrofacetModel>(prepared.material().model)) {
      const Json whole = header["material"];  // a copy: members that are added move the others
      header["smith"] = whole.value(whole.contains("smith") ? "smith" : "shadowing", "");
      header["compensation"] = whole.value("compensation", "");
      const auto& lobe = std::get<MicrofacetModel>(prepared.material().model);
      header["alpha"] = lobe.alpha;
      if (lobe.anisotropic) {
        // Along the material's tangent, which its parameters turn away from the surface's, and
        // across it.
        header["alpha"] = {lobe.anisotropic->alpha.x, lobe.anisotropic->alpha.y};
      }
    }
    const Json maps = MapsOf(material, model);
    if (!maps.empty()) header["maps_left_out"] = maps;
  }
  const bool has_film = header["material"].contains("thin_film_weight");
  header["thin_film"] = has_film ? "by the parameters and options above" : "none";
  header["directions"] =
      "unit vectors that point away from the surface; +z is the normal, +x the tangent";
  header["f"] =
      "the BRDF, radiance per irradiance in 1/sr, without n.l; the lobes as they contribute, so "
      "that they sum to f";
  header["lobes"] = prepared.lobes();
  header["mirrors"] = MirrorsOf(prepared.material());
  header["mirrors_are"] = "lobes that no row has, with their reflectance along the normal";
  header["pdf"] =
      "of nacre's sampler of the light, per solid angle, without mirrors; other samplers are "
      "right, "
      "too";
  header["albedo"] =
      "the radiance seen from the view under radiance 1 from everywhere, mirrors included, right "
      "to 0.001";
  header["color_space"] = "linear Rec. 709";
  return header;
}

std::vector<std::string> ColumnsOf(const Material& material, bool albedo) {
  return ColumnsOf(PreparedVariant({.material = material}), albedo);
}

BrdfTable TabulateBrdf(const Material& material, std::span<const DirectionPair> pairs,
                       const TableOptions& options) {
  const PreparedVariant prepared({.material = material});
  const ShadingMaterial& shading = prepared.material();
  BrdfTable table{.header = HeaderOf(material), .columns = ColumnsOf(prepared, options.albedo)};
  table.values.reserve(pairs.size() * table.columns.size());
  std::vector<Rgb> lobes(prepared.lobes().size());
  ViewAlbedos albedos(prepared);
  for (size_t i = 0; i < pairs.size(); ++i) {
    if (options.on_progress) {
      options.on_progress(static_cast<double>(i) / static_cast<double>(pairs.size()));
    }
    const auto& [l, v] = pairs[i];
    AddPair(pairs[i], &table.values);
    prepared.Evaluate(l, v, lobes);
    Rgb sum(0, 0, 0);
    for (const Rgb& lobe : lobes) sum += lobe;
    AddRgb(sum, &table.values);
    for (const Rgb& lobe : lobes) AddRgb(lobe, &table.values);
    const bool above = l.z > 0 && v.z > 0;
    table.values.push_back(above ? ReflectionPdf(shading, kUp, v, l, false) : 0);
    if (!options.albedo) continue;
    AddRgb(v.z > 0 ? albedos.At(v) : Rgb(0), &table.values);
  }
  return table;
}

std::vector<size_t> RowsNotFinite(const BrdfTable& table) {
  const auto is_finite = [](double value) { return std::isfinite(value); };
  std::vector<size_t> rows;
  for (size_t row = 0; row < table.rows(); ++row) {
    const size_t columns = table.columns.size();
    const auto values = std::span(table.values).subspan(row * columns, columns);
    if (!std::ranges::all_of(values, is_finite)) rows.push_back(row);
  }
  return rows;
}

BrdfTable TabulateDirections(std::span<const DirectionPair> pairs) {
  BrdfTable table{.columns = {"light_x", "light_y", "light_z", "view_x", "view_y", "view_z"}};
  for (const DirectionPair& pair : pairs) AddPair(pair, &table.values);
  return table;
}

}  // namespace nacre
