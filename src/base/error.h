// SPDX-License-Identifier: Apache-2.0
// base/error.h: the one error type. Thrown at the edges (scene and image I/O, validation),
// caught once in main. Kernels never throw; libraries never print.
#pragma once

#include <exception>
#include <string>
#include <vector>

namespace nacre {

// Process exit codes (sysexits.h where one exists).
enum class ExitCode : int {
  kOk = 0,
  kDiffers = 1,        // compare, validate: the images differ
  kCannotCompare = 2,  // compare, validate: there is nothing to compare
  kUsage = 64,         // command line, unknown output extension
  kBadInput = 65,      // missing, unreadable or malformed input
  kInternal = 70,      // nacre's own fault, or out of memory
  kCannotWrite = 74,   // output unwritable, not a regular file, disk full
  kInterrupted = 130,  // SIGINT
  kTerminated = 143,   // SIGTERM
};

// One mistake. Names from files are kept as they are, and may hold any bytes.
struct Fault {
  std::string where;  // file and position, e.g. "scenes/grid.json: /materials/gold"
  std::string what;   // what is wrong there
  std::string hint;   // how to fix it; may be empty
};

// One or more faults and the exit code that they lead to.
class Error : public std::exception {
 public:
  Error(ExitCode code, std::vector<Fault> faults);
  Error(ExitCode code, std::string where, std::string what, std::string hint = {});

  ExitCode code() const { return code_; }
  const std::vector<Fault>& faults() const { return faults_; }

  // All faults in the form that main prints, each part of them made Printable():
  //   error: <where>: <what>
  //     hint: <hint>
  const char* what() const noexcept override { return message_.c_str(); }

 private:
  ExitCode code_;
  std::vector<Fault> faults_;
  std::string message_;
};

// The candidate nearest to `word` in edit distance, or "" if none is near enough to be a likely
// typing error (more than a third of the letters differ).
std::string NearestName(const std::string& word, const std::vector<std::string>& candidates);

// The hint for an unknown name: did you mean "NEAREST"? If there is none, `otherwise`.
std::string NearestHint(const std::string& word, const std::vector<std::string>& candidates,
                        const std::string& otherwise);

// The names of items, which are such candidates.
template <class Items>
std::vector<std::string> NamesOf(const Items& items) {
  std::vector<std::string> names;
  for (const auto& item : items) names.emplace_back(item.name);
  return names;
}

}  // namespace nacre
