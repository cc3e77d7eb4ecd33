// SPDX-License-Identifier: Apache-2.0
#include "image_io/image_file.h"

#include <array>
#include <fstream>
#include <string_view>

#include <fmt/format.h>

#include "base/error.h"
#include "base/huge_pages.h"
#include "base/input_file.h"
#include "base/path.h"
#include "image_io/exr_reader.h"
#include "image_io/hdr_reader.h"
#include "image_io/jpeg_reader.h"
#include "image_io/oiio.h"
#include "image_io/png_reader.h"
#include "image_io/pnm_reader.h"
#include "image_io/tga_reader.h"

namespace nacre {
namespace {

enum class FileFormat : uint8_t { kExr, kHdr, kPng, kJpeg, kPnm, kTga, kTiff, kOther };

// By its first bytes, whatever it is called. Another file named .exr is opened as EXR, so that the
// error says what is wrong with the EXR.
FileFormat FormatOf(const std::string& path) {
  CheckInputFile(path);
  std::array<char, 4096> bytes = {};
  std::ifstream(path, std::ios::binary).read(bytes.data(), bytes.size());
  const std::string_view head(bytes.data(), bytes.size());
  if (head.starts_with("\x89PNG")) return FileFormat::kPng;
  if (head.starts_with("\xff\xd8")) return FileFormat::kJpeg;
  if (head[0] == 'P' && std::string_view("123456Ff").find(head[1]) != std::string_view::npos) {
    return FileFormat::kPnm;
  }
  if (head.starts_with("\x76\x2f\x31\x01")) return FileFormat::kExr;
  // The oldest Radiance pictures have no "#?".
  if (head.starts_with("#?") || head.starts_with("FORMAT=32-bit_rle_") ||
      head.find("\nFORMAT=32-bit_rle_") != std::string_view::npos) {
    return FileFormat::kHdr;
  }
  if (head.starts_with("II*") || head.starts_with("II+") || head.starts_with("MM")) {
    return FileFormat::kTiff;
  }
  if (HasExtension(path, ".tga")) return FileFormat::kTga;  // has no first bytes of its own
  if (HasExtension(path, ".exr")) return FileFormat::kExr;
  return FileFormat::kOther;
}

}  // namespace

void CheckSampleCount(const std::string& path, uint64_t file_bytes, int64_t width, int64_t height,
                      uint64_t channels) {
  // Sides fit 32 bits; the product may need more than 64.
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

ImageFile OpenImage(const std::string& path, const std::string& part) {
  const FileFormat format = FormatOf(path);
  if (format == FileFormat::kExr) return OpenExr(path, part);
  if (!part.empty()) {
    throw Error(ExitCode::kBadInput, path, "has no part \"" + part + "\"",
                "only EXR files have parts");
  }
  if (format == FileFormat::kHdr) return OpenHdr(path);
  if (format == FileFormat::kPng) return OpenPng(path);
  if (format == FileFormat::kJpeg) return OpenJpeg(path);
  if (format == FileFormat::kPnm) return OpenPnm(path);
  if (format == FileFormat::kTga) return OpenTga(path);
  if (format == FileFormat::kTiff) return OpenWithOiio(path);
  throw Error(ExitCode::kBadInput, path,
              "cannot be read: not EXR, PNG, JPEG, TIFF, Radiance HDR, PNM or TGA");
}

std::vector<ImagePart> DescribeImage(const std::string& path) {
  if (FormatOf(path) == FileFormat::kExr) return DescribeExr(path);
  return OpenImage(path).parts;
}

Image ReadImage(const ImageFile& file) {
  Image image = file.header;
  file.CheckSize(image.data, image.channels.size());
  std::vector<SampleTarget> targets;
  for (size_t c = 0; c < image.channels.size(); ++c) {
    std::vector<float>& samples = image.channels[c].samples;
    samples.reserve(image.data.pixel_count());
    AdviseHugePages(samples.data(), image.data.pixel_count() * sizeof(float));
    samples.resize(image.data.pixel_count());
    targets.push_back({c, samples.data(), 1, image.data.width()});
  }
  file.read(image.data, targets);
  return image;
}

Image ReadImage(const std::string& path, const std::string& part) {
  return ReadImage(OpenImage(path, part));
}

}  // namespace nacre
