// SPDX-License-Identifier: Apache-2.0
// sampling/pixel_sampler.h: film positions and weights of a pixel's samples.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/aligned.h"
#include "base/image.h"
#include "sampling/pixel_filter.h"

namespace nacre {

// Shared by all pixels of an image: one Owen-scrambled point set, whose binary digits each pixel
// shifts by a random number of its own (Kollig and Keller 2002). That costs one exclusive or, keeps
// the points' (t,m,s)-nets, and makes the errors of pixels independent.
struct PixelSampler {
  FilterSampler filter{};
  uint32_t seed = 0;
  int samples_per_pixel = 1;
  bool centered = false;  // the only sample is the pixel's centre
  // Samples [0, positive_count) are drawn from the filter's positive part, the others from its
  // negative part. The counts and weights are fixed, so that a constant image is reproduced
  // exactly.
  int positive_count = 1;
  double positive_weight = 1;
  double negative_weight = 0;
  // The point of each sample, as 32-bit binary fractions; padded for whole vectors.
  std::vector<uint32_t> points_x{}, points_y{};
};

// samples_per_pixel is in [1, 65536]. A single sample is the pixel's centre.
PixelSampler MakePixelSampler(const PixelFilter& filter, int samples_per_pixel, uint32_t seed);

// Like MakePixelSampler, but a single sample is random, too. This is needed where results of
// several samplers with different seeds are compared and averaged. A filter with negative lobes
// needs at least two samples.
PixelSampler MakeReplicateSampler(const PixelFilter& filter, int samples_per_pixel, uint32_t seed);

// True if every sample has weight 1, as with filters without negative lobes.
bool HasUnitWeights(const PixelSampler& sampler);

struct PixelSample {
  double dx, dy;  // from the pixel's centre, in pixels
  double weight;
};

// Sample `index` of the pixel in column x and row y of the full image. The mean over a pixel's
// samples of weight x value is an unbiased estimate of the filtered image; the weights have mean 1.
PixelSample SamplePixel(const PixelSampler& sampler, int x, int y, int index);

// The weight of sample `index` of every pixel.
double SampleWeight(const PixelSampler& sampler, int index);

// Stores the centres of the pixels, row by row, which are the samples of a centred sampler. The
// arrays are padded as for SamplePixels.
void PlaceCenters(const Window& pixels, double* film_x, double* film_y);

// Pixels whose samples are placed together. Not for centred samplers.
struct PixelBatch {
  explicit PixelBatch(size_t capacity)
      : origin_x(capacity), origin_y(capacity), shift_x(capacity), shift_y(capacity) {}

  size_t count = 0;
  // origin_x and origin_y are the pixel's column and row minus kUnitOrigin, and shift_x and shift_y
  // its digital shift with the exponent bits kUnitExponent (pixel_sampler_kernel.cc): there a
  // sample's bits become doubles that are kUnitOrigin too large.
  AlignedArray<double> origin_x, origin_y;
  AlignedArray<uint64_t> shift_x, shift_y;
};

// Fills `pixels` with the pixels of the runs, which must not exceed its capacity.
void PreparePixels(const PixelSampler& sampler, std::span<const PixelRun> runs, PixelBatch* pixels);

// Stores samples [first, first + count) of each of the pixels, sample by sample: film positions
// x + 0.5 + dx and y + 0.5 + dy, bit for bit those of SamplePixel. The arrays take pixels.count *
// count entries, and a vector behind them (AlignedArray) may be overwritten.
void SamplePixels(const PixelSampler& sampler, const PixelBatch& pixels, int first, int count,
                  double* film_x, double* film_y);

// A pixel, and the index of the sampler that places its samples.
struct SampledPixel {
  int x, y;
  uint32_t sampler;
};

// Stores samples [first, first + count) of each of the pixels, pixel by pixel. The samplers must
// have the same filter, and not be centred. The arrays are padded as for SamplePixels.
void SamplePixelList(const PixelSampler* samplers, std::span<const SampledPixel> pixels, int first,
                     int count, double* film_x, double* film_y);

}  // namespace nacre
