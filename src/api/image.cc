// SPDX-License-Identifier: Apache-2.0
// api/image.cc: images of the public API: conversion to and from the library's own, and reading.
#include <cstdint>
#include <limits>

#include "api/border.h"
#include "image_io/read_image.h"

namespace nacre::v0 {
namespace {

SampleType ToPublic(nacre::PixelType type) {
  if (type == nacre::PixelType::kUint) return SampleType::kUint;
  return type == nacre::PixelType::kHalf ? SampleType::kHalf : SampleType::kFloat;
}

}  // namespace

Image ToPublic(nacre::Image&& image) {
  Image result;
  result.frame = ToPublic(image.display);
  result.data = ToPublic(image.data);
  result.channels.reserve(image.channels.size());
  for (nacre::Channel& channel : image.channels) {
    result.channels.push_back(
        {std::move(channel.name), ToPublic(channel.type), std::move(channel.samples)});
  }
  result.metadata = std::move(image.metadata);
  return result;
}

void CheckImage(const Image& image) {
  for (const Window& window : {image.frame, image.data}) {
    const auto side = [](int from, int to) { return int64_t{to} - from; };
    constexpr int64_t kLongest = std::numeric_limits<int>::max();
    if (side(window.x0, window.x1) <= kLongest && side(window.y0, window.y1) <= kLongest) continue;
    throw nacre::Error(ExitCode::kUsage, "image", "a window of it is larger than any image");
  }
  const nacre::Window data = ToOwn(image.data);
  if (data.empty()) throw nacre::Error(ExitCode::kUsage, "image", "has no pixels");
  for (const Channel& channel : image.channels) {
    if (channel.samples.size() == data.pixel_count()) continue;
    throw nacre::Error(ExitCode::kUsage, "image",
                       "channel \"" + channel.name + "\" has " +
                           std::to_string(channel.samples.size()) + " samples for " +
                           std::to_string(data.pixel_count()) + " pixels",
                       "Image::data tells the pixels that channels cover");
  }
}

nacre::Image ToOwn(const Image& image) {
  CheckImage(image);
  nacre::Image own;
  own.display = ToOwn(image.frame);
  own.data = ToOwn(image.data);
  own.channels.reserve(image.channels.size());
  for (const Channel& channel : image.channels) {
    // The type in files does not matter to functions that work on samples.
    own.channels.push_back({channel.name, nacre::PixelType::kFloat, channel.samples});
  }
  own.metadata = image.metadata;
  return own;
}

const Channel& RequireChannel(const Image& image, const std::string& name,
                              const std::string& what) {
  if (const Channel* const channel = image.Find(name)) return *channel;
  throw nacre::Error(ExitCode::kUsage, "image", "there is no channel \"" + name + "\"",
                     what + " needs it");
}

Image Read(const std::string& path) {
  return AtBorder([&] { return ToPublic(ReadImage(path)); });
}

}  // namespace nacre::v0
