// SPDX-License-Identifier: Apache-2.0
// scene_io/sheet_axis_check.cc: finds out what an axis of a sheet varies, and checks its values.
#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/error.h"
#include "scene/material_parameters.h"
#include "scene_io/sheet_axis.h"

namespace nacre {
namespace {

[[noreturn]] void RefuseMaterial(const std::string& option, std::string what, std::string hint) {
  throw Error(ExitCode::kBadInput, option, std::move(what), std::move(hint));
}

std::string NearestOrAll(const std::string& word, const std::vector<std::string>& names) {
  const std::string nearest = NearestName(word, names);
  return nearest.empty() ? fmt::format("one of: {}", fmt::join(names, ", "))
                         : fmt::format("did you mean \"{}\"?", nearest);
}

const MaterialModel& ModelOfJson(const std::string& option, const Json& material) {
  const auto found = material.find("model");
  const std::string name =
      found != material.end() && found->is_string() ? found->get<std::string>() : "";
  if (const MaterialModel* model = FindModel(name)) return *model;
  std::vector<std::string> names;
  for (const MaterialModel& model : MaterialModels()) names.emplace_back(model.name);
  RefuseMaterial(option, fmt::format("\"{}\" is no model", name), NearestOrAll(name, names));
}

void CheckParameter(const std::string& option, const MaterialParameter& parameter,
                    const SheetAxis& axis) {
  for (const Json& value : axis.values) {
    const bool fits = value.is_number() || (value.is_array() && parameter.is_color);
    if (!fits) {
      RefuseMaterial(
          option, fmt::format("{} is no value of {}", JsonText(value), axis.name),
          parameter.is_color ? "a colour is #rrggbb, [r,g,b] or one number" : "give numbers");
    }
    const auto check = [&](const Json& number) {
      if (parameter.range.Contains(number.get<double>())) return;
      RefuseMaterial(option, fmt::format("{} is out of range for {}", JsonText(number), axis.name),
                     Describe(parameter.range));
    };
    if (value.is_number()) check(value);
    if (value.is_array()) {
      for (const Json& component : value) check(component);
    }
  }
}

void CheckChoice(const std::string& option, const MaterialChoice& choice, const SheetAxis& axis) {
  const std::vector<std::string> names(choice.options.begin(), choice.options.end());
  for (const Json& value : axis.values) {
    const std::string word = value.is_string() ? value.get<std::string>() : JsonText(value);
    if (std::find(names.begin(), names.end(), word) == names.end()) {
      RefuseMaterial(option, fmt::format("\"{}\" is no {}", word, axis.name),
                     NearestOrAll(word, names));
    }
  }
}

SheetAxis::Kind CheckAgainst(const std::string& option, const MaterialModel& model,
                             const SheetAxis& axis) {
  if (const MaterialParameter* parameter = FindParameter(model, axis.name)) {
    CheckParameter(option, *parameter, axis);
    return SheetAxis::Kind::kParameter;
  }
  std::vector<std::string> names;
  for (const MaterialParameter& parameter : model.parameters) names.emplace_back(parameter.name);
  for (const MaterialChoice& choice : model.choices) {
    if (choice.name == axis.name) {
      CheckChoice(option, choice, axis);
      return SheetAxis::Kind::kChoice;
    }
    names.emplace_back(choice.name);
  }
  names.emplace_back("material");
  RefuseMaterial(option, fmt::format("{} has no parameter \"{}\"", model.name, axis.name),
                 NearestOrAll(axis.name, names));
}

}  // namespace

void CheckModels(const std::string& option, const std::vector<Json>& materials) {
  for (const Json& material : materials) ModelOfJson(option, material);
}

void CheckSheetAxis(const std::string& option, const std::vector<Json>& materials,
                    SheetAxis* axis) {
  if (axis->kind == SheetAxis::Kind::kMaterial) {
    CheckModels(option, axis->values);
    return;
  }
  for (const Json& material : materials) {
    axis->kind = CheckAgainst(option, ModelOfJson(option, material), *axis);
  }
}

}  // namespace nacre
