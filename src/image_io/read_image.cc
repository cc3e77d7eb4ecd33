// SPDX-License-Identifier: Apache-2.0
#include "image_io/read_image.h"

#include <array>
#include <fstream>
#include <string_view>

#include "base/error.h"
#include "base/huge_pages.h"
#include "base/input_file.h"
#include "base/path.h"
#include "image_io/format_readers.h"
#include "image_io/oiio.h"

namespace nacre {
namespace {

enum class FileFormat : uint8_t { kExr, kHdr, kPng, kJpeg, kPnm, kTga, kTiff, kOther };

// The format by the file's first bytes, whatever its name. A file of unknown format that is named
// .exr is opened as EXR, so that the error says what is wrong with the EXR.
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
  // The oldest Radiance pictures do not begin with "#?".
  if (head.starts_with("#?") || head.starts_with("FORMAT=32-bit_rle_") ||
      head.find("\nFORMAT=32-bit_rle_") != std::string_view::npos) {
    return FileFormat::kHdr;
  }
  if (head.starts_with("II*") || head.starts_with("II+") || head.starts_with("MM")) {
    return FileFormat::kTiff;
  }
  if (HasExtension(path, ".tga")) return FileFormat::kTga;  // the format has no magic number
  if (HasExtension(path, ".exr")) return FileFormat::kExr;
  return FileFormat::kOther;
}

}  // namespace

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
