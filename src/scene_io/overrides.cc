// SPDX-License-Identifier: Apache-2.0
#include "scene_io/overrides.h"

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/error.h"
#include "base/excerpt.h"

namespace nacre {
namespace {

[[noreturn]] void RefuseOverride(const std::string& pointer, std::string what, std::string hint) {
  throw Error(ExitCode::kUsage, "--set " + pointer, std::move(what), std::move(hint));
}

// The names that a pointer is made of, unescaped.
std::vector<std::string> Split(const std::string& pointer) {
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
  RefuseOverride(pointer, fmt::format("{} is not JSON", Excerpt(text)),
                 fmt::format("a string needs quotes: '{}=\"{}\"'", pointer, Excerpt(text)));
}

Json* Step(const std::string& pointer, const std::string& token, Json* parent) {
  if (parent->is_object()) return &(*parent)[token];  // made if missing
  if (!parent->is_array())
    RefuseOverride(pointer, fmt::format("there is no \"{}\" in a value", Excerpt(token)), {});
  size_t index = 0;
  const char* const last = token.data() + token.size();
  const auto [end, error] = std::from_chars(token.data(), last, index);
  if (error != std::errc() || end != last || index >= parent->size()) {
    RefuseOverride(pointer, fmt::format("there is no element \"{}\"", Excerpt(token)),
                   fmt::format("the array has {}, counted from 0", parent->size()));
  }
  return &(*parent)[index];
}

}  // namespace

void ApplyOverride(const std::string& pointer, const std::string& text, Json* root) {
  Json value = ParseValue(pointer, text);
  Json* place = root;
  for (const std::string& token : Split(pointer)) {
    if (place->is_null()) *place = Json::object();
    place = Step(pointer, token, place);
  }
  *place = std::move(value);
}

void ApplyOptions(const LoadOptions& options, Json* root) {
  if (!options.environment.empty() && root->is_object()) {
    // Its faults are the command line's. What is wrong with its contents is found by its reader.
    const std::filesystem::path image = std::filesystem::absolute(options.environment);
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
  for (const auto& [pointer, value] : options.overrides) ApplyOverride(pointer, value, root);
}

ReferenceRules RulesOf(const LoadOptions& options) {
  ReferenceRules rules{options.allow_paths, options.on_file, {}};
  const auto trust = [&](const std::filesystem::path& file) {
    if (file.empty()) return;
    std::error_code error;
    std::filesystem::path path =
        std::filesystem::weakly_canonical(std::filesystem::absolute(file), error);
    if (!error) rules.trusted.push_back(std::move(path));  // else it leads nowhere
  };
  trust(options.environment);
  for (const std::filesystem::path& file : options.trusted_files) trust(file);
  return rules;
}

}  // namespace nacre
