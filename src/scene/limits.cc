// SPDX-License-Identifier: Apache-2.0
#include "scene/limits.h"

#include <cmath>

#include <fmt/format.h>

namespace nacre {
namespace {

// Powers of ten with a dozen zeros are easier to read as such.
std::string Text(double x) {
  return std::abs(x) < 1e12 ? fmt::format("{}", x) : fmt::format("{:g}", x);
}

}  // namespace

std::string Describe(const Range& range) {
  if (!range.min_open && !range.max_open) {
    return "from " + Text(range.min) + " to " + Text(range.max);
  }
  return fmt::format("{} {} and {} {}", range.min_open ? "greater than" : "at least",
                     Text(range.min), range.max_open ? "less than" : "at most", Text(range.max));
}

}  // namespace nacre
