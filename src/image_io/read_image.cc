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

namespace nacre {
namespace {

// Opens a file of a format without parts. Null for EXR, which has them.
using Opener = ImageFile (*)(const std::string& path);

// The opener by the file's first bytes, whatever its name. A file of unknown format that is named
// .exr is opened as EXR, so that the error says what is wrong with the EXR.
Opener OpenerOf(const std::string& path) {
  CheckInputFile(path);
  std::array<char, 4096> bytes = {};
  std::ifstream(path, std::ios::binary).read(bytes.data(), bytes.size());
  const std::string_view head(bytes.data(), bytes.size());
  if (head.starts_with("\x89PNG")) return OpenPng;
  if (head.starts_with("\xff\xd8")) return OpenJpeg;
  if (head.starts_with("RIFF") && head.substr(8, 4) == "WEBP") return OpenWebp;
  if (head[0] == 'P' && std::string_view("123456Ff").find(head[1]) != std::string_view::npos) {
    return OpenPnm;
  }
  if (head.starts_with("\x76\x2f\x31\x01")) return nullptr;
  // The oldest Radiance pictures do not begin with "#?".
  if (head.starts_with("#?") || head.starts_with("FORMAT=32-bit_rle_") ||
      head.find("\nFORMAT=32-bit_rle_") != std::string_view::npos) {
    return OpenHdr;
  }
  if (head.starts_with("II*") || head.starts_with("II+") || head.starts_with("MM")) {
    return OpenWithOiio;
  }
  if (HasExtension(path, ".tga")) return OpenTga;  // the format has no magic number
  if (HasExtension(path, ".exr")) return nullptr;
  return [](const std::string& other) -> ImageFile {
    throw Error(ExitCode::kBadInput, other,
                "cannot be read: not EXR, PNG, JPEG, WebP, TIFF, Radiance HDR, PNM or TGA");
  };
}

}  // namespace

ImageFile OpenImage(const std::string& path, const std::string& part) {
  const Opener open = OpenerOf(path);
  if (open == nullptr) return OpenExr(path, part);
  if (!part.empty()) {
    throw Error(ExitCode::kBadInput, path, "has no part \"" + part + "\"",
                "only EXR files have parts");
  }
  return open(path);
}

std::vector<ImagePart> DescribeImage(const std::string& path) {
  const Opener open = OpenerOf(path);
  return open == nullptr ? DescribeExr(path) : open(path).parts;
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
