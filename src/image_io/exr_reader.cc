// SPDX-License-Identifier: Apache-2.0
#include "image_io/exr_reader.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <new>

#include <OpenEXR/ImfBoxAttribute.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfChromaticitiesAttribute.h>
#include <OpenEXR/ImfCompressionAttribute.h>
#include <OpenEXR/ImfDoubleAttribute.h>
#include <OpenEXR/ImfFloatAttribute.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputPart.h>
#include <OpenEXR/ImfIntAttribute.h>
#include <OpenEXR/ImfLineOrderAttribute.h>
#include <OpenEXR/ImfMatrixAttribute.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfStringVectorAttribute.h>
#include <OpenEXR/ImfTileDescription.h>
#include <OpenEXR/ImfVecAttribute.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/error.h"
#include "image_io/exr_header_check.h"

namespace nacre {
namespace {

constexpr uint64_t kMaxSamples = (uint64_t{2} << 30) / sizeof(float);

[[noreturn]] void Fail(const std::string& path, const std::string& what,
                       const std::string& hint = {}) {
  throw Error(ExitCode::kBadInput, path, what, hint);
}

Window ToWindow(const Imath::Box2i& box) {
  return {box.min.x, box.min.y, box.max.x + 1, box.max.y + 1};
}

PixelType ToPixelType(Imf::PixelType type) {
  switch (type) {
    case Imf::HALF:
      return PixelType::kHalf;
    case Imf::UINT:
      return PixelType::kUint;
    default:
      return PixelType::kFloat;
  }
}

std::string CompressionName(Imf::Compression compression) {
  constexpr std::array<const char*, Imf::NUM_COMPRESSION_METHODS> kNames = {
      "none", "rle", "zips", "zip", "piz", "pxr24", "b44", "b44a", "dwaa", "dwab"};
  const auto index = static_cast<size_t>(compression);
  return index < kNames.size() ? kNames[index] : "unknown";
}

std::string LineOrderName(Imf::LineOrder order) {
  switch (order) {
    case Imf::INCREASING_Y:
      return "increasing y";
    case Imf::DECREASING_Y:
      return "decreasing y";
    default:
      return "random y";
  }
}

template <typename T>
std::string NumbersText(const T* values, size_t count) {
  return fmt::format("{}", fmt::join(values, values + count, " "));
}

// The attribute's value as text if it is a TypedAttribute<T>.
template <typename T, typename Format>
bool Describe(const Imf::Attribute& attribute, const Format& format, std::string* text) {
  const auto* typed = dynamic_cast<const Imf::TypedAttribute<T>*>(&attribute);
  if (typed != nullptr) *text = format(typed->value());
  return typed != nullptr;
}

std::string AttributeText(const Imf::Attribute& attribute) {
  const auto number = [](const auto& v) { return fmt::format("{}", v); };
  const auto vector = [](const auto& v) { return NumbersText(&v[0], v.dimensions()); };
  const auto box = [&](const auto& v) { return vector(v.min) + " " + vector(v.max); };
  const auto matrix = [](const auto& v) {
    return NumbersText(&v[0][0], sizeof(v) / sizeof(v[0][0]));
  };
  const auto primaries = [&](const Imf::Chromaticities& v) {
    return vector(v.red) + " " + vector(v.green) + " " + vector(v.blue) + " " + vector(v.white);
  };
  const auto strings = [](const Imf::StringVector& v) {
    return fmt::format("{}", fmt::join(v, "\n"));
  };
  std::string text;
  if (Describe<std::string>(attribute, number, &text) || Describe<int>(attribute, number, &text) ||
      Describe<float>(attribute, number, &text) || Describe<double>(attribute, number, &text) ||
      Describe<Imath::V2i>(attribute, vector, &text) ||
      Describe<Imath::V2f>(attribute, vector, &text) ||
      Describe<Imath::V2d>(attribute, vector, &text) ||
      Describe<Imath::V3i>(attribute, vector, &text) ||
      Describe<Imath::V3f>(attribute, vector, &text) ||
      Describe<Imath::V3d>(attribute, vector, &text) ||
      Describe<Imath::Box2i>(attribute, box, &text) ||
      Describe<Imath::Box2f>(attribute, box, &text) ||
      Describe<Imath::M33f>(attribute, matrix, &text) ||
      Describe<Imath::M44f>(attribute, matrix, &text) ||
      Describe<Imath::M44d>(attribute, matrix, &text) ||
      Describe<Imf::Chromaticities>(attribute, primaries, &text) ||
      Describe<Imf::StringVector>(attribute, strings, &text) ||
      Describe<Imf::Compression>(attribute, CompressionName, &text) ||
      Describe<Imf::LineOrder>(attribute, LineOrderName, &text)) {
    return text;
  }
  return fmt::format("<{}>", attribute.typeName());
}

Image DescribeHeader(const std::string& path, const Imf::Header& header) {
  if (header.hasType() && Imf::isDeepData(header.type())) {
    Fail(path, "is a deep image", "flatten it first");
  }
  Image image;
  image.display = ToWindow(header.displayWindow());
  image.data = ToWindow(header.dataWindow());
  for (auto it = header.channels().begin(); it != header.channels().end(); ++it) {
    const Imf::Channel& channel = it.channel();
    if (channel.xSampling != 1 || channel.ySampling != 1) {
      Fail(path, std::string("channel ") + it.name() + " is subsampled",
           "convert it to R, G and B of full resolution first");
    }
    image.channels.push_back({it.name(), ToPixelType(channel.type), {}});
  }
  for (auto it = header.begin(); it != header.end(); ++it) {
    const std::string name = it.name();
    if (name == "channels" || name == "dataWindow" || name == "displayWindow") continue;
    image.metadata[name] = AttributeText(it.attribute());
  }
  return image;
}

// OpenEXR makes room for a tile, and for a row of tiles over the picture's width, as large as the
// header tells, however small the picture is.
void CheckTiles(const std::string& path, const Imf::Header& header, uint64_t width, uint64_t height,
                uint64_t channels) {
  if (!header.hasTileDescription()) return;
  constexpr uint64_t kSmall = uint64_t{1} << 26;  // samples, 256 MiB
  const Imf::TileDescription& tiles = header.tileDescription();
  const uint64_t most = std::max(kSmall, width * height * channels);
  const uint64_t across = std::max<uint64_t>(width, tiles.xSize);  // both below 2^31
  if (tiles.ySize > most / channels / std::max<uint64_t>(across, 1)) {
    Fail(path, fmt::format("its tiles of {} x {} are too large for {} x {} pixels", tiles.xSize,
                           tiles.ySize, width, height));
  }
}

void ReadSamples(const std::string& path, Imf::MultiPartInputFile& file, Image* image) {
  const Window& data = image->data;
  const auto width = static_cast<uint64_t>(int64_t{data.x1} - data.x0);
  const auto height = static_cast<uint64_t>(int64_t{data.y1} - data.y0);
  if (height != 0 && width * image->channels.size() > kMaxSamples / height) {
    Fail(path, fmt::format("{} x {} pixels of {} channels are more than 2 GiB", width, height,
                           image->channels.size()));
  }
  if (image->channels.empty()) Fail(path, "has no channels");
  CheckTiles(path, file.header(0), width, height, image->channels.size());
  Imf::FrameBuffer frame;
  for (Channel& channel : image->channels) {
    channel.samples.reserve(width * height);
    frame.insert(channel.name,
                 Imf::Slice::Make(Imf::FLOAT, channel.samples.data(), Imath::V2i(data.x0, data.y0),
                                  static_cast<int64_t>(width), static_cast<int64_t>(height),
                                  sizeof(float), width * sizeof(float)));
  }
  Imf::InputPart part(file, 0);
  part.setFrameBuffer(frame);
  // In bands, and memory is touched only for those that are there: a header costs a liar nothing.
  constexpr int64_t kBand = 256;  // rows: the most that any compression takes together
  for (int64_t y = data.y0; y < data.y1; y += kBand) {
    const int64_t end = std::min<int64_t>(y + kBand, data.y1);
    for (Channel& channel : image->channels) {
      channel.samples.resize(static_cast<uint64_t>(end - data.y0) * width);
    }
    part.readPixels(static_cast<int>(y), static_cast<int>(end - 1));
  }
}

Image Read(const std::string& path, bool with_samples) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) Fail(path, "no such file");
  if (!std::filesystem::is_regular_file(status)) Fail(path, "is not a regular file");
  CheckExrHeader(path);
  try {
    constexpr int kNoThreads = 0;
    Imf::MultiPartInputFile file(path.c_str(), kNoThreads);
    Image image = DescribeHeader(path, file.header(0));
    if (with_samples) ReadSamples(path, file, &image);
    return image;
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    Fail(path, "there is no memory for it");
  } catch (const std::exception& exception) {
    Fail(path, std::string("cannot be read as EXR: ") + exception.what());
  }
}

}  // namespace

Image ReadExr(const std::string& path) { return Read(path, true); }

Image ReadExrHeader(const std::string& path) { return Read(path, false); }

}  // namespace nacre
