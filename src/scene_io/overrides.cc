// SPDX-License-Identifier: Apache-2.0
#include "scene_io/overrides.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <filesystem>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/error.h"
#include "base/excerpt.h"
#include "base/numbers.h"
#include "base/path.h"
#include "scene_io/schema.h"

namespace nacre {
namespace {

[[noreturn]] void RefuseOverride(const std::string& pointer, std::string what, std::string hint) {
  throw Error(ExitCode::kUsage, pointer, std::move(what), std::move(hint));
}

[[noreturn]] void RefuseText(const std::string& pointer, const std::string& text,
                             const std::string& wanted) {
  const std::optional<double> number = ParseNumber(text);  // almost JSON: .5, 1. or +2
  RefuseOverride(pointer, fmt::format("{} is not JSON", Excerpt(text)),
                 number ? fmt::format("write {}", JsonText(*number))
                 : wanted.empty()
                     ? fmt::format("a string needs quotes: '{}=\"{}\"'", pointer, Excerpt(text))
                     : fmt::format("{} is wanted there", wanted));
}

// The parts of a scene that have named entries, and the key that each entry requires.
struct NamedPart {
  const char* part;
  const char* entry;
  const char* required;
};
constexpr std::array<NamedPart, 3> kNamedParts = {{{"materials", "material", "model"},
                                                   {"lights", "light", "type"},
                                                   {"textures", "texture", "file"}}};

std::vector<std::string> NamesIn(const Json& root, const char* part) {
  std::vector<std::string> names;
  if (!root.is_object()) return names;
  const auto found = root.find(part);
  if (found == root.end() || !found->is_object()) return names;
  for (const auto& [name, value] : found->items()) names.push_back(name);
  return names;
}

// The part into one of whose entries the tokens point; nullptr if there is none.
const NamedPart* PartOfEntry(std::span<const std::string> tokens) {
  if (tokens.size() < 3) return nullptr;
  const auto found = std::ranges::find(kNamedParts, tokens[0], &NamedPart::part);
  return found != kNamedParts.end() ? &*found : nullptr;
}

// An entry that overrides have created, but without its required key, results from a mistyped name.
bool IsMistyped(std::span<const std::string> tokens, const NamedPart& named, const Json& root) {
  const Json* const entry = FindValue(tokens.first(2), root);
  return entry != nullptr && !entry->contains(named.required);
}

// `names` are the existing entries.
[[noreturn]] void RefuseEntry(const std::string& pointer, const std::string& name,
                              const NamedPart& named, const std::vector<std::string>& names) {
  std::vector<std::string> shown;
  for (const std::string& known : names) shown.push_back(Excerpt(known));
  RefuseOverride(pointer, fmt::format("there is no {} \"{}\"", named.entry, Excerpt(name)),
                 names.empty() ? fmt::format("the scene has no {}", named.part)
                               : fmt::format("the scene has {}", fmt::join(shown, ", ")));
}

Json* Step(const std::string& pointer, const std::string& token, Json* parent) {
  if (parent->is_object()) return &(*parent)[token];  // creates it if missing
  if (!parent->is_array())
    RefuseOverride(pointer, fmt::format("there is no \"{}\" in a value", Excerpt(token)), {});
  const std::optional<size_t> index = ElementOf(token, parent->size());
  if (!index) {
    RefuseOverride(pointer, fmt::format("there is no element \"{}\"", Excerpt(token)),
                   fmt::format("the array has {}, counted from 0", parent->size()));
  }
  return &(*parent)[*index];
}

}  // namespace

// RFC 6901 forbids leading zeros.
std::optional<size_t> ElementOf(const std::string& token, size_t size) {
  size_t index = 0;
  const char* const last = token.data() + token.size();
  const auto [end, error] = std::from_chars(token.data(), last, index);
  const bool is_number = error == std::errc() && end == last && (token == "0" || token[0] != '0');
  return is_number && index < size ? std::optional(index) : std::nullopt;
}

std::vector<std::string> TokensOf(const std::string& pointer) {
  try {
    Json::json_pointer rest(pointer);
    std::vector<std::string> tokens;
    for (; !rest.empty(); rest.pop_back()) tokens.push_back(rest.back());
    std::reverse(tokens.begin(), tokens.end());
    if (tokens.size() <= kMaxJsonDepth) return tokens;
  } catch (const Json::exception&) {
    RefuseOverride(pointer, "is not a JSON pointer",
                   "for example /image/spp or /materials/gold/roughness");
  }
  RefuseOverride(pointer.substr(0, 40) + "...",
                 fmt::format("is deeper than {} levels", kMaxJsonDepth), {});
}

Json ParseValue(const std::string& pointer, const std::string& text) {
  if (std::optional<Json> value = TryParseJson(text)) return *std::move(value);
  RefuseText(pointer, text, {});
}

std::string JsonOfTyped(const std::string& pointer, const std::string& text) {
  const std::optional<Json> value = TryParseJson(text);
  if (value && (value->is_string() || value->is_structured() || value->is_null())) return text;
  const std::vector<std::string> types = SchemaTypesAt(TokensOf(pointer));
  const auto takes = [&](const char* type) {
    return std::find(types.begin(), types.end(), type) != types.end();
  };
  const bool fits =
      value && (value->is_boolean() ? takes("boolean") : takes("number") || takes("integer"));
  const bool is_json = text.empty() || std::string_view("[{\"").find(text[0]) != std::string::npos;
  if (takes("string") && !fits && !is_json) return JsonText(Json(text));
  if (value) return text;
  std::vector<std::string> wanted;
  for (const std::string& type : types) {
    wanted.push_back(type == "integer"   ? "a whole number"
                     : type == "boolean" ? "true or false"
                     : type == "array"   ? "a list in brackets"
                     : type == "object"  ? "an object in braces"
                                         : "a " + type);
  }
  RefuseText(pointer, text, fmt::format("{}", fmt::join(wanted, " or ")));
}

const Json* FindValue(std::span<const std::string> tokens, const Json& root) {
  const Json* place = &root;
  for (const std::string& token : tokens) {
    if (place->is_object()) {
      const auto member = place->find(token);
      if (member == place->end()) return nullptr;
      place = &*member;
    } else {
      const auto element = ElementOf(token, place->is_array() ? place->size() : 0);
      if (!element) return nullptr;
      place = &(*place)[*element];
    }
  }
  return place;
}

Replaced ReplaceValue(const std::string& pointer, const std::string& text, Json* root) {
  return ReplaceValue(pointer, TokensOf(pointer), text, root);
}

Replaced ReplaceValue(const std::string& pointer, std::span<const std::string> tokens,
                      const std::string& text, Json* root) {
  Json value = ParseValue(pointer, text);
  Replaced replaced;
  bool made = false;  // true: nothing existed from here on
  Json* place = root;
  try {
    for (const std::string& token : tokens) {
      if (!made && place->is_null()) {
        replaced.value = nullptr;
        made = true;
      } else if (!made) {
        replaced.path.push_back(token);
        made = place->is_object() && !place->contains(token);
      }
      if (place->is_null()) *place = Json::object();
      place = Step(pointer, token, place);
    }
  } catch (const Error&) {
    if (made) PutBack(std::move(replaced), root);
    throw;
  }
  if (!made) replaced.value = std::move(*place);
  *place = std::move(value);
  return replaced;
}

void PutBack(Replaced replaced, Json* root) {
  Json* place = root;
  for (size_t i = 0; i < replaced.path.size(); ++i) {
    const std::string& token = replaced.path[i];
    if (i + 1 == replaced.path.size() && !replaced.value) {
      place->erase(token);
      return;
    }
    place = place->is_array() ? &place->at(std::stoul(token)) : &place->at(token);
  }
  *place = *std::move(replaced.value);
}

Replaced ReplaceInFile(const std::string& pointer, const std::string& text, Json* root,
                       std::optional<size_t> shape) {
  std::vector<std::string> tokens = TokensOf(pointer);
  if (shape) tokens[1] = std::to_string(*shape);
  const NamedPart* const named = PartOfEntry(tokens);
  const bool was_there =
      named == nullptr || FindValue(std::span(tokens).first(2), *root) != nullptr;
  Replaced replaced = ReplaceValue(pointer, tokens, text, root);
  if (was_there || !IsMistyped(tokens, *named, *root)) return replaced;
  PutBack(std::move(replaced), root);
  RefuseEntry(pointer, tokens[1], *named, NamesIn(*root, named->part));
}

void ApplyOptions(const LoadOptions& options, Json* root) {
  if (!options.environment.empty() && root->is_object()) {
    // A missing file is an error of the command line. Errors in its contents are found by its
    // reader.
    const std::filesystem::path image = AbsolutePath(options.environment);
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(image, ignored)) {
      const std::string name = Excerpt(options.environment.string());
      throw Error(ExitCode::kBadInput, "--environment",
                  std::filesystem::exists(image, ignored)
                      ? fmt::format("\"{}\" is not a regular file", name)
                      : fmt::format("there is no file \"{}\"", name));
    }
    (*root)["lights"] = {{"environment", {{"type", "environment"}, {"image", image.string()}}}};
  }
  for (const auto& [pointer, value] : options.overrides) ReplaceValue(pointer, value, root);
}

void RefuseVariant(const LoadOptions& options) {
  if (!options.variant) return;
  throw Error(ExitCode::kUsage, "--variant", "only glTF models have variants", "leave it out");
}

void ApplyOptionsToFile(const LoadOptions& options, Json* root) {
  RefuseVariant(options);
  std::array<std::vector<std::string>, kNamedParts.size()> names;
  for (size_t i = 0; i < names.size(); ++i) names[i] = NamesIn(*root, kNamedParts[i].part);
  ApplyOptions(options, root);
  for (const auto& [pointer, value] : options.overrides) {
    const std::vector<std::string> tokens = TokensOf(pointer);
    const NamedPart* const named = PartOfEntry(tokens);
    if (named == nullptr || !IsMistyped(tokens, *named, *root)) continue;
    const auto& known = names[static_cast<size_t>(named - kNamedParts.data())];
    const bool was_there = std::find(known.begin(), known.end(), tokens[1]) != known.end();
    if (!was_there) RefuseEntry(pointer, tokens[1], *named, known);
  }
}

ReferenceRules RulesOf(const LoadOptions& options) {
  ReferenceRules rules{options.allow_paths, options.on_file, {}};
  const auto trust = [&](const std::filesystem::path& file) {
    if (file.empty()) return;
    std::error_code error;
    std::filesystem::path path = std::filesystem::weakly_canonical(AbsolutePath(file), error);
    if (!error) rules.trusted.push_back(std::move(path));  // else the path leads nowhere
  };
  trust(options.environment);
  for (const std::filesystem::path& file : options.trusted_files) trust(file);
  return rules;
}

}  // namespace nacre
