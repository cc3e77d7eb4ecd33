// SPDX-License-Identifier: Apache-2.0
// compare/layers.h: what of two images is compared with what: channels of one name over the pixels
// that both cover, grouped into layers.
#pragma once

#include <string>
#include <vector>

#include "base/image.h"

namespace nacre {

struct CompareOptions {
  // The layers to compare; empty: all, and then both images must have the same channels.
  std::vector<std::string> layers;
  // Judge the pixels that both images have, where their windows differ.
  bool crop = false;
  // Display windows of different sizes are a difference like another, not an error. Pages and
  // pictures of differences show one image over the other, and have no use for it.
  bool sizes_may_differ = false;
  // What error messages call the images.
  std::string got_name = "image";
  std::string reference_name = "reference";
};

// The layer that a channel belongs to: what comes before its last dot ("diffuse" of "diffuse.R");
// "" for the beauty's R, G and B; other channels without a dot ("A", "Z") are their own layer.
std::string LayerOfChannel(const std::string& channel);

// A channel of both images.
struct ChannelPair {
  std::string name;
  const float* got;        // of the window's first pixel
  const float* reference;  // of the window's first pixel
};

struct LayerPair {
  std::string layer;
  std::vector<ChannelPair> channels;
};

struct ImagePair {
  Window window;                                // the pixels that both data windows cover
  size_t got_stride = 0, reference_stride = 0;  // samples from a row to the next
  std::vector<LayerPair> layers;

  size_t GotIndex(int x, int y) const { return Index(x, y, got_stride); }
  size_t ReferenceIndex(int x, int y) const { return Index(x, y, reference_stride); }

 private:
  size_t Index(int x, int y, size_t stride) const {
    return static_cast<size_t>(y - window.y0) * stride + static_cast<size_t>(x - window.x0);
  }
};

// Points into both images. Throws Error(kCannotCompare) if their primaries differ, or their display
// windows in size where they may not, they share no pixel, or one has no channel of a layer to
// compare that the other has.
ImagePair PairImages(const Image& got, const Image& reference, const CompareOptions& options);

// The difference of two samples: 0 if they are equal, both NaN, or the same infinity; infinite if
// only one of them is finite or they are otherwise not comparable. NaN never comes out.
double SampleError(float got, float reference);

// error / |reference|; 0 for equal samples, infinity where the reference alone is 0: what
// Tolerances::max_rel is held against.
double RelativeError(double error, float reference);

// error / sqrt(reference^2 + kDarkReference^2), for means and maps of errors: below 0.01, which any
// display shows as nearly black, relative errors grow without bound though nobody could see them.
double SoftenedError(double error, float reference);
inline constexpr double kDarkReference = 0.01;

}  // namespace nacre
