// SPDX-License-Identifier: Apache-2.0
// cli/sheet.h: scenes that the commands grid and pair build from their arguments: spheres in the
// cells of a page, before a plain ground.
#pragma once

#include <string>

#include "cli/lighting.h"
#include "cli/render_options.h"
#include "cli/sheet_page.h"

namespace nacre {

inline constexpr double kSheetSphereRadius = 0.44;  // of a cell

// A scene file's text. World units are cells; the block of rows by columns has its centre at the
// origin and is seen in parallel projection along -z, so that every sphere is seen alike.
std::string SheetScene(const Json& shapes, const Json& materials, const SheetRequest& request,
                       const SheetPage& page, const Lighting& lighting);

// The options of size that sheets share: --sphere-size, --title.
struct SheetOptions {
  double sphere_size = 0;  // pixels; 0: what fits
  std::string title;
  LightingOptions lighting;
};
void AddSheetOptions(CLI::App* command, SheetOptions* options, RenderOptions* render);

// What they and --size ask for. Throws Error (usage).
SheetRequest MakeSheetRequest(const SheetOptions& options, const RenderOptions& render, int rows,
                              int columns);

// Whether the ground looks light in a PNG.
bool IsLightGround(const Lighting& lighting, const RenderOptions& render);

// Loads a sheet's scene. The image of --environment may be anywhere, those that --lights names only
// below the working folder, unless the options allow more.
Scene LoadSheet(const std::string& text, const std::string& command, const SheetOptions& options,
                const SheetPage& page, LoadOptions load);

}  // namespace nacre
