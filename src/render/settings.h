// SPDX-License-Identifier: Apache-2.0
// render/settings.h: the settings of a render that are not part of its scene, and the table of
// those that people can give. The options of the command line with their help, the settings of the
// C++ and the Python library, what the live view takes and what files say of them are derived from
// it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "base/cancel.h"
#include "base/image.h"
#include "base/strip.h"
#include "scene/limits.h"

namespace nacre {

// How rays find spheres. All choices give the same bits.
enum class IntersectorChoice : uint8_t { kAuto, kEmbree, kTiles, kShells };

// The reason why all rays use a BVH with this choice, whatever the scene; else null.
const char* TreeAskedFor(IntersectorChoice choice);

// One of `count` horizontal bands that together hold every row of the frame once (--tile).
struct FrameBand {
  int index = 0;
  int count = 0;  // 0: the frame is not cut
};

struct RenderSettings {
  int threads = 0;                    // 0: as many as the machine has
  Window region{};                    // pixels to render; empty: the whole frame
  FrameBand band{};                   // if its count is above 0: the pixels to render, not `region`
  int band_rows = kStripRows;         // bands begin at multiples of this; a multiple of kStripRows
  std::vector<std::string> layers{};  // besides R G B A; names as in render/output_layers.h
  int tile_size = 0;  // width of tiles in pixels, [1, 64]; 0: the plan chooses. Changes no bit
  IntersectorChoice intersector = IntersectorChoice::kAuto;
  // Adaptive sampling (adaptive.h) if max_error is above 0: the largest error of a pixel relative
  // to max(|L|, 0.05), or for highlights relative to white (white_level.h). max_samples is
  // approximately the largest number of samples of a pixel. If max_error is 0, every pixel takes
  // the scene's samples.
  double max_error = 0;
  int max_samples = 4096;
  // Whether diffuse reflection of lights with an extent is computed in closed form where possible.
  // false: only by samples, for tests that compare the two.
  bool closed_forms = true;
  // Whether distant lights are located relative to hits on spheres from the hits' normals
  // (ShadingLight::from_spheres). false: always from the hits' positions, for tests.
  bool far_lights = true;
  // Whether the layer of a light shows only its diffuse reflection, not its specular one as well,
  // if both components are computed: for code that explains a pixel.
  bool diffuse_light_layers = false;
  // Whether to take none of the shortcuts that change no bits: shadow rays are traced even where
  // nothing can occlude them, every sample gets a position and is summed. For tests that compare
  // shortcuts with the general path.
  bool general_path = false;
  // Whether to measure how long each stage takes (RenderStats::stage_seconds). This costs some per
  // cent of the time of small frames. Output is always measured.
  bool time_stages = false;
  // Setting it to true, from any thread, ends the render: Cancelled is thrown within milliseconds
  // or, while the plan is made, at the end of the current step. May be null.
  CancelPointer cancel = nullptr;
  // Called after every strip, from any thread, one call at a time, with the share of the work that
  // is done, in (0, 1]. An exception from it ends the render.
  std::function<void(double)> on_progress{};
  // Called in the same way while the plan is made, between its large steps.
  std::function<void(double)> on_plan_progress{};
};

// ---- The settings by name -----------------------------------------------------------------------

// A setting with named options, numbered from 0.
struct SettingChoice {
  std::span<const std::string_view> options;
  size_t (*get)(const RenderSettings&);
  void (*set)(RenderSettings&, size_t option);
};

// A setting that is written as text of a form of its own, such as "x0,y0,x1,y1". Throws Error
// (usage).
struct SettingText {
  void (*parse)(const std::string& text, RenderSettings*);
};

// The field of a setting, whose type decides the form of its values.
using SettingField =
    std::variant<double RenderSettings::*, int RenderSettings::*, bool RenderSettings::*,
                 std::vector<std::string> RenderSettings::*, SettingChoice, SettingText>;

// The titles in --help under which options stand. The live view takes all of kMachine.
enum class SettingGroup : uint8_t { kPicture, kExrFiles, kMachine };

// How programs that use the library give a setting.
enum class LibraryUse : uint8_t {
  kNone,    // not at all
  kMember,  // as a member of nacre.h's own RenderSettings; and by name, but for lists
  kByName,  // by name: in C++ in RenderSettings::others, in Python as a keyword argument
};

struct SettingKey {
  std::string_view name;  // "max_error", which is the option --max-error
  SettingField field;
  Range range{};             // of numbers. The default, too, is valid, even if it is outside
  std::string_view meaning;  // for people: a sentence or two
  std::string_view form{};   // of values, in --help: "x0,y0,x1,y1"; empty: that of the field
  SettingGroup group = SettingGroup::kMachine;
  bool common = false;              // --help explains it; otherwise only --help-all does
  std::string_view view_meaning{};  // offered by the live view, too, with this meaning, if any
  LibraryUse library = LibraryUse::kByName;
  // Whether pictures depend on it: if so, the metadata of files has it where it is not the default.
  bool changes_picture = false;
  // Throws Error (usage) for a valid value that this build does not support. May be null.
  void (*check)(const RenderSettings&) = nullptr;
};

// All settings that people can give, in the order of --help.
std::span<const SettingKey> SettingKeys();
// The key with this name, which must exist.
const SettingKey& SettingNamed(std::string_view name);

// The option of the command line: "--max-error".
std::string OptionOf(const SettingKey& key);

// Sets a choice to the option with this name. Throws Error (usage) if there is none.
void SetChoice(const SettingKey& key, const std::string& option, RenderSettings* settings);

// Throws Error (usage) for settings that are out of range or that this build does not support.
void CheckSettings(const RenderSettings& settings);

// The settings that pictures depend on and that are not the defaults, by name.
using SettingValue = std::variant<int, float, std::string>;
std::vector<std::pair<std::string_view, SettingValue>> ChangedSettings(
    const RenderSettings& settings);

}  // namespace nacre
