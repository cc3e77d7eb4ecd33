// SPDX-License-Identifier: Apache-2.0
// image_io/verify_image.cc: VerifyImage() of read_image.h.
#include <algorithm>
#include <array>
#include <fstream>
#include <string_view>
#include <vector>

#include <OpenEXR/ImfCheckFile.h>

#include "base/error.h"
#include "base/input_file.h"
#include "base/path.h"
#include "image_io/exr_bands.h"
#include "image_io/exr_checksum.h"
#include "image_io/read_image.h"

namespace nacre {
namespace {

[[noreturn]] void RefuseDamaged(const std::string& path, const std::string& what) {
  throw Error(ExitCode::kBadInput, path, "is damaged: " + what, "make it again");
}

std::string VerifyExr(const std::string& path) {
  const ExrChecksum checksum = CheckExrChecksum(path);
  if (checksum == ExrChecksum::kWrong) {
    RefuseDamaged(path, "its bytes are not those that its checksum was made of");
  }
  if (checksum == ExrChecksum::kRight) {  // written by nacre, of any size
    ExrBandReader(path).DecodeAll();
    return "whole: its checksum is right, and every sample decodes";
  }
  const std::vector<ImagePart> parts = DescribeImage(path);
  const bool refused = std::any_of(parts.begin(), parts.end(),
                                   [](const ImagePart& part) { return !part.refusal.empty(); });
  // Deep and subsampled parts and the like are left to OpenEXR's own check, which reads them all.
  if (!refused) {
    ReadImage(path);
  } else if (Imf::checkOpenEXRFile(path.c_str(), /*reduceMemory=*/true)) {
    RefuseDamaged(path, "OpenEXR cannot read all of it");
  }
  return "every sample decodes; it has no checksum of nacre's";
}

// Whether the file ends with the last chunk, at which readers stop.
bool EndsAsPng(const std::string& path) {
  std::array<char, 8> end{};
  std::ifstream file(path, std::ios::binary);
  file.seekg(-static_cast<std::streamoff>(end.size()), std::ios::end);
  file.read(end.data(), end.size());
  return std::string_view(end.data(), end.size()) == "IEND\xae\x42\x60\x82";
}

}  // namespace

std::string VerifyImage(const std::string& path) {
  CheckInputFile(path);
  std::array<char, 4> magic{};
  std::ifstream(path, std::ios::binary).read(magic.data(), magic.size());
  const bool is_exr = std::string_view(magic.data(), magic.size()) == "\x76\x2f\x31\x01";
  if (is_exr || HasExtension(path, ".exr")) return VerifyExr(path);
  const ImageFile image = OpenImage(path);
  image.read(image.header.data, {});  // decodes all, and keeps nothing
  if (std::string_view(magic.data(), magic.size()) == "\x89PNG") {
    if (!EndsAsPng(path)) RefuseDamaged(path, "there is more behind its end");
    return "whole: its checksums are right, and every pixel is there";
  }
  return "every sample decodes; files of its kind have no checksum";
}

}  // namespace nacre
