// SPDX-License-Identifier: Apache-2.0
#include "image_io/image_file.h"

#include <filesystem>
#include <system_error>

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

}  // namespace nacre
