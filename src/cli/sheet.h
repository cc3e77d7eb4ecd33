// SPDX-License-Identifier: Apache-2.0
// cli/sheet.h: the scenes that grid and pair build from their arguments: spheres in the cells of a
// page, in front of a plain ground.
#pragma once

#include <string>

#include "cli/lighting.h"
#include "cli/render_options.h"
#include "cli/sheet_page.h"

namespace nacre {

inline constexpr double kSheetSphereRadius = 0.44;  // in multiples of a cell's side

// A sphere in the cell whose middle is at (x, 0); `material` as in a scene file.
Json SheetSphere(double x, const Json& material);

// The text of a scene file. World units are cells; the block of rows by columns is centred at the
// origin. The projection is parallel, along -z, so that all spheres look alike.
std::string SheetScene(const Json& shapes, const Json& materials, const SheetRequest& request,
                       const SheetPage& page, const Lighting& lighting);

// The options for the size and title of sheets: --sphere-size, --title.
struct SheetOptions {
  double sphere_size = 0;  // pixels; 0: as large as fits
  std::string title;
  LightingOptions lighting;
};
void AddSheetOptions(CLI::App* command, SheetOptions* options, RenderOptions* render);

// The title that the options ask for; `by_default` if they name none.
std::string SheetTitle(const SheetOptions& options, const std::string& by_default);

// Combines them with --size; text is dark if the ground is light in a PNG. Throws Error (kUsage).
SheetRequest MakeSheetRequest(const SheetOptions& options, const RenderOptions& render,
                              const Lighting& lighting, int rows, int columns);

// Loads the scene of a sheet. The image of --environment and MaterialX documents may be anywhere;
// files that --lights names must be below the working folder unless the options allow more.
Scene LoadSheet(const std::string& text, const std::string& command, const SheetOptions& options,
                const SheetPage& page, LoadOptions load);

}  // namespace nacre
