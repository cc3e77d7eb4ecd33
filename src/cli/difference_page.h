// SPDX-License-Identifier: Apache-2.0
// cli/difference_page.h: two materials and their difference side by side: A | B | |A - B|, with
// the difference's scale and its measures, as a PNG.
#pragma once

#include <string>
#include <vector>

#include "cli/sheet.h"

namespace nacre {

// Of linear radiance, over the pixels of the sphere and their three channels.
struct DifferenceMeasures {
  double rmse = 0;
  double max = 0;   // of |A - B|
  double mean = 0;  // of A - B
  Json ToJson() const;
};

struct DifferencePage {
  Json a, b;  // materials as in scene files
  std::string a_label, b_label;
  std::string title;
  std::vector<std::string> footer;
};

// Throws Error (usage) for an option of the command that means nothing to such a page.
void RefuseWhatNoDifferencePageTakes(const CLI::App& command, const std::string& what);

// Renders both on the same sphere under the same light and writes the page to the options' outputs,
// PNG files all of them; with none it only measures. `outputs` are all files that the command will
// write: none may be one that the lights are made of. Throws Error.
DifferenceMeasures DrawDifference(const DifferencePage& page, const SheetOptions& sheet,
                                  const RenderOptions& options, const std::string& command,
                                  const std::vector<std::string>& outputs);

}  // namespace nacre
