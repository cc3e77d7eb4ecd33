// SPDX-License-Identifier: Apache-2.0
#include "scene_io/texture_image.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/error.h"
#include "base/path.h"
#include "color/transfer.h"
#include "image_io/exr_reader.h"
#include "image_io/image_reader.h"
#include "image_io/png_reader.h"
#include "scene/limits.h"

namespace nacre {
namespace {

// Values k / maximum of an integer file, and what they decode to. Integers come as floats: the code
// is found again, so that each decodes from its exact value and not from its rounding.
struct CodeTable {
  std::vector<float> decoded;
  float maximum;

  CodeTable(int codes, TextureEncoding encoding) : maximum(static_cast<float>(codes - 1)) {
    decoded.reserve(static_cast<size_t>(codes));
    for (int code = 0; code < codes; ++code) {
      const double value = static_cast<double>(code) / (codes - 1);
      decoded.push_back(
          static_cast<float>(encoding == TextureEncoding::kSrgb ? SrgbEotf(value) : value));
    }
  }
  // Whether the float is one of the table's codes, give or take two roundings: at most 0.016 of a
  // 16-bit code, and 255 times less than the distance of 16-bit codes of an 8-bit one.
  bool Holds(float value) const {
    const float code = value * maximum;
    return value >= 0 && value <= 1 && std::abs(std::round(code) - code) <= maximum * 0x1p-22f;
  }
  float Decode(float value) const {
    return decoded[static_cast<size_t>(std::round(value * maximum))];
  }
};

void CheckSize(const std::filesystem::path& path, const Window& window, size_t channels,
               size_t max_values) {
  const auto width = int64_t{window.x1} - window.x0, height = int64_t{window.y1} - window.y0;
  const double side = limits::kImageSide.max;
  const auto values = static_cast<double>(width) * static_cast<double>(height) *
                      static_cast<double>(std::min<size_t>(channels, 3));
  if (width >= 1 && height >= 1 && static_cast<double>(width) <= side &&
      static_cast<double>(height) <= side && values <= static_cast<double>(max_values)) {
    return;
  }
  throw Error(ExitCode::kBadInput, path.string(),
              fmt::format("{} x {} texels are too many for a texture", width, height),
              "make it smaller: 65536 a side, 2^30 values in all textures of a scene");
}

bool IsAlpha(const Channel& channel) { return channel.name == "A" || channel.name == "Alpha"; }

// Red, green and blue, or the first channel that is not alpha; or alpha, and nothing if there is
// none.
std::vector<const Channel*> ChannelsOf(const Image& image, TextureEncoding encoding) {
  if (encoding == TextureEncoding::kAlpha) {
    for (const Channel& channel : image.channels) {
      if (IsAlpha(channel)) return {&channel};
    }
    return {};
  }
  const std::vector<const Channel*> rgb = {image.Find("R"), image.Find("G"), image.Find("B")};
  if (rgb[0] != nullptr && rgb[1] != nullptr && rgb[2] != nullptr) return rgb;
  for (const Channel& channel : image.channels) {
    if (!IsAlpha(channel)) return {&channel};
  }
  return {};
}

// Row by row from the bottom, channels together.
std::vector<float> Interleave(const Image& image, const std::vector<const Channel*>& channels) {
  const auto width = static_cast<size_t>(image.data.width());
  const auto height = static_cast<size_t>(image.data.height());
  std::vector<float> values;
  values.reserve(width * height * channels.size());
  for (size_t y = height; y-- > 0;) {
    for (size_t x = 0; x < width; ++x) {
      for (const Channel* channel : channels) values.push_back(channel->samples[y * width + x]);
    }
  }
  return values;
}

// Decodes the values of an integer file and returns the code that a normal map has as 0.
float DecodeIntegers(TextureEncoding encoding, std::vector<float>* values) {
  const CodeTable bytes(1 << 8, encoding);
  const auto is_byte = [&](float value) { return bytes.Holds(value); };
  if (std::all_of(values->begin(), values->end(), is_byte)) {
    for (float& value : *values) value = bytes.Decode(value);
    return 128.0f / 255;
  }
  const CodeTable words(1 << 16, encoding);
  for (float& value : *values) {
    value = words.Holds(value)                   ? words.Decode(value)
            : encoding == TextureEncoding::kSrgb ? SrgbEotf(value)
                                                 : value;
  }
  return 32768.0f / 65535;
}

}  // namespace

SceneImage ReadTextureImage(const std::filesystem::path& path, const std::string& file,
                            TextureEncoding encoding, size_t max_values) {
  if (HasExtension(path.string(), ".exr")) {
    const Image header = ReadExrHeader(path.string());  // before anything is decoded
    CheckSize(path, header.data, header.channels.size(), max_values);
  }
  SceneImage texture;
  texture.file = file;
  std::vector<float> values;
  int width = 0, height = 0;
  size_t channel_count = 0;
  {
    // Plain PNG files need no library that takes longer to load than they do to read. The other
    // readers refuse images over 2 GiB before they decode them, as this one does.
    std::optional<Image> plain = ReadPlainPng(path.string(), kMaxTexelValues / 2);
    const Image image = plain ? std::move(*plain) : ReadImage(path.string());
    const std::vector<const Channel*> channels = ChannelsOf(image, encoding);
    const bool opaque = channels.empty() && encoding == TextureEncoding::kAlpha;
    if (channels.empty() && !opaque) {
      throw Error(ExitCode::kBadInput, path.string(), "has no colours");
    }
    channel_count = opaque ? 1 : channels.size();
    CheckSize(path, image.data, channel_count, max_values);
    width = image.data.width();
    height = image.data.height();
    values = opaque ? std::vector<float>(image.channels.front().samples.size(), 1.0f)
                    : Interleave(image, channels);
    const auto transfer = image.metadata.find("transfer");
    if (transfer != image.metadata.end() && transfer->second == "display") {
      texture.middle = DecodeIntegers(encoding, &values);
    }
  }
  if (!std::all_of(values.begin(), values.end(), [](float v) { return std::isfinite(v); })) {
    throw Error(ExitCode::kBadInput, path.string(), "holds NaN or infinities",
                "a texture needs finite values");
  }
  texture.texels = std::make_shared<const MipChain>(
      MakeMipChain(width, height, static_cast<int>(channel_count), std::move(values)));
  return texture;
}

ImageId AddTextureImage(const std::filesystem::path& path, const std::string& file,
                        TextureEncoding encoding, Scene* scene) {
  size_t left = kMaxTexelValues;
  for (const SceneImage& image : scene->images) {
    const MipLevel& level = image.texels->levels[0];
    left -= static_cast<size_t>(level.width) * static_cast<size_t>(level.height) *
            static_cast<size_t>(image.texels->channels);
  }
  scene->images.push_back(ReadTextureImage(path, file, encoding, left));
  return {static_cast<uint32_t>(scene->images.size() - 1)};
}

}  // namespace nacre
