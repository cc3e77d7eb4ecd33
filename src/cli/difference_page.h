// SPDX-License-Identifier: Apache-2.0
// cli/difference_page.h: a PNG with two materials and their difference side by side, A | B | |A -
// B|, with the scale of the difference and its measures.
#pragma once

#include <string>
#include <vector>

#include "cli/sheet.h"

namespace nacre {

// Measures in linear radiance, over the pixels of the sphere and their three channels.
struct DifferenceMeasures {
  double rmse = 0;
  double max = 0;   // of |A - B|
  double mean = 0;  // of A - B
  Json ToJson() const;
};

struct DifferencePage {
  Json a, b;  // as objects of a scene file
  std::string a_label, b_label;
  std::string title;
  std::vector<std::string> footer;
};

// Throws Error (kUsage) for an option of the command that has no meaning for such a page; `what`
// names the page.
void RefuseWhatNoDifferencePageTakes(const CLI::App& command, const std::string& what);

// Renders both materials on the same sphere under the same light, and writes the page to the
// options' outputs, which must be PNG files; without outputs, it only measures. `outputs` are all
// files that the command will write; none of them may be an input of the lights. Throws Error.
DifferenceMeasures DrawDifference(const DifferencePage& page, const SheetOptions& sheet,
                                  const RenderOptions& options, const std::string& command,
                                  const std::vector<std::string>& outputs);

}  // namespace nacre
