// SPDX-License-Identifier: Apache-2.0
#include "embree/tbb_threads.h"

#include <map>
#include <memory>
#include <mutex>
#include <new>
#include <set>

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/task_arena.h>

#include "base/float_mode.h"
#include "base/parallel.h"

namespace nacre {
namespace {

// Left alone, TBB starts no more workers than the machine has cores, and prints a warning. While
// alive, it may start as many as this and all others alive ask for: the smallest of several
// controls counts, so there is one for all.
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
    // The new one is there before the old one goes: others run meanwhile.
    control = Asked().empty() ? nullptr
                              : std::make_unique<tbb::global_control>(
                                    tbb::global_control::max_allowed_parallelism,
                                    static_cast<size_t>(*Asked().rbegin()));
  }

  int count_;
};

// Throws std::bad_alloc if there is no memory for an arena and its first worker. TBB's own would
// never arrive: TBB 2022 throws it under a lock that throwing takes again, and waits for ever. Its
// controls take that lock, too.
void RequireMemoryForArena() {
  constexpr size_t kBytes = size_t{8} << 20;  // a worker's stack alone is 4; never touched
  ::operator delete(::operator new(kBytes));
}

// One arena for each number of threads, kept: an arena that goes leaves 7 KB behind in TBB 2021.8,
// and a program that renders thousands of pictures would feel it.
tbb::task_arena& ArenaOf(int threads) {
  static std::mutex mutex;
  static std::map<int, tbb::task_arena> arenas;
  const std::lock_guard lock(mutex);
  if (!arenas.contains(threads)) RequireMemoryForArena();
  return arenas.try_emplace(threads, threads).first->second;
}

}  // namespace

void WithThreads(int threads, const std::function<void()>& body) {
  tbb::task_arena& arena = ArenaOf(ThreadCount(threads));
  const AllowThreads allow(threads);
  arena.execute([&] {  // maybe in a worker, which has the modes of whoever started it
    const DefaultFloatMode mode;
    body();
  });
}

}  // namespace nacre
