// SPDX-License-Identifier: Apache-2.0
#include "render/settings.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/error.h"
#include "visibility/box_trees.h"

namespace nacre {

std::vector<std::string> IntersectorNames() { return {"auto", "embree", "tiles", "shells"}; }

IntersectorChoice ParseIntersector(const std::string& name) {
  const std::vector<std::string> names = IntersectorNames();
  const auto found = std::find(names.begin(), names.end(), name);
  if (name == "embree" && EmbreeVersion() == nullptr) {
    throw Error(ExitCode::kUsage, "intersector", "this build has no Embree",
                "shells finds the same hits");
  }
  if (found != names.end()) return static_cast<IntersectorChoice>(found - names.begin());
  throw Error(ExitCode::kUsage, "intersector", "unknown intersector \"" + name + "\"",
              fmt::format("one of: {}", fmt::join(names, ", ")));
}

const char* TreeAskedFor(IntersectorChoice choice) {
  return choice == IntersectorChoice::kEmbree   ? "--intersector embree"
         : choice == IntersectorChoice::kShells ? "--intersector shells"
                                                : nullptr;
}

}  // namespace nacre
