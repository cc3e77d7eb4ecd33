// SPDX-License-Identifier: Apache-2.0
// oiio_module/oiio_module.cc: the functions of image_io/oiio_abi.h, on OpenImageIO.
#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <filesystem>
#include <fstream>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>
#include <OpenImageIO/imageio.h>
#include <dlfcn.h>
#include <unistd.h>

// Only these names are seen from outside.
#pragma GCC visibility push(default)
#include "image_io/oiio_abi.h"
#pragma GCC visibility pop
#include "image_io/icc_profile.h"

// libpng prints its errors to standard error once the handler that OpenImageIO gave it returns, as
// that does. So OpenImageIO finds this function in place of libpng's, being loaded as a library of
// this module: it lets the handler have the message and leaves as libpng would, without a word.
extern "C" {

using PngErrorFunction = void (*)(void* png, const char* message);

void png_longjmp(void* png, int value);

__attribute__((visibility("default"))) void png_set_error_fn(void* png, void* user,
                                                             PngErrorFunction on_error,
                                                             PngErrorFunction on_warning) {
  thread_local PngErrorFunction handler;  // of the file that this thread reads
  handler = on_error;
  static const auto set =
      reinterpret_cast<decltype(&png_set_error_fn)>(dlsym(RTLD_NEXT, "png_set_error_fn"));
  static const auto leave =
      reinterpret_cast<decltype(&png_longjmp)>(dlsym(RTLD_NEXT, "png_longjmp"));
  const PngErrorFunction quiet = [](void* failed, const char* message) {
    if (handler != nullptr) handler(failed, message);
    if (leave != nullptr) leave(failed, 1);
  };
  if (set != nullptr) set(png, user, quiet, on_warning);
}

}  // extern "C"

namespace {

// The first line: OpenImageIO adds what it did about it.
const char* KeepMessage(const std::string& message) {
  thread_local std::array<char, 1024> kept;
  const std::string line = message.substr(0, message.find('\n'));
  std::snprintf(kept.data(), kept.size(), "%s", line.empty() ? "unknown reason" : line.c_str());
  return kept.data();
}

// A copy that C frees; `strings` may hold NULs.
char* Copy(const std::string& strings) {
  auto* copy = static_cast<char*>(std::malloc(strings.size() + 1));
  if (copy == nullptr) throw std::bad_alloc();
  std::memcpy(copy, strings.c_str(), strings.size() + 1);
  return copy;
}

// "sRGB" or the profile's own description, of a profile that is embedded; "" without.
std::string ProfileOf(const OIIO::ImageSpec& spec) {
  const OIIO::ParamValue* const profile = spec.find_attribute("ICCProfile");
  if (profile == nullptr) return {};
  const auto* const bytes = static_cast<const uint8_t*>(profile->data());
  const auto size = static_cast<size_t>(profile->datasize());
  if (nacre::IsSrgbProfile(std::span(bytes, size))) return "sRGB";
  const std::string name = spec.get_string_attribute("ICCProfile:profile_description");
  return name.empty() ? "unnamed" : name;
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
  const std::string profile = ProfileOf(spec);
  if (!profile.empty()) add("icc_profile", profile);
  if (!profile.empty() && profile != "sRGB") add("not_srgb", "the ICC profile \"" + profile + "\"");
  file->attributes = Copy(attributes);
}

// The reader that a file's first bytes ask for, or "" for a format that is left to nobody: a
// stranger's file must not choose among the forty readers that OpenImageIO brings.
std::string FormatOf(const std::string& path) {
  std::array<char, 4> bytes = {};
  std::ifstream(path, std::ios::binary).read(bytes.data(), bytes.size());
  const std::string_view head(bytes.data(), bytes.size());
  if (head == "\x89PNG") return "png";
  if (head.starts_with("\xff\xd8")) return "jpeg";
  if (head.starts_with("II*") || head.starts_with("II+") || head.starts_with("MM")) return "tiff";
  if (head[0] == 'P' && std::string_view("1234567Ff").find(head[1]) != std::string_view::npos) {
    return "pnm";
  }
  const std::string_view end = ".tga";  // these have no first bytes of their own
  const bool is_tga = path.size() > end.size() &&
                      std::equal(end.begin(), end.end(), path.end() - 4,
                                 [](char a, char b) { return a == (b | 0x20) || a == b; });
  return is_tga ? "targa" : "";
}

// Bytes that a PNM file of such an image has at least: OpenImageIO reads what is missing as
// anything. Text takes no less than binary numbers, but for the space after the last one. Binary
// bitmaps, P4, have rows of whole bytes.
uint64_t LeastPnmBytes(const std::string& path, const OIIO::ImageSpec& spec) {
  std::array<char, 2> kind = {};
  std::ifstream(path, std::ios::binary).read(kind.data(), kind.size());
  if (kind[1] == '4') {
    return (static_cast<uint64_t>(spec.width) + 7) / 8 * static_cast<uint64_t>(spec.height);
  }
  return spec.image_pixels() * static_cast<uint64_t>(spec.nchannels) * spec.format.size() - 1;
}

std::string Open(const char* path, uint64_t max_samples, NacreOiioFile* file) {
  OIIO::ImageSpec config;
  config["oiio:UnassociatedAlpha"] = 1;  // the file's values, not multiplied by alpha
  const std::string format = FormatOf(path);
  if (format.empty()) return "not PNG, JPEG, TIFF, Radiance HDR, PNM or TGA";
  auto input = OIIO::ImageInput::create(format);
  if (!input) return OIIO::geterror();
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
  // Divided, because the product may wrap around.
  const auto channels = static_cast<uint64_t>(spec.nchannels);
  const uint64_t across = std::max(tile_width, static_cast<uint64_t>(spec.width));
  if (tile_height > max_samples / channels / across) return "its tiles are too large";
  if (format == "pnm" && std::filesystem::file_size(path) < LeastPnmBytes(path, spec)) {
    return "cut off: too short for " + std::to_string(spec.width) + "x" +
           std::to_string(spec.height) + " pixels";
  }
  DescribeImage(spec, file);
  file->input = input.release();
  return {};
}

std::string ReadRows(NacreOiioFile* file, int32_t y0, int32_t y1, float* values) {
  auto* const input = static_cast<OIIO::ImageInput*>(file->input);
  const OIIO::ImageSpec spec = input->spec();
  const int first = spec.y + y0, end = spec.y + y1;
  const bool read = spec.tile_height > 0
                        ? input->read_tiles(0, 0, spec.x, spec.x + spec.width, first, end, 0, 1, 0,
                                            spec.nchannels, OIIO::TypeDesc::FLOAT, values)
                        : input->read_scanlines(0, 0, first, end, 0, 0, spec.nchannels,
                                                OIIO::TypeDesc::FLOAT, values);
  // Libraries go on after what they only warn of, with pixels that they made up.
  const std::string complaint = input->geterror();
  return read && complaint.empty() ? std::string()
         : complaint.empty()       ? "unknown reason"
                                   : complaint;
}

// Where Debian has it: OpenImageIO 2.5 no longer looks there by itself. Elsewhere its name.
const std::string& Font() {
  constexpr char kFile[] = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";
  static const std::string font = access(kFile, R_OK) == 0 ? kFile : "DejaVuSans";
  return font;
}

// From the text's origin, which is on its baseline, to the point that the item places. Vertically
// that depends on the font only, so that labels in a row stand on one line: the top and the middle
// of capitals, the bottom of descenders.
struct Offset {
  int x, y;
};

Offset AlignmentOffset(const NacreOiioText& item) {
  using OIIO::ImageBufAlgo::text_size;
  const OIIO::ROI text = text_size(item.text, item.size_px, Font());
  const OIIO::ROI capital = text_size("H", item.size_px, Font());
  const OIIO::ROI descender = text_size("g", item.size_px, Font());
  Offset offset = {(text.xbegin + text.xend) / 2, (capital.ybegin + capital.yend) / 2};
  if (item.align_x < 0) offset.x = text.xbegin;
  if (item.align_x > 0) offset.x = text.xend;
  if (item.align_y < 0) offset.y = capital.ybegin;
  if (item.align_y > 0) offset.y = descender.yend;
  return offset;
}

std::string DrawItem(const NacreOiioText& item, OIIO::ImageBuf* picture) {
  if (item.text[0] == '\0') return {};
  constexpr float kCodes = 255.0f;
  const float color[] = {static_cast<float>(item.color[0]) / kCodes,
                         static_cast<float>(item.color[1]) / kCodes,
                         static_cast<float>(item.color[2]) / kCodes};
  const int outline_px = item.outline != 0 ? std::max(1, item.size_px / 12) : 0;
  if (!OIIO::ImageBufAlgo::text_size("H", item.size_px, Font()).defined()) {
    return "the font DejaVuSans is not there";
  }
  const Offset offset = AlignmentOffset(item);
  using OIIO::ImageBufAlgo::TextAlignX;
  using OIIO::ImageBufAlgo::TextAlignY;
  const int x = item.x - offset.x;
  const int y = item.y - offset.y;
  // render_text ends the process when text crosses the picture's edge: draw on a cut-out as large
  // as the text, and put back what lies within the picture.
  const int room = outline_px + 2;
  OIIO::ROI bounds = OIIO::ImageBufAlgo::text_size(item.text, item.size_px, Font());
  bounds = OIIO::ROI(x + bounds.xbegin - room, x + bounds.xend + room, y + bounds.ybegin - room,
                     y + bounds.yend + room, 0, 1, 0, 3);
  const OIIO::ROI visible = OIIO::roi_intersection(bounds, picture->roi());
  if (visible.width() <= 0 || visible.height() <= 0) return {};
  OIIO::ImageBuf part = OIIO::ImageBufAlgo::crop(*picture, bounds);
  const bool drawn =
      OIIO::ImageBufAlgo::render_text(part, x, y, item.text, item.size_px, Font(), color,
                                      TextAlignX::Left, TextAlignY::Baseline, outline_px);
  if (!drawn) return part.geterror();
  std::vector<uint8_t> pixels(visible.npixels() * 3);
  const bool copied = part.get_pixels(visible, OIIO::TypeDesc::UINT8, pixels.data()) &&
                      picture->set_pixels(visible, OIIO::TypeDesc::UINT8, pixels.data());
  return copied ? std::string() : part.geterror() + picture->geterror();
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

const char* NacreOiioDrawText(uint8_t* rgb8, int32_t width, int32_t height,
                              const NacreOiioText* items, int32_t item_count) {
  try {
    OIIO::ImageBuf picture(OIIO::ImageSpec(width, height, 3, OIIO::TypeDesc::UINT8), rgb8);
    for (int32_t i = 0; i < item_count; ++i) {
      const std::string failure = DrawItem(items[i], &picture);
      if (!failure.empty()) return KeepMessage(failure);
    }
    return nullptr;
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
