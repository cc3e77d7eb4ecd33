// SPDX-License-Identifier: Apache-2.0
#include "scene_io/material_json.h"

#include <cstdlib>

#include <fmt/format.h>

#include "brdf/fresnel.h"
#include "scene/material_parameters.h"

namespace nacre {
namespace {

double Rounded(double value) { return std::strtod(fmt::format("{:.6g}", value).c_str(), nullptr); }

Json RoundedColorJson(const Rgb& rgb) {
  const Json color = {Rounded(rgb.x), Rounded(rgb.y), Rounded(rgb.z)};
  return color[0] == color[1] && color[1] == color[2] ? color[0] : color;
}

bool DoesNothing(const MaterialParameter& parameter, const Rgb& value) {
  return (parameter.name == "emission" && value == Rgb(0)) ||
         (parameter.name == "dielectric_f0" && value == Rgb(kDielectricF0)) ||
         (parameter.name == "specular" && value == Rgb(1)) ||
         (parameter.name == "opacity" && value == Rgb(1)) ||
         (parameter.name == "opacity_cutoff" && value == Rgb(Material().opacity_cutoff)) ||
         (parameter.name == "f82_tint" && value == Rgb(1));
}

}  // namespace

Json MaterialJson(const Material& material) {
  const MaterialModel& model = *ModelOf(material);
  Json json = {{"model", model.name}};
  for (const MaterialParameter& parameter : model.parameters) {
    const Rgb value = parameter.get(material);
    if (!DoesNothing(parameter, value)) json[std::string(parameter.name)] = RoundedColorJson(value);
  }
  const Material defaults = model.make();
  for (const MaterialChoice& choice : model.choices) {
    if (choice.get == nullptr || choice.get(material) == choice.get(defaults)) continue;
    json[std::string(choice.name)] = choice.options[choice.get(material)];
  }
  return json;
}

std::string DescribeMaterial(const Json& material) {
  std::string text;
  for (const auto& [key, value] : material.items()) {
    if (key == "model") continue;
    text += text.empty() ? "" : ", ";
    text += key + " ";
    if (value.is_array()) {
      for (size_t i = 0; i < value.size(); ++i) {
        text += fmt::format("{}{:.4g}", i > 0 ? " " : "", value[i].get<double>());
      }
    } else {
      text += value.is_number()   ? fmt::format("{:.4g}", value.get<double>())
              : value.is_string() ? value.get<std::string>()
                                  : JsonText(value);
    }
  }
  const std::string model = material.value("model", "material");
  return text.empty() ? model : model + ": " + text;
}

}  // namespace nacre
