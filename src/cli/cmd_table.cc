// SPDX-License-Identifier: Apache-2.0
// cli/cmd_table.cc: nacre table: the BRDF of a material as a table, and what differs in the table
// of another program.
#include <algorithm>
#include <memory>
#include <set>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/error.h"
#include "cli/commands.h"
#include "cli/given_material.h"
#include "cli/help_text.h"
#include "cli/outputs.h"
#include "cli/print.h"
#include "cli/progress.h"
#include "cli/render_options.h"
#include "cli/usage_error.h"
#include "image_io/output_file.h"
#include "scene_io/load_scene.h"
#include "scene_io/sheet_axis.h"
#include "table/brdf_table.h"
#include "table/check_table.h"
#include "table/read_table.h"
#include "table/write_table.h"

namespace nacre {
namespace {

struct TableArguments {
  std::string material;
  std::string scene;
  bool allow_paths = false;
  std::vector<std::string> outputs;
  DirectionGrid grid;
  std::string directions;  // a file; empty: the grid
  bool no_albedo = false;
  std::string check;  // a file; empty: a table is written
  double tolerance = kDefaultTableTolerance;
  bool json = false;
};

// ---- The material -------------------------------------------------------------------------------

Material MaterialOfScene(const TableArguments& a, const std::vector<std::string>& outputs) {
  LoadOptions options;
  options.allow_paths = a.allow_paths;
  std::vector<std::string> read = {a.scene};
  options.on_file = [&](const std::filesystem::path& file) { read.push_back(file.string()); };
  const Scene scene = LoadScene(a.scene, options);
  CheckOutputsAreNoInputs(outputs, read);
  const auto at = std::ranges::find(scene.materials, a.material, &Material::name);
  if (at != scene.materials.end()) return *at;
  const std::vector<std::string> names = NamesOf(scene.materials);
  throw Error(ExitCode::kBadInput, a.scene, fmt::format("has no material \"{}\"", a.material),
              NearestHint(a.material, names, fmt::format("it has {}", fmt::join(names, ", "))));
}

Material ReadMaterial(const TableArguments& a, const std::vector<std::string>& outputs) {
  Material material;
  if (!a.scene.empty()) {
    material = MaterialOfScene(a, outputs);
  } else {
    Json json = ParseMaterialText("MATERIAL", a.material);
    json.erase("name");
    material = LoadGivenMaterial(json, "MATERIAL");
  }
  if (!std::holds_alternative<SplitMaterial>(material.model)) return material;
  throw Error(ExitCode::kBadInput, a.material, "a split has no reflection model of its own",
              "name one of its materials");
}

// ---- Writing ------------------------------------------------------------------------------------

std::vector<DirectionPair> ChosenPairs(const TableArguments& a) {
  if (!a.directions.empty()) {
    std::vector<std::string> notes;
    std::vector<DirectionPair> pairs = DirectionsOf(ReadTable(a.directions), a.directions, &notes);
    for (const std::string& note : notes) PrintError("note: {}: {}\n", a.directions, note);
    return pairs;
  }
  const size_t rows = a.grid.light_deg.size() * a.grid.view_deg.size() * a.grid.phi_deg.size();
  if (rows > kMostTableRows) {
    throw Error(ExitCode::kUsage, "nacre table", fmt::format("the grid has {} rows", rows),
                fmt::format("up to {} are possible", kMostTableRows));
  }
  return PairsOf(a.grid);
}

// The most views at which the albedo is integrated.
constexpr size_t kMostViews = 256;

bool WithAlbedo(const TableArguments& a, const std::vector<DirectionPair>& pairs) {
  if (a.no_albedo) return false;
  std::set<double> views;
  for (const DirectionPair& pair : pairs) views.insert(pair.to_view.z);
  if (views.size() <= kMostViews) return true;
  PrintError("note: the albedo is left out: it is integrated at up to {} views, and these are {}\n",
             kMostViews, views.size());
  return false;
}

// Non-finite values are written as they are, and told.
void TellNotFinite(const BrdfTable& table) {
  const std::vector<size_t> rows = RowsNotFinite(table);
  if (rows.empty()) return;
  PrintError("warning: {} of {} rows hold values that are not finite, the first is row {}\n",
             rows.size(), table.rows(), rows.front() + 1);
}

void WriteTables(const TableArguments& a) {
  std::vector<std::string> files;
  for (const std::string& path : a.outputs) {
    if (path == "-") continue;
    for (const std::string& file : FilesOfTable(path)) files.push_back(file);
  }
  for (const std::string& file : files) CheckWritable(file);
  CheckPathsDiffer(files);
  CheckOutputsAreNoInputs(files, {a.scene, a.directions});
  const Material material = ReadMaterial(a, files);
  const std::vector<DirectionPair> pairs = ChosenPairs(a);
  TableOptions options;
  options.albedo = WithAlbedo(a, pairs);
  Progress progress(DefaultProgressForm(), "table", 0, "");
  options.on_progress = [&](double done) { progress.Update(done); };
  BrdfTable table = TabulateBrdf(material, pairs, options);
  TellNotFinite(table);
  for (const std::string& path : a.outputs) {
    if (path == "-") continue;
    ThrowIfStopped();
    WriteTable(table, path);
    NoteWritten(path);
  }
  const bool prints =
      a.outputs.empty() || std::ranges::find(a.outputs, "-") != a.outputs.end() || a.json;
  if (prints) PrintOut(a.json ? TableJsonText(table) : CsvOf(table));
}

// ---- Checking -----------------------------------------------------------------------------------

int CheckTheirs(const TableArguments& a) {
  const Material material = ReadMaterial(a, {});
  Progress progress(DefaultProgressForm(), "check", 0, "");
  TableCheck check;
  try {
    check = CheckTable(material, ReadTable(a.check), a.check, a.tolerance,
                       [&](double done) { progress.Update(done); });
  } catch (const Error& error) {
    // As `nacre compare`: what cannot be read cannot be compared.
    if (error.code() != ExitCode::kBadInput) throw;
    throw Error(ExitCode::kCannotCompare, error.faults());
  }
  PrintOut(a.json ? JsonText(CheckJson(check), 2) + "\n" : PageOf(check));
  return static_cast<int>(check.ok ? ExitCode::kOk : ExitCode::kDiffers);
}

void RefuseWhatCannotApply(const TableArguments& a, const CLI::App& command) {
  const std::set<std::string> writes = {"--output",   "--theta-light", "--theta-view", "--phi",
                                        "--phi-view", "--directions",  "--no-albedo"};
  if (!a.check.empty()) {
    RefuseOptions(
        command, [&](const CLI::Option& option) { return !writes.contains(option.get_name()); },
        "--check", "the other program's table has the directions, and the result is printed");
    return;
  }
  RefuseOptions(
      command, [](const CLI::Option& option) { return option.get_name() != "--tolerance"; },
      "nacre table without --check", "--check FILE compares the table of another program");
  if (a.directions.empty()) return;
  RefuseOptions(
      command,
      [](const CLI::Option& option) {
        const std::string name = option.get_name();
        return !name.starts_with("--theta") && !name.starts_with("--phi");
      },
      "--directions", "the file has all pairs of directions");
}

void AddGridOptions(CLI::App* command, TableArguments* a) {
  const auto add = [&](const char* name, std::vector<double>* degrees, const char* meaning) {
    command->add_option(name, *degrees, meaning)
        ->delimiter(',')
        ->allow_extra_args(false)
        ->type_name("DEGREES")
        ->capture_default_str();
  };
  add("--theta-light", &a->grid.light_deg, "Angles of the light from the normal");
  command->get_option("--theta-light")->check(InRange(0, 90));
  add("--theta-view", &a->grid.view_deg, "Angles of the view from the normal");
  command->get_option("--theta-view")->check(InRange(0, 90));
  add("--phi", &a->grid.phi_deg,
      "Azimuths of the light, counted from the view; 180 is the mirror's side");
  command->get_option("--phi")->check(InRange(-360, 360));
  command
      ->add_option("--phi-view", a->grid.view_phi_deg,
                   "Azimuth of the view, counted from the tangent")
      ->type_name("DEGREES")
      ->check(InRange(-360, 360))
      ->capture_default_str();
}

}  // namespace

void AddTableCommand(CLI::App* app, int* exit_code) {
  CLI::App* command = app->add_subcommand(
      "table", "Write a material's BRDF as a table, or tell what is wrong with another program's");
  const auto a = std::make_shared<TableArguments>();
  command
      ->add_option(
          "MATERIAL", a->material,
          "A model's name, a material as JSON, FILE.mtlx#NAME of a MaterialX document, or with "
          "--scene a name in it")
      ->required();
  command
      ->add_option("-o,--output", a->outputs,
                   "File to write, repeatable: .csv, .json or .npy; - is standard output, as CSV "
                   "(if not given, -)")
      ->type_name("FILE")
      ->allow_extra_args(false);
  command
      ->add_option("--check", a->check,
                   "Compare with a table of another program: .csv, .json or .npy with columns "
                   "light_x ... view_z and f_r, f_g, f_b; also, if it has them, pdf, albedo and "
                   "lobes")
      ->type_name("FILE");
  command
      ->add_option("--tolerance", a->tolerance,
                   "The largest difference that is right, relative to the larger of both values")
      ->check(InRange(0, 1))
      ->capture_default_str();
  command
      ->add_option("--directions", a->directions,
                   "Pairs of directions, in place of the grid: .csv, .json or .npy with columns "
                   "light_x, light_y, light_z, view_x, view_y, view_z")
      ->type_name("FILE");
  AddGridOptions(command, a.get());
  command->add_flag("--no-albedo", a->no_albedo, "Leave out the albedo, which takes longest");
  command->add_option("--scene", a->scene, "Scene or model that has the material")
      ->type_name("FILE");
  command->add_flag("--allow-paths", a->allow_paths,
                    "Let the scene refer to files outside its own folder");
  command->add_flag("--json", a->json, "Print the table, or the result of --check, as JSON");
  MoveBehindHelpAll(command, {"--phi-view", "--no-albedo", "--allow-paths"});
  command->footer(
      "f is the BRDF, radiance per irradiance in 1/sr, without n.l; directions are unit vectors\n"
      "from the surface, +z the normal, +x the tangent; colours are linear Rec. 709. Columns:\n"
      "directions, f, what each lobe contributes to it, pdf, albedo. Comments in the file have\n"
      "every parameter and option; a .npy file has them in FILE.npy.json.\n"
      "--check prints where and by how much the other program differs, which mistake explains\n"
      "that (each is tried: factors, n.l, alpha for roughness, swapped axes, ...), and which\n"
      "options or rules come nearest. Exit code: 0 they agree, 1 they differ, 2 they cannot be\n"
      "compared.\n"
      "Examples:\n"
      "  nacre table open_pbr -o nacre.csv\n"
      "  nacre table '{\"model\": \"open_pbr\", \"rules\": \"materialx\", \"coat_weight\": 1}' -o "
      "coat.npy\n"
      "  nacre table red --scene scenes/first_scene.json --theta-light 0,45,80 -o -\n"
      "  nacre table open_pbr --directions mine.csv -o there.csv\n"
      "  nacre table open_pbr --check theirs.csv --tolerance 0.01");
  command->callback([a, command, exit_code] {
    RefuseWhatCannotApply(*a, *command);
    if (a->check.empty()) {
      WriteTables(*a);
    } else {
      *exit_code = CheckTheirs(*a);
    }
  });
}

}  // namespace nacre
