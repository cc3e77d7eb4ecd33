// SPDX-License-Identifier: Apache-2.0
// api/picture.cc: what a display shows of an image, as pictures in memory, and images as EXR and
// PNG files.
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <locale>
#include <set>
#include <sstream>
#include <string>
#include <system_error>
#include <vector>

#include "api/border.h"
#include "base/parallel.h"
#include "base/path.h"
#include "base/version.h"
#include "color/display.h"
#include "image_io/color_channels.h"
#include "image_io/exr_checksum.h"
#include "image_io/exr_writer.h"
#include "image_io/jpeg_writer.h"
#include "image_io/png_writer.h"

namespace nacre::v0 {
namespace {

// The values of a public image that a display shows.
struct Shown {
  // Throws Error (kUsage) for settings out of range, and if there is no such layer; `what` names
  // the function in errors.
  Shown(const Image& image, const ToneMapSettings& settings, const std::string& what) {
    CheckImage(image);
    if (!(std::abs(settings.exposure) <= 60)) {
      throw nacre::Error(ExitCode::kUsage, "exposure", "is not within -60 to 60 stops");
    }
    display = {.tone = ParseToneOperator(settings.tonemap), .exposure_ev = settings.exposure};
    const auto transfer = image.metadata.find("transfer");
    displayed = transfer != image.metadata.end() && transfer->second == "display";
    const std::string prefix = settings.layer.empty() ? "" : settings.layer + ".";
    for (size_t c = 0; c < 3; ++c) {
      rgb[c] = RequireChannel(image, prefix + "RGB"[c], what).samples.data();
    }
    const ColorConversion conversion = ConversionToRec709(image.metadata);
    if (!conversion.matrix) return;
    const size_t pixels = image.channels[0].samples.size();
    for (size_t c = 0; c < 3; ++c) {
      converted_[c].assign(rgb[c], rgb[c] + pixels);
      rgb[c] = converted_[c].data();
    }
    ConvertColors(*conversion.matrix,
                  {converted_[0].data(), converted_[1].data(), converted_[2].data()}, 1, pixels,
                  /*clip=*/false);
  }

  nacre::DisplaySettings display;
  bool displayed;  // the values are display values already
  std::array<const float*, 3> rgb;

 private:
  std::array<std::vector<float>, 3> converted_;  // in Rec. 709, if the image has other primaries
};

// For values that are display values already.
void RoundToCodes(const std::array<const float*, 3>& rgb, size_t count, uint8_t* rgb8) {
  for (size_t i = 0; i < count; ++i) {
    for (size_t c = 0; c < 3; ++c) {
      const float value = std::min(std::max(rgb[c][i], 0.0f), 1.0f);
      rgb8[3 * i + c] = static_cast<uint8_t>(std::lround(255 * value));
    }
  }
}

// Drops A. Throws Error (kUsage) unless there are pixels, and four bytes for each.
Rgb8Picture ToOwn(const Picture& picture) {
  const bool any = picture.width > 0 && picture.height > 0;
  const size_t pixels =
      any ? static_cast<size_t>(picture.width) * static_cast<size_t>(picture.height) : 0;
  if (!any || picture.rgba.size() != 4 * pixels) {
    throw nacre::Error(ExitCode::kUsage, "picture",
                       "has " + std::to_string(picture.rgba.size()) + " bytes for " +
                           std::to_string(picture.width) + " x " + std::to_string(picture.height) +
                           " pixels",
                       "it has pixels, and four bytes for each");
  }
  Rgb8Picture own{picture.width, picture.height, {}};
  own.rgb8.resize(3 * pixels);
  for (size_t i = 0; i < pixels; ++i) {
    std::copy_n(picture.rgba.data() + 4 * i, 3, own.rgb8.data() + 3 * i);
  }
  return own;
}

// Writes the codes of `count` pixels, row by row from pixel `first` on: R, G and B of each.
void EncodePixels(const Shown& shown, size_t first, size_t count, uint8_t* rgb8) {
  const std::array<const float*, 3> from = {shown.rgb[0] + first, shown.rgb[1] + first,
                                            shown.rgb[2] + first};
  if (shown.displayed) return RoundToCodes(from, count, rgb8);
  EncodeDisplay(shown.display, from[0], from[1], from[2], count, rgb8);
}

}  // namespace

Picture ToneMap(const Image& image, const ToneMapSettings& settings) {
  return AtBorder([&] {
    const Shown shown(image, settings, "the picture");
    Picture picture{image.width(), image.height(), {}};
    const size_t pixels = image.channels[0].samples.size();
    picture.rgba.resize(4 * pixels, 255);
    constexpr size_t kBlock = size_t{1} << 14;
    ParallelForBlocks(pixels, kBlock, 0, [&](size_t first, size_t end) {
      std::array<uint8_t, 3 * kBlock> rgb8;
      EncodePixels(shown, first, end - first, rgb8.data());
      for (size_t i = first; i < end; ++i) {
        std::copy_n(rgb8.data() + 3 * (i - first), 3, picture.rgba.data() + 4 * i);
      }
    });
    return picture;
  });
}

std::vector<uint8_t> EncodePng(const Picture& picture) {
  return AtBorder([&] { return nacre::EncodePng(ToOwn(picture)); });
}

std::vector<uint8_t> EncodeJpeg(const Picture& picture, int quality) {
  return AtBorder([&] {
    if (quality < 1 || quality > 100) {
      throw nacre::Error(ExitCode::kUsage, "quality", "is not within 1 to 100");
    }
    constexpr int kMostPixels = 65500;  // per side: the limit of libjpeg
    if (std::max(picture.width, picture.height) > kMostPixels) {
      throw nacre::Error(ExitCode::kUsage, "picture", "is too large for a JPEG file",
                         "a side has at most 65500 pixels");
    }
    return nacre::EncodeJpeg(ToOwn(picture), quality);
  });
}

// ---- Files --------------------------------------------------------------------------------------

namespace {

nacre::PixelType ToFile(SampleType type, bool half_floats) {
  if (type == SampleType::kUint) return nacre::PixelType::kUint;
  const bool half = type == SampleType::kHalf && half_floats;
  return half ? nacre::PixelType::kHalf : nacre::PixelType::kFloat;
}

// Parses sixteen numbers, as the reader prints a matrix; nullopt for any other text.
std::optional<Imath::M44f> ParseMatrix(const std::string& text) {
  std::istringstream numbers(text);
  numbers.imbue(std::locale::classic());
  Imath::M44f matrix;
  for (int i = 0; i < 16; ++i) {
    if (!(numbers >> matrix[i / 4][i % 4])) return std::nullopt;
  }
  return matrix;
}

// Metadata that the file has by itself, and "transfer", which is not an attribute of any file.
bool IsFilesOwn(const std::string& name) {
  static const std::set<std::string> own = {
      "channels",          "chromaticities",     "chunkCount", "compression", "dataWindow",
      "displayWindow",     "lineOrder",          "name",       "transfer",    "type",
      "pixelAspectRatio",  "screenWindowCenter", "version",    "tiles",       "view",
      "screenWindowWidth", kExrChecksumAttribute};
  return own.contains(name);
}

// Converts metadata to an attribute; attributes of nacre keep their types.
nacre::ExrAttribute ToAttribute(const std::string& name, const std::string& text) {
  // The number, if the whole text is one; else the text.
  const auto number = [&](auto value) -> nacre::ExrAttribute {
    const char* const end = text.data() + text.size();
    const auto [last, error] = std::from_chars(text.data(), end, value);
    if (error != std::errc() || last != end) return text;
    return value;
  };
  if (name == "samplesPerPixel") return number(int{});
  if (name == "renderTime" || name == "nacre:maxError") return number(float{});
  return text;
}

nacre::ExrHeader MakeHeader(const Image& image, const WriteSettings& settings) {
  nacre::ExrHeader header;
  header.data = ToOwn(image.data);
  header.display = ToOwn(image.frame);
  if (header.display.empty()) header.display = header.data;
  for (const Channel& channel : image.channels) {
    header.channels.push_back({channel.name, ToFile(channel.type, settings.half_floats)});
  }
  header.attributes["Software"] = std::string("nacre ") + kVersion;
  for (const auto& [name, text] : image.metadata) {
    if (name == "worldToCamera") {
      header.world_to_camera = ParseMatrix(text);
    } else if (name == "worldToNDC") {
      header.world_to_ndc = ParseMatrix(text);
    } else if (!IsFilesOwn(name)) {
      header.attributes[name] = ToAttribute(name, text);
    }
  }
  return header;
}

void WriteExr(const Image& image, const std::string& path, const WriteSettings& settings) {
  const ExrOptions options{.compression = ParseCompression(settings.compression),
                           .small = settings.small};
  ExrWriter writer(path, MakeHeader(image, settings), options);
  std::vector<const float*> planes;
  for (const Channel& channel : image.channels) planes.push_back(channel.samples.data());
  writer.WriteAll(planes);
  writer.Finish();
}

void WritePng(const Image& image, const std::string& path, const WriteSettings& settings) {
  const Shown shown(image,
                    {.layer = "", .tonemap = settings.tonemap, .exposure = settings.exposure},
                    "a PNG file");
  PngHeader header;
  header.width = image.width();
  header.height = image.height();
  header.text = {{"Software", std::string("nacre ") + kVersion},
                 {"nacre:tonemap", shown.displayed ? "none" : settings.tonemap}};
  PngWriter writer(path, header, {.small = settings.small});
  writer.WriteAll(
      [&](size_t first, size_t count, uint8_t* rgb8) { EncodePixels(shown, first, count, rgb8); });
  writer.Finish();
}

}  // namespace

void Write(const Image& image, const std::string& path, const WriteSettings& settings) {
  AtBorder([&] {
    CheckImage(image);
    if (HasExtension(path, ".exr")) return WriteExr(image, path, settings);
    if (HasExtension(path, ".png")) return WritePng(image, path, settings);
    throw nacre::Error(ExitCode::kUsage, path, "unknown output extension",
                       "nacre writes .exr (linear, HDR) and .png (tone-mapped)");
  });
}

}  // namespace nacre::v0
