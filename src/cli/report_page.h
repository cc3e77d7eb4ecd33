// SPDX-License-Identifier: Apache-2.0
// cli/report_page.h: assembles a report's file from its sections.
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "cli/perceptual_options.h"
#include "report/page.h"

namespace nacre {

// Throws Error: kUsage unless `path` is a .html file, kCannotWrite if it cannot be written.
void CheckReportPath(const std::string& path);

// The HTML of a report. `page` holds the samples of the sections' pictures, which open as `shown`
// says.
std::string ReportHtml(const std::string& title, const nlohmann::ordered_json& sections,
                       const PerceptualArguments& shown, const Page& page);

// Writes such a page to a file, and prints the file's size on stderr.
void WriteReport(const std::string& path, const std::string& title,
                 const nlohmann::ordered_json& sections, const PerceptualArguments& shown,
                 const Page& page);

}  // namespace nacre
