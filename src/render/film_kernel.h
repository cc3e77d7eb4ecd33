// SPDX-License-Identifier: Apache-2.0
// render/film_kernel.h: the film's loops over samples and pixels, in SIMD. Arithmetic is in double
// and never fused, so that every target gives the same bits.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "base/image.h"

namespace nacre {

// Adds the samples of one channel to the sums of its pixels: values[s * pixels + p] is sample s of
// pixel p and has weight weights[s]. All arrays are aligned and padded to whole vectors.
void AddSamples(const double* values, const double* weights, int samples, size_t pixels,
                double* sums);

// Hits [hit, hit + count) of a batch belong to consecutive pixels, from `pixel` on, and to the same
// sample of each, which has this weight.
struct HitSpan {
  uint32_t hit, pixel, count;
  double weight;
};

// Hits [begin, end) of a batch: the numbers of their rays, in ascending order. The array is aligned
// and padded to whole vectors.
struct HitRays {
  const uint32_t* ray;
  size_t begin, end;
};

// Finds the spans of these hits. Rays are numbered sample by sample, and by the `pixels` pixels
// within a sample. There is a weight for each sample. No span crosses the end of a row of `row`
// pixels; `row` divides `pixels`.
void FindHitSpans(const HitRays& hits, size_t pixels, size_t row, const double* weights,
                  std::vector<HitSpan>* spans);

// The value of hit i in channel c of a layer is values[c][i] + constant[c] + constant2[c], in
// double. `values` may be null for all channels, and then count as 0. `channels` is 1, 3 or 4; the
// fourth is coverage, where every hit has the value 1.
struct HitValues {
  int channels;
  const float* values[3];
  double constant[3], constant2[3];
};

// Adds the values of the hits, times the weights of their spans, to the sums of each channel.
void AddHits(const HitValues& values, std::span<const HitSpan> spans, double* const* sums);

// A tile's rows in a channel of a strip: pixel p is first[p / width * stride + p % width].
template <typename T>
struct PixelRows {
  T* first;
  size_t width, height, stride;
};

// For tiles with one sample per pixel, of weight 1: writes the values of the hits to the rows of
// each channel, with the bits that AddHits and RoundSums would give. No span crosses the end of a
// row.
void StoreHits(const HitValues& values, std::span<const HitSpan> spans,
               const PixelRows<float>* rows);

// How the sums of a channel become pixels. `weight` is the sum of the weights of a pixel's samples;
// the samples that missed show the background.
struct Resolution {
  double background, weight, scale;
};

// Writes float((sum + background (weight - coverage)) scale) to each pixel of the runs, which lie
// in the tile that `rows` are of.
void RoundSums(const double* sums, const double* coverage, const Resolution& by,
               std::span<const PixelRun> runs, const Window& tile, const PixelRows<float>& rows);

// Sets all pixels of a tile to one value.
void FillPixels(float value, const PixelRows<float>& rows);

// to[i] = double(from[i]) + constant + constant2 for i in [begin, end). Entries after the end, up
// to a whole vector, are overwritten.
void AddFloats(const float* from, double constant, double constant2, size_t begin, size_t end,
               double* to);

// AddFloats with constants for each hit.
struct FloatsToAdd {
  const float *from, *constant, *constant2;
};
void AddFloats(const FloatsToAdd& floats, size_t begin, size_t end, double* to);

}  // namespace nacre
