// SPDX-License-Identifier: Apache-2.0
#include "scene/fault_list.h"

#include <utility>

#include <fmt/format.h>

namespace nacre {

void FaultList::Add(std::string where, std::string what, std::string hint) {
  ++count_;
  if (kept_.size() < kMaxKept) {
    kept_.push_back({std::move(where), std::move(what), std::move(hint)});
  }
}

std::vector<Fault> FaultList::All() const {
  std::vector<Fault> faults = kept_;
  if (count_ > kept_.size()) {
    faults.push_back({{}, fmt::format("and {} more faults", count_ - kept_.size()), {}});
  }
  return faults;
}

std::string PointerToken(std::string_view name) {
  std::string token;
  for (const char c : name) {
    if (c == '~') {
      token += "~0";
    } else if (c == '/') {
      token += "~1";
    } else {
      token += c;
    }
  }
  return token;
}

}  // namespace nacre
