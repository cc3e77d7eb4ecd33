// SPDX-License-Identifier: Apache-2.0
// image_io/image_file.h: an image file that is open: what it holds, and its samples, read straight
// into the caller's memory. Which format a file has, and how large an image may be, is decided
// here, once for all commands.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "base/image.h"

namespace nacre {

// The bound of every reader. An image may have kFreeSamples samples whatever its file's size (8192
// x 4096 of four channels), more if the file has a byte for every kSamplesPerByte of them, and
// kMaxSamples (16384 x 16384 of four channels) at most. Counted are the samples that are read.
// Deflate packs a thousand zeros into a byte: without the second rule a file of a megabyte would
// take gigabytes. A photograph or a render has 1 to 20 samples a byte, also as JPEG.
inline constexpr uint64_t kFreeSamples = uint64_t{1} << 27;
inline constexpr uint64_t kSamplesPerByte = 64;
inline constexpr uint64_t kMaxSamples = uint64_t{1} << 30;

// Throws Error (kBadInput) if `channels` x `height` x `width` samples are more than a file of
// `file_bytes` may have.
void CheckSampleCount(const std::string& path, uint64_t file_bytes, int64_t width, int64_t height,
                      uint64_t channels);

// For files that are opened a second time to read their samples: throws Error (kBadInput) unless
// `same`, which says that the header still asks for what the caller made room for.
void CheckUnchanged(const std::string& path, bool same);

// Of a file that has been opened. Throws like CheckUnchanged where it has gone since.
uint64_t FileBytes(const std::string& path);

// One of the images that a file holds: EXR files may hold several.
struct ImagePart {
  struct PartChannel {
    std::string name;
    PixelType type = PixelType::kFloat;
    int x_sampling = 1, y_sampling = 1;  // every so many pixels have a sample
  };
  std::string name;  // "" where the format has no names
  Window display, data;
  std::vector<PartChannel> channels;
  std::map<std::string, std::string> metadata;
  std::string refusal;  // why its samples are not read ("is deep"); "" if they are
};

// The only part of a file, of the same channels.
ImagePart PartOf(const Image& header);

// Where the samples of a channel go: that of a region's first pixel to `first`, the next one to
// the right `step_x` further, the one below `step_y` further.
struct SampleTarget {
  size_t channel = 0;  // index in ImageFile::header.channels
  float* first = nullptr;
  ptrdiff_t step_x = 1, step_y = 0;
};

struct ImageFile {
  std::string path;
  uint64_t file_bytes = 0;
  std::vector<ImagePart> parts;  // all that the file has
  bool has_several = false;      // more than one of them is in `header`
  // What Read reads: channels without samples, windows as the image is seen (orientation tags are
  // honoured). Of several parts the channels are called "part.channel", and the data window holds
  // all of theirs; outside of its own, a channel is 0.
  Image header;
  // Reads the channels' samples within `region`, which header.data holds. Throws Error (kBadInput)
  // for what is damaged.
  std::function<void(const Window& region, std::span<const SampleTarget> targets)> read;

  void CheckSize(const Window& region, size_t channels) const {
    CheckSampleCount(path, file_bytes, int64_t{region.x1} - region.x0,
                     int64_t{region.y1} - region.y0, channels);
  }
};

// `part`: the only part of an EXR file to read, whose channels then keep their own names; "": all.
//
// header.metadata["transfer"] says what values mean: "linear", or "display" for formats of integer
// samples, whose values lie in [0, 1] and are those of the file: no transfer curve is undone.
// Throws Error: kBadInput if the file cannot be read, has no such part, or has parts that cannot
// be read (deep, subsampled) and none is chosen; kInternal if OpenImageIO cannot be loaded.
ImageFile OpenImage(const std::string& path, const std::string& part = {});

// All parts of a file, those that cannot be read too.
std::vector<ImagePart> DescribeImage(const std::string& path);

// The whole image in memory, 4 bytes a sample. Throws as OpenImage does, and for damaged samples.
Image ReadImage(const std::string& path, const std::string& part = {});
Image ReadImage(const ImageFile& file);

}  // namespace nacre
