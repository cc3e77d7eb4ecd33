// SPDX-License-Identifier: Apache-2.0
#include "image_io/exr_bands.h"

#include <algorithm>
#include <set>

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFloatAttribute.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfIntAttribute.h>
#include <OpenEXR/ImfMatrixAttribute.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfStringAttribute.h>

#include "base/error.h"
#include "base/input_file.h"
#include "image_io/exr_check.h"
#include "image_io/exr_checksum.h"
#include "image_io/exr_types.h"
#include "image_io/image_file.h"

namespace nacre {
namespace {

constexpr char kRenderAgain[] = "render this tile again";

[[noreturn]] void RefuseBand(const std::string& path, const std::string& what) {
  throw Error(ExitCode::kBadInput, path, what, kRenderAgain);
}

[[noreturn]] void RefuseKind(const std::string& path, const std::string& what) {
  throw Error(ExitCode::kBadInput, path, "is not a file that nacre wrote: " + what);
}

Compression ToCompression(const std::string& path, Imf::Compression compression) {
  if (const auto known = CompressionOfNumber(compression)) return *known;
  RefuseKind(path, "its compression is not one of nacre's");
}

// Attributes that every file has, and those that ExrContainer writes itself.
const std::set<std::string> kStructure = {
    "channels",  "compression",      "dataWindow",         "displayWindow",
    "lineOrder", "pixelAspectRatio", "screenWindowCenter", "screenWindowWidth",
    "type",      "chromaticities",   kExrChecksumAttribute};

void AddAttribute(const std::string& path, const std::string& name, const Imf::Attribute& attribute,
                  ExrHeader* header) {
  if (const auto* number = dynamic_cast<const Imf::IntAttribute*>(&attribute)) {
    header->attributes[name] = number->value();
  } else if (const auto* real = dynamic_cast<const Imf::FloatAttribute*>(&attribute)) {
    header->attributes[name] = real->value();
  } else if (const auto* text = dynamic_cast<const Imf::StringAttribute*>(&attribute)) {
    header->attributes[name] = text->value();
  } else if (const auto* matrix = dynamic_cast<const Imf::M44fAttribute*>(&attribute)) {
    if (name == "worldToCamera") header->world_to_camera = matrix->value();
    if (name == "worldToNDC") header->world_to_ndc = matrix->value();
  } else {
    RefuseKind(path, "its header has an attribute " + name);
  }
}

// An uncompressed chunk has exactly its full size, and a compressed one is never larger. OpenEXR
// would fill what is missing with zeros.
void CheckChunkSize(const std::string& path, const Imf::Header& header, int y, int size) {
  const Window data = ToWindow(header.dataWindow());
  size_t row_bytes = 0;
  for (auto it = header.channels().begin(); it != header.channels().end(); ++it) {
    row_bytes += static_cast<size_t>(data.width()) * (it.channel().type == Imf::HALF ? 2 : 4);
  }
  const Compression compression = ToCompression(path, header.compression());
  const int rows = std::min(RowsPerChunk(compression), data.y1 - y);
  const size_t full = row_bytes * static_cast<size_t>(rows);
  const auto bytes = static_cast<size_t>(size);
  if (size <= 0 || bytes > full || (compression == Compression::kNone && bytes != full)) {
    RefuseBand(path, "is damaged: the rows from " + std::to_string(y) + " on have " +
                         std::to_string(size) + " bytes, not " + std::to_string(full));
  }
}

}  // namespace

ExrBandReader::ExrBandReader(const std::string& path) : path_(path) {
  CheckInputFile(path);
  CheckExrHeader(path);
  WithOpenExr(path_, kRenderAgain, [&] {
    constexpr int kNoThreads = 0;
    file_ = std::make_unique<Imf::InputFile>(path.c_str(), kNoThreads);
    const Imf::Header& header = file_->header();
    if (header.hasTileDescription() || header.lineOrder() != Imf::INCREASING_Y) {
      RefuseKind(path, "it does not hold lines from the top down");
    }
    if (!file_->isComplete()) RefuseBand(path, "is not complete");
  });
}

ExrBandReader::~ExrBandReader() = default;

ExrBandHeader ExrBandReader::ReadHeader() const {
  const Imf::Header& from = file_->header();
  ExrBandHeader band;
  band.compression = ToCompression(path_, from.compression());
  band.header.display = ToWindow(from.displayWindow());
  band.header.data = ToWindow(from.dataWindow());
  for (auto it = from.channels().begin(); it != from.channels().end(); ++it) {
    if (it.channel().xSampling != 1 || it.channel().ySampling != 1) {
      RefuseKind(path_, std::string("channel ") + it.name() + " is subsampled");
    }
    band.header.channels.push_back({it.name(), ToPixelType(it.channel().type)});
  }
  if (Imf::hasChromaticities(from) && Imf::chromaticities(from) != Imf::Chromaticities()) {
    RefuseKind(path_, "its primaries are not Rec. 709's");
  }
  for (auto it = from.begin(); it != from.end(); ++it) {
    if (kStructure.contains(it.name())) continue;
    AddAttribute(path_, it.name(), it.attribute(), &band.header);
  }
  return band;
}

std::vector<uint8_t> ExrBandReader::ReadChunk(int y) {
  return WithOpenExr(path_, kRenderAgain, [&]() -> std::vector<uint8_t> {
    const char* bytes = nullptr;
    int size = 0;
    file_->rawPixelData(y, bytes, size);
    CheckChunkSize(path_, file_->header(), y, size);
    return {bytes, bytes + size};
  });
}

void ExrBandReader::DecodeAll() {
  // OpenEXR's reader allocates what the header says, and leaves memory uninitialised that short
  // chunks do not fill.
  CheckExrChunks(path_, 0, FileBytes(path_));
  const Imf::Header& header = file_->header();
  const Window data = ToWindow(header.dataWindow());
  std::vector<std::string> channels;
  for (auto it = header.channels().begin(); it != header.channels().end(); ++it) {
    channels.emplace_back(it.name());
  }
  const int rows = RowsPerChunk(ToCompression(path_, header.compression()));
  std::vector<std::vector<float>> planes;
  for (int y = data.y0; y < data.y1; y += rows) {
    ReadChunk(y);
    ReadRows(y, std::min(rows, data.y1 - y), channels, &planes);
  }
}

void ExrBandReader::ReadRows(int y, int rows, const std::vector<std::string>& channels,
                             std::vector<std::vector<float>>* planes) {
  const Window data = ToWindow(file_->header().dataWindow());
  const auto width = static_cast<size_t>(data.width());
  planes->resize(channels.size());
  Imf::FrameBuffer frame;
  for (size_t c = 0; c < channels.size(); ++c) {
    std::vector<float>& plane = (*planes)[c];
    plane.resize(width * static_cast<size_t>(rows));
    frame.insert(channels[c], Imf::Slice::Make(Imf::FLOAT, plane.data(), Imath::V2i(data.x0, y),
                                               data.width(), rows));
  }
  WithOpenExr(path_, kRenderAgain, [&] {
    file_->setFrameBuffer(frame);
    file_->readPixels(y, y + rows - 1);
  });
}

}  // namespace nacre
