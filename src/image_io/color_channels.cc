// SPDX-License-Identifier: Apache-2.0
#include "image_io/color_channels.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <sstream>

#include <fmt/format.h>

#include "base/error.h"

namespace nacre {
namespace {

bool SameLetters(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](unsigned char x, unsigned char y) {
    return std::tolower(x) == std::tolower(y);
  });
}

// What comes after the last dot.
std::string_view OwnName(std::string_view name) {
  const size_t dot = name.rfind('.');
  return dot == std::string_view::npos ? name : name.substr(dot + 1);
}

bool IsInLayer(std::string_view name, std::string_view layer) {
  const size_t dot = name.rfind('.');
  return (dot == std::string_view::npos ? std::string_view() : name.substr(0, dot)) == layer;
}

}  // namespace

bool IsAlphaChannel(std::string_view name) {
  return SameLetters(OwnName(name), "a") || SameLetters(OwnName(name), "alpha");
}

std::optional<ColorChannels> FindColors(const std::vector<Channel>& channels,
                                        std::string_view layer) {
  const auto find = [&](std::string_view own, std::string_view long_name) -> std::optional<size_t> {
    for (size_t c = 0; c < channels.size(); ++c) {
      const std::string_view name = channels[c].name;
      if (IsInLayer(name, layer) &&
          (SameLetters(OwnName(name), own) || SameLetters(OwnName(name), long_name))) {
        return c;
      }
    }
    return {};
  };
  const auto r = find("r", "red"), g = find("g", "green"), b = find("b", "blue");
  if (r && g && b) return ColorChannels{*r, *g, *b};
  if (const auto y = find("y", "y")) return ColorChannels{*y, *y, *y};
  std::vector<size_t> others;
  for (size_t c = 0; c < channels.size(); ++c) {
    const std::string_view name = channels[c].name;
    if (!layer.empty() && name == layer) return ColorChannels{c, c, c};
    if (!IsAlphaChannel(name) && (layer.empty() || IsInLayer(name, layer))) others.push_back(c);
  }
  if (others.size() != 1) return {};
  return ColorChannels{others[0], others[0], others[0]};
}

void CheckPrimaries(const ImageFile& image) {
  // An attribute that all parts of a file share.
  const auto& metadata = image.parts.front().metadata;
  const auto found = metadata.find("chromaticities");
  if (found == metadata.end()) return;
  // Red, green, blue, white (ITU-R BT.709-6).
  if (SamePrimaries(found->second, "0.64 0.33 0.30 0.60 0.15 0.06 0.3127 0.3290")) return;
  throw Error(ExitCode::kBadInput, image.path,
              "its primaries (" + found->second + ") are not Rec. 709's",
              "convert its colours to linear Rec. 709 (sRGB's primaries) first");
}

bool SamePrimaries(const std::string& a, const std::string& b) {
  std::istringstream text_a(a), text_b(b);
  for (int i = 0; i < 8; ++i) {
    double x = 0, y = 0;
    if (!(text_a >> x) || !(text_b >> y) || !(std::abs(x - y) <= kPrimariesError)) return false;
  }
  return true;
}

Window WholeWindow(const ImageFile& image, const std::string& what) {
  const Window& display = image.header.display;
  const Window& data = image.header.data;
  if (image.has_several) {
    throw Error(ExitCode::kBadInput, image.path, fmt::format("has {} parts", image.parts.size()),
                fmt::format(R"(name one: "part": "{}")", image.parts.front().name));
  }
  if (!display.empty() && Intersect(display, data) == display) return display;
  throw Error(ExitCode::kBadInput, image.path,
              fmt::format("the picture is a crop: it has {} x {} pixels at {},{} of {} x {} at "
                          "{},{}",
                          data.width(), data.height(), data.x0, data.y0, display.width(),
                          display.height(), display.x0, display.y0),
              what + " needs all of it");
}

}  // namespace nacre
