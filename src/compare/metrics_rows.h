// SPDX-License-Identifier: Apache-2.0
// compare/metrics_rows.h: errors of rows of samples, in double. The kernels are in
// metrics_kernel.cc.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace nacre {

// The largest of many relative errors: `kept` of them at least, in no order.
class LargestErrors {
 public:
  explicit LargestErrors(size_t kept) : kept_(kept) {}

  // What is at most this is not among the largest.
  float threshold() const { return threshold_; }
  void Add(float error) {
    if (error <= threshold_) return;
    errors_.push_back(error);
    if (errors_.size() >= 2 * kept_ + kSlack) DropSmaller();
  }
  const std::vector<float>& errors() const { return errors_; }

 private:
  static constexpr size_t kSlack = 4096;  // so that dropping is rare where few are kept
  void DropSmaller();

  size_t kept_;
  float threshold_ = 0;
  std::vector<float> errors_;
};

// Sums over samples that are finite in both images.
struct ErrorSums {
  size_t finite = 0, relative = 0;  // samples, and those of them whose reference is not 0
  size_t zero_mismatches = 0;       // different, where the reference is 0
  double squares = 0, softened_squares = 0, sum_got = 0, sum_reference = 0;
  double largest = 0, peak = 0, largest_relative = 0;

  void Add(const ErrorSums& other);
};

// error^2 / (reference^2 + kDarkReference^2): SoftenedError squared.
double SoftenedSquare(double error, double reference);

// RelativeError as LargestErrors has it: references may be denormals.
float RelativeToFloat(double relative);

// Adds a row's samples. Returns false, and adds nothing, if any of them is not finite.
bool SumRow(const float* got, const float* reference, size_t count, ErrorSums* sums,
            LargestErrors* relative);

// Marks samples whose error exceeds max_abs + max_rel |reference|: ORs a bit for each, always of
// the same place for the same column, into ExcessBytes(count) bytes, and raises *largest to
// their errors. Returns false if any sample is not finite; what is marked is then of no use.
bool MarkExcess(const float* got, const float* reference, size_t count, double max_abs,
                double max_rel, uint8_t* marks, double* largest);
inline size_t ExcessBytes(size_t count) { return count; }

}  // namespace nacre
