// SPDX-License-Identifier: Apache-2.0
// cli/cmd_report.cc: nacre report: writes pictures, comparisons, validations and benchmarks to one
// HTML file.
#include <algorithm>
#include <memory>

#include <CLI/CLI.hpp>

#include "base/error.h"
#include "cli/commands.h"
#include "cli/help_text.h"
#include "cli/outputs.h"
#include "cli/perceptual_options.h"
#include "cli/render_options.h"
#include "cli/report_sections.h"

namespace nacre {
namespace {

struct ReportArguments {
  std::string output;
  std::vector<std::string> inputs;
  std::string reference, part;
  std::string title;
  double limit_mib = 64;
  RenderOptions render;
  PerceptualArguments perceptual;
};

// The pictures of the inputs, each with its stats, and the index of the one that the others are
// compared with.
struct Pictures {
  std::vector<ReportPicture> all;
  size_t reference = 0;
};

Pictures ReadPictures(const ReportArguments& arguments) {
  Pictures pictures;
  std::vector<std::string> paths;
  for (const std::string& path : arguments.inputs) {
    const ReportInput kind = KindOfInput(path);
    if (kind == ReportInput::kImage) {
      pictures.all.push_back(ReadPicture(path, arguments.part));
    } else if (kind == ReportInput::kScene) {
      pictures.all.push_back(RenderPicture(path, arguments.render, arguments.output));
    } else if (kind == ReportInput::kStats) {
      if (pictures.all.empty()) {
        throw Error(ExitCode::kUsage, path, "these are the counts and times of a render",
                    "name them after its picture");
      }
      pictures.all.back().stats = ReadJson(path);
      continue;
    } else {
      continue;
    }
    paths.push_back(path);
  }
  // As in `nacre compare IMAGE REFERENCE`, the second one is the reference.
  pictures.reference = pictures.all.size() > 1 ? 1 : 0;
  if (!arguments.reference.empty()) {
    const auto found = std::find(paths.begin(), paths.end(), arguments.reference);
    if (found == paths.end()) {
      throw Error(ExitCode::kUsage, "--reference",
                  "\"" + arguments.reference + "\" is not one of the pictures",
                  "name it as it is named among the inputs");
    }
    pictures.reference = static_cast<size_t>(found - paths.begin());
  }
  return pictures;
}

std::string DefaultTitle(const Pictures& pictures, const Json& sections) {
  if (pictures.all.size() == 1) return pictures.all[0].name;
  if (pictures.all.size() > 1) {
    return pictures.all[pictures.reference == 0 ? 1 : 0].name + " against " +
           pictures.all[pictures.reference].name;
  }
  return sections[0]["title"];
}

void RunReport(const ReportArguments& arguments) {
  CheckReportPath(arguments.output);
  for (const std::string& input : arguments.inputs) CheckPathsDiffer({arguments.output, input});
  ApplyTarget(arguments.render.target);
  const std::optional<PerceptualOptions> perceptual = MakePerceptualOptions(arguments.perceptual);
  const auto limit = static_cast<size_t>(arguments.limit_mib * 1024 * 1024);
  Page page;
  Json sections = Json::array();
  const Pictures pictures = ReadPictures(arguments);
  if (!pictures.all.empty()) {
    sections.push_back(PictureSection(pictures.all, pictures.reference, perceptual, limit, &page));
  }
  for (const std::string& path : arguments.inputs) {
    const ReportInput kind = KindOfInput(path);
    if (kind == ReportInput::kBench) sections.push_back(BenchSection(path));
    if (kind == ReportInput::kReferences) {
      ValidationSection validation(perceptual, limit / FindReferences(path).size(), &page);
      const ReferenceOptions references{arguments.render.settings.threads,
                                        arguments.render.allow_paths};
      RunReferences(path, references, [&](const ReferenceOutcome& outcome) {
        CheckOutputsAreNoInputs({arguments.output}, outcome.read);
        validation.Add(outcome);
      });
      sections.push_back(validation.ToJson());
    }
  }
  WriteReport(arguments.output,
              arguments.title.empty() ? DefaultTitle(pictures, sections) : arguments.title,
              sections, arguments.perceptual, page);
}

}  // namespace

void AddReportCommand(CLI::App* app, int*) {
  CLI::App* command = app->add_subcommand(
      "report", "Make an HTML page of pictures, comparisons, validations or benchmarks");
  const auto a = std::make_shared<ReportArguments>();
  a->perceptual.metrics = {"all"};
  command->add_option("OUT.html", a->output, "HTML file to write; it needs no other file")
      ->required();
  command
      ->add_option("INPUT", a->inputs,
                   "Images, scenes and models, folders of references, bench.json of scripts/bench; "
                   "scenes and models are rendered, references validated. The JSON of render "
                   "--stats may follow its image")
      ->required();
  command->add_option("--reference", a->reference,
                      "Picture that the others are compared with (the second, if not given)");
  command->add_option("--part", a->part, "Part of EXR files that have several");
  command->add_option("--title", a->title, "Title of the page");
  command
      ->add_option("--limit", a->limit_mib,
                   "Most MiB of samples, before they are compressed. Pictures that have more are "
                   "shown in half precision, then smaller, and the page says so")
      ->check(InRange(0.01, 2048))
      ->capture_default_str();
  AddPerceptualOptions(command, &a->perceptual);
  AddPictureOptions(command, &a->render);
  AddSettingOption(command, SettingNamed("layers"), &a->render)
      ->description("Layers of scenes to render besides R G B A, or all")
      ->group("Picture");
  AddMachineOptions(command, &a->render);
  MoveBehindHelpAll(command, {"--limit"});
  command->footer(
      "The page keeps the pictures' samples, so that it has an exposure slider, nacre's tone\n"
      "operators and the linear values of every pixel. Press ? in it for its keys.\n"
      "Examples:\n"
      "  nacre report look.html scenes/material_grid.json --layers all\n"
      "  nacre report diff.html render.exr reference.exr --ppd 40\n"
      "  nacre report three.html a.exr b.exr truth.exr --reference truth.exr\n"
      "  nacre report checks.html tests/references\n"
      "  nacre report speed.html out/bench/bench.json");
  command->callback([a] { RunReport(*a); });
}

}  // namespace nacre
