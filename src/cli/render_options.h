// SPDX-License-Identifier: Apache-2.0
// cli/render_options.h: the options that all rendering commands share.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <CLI/App.hpp>
#include <CLI/Validators.hpp>

#include "color/display.h"
#include "image_io/exr_compression.h"
#include "render/settings.h"
#include "scene_io/load_scene.h"

namespace nacre {

// An option that only affects files of a kind that the command does not write.
struct IdleOption {
  std::string name, extension;
};

struct RenderOptions {
  std::vector<std::string> outputs;
  std::string size;  // "WxH"; empty: the scene's
  std::optional<int> spp;
  std::optional<uint32_t> seed;
  // The settings of SettingKeys() that options have set, but for those that are written as text:
  // these are parsed by MakeRenderSettings, after all options are known.
  RenderSettings settings;
  std::map<std::string_view, std::string> setting_texts;  // by name; empty: not given
  std::string target = "auto";
  std::string depth = "half";
  std::string compression = "zip";
  bool small = false;
  DisplaySettings display;
  bool labels = false;
  std::vector<std::string> sets;  // "/json/pointer=value"
  bool allow_paths = false;
  std::optional<uint64_t> max_primitives;
  bool dry_run = false;
  bool explain = false;
  std::string stats;  // path; empty: none
  bool reproducible = false;
  bool quiet = false;
  std::string progress = "auto";
  std::vector<IdleOption> idle_options;
};

// Adds all of these options to `command`.
void AddRenderOptions(CLI::App* command, RenderOptions* options);

// Adds the option for the SIMD target.
CLI::Option* AddTargetOption(CLI::App* command, std::string* target);

// Adds --tonemap and --exposure, described for PNG files if not otherwise.
void AddDisplayOptions(
    CLI::App* command, DisplaySettings* display,
    const std::string& tonemap =
        "Tone operator of PNG files: neutral, reinhard, reinhard_extended, aces, agx or none; "
        "neutral is Khronos PBR Neutral, none clips at 1",
    const std::string& exposure = "Exposure of PNG files in stops: values times 2^EV");

// Adds the option for a setting.
CLI::Option* AddSettingOption(CLI::App* command, const SettingKey& key, RenderOptions* options);

// Adds the options for the settings of refined pictures that the live view takes.
void AddViewSettingOptions(CLI::App* command, RenderOptions* options);

// Add the options for the scene's picture, and for how the machine renders it.
void AddPictureOptions(CLI::App* command, RenderOptions* options);
void AddMachineOptions(CLI::App* command, RenderOptions* options);

// Adds the option that raises the limit on what a file expands to.
CLI::Option* AddMaxPrimitivesOption(CLI::App* command, std::optional<uint64_t>* max_primitives);

// The options for scene_io. --size, --spp and --seed become overrides of the scene's image, like
// those of --set. Throws Error (kUsage).
LoadOptions MakeLoadOptions(const RenderOptions& options);

// A check for numbers in [low, high]; unlike CLI11's own, it refuses NaN.
std::function<std::string(const std::string&)> InRange(double low, double high);
// A check for whole numbers in [low, high]; CLI11's own says that 1.5 is not in the range from 1 to
// 2.
CLI::Validator WholeInRange(uint64_t low, uint64_t high);

// Parses "WxH". Throws Error (kUsage).
void ParseSize(const std::string& text, int* width, int* height);

// The options for the renderer. Throws Error (kUsage).
RenderSettings MakeRenderSettings(const RenderOptions& options);

// Sets the SIMD target. Throws Error (kUsage) for one that this machine lacks.
void ApplyTarget(const std::string& name);

// ApplyTarget for showing the pictures of a file that was rendered on the target `of_file`: "auto"
// means that target, if this machine has it, so that pictures have the same bits as in a render.
void ApplyTargetOf(const std::string& name, const std::string& of_file);

}  // namespace nacre
