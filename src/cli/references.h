// SPDX-License-Identifier: Apache-2.0
// cli/references.h: scenes that have a reference image.
//
// A folder of references holds, for each, NAME.reference.json:
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
  std::string reason;  // why these tolerances
};

// The *.reference.json files of the folder, by name. Throws Error (kCannotCompare) if there is
// none.
std::vector<std::filesystem::path> FindReferences(const std::string& folder);

// How references are validated.
struct ReferenceOptions {
  int threads = 0;           // 0: as many as the machine has
  bool allow_paths = false;  // scenes, images and what scenes name outside the folder, too
};

// Throws Error (kCannotCompare) with all faults, as scene files have theirs told, for a file that
// is not what is described above, and for scenes and images outside its folder unless they are
// allowed: a folder of references from elsewhere should not read other files of its user.
Reference ReadReference(const std::filesystem::path& path, const ReferenceOptions& options);

// What a reference's scene renders to, beside its image.
struct ReferenceRun {
  Image got, expected;
  Verdict verdict;
};

CompareOptions OptionsOf(const Reference& reference);

// What came of a reference: its run, or, if its scene or image cannot be read or they do not belong
// together, why there is none.
struct ReferenceOutcome {
  std::string name;
  Reference reference;
  std::optional<ReferenceRun> run;
  std::vector<std::string> read;  // the files that it is made of, as far as they were found
  std::string failure;            // in a few words
  std::string message;            // where, what and hint
};

// All references of the folder, one after another; `done` is called with each. Throws Error.
void RunReferences(const std::string& folder, const ReferenceOptions& options,
                   const std::function<void(const ReferenceOutcome&)>& done);

}  // namespace nacre
