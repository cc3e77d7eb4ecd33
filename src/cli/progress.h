// SPDX-License-Identifier: Apache-2.0
// cli/progress.h: shows the progress of long work, and notices when it is to stop.
#pragma once

#include <atomic>
#include <chrono>
#include <string>
#include <thread>

namespace nacre {

enum class ProgressForm { kNone, kBar, kJson };

// The form that suits standard error: a bar on a terminal, nothing in a pipe.
ProgressForm DefaultProgressForm();

// Formats a duration: "5.2 s", "1:02:03".
std::string FormatSeconds(double seconds);

// Shows the progress of one job on standard error. To be used by one thread at a time.
class Progress {
 public:
  // The job consists of `unit_count` times `unit` ("pixel samples"); if that is above 0, the rate
  // is shown in these units.
  Progress(ProgressForm form, std::string what, double unit_count, std::string unit);
  ~Progress();

  // `done` is in [0, 1]. Prints at most ten times a second, and in JSON form also at the end.
  // Throws Error (kInterrupted, kTerminated) after a stop signal, so that the work ends and leaves
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

// From now on, SIGINT and SIGTERM are recorded instead of ending the process at once; a second
// signal ends it. Unfinished output has no name yet, so nothing is left behind either way.
void CatchStopSignals();

// The flag that ends a render at once, for RenderSettings::cancel. It is set by stop signals, and
// by other code that wants to end the render.
std::atomic<bool>& CancelFlag();

// Throws Error if a stop signal has come. The error names the files reported to NoteWritten.
void ThrowIfStopped();

// The exit code due to a stop signal; 0 if none has come.
int StopExitCode();

// While the returned thread exists, the process ends at most `limit` after a stop signal, whatever
// its other threads do. For servers, which run until a signal and leave nothing half-written.
std::jthread StopInTime(std::chrono::milliseconds limit);

// For commands that write several files and may be stopped in between: records that this file is
// complete and stays. To be called from the thread that calls ThrowIfStopped.
void NoteWritten(const std::string& path);

}  // namespace nacre
