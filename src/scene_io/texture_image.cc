// SPDX-License-Identifier: Apache-2.0
#include "scene_io/texture_image.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/error.h"
#include "color/transfer.h"
#include "image_io/color_channels.h"
#include "image_io/image_file.h"
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

// The channels that a texture keeps: one or three, or none for the alpha of an opaque image.
std::vector<size_t> ChannelsOf(const ImageFile& image, TextureEncoding encoding) {
  const std::vector<Channel>& channels = image.header.channels;
  if (encoding == TextureEncoding::kAlpha) {
    for (size_t c = 0; c < channels.size(); ++c) {
      if (IsAlphaChannel(channels[c].name)) return {c};
    }
    return {};
  }
  const std::optional<ColorChannels> colors = FindColors(channels, "");
  if (!colors) {
    throw Error(ExitCode::kBadInput, image.path, "has no colours",
                "a texture needs R, G and B, or one channel");
  }
  if (colors->is_grey()) return {colors->r};
  CheckPrimaries(image);
  return {colors->r, colors->g, colors->b};
}

// Decodes the values of an integer file and returns the code that a normal map has as 0.
float DecodeIntegers(TextureEncoding encoding, std::span<float> values) {
  const CodeTable bytes(1 << 8, encoding);
  const auto is_byte = [&](float value) { return bytes.Holds(value); };
  if (std::all_of(values.begin(), values.end(), is_byte)) {
    for (float& value : values) value = bytes.Decode(value);
    return 128.0f / 255;
  }
  const CodeTable words(1 << 16, encoding);
  for (float& value : values) {
    value = words.Holds(value)                   ? words.Decode(value)
            : encoding == TextureEncoding::kSrgb ? SrgbEotf(value)
                                                 : value;
  }
  return 32768.0f / 65535;
}

}  // namespace

SceneImage ReadTextureImage(const std::filesystem::path& path, const std::string& file,
                            const TextureReading& reading, size_t max_values) {
  const ImageFile image = OpenImage(path.string(), reading.part);
  const Window window = WholeWindow(image, "a texture");
  const std::vector<size_t> channels = ChannelsOf(image, reading.encoding);
  const auto& metadata = image.header.metadata;
  const bool is_integer = metadata.at("transfer") == "display";
  const auto not_srgb = metadata.find("not_srgb");
  if (is_integer && !reading.trust_encoding && reading.encoding == TextureEncoding::kSrgb &&
      not_srgb != metadata.end()) {
    throw Error(ExitCode::kBadInput, path.string(), "has " + not_srgb->second,
                R"(convert it to sRGB, or say "encoding": "srgb" to take it as that)");
  }
  const size_t kept = std::max<size_t>(channels.size(), 1);
  CheckSize(path, window, kept, max_values);
  image.CheckSize(window, kept);
  MipChain chain = MakeEmptyMipChain(window.width(), window.height(), static_cast<int>(kept));
  const size_t count = window.pixel_count() * kept;
  const std::span<float> values(chain.values.data(), count);
  if (channels.empty()) {
    std::fill(values.begin(), values.end(), 1.0f);  // opaque
  } else {
    // Row by row from the bottom, channels together.
    const auto step_x = static_cast<ptrdiff_t>(kept);
    const ptrdiff_t step_y = step_x * window.width();
    std::vector<SampleTarget> targets;
    for (size_t c = 0; c < kept; ++c) {
      targets.push_back({channels[c],
                         values.data() + (window.height() - 1) * step_y + static_cast<ptrdiff_t>(c),
                         step_x, -step_y});
    }
    image.read(window, targets);
  }
  SceneImage texture;
  texture.file = file;
  texture.lacks_alpha = channels.empty();
  if (is_integer) texture.middle = DecodeIntegers(reading.encoding, values);
  if (!std::all_of(values.begin(), values.end(), [](float v) { return std::isfinite(v); })) {
    throw Error(ExitCode::kBadInput, path.string(), "holds NaN or infinities",
                "a texture needs finite values");
  }
  FillMipLevels(&chain);
  texture.texels = std::make_shared<const MipChain>(std::move(chain));
  return texture;
}

size_t TexelValuesLeft(const Scene& scene) {
  size_t left = kMaxTexelValues;
  for (const SceneImage& image : scene.images) {
    const MipLevel& level = image.texels->levels[0];
    left -= static_cast<size_t>(level.width) * static_cast<size_t>(level.height) *
            static_cast<size_t>(image.texels->channels);
  }
  return left;
}

ImageId AddTextureImage(const std::filesystem::path& path, const std::string& file,
                        const TextureReading& reading, Scene* scene) {
  scene->images.push_back(ReadTextureImage(path, file, reading, TexelValuesLeft(*scene)));
  return {static_cast<uint32_t>(scene->images.size() - 1)};
}

}  // namespace nacre
