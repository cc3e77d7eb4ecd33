// SPDX-License-Identifier: Apache-2.0
#include "scene_io/texture_image.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <memory>
#include <optional>
#include <span>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/error.h"
#include "base/float_mode.h"
#include "base/huge_pages.h"
#include "base/parallel.h"
#include "color/transfer.h"
#include "image_io/color_channels.h"
#include "image_io/read_image.h"
#include "scene/limits.h"

namespace nacre {
namespace {

// The values k / maximum of an integer file, and what they decode to. Values arrive as floats;
// their integer code is recovered, so that each is decoded from its exact value and not from a
// rounded one.
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
  // Whether the float is one of the table's codes within two roundings. The tolerance is at most
  // 0.016 of the distance of 16-bit codes, and 255 times smaller than that distance for 8-bit
  // codes.
  bool Holds(float value) const {
    if (!(value >= 0 && value <= 1)) return false;
    const float code = value * maximum;
    return std::abs(static_cast<float>(NearestCode(value)) - code) <= maximum * 0x1p-22f;
  }
  // The code nearest to a value in [0, 1]. std::round would be a function call for each texel.
  int NearestCode(float value) const { return static_cast<int>(value * maximum + 0.5f); }
};

// The table for an encoding, shared by all textures.
template <int kCodes>
std::shared_ptr<const CodeTable> TableOf(TextureEncoding encoding) {
  if (encoding == TextureEncoding::kSrgb) {
    static const auto srgb = std::make_shared<const CodeTable>(kCodes, TextureEncoding::kSrgb);
    return srgb;
  }
  static const auto linear = std::make_shared<const CodeTable>(kCodes, TextureEncoding::kLinear);
  return linear;
}

// Calls body(piece) for pieces of the values, on several threads.
template <class Body>
void ForEachPiece(std::span<float> values, int threads, const Body& body) {
  constexpr size_t kPiece = size_t{1} << 18;
  ParallelForBlocks(values.size(), kPiece, threads,
                    [&](size_t begin, size_t end) { body(values.subspan(begin, end - begin)); });
}

bool AreFinite(std::span<float> values, int threads) {
  std::atomic<bool> all = true;
  ForEachPiece(values, threads, [&](std::span<float> piece) {
    const auto is_finite = [](float value) { return std::isfinite(value); };
    if (all && !std::all_of(piece.begin(), piece.end(), is_finite)) all = false;
  });
  return all;
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
                "a texture needs R, G and B, or one channel; " + TellChannels(channels));
  }
  if (colors->is_grey()) return {colors->r};
  return {colors->r, colors->g, colors->b};
}

// Converts values as TextureReading::glossiness says.
void TurnGlossIntoRoughness(double glossiness, std::span<float> values) {
  const auto factor = static_cast<float>(glossiness);
  if (factor > 0) {
    for (float& value : values) value = 1 - factor * value;
  }
}

// The values of an integer file as codes, if each of them is one.
template <typename Code>
std::optional<Texels> FindCodes(const TextureReading& reading, std::span<float> values) {
  const auto codes = TableOf<1 << 8 * sizeof(Code)>(reading.encoding);
  TexelTable table(codes, &codes->decoded);
  if (reading.glossiness > 0) {
    std::vector<float> changed = codes->decoded;
    TurnGlossIntoRoughness(reading.glossiness, changed);
    table = std::make_shared<const std::vector<float>>(std::move(changed));
  }
  Texels texels(std::move(table), values.size());
  Code* const all = texels.As<Code>();
  std::atomic<bool> found = true;
  ForEachPiece(values, reading.threads, [&](std::span<float> piece) {
    Code* to = all + (piece.data() - values.data());
    for (const float value : piece) {
      if (!codes->Holds(value)) {
        found = false;
        return;
      }
      *to++ = static_cast<Code>(codes->NearestCode(value));
    }
  });
  if (!found) return std::nullopt;
  return texels;
}

// *middle is set to the code that means 0 in a normal map.
Texels DecodeIntegers(const TextureReading& reading, std::span<float> values, float* middle) {
  *middle = 128.0f / 255;
  if (auto bytes = FindCodes<uint8_t>(reading, values)) return *std::move(bytes);
  *middle = 32768.0f / 65535;
  if (auto words = FindCodes<uint16_t>(reading, values)) return *std::move(words);
  const auto words = TableOf<1 << 16>(reading.encoding);
  ForEachPiece(values, reading.threads, [&](std::span<float> piece) {
    for (float& value : piece) {
      if (words->Holds(value)) {
        value = words->decoded[static_cast<size_t>(words->NearestCode(value))];
      } else if (reading.encoding == TextureEncoding::kSrgb) {
        value = SrgbEotf(value);
      }
    }
  });
  TurnGlossIntoRoughness(reading.glossiness, values);
  return PackTexels(values);
}

// An image file whose header has been read and checked.
struct OpenTexture {
  ImageFile image;
  Window window;
  std::vector<size_t> channels;  // indices in the file; empty: the alpha of an opaque image
  bool is_integer = false;
  ColorConversion conversion;

  size_t kept() const { return std::max<size_t>(channels.size(), 1); }
};

OpenTexture OpenTextureImage(const std::filesystem::path& path, const TextureReading& reading,
                             TexelBudget* budget) {
  OpenTexture texture;
  texture.image = OpenImage(path.string(), reading.part);
  const Window window = texture.window = WholeWindow(texture.image, "a texture");
  texture.channels = ChannelsOf(texture.image, reading.encoding);
  const auto& metadata = texture.image.header.metadata;
  texture.is_integer = metadata.at("transfer") == "display";
  const auto not_srgb = metadata.find("not_srgb");
  if (texture.is_integer && !reading.trust_encoding && reading.encoding == TextureEncoding::kSrgb &&
      not_srgb != metadata.end()) {
    throw Error(ExitCode::kBadInput, path.string(), "has " + not_srgb->second,
                R"(convert it to sRGB, or say "encoding": "srgb" to take it as that)");
  }
  if (reading.encoding == TextureEncoding::kSrgb && texture.kept() == 3) {
    texture.conversion = ConversionToRec709(texture.image.header.metadata);
  }
  texture.image.CheckSize(window, texture.kept());
  budget->Spend(path.string(), int64_t{window.x1} - window.x0, int64_t{window.y1} - window.y0,
                texture.kept());
  return texture;
}

DecodedImage DecodeTextureImage(const OpenTexture& open, const TextureReading& reading) {
  const Window& window = open.window;
  const std::vector<size_t>& channels = open.channels;
  const size_t kept = open.kept();
  HugeVector<float> values(window.pixel_count() * kept);
  if (channels.empty()) {
    std::fill(values.begin(), values.end(), 1.0f);  // opaque
  } else {
    // Rows from the bottom up, with interleaved channels.
    const auto step_x = static_cast<ptrdiff_t>(kept);
    const ptrdiff_t step_y = step_x * window.width();
    std::vector<SampleTarget> targets;
    for (size_t c = 0; c < kept; ++c) {
      targets.push_back({channels[c],
                         values.data() + (window.height() - 1) * step_y + static_cast<ptrdiff_t>(c),
                         step_x, -step_y});
    }
    open.image.read(window, targets);
  }
  DecodedImage decoded;
  SceneImage& texture = decoded.image;
  texture.lacks_alpha = channels.empty();
  // Values from a table are finite; others are checked.
  const auto decode = [&]() -> Texels {
    if (open.is_integer) return DecodeIntegers(reading, values, &texture.middle);
    if (!AreFinite(values, reading.threads)) {
      throw Error(ExitCode::kBadInput, open.image.path, "holds NaN or infinities",
                  "a texture needs finite values");
    }
    if (open.conversion.matrix) {
      decoded.outside = ConvertColors(*open.conversion.matrix, {&values[0], &values[1], &values[2]},
                                      kept, window.pixel_count(), /*clip=*/true, reading.threads);
    }
    TurnGlossIntoRoughness(reading.glossiness, values);
    return PackTexels(values);
  };
  texture.texels = std::make_shared<const MipChain>(window.width(), window.height(),
                                                    static_cast<int>(kept), decode());
  const auto are_all = [&](float value) {
    return texture.texels->least == value && texture.texels->greatest == value;
  };
  texture.is_black = are_all(0);
  texture.is_white = are_all(1);
  return decoded;
}

}  // namespace

void TexelBudget::AddFile(const std::filesystem::path& path) {
  std::error_code error;
  const uintmax_t bytes = std::filesystem::file_size(path, error);
  if (!error && files_.insert(path).second) file_bytes_ += bytes;
}

void TexelBudget::Spend(const std::string& where, int64_t width, int64_t height, size_t channels) {
  // Each side fits 32 bits, but the product may need more than 64.
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

std::string TextureReading::Key(const std::filesystem::path& path) const {
  const std::string gloss = glossiness > 0 ? fmt::format("{} ", glossiness) : "";
  return path.string() + "sla"[static_cast<size_t>(encoding)] + (trust_encoding ? "!" : "?") +
         gloss + part;
}

void TexturesAhead::Want(const std::filesystem::path& path, const TextureReading& reading) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) return;
  if (by_key_.emplace(reading.Key(path), wanted_.size()).second) {
    wanted_.push_back({path, reading, std::nullopt});
  }
}

void TexturesAhead::Decode(TexelBudget budget, int threads) {
  if (wanted_.size() < 2 || ThreadCount(threads) < 2) return;
  std::vector<std::optional<OpenTexture>> open(wanted_.size());
  for (size_t i = 0; i < wanted_.size(); ++i) {
    try {
      budget.AddFile(wanted_[i].path);
      open[i] = OpenTextureImage(wanted_[i].path, wanted_[i].reading, &budget);
    } catch (const Error&) {  // NOLINT(bugprone-empty-catch): its reader will throw it again
    }
  }
  ParallelFor(wanted_.size(), threads, [&](size_t i) {
    if (!open[i]) return;
    const DefaultFloatMode keeps_denormals;
    try {
      wanted_[i].image = DecodeTextureImage(*open[i], wanted_[i].reading);
    } catch (const Error&) {  // NOLINT(bugprone-empty-catch)
    }
  });
}

std::optional<DecodedImage> TexturesAhead::Take(const std::filesystem::path& path,
                                                const TextureReading& reading) {
  const auto found = by_key_.find(reading.Key(path));
  if (found == by_key_.end()) return std::nullopt;
  return std::exchange(wanted_[found->second].image, std::nullopt);
}

SceneImage ReadTextureImage(const std::filesystem::path& path, const std::string& file,
                            const TextureReading& reading, TexelBudget* budget,
                            TexturesAhead* ahead) {
  const OpenTexture open = OpenTextureImage(path, reading, budget);
  if (!open.conversion.note.empty() && reading.on_warning) {
    reading.on_warning(file + ": " + open.conversion.note);
  }
  std::optional<DecodedImage> decoded;
  if (ahead != nullptr) decoded = ahead->Take(path, reading);
  if (!decoded) decoded = DecodeTextureImage(open, reading);
  if (decoded->outside > 0 && reading.on_warning) {
    reading.on_warning(file + ": " + OutsideNote(decoded->outside));
  }
  decoded->image.file = file;
  return std::move(decoded->image);
}

ImageId AddTextureImage(const std::filesystem::path& path, const std::string& file,
                        const TextureReading& reading, TexelBudget* budget, Scene* scene,
                        TexturesAhead* ahead) {
  scene->images.push_back(ReadTextureImage(path, file, reading, budget, ahead));
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
