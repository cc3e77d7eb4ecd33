// SPDX-License-Identifier: Apache-2.0
// base/memo.h: the last results of a function that takes long and depends on its arguments alone.
#pragma once

#include <cstddef>
#include <list>
#include <memory>
#include <mutex>
#include <utility>

namespace nacre {

// Keeps the results for the last kMost keys. For any number of threads; two that ask for a new key
// at once may both compute it.
template <class Key, class Value>
class Memo {
 public:
  // The result for a key, which is make() if it is not known. make() must depend on nothing else.
  template <class Make>
  std::shared_ptr<const Value> Get(const Key& key, const Make& make) {
    if (std::shared_ptr<const Value> known = Find(key)) return known;
    auto made = std::make_shared<const Value>(make());
    const std::lock_guard lock(mutex_);
    entries_.emplace_front(key, made);
    if (entries_.size() > kMost) entries_.pop_back();
    return made;
  }

 private:
  std::shared_ptr<const Value> Find(const Key& key) {
    const std::lock_guard lock(mutex_);
    for (auto entry = entries_.begin(); entry != entries_.end(); ++entry) {
      if (!(entry->first == key)) continue;
      entries_.splice(entries_.begin(), entries_, entry);
      return entry->second;
    }
    return nullptr;
  }

  static constexpr size_t kMost = 64;

  std::mutex mutex_;
  std::list<std::pair<Key, std::shared_ptr<const Value>>> entries_;  // the last used first
};

}  // namespace nacre
