// SPDX-License-Identifier: Apache-2.0
// cli/cmd_validate.cc: nacre validate: renders scenes and compares them with their reference
// images.
#include <memory>

#include "base/error.h"
#include "cli/commands.h"
#include "cli/help_text.h"
#include "cli/outputs.h"
#include "cli/print.h"
#include "cli/references.h"
#include "cli/render_options.h"
#include "cli/report_sections.h"

namespace nacre {
namespace {

struct ValidateArguments {
  std::string folder = "tests/references";
  std::string report;  // path; empty: none
  std::string target = "auto";
  ReferenceOptions references;
};

// Prints a row of the table.
void PrintOutcome(const ReferenceOutcome& outcome) {
  if (!outcome.run) {
    PrintOut("{:<24} ERROR  {}\n", outcome.name, outcome.failure);
    PrintError(outcome.message + "\n");
    return;
  }
  const Verdict& verdict = outcome.run->verdict;
  const LayerMetrics& m = verdict.layers.front();
  PrintOut("{:<24} {:<6} {:>11.3g} {:>11.3g} {:>11.3g} {:>9}  {}\n", outcome.name,
           verdict.match ? "match" : "DIFFER", m.rmse, m.max_rel, m.p999_rel,
           verdict.exceeding_pixels, verdict.match ? outcome.reference.reason : verdict.reason);
}

ExitCode Validate(const ValidateArguments& arguments) {
  ApplyTarget(arguments.target);
  if (!arguments.report.empty()) CheckReportPath(arguments.report);
  constexpr size_t kLimit = size_t{64} << 20;  // bytes of samples, as in nacre report
  PerceptualArguments shown;
  shown.metrics = {"all"};
  Page page;
  ValidationSection section(MakePerceptualOptions(shown),
                            kLimit / FindReferences(arguments.folder).size(), &page);
  PrintOut("{:<24} {:<6} {:>11} {:>11} {:>11} {:>9}  {}\n", "reference", "", "RMSE", "max rel",
           "99.9% rel", "exceed", "tolerance's reason, or what differs");
  bool all_match = true;
  bool all_compared = true;
  RunReferences(arguments.folder, arguments.references, [&](const ReferenceOutcome& outcome) {
    PrintOutcome(outcome);
    all_compared = all_compared && outcome.run;
    all_match = all_match && outcome.run && outcome.run->verdict.match;
    if (arguments.report.empty()) return;
    CheckOutputsAreNoInputs({arguments.report}, outcome.read);
    section.Add(outcome);
  });
  if (!arguments.report.empty()) {
    const auto sections = Json::array({section.ToJson()});
    WriteReport(arguments.report, section.ToJson()["title"], sections, shown, page);
  }
  if (!all_compared) return ExitCode::kCannotCompare;
  return all_match ? ExitCode::kOk : ExitCode::kDiffers;
}

}  // namespace

void AddValidateCommand(CLI::App* app, int* exit_code) {
  CLI::App* command = app->add_subcommand(
      "validate", "Render the scenes of a folder and compare them with reference images");
  const auto a = std::make_shared<ValidateArguments>();
  command->add_option("DIR", a->folder, "Folder with *.reference.json files")
      ->capture_default_str();
  command
      ->add_option("--report", a->report,
                   "Also write an HTML file with all pictures, references and errors")
      ->type_name("OUT.html");
  command
      ->add_option("--threads", a->references.threads,
                   "Number of threads; 0: as many as the machine has")
      ->check(WholeInRange(0, 1024));
  AddTargetOption(command, &a->target);
  command->add_flag("--allow-paths", a->references.allow_paths,
                    "Let references and their scenes name files outside their folder");
  MoveBehindHelpAll(command, {"--threads", "--target", "--allow-paths"});
  command->footer(
      "NAME.reference.json names a scene, its reference image, tolerances and their reason:\n"
      "  {\"scene\": \"ball.json\", \"image\": \"ball.exr\", \"layers\": [\"\"],\n"
      "   \"tolerances\": {\"max_rel\": 1e-5}, \"reason\": \"float shading in the other one\"}\n"
      "Exit code: 0 all match, 1 one differs, 2 one cannot be compared.\n"
      "Examples:\n"
      "  nacre validate\n"
      "  nacre validate my_references --report checks.html");
  command->callback([a, exit_code] { *exit_code = static_cast<int>(Validate(*a)); });
}

}  // namespace nacre
