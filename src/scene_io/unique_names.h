// SPDX-License-Identifier: Apache-2.0
// scene_io/unique_names.h: makes unique names for items of a file whose names may be missing or
// repeated.
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>
#include <unordered_map>
#include <unordered_set>

#include <fmt/format.h>

namespace nacre {

class UniqueNames {
 public:
  // Returns `wanted`. If that is empty or was returned before, returns `wanted`, `separator` and
  // the first number from `number` on that give a name not returned before. Takes constant time on
  // average, whatever the names are.
  std::string Take(const std::string& wanted, std::string_view separator, size_t number) {
    if (!wanted.empty() && taken_.insert(wanted).second) return wanted;
    size_t& next = next_[wanted];
    next = std::max(next, number);
    std::string name;
    do {
      name = fmt::format("{}{}{}", wanted, separator, next++);
    } while (!taken_.insert(name).second);
    return name;
  }

 private:
  std::unordered_set<std::string> taken_;
  std::unordered_map<std::string, size_t> next_;  // by wanted name: the next number to try
};

}  // namespace nacre
