// SPDX-License-Identifier: Apache-2.0
// cli/report_page.h: the file that a report is, put together of its sections.
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "cli/perceptual_options.h"
#include "report/page.h"

namespace nacre {

// Throws Error: kUsage unless `path` is a .html file, kCannotWrite.
void CheckReportPath(const std::string& path);

// The page: `page` holds the sections' samples; pictures open as `shown` says.
std::string ReportHtml(const std::string& title, const nlohmann::ordered_json& sections,
                       const PerceptualArguments& shown, const Page& page);

// The same into a file. Tells its size on stderr.
void WriteReport(const std::string& path, const std::string& title,
                 const nlohmann::ordered_json& sections, const PerceptualArguments& shown,
                 const Page& page);

}  // namespace nacre
