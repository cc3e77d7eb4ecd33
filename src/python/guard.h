// SPDX-License-Identifier: Apache-2.0
// python/guard.h: guards objects while C++ works on them without the interpreter lock, and handles
// signals meanwhile.
#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <functional>
#include <list>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>

#include <pybind11/pybind11.h>

#include "nacre.h"

namespace nacre_python {

namespace py = pybind11;

// Throws nacre::Error for wrong use.
[[noreturn]] inline void Refuse(const std::string& where, const std::string& what,
                                const std::string& hint) {
  throw nacre::Error(64, {{where, what, hint}},
                     "error: " + where + ": " + what + "\n  hint: " + hint);
}

// Counts the calls that work on an object. It is protected by the interpreter lock, which must be
// held when a guard is made or destroyed. A thread that finds the object in use gets an error,
// instead of a wait that might never end.
struct Users {
  int count = 0;
};

class Use {
 public:
  enum Kind { kShared, kAlone };
  Use(Users* users, Kind kind, const char* what) : users_(users), kind_(kind) {
    const bool taken = kind == kAlone ? users->count != 0 : users->count < 0;
    if (taken) {
      Refuse(what, "is in use by another call",
             "one call at a time; threads take a copy each, or a lock");
    }
    users->count = kind == kAlone ? -1 : users->count + 1;
  }
  ~Use() { users_->count = kind_ == kAlone ? 0 : users_->count - 1; }
  Use(const Use&) = delete;
  Use& operator=(const Use&) = delete;

 private:
  Users* users_;
  Kind kind_;
};

// Held while a render calls a user's function, so that only one such call runs at a time in the
// process. The interpreter lock alone is not enough: numpy releases it in every operation on more
// than 500 numbers, and threads that pass it to each other every time are slower than a single one.
class FunctionLock {
 public:
  FunctionLock() : lock_(TheMutex(), std::defer_lock), outer_(std::exchange(Held(), &lock_)) {
    // A call takes about 50 us, as does waking a sleeping thread, so this spins first.
    const auto start = std::chrono::steady_clock::now();
    while (!lock_.try_lock()) {
      if (std::chrono::steady_clock::now() - start > std::chrono::microseconds(200)) {
        // The wait is limited, as a function may wait for another thread whose render also calls
        // one. It uses the system's clock, because GCC 12's thread sanitizer does not see a lock
        // taken by the steady one.
        (void)lock_.try_lock_until(std::chrono::system_clock::now() + std::chrono::seconds(1));
        break;
      }
      std::this_thread::yield();
    }
  }
  ~FunctionLock() { Held() = outer_; }
  FunctionLock(const FunctionLock&) = delete;
  FunctionLock& operator=(const FunctionLock&) = delete;

  // Whether this thread is inside such a function.
  static bool IsHere() { return Held() != nullptr; }

  // To be called in a child process after a fork, in which no function runs.
  static void Reset() { new (&TheMutex()) std::timed_mutex; }

  // Releases the lock that this thread holds, if any, while a user's function waits for a render of
  // its own. It must not be made or destroyed while the interpreter lock is held.
  class Pause {
   public:
    Pause() : held_(Held() != nullptr && Held()->owns_lock() ? Held() : nullptr) {
      if (held_ != nullptr) held_->unlock();
    }
    ~Pause() {
      if (held_ != nullptr) held_->lock();
    }
    Pause(const Pause&) = delete;
    Pause& operator=(const Pause&) = delete;

   private:
    std::unique_lock<std::timed_mutex>* held_;
  };

 private:
  static std::timed_mutex& TheMutex() {
    static std::timed_mutex mutex;
    return mutex;
  }
  static std::unique_lock<std::timed_mutex>*& Held() {
    static thread_local std::unique_lock<std::timed_mutex>* held = nullptr;
    return held;
  }

  std::unique_lock<std::timed_mutex> lock_;
  std::unique_lock<std::timed_mutex>* outer_;
};

// The running renders, which are stopped when the interpreter ends: a thread that returned to a
// finished interpreter would end the process by std::terminate. Protected by the interpreter lock.
class Running {
 public:
  explicit Running(const std::function<void()>* stop) {
    if (Ending()) ExitThread();
    if (waiting_ >= kMostNested) {
      Refuse("render", std::to_string(kMostNested) + " renders wait for functions that render",
             "does a function render its own scene?");
    }
    place_ = Stops().insert(Stops().end(), stop);
  }
  ~Running() { Stops().erase(place_); }
  Running(const Running&) = delete;
  Running& operator=(const Running&) = delete;

  // To be called in a new thread that works for this render, so that functions called there count
  // it as waiting.
  void CallFromHere() const { Chain() = waiting_ + 1; }

  // Stops all renders, and waits until they have ended.
  static void StopAll() {
    Ending() = true;
    for (const std::function<void()>* stop : Stops()) (*stop)();
    for (int i = 0; i < 1000 && !Stops().empty(); ++i) {
      const py::gil_scoped_release release;
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
  }
  // To be called in a child process after a fork, in which no render runs.
  static void Reset() { Stops().clear(); }

  // Ends a Python thread silently.
  [[noreturn]] static void ExitThread() {
    PyErr_SetNone(PyExc_SystemExit);
    throw py::error_already_set();
  }

  static bool& Ending() {
    static bool ending = false;
    return ending;
  }

 private:
  static constexpr int kMostNested = 64;

  // The number of renders that wait for this thread. Helper threads of a render do not inherit it,
  // and count as the first of a chain when they run its functions. As each helper waits in at most
  // one chain, all chains end.
  static int& Chain() {
    static thread_local int chain = 0;
    return chain;
  }

  static std::list<const std::function<void()>*>& Stops() {
    static std::list<const std::function<void()>*> stops;
    return stops;
  }

  int waiting_ = std::max(Chain(), FunctionLock::IsHere() ? 1 : 0);
  std::list<const std::function<void()>*>::iterator place_;
};

// Calls work() without the interpreter lock.
template <class Work>
auto Unlocked(const Work& work) {
  const py::gil_scoped_release release;
  return work();
}

// Calls body() on another thread, without the interpreter lock, while this thread checks for
// signals. The first signal whose handler throws (Ctrl-C) calls stop(), and its exception is thrown
// after body() has returned. `body` may acquire the lock.
template <class Body>
auto Interruptibly(const std::function<void()>& stop, const Body& body) {
  using Result = decltype(body());
  std::optional<Result> result;
  std::exception_ptr error;
  std::optional<py::error_already_set> signal;
  const Running running(&stop);
  {
    const py::gil_scoped_release release;
    const FunctionLock::Pause pause;
    std::mutex mutex;
    std::condition_variable ended;
    bool done = false;
    std::thread worker([&] {
      running.CallFromHere();
      try {
        result = body();
      } catch (...) {
        error = std::current_exception();
      }
      const std::lock_guard lock(mutex);
      done = true;
      ended.notify_one();
    });
    std::unique_lock lock(mutex);
    while (!ended.wait_for(lock, std::chrono::milliseconds(20), [&] { return done; })) {
      if (signal) continue;
      lock.unlock();
      {
        const py::gil_scoped_acquire acquire;
        if (PyErr_CheckSignals() != 0) signal.emplace();
      }
      if (signal) stop();
      lock.lock();
    }
    lock.unlock();
    worker.join();
  }
  if (signal) throw *std::move(signal);
  if (error && Running::Ending()) Running::ExitThread();
  if (error) std::rethrow_exception(error);
  return *std::move(result);
}

}  // namespace nacre_python
