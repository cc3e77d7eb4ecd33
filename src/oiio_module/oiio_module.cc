// SPDX-License-Identifier: Apache-2.0
// oiio_module/oiio_module.cc: implements the functions of image_io/oiio_abi.h with OpenImageIO.
#include <algorithm>
#include <array>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include <OpenImageIO/imageio.h>
#include <tiffio.h>

// Only these names are exported.
#pragma GCC visibility push(default)
#include "image_io/oiio_abi.h"
#pragma GCC visibility pop
#include "image_io/icc_profile.h"

// The library defines it, but its headers do not declare it.
OIIO_NAMESPACE_BEGIN
ImageInput* tiff_input_imageio_create();
OIIO_NAMESPACE_END

namespace {

// For failures of OpenImageIO without a message, as for TIFF files with new versions of libtiff.
constexpr const char* kNoReason = "its contents are damaged, or end early";

// Keeps the message's first line; the following ones are details that OpenImageIO adds.
const char* KeepMessage(const std::string& message) {
  thread_local std::array<char, 1024> kept;
  const std::string line = message.substr(0, message.find('\n'));
  std::snprintf(kept.data(), kept.size(), "%s", line.empty() ? kNoReason : line.c_str());
  return kept.data();
}

// A copy to be freed by C; `strings` may contain NULs.
char* Copy(const std::string& strings) {
  auto* copy = static_cast<char*>(std::malloc(strings.size() + 1));
  if (copy == nullptr) throw std::bad_alloc();
  std::memcpy(copy, strings.c_str(), strings.size() + 1);
  return copy;
}

// The first message of libtiff on this thread, even if it is only a warning: after a warning,
// libtiff continues with made-up pixels (for a missing end of a fax or JPEG), and so does
// OpenImageIO.
thread_local std::array<char, 600> g_complaint;  // "": none

void TakeComplaint(const char* module, const char* format, va_list arguments) {
  if (g_complaint[0] != '\0') return;  // the first message tells the cause
  std::array<char, 512> text{};
  std::vsnprintf(text.data(), text.size(), format, arguments);
  std::string complaint = std::string(module == nullptr ? "libtiff" : module) + ": " + text.data();
  complaint.erase(complaint.find_last_not_of(": ") + 1);  // left if zlib gives no reason
  std::snprintf(g_complaint.data(), g_complaint.size(), "%s", complaint.c_str());
}

void DescribeImage(const OIIO::ImageSpec& spec, NacreOiioFile* file) {
  const int32_t data[] = {spec.x, spec.y, spec.x + spec.width, spec.y + spec.height};
  const int32_t display[] = {spec.full_x, spec.full_y, spec.full_x + spec.full_width,
                             spec.full_y + spec.full_height};
  std::ranges::copy(data, file->data_window);
  std::ranges::copy(display, file->display_window);
  file->channel_count = spec.nchannels;
  file->integer_samples = spec.format.is_floating_point() ? 0 : 1;
  file->half_samples = spec.format == OIIO::TypeDesc::HALF ? 1 : 0;
  file->orientation = spec.get_int_attribute("Orientation", 1);
  constexpr uint64_t kBandSamples = 1 << 18;  // a megabyte
  const uint64_t row = std::max<uint64_t>(
      1, static_cast<uint64_t>(spec.width) * static_cast<uint64_t>(spec.nchannels));
  file->band_rows = spec.tile_height > 0
                        ? spec.tile_height
                        : static_cast<int32_t>(std::clamp<uint64_t>(kBandSamples / row, 1, 64));
  std::string names;
  for (int c = 0; c < spec.nchannels; ++c) names += std::string(spec.channel_name(c)) + '\0';
  file->channel_names = Copy(names);
  std::string attributes;
  const auto add = [&](const std::string& name, const std::string& value) {
    attributes += name + '\0' + value + '\0';
  };
  for (const OIIO::ParamValue& attribute : spec.extra_attribs) {
    if (attribute.name().empty() || attribute.name() == "ICCProfile") continue;
    add(attribute.name().string(), attribute.get_string());
  }
  if (const OIIO::ParamValue* const embedded = spec.find_attribute("ICCProfile")) {
    const nacre::IccProfile profile = nacre::ReadIccProfile(
        {static_cast<const uint8_t*>(embedded->data()), static_cast<size_t>(embedded->datasize())});
    add("icc_profile", profile.name);
    if (!profile.is_srgb) add("not_srgb", "the ICC profile \"" + profile.name + "\"");
  }
  file->attributes = Copy(attributes);
}

std::string Open(const char* path, uint64_t max_samples, NacreOiioFile* file) {
  OIIO::ImageSpec config;
  config["oiio:UnassociatedAlpha"] = 1;  // keeps the file's values, not multiplied by alpha
  // An untrusted file must not choose among the forty readers of OpenImageIO. Nor is OpenImageIO's
  // list of readers used: to make it, OpenImageIO loads code from the folders in OIIO_LIBRARY_PATH
  // and LD_LIBRARY_PATH.
  OIIO::ImageInput::unique_ptr input(OIIO::tiff_input_imageio_create());
  OIIO::ImageSpec spec;
  if (!input->open(path, spec, config)) return input->geterror();
  if (spec.width < 1 || spec.height < 1 || spec.depth > 1 || spec.nchannels < 1) {
    return "not a flat picture";
  }
  constexpr int kFar = 1 << 30;  // sums of two of these stay in range
  for (const int number : {spec.x, spec.y, spec.width, spec.height, spec.full_x, spec.full_y,
                           spec.full_width, spec.full_height}) {
    if (number < -kFar || number > kFar) return "its size or place is out of range";
  }
  const uint64_t tile_width = static_cast<uint64_t>(std::max(spec.tile_width, 0));
  const uint64_t tile_height = static_cast<uint64_t>(std::max(spec.tile_height, 0));
  // Divides, because the product may wrap around.
  const auto channels = static_cast<uint64_t>(spec.nchannels);
  const uint64_t across = std::max(tile_width, static_cast<uint64_t>(spec.width));
  if (tile_height > max_samples / channels / across) return "its tiles are too large";
  // Replaces OpenImageIO's handlers, which it sets only once, when it opens the first file.
  TIFFSetErrorHandler(&TakeComplaint);
  TIFFSetWarningHandler(&TakeComplaint);
  // With several threads, OpenImageIO inflates tiles itself without checking that they are
  // complete.
  input->threads(1);
  DescribeImage(spec, file);
  file->input = input.release();
  return {};
}

std::string ReadAs(OIIO::TypeDesc type, NacreOiioFile* file, int32_t y0, int32_t y1, void* to) {
  auto* const input = static_cast<OIIO::ImageInput*>(file->input);
  const OIIO::ImageSpec spec = input->spec();
  const int first = spec.y + y0, end = spec.y + y1;
  g_complaint[0] = '\0';
  bool read = true;
  if (spec.tile_height > 0) {
    read = input->read_tiles(0, 0, spec.x, spec.x + spec.width, first, end, 0, 1, 0, spec.nchannels,
                             type, to);
  } else if (spec.get_int_attribute("tiff:Compression") == COMPRESSION_ADOBE_DEFLATE &&
             spec.get_int_attribute("tiff:PlanarConfiguration") == PLANARCONFIG_CONTIG) {
    // Reads row by row: OpenImageIO inflates whole strips of these itself, without checking whether
    // they end early.
    const size_t row =
        static_cast<size_t>(spec.width) * static_cast<size_t>(spec.nchannels) * type.size();
    for (int y = first; read && y < end; ++y) {
      read = input->read_scanlines(0, 0, y, y + 1, 0, 0, spec.nchannels, type,
                                   static_cast<char*>(to) + static_cast<size_t>(y - first) * row);
    }
  } else {
    read = input->read_scanlines(0, 0, first, end, 0, 0, spec.nchannels, type, to);
  }
  const std::string error = input->geterror();
  if (g_complaint[0] != '\0') return g_complaint.data();
  return read && error.empty() ? std::string() : error.empty() ? kNoReason : error;
}

// Divides codes by the code of white, as nacre's other readers do. OpenImageIO multiplies by the
// rounded reciprocal, so equal pixels would differ by an ulp between formats.
template <typename Code>
std::string ReadCodes(OIIO::TypeDesc type, NacreOiioFile* file, int32_t y0, int32_t y1,
                      size_t count, float* values) {
  std::vector<Code> codes(count);
  std::string failure = ReadAs(type, file, y0, y1, codes.data());
  constexpr auto kWhite = static_cast<float>(std::numeric_limits<Code>::max());
  for (size_t i = 0; i < count; ++i) values[i] = static_cast<float>(codes[i]) / kWhite;
  return failure;
}

std::string ReadRows(NacreOiioFile* file, int32_t y0, int32_t y1, float* values) {
  const OIIO::ImageSpec& spec = static_cast<OIIO::ImageInput*>(file->input)->spec();
  const size_t count = static_cast<size_t>(y1 - y0) * static_cast<size_t>(spec.width) *
                       static_cast<size_t>(spec.nchannels);
  if (spec.format == OIIO::TypeDesc::UINT8) {
    return ReadCodes<uint8_t>(spec.format, file, y0, y1, count, values);
  }
  if (spec.format == OIIO::TypeDesc::UINT16) {
    return ReadCodes<uint16_t>(spec.format, file, y0, y1, count, values);
  }
  return ReadAs(OIIO::TypeDesc::FLOAT, file, y0, y1, values);
}

}  // namespace

const char* NacreOiioOpen(const char* path, uint64_t max_samples, NacreOiioFile* file) {
  *file = {};
  try {
    const std::string failure = Open(path, max_samples, file);
    if (file->input != nullptr) return nullptr;
    NacreOiioClose(file);
    return KeepMessage(failure);
  } catch (const std::exception& exception) {
    NacreOiioClose(file);
    return KeepMessage(exception.what());
  }
}

const char* NacreOiioReadRows(NacreOiioFile* file, int32_t y0, int32_t y1, float* values) {
  try {
    const std::string failure = ReadRows(file, y0, y1, values);
    return failure.empty() ? nullptr : KeepMessage(failure);
  } catch (const std::exception& exception) {
    return KeepMessage(exception.what());
  }
}

void NacreOiioClose(NacreOiioFile* file) {
  delete static_cast<OIIO::ImageInput*>(file->input);
  std::free(file->channel_names);
  std::free(file->attributes);
  *file = {};
}
