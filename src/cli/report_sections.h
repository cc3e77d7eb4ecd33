// SPDX-License-Identifier: Apache-2.0
// cli/report_sections.h: the parts of a report as the page wants them (src/report/html).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/perceptual_options.h"
#include "cli/references.h"
#include "cli/report_inputs.h"
#include "report/picture.h"

namespace nacre {

// The pictures side by side; if there are several, each against number `reference`. Throws Error
// (kCannotCompare) if they do not belong together.
nlohmann::ordered_json PictureSection(const std::vector<ReportPicture>& pictures, size_t reference,
                                      const std::optional<PerceptualOptions>& perceptual,
                                      size_t limit, Page* page);

// All references of a folder, rendered and compared. Those that cannot be are told in the table.
nlohmann::ordered_json ValidationSection(const std::string& folder, int threads,
                                         const std::optional<PerceptualOptions>& perceptual,
                                         size_t limit, Page* page);

nlohmann::ordered_json BenchSection(const std::string& path);

}  // namespace nacre
