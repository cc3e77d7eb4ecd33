// SPDX-License-Identifier: Apache-2.0
#include "base/parallel.h"

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <exception>
#include <list>
#include <mutex>
#include <system_error>
#include <thread>

#include <pthread.h>

#include "base/float_mode.h"

namespace nacre {
namespace {

// A call of ParallelFor.
class Loop {
 public:
  Loop(size_t count, const std::function<void(size_t)>& body) : count_(count), body_(body) {}

  // Runs bodies until no index is left; called by the caller and by each helper. Indices are begun
  // in ascending order, one at a time, so that a consumer that needs results in order has to buffer
  // few of them.
  void Work() {
    const FlushDenormals flush;
    try {
      for (size_t i = next_++; i < count_; i = next_++) body_(i);
    } catch (...) {
      next_ = count_;  // workers begin no more indices
      const std::lock_guard lock(mutex_);
      if (!error_) error_ = std::current_exception();
    }
  }

  // To be called once all workers have finished.
  void ThrowIfFailed() {
    if (error_) std::rethrow_exception(error_);
  }

 private:
  size_t count_;
  const std::function<void(size_t)>& body_;
  std::atomic<size_t> next_{0};
  std::mutex mutex_;
  std::exception_ptr error_;
};

// Threads that help with loops, and stay alive between loops.
class Helpers {
 public:
  // Runs a loop with up to `wanted` helpers, without waiting for helpers that have not joined yet.
  // So nested loops and loops of concurrent callers progress even if all helpers are busy.
  void Run(Loop* loop, int wanted) {
    Call call{loop, wanted};
    {
      const std::lock_guard lock(mutex_);
      Start(wanted);
      calls_.push_back(&call);
    }
    for (int i = 0; i < wanted; ++i) called_.notify_one();
    loop->Work();
    std::unique_lock lock(mutex_);
    calls_.remove(&call);
    left_.wait(lock, [&] { return call.working == 0; });
  }

 private:
  struct Call {
    Loop* loop;
    int wanted;       // helpers that may still join
    int working = 0;  // helpers that are at work
  };

  // Starts threads until there are this many, or fewer if the system refuses more.
  void Start(int threads) {
    try {
      for (; started_ < threads; ++started_) std::thread([this] { Help(); }).detach();
    } catch (const std::system_error&) {
    }
  }

  [[noreturn]] void Help() {
    std::unique_lock lock(mutex_);
    const auto open = [](const Call* call) { return call->wanted > 0; };
    for (;;) {
      const auto found = std::find_if(calls_.begin(), calls_.end(), open);
      if (found == calls_.end()) {
        called_.wait(lock);
        continue;
      }
      Call& call = **found;
      --call.wanted;
      ++call.working;
      lock.unlock();
      call.loop->Work();
      lock.lock();
      if (--call.working == 0) left_.notify_all();
    }
  }

  std::mutex mutex_;
  std::condition_variable called_, left_;
  std::list<Call*> calls_;
  int started_ = 0;
};

// Never destroyed, as helpers wait in it until the process ends. A child process after a fork has
// no helpers, and starts its own.
Helpers& TheHelpers() {
  static Helpers* helpers = [] {
    pthread_atfork(nullptr, nullptr, [] { helpers = new Helpers; });
    return new Helpers;
  }();
  return *helpers;
}

}  // namespace

int ThreadCount(int threads) {
  // Asking reads a file of the system: a hundredth of a frame of 10 ms, where a session asks each
  // time.
  static const int cores = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  return threads > 0 ? threads : cores;
}

void ParallelFor(size_t count, int threads, const std::function<void(size_t)>& body) {
  if (threads == 1 || count <= 1) {
    const FlushDenormals flush;
    for (size_t i = 0; i < count; ++i) body(i);
    return;
  }
  Loop loop(count, body);
  const size_t workers = std::min(count, static_cast<size_t>(ThreadCount(threads)));
  TheHelpers().Run(&loop, static_cast<int>(workers) - 1);
  loop.ThrowIfFailed();
}

}  // namespace nacre
