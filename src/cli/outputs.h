// SPDX-License-Identifier: Apache-2.0
// cli/outputs.h: the files of a render: strips in, EXR and PNG files out, whole or not at all.
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
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

// The output that is no file: the picture is rendered, for timing, and written nowhere.
inline constexpr char kNullOutput[] = "null:";

// The outputs that are files.
std::vector<std::string> FilesAmong(const std::vector<std::string>& outputs);

// Throws Error for a path that cannot be written (kCannotWrite) or whose extension is neither
// .exr nor .png (kUsage): before any work is done for it.
void CheckPicturePaths(const std::vector<std::string>& paths);

// The same for a single PNG.
void CheckPngPath(const std::string& path);

// Throws Error (kUsage) if two of the paths, inputs and outputs of a command, are the same file, by
// whatever spelling or link.
void CheckPathsDiffer(const std::vector<std::string>& paths);

// Throws Error (kUsage) if one of the outputs is a file that was read: the scene's own, its
// textures, models and their parts (LoadOptions::on_file). Inputs may be named more than once, and
// may be missing.
void CheckOutputsAreNoInputs(const std::vector<std::string>& outputs,
                             const std::vector<std::string>& inputs);

// The header of the EXR files of a render.
ExrHeader MakeOutputHeader(const RenderOptions& options, const FramePlan& plan,
                           PreparedScene* prepared = nullptr);

// Samples that the files do not hold as they were computed.
struct OutputCounts {
  SampleCounts exr;
  uint64_t nan_pixels = 0;  // drawn magenta in PNG files
};

class Outputs {
 public:
  // Opens all files. What it is given must outlive this. `prepared`: as MakeExrHeader's.
  // `captions`: as RunRenderJob's.
  Outputs(const RenderOptions& options, const FramePlan& plan, PreparedScene* prepared,
          const std::vector<TextItem>& captions);

  // From any thread, in any order.
  void WriteStrip(const Strip& strip);

  // Completes the files and gives them their names.
  OutputCounts Finish(const RenderStats& stats);

 private:
  void WritePng(const Strip& strip);
  void DrawTexts();

  const RenderOptions& options_;
  const FramePlan& plan_;
  const std::vector<TextItem>& captions_;
  DisplaySettings display_;
  std::vector<std::unique_ptr<ExrWriter>> exr_;
  std::vector<std::unique_ptr<PngWriter>> png_;
  // With --labels, the whole picture, which text is drawn into at the end.
  std::vector<uint8_t> picture_;
  std::atomic<uint64_t> nan_pixels_{0};
};

}  // namespace nacre
