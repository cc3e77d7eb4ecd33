// SPDX-License-Identifier: Apache-2.0
// cli/text_output.h: writes text files, which appear completely or not at all.
#pragma once

#include <string>

namespace nacre {

// Throws Error (kCannotWrite) if `path` cannot be written. "-" is standard output.
void CheckTextOutput(const std::string& path);
void WriteText(const std::string& path, const std::string& text);

}  // namespace nacre
