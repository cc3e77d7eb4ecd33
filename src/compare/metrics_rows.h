// SPDX-License-Identifier: Apache-2.0
// compare/metrics_rows.h: errors of rows of samples, in double. The kernels are in
// metrics_kernel.cc.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace nacre {

// Keeps the largest of many relative errors: at least `kept` of them, unordered.
class LargestErrors {
 public:
  explicit LargestErrors(size_t kept) : kept_(kept) {}

  // Errors up to this are not among the largest.
  float threshold() const { return threshold_; }
  void Add(float error) {
    if (error <= threshold_) return;
    errors_.push_back(error);
    if (errors_.size() >= 2 * kept_ + kSlack) DropSmaller();
  }
  const std::vector<float>& errors() const { return errors_; }

 private:
  static constexpr size_t kSlack = 4096;  // makes dropping rare if few are kept
  void DropSmaller();

  size_t kept_;
  float threshold_ = 0;
  std::vector<float> errors_;
};

// Sums over samples that are finite in both images.
struct ErrorSums {
  size_t finite = 0, relative = 0;  // number of samples, and of those with a nonzero reference
  size_t zero_mismatches = 0;       // samples that differ where the reference is 0
  double squares = 0, softened_squares = 0, sum_got = 0, sum_reference = 0;
  double largest = 0, peak = 0, largest_relative = 0;

  void Add(const ErrorSums& other);
};

// error^2 / (reference^2 + kDarkReference^2): SoftenedError squared.
double SoftenedSquare(double error, double reference);

// Converts a RelativeError for LargestErrors; it may overflow float if the reference is denormal.
float RelativeToFloat(double relative);

// Adds the samples of a row. Returns false, and adds nothing, if any of them is not finite.
bool SumRow(const float* got, const float* reference, size_t count, ErrorSums* sums,
            LargestErrors* relative);

// Marks samples whose error exceeds max_abs + max_rel |reference|: for each, sets a bit in `marks`,
// which has `count` bytes, at a position that depends only on the column. Raises
// *largest to their errors. Returns false if any sample is not finite; then `marks` and `largest`
// are invalid.
bool MarkExcess(const float* got, const float* reference, size_t count, double max_abs,
                double max_rel, uint8_t* marks, double* largest);

}  // namespace nacre
