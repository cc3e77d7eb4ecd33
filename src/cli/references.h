// SPDX-License-Identifier: Apache-2.0
// cli/references.h: validates scenes that have a reference image.
//
// A folder of references holds, for each, a file NAME.reference.json:
//   {"scene": "x.json", "image": "x.exr", "layers": [""],
//    "tolerances": {"max_abs": 0, "max_rel": 1e-5, "exceeding_fraction": 0}, "reason": "..."}
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "compare/verdict.h"

namespace nacre {

struct Reference {
  std::string name;
  std::filesystem::path scene, image;
  std::vector<std::string> layers;
  Tolerances tolerances;
  std::string reason;  // why these tolerances were chosen
};

// The *.reference.json files of the folder, sorted by name. Throws Error (kCannotCompare) if there
// are none.
std::vector<std::filesystem::path> FindReferences(const std::string& folder);

// How to validate references.
struct ReferenceOptions {
  int threads = 0;           // 0: as many as the machine has
  bool allow_paths = false;  // files outside the folder are allowed, too
};

// Throws Error (kCannotCompare) with all faults, reported like those of scene files, if the file is
// not as described above, and for scenes and images outside its folder unless they are allowed: a
// folder of references from someone else should not read other files of its user.
Reference ReadReference(const std::filesystem::path& path, const ReferenceOptions& options);

// The rendered scene of a reference, and the reference image.
struct ReferenceRun {
  Image got, expected;
  Verdict verdict;
};

CompareOptions OptionsOf(const Reference& reference);

// The result of a reference: its run, or, if its scene or image cannot be read or they do not fit
// each other, the reason.
struct ReferenceOutcome {
  std::string name;
  Reference reference;
  std::optional<ReferenceRun> run;
  std::vector<std::string> read;  // the files that were read, as far as they were found
  std::string failure;            // in a few words
  std::string message;            // where, what and hint
};

// Runs all references of the folder, one after another, and calls `done` with each. Throws Error.
void RunReferences(const std::string& folder, const ReferenceOptions& options,
                   const std::function<void(const ReferenceOutcome&)>& done);

}  // namespace nacre
