// SPDX-License-Identifier: Apache-2.0
#include "image_io/image_file.h"

#include <filesystem>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "base/error.h"

namespace nacre {

void CheckSampleCount(const std::string& path, uint64_t file_bytes, int64_t width, int64_t height,
                      uint64_t channels) {
  // Each side fits 32 bits, but the product may need more than 64.
  const double samples =
      static_cast<double>(width) * static_cast<double>(height) * static_cast<double>(channels);
  const double by_size = static_cast<double>(kFreeSamples) +
                         static_cast<double>(kSamplesPerByte) * static_cast<double>(file_bytes);
  if (samples > static_cast<double>(kMaxSamples)) {
    throw Error(ExitCode::kBadInput, path,
                fmt::format("{} x {} pixels of {} channels are too many", width, height, channels),
                "an image has 2^30 samples at most: make it smaller");
  }
  if (samples > by_size) {
    throw Error(
        ExitCode::kBadInput, path,
        fmt::format("{} x {} pixels of {} channels are too many for a file of {} bytes", width,
                    height, channels, file_bytes),
        "over 2^27 samples a file needs a byte for 64 of them: save it with less compression");
  }
}

void FailToRead(const std::string& path, const std::string& reason) {
  throw Error(ExitCode::kBadInput, path, "cannot be read: " + reason);
}

void CheckUnchanged(const std::string& path, bool same) {
  if (!same) throw Error(ExitCode::kBadInput, path, "changed while it was being read");
}

uint64_t FileBytes(const std::string& path) {
  std::error_code error;
  const uint64_t bytes = std::filesystem::file_size(path, error);
  CheckUnchanged(path, !error);
  return bytes;
}

ImagePart PartOf(const Image& header) {
  ImagePart part{.name = {},
                 .display = header.display,
                 .data = header.data,
                 .channels = {},
                 .metadata = header.metadata,
                 .refusal = {}};
  for (const Channel& channel : header.channels)
    part.channels.push_back({channel.name, channel.type});
  return part;
}

ImageFile MakeImageFile(const std::string& path, int width, int height, bool is_color,
                        bool has_alpha, std::map<std::string, std::string> metadata) {
  ImageFile image;
  image.path = path;
  image.file_bytes = FileBytes(path);
  image.header.data = image.header.display = {0, 0, width, height};
  image.header.metadata = std::move(metadata);
  std::vector<const char*> names = {"Y"};
  if (is_color) names = {"R", "G", "B"};
  if (has_alpha) names.push_back("A");
  for (const char* name : names) image.header.channels.push_back({name, PixelType::kFloat, {}});
  image.parts = {PartOf(image.header)};
  return image;
}

}  // namespace nacre
