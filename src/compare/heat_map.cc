// SPDX-License-Identifier: Apache-2.0
#include "compare/heat_map.h"

#include <algorithm>
#include <cmath>

namespace nacre {
namespace {

// matplotlib's viridis at t = 0, 1/9, ..., 1.
constexpr Rgb8 kViridis[] = {{0x44, 0x01, 0x54}, {0x48, 0x28, 0x78}, {0x3e, 0x49, 0x89},
                             {0x31, 0x68, 0x8e}, {0x26, 0x82, 0x8e}, {0x1f, 0x9e, 0x89},
                             {0x35, 0xb7, 0x79}, {0x6e, 0xce, 0x58}, {0xb5, 0xde, 0x2b},
                             {0xfd, 0xe7, 0x25}};
constexpr size_t kLast = std::size(kViridis) - 1;

Rgb8 PixelColor(double error, const HeatScale& scale) {
  if (error == 0) return kHeatEqual;
  return std::isfinite(error) ? HeatColor(scale.Position(error)) : kHeatNotFinite;
}

void Append(const Rgb8& color, Rgb8Picture* picture) {
  picture->rgb8.insert(picture->rgb8.end(), color.begin(), color.end());
}

}  // namespace

Rgb8 HeatColor(double t) {
  const double position = std::clamp(t, 0.0, 1.0) * kLast;
  const size_t i = std::min(static_cast<size_t>(position), kLast - 1);
  const double fraction = position - static_cast<double>(i);
  Rgb8 color;
  for (size_t c = 0; c < 3; ++c) {
    const double value = std::lerp(kViridis[i][c], kViridis[i + 1][c], fraction);
    color[c] = static_cast<uint8_t>(std::lround(value));
  }
  return color;
}

double HeatScale::Position(double error) const {
  return std::clamp(std::log(error / low) / std::log(high / low), 0.0, 1.0);
}

Rgb8Picture HeatMap(const Image& got, const Image& reference, const std::string& layer,
                    HeatQuantity quantity, const HeatScale& scale) {
  // Only the part that both have is drawn.
  const CompareOptions options{.layers = {layer}, .sizes_may_differ = true};
  const ImagePair pair = PairImages(got, reference, options);
  const Window& window = pair.window;
  Rgb8Picture picture{window.width(), window.height(), {}};
  picture.rgb8.reserve(3 * window.pixel_count());
  for (int y = window.y0; y < window.y1; ++y) {
    for (int x = window.x0; x < window.x1; ++x) {
      double worst = 0;
      for (const ChannelPair& channel : pair.layers.front().channels) {
        const float expected = channel.reference[pair.ReferenceIndex(x, y)];
        double error = SampleError(channel.got[pair.GotIndex(x, y)], expected);
        if (quantity == HeatQuantity::kRelative && std::isfinite(error)) {
          error = SoftenedError(error, expected);
        }
        worst = std::max(worst, error);
      }
      Append(PixelColor(worst, scale), &picture);
    }
  }
  return picture;
}

Rgb8Picture HeatLegend(int width, int height) {
  Rgb8Picture picture{width, height, {}};
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) Append(HeatColor(x / std::max(1.0, width - 1.0)), &picture);
  }
  return picture;
}

}  // namespace nacre
