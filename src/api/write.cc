// SPDX-License-Identifier: Apache-2.0
// api/write.cc: writes images of the public API to EXR and PNG files.
#include <algorithm>
#include <charconv>
#include <locale>
#include <set>
#include <sstream>
#include <system_error>

#include "api/shown.h"
#include "base/path.h"
#include "base/version.h"
#include "image_io/exr_checksum.h"
#include "image_io/exr_writer.h"
#include "image_io/png_writer.h"

namespace nacre::v0 {
namespace {

nacre::PixelType ToFile(SampleType type, bool half_floats) {
  switch (type) {
    case SampleType::kHalf:
      return half_floats ? nacre::PixelType::kHalf : nacre::PixelType::kFloat;
    case SampleType::kFloat:
      return nacre::PixelType::kFloat;
    case SampleType::kUint:
      return nacre::PixelType::kUint;
  }
  return nacre::PixelType::kFloat;
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
