// SPDX-License-Identifier: Apache-2.0
// image_io/webp_reader.cc: reads WebP files with libwebp.
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <webp/decode.h>
#include <webp/demux.h>

#include "base/error.h"
#include "image_io/c_file.h"
#include "image_io/format_readers.h"
#include "image_io/icc_profile.h"
#include "image_io/orientation.h"

namespace nacre {
namespace {

// The largest picture, 16 383 pixels a side, without any compression.
constexpr uint64_t kMostBytes = uint64_t{1} << 30;

std::vector<uint8_t> ReadAll(const std::string& path) {
  const CFile file = OpenToRead(path);
  if (!file) FailToRead(path, std::strerror(errno));
  const uint64_t size = FileBytes(path);
  if (size > kMostBytes) FailToRead(path, "no WebP file is so large");
  std::vector<uint8_t> bytes(size);
  bytes.resize(std::fread(bytes.data(), 1, bytes.size(), file.get()));
  return bytes;
}

struct DeleteDemuxer {
  void operator()(WebPDemuxer* demuxer) const { WebPDemuxDelete(demuxer); }
};

// The contents of the first chunk of this name; empty if there is none.
std::span<const uint8_t> ChunkOf(WebPDemuxer* demuxer, const char* name) {
  WebPChunkIterator chunk;
  if (WebPDemuxGetChunk(demuxer, name, 1, &chunk) == 0) return {};
  const std::span<const uint8_t> bytes(chunk.chunk.bytes, chunk.chunk.size);
  WebPDemuxReleaseChunkIterator(&chunk);  // the bytes are the file's
  return bytes;
}

WebPBitstreamFeatures FeaturesOf(const std::string& path, std::span<const uint8_t> bytes) {
  WebPBitstreamFeatures features;
  if (WebPGetFeatures(bytes.data(), bytes.size(), &features) != VP8_STATUS_OK) {
    FailToRead(path, "it is damaged or cut off");
  }
  if (features.has_animation != 0) {
    throw Error(ExitCode::kBadInput, path, "is an animation", "save one of its pictures");
  }
  return features;
}

}  // namespace

ImageFile OpenWebp(const std::string& path) {
  const std::vector<uint8_t> bytes = ReadAll(path);
  const WebPBitstreamFeatures features = FeaturesOf(path, bytes);
  std::map<std::string, std::string> metadata = {{"transfer", "display"}};
  const WebPData data = {bytes.data(), bytes.size()};
  const std::unique_ptr<WebPDemuxer, DeleteDemuxer> demuxer(WebPDemux(&data));
  if (!demuxer) FailToRead(path, "it is damaged or cut off");
  if (const auto embedded = ChunkOf(demuxer.get(), "ICCP"); !embedded.empty()) {
    NoteIccProfile(embedded, &metadata);
  }
  const Orientation orientation = OrientationOfTag(ExifOrientation(ChunkOf(demuxer.get(), "EXIF")));
  const bool has_alpha = features.has_alpha != 0;
  int width = features.width, height = features.height;
  if (orientation.transpose) std::swap(width, height);
  ImageFile image = MakeImageFile(path, width, height, /*is_color=*/true, has_alpha, metadata);
  // Reads the file again, so that no bytes are kept until then.
  image.read = [path, orientation, has_alpha, window = image.header.data](
                   const Window& region, std::span<const SampleTarget> targets) {
    const std::vector<uint8_t> again = ReadAll(path);
    const WebPBitstreamFeatures found = FeaturesOf(path, again);
    const RowPlacer placer(orientation, window, region, targets);
    CheckUnchanged(path, placer.stored_width() == found.width &&
                             placer.stored_height() == found.height &&
                             has_alpha == (found.has_alpha != 0));
    const size_t channels = has_alpha ? 4 : 3;
    // All of it is decoded at once, also for one row.
    CheckSampleCount(path, again.size(), found.width, found.height, channels);
    const auto row_codes = static_cast<size_t>(found.width) * channels;
    std::vector<uint8_t> codes(row_codes * static_cast<size_t>(found.height));
    const auto decode = has_alpha ? &WebPDecodeRGBAInto : &WebPDecodeRGBInto;
    if (decode(again.data(), again.size(), codes.data(), codes.size(),
               static_cast<int>(row_codes)) == nullptr) {
      FailToRead(path, "it is damaged or cut off");
    }
    std::vector<float> values(row_codes);
    for (int y = 0; y < found.height; ++y) {
      const uint8_t* const row = codes.data() + static_cast<size_t>(y) * row_codes;
      for (size_t i = 0; i < row_codes; ++i) values[i] = static_cast<float>(row[i]) / 255;
      placer.Place(y, values.data(), channels);
    }
  };
  return image;
}

}  // namespace nacre
