// SPDX-License-Identifier: Apache-2.0
// cli/render_options.h: the options that every command that renders shares.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <CLI/App.hpp>
#include <CLI/Validators.hpp>

#include "color/display.h"
#include "image_io/exr_compression.h"
#include "render/settings.h"
#include "scene_io/load_scene.h"

namespace nacre {

// An option that was given for files of a kind that is not written.
struct IdleOption {
  std::string name, extension;
};

struct RenderOptions {
  std::vector<std::string> outputs;
  std::string size;  // "WxH"; empty: the scene's
  std::optional<int> spp;
  double max_error = 0;  // 0: not adaptive
  std::optional<uint32_t> seed;
  int threads = 0;
  std::string target = "auto";
  std::string region;  // "x0,y0,x1,y1"; empty: all
  std::string tile;    // "i/N"; empty: all
  std::vector<std::string> layers;
  std::string depth = "half";
  std::string compression = "zip";
  bool small = false;
  std::string tonemap = "neutral";
  double exposure = 0;
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
  std::string intersector = "auto";
  int tile_size = 0;  // 0: chosen by the plan
  std::vector<IdleOption> idle_options;
};

// Adds all of them to `command`.
void AddRenderOptions(CLI::App* command, RenderOptions* options);

// The option that names the SIMD target of kernels.
CLI::Option* AddTargetOption(CLI::App* command, std::string* target);

// The options that say how a PNG looks, for `tonemap` as well.
void AddDisplayOptions(CLI::App* command, std::string* tonemap, double* exposure);

// Those of the scene's picture, and of how the machine renders it.
void AddPictureOptions(CLI::App* command, RenderOptions* options);
void AddMachineOptions(CLI::App* command, RenderOptions* options);

// The option that lifts the bound of what a file may be made into.
CLI::Option* AddMaxPrimitivesOption(CLI::App* command, std::optional<uint64_t>* max_primitives);

// What the options ask of scene_io; --size, --spp and --seed are settings of the scene's image
// like any that --set makes. Throws Error (usage).
LoadOptions MakeLoadOptions(const RenderOptions& options);

// "x0,y0,x1,y1" as a window; empty text gives an empty one. Throws Error (usage).
Window ParseRegion(const std::string& text);

// "i/N" with 0 <= i < N as a band; empty text gives none. Throws Error (usage).
FrameBand ParseTile(const std::string& text);

// A check for numbers in [low, high]; CLI11's own lets NaN pass.
std::function<std::string(const std::string&)> InRange(double low, double high);
// The same for whole numbers; CLI11's own says of 1.5 that it is not in the range from 1 to 2.
CLI::Validator WholeInRange(uint64_t low, uint64_t high);

// "WxH". Throws Error (usage).
void ParseSize(const std::string& text, int* width, int* height);

// What the options ask of the renderer. Throws Error (usage).
RenderSettings MakeRenderSettings(const RenderOptions& options);

// Pins the SIMD target. Throws Error (usage) for one that this machine lacks.
void ApplyTarget(const std::string& name);

// The same for the pictures of a file that nacre rendered on the target `of_file`: "auto" is that
// one, if this machine has it, so that they are shown with the bits of a render.
void ApplyTargetOf(const std::string& name, const std::string& of_file);

}  // namespace nacre
