// SPDX-License-Identifier: Apache-2.0
#include "scene_io/texture_image.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <span>
#include <system_error>
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

void TexelBudget::AddFile(const std::filesystem::path& path) {
  std::error_code error;
  const uintmax_t bytes = std::filesystem::file_size(path, error);
  if (!error && files_.insert(path).second) file_bytes_ += bytes;
}

void TexelBudget::Spend(const std::string& where, int64_t width, int64_t height, size_t channels) {
  // Sides fit 32 bits; the product may need more than 64.
  const double values =
      static_cast<double>(width) * static_cast<double>(height) * static_cast<double>(channels);
  const auto total = [&](uint64_t before) { return static_cast<double>(before) + values; };
  constexpr Range kSide = limits::kImageSide;
  if (!kSide.Contains(static_cast<double>(width)) || !kSide.Contains(static_cast<double>(height)) ||
      total(values_before_ + spent_) > static_cast<double>(kMaxTexelValues)) {
    throw Error(ExitCode::kBadInput, where,
                fmt::format("{} x {} texels are too many for a texture", width, height),
                "make it smaller: 65536 a side, 2^30 values in all textures of a scene");
  }
  const double by_size = static_cast<double>(kFreeSamples) +
                         static_cast<double>(kSamplesPerByte) * static_cast<double>(file_bytes_);
  if (total(spent_) > by_size) {
    throw Error(ExitCode::kBadInput, where,
                fmt::format("{} x {} texels are too many for textures of files of {} bytes", width,
                            height, file_bytes_),
                "over 2^27 values in all textures the files need a byte for 64 of them: make the "
                "image smaller, or save it with less compression");
  }
  spent_ += static_cast<uint64_t>(values);
}

SceneImage ReadTextureImage(const std::filesystem::path& path, const std::string& file,
                            const TextureReading& reading, TexelBudget* budget) {
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
  image.CheckSize(window, kept);
  budget->Spend(path.string(), int64_t{window.x1} - window.x0, int64_t{window.y1} - window.y0,
                kept);
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

ImageId AddTextureImage(const std::filesystem::path& path, const std::string& file,
                        const TextureReading& reading, TexelBudget* budget, Scene* scene) {
  scene->images.push_back(ReadTextureImage(path, file, reading, budget));
  return {static_cast<uint32_t>(scene->images.size() - 1)};
}

uint64_t TexelValuesOf(const Scene& scene) {
  uint64_t values = 0;
  for (const SceneImage& image : scene.images) {
    const MipLevel& level = image.texels->levels[0];
    values += static_cast<uint64_t>(level.width) * static_cast<uint64_t>(level.height) *
              static_cast<uint64_t>(image.texels->channels);
  }
  return values;
}

}  // namespace nacre
