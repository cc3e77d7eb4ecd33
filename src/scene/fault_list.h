// SPDX-License-Identifier: Apache-2.0
// scene/fault_list.h: collects the faults of a scene, so that all of them are reported at once.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"

namespace nacre {

// Keeps the first kMaxKept faults and counts the rest: a generator that makes one bad sphere
// makes a million.
class FaultList {
 public:
  static constexpr size_t kMaxKept = 20;

  void Add(std::string where, std::string what, std::string hint = {});

  // How many faults were added.
  size_t count() const { return count_; }
  const std::vector<Fault>& kept() const { return kept_; }

  // The kept faults, followed by one that says how many more there are, if any.
  std::vector<Fault> All() const;

 private:
  std::vector<Fault> kept_;
  size_t count_ = 0;
};

// `name` as a token of a JSON pointer (RFC 6901): ~ becomes ~0, and / becomes ~1.
std::string PointerToken(std::string_view name);

}  // namespace nacre
