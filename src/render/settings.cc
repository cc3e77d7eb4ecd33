// SPDX-License-Identifier: Apache-2.0
#include "render/settings.h"

#include <algorithm>
#include <array>
#include <type_traits>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/error.h"
#include "base/numbers.h"
#include "base/overloaded.h"
#include "visibility/box_trees.h"

namespace nacre {
namespace {

void ParseRegion(const std::string& text, RenderSettings* settings) {
  const auto edges = ParseIntegers(text, ',', 4);
  if (!edges || edges->at(0) >= edges->at(2) || edges->at(1) >= edges->at(3)) {
    throw Error(ExitCode::kUsage, "--region", "\"" + text + "\" is not a region",
                "give x0,y0,x1,y1 in pixels from the top left with x0 < x1 and y0 < y1");
  }
  settings->region = {edges->at(0), edges->at(1), edges->at(2), edges->at(3)};
}

void ParseTile(const std::string& text, RenderSettings* settings) {
  const auto numbers = ParseIntegers(text, '/', 2);
  if (!numbers || numbers->at(0) < 0 || numbers->at(0) >= numbers->at(1)) {
    throw Error(ExitCode::kUsage, "--tile", "\"" + text + "\" is not a tile",
                "give i/N with i from 0 to N-1: --tile 0/4 is the top quarter of the rows");
  }
  settings->band = {numbers->at(0), numbers->at(1)};
}

// `options` are in the order of the enumeration.
template <auto kMember>
constexpr SettingChoice Choice(std::span<const std::string_view> options) {
  return {options,
          [](const RenderSettings& settings) { return static_cast<size_t>(settings.*kMember); },
          [](RenderSettings& settings, size_t option) {
            auto& field = settings.*kMember;
            field = static_cast<std::remove_reference_t<decltype(field)>>(option);
          }};
}

constexpr std::array<std::string_view, 4> kIntersectors = {"auto", "embree", "tiles", "shells"};

void CheckIntersector(const RenderSettings& settings) {
  if (settings.intersector != IntersectorChoice::kEmbree || EmbreeVersion() != nullptr) return;
  throw Error(ExitCode::kUsage, "intersector", "this build has no Embree",
              "shells finds the same hits");
}

constexpr SettingKey kSettings[] = {
    {
        .name = "max_error",
        .field = &RenderSettings::max_error,
        .range = {1e-6, 1},
        .meaning =
            "Sample until each pixel's relative error is below this, e.g. 0.01; with 95 % "
            "confidence. Pixels darker than 0.05 count as 0.05, highlights brighter than white as "
            "white. --spp is then the most samples of a pixel (4096 if not given; rounded up to a "
            "power of two). Pixels that have not converged by then are reported",
        .form = "E",
        .group = SettingGroup::kPicture,
        .common = true,
        .view_meaning =
            "Once nothing moves, sample until each pixel's relative error is below this",
        .library = LibraryUse::kMember,
        .changes_picture = true,
    },
    {
        .name = "region",
        .field = SettingText{&ParseRegion},
        .meaning =
            "Render only these pixels, counted from the top left, x1 and y1 excluded; the same "
            "bits as in the full frame",
        .form = "x0,y0,x1,y1",
        .group = SettingGroup::kPicture,
        .library = LibraryUse::kMember,
    },
    {
        .name = "tile",
        .field = SettingText{&ParseTile},
        .meaning =
            "Render band i = 0 .. N-1 of N, counted from the top; the same bits as in the full "
            "frame. nacre merge puts the bands' EXR files together",
        .form = "i/N",
        .group = SettingGroup::kPicture,
        .library = LibraryUse::kNone,
    },
    {
        .name = "layers",
        .field = &RenderSettings::layers,
        .meaning =
            "Layers besides R G B A: diffuse, specular, ambient, emission, albedo, N, T, P, Z, "
            "id.object, id.material, light.NAME, or all",
        .group = SettingGroup::kExrFiles,
        .common = true,
        .library = LibraryUse::kMember,
    },
    {
        .name = "threads",
        .field = &RenderSettings::threads,
        .range = {0, 1024},
        .meaning = "Number of threads; 0: as many as the machine has",
        .library = LibraryUse::kMember,
    },
    {
        .name = "intersector",
        .field = Choice<&RenderSettings::intersector>(kIntersectors),
        .meaning = "How rays find spheres: auto, embree, tiles or shells; changes no bits",
        .library = LibraryUse::kMember,
        .check = &CheckIntersector,
    },
    {
        .name = "tile_size",
        .field = &RenderSettings::tile_size,
        .range = {0, 64},
        .meaning = "Width of tiles in pixels, 0: chosen by the plan; changes no bits",
        .library = LibraryUse::kNone,
    },
};

}  // namespace

std::span<const SettingKey> SettingKeys() { return kSettings; }

const SettingKey& SettingNamed(std::string_view name) {
  return *std::ranges::find(kSettings, name, &SettingKey::name);
}

std::string OptionOf(const SettingKey& key) {
  std::string option = "--" + std::string(key.name);
  std::ranges::replace(option, '_', '-');
  return option;
}

void SetChoice(const SettingKey& key, const std::string& option, RenderSettings* settings) {
  const auto& choice = std::get<SettingChoice>(key.field);
  const auto found = std::ranges::find(choice.options, option);
  if (found == choice.options.end()) {
    throw Error(ExitCode::kUsage, std::string(key.name),
                fmt::format("unknown {} \"{}\"", key.name, option),
                fmt::format("one of: {}", fmt::join(choice.options, ", ")));
  }
  choice.set(*settings, static_cast<size_t>(found - choice.options.begin()));
}

void CheckSettings(const RenderSettings& settings) {
  const RenderSettings defaults;
  for (const SettingKey& key : kSettings) {
    const auto check_number = [&](auto field) {
      const double value = settings.*field;
      const double preset = defaults.*field;
      if (value == preset || key.range.Contains(value)) return;
      throw Error(ExitCode::kUsage, fmt::format("RenderSettings::{}", key.name), "is out of range",
                  "it is " + (key.range.Contains(preset) ? "" : fmt::format("{} or ", preset)) +
                      Describe(key.range));
    };
    std::visit(
        Overloaded{[&](double RenderSettings::*field) { check_number(field); },
                   [&](int RenderSettings::*field) { check_number(field); }, [](const auto&) {}},
        key.field);
    if (key.check != nullptr) key.check(settings);
  }
}

std::vector<std::pair<std::string_view, SettingValue>> ChangedSettings(
    const RenderSettings& settings) {
  // Lists and texts have no value here: no picture depends on one.
  const auto value_in = [](const RenderSettings& of, const SettingKey& key) {
    return std::visit(
        Overloaded{[&](double RenderSettings::*field) -> SettingValue {
                     return static_cast<float>(of.*field);
                   },
                   [&](int RenderSettings::*field) -> SettingValue { return of.*field; },
                   [&](bool RenderSettings::*field) -> SettingValue { return int{of.*field}; },
                   [&](const SettingChoice& choice) -> SettingValue {
                     return std::string(choice.options[choice.get(of)]);
                   },
                   [](const auto&) -> SettingValue { return {}; }},
        key.field);
  };
  std::vector<std::pair<std::string_view, SettingValue>> changed;
  for (const SettingKey& key : kSettings) {
    if (!key.changes_picture) continue;
    SettingValue value = value_in(settings, key);
    if (value != value_in({}, key)) changed.emplace_back(key.name, std::move(value));
  }
  return changed;
}

const char* TreeAskedFor(IntersectorChoice choice) {
  return choice == IntersectorChoice::kEmbree   ? "--intersector embree"
         : choice == IntersectorChoice::kShells ? "--intersector shells"
                                                : nullptr;
}

}  // namespace nacre
