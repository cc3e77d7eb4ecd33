// SPDX-License-Identifier: Apache-2.0
#include "scene_io/sheet_axis.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/error.h"
#include "color/transfer.h"
#include "scene/generators.h"
#include "scene/material_parameters.h"
#include "scene_io/materialx.h"

namespace nacre {
namespace {

constexpr char kExample[] =
    "for example roughness=0.1:0.9:5, shininess=1:1024:6:log, base_color=#ff0000,#0000ff or "
    "material=phong,lambert";

[[noreturn]] void RefuseAxis(const std::string& option, std::string what,
                             std::string hint = kExample) {
  throw Error(ExitCode::kUsage, option, std::move(what), std::move(hint));
}

// Splits `text` at separators that are in no brackets and no string.
std::vector<std::string> Split(const std::string& text, char separator) {
  std::vector<std::string> parts(1);
  int depth = 0;
  bool quoted = false;
  for (size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '"' && (i == 0 || text[i - 1] != '\\')) quoted = !quoted;
    if (!quoted && (c == '[' || c == '{')) ++depth;
    if (!quoted && (c == ']' || c == '}')) --depth;
    if (c == separator && depth == 0 && !quoted) {
      parts.emplace_back();
    } else {
      parts.back() += c;
    }
  }
  return parts;
}

// Parses "#ff8000" or "#f80", sRGB codes; null if it is neither.
Json HexColor(const std::string& text) {
  const size_t digits = text.size() == 4 ? 1 : 2;
  if (text.empty() || text.front() != '#' || text.size() != 1 + 3 * digits) return nullptr;
  Json color = Json::array();
  for (size_t c = 0; c < 3; ++c) {
    int code = 0;
    const char* const begin = text.data() + 1 + c * digits;
    const auto [rest, error] = std::from_chars(begin, begin + digits, code, 16);
    if (error != std::errc() || rest != begin + digits || *begin == '-') return nullptr;
    color.push_back(SrgbEotf((digits == 1 ? 17 * code : code) / 255.0));
  }
  return color;
}

bool IsColorArray(const Json& value) {
  if (!value.is_array() || value.size() != 3) return false;
  return value[0].is_number() && value[1].is_number() && value[2].is_number();
}

// Parses a number, a colour, an object or, as a string, a name. Null if it is none of these.
Json ParseAxisValue(const std::string& text) {
  if (text.starts_with('#')) return HexColor(text);
  const Json value = TryParseJson(text).value_or(Json());
  if (value.is_number() || value.is_object() || IsColorArray(value)) return value;
  const bool is_name = !text.empty() && std::ranges::all_of(text, [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '_';
  });
  return is_name ? Json(text) : Json();
}

std::optional<Rgb> ToRgb(const Json& value) {
  if (value.is_number()) return Rgb(value.get<double>());
  if (!IsColorArray(value)) return std::nullopt;
  return Rgb(value[0].get<double>(), value[1].get<double>(), value[2].get<double>());
}

Json FromRgb(const Rgb& rgb, bool is_number) {
  return is_number ? Json(rgb.x) : Json{rgb.x, rgb.y, rgb.z};
}

// Shows components to two decimals.
std::string ColorLabel(const Json& color) {
  std::string text;
  for (const Json& component : color) {
    const double rounded = std::round(100 * component.get<double>()) / 100;
    text += fmt::format("{}{:.4g}", text.empty() ? "" : " ", rounded);
  }
  return text;
}

// The label of a value that was typed: the text as typed, or a number's digits.
std::string ItemLabel(const Json& value, const std::string& text) {
  if (value.is_number()) return fmt::format("{:.6g}", value.get<double>());
  return value.is_array() && !text.starts_with('#') ? ColorLabel(value) : text;
}

// The label of an interpolated value: three digits, or all digits of whole numbers up to 9999.
std::string RangeLabel(const Json& value) {
  if (!value.is_number()) return ColorLabel(value);
  const auto number = value.get<double>();
  return fmt::format("{:.{}g}", number, number < 100 ? 3 : 4);
}

// Parses FROM:TO:COUNT or FROM:TO:COUNT:log.
void ParseRange(const std::string& option, const std::vector<std::string>& parts, SheetAxis* axis) {
  const std::string scale = parts.size() == 4 ? parts[3] : "linear";
  if (parts.size() > 4 || (scale != "log" && scale != "linear")) {
    RefuseAxis(option, fmt::format("\"{}\" is not FROM:TO:COUNT or FROM:TO:COUNT:log", axis->name));
  }
  const Json from_json = ParseAxisValue(parts[0]);
  const Json to_json = ParseAxisValue(parts[1]);
  const std::optional<Rgb> from = ToRgb(from_json);
  const std::optional<Rgb> to = ToRgb(to_json);
  if (!from || !to) {
    RefuseAxis(option, fmt::format("{} is not a number or a colour", from ? parts[1] : parts[0]));
  }
  int count = 0;
  const std::string& text = parts[2];
  const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), count);
  if (error != std::errc() || rest != text.data() + text.size() || count < 1 ||
      count > kMaxSheetCount) {
    RefuseAxis(option, fmt::format("\"{}\" is not a count", text),
               fmt::format("from 1 to {} spheres along an axis", kMaxSheetCount));
  }
  const bool logarithmic = scale == "log";
  if (logarithmic && std::min({from->x, from->y, from->z, to->x, to->y, to->z}) <= 0) {
    RefuseAxis(option, "a logarithmic axis reaches 0", "both ends must be greater than 0");
  }
  const bool is_number = from_json.is_number() && to_json.is_number();
  const GridAxis values = logarithmic ? LogarithmicAxis(axis->name, *from, *to, count)
                                      : LinearAxis(axis->name, *from, *to, count);
  for (const Rgb& value : values.values) {
    axis->values.push_back(FromRgb(value, is_number));
    axis->labels.push_back(RangeLabel(axis->values.back()));
  }
}

void ParseList(const std::string& option, const std::string& text, SheetAxis* axis) {
  std::vector<std::string> items = Split(text, ',');
  // A JSON list is a list of materials, except that [r,g,b] is one colour.
  const Json list = TryParseJson(text).value_or(Json());
  const bool is_list = list.is_array() && !list.empty() && !list[0].is_number();
  if (is_list) items = Split(text.substr(1, text.rfind(']') - 1), ',');
  if (items.size() > static_cast<size_t>(kMaxSheetCount)) {
    RefuseAxis(option, fmt::format("{} values", items.size()),
               fmt::format("from 1 to {} spheres along an axis", kMaxSheetCount));
  }
  for (const std::string& item : items) {
    std::string trimmed = item.substr(std::min(item.find_first_not_of(' '), item.size()));
    trimmed.erase(trimmed.find_last_not_of(' ') + 1);
    if (is_list && trimmed.size() > 1 && trimmed.front() == '"') {
      trimmed = trimmed.substr(1, trimmed.size() - 2);
    }
    if (axis->kind == SheetAxis::Kind::kMaterial) {
      axis->values.push_back(ParseMaterialText(option, trimmed));
      axis->labels.push_back(MaterialLabel(axis->values.back()));
      axis->values.back().erase("name");
      continue;
    }
    const Json value = ParseAxisValue(trimmed);
    if (value.is_null()) RefuseAxis(option, fmt::format("\"{}\" is not a value", trimmed));
    axis->values.push_back(value);
    axis->labels.push_back(ItemLabel(value, trimmed));
  }
}

[[noreturn]] void RefuseMaterial(const std::string& option, std::string what, std::string hint) {
  throw Error(ExitCode::kBadInput, option, std::move(what), std::move(hint));
}

std::string NearestOrAll(const std::string& word, const std::vector<std::string>& names) {
  return NearestHint(word, names, fmt::format("one of: {}", fmt::join(names, ", ")));
}

const MaterialModel& ModelOfJson(const std::string& option, const Json& material) {
  const auto found = material.find("model");
  const std::string name =
      found != material.end() && found->is_string() ? found->get<std::string>() : "";
  if (const MaterialModel* model = FindModel(name)) return *model;
  RefuseMaterial(option, fmt::format("\"{}\" is no model", name),
                 NearestOrAll(name, NamesOf(MaterialModels())));
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
    for (const Json& number : value.is_array() ? value : Json::array({value})) {
      if (parameter.range.Contains(number.get<double>())) continue;
      RefuseMaterial(option, fmt::format("{} is out of range for {}", JsonText(number), axis.name),
                     Describe(parameter.range));
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
  std::vector<std::string> names = NamesOf(model.parameters);
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

SheetAxis ParseSheetAxis(const std::string& option, const std::string& text) {
  SheetAxis axis;
  const size_t equals = text.find('=');
  axis.name = text.substr(0, equals);
  if (equals == std::string::npos || axis.name.empty() || equals + 1 == text.size()) {
    RefuseAxis(option,
               fmt::format("\"{}\" is not PARAMETER=FROM:TO:COUNT or PARAMETER=A,B,C", text));
  }
  if (axis.name == "material") axis.kind = SheetAxis::Kind::kMaterial;
  const std::string values = text.substr(equals + 1);
  const std::vector<std::string> parts = Split(values, ':');
  if (parts.size() >= 3 && axis.kind != SheetAxis::Kind::kMaterial) {
    ParseRange(option, parts, &axis);
  } else {
    ParseList(option, values, &axis);
  }
  return axis;
}

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

Json ParseMaterialText(const std::string& option, const std::string& text) {
  if (IsMaterialXReference(text)) return MaterialXReference(text);
  if (text.find_first_of("{[\" ") == std::string::npos && !text.empty()) return {{"model", text}};
  Json material = TryParseJson(text).value_or(Json());
  if (!material.is_object()) {
    RefuseAxis(option, "\"" + text + "\" is not a material",
               "give a model's name or JSON, e.g. '{\"model\": \"phong\", \"shininess\": 64}'");
  }
  return material;
}

Json ParseColorText(const std::string& option, const std::string& text) {
  Json value = ParseAxisValue(text);
  if (ToRgb(value)) return value;
  RefuseAxis(option, "\"" + text + "\" is not a colour",
             "for example #202020, 0.18 or [0.1,0.2,0.3]");
}

std::string MaterialLabel(const Json& material) {
  for (const char* key : {"name", "preset", "model"}) {
    const auto found = material.find(key);
    if (found != material.end() && found->is_string()) return found->get<std::string>();
  }
  return "material";
}

}  // namespace nacre
