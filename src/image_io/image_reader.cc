// SPDX-License-Identifier: Apache-2.0
#include "image_io/image_reader.h"

#include <optional>
#include <utility>

#include "base/path.h"
#include "image_io/exr_reader.h"
#include "image_io/hdr_reader.h"
#include "image_io/oiio.h"

namespace nacre {

Image ReadImage(const std::string& path) {
  if (HasExtension(path, ".hdr")) {
    constexpr uint64_t kMaxSamples = (uint64_t{2} << 30) / sizeof(float);
    if (std::optional<Image> plain = ReadPlainHdr(path, kMaxSamples)) return *std::move(plain);
  }
  if (!HasExtension(path, ".exr")) return ReadWithOiio(path);
  Image image = ReadExr(path);
  image.metadata["transfer"] = "linear";
  return image;
}

}  // namespace nacre
