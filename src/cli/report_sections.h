// SPDX-License-Identifier: Apache-2.0
// cli/report_sections.h: the sections of a report as JSON for the page (src/report/html), and the
// file that is made of them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/perceptual_options.h"
#include "cli/references.h"
#include "cli/report_inputs.h"
#include "report/page.h"
#include "report/picture.h"

namespace nacre {

// Pictures side by side; several are each compared with number `reference`. Throws Error
// (kCannotCompare) if they do not fit each other.
Json PictureSection(const std::vector<ReportPicture>& pictures, size_t reference,
                    const std::optional<PerceptualOptions>& perceptual, size_t limit, Page* page);

// References, added one after another as they are rendered and compared. Those that could not be
// are listed in the table with the reason.
class ValidationSection {
 public:
  // `limit`: the maximum size in bytes of the samples of one reference's pictures.
  ValidationSection(const std::optional<PerceptualOptions>& perceptual, size_t limit, Page* page);

  void Add(const ReferenceOutcome& outcome);
  const Json& ToJson() const { return section_; }

 private:
  void AddRun(const ReferenceOutcome& outcome);

  std::optional<PerceptualOptions> perceptual_;
  size_t limit_;
  Page* page_;
  Json section_;
};

Json BenchSection(const std::string& path);

// Throws Error: kUsage unless `path` is a .html file, kCannotWrite if it cannot be written.
void CheckReportPath(const std::string& path);

// The HTML of a report. `page` holds the samples of the sections' pictures, which open as `shown`
// says.
std::string ReportHtml(const std::string& title, const Json& sections,
                       const PerceptualArguments& shown, const Page& page);

// Writes such a page to a file, and prints the file's size on stderr.
void WriteReport(const std::string& path, const std::string& title, const Json& sections,
                 const PerceptualArguments& shown, const Page& page);

}  // namespace nacre
