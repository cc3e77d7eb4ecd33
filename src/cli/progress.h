// SPDX-License-Identifier: Apache-2.0
// cli/progress.h: tells the user how far long work is, and notices when it is to stop.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

namespace nacre {

enum class ProgressForm { kNone, kBar, kJson };

// What fits where standard error goes: a bar on a terminal, nothing in a pipe.
ProgressForm DefaultProgressForm();

// "5.2 s", "1:02:03".
std::string FormatSeconds(double seconds);

// Progress of one job on standard error. Calls from one thread at a time.
class Progress {
 public:
  // `unit_count` of `unit` ("pixel samples") make the job; the rate is told in them, if it is
  // above 0.
  Progress(ProgressForm form, std::string what, double unit_count, std::string unit);
  ~Progress();

  // `done` in [0, 1]. Prints at most ten times a second, and at the end for programs. Throws Error
  // (kInterrupted, kTerminated) once a signal has come, so that whoever works stops and leaves
  // nothing behind.
  void Update(double done);

 private:
  void Print(double done, double elapsed_seconds) const;

  ProgressForm form_;
  std::string what_;
  double unit_count_;
  std::string unit_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::chrono::steady_clock::time_point last_printed_ = start_;
  bool printed_ = false;
};

// From here on SIGINT and SIGTERM are noted instead of ending the process at once; a second one
// ends it. Output that is not finished has no name yet, so nothing is left either way.
void CatchStopSignals();

// What ends a render at once, as RenderSettings::cancel: set by stop signals, and by who else wants
// it to end.
std::atomic<bool>& CancelFlag();

// Throws Error if a stop signal has come, with what NoteWritten was told.
void ThrowIfStopped();

// What the program exits with because of a stop signal; 0: none has come.
int StopExitCode();

// While this lives, the process ends no later than `limit` after a stop signal, whatever its
// threads do then. For programs that serve until a signal, and leave nothing half-written.
class StopsInTime {
 public:
  explicit StopsInTime(std::chrono::milliseconds limit);
  ~StopsInTime();
  StopsInTime(const StopsInTime&) = delete;
  StopsInTime& operator=(const StopsInTime&) = delete;

 private:
  std::mutex mutex_;
  std::condition_variable ended_;
  bool has_ended_ = false;  // under mutex_
  std::thread thread_;
};

// For commands that write several files, one after the other, and may be stopped in between: tells
// that this one is whole and stays. From the thread that calls ThrowIfStopped.
void NoteWritten(const std::string& path);

}  // namespace nacre
