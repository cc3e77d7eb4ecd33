// SPDX-License-Identifier: Apache-2.0
// image_io/exr_writer.h: writes EXR files strip by strip while the picture is being rendered.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "base/strip.h"
#include "image_io/exr_compression.h"
#include "image_io/exr_header.h"
#include "image_io/exr_rows.h"
#include "image_io/half.h"

namespace nacre {

struct ExrOptions {
  Compression compression = Compression::kZip;
  bool small = false;         // ZIP and ZIPS: smaller and several times slower
  bool reproducible = false;  // ZIP and ZIPS: equal pictures make equal chunks, which is slower
  bool sync = false;          // Finish returns only when the file has reached the disk
};

// Writes a single-part scanline file. Strips are compressed in the threads that bring them, and
// written in order. All functions throw Error: kCannotWrite when the file cannot be written,
// kInternal when they are called wrongly.
class ExrWriter {
 public:
  // Opens the file and writes its header; to be called before rendering, to find errors early.
  ExrWriter(const std::string& path, const ExrHeader& header, const ExrOptions& options = {});
  // Writes the file to `bytes`, which must be empty, instead of to disk.
  ExrWriter(std::vector<uint8_t>* bytes, const ExrHeader& header, const ExrOptions& options = {});
  // If Finish was not called, no file remains.
  ~ExrWriter();

  // Adds a strip: kStripRows rows, counted from the top of the data window, in the last strip
  // perhaps fewer. Each strip must come once, in any order, from any thread; calls may be
  // concurrent.
  void WriteStrip(const StripView& strip);

  // Writes all strips of a complete picture, on several threads. There is a plane for each channel.
  void WriteAll(const std::vector<const float*>& planes);

  // Changes the value of an attribute in ExrHeader::attributes, keeping its type, int or float. For
  // values that are known only at the end, such as the render time.
  void UpdateAttribute(const std::string& name, const ExrAttribute& value);

  // To be called after the last strip has been written. Then the file appears under its name.
  void Finish();

  // The number of samples so far that the file does not hold exactly, or that are not finite.
  SampleCounts counts() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace nacre
