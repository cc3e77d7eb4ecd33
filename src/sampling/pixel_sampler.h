// SPDX-License-Identifier: Apache-2.0
// sampling/pixel_sampler.h: where a pixel's samples lie and what they weigh.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/aligned.h"
#include "base/image.h"
#include "sampling/pixel_filter.h"

namespace nacre {

// What all pixels of an image share. One Owen-scrambled point set serves them all; each pixel
// shifts its binary digits by a random number of its own (Kollig and Keller 2002), which keeps its
// nets and costs one exclusive or, and makes the errors of pixels independent.
struct PixelSampler {
  FilterSampler filter;
  uint32_t seed = 0;
  int samples_per_pixel = 1;
  bool centered = false;  // the only sample is the pixel's centre
  // Samples [0, positive_count) are of the filter's positive part, the others of the negative
  // one: fixed counts with fixed weights, so that a constant image is reproduced exactly.
  int positive_count = 1;
  double positive_weight = 1;
  double negative_weight = 0;
  // The point of each sample, as 32 bits after the point; padded for whole vectors.
  std::vector<uint32_t> points_x, points_y;
};

// samples_per_pixel in [1, 65536]. One alone is the pixel's centre.
PixelSampler MakePixelSampler(const PixelFilter& filter, int samples_per_pixel, uint32_t seed);

// Like it, but one sample alone is random, too, as needed where the results of several samplers of
// different seeds are compared and averaged. A filter with both signs needs two samples at least.
PixelSampler MakeReplicateSampler(const PixelFilter& filter, int samples_per_pixel, uint32_t seed);

// True if every sample weighs 1: for filters without negative lobes.
bool HasUnitWeights(const PixelSampler& sampler);

struct PixelSample {
  double dx, dy;  // from the pixel's centre, in pixels
  double weight;
};

// Sample `index` of the pixel in column x and row y of the full image. The mean over a pixel's
// samples of weight x value estimates the filtered image without bias; the weights have the mean
// 1.
PixelSample SamplePixel(const PixelSampler& sampler, int x, int y, int index);

// The weight of sample `index` of every pixel.
double SampleWeight(const PixelSampler& sampler, int index);

// The centres of the pixels, row by row: the places of the only samples of a centred sampler. The
// arrays are overwritten like those of SamplePixels.
void PlaceCenters(const Window& pixels, double* film_x, double* film_y);

// Pixels whose samples are placed together, one behind the other, but for a centred sampler's.
struct PixelBatch {
  explicit PixelBatch(size_t capacity)
      : origin_x(capacity), origin_y(capacity), shift_x(capacity), shift_y(capacity) {}

  size_t count = 0;
  // Column and row, less what a sample's bits begin at; and what the point set is shifted by there,
  // under the exponent that makes such bits a double: pixel_sampler_kernel.cc.
  AlignedArray<double> origin_x, origin_y;
  AlignedArray<uint64_t> shift_x, shift_y;
};

// Readies the pixels of the runs, at most as many as there is room for.
void PutPixels(const PixelSampler& sampler, std::span<const PixelRun> runs, PixelBatch* pixels);

// Samples [first, first + count) of each of the pixels, sample by sample: film positions
// x + 0.5 + dx and y + 0.5 + dy, to the bit those of SamplePixel. The arrays take
// pixels.count * count entries, and a vector's worth after them (AlignedArray) may be overwritten.
void SamplePixels(const PixelSampler& sampler, const PixelBatch& pixels, int first, int count,
                  double* film_x, double* film_y);

// What places those of the runs' pixels have among `count` samples of each of the window's pixels,
// sample by sample, each row by row. All arrays are overwritten like those of SamplePixels.
void NumberRays(const Window& window, std::span<const PixelRun> runs, int count, uint32_t* ray);

// A pixel, by column and row, and which of several samplers places its samples.
struct SampledPixel {
  int x, y;
  uint32_t sampler;
};

// Samples [first, first + count) of each of the pixels, one pixel after the other, likewise. The
// samplers are of the same filter, and not centred.
void SamplePixelList(const PixelSampler* samplers, std::span<const SampledPixel> pixels, int first,
                     int count, double* film_x, double* film_y);

}  // namespace nacre
