#include "scene/limits.h"

#include <fmt/format.h>

namespace nacre {

std::string Describe(const Range& range) {
  if (!range.min_open && !range.max_open) return fmt::format("from {} to {}", range.min, range.max);
  return fmt::format("{} {} and {} {}", range.min_open ? "greater than" : "at least", range.min,
                     range.max_open ? "less than" : "at most", range.max);
}

}  // namespace nacre
