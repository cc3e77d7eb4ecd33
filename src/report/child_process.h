// SPDX-License-Identifier: Apache-2.0
// report/child_process.h: runs another program to its end, with text as input and bytes as output.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace nacre {

struct ChildResult {
  bool found = true;  // false: the program does not exist
  int status = 0;     // its exit code, or 128 plus the number of the signal that ended it
  std::string output;
  std::string errors;
};

// The path of a program, searched in the absolute folders of PATH. Empty and relative entries are
// ignored, so that no program is started because it is in the working folder.
std::optional<std::string> FindProgram(const std::string& name);

// Runs arguments[0] with these arguments, without a shell, in the root folder, with an environment
// that only says where programs, libraries and fonts are, in absolute folders. Its three streams
// are files in memory, which can neither fill up nor break like pipes. Throws Error (kInternal) if
// the system cannot start programs.
ChildResult RunChild(const std::vector<std::string>& arguments, const std::string& input);

}  // namespace nacre
