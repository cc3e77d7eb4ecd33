// SPDX-License-Identifier: Apache-2.0
// python/guard.h: objects that C++ works on while other Python threads run, and signals meanwhile.
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

// Throws nacre::Error for what is used wrongly.
[[noreturn]] inline void Refuse(const std::string& where, const std::string& what,
                                const std::string& hint) {
  throw nacre::Error(64, {{where, what, hint}},
                     "error: " + where + ": " + what + "\n  hint: " + hint);
}

// How many calls are at work on an object. The interpreter lock protects it: it is held wherever a
// guard is made or goes. A thread that finds the object taken gets an error, never a wait that may
// have no end.
class Users {
 public:
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

// Held where a render calls a function of the user's, so that there is one call at a time in the
// process. The interpreter lock alone would not do: numpy drops it in every operation on more than
// 500 numbers, and threads that hand it to one another each time are slower than one.
class FunctionLock {
 public:
  FunctionLock() : lock_(TheMutex(), std::defer_lock), outer_(std::exchange(Held(), &lock_)) {
    // Calls take some 50 us, and so does it to wake a thread that sleeps.
    const auto start = std::chrono::steady_clock::now();
    while (!lock_.try_lock()) {
      if (std::chrono::steady_clock::now() - start > std::chrono::microseconds(200)) {
        // Not for ever: a function may wait for another thread whose render calls one as well. By
        // the system's clock: GCC 12's thread sanitizer does not see a lock taken by the steady
        // one.
        (void)lock_.try_lock_until(std::chrono::system_clock::now() + std::chrono::seconds(1));
        break;
      }
      std::this_thread::yield();
    }
  }
  ~FunctionLock() { Held() = outer_; }
  FunctionLock(const FunctionLock&) = delete;
  FunctionLock& operator=(const FunctionLock&) = delete;

  // Whether this thread is in such a function.
  static bool IsHere() { return Held() != nullptr; }

  // Of a child after a fork, in which no function runs.
  static void Reset() { new (&TheMutex()) std::timed_mutex; }

  // Lets go of the lock that this thread holds, if any, while a function of the user's waits for a
  // render of its own. Not to be made or destroyed with the interpreter lock.
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

// What ends the renders that run, for the interpreter's end: a thread that comes back to an
// interpreter that is gone ends the process by std::terminate. Protected by the interpreter lock.
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

  // Of a new thread that works for this render: what it calls has one more that waits for it.
  void CallFromHere() const { Chain() = waiting_ + 1; }

  // Ends them all, and waits for that.
  static void StopAll() {
    Ending() = true;
    for (const std::function<void()>* stop : Stops()) (*stop)();
    for (int i = 0; i < 1000 && !Stops().empty(); ++i) {
      const py::gil_scoped_release release;
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
  }
  // Of a child after a fork, in which no render runs.
  static void Reset() { Stops().clear(); }

  // Ends a thread of Python's, and prints nothing.
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

  // How many renders wait for what this thread does. The threads that help a render are not told,
  // and count as the first of a chain in its functions. Each of these waits in one chain at most,
  // so that all chains end.
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

// Calls body() on a thread of its own, without the interpreter lock, while this thread looks for
// signals: the first whose handler throws (Ctrl-C) calls stop(), and its exception is thrown when
// body() has returned. `body` may take the lock.
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
