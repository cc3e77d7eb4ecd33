// SPDX-License-Identifier: Apache-2.0
// image_io/exr_writer.h: EXR files written strip by strip while the picture is being rendered.
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
  bool reproducible = false;  // ZIP and ZIPS: equal pictures make equal chunks, some times slower
  bool sync = false;          // Finish returns when the file has reached the disk
};

// A single-part scanline file. Strips are compressed in the threads that bring them and written
// in order. All functions throw Error: kCannotWrite when the file cannot be written, kInternal
// when they are called wrongly.
class ExrWriter {
 public:
  // Opens the file and writes its header: call before rendering.
  ExrWriter(const std::string& path, const ExrHeader& header, const ExrOptions& options = {});
  // The same bytes into `bytes`, which is empty, and into no file.
  ExrWriter(std::vector<uint8_t>* bytes, const ExrHeader& header, const ExrOptions& options = {});
  // Without Finish, nothing remains of the file.
  ~ExrWriter();

  // Strips of kStripRows rows counted from the data window's top, each once, in any order, from
  // any thread, several at once.
  void WriteStrip(const StripView& strip);

  // All strips of a picture that is there, in several threads: a plane for each channel.
  void WriteAll(const std::vector<const float*>& planes);

  // Gives an attribute of ExrHeader::attributes another value of the same type, int or float:
  // for what is only known at the end, such as the render time.
  void UpdateAttribute(const std::string& name, const ExrAttribute& value);

  // After the last strip has been written: the file appears.
  void Finish();

  // Samples so far that the file does not hold as computed, or that should not exist.
  SampleCounts counts() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace nacre
