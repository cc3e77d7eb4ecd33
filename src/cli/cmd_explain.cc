// SPDX-License-Identifier: Apache-2.0
// cli/cmd_explain.cc: nacre explain TOPIC: explains a part of nacre, with numbers that it measures
// at that moment.
#include <filesystem>
#include <memory>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "base/error.h"
#include "cli/commands.h"
#include "cli/help_text.h"
#include "cli/outputs.h"
#include "cli/print.h"
#include "cli/progress.h"
#include "lesson/fault_entries.h"
#include "lesson/page.h"
#include "lesson/scenes.h"

namespace nacre {
namespace {

namespace fs = std::filesystem;

struct Sheet {
  std::string file;
  TextbookSheet layout;
  const CodedPicture& lesson;
  Scene (*scene)();
};

void PrintEntry(const FaultEntry& entry, const LessonPictures& lesson) {
  std::string text = fmt::format("{:<4} {}\n", entry.id, entry.title);
  const auto line = [&](std::string_view name, std::string_view words) {
    text += fmt::format("     {:<7} {}\n", name, WrapWordsAt(std::string(words), 13, 13, 100));
  };
  line("lesson", entry.lesson);
  line("right", entry.right);
  line("nacre", entry.nacre);
  std::string_view name = "amount";
  for (const std::string& words : entry.amount(lesson)) {
    line(name, words);
    name = "";
  }
  PrintOut(text + "\n");
}

void PrintFaults(const LessonPictures& lesson) {
  PrintOut(
      "The founding lesson's program, fault by fault.\n\n"
      "Amounts are measured now: each fault is switched off alone in the lesson's two pictures,\n"
      "\"comparison\" (400x200) and \"grid\" (600x400), and 8-bit codes compared on their "
      "spheres;\n"
      "or they come from quadrature, or from the formula. Some faults are other founding\n"
      "documents': doc1 on interpolation, doc2 shading notes, doc3 slides on lighting.\n\n");
  for (const FaultEntry& entry : FaultEntries()) {
    ThrowIfStopped();
    PrintEntry(entry, lesson);
  }
  const TextbookFaults none = NoFaults();
  PrintOut("all  the lesson's program without any of its faults\n");
  for (const std::string& line : ChangeLines(lesson, none)) PrintOut("     " + line + "\n");
}

// The paths of the pictures in `folder`, which is created if necessary. Throws Error for paths that
// cannot be written, before anything is rendered.
std::vector<std::string> PrepareFolder(const std::string& folder,
                                       const std::vector<Sheet>& sheets) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) {
    throw Error(ExitCode::kCannotWrite, folder, error.message(),
                "--output-dir names the folder that the pictures go to");
  }
  std::vector<std::string> paths;
  paths.reserve(sheets.size());
  for (const Sheet& sheet : sheets) paths.push_back((fs::path(folder) / sheet.file).string());
  for (const std::string& path : paths) CheckPngPath(path);
  return paths;
}

void ExplainTextbook(const std::string& folder) {
  const LessonPictures lesson = RenderLesson({});
  const std::vector<Sheet> sheets = {
      // The whole scene, and its sphere magnified four times.
      {"phong_vs_pbr.png",
       {"Phong (left half) against PBR (right half)",
        {{Window{0, 0, 400, 200}, 1}, {Window{150, 50, 250, 150}, 4}}},
       lesson.comparison,
       TextbookComparisonScene},
      {"material_grid.png",
       {"Roughness 0.1 to 0.9 downwards, metallic 0 to 1 to the right",
        {{Window{0, 0, 600, 400}, 1}}},
       lesson.grid,
       TextbookGridScene},
  };
  std::vector<std::string> paths;
  if (!folder.empty()) paths = PrepareFolder(folder, sheets);
  PrintFaults(lesson);
  PrintOut("\nAgainst nacre's own renderer, with real spheres and light that falls off\n");
  for (size_t i = 0; i < sheets.size(); ++i) {
    const Sheet& sheet = sheets[i];
    const AccuratePicture accurate =
        RenderAccurate(sheet.scene(), [](double) { ThrowIfStopped(); });
    PrintOut("     {}: {}\n", fs::path(sheet.file).stem().string(),
             ChangeText(MeasureChange(sheet.lesson.codes, accurate.shown.rgb8,
                                      sheet.lesson.picture.sphere, accurate.sphere)));
    if (paths.empty()) continue;
    WriteTextbookSheet(paths[i], sheet.layout, sheet.lesson, accurate);
    NoteWritten(paths[i]);
    PrintError("{}: the lesson, nacre, and the difference\n", paths[i]);
  }
}

}  // namespace

void AddExplainCommand(CLI::App* app, int*) {
  CLI::App* command = app->add_subcommand("explain", "Explain a topic, with measured numbers");
  struct ExplainArguments {
    std::string topic;
    std::string folder;
  };
  const auto arguments = std::make_shared<ExplainArguments>();
  command
      ->add_option("TOPIC", arguments->topic,
                   "textbook: the faults of the founding lesson's shading program, each with what "
                   "is right, what nacre does, and how much it changes the lesson's pictures")
      ->required();
  command
      ->add_option("-o,--output-dir", arguments->folder,
                   "Also write phong_vs_pbr.png and material_grid.png into this folder: the "
                   "lesson's picture, nacre's of the same set-up, and a heat map of the difference")
      ->type_name("DIR");
  command->footer(
      "Examples:\n"
      "  nacre explain textbook\n"
      "  nacre explain textbook -o out/textbook\n"
      "See also:\n"
      "  nacre render scenes/phong_vs_pbr.json --preset textbook -o lesson.png\n"
      "  scenes/textbook/*.json: the lesson's set-ups for nacre's own renderer");
  command->callback([arguments] {
    if (arguments->topic != "textbook") {
      throw Error(ExitCode::kUsage, "", fmt::format("unknown topic \"{}\"", arguments->topic),
                  NearestHint(arguments->topic, {"textbook"}, "the only topic is textbook"));
    }
    ExplainTextbook(arguments->folder);
  });
}

}  // namespace nacre
