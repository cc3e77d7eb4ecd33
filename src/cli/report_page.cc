// SPDX-License-Identifier: Apache-2.0
#include "cli/report_page.h"

#include <algorithm>

#include <fmt/format.h>

#include "base/error.h"
#include "base/path.h"
#include "base/target.h"
#include "base/version.h"
#include "cli/print.h"
#include "cli/text_output.h"

namespace nacre {
namespace {

using Json = nlohmann::ordered_json;

std::string Summary(const PerceptualArguments& shown, const Json& sections) {
  const bool pictures = std::any_of(sections.begin(), sections.end(),
                                    [](const Json& s) { return s["kind"] == "images"; });
  if (!pictures) return fmt::format("By nacre {}.", kVersion);
  return fmt::format(
      "By nacre {}, SIMD target {}. Pictures open with the tone operator {} at {} "
      "stops; what they hold is linear.",
      kVersion, TargetName(ActiveTarget()), shown.tonemap, shown.exposure);
}

}  // namespace

void CheckReportPath(const std::string& path) {
  if (!HasExtension(path, ".html")) {
    throw Error(ExitCode::kUsage, path, "unknown output extension", "a report is a .html file");
  }
  CheckTextOutput(path);
}

std::string ReportHtml(const std::string& title, const Json& sections,
                       const PerceptualArguments& shown, const Page& page) {
  const std::string generator = fmt::format("nacre {} ({})", kVersion, kCommit);
  return page.Html(title, generator,
                   {{"generator", generator},
                    {"summary", Summary(shown, sections)},
                    {"notes", Json::array()},
                    {"tone", shown.tonemap},
                    {"exposure", shown.exposure},
                    {"sections", sections}});
}

void WriteReport(const std::string& path, const std::string& title, const Json& sections,
                 const PerceptualArguments& shown, const Page& page) {
  const std::string html = ReportHtml(title, sections, shown, page);
  WriteText(path, html);
  PrintError("{}: {:.1f} MiB\n", path, static_cast<double>(html.size()) / (1024 * 1024));
}

}  // namespace nacre
