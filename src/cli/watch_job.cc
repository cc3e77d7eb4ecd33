// SPDX-License-Identifier: Apache-2.0
// cli/watch_job.cc: nacre render --watch: repeats a render whenever its files change.
#include <atomic>
#include <chrono>
#include <new>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/error.h"
#include "base/printable.h"
#include "cli/print.h"
#include "cli/progress.h"
#include "cli/render_job.h"
#include "render/prepared_scene.h"
#include "scene_io/live_scene.h"

namespace nacre {
namespace {

// The interval of polling files and signals.
constexpr std::chrono::milliseconds kLook(30);

bool IsStop(const Error& error) {
  return error.code() == ExitCode::kInterrupted || error.code() == ExitCode::kTerminated;
}

// Prints an error on one line: a user who saves a file repeatedly does not want a page each time.
void PrintInOneLine(const Error& error) {
  const std::vector<Fault>& faults = error.faults();
  if (faults.empty()) return;
  const Fault& first = faults.front();
  std::string line = "error: ";
  if (!first.where.empty()) line += Printable(first.where) + ": ";
  line += Printable(first.what);
  if (!first.hint.empty()) line += " (" + Printable(first.hint) + ")";
  if (faults.size() > 1) line += fmt::format(", and {} more", faults.size() - 1);
  PrintError(line + "\n");
}

// Ends the render when files of the scene change. Nothing else may use `live` while this object
// exists.
class ChangeGuard {
 public:
  explicit ChangeGuard(LiveScene* live)
      : thread_([this, live](const std::stop_token& done) {
          while (!done.stop_requested()) {
            std::this_thread::sleep_for(kLook);
            if (!live->FilesChanged()) continue;
            changed_ = true;
            CancelFlag() = true;
            return;
          }
        }) {}
  ChangeGuard(const ChangeGuard&) = delete;
  ChangeGuard& operator=(const ChangeGuard&) = delete;

  // Stops watching. Returns whether files have changed since construction.
  bool Stop() {
    thread_.request_stop();
    if (thread_.joinable()) thread_.join();
    return changed_;
  }

 private:
  std::atomic<bool> changed_ = false;
  std::jthread thread_;  // joined before the flag is gone
};

// Renders the scene. Returns true if files changed meanwhile, which ends the render. Throws Error.
bool RenderUnlessChanged(RenderJob* job, LiveScene* live, PreparedScene* prepared) {
  ChangeGuard guard(live);
  try {
    job->Render(live->scene(), prepared);
  } catch (const Cancelled&) {
    ThrowIfStopped();
    if (!guard.Stop()) throw;
  }
  if (!guard.Stop()) return false;
  CancelFlag() = false;
  ThrowIfStopped();  // a signal may have set the flag as well
  return true;
}

}  // namespace

int RunWatchJob(const RenderOptions& options, const std::filesystem::path& path,
                const std::filesystem::path& environment,
                const std::optional<std::string>& variant) {
  if (options.dry_run) {
    throw Error(ExitCode::kUsage, "--watch", "cannot be used with --dry-run",
                "leave one of them out");
  }
  RenderJob job(options, {path.string()});
  std::optional<LiveScene> live;
  PreparedScene prepared;
  job.Load([&] {
    LoadOptions load = job.load_options();
    load.environment = environment;
    load.variant = variant;
    live.emplace(path, std::move(load));
  });
  bool changed = RenderUnlessChanged(&job, &*live, &prepared);
  if (!options.quiet) PrintError("watching the files of {}; Ctrl-C ends it\n", path.string());
  while (true) {
    FinishOutput();  // the output of --explain and --stats -
    try {
      while (!changed && !live->FilesChanged()) {
        ThrowIfStopped();
        std::this_thread::sleep_for(kLook);
      }
      changed = false;
      job.Load([&] { prepared.versions.Change(live->ReadChangedFiles()); });
      changed = RenderUnlessChanged(&job, &*live, &prepared);
    } catch (const Error& error) {
      // A stop signal is the regular end, not an error.
      if (IsStop(error)) return static_cast<int>(error.code());
      PrintInOneLine(error);
    } catch (const std::bad_alloc&) {
      PrintError("error: out of memory (a smaller picture or scene needs less)\n");
    }
  }
}

}  // namespace nacre
