// SPDX-License-Identifier: Apache-2.0
// cli/cmd_study.cc: nacre study: answers the lesson's exercises, and questions about materials,
// with a folder of pictures, diagrams, numbers and explanations.
#include <cmath>
#include <filesystem>
#include <memory>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/error.h"
#include "base/version.h"
#include "cli/commands.h"
#include "cli/print.h"
#include "cli/progress.h"
#include "image_io/output_file.h"
#include "image_io/png_writer.h"
#include "report/plot.h"
#include "study/study.h"

namespace nacre {
namespace {

namespace fs = std::filesystem;

struct StudyArguments {
  std::string name;
  std::string folder;
  bool quiet = false;
};

std::string NumbersCsv(const StudyResult& result) {
  std::string text = "quantity,value,unit\n";
  for (const StudyNumber& number : result.numbers) {
    text += fmt::format("{},{},{}\n", CsvText(number.quantity),
                        std::isfinite(number.value) ? fmt::format("{}", number.value) : "",
                        number.unit);
  }
  return text;
}

std::string AnswerText(const StudyEntry& study, const StudyResult& result) {
  std::string text =
      fmt::format("# {}\n\n> {}\n\n{}\n", study.title, study.question, result.answer);
  for (const StudyPicture& picture : result.pictures) {
    text += fmt::format("\n![{}]({}.png)\n\n{}\n", picture.name, picture.name, picture.caption);
  }
  for (const StudyFigure& figure : result.figures) {
    text +=
        fmt::format("\n![{0}]({0}.svg)\n\n{1} ([numbers]({0}.csv))\n", figure.name, figure.caption);
  }
  return text + fmt::format(
                    "\nAll numbers: [numbers.csv](numbers.csv). Computed by `nacre study "
                    "{}`, nacre {}.\n",
                    study.name, kVersion);
}

// Creates the folder, and checks that files can be written there, before anything is computed.
void PrepareFolder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) {
    throw Error(ExitCode::kCannotWrite, folder.string(), error.message(),
                "--output-dir names the folder that the study goes to");
  }
  CheckWritable((folder / "answer.md").string());
}

void WriteNoted(const fs::path& path, const std::string& text) {
  WriteText(path.string(), text);
  NoteWritten(path.string());
}

void RunStudy(const StudyEntry& study, const fs::path& folder, bool quiet) {
  const StudyResult result = [&] {
    Progress progress(quiet ? ProgressForm::kNone : DefaultProgressForm(), study.name, 0, "");
    return study.run([&](double done) { progress.Update(done); });
  }();
  for (const StudyPicture& picture : result.pictures) {
    const std::string path = (folder / (picture.name + ".png")).string();
    WritePng(path, picture.picture);
    NoteWritten(path);
  }
  for (const StudyFigure& figure : result.figures) {
    for (const char* extension : {".svg", ".png", ".csv"}) {
      ThrowIfStopped();
      const std::string path = (folder / (figure.name + extension)).string();
      WriteFigure(path, figure.figure);
      NoteWritten(path);
    }
  }
  WriteNoted(folder / "numbers.csv", NumbersCsv(result));
  WriteNoted(folder / "answer.md", AnswerText(study, result));
  if (!quiet) PrintError("{}\n", (folder / "answer.md").string());
}

void RunAll(const fs::path& folder, bool quiet) {
  std::string index = "# Studies\n\n";
  for (const StudyEntry& study : Studies()) PrepareFolder(folder / study.name);
  for (const StudyEntry& study : Studies()) {
    RunStudy(study, folder / study.name, quiet);
    index += fmt::format("- [{}]({}/answer.md): {}\n", study.title, study.name, study.question);
  }
  WriteNoted(folder / "index.md", index);
  if (!quiet) PrintError("{}\n", (folder / "index.md").string());
}

const StudyEntry& FindStudy(const std::string& name) {
  std::vector<std::string> names = {"all", "list"};
  for (const StudyEntry& study : Studies()) {
    if (name == study.name) return study;
    names.emplace_back(study.name);
  }
  throw Error(ExitCode::kUsage, "", fmt::format("unknown study \"{}\"", name),
              NearestHint(name, names, fmt::format("the studies are {}", fmt::join(names, ", "))));
}

void Run(const StudyArguments& arguments) {
  if (arguments.name == "list") {
    for (const StudyEntry& study : Studies()) {
      PrintOut("{:<16}{}\n                {}\n", study.name, study.title, study.question);
    }
    return;
  }
  const StudyEntry* const study = arguments.name == "all" ? nullptr : &FindStudy(arguments.name);
  if (arguments.folder.empty()) {
    throw Error(ExitCode::kUsage, "-o", "a study needs a folder for its files",
                fmt::format("nacre study {0} -o out/{0}", arguments.name));
  }
  CheckPlotter();
  const fs::path folder = arguments.folder;
  if (study == nullptr) return RunAll(folder, arguments.quiet);
  PrepareFolder(folder);
  RunStudy(*study, folder, arguments.quiet);
}

}  // namespace

void AddStudyCommand(CLI::App* app, int*) {
  CLI::App* command = app->add_subcommand(
      "study",
      "Answer an exercise of the founding lesson, or a question about materials, with pictures, "
      "curves and numbers");
  const auto arguments = std::make_shared<StudyArguments>();
  std::string names;
  for (const StudyEntry& study : Studies()) names += fmt::format("{}, ", study.name);
  command->add_option("NAME", arguments->name, names + "all, or list to see what each asks")
      ->required();
  command
      ->add_option(
          "-o,--output-dir", arguments->folder,
          "Folder for answer.md, numbers.csv, pictures (PNG) and diagrams (SVG, PNG, CSV); "
          "of all, one folder each and index.md")
      ->type_name("DIR");
  command->add_flag("--quiet", arguments->quiet, "Print nothing but errors");
  command->footer(
      "Every number is computed when the study runs. See also nacre plot.\n"
      "Examples:\n"
      "  nacre study list\n"
      "  nacre study interpolation -o out/interpolation\n"
      "  nacre study all -o out/studies");
  command->callback([arguments] { Run(*arguments); });
}

}  // namespace nacre
