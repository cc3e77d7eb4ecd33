// SPDX-License-Identifier: Apache-2.0
#include "base/parallel.h"

#include <algorithm>
#include <atomic>
#include <map>
#include <memory>
#include <mutex>
#include <new>
#include <set>

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include "base/float_mode.h"
#include "base/handover.h"

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

int ThreadCount(int threads) { return threads > 0 ? threads : tbb::info::default_concurrency(); }

void ParallelFor(size_t count, int threads, const std::function<void(size_t)>& body) {
  if (threads == 1 || count <= 1) {
    const FlushDenormals flush;
    for (size_t i = 0; i < count; ++i) body(i);
    return;
  }
  tbb::task_arena& arena = ArenaOf(ThreadCount(threads));  // first: it asks for memory
  const AllowThreads allow(threads);
  // Workers take indices in order, one after the other: what is finished early is then needed
  // early, and a consumer that wants them in order has little to keep.
  std::atomic<size_t> next{0};
  static const char begun = 0, ended = 0;
  struct AtEnd {  // of whatever the worker read of this function's variables, too
    ~AtEnd() { HandOver(&ended); }
  };
  const auto work = [&](int) {
    TakeOver(&begun);
    const AtEnd at_end;
    const FlushDenormals flush;
    for (size_t i = next++; i < count; i = next++) {
      try {
        body(i);
      } catch (...) {
        next = count;  // no worker begins another
        throw;
      }
    }
  };
  struct AfterAll {  // by an exception, too
    ~AfterAll() { TakeOver(&ended); }
  };
  const AfterAll after_all;
  HandOver(&begun);
  arena.execute(
      [&] { tbb::parallel_for(0, ThreadCount(threads), work, tbb::simple_partitioner()); });
}

void WithThreads(int threads, const std::function<void()>& body) {
  tbb::task_arena& arena = ArenaOf(ThreadCount(threads));
  const AllowThreads allow(threads);
  arena.execute([&] {  // maybe in a worker, which has the modes of whoever started it
    const DefaultFloatMode mode;
    body();
  });
}

FlushDenormals::FlushDenormals() : saved_(EnterFloatMode(Denormals::kFlushed)) {}
FlushDenormals::~FlushDenormals() { LeaveFloatMode(saved_); }

}  // namespace nacre
