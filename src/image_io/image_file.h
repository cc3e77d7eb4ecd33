// SPDX-License-Identifier: Apache-2.0
// image_io/image_file.h: an open image file: its contents, and its samples, which are read directly
// into the caller's memory. The limit on the size of images of all formats is defined here.
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

// The limit of all readers, on the number of samples that are read. An image may have kFreeSamples
// samples whatever its file's size (8192 x 4096 with four channels), more if the file has a byte
// for every kSamplesPerByte of them, and kMaxSamples (16384 x 16384 with four channels) at most.
// Deflate packs a thousand zeros into a byte: without the second rule, a file of a megabyte would
// take gigabytes of memory. A photograph or a render has 1 to 20 samples per byte, also as JPEG.
inline constexpr uint64_t kFreeSamples = uint64_t{1} << 27;
inline constexpr uint64_t kSamplesPerByte = 64;
inline constexpr uint64_t kMaxSamples = uint64_t{1} << 30;

// Throws Error (kBadInput) if `channels` x `height` x `width` samples are more than the limit
// allows for a file of `file_bytes`.
void CheckSampleCount(const std::string& path, uint64_t file_bytes, int64_t width, int64_t height,
                      uint64_t channels);

// The error of files that cannot be read (kBadInput).
[[noreturn]] void FailToRead(const std::string& path, const std::string& reason);

// For files that are opened a second time to read their samples: throws Error (kBadInput) unless
// `same`, which says whether the header still agrees with what the caller has allocated.
void CheckUnchanged(const std::string& path, bool same);

// The size of a file that has been opened. Throws like CheckUnchanged if it no longer exists.
uint64_t FileBytes(const std::string& path);

// One image of a file; EXR files may hold several.
struct ImagePart {
  struct PartChannel {
    std::string name;
    PixelType type = PixelType::kFloat;
    int x_sampling = 1, y_sampling = 1;  // a sample for every so many pixels
  };
  std::string name;  // "" where the format has no names
  Window display, data;
  std::vector<PartChannel> channels;
  std::map<std::string, std::string> metadata;
  std::string refusal;  // why its samples cannot be read ("is deep"); "" if they can
};

// The only part of a file, with the channels of `header`.
ImagePart PartOf(const Image& header);

// Where to write the samples of a channel: the region's first pixel goes to `first`, its right
// neighbour to `first + step_x`, the pixel below it to `first + step_y`.
struct SampleTarget {
  size_t channel = 0;  // index in ImageFile::header.channels
  float* first = nullptr;
  ptrdiff_t step_x = 1, step_y = 0;
};

struct ImageFile {
  std::string path;
  uint64_t file_bytes = 0;
  std::vector<ImagePart> parts;  // all parts of the file
  bool has_several = false;      // `header` covers more than one of them
  // The image that `read` reads: channels without samples, windows after applying orientation tags.
  // With several parts, channels are called "part.channel", and the data window encloses those of
  // all parts; outside of its own part, a channel is 0.
  Image header;
  // Reads the channels' samples within `region`, which must lie in header.data. Throws Error
  // (kBadInput) for damaged samples.
  std::function<void(const Window& region, std::span<const SampleTarget> targets)> read;

  void CheckSize(const Window& region, size_t channels) const {
    CheckSampleCount(path, file_bytes, int64_t{region.x1} - region.x0,
                     int64_t{region.y1} - region.y0, channels);
  }
};

// A file with one image, from pixel 0, 0 on, whose channels are R, G and B, or Y, perhaps with A.
// Its `read` is not set.
ImageFile MakeImageFile(const std::string& path, int width, int height, bool is_color,
                        bool has_alpha, std::map<std::string, std::string> metadata);

}  // namespace nacre
