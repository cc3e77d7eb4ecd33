// SPDX-License-Identifier: Apache-2.0
// cli/cmd_merge.cc: nacre merge: joins the tiles of a picture.
#include <algorithm>
#include <chrono>
#include <memory>

#include <CLI/CLI.hpp>

#include "base/path.h"
#include "base/strip.h"
#include "cli/commands.h"
#include "cli/merge_tiles.h"
#include "cli/outputs.h"
#include "cli/print.h"
#include "cli/progress.h"
#include "image_io/exr_container.h"
#include "image_io/png_writer.h"
#include "output/metadata.h"

namespace nacre {
namespace {

struct MergeArguments {
  std::vector<std::string> tiles;
  std::vector<std::string> outputs;
  DisplaySettings display;
  std::string target = "auto";
  bool small = false;
  bool quiet = false;
};

// The output files, to which tiles are added from the top down.
class MergedFiles {
 public:
  MergedFiles(const MergeArguments& arguments, const ExrBandHeader& whole)
      : whole_(whole), display_(arguments.display) {
    const auto& attributes = whole.header.attributes;
    PngHeader png;
    png.width = whole.header.display.width();
    png.height = whole.header.display.height();
    for (const char* name : {"Software", "nacre:shadowing"}) {
      const auto found = attributes.find(name);
      if (found == attributes.end()) continue;
      // A file not made by nacre may have an attribute of this name, but of another type.
      if (const auto* text = std::get_if<std::string>(&found->second)) png.text[name] = *text;
    }
    png.text["nacre:tonemap"] = ToneOperatorName(display_.tone);
    for (const std::string& path : arguments.outputs) {
      if (HasExtension(path, ".exr")) {
        exr_.push_back(
            std::make_unique<ExrContainer>(path, nullptr, whole.header, whole.compression));
      } else {
        png_.push_back(std::make_unique<PngWriter>(
            path, png,
            PngOptions{.small = arguments.small,
                       .reproducible = !attributes.contains(kRenderTimeAttribute),
                       .sync = true}));
      }
    }
  }

  void Add(const Tile& tile) {
    ExrBandReader reader(tile.path);
    const int chunk_rows = RowsPerChunk(whole_.compression);
    for (int y = tile.rows.y0; !exr_.empty() && y < tile.rows.y1; y += chunk_rows) {
      const std::vector<uint8_t> chunk = reader.ReadChunk(y);
      for (const auto& exr : exr_) exr->WriteChunk(y, chunk);
    }
    if (!png_.empty()) AddToPng(tile.rows, &reader);
  }

  void Finish() {
    if (!png_.empty()) FlushPng();
    // On the disk before they have their names, because the tiles are deleted then.
    for (const auto& exr : exr_) exr->Finish(/*sync=*/true);
    for (const auto& png : png_) png->Finish();
  }

  uint64_t nan_pixels() const { return nan_pixels_; }

 private:
  // PNG strips are counted from the top of the frame; a tile may begin within a strip.
  void AddToPng(const Window& rows, ExrBandReader* reader) {
    const auto row_bytes = 3 * static_cast<size_t>(rows.width());
    for (int y = rows.y0; y < rows.y1;) {
      const int row = y - whole_.header.display.y0;
      const int count = std::min(kStripRows - row % kStripRows, rows.y1 - y);
      reader->ReadRows(y, count, {"R", "G", "B"}, &planes_);
      const size_t filled = rgb8_.size();
      rgb8_.resize(filled + row_bytes * static_cast<size_t>(count));
      nan_pixels_ += EncodeDisplay(display_, planes_[0].data(), planes_[1].data(),
                                   planes_[2].data(), planes_[0].size(), rgb8_.data() + filled);
      y += count;
      if ((row + count) % kStripRows == 0) FlushPng();
    }
  }

  void FlushPng() {
    const auto row_bytes = 3 * static_cast<size_t>(whole_.header.display.width());
    const int rows = static_cast<int>(rgb8_.size() / row_bytes);
    for (const auto& png : png_) {
      if (rows > 0) png->WriteStrip(png_row_, rows, rgb8_.data());
    }
    png_row_ += rows;
    rgb8_.clear();
  }

  const ExrBandHeader& whole_;
  DisplaySettings display_;
  std::vector<std::unique_ptr<ExrContainer>> exr_;
  std::vector<std::unique_ptr<PngWriter>> png_;
  std::vector<std::vector<float>> planes_;
  std::vector<uint8_t> rgb8_;  // the current strip, as far as it is complete
  int png_row_ = 0;            // its first row
  uint64_t nan_pixels_ = 0;
};

void RunMerge(const MergeArguments& arguments) {
  const auto start = std::chrono::steady_clock::now();
  CheckPicturePaths(arguments.outputs);
  std::vector<std::string> paths = arguments.outputs;
  paths.insert(paths.end(), arguments.tiles.begin(), arguments.tiles.end());
  CheckPathsDiffer(paths);
  const TilesOfPicture picture = FindTiles(arguments.tiles);
  for (const std::string& path : picture.unproven) {
    if (arguments.quiet) break;
    PrintError("warning: {} has no checksum; all of it was decoded instead\n", path);
  }
  const auto target = picture.whole.header.attributes.find("nacre:target");
  const bool has_target = target != picture.whole.header.attributes.end();
  const auto* const name = has_target ? std::get_if<std::string>(&target->second) : nullptr;
  ApplyTargetOf(arguments.target, name != nullptr ? *name : "");
  MergedFiles files(arguments, picture.whole);
  {
    Progress progress(arguments.quiet ? ProgressForm::kNone : DefaultProgressForm(), "merging",
                      static_cast<double>(picture.tiles.size()), "tiles");
    for (size_t i = 0; i < picture.tiles.size(); ++i) {
      files.Add(picture.tiles[i]);
      progress.Update(static_cast<double>(i + 1) / static_cast<double>(picture.tiles.size()));
    }
  }
  files.Finish();
  if (files.nan_pixels() > 0) {
    PrintError("warning: {} pixels are not numbers and are drawn in magenta\n", files.nan_pixels());
  }
  if (arguments.quiet) return;
  std::string names;
  for (const std::string& path : arguments.outputs) names += (names.empty() ? "" : ", ") + path;
  const Window& frame = picture.whole.header.display;
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
  PrintError("{}: {}x{} of {} tiles, {:.0f} ms\n", names, frame.width(), frame.height(),
             picture.tiles.size(), 1e3 * elapsed.count());
}

}  // namespace

void AddMergeCommand(CLI::App* app, int*) {
  CLI::App* command = app->add_subcommand("merge", "Put the tiles of a picture together");
  const auto arguments = std::make_shared<MergeArguments>();
  command
      ->add_option("TILE", arguments->tiles, "EXR files of nacre render --tile i/N, in any order")
      ->required();
  command
      ->add_option("-o,--output", arguments->outputs,
                   "File to write, .exr or .png (tone-mapped from the tiles' samples); repeatable")
      ->required()
      ->type_name("FILE")
      ->allow_extra_args(false);
  AddDisplayOptions(command, &arguments->display);
  AddTargetOption(command, &arguments->target)
      ->description("SIMD target that PNG files are made on; auto: that of the tiles");
  command->add_flag("--small", arguments->small,
                    "Smaller PNG files, several times slower to write");
  command->add_flag("--quiet", arguments->quiet, "Print nothing but errors");
  command->footer(
      "The tiles must belong to one picture (scene, settings, SIMD target, build, layers,\n"
      "compression) and hold each of its rows once. Tiles whose checksum is wrong are refused, "
      "all of\n"
      "them by name; those without a checksum are decoded completely. Compressed rows are copied "
      "as\n"
      "they are, so the EXR file has the bits of the picture rendered at once; its render time "
      "is the\n"
      "sum of the tiles'. It is on the disk when the program ends; nacre info --verify reads it "
      "back.\n"
      "PNG files of tiles with --depth float equal those of nacre render; of half-precision tiles\n"
      "some pixels differ by one code.\n"
      "Example:\n"
      "  nacre render scene.json -o 0.exr --tile 0/2\n"
      "  nacre render scene.json -o 1.exr --tile 1/2\n"
      "  nacre merge -o scene.exr -o scene.png 0.exr 1.exr");
  command->callback([arguments] { RunMerge(*arguments); });
}

}  // namespace nacre
