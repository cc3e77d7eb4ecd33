// SPDX-License-Identifier: Apache-2.0
// report/child_process.h: another program, run to its end: text in, bytes out.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace nacre {

struct ChildResult {
  bool found = true;  // false: there is no such program
  int status = 0;     // its exit code; 128 and the signal's number if a signal ended it
  std::string output;
  std::string errors;
};

// The program's file: in the absolute folders of PATH. Empty and relative entries are passed over,
// so that no program is started because it lies in the working folder.
std::optional<std::string> FindProgram(const std::string& name);

// Whether RunChild would find the program.
bool IsProgramThere(const std::string& program);

// Starts arguments[0] with these arguments, without a shell, in the root folder, and with no more
// of the environment than says where programs, libraries and fonts are, in absolute folders. Its
// three streams are files in memory: none can fill up, and none can break. Throws Error (kInternal)
// if the system cannot start any program.
ChildResult RunChild(const std::vector<std::string>& arguments, const std::string& input);

}  // namespace nacre
