// SPDX-License-Identifier: Apache-2.0
// image_io/png_writer.h: 8-bit RGB PNG files written strip by strip while the picture is being
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
  bool small = false;         // zlib's best instead of ISA-L: a quarter smaller, many times slower
  bool reproducible = false;  // equal pictures make equal files, some times slower
  bool sync = false;          // Finish returns when the file has reached the disk
};

// A file of sRGB codes, tagged as such. Strips are filtered and deflated, each by itself, in the
// threads that bring them, and written in order. All functions throw Error: kCannotWrite when the
// file cannot be written, kInternal when they are called wrongly.
class PngWriter {
 public:
  // Opens the file and writes its header: call before rendering.
  PngWriter(const std::string& path, const PngHeader& header, const PngOptions& options = {});
  // The same bytes to the end of `bytes`, and to no file.
  PngWriter(std::vector<uint8_t>* bytes, const PngHeader& header, const PngOptions& options = {});
  // Without Finish, nothing remains of the file.
  ~PngWriter();

  // kStripRows rows from row `y` on (a multiple of kStripRows; the top row is 0): rows * width
  // pixels of three bytes. Each strip once, in any order, from any thread, several at once.
  void WriteStrip(int y, int rows, const uint8_t* rgb8);

  // All strips of a picture that is there, in several threads: its codes; or encode(first, count,
  // rgb8), which makes those of `count` pixels from pixel `first` on, counted row by row.
  void WriteAll(std::span<const uint8_t> rgb8);
  void WriteAll(const std::function<void(size_t first, size_t count, uint8_t* rgb8)>& encode);

  // After the last strip has been written: adds text that is only known at the end, such as the
  // render time, and the file appears.
  void Finish(const PngText& text = {});

 private:
  struct State;
  std::unique_ptr<State> state_;
};

// A file of the picture that says what made it.
void WritePng(const std::string& path, const Rgb8Picture& picture, const PngOptions& options = {});

// The bytes of that file. Throws Error (kInternal) for a picture without pixels, or one that is
// wider than PNG allows.
std::vector<uint8_t> EncodePng(const Rgb8Picture& picture, const PngOptions& options = {});

}  // namespace nacre
