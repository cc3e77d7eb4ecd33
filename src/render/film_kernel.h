// SPDX-License-Identifier: Apache-2.0
// render/film_kernel.h: the film's loops over samples and pixels, in SIMD. All sums and products
// are of doubles and never fused: the same bits on every target.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

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

// Hits [begin, end) of a batch: the numbers of their rays, which ascend. Aligned, and padded to
// whole vectors.
struct HitRays {
  const uint32_t* ray;
  size_t begin, end;
};

// Finds their spans. The rays go through all pixels of the first sample first; `weights`: of each
// sample. `row` divides `pixels`; no span goes beyond a row.
void FindSpans(const HitRays& hits, size_t pixels, size_t row, const double* weights,
               std::vector<HitSpan>* spans);

// Hit i is worth a[c][i] + b[c][i] + constant[c] + further[c], in double, in channel c of a layer.
// b, or a and b, may be null in all channels: 0. `channels` is 1, 3 or 4; the fourth is coverage,
// where every hit is worth 1.
struct HitValues {
  int channels;
  const float* a[3];
  const float* b[3];
  double constant[3], further[3];
};

// AddSamples for hits alone, into the sums of each channel.
void AddHits(const HitValues& values, std::span<const HitSpan> spans, double* const* sums);

// A tile's rows in a channel of the picture: pixel p is first[p / width * stride + p % width].
template <typename T>
struct PixelRows {
  T* first;
  size_t width, height, stride;
};

// The same for the only sample of each pixel, of weight 1, rounded to float: what RoundSums would
// make of its sum, into the rows of each channel. No span goes beyond a row.
void PutHits(const HitValues& values, std::span<const HitSpan> spans, const PixelRows<float>* rows);

// What rounds the sums of a channel to its pixels: `weight` of all samples of a pixel, those that
// missed showing the background.
struct RoundedBy {
  double background, weight, scale;
};

// float((sum + background (weight - coverage)) scale) for each pixel of a tile.
void RoundSums(const double* sums, const double* coverage, const RoundedBy& by,
               const PixelRows<float>& rows);

// Sets all pixels of a tile.
void FillPixels(float value, const PixelRows<float>& rows);

// to[i] = double(a[i]) + double(b[i]) + constant + further for i in [begin, end); what lies after,
// up to a whole vector, is overwritten. Of a null b there is nothing to add.
void AddFloats(const float* a, const float* b, double constant, double further, size_t begin,
               size_t end, double* to);

// The same with constants of their own.
struct FloatsToAdd {
  const float *a, *b, *constant, *further;
};
void AddFloats(const FloatsToAdd& floats, size_t begin, size_t end, double* to);

}  // namespace nacre
