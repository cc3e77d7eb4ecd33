// SPDX-License-Identifier: Apache-2.0
// cli/outputs.h: writes the strips of a render to EXR and PNG files, which appear completely or not
// at all.
#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <vector>

#include "cli/render_options.h"
#include "image_io/draw_text.h"
#include "image_io/exr_writer.h"
#include "image_io/png_writer.h"
#include "render/film.h"
#include "render/frame_plan.h"
#include "render/stats.h"

namespace nacre {

// The output that is not a file: the picture is rendered for timing, but not written.
inline constexpr char kNullOutput[] = "null:";

// The outputs that are files.
std::vector<std::string> FilesAmong(const std::vector<std::string>& outputs);

// Throws Error for a path that cannot be written (kCannotWrite) or whose extension is neither .exr
// nor .png (kUsage). To be called before any work is done.
void CheckPicturePaths(const std::vector<std::string>& paths);

// Throws Error for a path that cannot be written (kCannotWrite) or does not end in .png (kUsage).
void CheckPngPath(const std::string& path);

// Throws Error (kUsage) if two of the paths, inputs and outputs of a command, are the same file,
// even if they are spelled differently or are links.
void CheckPathsDiffer(const std::vector<std::string>& paths);

// Throws Error (kUsage) if one of the outputs is a file that was read: the scene file, its
// textures, models and their parts (LoadOptions::on_file). Inputs may be repeated, and may be
// missing.
void CheckOutputsAreNoInputs(const std::vector<std::string>& outputs,
                             const std::vector<std::string>& inputs);

// The header of the EXR files of a render.
ExrHeader MakeOutputHeader(const RenderOptions& options, const FramePlan& plan,
                           PreparedScene* prepared = nullptr);

// Counts of samples that the files do not hold exactly.
struct OutputCounts {
  SampleCounts exr;
  uint64_t nan_pixels = 0;  // shown as magenta in PNG files
};

class Outputs {
 public:
  // Opens all files. The arguments must outlive this object. `prepared` is as for MakeExrHeader,
  // `captions` as for RunRenderJob.
  Outputs(const RenderOptions& options, const FramePlan& plan, PreparedScene* prepared,
          const std::vector<TextItem>& captions);

  // May be called from any thread, in any order.
  void WriteStrip(const Strip& strip);

  // Completes the files and gives them their names.
  OutputCounts Finish(const RenderStats& stats);

 private:
  void WritePng(const Strip& strip);
  void DrawTexts();

  const RenderOptions& options_;
  const FramePlan& plan_;
  const std::vector<TextItem>& captions_;
  std::vector<std::unique_ptr<ExrWriter>> exr_;
  std::vector<std::unique_ptr<PngWriter>> png_;
  // With --labels: the whole picture, since text is drawn into it at the end.
  std::vector<uint8_t> picture_;
  std::atomic<uint64_t> nan_pixels_{0};
};

}  // namespace nacre
