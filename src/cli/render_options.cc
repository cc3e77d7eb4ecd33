// SPDX-License-Identifier: Apache-2.0
#include "cli/render_options.h"

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <variant>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/error.h"
#include "base/numbers.h"
#include "base/overloaded.h"
#include "base/path.h"
#include "base/strip.h"
#include "base/target.h"
#include "cli/help_text.h"
#include "color/tone.h"
#include "scene/limits.h"
#include "scene_io/overrides.h"

namespace nacre {

CLI::Option* AddMaxPrimitivesOption(CLI::App* command, std::optional<uint64_t>* max_primitives) {
  return command
      ->add_option("--max-primitives", *max_primitives,
                   "Most spheres and triangles that a file may be made into; if not given 20 "
                   "million, of a small model fewer")
      ->check(WholeInRange(1, limits::kMaxPrimitivesMade));
}

std::function<std::string(const std::string&)> InRange(double low, double high) {
  return [=](const std::string& text) -> std::string {
    char* end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    if (end != text.c_str() && *end == '\0' && value >= low && value <= high) return {};
    return fmt::format("{} is not a number from {} to {}", text, low, high);
  };
}

CLI::Validator WholeInRange(uint64_t low, uint64_t high) {
  const auto check = [=](const std::string& text) -> std::string {
    uint64_t value = 0;
    const char* const last = text.data() + text.size();
    const auto [end, error] = std::from_chars(text.data(), last, value);
    if (error == std::errc() && end == last && value >= low && value <= high) return {};
    return fmt::format("{} is not a whole number from {} to {}", text, low, high);
  };
  return {check, fmt::format("{} to {}", low, high)};
}

void AddDisplayOptions(CLI::App* command, DisplaySettings* display, const std::string& tonemap,
                       const std::string& exposure) {
  command
      ->add_option_function<std::string>(
          "--tonemap",
          [display](const std::string& name) { display->tone = ParseToneOperator(name); }, tonemap)
      ->check(CLI::IsMember(ToneOperatorNames()))
      ->default_str(ToneOperatorName(display->tone));
  command->add_option("--exposure", display->exposure_ev, exposure)
      ->check(InRange(-60, 60))
      ->capture_default_str();
}

CLI::Option* AddSettingOption(CLI::App* command, const SettingKey& key, RenderOptions* o) {
  const std::string name = OptionOf(key);
  const std::string meaning(key.meaning);
  RenderSettings* const s = &o->settings;
  CLI::Option* const option = std::visit(
      Overloaded{
          [&](double RenderSettings::*field) {
            return command->add_option(name, s->*field, meaning)
                ->check(InRange(key.range.min, key.range.max));
          },
          [&](int RenderSettings::*field) {
            return command->add_option(name, s->*field, meaning)
                ->check(WholeInRange(static_cast<uint64_t>(key.range.min),
                                     static_cast<uint64_t>(key.range.max)));
          },
          [&](bool RenderSettings::*field) { return command->add_flag(name, s->*field, meaning); },
          [&](std::vector<std::string> RenderSettings::*field) {
            return command->add_option(name, s->*field, meaning)
                ->delimiter(',')
                ->allow_extra_args(false);
          },
          [&](const SettingChoice& choice) {
            const std::vector<std::string> options(choice.options.begin(), choice.options.end());
            return command
                ->add_option_function<std::string>(
                    name, [&key, s](const std::string& text) { SetChoice(key, text, s); }, meaning)
                ->check(CLI::IsMember(options))
                ->default_str(options[choice.get(*s)]);
          },
          [&](const SettingText&) {
            return command->add_option(name, o->setting_texts[key.name], meaning);
          }},
      key.field);
  if (!key.form.empty()) option->type_name(std::string(key.form));
  return option;
}

namespace {

// Adds the options for the settings of a group that the command does not have already.
void AddSettingOptions(CLI::App* command, SettingGroup group, RenderOptions* o) {
  for (const SettingKey& key : SettingKeys()) {
    if (key.group != group || command->get_option_no_throw(OptionOf(key)) != nullptr) continue;
    AddSettingOption(command, key, o);
    if (!key.common) MoveBehindHelpAll(command, {OptionOf(key)});
  }
}

}  // namespace

void AddViewSettingOptions(CLI::App* command, RenderOptions* o) {
  for (const SettingKey& key : SettingKeys()) {
    if (key.view_meaning.empty()) continue;
    AddSettingOption(command, key, o)->description(std::string(key.view_meaning));
    MoveBehindHelpAll(command, {OptionOf(key)});
  }
}

void AddPictureOptions(CLI::App* command, RenderOptions* o) {
  const InGroup group(command, "Picture");
  command->add_option("--size", o->size, "Width and height in pixels")->type_name("WxH");
  command->add_option("--spp", o->spp, "Samples per pixel; 1 goes through the pixel's centre")
      ->check(WholeInRange(1, 65536));
  AddSettingOptions(command, SettingGroup::kPicture, o);
  command->add_option("--seed", o->seed, "Seed of the sample pattern");
  command
      ->add_option("--set", o->sets,
                   "Change a value of the scene, e.g. /materials/red/roughness=0.2; repeatable. "
                   "The value is put into the scene before it is read")
      ->type_name("/POINTER=JSON")
      ->allow_extra_args(false);
  MoveBehindHelpAll(command, {"--seed"});
}

namespace {

void AddExrOptions(CLI::App* command, RenderOptions* o) {
  const InGroup group(command, "EXR files");
  AddSettingOptions(command, SettingGroup::kExrFiles, o);
  command->add_option("--depth", o->depth, "Precision of colour samples: half or float")
      ->check(CLI::IsMember({"half", "float"}))
      ->capture_default_str();
  command->add_option("--compression", o->compression, "Compression: none, zip, zips, piz or dwaa")
      ->check(CLI::IsMember(CompressionNames()))
      ->capture_default_str();
  command->add_flag("--small", o->small,
                    "Smaller files (EXR and PNG), several times slower to write");
  command->add_flag("--reproducible", o->reproducible,
                    "Leave times out of the files and compress them with zlib (slower), so that "
                    "equal pictures make equal files");
  MoveBehindHelpAll(command, {"--depth", "--compression", "--small", "--reproducible"});
}

}  // namespace

CLI::Option* AddTargetOption(CLI::App* command, std::string* target) {
  return command
      ->add_option("--target", *target,
                   "SIMD target: auto, avx3, avx2, sse4 or scalar; neon on arm64")
      ->check(CLI::IsMember({"auto", "avx3", "avx2", "sse4", "scalar", "neon"}))
      ->capture_default_str();
}

void AddMachineOptions(CLI::App* command, RenderOptions* o) {
  const InGroup group(command, "Machine");
  AddSettingOption(command, SettingNamed("threads"), o);
  AddTargetOption(command, &o->target);
  AddSettingOptions(command, SettingGroup::kMachine, o);
  command->add_flag("--allow-paths", o->allow_paths,
                    "Let the scene refer to files outside its own folder");
  AddMaxPrimitivesOption(command, &o->max_primitives);
  MoveBehindHelpAll(command, {"--threads", "--target", "--allow-paths", "--max-primitives"});
}

namespace {

void AddTellingOptions(CLI::App* command, RenderOptions* o) {
  const InGroup group(command, "Messages");
  command->add_flag("--dry-run", o->dry_run,
                    "Check everything and print, as JSON, the EXR file's header and the most tiles "
                    "that the picture can be cut into; render nothing");
  command->add_flag(
      "--explain", o->explain,
      "Print the plan: what is used, what is skipped and why, and where the time went");
  command->add_option("--stats", o->stats, "Write times and counts as JSON")->type_name("FILE");
  command
      ->add_option("--progress", o->progress,
                   "Progress display: auto (a bar on a terminal), bar, json or none")
      ->check(CLI::IsMember({"auto", "bar", "json", "none"}))
      ->capture_default_str();
  command->add_flag("--quiet", o->quiet, "Print nothing but errors");
  MoveBehindHelpAll(command, {"--dry-run", "--stats", "--progress"});
}

void FindIdleOptions(const CLI::App& command, RenderOptions* o) {
  const auto find = [&](const std::vector<std::string>& names, const char* extension) {
    const auto is_one = [&](const std::string& path) { return HasExtension(path, extension); };
    if (std::ranges::any_of(o->outputs, is_one)) return;
    for (const std::string& name : names) {
      if (command.get_option(name)->count() > 0) o->idle_options.push_back({name, extension});
    }
  };
  std::vector<std::string> of_exr;
  for (const SettingKey& key : SettingKeys()) {
    if (key.group == SettingGroup::kExrFiles) of_exr.push_back(OptionOf(key));
  }
  of_exr.insert(of_exr.end(), {"--depth", "--compression"});
  find(of_exr, ".exr");
  find({"--tonemap", "--exposure", "--labels"}, ".png");
}

}  // namespace

void AddRenderOptions(CLI::App* command, RenderOptions* o) {
  command
      ->add_option(
          "-o,--output", o->outputs,
          "File to write, repeatable: .exr (linear, HDR) or .png (tone-mapped sRGB); null: "
          "writes none, for timing")
      ->required()
      ->type_name("FILE")
      ->allow_extra_args(false);
  AddDisplayOptions(command, &o->display);
  command->add_flag("--labels,!--no-labels", o->labels,
                    "Write titles and labels of rows and columns into PNG files, or do not");
  AddPictureOptions(command, o);
  AddExrOptions(command, o);
  AddMachineOptions(command, o);
  AddTellingOptions(command, o);
  command->parse_complete_callback([command, o] { FindIdleOptions(*command, o); });
}

LoadOptions MakeLoadOptions(const RenderOptions& options) {
  LoadOptions load;
  load.allow_paths = options.allow_paths;
  load.max_primitives = options.max_primitives;
  load.threads = options.settings.threads;
  for (const std::string& set : options.sets) {
    const size_t equals = set.find('=');
    if (equals == std::string::npos || set.empty() || set.front() != '/') {
      throw Error(ExitCode::kUsage, "--set", "\"" + set + "\" is not /json/pointer=value",
                  "for example --set /image/spp=64");
    }
    const std::string pointer = set.substr(0, equals);
    load.overrides.emplace_back(pointer, JsonOfTyped(pointer, set.substr(equals + 1)));
  }
  const auto put = [&](const char* pointer, auto value) {
    load.overrides.emplace_back(pointer, std::to_string(value));
  };
  if (!options.size.empty()) {
    int width = 0;
    int height = 0;
    ParseSize(options.size, &width, &height);
    put("/image/width", width);
    put("/image/height", height);
  }
  if (options.spp) put("/image/spp", *options.spp);
  if (options.seed) put("/image/seed", *options.seed);
  return load;
}

void ParseSize(const std::string& text, int* width, int* height) {
  constexpr int kMaxSide = 65536;  // pixels, as for ImageSettings
  const auto sides = ParseIntegers(text, 'x', 2);
  const auto is_side = [](int side) { return side >= 1 && side <= kMaxSide; };
  if (!sides || !std::ranges::all_of(*sides, is_side)) {
    throw Error(
        ExitCode::kUsage, "--size", "\"" + text + "\" is not a size",
        fmt::format("give WIDTHxHEIGHT with sides from 1 to {}, for example 1920x1080", kMaxSide));
  }
  *width = sides->at(0);
  *height = sides->at(1);
}

RenderSettings MakeRenderSettings(const RenderOptions& options) {
  RenderSettings settings = options.settings;
  for (const SettingKey& key : SettingKeys()) {
    const auto text = options.setting_texts.find(key.name);
    if (text == options.setting_texts.end() || text->second.empty()) continue;
    std::get<SettingText>(key.field).parse(text->second, &settings);
  }
  if (settings.band.count > 0 && settings.region != Window{}) {
    throw Error(ExitCode::kUsage, "--tile", "cannot be used with --region",
                "a tile spans the frame's width; leave one of them out");
  }
  // The chunks of a tile must be those of the whole picture's file.
  settings.band_rows = std::max(kStripRows, RowsPerChunk(ParseCompression(options.compression)));
  settings.time_stages = options.explain || !options.stats.empty();
  if (options.spp) settings.max_samples = *options.spp;
  CheckSettings(settings);
  return settings;
}

void ApplyTarget(const std::string& name) {
  if (name == "auto") return;
  std::vector<std::string> supported;
  for (const Target target : SupportedTargets()) {
    if (TargetName(target) == name) return PinTarget(target);
    supported.push_back(TargetName(target));
  }
  throw Error(ExitCode::kUsage, "--target", "this machine cannot run " + name,
              fmt::format("it can run {}", fmt::join(supported, ", ")));
}

void ApplyTargetOf(const std::string& name, const std::string& of_file) {
  if (name != "auto") return ApplyTarget(name);
  for (const Target target : SupportedTargets()) {
    if (TargetName(target) == of_file) PinTarget(target);
  }
}

}  // namespace nacre
