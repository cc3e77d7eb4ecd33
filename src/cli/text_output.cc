// SPDX-License-Identifier: Apache-2.0
#include "cli/text_output.h"

#include <span>

#include "cli/print.h"
#include "image_io/output_file.h"

namespace nacre {

void CheckTextOutput(const std::string& path) {
  if (path != "-") CheckWritable(path);
}

void WriteText(const std::string& path, const std::string& text) {
  if (path == "-") {
    PrintOut(text);
    return;
  }
  OutputFile file(path);
  file.Write(0, std::span(reinterpret_cast<const uint8_t*>(text.data()), text.size()));
  file.Commit();
}

}  // namespace nacre
