// SPDX-License-Identifier: Apache-2.0
#include "embree/tbb_threads.h"

#include <map>
#include <memory>
#include <mutex>
#include <set>

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/task_arena.h>

#include "base/address_space.h"
#include "base/float_mode.h"
#include "base/parallel.h"

namespace nacre {
namespace {

// By default TBB starts no more workers than the machine has cores, and prints a warning. While
// objects of this class exist, it may start as many as the largest of them asks for. There is one
// control for all of them, because TBB obeys the smallest of several.
class AllowThreads {
 public:
  explicit AllowThreads(int threads) : count_(ThreadCount(threads)) {
    if (count_ <= tbb::info::default_concurrency()) return;
    const std::lock_guard lock(Mutex());
    Asked().insert(count_);
    Renew();
  }
  ~AllowThreads() {
    if (count_ <= tbb::info::default_concurrency()) return;
    const std::lock_guard lock(Mutex());
    Asked().erase(Asked().find(count_));
    Renew();
  }
  AllowThreads(const AllowThreads&) = delete;
  AllowThreads& operator=(const AllowThreads&) = delete;

 private:
  static std::mutex& Mutex() {
    static std::mutex mutex;
    return mutex;
  }
  static std::multiset<int>& Asked() {
    static std::multiset<int> asked;
    return asked;
  }
  static void Renew() {
    static std::unique_ptr<tbb::global_control> control;
    // The new control exists before the old one is destroyed, because other builds run meanwhile.
    control = Asked().empty() ? nullptr
                              : std::make_unique<tbb::global_control>(
                                    tbb::global_control::max_allowed_parallelism,
                                    static_cast<size_t>(*Asked().rbegin()));
  }

  int count_;
};

// What an arena and its first worker take; a worker's stack alone is 4 MiB. TBB's own exception
// would never arrive: TBB 2022 throws it under a lock that throwing takes again, and waits forever.
// TBB's controls take that lock, too.
constexpr size_t kArenaBytes = size_t{8} << 20;

// One arena for each number of threads, which is kept: destroying an arena leaks 7 KB in TBB
// 2021.8, which would add up in a program that renders thousands of pictures.
tbb::task_arena& ArenaOf(int threads) {
  static std::mutex mutex;
  static std::map<int, tbb::task_arena> arenas;
  const std::lock_guard lock(mutex);
  if (!arenas.contains(threads)) RequireAddressSpace(kArenaBytes);
  return arenas.try_emplace(threads, threads).first->second;
}

}  // namespace

void WithThreads(int threads, const std::function<void()>& body) {
  tbb::task_arena& arena = ArenaOf(ThreadCount(threads));
  const AllowThreads allow(threads);
  arena.execute([&] {  // maybe in a worker, which has the float modes of the thread that started it
    const DefaultFloatMode mode;
    body();
  });
}

}  // namespace nacre
