// SPDX-License-Identifier: Apache-2.0
#include "image_io/color_channels.h"

#include <algorithm>
#include <atomic>
#include <cctype>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/error.h"
#include "base/excerpt.h"
#include "base/float_mode.h"
#include "base/parallel.h"
#include "color/primaries.h"

namespace nacre {
namespace {

bool SameLetters(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](unsigned char x, unsigned char y) {
    return std::tolower(x) == std::tolower(y);
  });
}

// The part of the name after the last dot.
std::string_view OwnName(std::string_view name) {
  return name.substr(name.rfind('.') + 1);  // npos + 1 is 0
}

// The part of the name before the last dot; "" if there is no dot.
std::string_view LayerOf(std::string_view name) {
  const size_t dot = name.rfind('.');
  return name.substr(0, dot == std::string_view::npos ? 0 : dot);
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
      if (LayerOf(name) == layer &&
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
    if (!IsAlphaChannel(name) && (layer.empty() || LayerOf(name) == layer)) others.push_back(c);
  }
  if (others.size() != 1) return {};
  return ColorChannels{others[0], others[0], others[0]};
}

std::string TellChannels(const std::vector<Channel>& channels) {
  constexpr size_t kMost = 12;
  std::vector<std::string> names;
  for (size_t c = 0; c < std::min(channels.size(), kMost); ++c) {
    names.push_back(Excerpt(channels[c].name));
  }
  return fmt::format("it has {}{}", fmt::join(names, ", "),
                     channels.size() > kMost ? fmt::format(" and {} more", channels.size() - kMost)
                                             : std::string());
}

ColorConversion ConversionToRec709(const std::map<std::string, std::string>& metadata) {
  const auto found = metadata.find("chromaticities");
  if (found == metadata.end()) return {};
  const std::optional<Primaries> primaries = ParsePrimaries(found->second);
  if (!primaries) {
    // Photoshop writes all of them as 0, which means nothing and is found in most published skies.
    if (found->second.find_first_not_of("0.e+- \t") == std::string::npos) return {};
    return {{},
            fmt::format("its primaries ({}) are none, and its colours are taken as Rec. 709",
                        Excerpt(found->second))};
  }
  if (SamePrimaries(*primaries, *ParsePrimaries(kRec709Primaries))) return {};
  return {Rec709FromPrimaries(*primaries),
          fmt::format("its colours are converted to Rec. 709 from its primaries ({})",
                      Excerpt(found->second))};
}

size_t ConvertColors(const Imath::M33d& matrix, const std::array<float*, 3>& rgb, size_t step,
                     size_t count, bool clip, int threads) {
  constexpr size_t kPiece = size_t{1} << 16;
  // The relative rounding error of samples is 2^-24, which the matrix amplifies at most tenfold.
  constexpr double kRounding = 1e-6;
  std::atomic<size_t> outside{0};
  constexpr double kMost = std::numeric_limits<float>::max();
  ParallelForBlocks(count, kPiece, threads, [&](size_t begin, size_t end) {
    const DefaultFloatMode keeps_denormals;
    size_t outside_here = 0;
    for (size_t i = begin; i < end; ++i) {
      const Vec3d from(rgb[0][i * step], rgb[1][i * step], rgb[2][i * step]);
      if (!std::isfinite(from.x + from.y + from.z)) continue;
      const Vec3d to = from * matrix;
      outside_here += std::min({to.x, to.y, to.z}) < -kRounding * from.length() ? 1 : 0;
      for (int c = 0; c < 3; ++c) {
        rgb[static_cast<size_t>(c)][i * step] =
            static_cast<float>(std::clamp(to[c], clip ? 0 : -kMost, kMost));
      }
    }
    outside += outside_here;
  });
  return outside;
}

std::string OutsideNote(size_t outside) {
  if (outside == 0) return {};
  return fmt::format("{} pixels lie outside of Rec. 709's gamut: what is below 0 counts as 0",
                     outside);
}

std::string ConvertImage(Image* image) {
  ColorConversion conversion = ConversionToRec709(image->metadata);
  if (!conversion.matrix) return std::move(conversion.note);
  std::set<std::string_view> layers;
  size_t outside = 0;
  for (const Channel& channel : image->channels) {
    const std::string_view layer = LayerOf(channel.name);
    if (!layers.insert(layer).second) continue;
    const std::optional<ColorChannels> colors = FindColors(image->channels, layer);
    if (!colors || colors->is_grey()) continue;
    const auto samples = [&](size_t c) { return image->channels[c].samples.data(); };
    outside += ConvertColors(*conversion.matrix,
                             {samples(colors->r), samples(colors->g), samples(colors->b)}, 1,
                             image->data.pixel_count(), false);
  }
  image->metadata["chromaticities"] = kRec709Primaries;
  if (outside > 0) conversion.note += "; " + OutsideNote(outside);
  return std::move(conversion.note);
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
