// SPDX-License-Identifier: Apache-2.0
// api/picture.cc: display pictures in memory.
#include <algorithm>
#include <cmath>

#include "api/shown.h"
#include "base/parallel.h"
#include "image_io/color_channels.h"
#include "image_io/jpeg_writer.h"
#include "image_io/png_writer.h"

namespace nacre::v0 {
namespace {

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

}  // namespace

Shown::Shown(const Image& image, const ToneMapSettings& settings, const std::string& what) {
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

void EncodePixels(const Shown& shown, size_t first, size_t count, uint8_t* rgb8) {
  const std::array<const float*, 3> from = {shown.rgb[0] + first, shown.rgb[1] + first,
                                            shown.rgb[2] + first};
  if (shown.displayed) return RoundToCodes(from, count, rgb8);
  EncodeDisplay(shown.display, from[0], from[1], from[2], count, rgb8);
}

Picture ToneMap(const Image& image, const ToneMapSettings& settings) {
  return AtBorder([&] {
    const Shown shown(image, settings, "the picture");
    Picture picture{image.width(), image.height(), {}};
    const size_t pixels = image.channels[0].samples.size();
    picture.rgba.resize(4 * pixels, 255);
    constexpr size_t kBlock = size_t{1} << 14;
    ParallelFor((pixels + kBlock - 1) / kBlock, 0, [&](size_t block) {
      const size_t first = block * kBlock, count = std::min(kBlock, pixels - first);
      std::array<uint8_t, 3 * kBlock> rgb8;
      EncodePixels(shown, first, count, rgb8.data());
      for (size_t i = 0; i < count; ++i) {
        std::copy_n(rgb8.data() + 3 * i, 3, picture.rgba.data() + 4 * (first + i));
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

}  // namespace nacre::v0
