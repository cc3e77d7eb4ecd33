// SPDX-License-Identifier: Apache-2.0
// render/film_kernel.h: the film's loops over samples and pixels, in SIMD. All sums and products
// are of doubles and never fused: the same bits on every target.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace nacre {

// Adds the samples of one channel to the sums of its pixels: values[s * pixels + p] is sample s of
// pixel p, of the weight weights[s]. All arrays are aligned and padded to whole vectors.
void AddSamples(const double* values, const double* weights, int samples, size_t pixels,
                double* sums);

// Hits [hit, hit + count) of a batch are those of as many pixels, from `pixel` on, by one sample.
struct HitSpan {
  uint32_t hit, pixel, count;
  double weight;
};

// The same for hits alone: value i is double(a[i]) + double(b[i]) + constant + further, or only
// double(a[i]) if b is null, or only the constants if both are.
void AddHits(const float* a, const float* b, double constant, double further,
             std::span<const HitSpan> spans, double* sums);

// Rows of a picture's channel: pixel p of a tile of this width is
// first[p / width * stride + p % width].
struct PixelRows {
  float* first;
  size_t width, stride;
};

// The same for the only sample of each pixel, of weight 1, rounded to float: what RoundSums would
// make of its sum. No span goes beyond a row.
void PutHits(const float* a, const float* b, double constant, double further,
             std::span<const HitSpan> spans, const PixelRows& rows);

// What rounds the sums of a channel to its pixels: `weight` of all samples of a pixel, those that
// missed showing the background.
struct RoundedBy {
  double background, weight, scale;
};

// out = float((sum + background (weight - coverage)) scale) for each pixel of a tile; `stride`
// between the rows of `out`.
void RoundSums(const double* sums, const double* coverage, const RoundedBy& by, size_t width,
               size_t height, float* out, size_t stride);

// Sets the pixels of a tile; `stride` between the rows of `out`.
void FillPixels(float value, size_t width, size_t height, float* out, size_t stride);

// to[i] = double(a[i]) + double(b[i]) + constant + further for i in [begin, end); what lies after,
// up to a whole vector, is overwritten.
void AddFloats(const float* a, const float* b, double constant, double further, size_t begin,
               size_t end, double* to);

// The same with constants of their own.
struct FloatsToAdd {
  const float *a, *b, *constant, *further;
};
void AddFloats(const FloatsToAdd& floats, size_t begin, size_t end, double* to);

}  // namespace nacre
