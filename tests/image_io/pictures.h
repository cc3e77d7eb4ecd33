// SPDX-License-Identifier: Apache-2.0
// tests/image_io/pictures.h: random pictures for EXR files, and what reading them must give.
#pragma once

#include <bit>
#include <cmath>
#include <random>
#include <string>
#include <variant>
#include <vector>

#include <Imath/half.h>

#include "files.h"
#include "image_io/exr_writer.h"
#include "image_io/format_readers.h"
#include "image_io/read_image.h"

namespace nacre {

inline Image ReadExr(const std::string& path) { return ReadImage(OpenExr(path)); }

struct Picture {
  ExrHeader header;
  std::vector<std::vector<float>> floats;  // by channel; of uint channels their ids as floats
  std::vector<std::vector<uint32_t>> ids;  // by channel; empty for others
};

// Nine channels of all types, with names that sort differently as bytes and as words, and one
// over 31 characters.
inline std::vector<ExrChannel> MixedChannels() {
  return {{"R", PixelType::kHalf},
          {"G", PixelType::kHalf},
          {"B", PixelType::kHalf},
          {"A", PixelType::kHalf},
          {"diffuse.R", PixelType::kHalf},
          {"Z", PixelType::kFloat},
          {"id.object", PixelType::kUint},
          {"N.X", PixelType::kFloat},
          {"light.a name of more than thirty-one characters.R", PixelType::kHalf}};
}

// A gradient with noise of a hundredth, a few samples of any magnitude that halves hold, zeros of
// both signs; ids up to 2^24, which floats hold exactly.
inline float RandomSample(std::mt19937& random, int x, int y) {
  const auto unit = [&] { return static_cast<float>(random() >> 8) * 0x1p-24f; };
  switch (random() % 32) {
    case 0:
      return std::ldexp(unit() - 0.5f, static_cast<int>(random() % 40) - 24);
    case 1:
      return 0.0f;
    case 2:
      return -0.0f;
    default:
      return 0.01f * static_cast<float>(x + 2 * y) + 0.01f * unit();
  }
}

inline Picture MakePicture(const Window& data, const Window& display,
                           const std::vector<ExrChannel>& channels) {
  Picture picture;
  picture.header.data = data;
  picture.header.display = display;
  picture.header.channels = channels;
  std::mt19937 random(3);
  for (const ExrChannel& channel : channels) {
    std::vector<float> floats;
    std::vector<uint32_t> ids;
    for (int y = 0; y < data.height(); ++y) {
      for (int x = 0; x < data.width(); ++x) {
        if (channel.type == PixelType::kUint) {
          ids.push_back(static_cast<uint32_t>(random() % ((1u << 24) + 1)));
          floats.push_back(static_cast<float>(ids.back()));
        } else {
          floats.push_back(RandomSample(random, x, y));
        }
      }
    }
    picture.floats.push_back(std::move(floats));
    picture.ids.push_back(std::move(ids));
  }
  return picture;
}

inline Picture MakePicture(int width, int height) {
  const Window window = {0, 0, width, height};
  return MakePicture(window, window, MixedChannels());
}

// Strip `index` of the picture.
inline StripView ViewStrip(const Picture& picture, size_t index) {
  const Window& data = picture.header.data;
  StripView strip;
  const int row = static_cast<int>(index) * kStripRows;
  strip.y = data.y0 + row;
  strip.rows = std::min(kStripRows, data.height() - row);
  const size_t offset = static_cast<size_t>(row) * static_cast<size_t>(data.width());
  for (size_t c = 0; c < picture.floats.size(); ++c) {
    if (picture.ids[c].empty()) {
      strip.channels.emplace_back(picture.floats[c].data() + offset);
    } else {
      strip.channels.emplace_back(picture.ids[c].data() + offset);
    }
  }
  return strip;
}

inline size_t StripCount(const Picture& picture) {
  return static_cast<size_t>((picture.header.data.height() + kStripRows - 1) / kStripRows);
}

inline void WritePicture(const std::string& path, const Picture& picture,
                         const ExrOptions& options) {
  ExrWriter writer(path, picture.header, options);
  ShuffledInThreads(StripCount(picture),
                    [&](size_t i) { writer.WriteStrip(ViewStrip(picture, i)); });
  writer.Finish();
}

// What the file must hold of a sample: halves as Imath rounds them, the rest as it is.
inline float Stored(PixelType type, float sample) {
  return type == PixelType::kHalf ? static_cast<float>(Imath::half(sample)) : sample;
}

// Whether the image has the picture's windows, channels and samples, bit for bit.
inline void CheckSamePicture(const Image& image, const Picture& picture) {
  CHECK(image.data == picture.header.data);
  CHECK(image.display == picture.header.display);
  REQUIRE(image.channels.size() == picture.floats.size());
  for (size_t c = 0; c < picture.floats.size(); ++c) {
    const ExrChannel& expected = picture.header.channels[c];
    CAPTURE(expected.name);
    const Channel* channel = image.Find(expected.name);
    REQUIRE(channel != nullptr);
    REQUIRE(channel->samples.size() == picture.floats[c].size());
    size_t wrong = 0;
    for (size_t i = 0; i < channel->samples.size(); ++i) {
      const float stored = Stored(expected.type, picture.floats[c][i]);
      if (std::bit_cast<uint32_t>(channel->samples[i]) != std::bit_cast<uint32_t>(stored)) ++wrong;
    }
    CHECK(wrong == 0);
  }
}

}  // namespace nacre
