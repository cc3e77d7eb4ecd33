// SPDX-License-Identifier: Apache-2.0
// scene_io/unique_names.h: names for what a file names as it likes: twice, or not at all.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <unordered_map>
#include <unordered_set>

namespace nacre {

class UniqueNames {
 public:
  // `wanted`, or, if that is empty or was returned before, `wanted`, `separator` and the first
  // number from `number` on that make a name that was not. Takes constant time on average,
  // whatever the names are.
  std::string Take(const std::string& wanted, std::string_view separator, size_t number);

 private:
  std::unordered_set<std::string> taken_;
  std::unordered_map<std::string, size_t> next_;  // numbers below are taken, by wanted name
};

}  // namespace nacre
