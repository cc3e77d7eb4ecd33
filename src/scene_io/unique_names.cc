// SPDX-License-Identifier: Apache-2.0
#include "scene_io/unique_names.h"

#include <algorithm>

#include <fmt/format.h>

namespace nacre {

std::string UniqueNames::Take(const std::string& wanted, std::string_view separator,
                              size_t number) {
  if (!wanted.empty() && taken_.insert(wanted).second) return wanted;
  size_t& next = next_[wanted];
  next = std::max(next, number);
  std::string name;
  do {
    name = fmt::format("{}{}{}", wanted, separator, next++);
  } while (!taken_.insert(name).second);
  return name;
}

}  // namespace nacre
