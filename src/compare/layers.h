// SPDX-License-Identifier: Apache-2.0
// compare/layers.h: pairs up the samples of two images: channels with the same name over the pixels
// that both cover, grouped into layers.
#pragma once

#include <string>
#include <vector>

#include "base/image.h"

namespace nacre {

struct CompareOptions {
  // The layers to compare. If empty, all are, and both images must have the same channels.
  std::vector<std::string> layers{};
  // If the windows differ, compare only the pixels that both images have.
  bool crop = false;
  // Treat display windows of different sizes as a difference instead of an error. Pages and
  // pictures of differences, which overlay the images, leave this off.
  bool sizes_may_differ = false;
  // Names of the images in error messages.
  std::string got_name = "image";
  std::string reference_name = "reference";
};

// The layer of a channel: the part before its last dot ("diffuse" of "diffuse.R"); "" for the
// beauty's R, G and B. Any other channel without a dot ("A", "Z") is a layer of its own.
std::string LayerOfChannel(const std::string& channel);

// A channel that both images have.
struct ChannelPair {
  std::string name;
  const float* got;        // at the window's first pixel
  const float* reference;  // at the window's first pixel
};

struct LayerPair {
  std::string layer;
  std::vector<ChannelPair> channels;
};

struct ImagePair {
  Window window;                                // the pixels that both data windows cover
  size_t got_stride = 0, reference_stride = 0;  // samples from one row to the next
  std::vector<LayerPair> layers;

  size_t GotIndex(int x, int y) const { return Index(x, y, got_stride); }
  size_t ReferenceIndex(int x, int y) const { return Index(x, y, reference_stride); }

 private:
  size_t Index(int x, int y, size_t stride) const {
    return static_cast<size_t>(y - window.y0) * stride + static_cast<size_t>(x - window.x0);
  }
};

// Pairs the images; the result points into both. Throws Error (kCannotCompare) if their primaries
// differ, their display windows differ in size although that is not allowed, they have no common
// pixel, or a channel of a layer to compare is missing in one of them.
ImagePair PairImages(const Image& got, const Image& reference, const CompareOptions& options);

// The difference of two samples: 0 if they are equal, both NaN, or the same infinity; infinite if
// only one of them is finite or they cannot be compared otherwise. Never NaN.
double SampleError(float got, float reference);

// error / |reference|; 0 for equal samples, infinity if only the reference is 0. This is what
// Tolerances::max_rel limits.
double RelativeError(double error, float reference);

// error / sqrt(reference^2 + kDarkReference^2), for means and maps of errors. Below 0.01, which any
// display shows as nearly black, relative errors would grow without bound though they are
// invisible.
double SoftenedError(double error, float reference);
inline constexpr double kDarkReference = 0.01;

}  // namespace nacre
