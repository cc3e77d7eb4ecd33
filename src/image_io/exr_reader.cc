// SPDX-License-Identifier: Apache-2.0
// image_io/exr_reader.cc: reads EXR files with OpenEXR.
#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <memory>
#include <set>
#include <utility>

#include <Imath/half.h>
#include <OpenEXR/ImfBoxAttribute.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfChromaticitiesAttribute.h>
#include <OpenEXR/ImfCompressionAttribute.h>
#include <OpenEXR/ImfDoubleAttribute.h>
#include <OpenEXR/ImfEnvmapAttribute.h>
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
#include "base/input_file.h"
#include "image_io/exr_check.h"
#include "image_io/exr_types.h"
#include "image_io/format_readers.h"

namespace nacre {
namespace {

[[noreturn]] void Fail(const std::string& path, const std::string& what,
                       const std::string& hint = {}) {
  throw Error(ExitCode::kBadInput, path, what, hint);
}

// The name of any compression in a file; exr_compression.h knows only those that nacre writes.
std::string FileCompressionName(Imf::Compression compression) {
  constexpr std::array<const char*, Imf::NUM_COMPRESSION_METHODS> kNames = {
      "none", "rle", "zips", "zip", "piz", "pxr24", "b44", "b44a", "dwaa", "dwab"};
  const auto index = static_cast<size_t>(compression);
  return index < kNames.size() ? kNames[index] : "unknown";
}

std::string LineOrderName(Imf::LineOrder order) {
  if (order == Imf::INCREASING_Y) return "increasing y";
  return order == Imf::DECREASING_Y ? "decreasing y" : "random y";
}

template <typename T>
std::string NumbersText(const T* values, size_t count) {
  return fmt::format("{}", fmt::join(values, values + count, " "));
}

// Sets *text to the attribute's value if it is a TypedAttribute of one of the types; returns
// whether it is.
template <typename... Types, typename Format>
bool Describe(const Imf::Attribute& attribute, const Format& format, std::string* text) {
  const auto describe = [&](const auto* typed) {
    if (typed != nullptr) *text = format(typed->value());
    return typed != nullptr;
  };
  return (describe(dynamic_cast<const Imf::TypedAttribute<Types>*>(&attribute)) || ...);
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
  const auto envmap = [](Imf::Envmap v) {
    return std::string(v == Imf::ENVMAP_CUBE      ? "cube"
                       : v == Imf::ENVMAP_LATLONG ? "latlong"
                                                  : "unknown");
  };
  std::string text;
  if (Describe<std::string, int, float, double>(attribute, number, &text) ||
      Describe<Imath::V2i, Imath::V2f, Imath::V2d, Imath::V3i, Imath::V3f, Imath::V3d>(
          attribute, vector, &text) ||
      Describe<Imath::Box2i, Imath::Box2f>(attribute, box, &text) ||
      Describe<Imath::M33f, Imath::M44f, Imath::M44d>(attribute, matrix, &text) ||
      Describe<Imf::Chromaticities>(attribute, primaries, &text) ||
      Describe<Imf::StringVector>(attribute, strings, &text) ||
      Describe<Imf::Compression>(attribute, FileCompressionName, &text) ||
      Describe<Imf::Envmap>(attribute, envmap, &text) ||
      Describe<Imf::LineOrder>(attribute, LineOrderName, &text)) {
    return text;
  }
  return fmt::format("<{}>", attribute.typeName());
}

// Why the part's samples cannot be read; "" if they can.
std::string Refusal(const ImagePart& part, const Imf::Header& header) {
  if (header.hasType() && Imf::isDeepData(header.type())) return "is a deep image";
  if (part.channels.empty()) return "has no channels";
  const auto has = [&](const char* name) { return header.channels().findChannel(name) != nullptr; };
  if (has("RY") && has("BY")) return "has luminance and chroma (Y, RY, BY) for colours";
  for (const ImagePart::PartChannel& channel : part.channels) {
    if (channel.x_sampling != 1 || channel.y_sampling != 1) {
      return "channel " + channel.name + " is subsampled";
    }
  }
  return {};
}

std::string RefusalHint(const std::string& refusal) {
  if (refusal == "is a deep image") return "flatten it first";
  if (refusal == "has no channels") return {};
  return "convert it to R, G and B of full resolution first";
}

ImagePart DescribePart(const Imf::Header& header) {
  ImagePart part;
  if (header.hasName()) part.name = header.name();
  part.display = ToWindow(header.displayWindow());
  part.data = ToWindow(header.dataWindow());
  for (auto it = header.channels().begin(); it != header.channels().end(); ++it) {
    const Imf::Channel& channel = it.channel();
    part.channels.push_back(
        {it.name(), ToPixelType(channel.type), channel.xSampling, channel.ySampling});
  }
  for (auto it = header.begin(); it != header.end(); ++it) {
    const std::string name = it.name();
    if (name == "channels" || name == "dataWindow" || name == "displayWindow") continue;
    part.metadata[name] = AttributeText(it.attribute());
  }
  part.refusal = Refusal(part, header);
  return part;
}

// The number of rows that are decoded together.
int BandRows(const Imf::Header& header) {
  constexpr int kLeast = 32, kMost = 256;  // rows; the latter for DWAB, whose chunks have as many
  if (header.hasTileDescription()) return static_cast<int>(header.tileDescription().ySize);
  return header.compression() == Imf::DWAB_COMPRESSION ? kMost : kLeast;
}

// A channel to read, and where its samples go.
struct WantedChannel {
  std::string name;
  SampleTarget target;
};

// Copies the samples [first, first + count) of a row of a channel to floats.
void CopySamples(Imf::PixelType type, const uint16_t* row, size_t first, size_t count, float* to,
                 ptrdiff_t step) {
  for (size_t x = first; x < first + count; ++x, to += step) {
    if (type == Imf::HALF) {
      *to = imath_half_to_float(row[x]);
    } else if (type == Imf::UINT) {
      uint32_t id;
      std::memcpy(&id, row + 2 * x, sizeof(id));
      *to = static_cast<float>(id);
    } else {
      std::memcpy(to, row + 2 * x, sizeof(*to));
    }
  }
}

// Reads a part of scanlines that is compressed by ZIP or ZIPS, as nacre's files and most others
// are. Returns false, and reads nothing, if it is of another kind.
bool ReadLines(const std::string& path, uint64_t file_bytes, const Imf::Header& header, int index,
               const Window& region, const std::vector<WantedChannel>& wanted) {
  const Window data = ToWindow(header.dataWindow());
  const Window common = Intersect(data, region);
  const auto width = static_cast<size_t>(data.width());
  size_t row_words = 0;
  for (auto it = header.channels().begin(); it != header.channels().end(); ++it) {
    row_words += width * (it.channel().type == Imf::HALF ? 1 : 2);
  }
  return DecodeExrLines(path, index, file_bytes, [&](const ExrChunkRows& chunk) {
    if (chunk.words.size() != row_words * static_cast<size_t>(chunk.rows)) {
      Fail(path, "cannot be read as EXR: its channels are not told the same way twice");
    }
    const uint16_t* row = chunk.words.data();
    for (int y = chunk.y; y < chunk.y + chunk.rows; ++y) {
      for (auto it = header.channels().begin(); it != header.channels().end(); ++it) {
        const Imf::PixelType type = it.channel().type;
        for (const WantedChannel& channel : wanted) {
          if (y < common.y0 || y >= common.y1 || channel.name != it.name()) continue;
          const SampleTarget& target = channel.target;
          CopySamples(type, row, static_cast<size_t>(common.x0 - data.x0),
                      static_cast<size_t>(common.width()),
                      target.first + (y - region.y0) * target.step_y +
                          (common.x0 - region.x0) * target.step_x,
                      target.step_x);
        }
        row += width * (type == Imf::HALF ? 1 : 2);
      }
    }
  });
}

void ReadPart(const std::string& path, uint64_t file_bytes, Imf::MultiPartInputFile& file,
              int index, const Window& region, const std::vector<WantedChannel>& wanted) {
  const Imf::Header& header = file.header(index);
  const Window data = ToWindow(header.dataWindow());
  const Window common = Intersect(data, region);
  if (common.empty()) return;
  if (ReadLines(path, file_bytes, header, index, region, wanted)) return;
  CheckExrChunks(path, index, file_bytes);
  const auto width = static_cast<size_t>(data.width());
  const int band = std::min(BandRows(header), data.height());
  CheckSampleCount(path, file_bytes, data.width(), band, wanted.size());
  Imf::InputPart part(file, index);
  if (!part.isComplete()) Fail(path, "cannot be read as EXR: it is not complete");
  std::vector<std::vector<float>> rows(wanted.size());
  for (std::vector<float>& samples : rows) samples.resize(width * static_cast<size_t>(band));
  // Bands are counted from the data window's first row, so that each chunk is decoded only once.
  const int first = data.y0 + (common.y0 - data.y0) / band * band;
  for (int y = first; y < common.y1; y += band) {
    const int end = std::min(y + band, data.y1);
    Imf::FrameBuffer frame;
    for (size_t c = 0; c < wanted.size(); ++c) {
      frame.insert(wanted[c].name,
                   Imf::Slice::Make(Imf::FLOAT, rows[c].data(), Imath::V2i(data.x0, y),
                                    data.width(), end - y, sizeof(float), width * sizeof(float)));
    }
    part.setFrameBuffer(frame);
    part.readPixels(y, end - 1);
    for (size_t c = 0; c < wanted.size(); ++c) {
      const SampleTarget& target = wanted[c].target;
      for (int row = std::max(y, common.y0); row < std::min(end, common.y1); ++row) {
        const float* from = rows[c].data() + static_cast<size_t>(row - y) * width +
                            static_cast<size_t>(common.x0 - data.x0);
        float* to = target.first + (row - region.y0) * target.step_y +
                    (common.x0 - region.x0) * target.step_x;
        for (int x = common.x0; x < common.x1; ++x, to += target.step_x) *to = *from++;
      }
    }
  }
}

struct OpenedExr {
  std::unique_ptr<Imf::MultiPartInputFile> file;
  std::vector<ImagePart> parts;
};

OpenedExr OpenParts(const std::string& path) {
  CheckInputFile(path);
  CheckExrHeader(path);
  OpenedExr opened;
  WithOpenExr(path, {}, [&] {
    constexpr int kNoThreads = 0;
    // The chunk table may be incomplete at this point: ReadPart checks it before decoding.
    opened.file = std::make_unique<Imf::MultiPartInputFile>(path.c_str(), kNoThreads);
    for (int i = 0; i < opened.file->parts(); ++i) {
      opened.parts.push_back(DescribePart(opened.file->header(i)));
    }
  });
  return opened;
}

// The index of the part to read, or -1 for all of them.
int ChoosePart(const std::string& path, const std::vector<ImagePart>& parts,
               const std::string& name) {
  if (name.empty()) return parts.size() == 1 ? 0 : -1;
  std::vector<std::string> names;
  for (size_t i = 0; i < parts.size(); ++i) {
    if (parts[i].name == name) return static_cast<int>(i);
    if (!parts[i].name.empty()) names.push_back(parts[i].name);
  }
  constexpr size_t kMost = 8;
  const std::string nearest = NearestName(name, names);
  const size_t shown = std::min(names.size(), kMost);
  const std::string list =
      fmt::format("its parts: {}{}", fmt::join(names.data(), names.data() + shown, ", "),
                  shown < names.size() ? ", ..." : "");
  Fail(path, "has no part \"" + name + "\"",
       names.empty()     ? "its only part has no name: leave that out"
       : nearest.empty() ? list
                         : "did you mean \"" + nearest + "\"? " + list);
}

}  // namespace

std::vector<ImagePart> DescribeExr(const std::string& path) { return OpenParts(path).parts; }

ImageFile OpenExr(const std::string& path, const std::string& part) {
  OpenedExr opened = OpenParts(path);
  const int only = ChoosePart(path, opened.parts, part);
  ImageFile image;
  image.path = path;
  image.file_bytes = FileBytes(path);
  image.parts = std::move(opened.parts);
  image.has_several = only < 0;
  // For each channel of the image, its part, and its name in that part.
  std::vector<std::pair<int, std::string>> sources;
  for (int i = 0; i < static_cast<int>(image.parts.size()); ++i) {
    if (only >= 0 && i != only) continue;
    const ImagePart& from = image.parts[static_cast<size_t>(i)];
    const std::string prefix = only >= 0 ? std::string() : from.name + ".";
    if (!from.refusal.empty()) {
      Fail(path, only >= 0 ? from.refusal : "part \"" + from.name + "\" " + from.refusal,
           only >= 0 ? RefusalHint(from.refusal) : "choose another part; nacre info lists them");
    }
    image.header.display = from.display;
    Window& data = image.header.data;
    data = data.empty() ? from.data : BoundingWindow(data, from.data);
    for (const ImagePart::PartChannel& channel : from.channels) {
      image.header.channels.push_back({prefix + channel.name, channel.type, {}});
      sources.emplace_back(i, channel.name);
    }
    for (const auto& [name, value] : from.metadata) image.header.metadata[prefix + name] = value;
  }
  std::set<std::string> names;
  for (const Channel& channel : image.header.channels) {
    if (names.insert(channel.name).second) continue;
    Fail(path, "channels of two of its parts are both called \"" + channel.name + "\"",
         "choose a part; nacre info lists them");
  }
  const Window& all = image.header.data;
  constexpr int64_t kFar = std::numeric_limits<int>::max();
  if (int64_t{all.x1} - all.x0 > kFar || int64_t{all.y1} - all.y0 > kFar) {
    Fail(path, "its parts are too far from each other", "choose one; nacre info lists them");
  }
  // The attribute is shared by all parts.
  const auto& shared = image.parts.front().metadata;
  if (const auto found = shared.find("chromaticities"); found != shared.end()) {
    image.header.metadata["chromaticities"] = found->second;
  }
  image.header.metadata["transfer"] = "linear";
  image.read = [path, sources, bytes = image.file_bytes, parts = image.parts,
                file = std::shared_ptr<Imf::MultiPartInputFile>(std::move(opened.file))](
                   const Window& region, std::span<const SampleTarget> targets) {
    std::vector<std::vector<WantedChannel>> by_part(parts.size());
    for (const SampleTarget& target : targets) {
      const auto& [index, name] = sources.at(target.channel);
      by_part[static_cast<size_t>(index)].push_back({name, target});
      if (Intersect(parts[static_cast<size_t>(index)].data, region) == region) continue;
      for (int y = 0; y < region.height(); ++y) {
        for (int x = 0; x < region.width(); ++x) {
          target.first[x * target.step_x + y * target.step_y] = 0;
        }
      }
    }
    WithOpenExr(path, {}, [&] {
      for (size_t i = 0; i < parts.size(); ++i) {
        if (!by_part[i].empty()) {
          ReadPart(path, bytes, *file, static_cast<int>(i), region, by_part[i]);
        }
      }
    });
  };
  return image;
}

}  // namespace nacre
