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

// References as they are rendered and compared, one after another. Those that could not be are told
// in the table.
class ValidationSection {
 public:
  // `limit`: bytes of samples that the pictures of one reference may have.
  ValidationSection(const std::optional<PerceptualOptions>& perceptual, size_t limit, Page* page);

  void Add(const ReferenceOutcome& outcome);
  const nlohmann::ordered_json& ToJson() const { return section_; }

 private:
  void AddRun(const ReferenceOutcome& outcome);

  std::optional<PerceptualOptions> perceptual_;
  size_t limit_;
  Page* page_;
  nlohmann::ordered_json section_;
};

nlohmann::ordered_json BenchSection(const std::string& path);

}  // namespace nacre
