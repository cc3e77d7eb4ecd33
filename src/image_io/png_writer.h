// SPDX-License-Identifier: Apache-2.0
// image_io/png_writer.h: writes 8-bit RGB PNG files strip by strip while the picture is being
// rendered.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/picture.h"
#include "base/strip.h"

namespace nacre {

// Text chunks by keyword (1 to 79 printable ASCII characters). Values are UTF-8.
using PngText = std::map<std::string, std::string>;

struct PngHeader {
  int width = 0;  // both at least 1
  int height = 0;
  PngText text;
};

struct PngOptions {
  bool small = false;         // zlib's best level instead of ISA-L: a quarter smaller, but many
                              // times slower
  bool reproducible = false;  // equal pictures make equal files, which is slower
  bool sync = false;          // Finish returns only when the file has reached the disk
};

// Writes a file of sRGB codes, tagged as such. Each strip is filtered and deflated independently in
// the thread that brings it; strips are written in order. All functions throw Error: kCannotWrite
// when the file cannot be written, kInternal when they are called wrongly.
class PngWriter {
 public:
  // Opens the file and writes its header; to be called before rendering, to find errors early.
  PngWriter(const std::string& path, const PngHeader& header, const PngOptions& options = {});
  // Appends the file to `bytes` instead of writing it to disk.
  PngWriter(std::vector<uint8_t>* bytes, const PngHeader& header, const PngOptions& options = {});
  // If Finish was not called, no file remains.
  ~PngWriter();

  // Adds a strip of kStripRows rows, in the last strip perhaps fewer, from row `y` on, which is a
  // multiple of kStripRows, 0 at the top: rows * width pixels of three bytes. Each strip must come
  // once, in any order, from any thread; calls may be concurrent.
  void WriteStrip(int y, int rows, const uint8_t* rgb8);

  // Writes all strips of a complete picture, on several threads. The codes are given in `rgb8`, or
  // by encode(first, count, rgb8), which writes those of `count` pixels from pixel `first` on,
  // counted row by row.
  void WriteAll(std::span<const uint8_t> rgb8);
  void WriteAll(const std::function<void(size_t first, size_t count, uint8_t* rgb8)>& encode);

  // To be called after the last strip has been written. Adds text that is known only at the end,
  // such as the render time; then the file appears under its name.
  void Finish(const PngText& text = {});

 private:
  struct State;
  std::unique_ptr<State> state_;
};

// Writes the picture to a file, tagged with the software that made it.
void WritePng(const std::string& path, const Rgb8Picture& picture, const PngOptions& options = {});

// The bytes of such a file. Throws Error (kInternal) for a picture without pixels, or one that is
// wider than PNG allows.
std::vector<uint8_t> EncodePng(const Rgb8Picture& picture, const PngOptions& options = {});

}  // namespace nacre
