// SPDX-License-Identifier: Apache-2.0
// cli/cmd_validate.cc: nacre validate: renders scenes that have a reference image and compares.
#include <filesystem>
#include <memory>

#include <fmt/format.h>

#include "base/error.h"
#include "cli/commands.h"
#include "cli/print.h"
#include "cli/references.h"
#include "cli/render_options.h"

namespace nacre {
namespace {

namespace fs = std::filesystem;

bool ValidateOne(const fs::path& path, int threads) {
  const Reference reference = ReadReference(path);
  const Verdict verdict = RunReference(reference, threads).verdict;
  const LayerMetrics& m = verdict.layers.front();
  PrintOut(fmt::format("{:<24} {:<6} {:>11.3g} {:>11.3g} {:>11.3g} {:>9}  {}\n", reference.name,
                       verdict.match ? "match" : "DIFFER", m.rmse, m.max_rel, m.p999_rel,
                       verdict.exceeding_pixels,
                       verdict.match ? reference.reason : verdict.reason));
  return verdict.match;
}

}  // namespace

void AddValidateCommand(CLI::App* app, int* exit_code) {
  CLI::App* command = app->add_subcommand(
      "validate", "Render the scenes of a folder of references and compare with their images");
  struct Arguments {
    std::string folder = "tests/references";
    std::string target = "auto";
    int threads = 0;
  };
  const auto a = std::make_shared<Arguments>();
  command->add_option("DIR", a->folder, "Folder with *.reference.json files")
      ->capture_default_str();
  command->add_option("--threads", a->threads, "Threads to use; 0: as many as the machine has")
      ->check(CLI::Range(0, 1024));
  command->add_option("--target", a->target, "SIMD target: auto, avx3, avx2, sse4 or scalar")
      ->capture_default_str();
  command->footer("Exit code: 0 all match, 1 one differs, 2 one cannot be compared.");
  command->callback([a, exit_code] {
    ApplyTarget(a->target);
    const std::vector<fs::path> references = FindReferences(a->folder);
    PrintOut(fmt::format("{:<24} {:<6} {:>11} {:>11} {:>11} {:>9}  {}\n", "reference", "", "RMSE",
                         "max rel", "99.9% rel", "exceed", "tolerance's reason, or what differs"));
    bool all_match = true;
    bool all_compared = true;
    for (const fs::path& reference : references) {
      try {
        all_match = ValidateOne(reference, a->threads) && all_match;
      } catch (const Error& error) {
        // A missing scene or image: told, and the others still get their turn.
        if (error.code() != ExitCode::kBadInput && error.code() != ExitCode::kCannotCompare) throw;
        all_compared = false;
        PrintOut(fmt::format("{:<24} ERROR  {}\n", reference.stem().stem().string(),
                             error.faults().front().what));
        PrintError(fmt::format("{}\n", error.what()));
      }
    }
    *exit_code = static_cast<int>(!all_compared ? ExitCode::kCannotCompare
                                  : all_match   ? ExitCode::kOk
                                                : ExitCode::kDiffers);
  });
}

}  // namespace nacre
