// render/film_kernel.h: the film's loops over samples and pixels, in SIMD. All sums and products
// are of doubles and never fused: the same bits on every target.
#pragma once

#include <cstddef>

namespace nacre {

// Adds the samples of one channel to the sums of its pixels, or, with `first`, to 0:
// values[s * pixels + p] is sample s of pixel p, of the weight weights[s]. All arrays are aligned
// and padded to whole vectors.
void AddSamples(const double* values, const double* weights, int samples, size_t pixels, bool first,
                double* sums);

// out[i] = float(sums[i] * scale).
void RoundSums(const double* sums, double scale, size_t count, float* out);

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
