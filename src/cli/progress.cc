// SPDX-License-Identifier: Apache-2.0
#include "cli/progress.h"

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <mutex>
#include <stop_token>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <unistd.h>

#include "base/error.h"
#include "cli/print.h"

namespace nacre {
namespace {

std::atomic<int> g_stop_signal{0};
std::atomic<bool> g_cancel{false};

// The files of the command that are complete.
struct WrittenFiles {
  size_t count = 0;
  std::string last;
};

WrittenFiles g_written;

int SignalExitCode(int signal) {
  return static_cast<int>(signal == SIGTERM ? ExitCode::kTerminated : ExitCode::kInterrupted);
}

extern "C" void NoteStopSignal(int signal) {
  if (g_stop_signal.exchange(signal) != 0) _exit(SignalExitCode(signal));
  g_cancel = true;
}

std::string FormatRate(double rate, const std::string& unit) {
  if (rate >= 1e9) return fmt::format("{:.2f} G {}/s", rate * 1e-9, unit);
  if (rate >= 1e6) return fmt::format("{:.1f} M {}/s", rate * 1e-6, unit);
  if (rate >= 1e3) return fmt::format("{:.1f} k {}/s", rate * 1e-3, unit);
  return fmt::format("{:.1f} {}/s", rate, unit);
}

}  // namespace

std::string FormatSeconds(double seconds) {
  if (seconds < 60) return fmt::format("{:.1f} s", seconds);
  const int whole = static_cast<int>(std::min(seconds, 1e8));
  return fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60);
}

ProgressForm DefaultProgressForm() {
  // A terminal that cannot move its cursor back would show each state of the bar on a new line.
  const char* const terminal = std::getenv("TERM");
  const bool moves = terminal != nullptr && std::string_view(terminal) != "dumb";
  return moves && isatty(STDERR_FILENO) != 0 ? ProgressForm::kBar : ProgressForm::kNone;
}

Progress::Progress(ProgressForm form, std::string what, double unit_count, std::string unit)
    : form_(form), what_(std::move(what)), unit_count_(unit_count), unit_(std::move(unit)) {}

Progress::~Progress() {
  if (printed_ && form_ == ProgressForm::kBar) std::fputs("\r\033[K", stderr);
}

void Progress::Update(double done) {
  ThrowIfStopped();
  if (form_ == ProgressForm::kNone) return;
  const auto now = std::chrono::steady_clock::now();
  const bool last = done >= 1 && form_ == ProgressForm::kJson;
  if (!last && now - last_printed_ < std::chrono::milliseconds(100)) return;
  last_printed_ = now;
  printed_ = true;
  Print(done, std::chrono::duration<double>(now - start_).count());
}

void Progress::Print(double done, double elapsed_seconds) const {
  const double rate = unit_count_ * done / elapsed_seconds;
  const double left = done > 0 ? elapsed_seconds * (1 - done) / done : 0;
  if (form_ == ProgressForm::kJson) {
    PrintError(
        "{{\"progress\": {:.4f}, \"elapsed_s\": {:.3f}, \"left_s\": {:.3f}, "
        "\"rate_per_s\": {:.6g}}}\n",
        done, elapsed_seconds, left, rate);
  } else {
    constexpr int kBarWidth = 30;
    const int filled = static_cast<int>(done * kBarWidth);
    const std::string told = unit_count_ > 0 ? FormatRate(rate, unit_) + "  " : "";
    // This is the only text that moves the cursor, so it bypasses PrintError.
    std::fputs(fmt::format("\r{} [{:=<{}}{: <{}}] {:3.0f} %  {}{} left\033[K", Printable(what_), "",
                           filled, "", kBarWidth - filled, 100 * done, told, FormatSeconds(left))
                   .c_str(),
               stderr);
  }
  std::fflush(stderr);
}

std::atomic<bool>& CancelFlag() { return g_cancel; }

void CatchStopSignals() {
  struct sigaction action = {};
  action.sa_handler = NoteStopSignal;  // without SA_RESTART, so that it interrupts waiting for a
                                       // pipe
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  // Makes exceeding the file size limit an error of write(), with a message and exit code.
  std::signal(SIGXFSZ, SIG_IGN);
  // A reader that closes the pipe must not end a render either: FinishOutput reports it.
  std::signal(SIGPIPE, SIG_IGN);
}

void ThrowIfStopped() {
  const int signal = g_stop_signal.load();
  if (signal == 0) return;
  throw Error(static_cast<ExitCode>(SignalExitCode(signal)), "",
              signal == SIGTERM ? "terminated" : "interrupted",
              g_written.count == 0 ? "no output was written"
              : g_written.count == 1
                  ? fmt::format("of the outputs, {} was written", g_written.last)
                  : fmt::format("{} files were written before, the last of them {}",
                                g_written.count, g_written.last));
}

int StopExitCode() {
  const int signal = g_stop_signal.load();
  return signal == 0 ? 0 : SignalExitCode(signal);
}

std::jthread StopInTime(std::chrono::milliseconds limit) {
  return std::jthread([limit](const std::stop_token& ended) {
    std::mutex mutex;
    std::unique_lock lock(mutex);
    std::condition_variable_any wait;
    const auto ends_within = [&](std::chrono::milliseconds time) {
      wait.wait_for(lock, ended, time, [] { return false; });
      return ended.stop_requested();
    };
    constexpr std::chrono::milliseconds kLook(20);
    while (StopExitCode() == 0) {
      if (ends_within(kLook)) return;
    }
    if (!ends_within(limit)) _exit(StopExitCode());
  });
}

void NoteWritten(const std::string& path) {
  ++g_written.count;
  g_written.last = path;
}

}  // namespace nacre
