// SPDX-License-Identifier: Apache-2.0
#include "compare/ssim.h"

#include <algorithm>
#include <vector>

#include "base/aligned.h"
#include "base/parallel.h"

namespace nacre {
namespace {

// Rows of windows that are processed together; they read ten more rows.
constexpr int kBandRows = 64;

}  // namespace

GreyRows ShownGreys(const PictureView& picture, const ShowFunction& show) {
  return [&picture, &show](int y, float* greys) {
    const auto width = static_cast<size_t>(picture.width);
    AlignedArray<float> light[3];
    for (AlignedArray<float>& channel : light) channel = AlignedArray<float>(width);
    ReadLight(picture, show, 0, y, picture.width,
              {light[0].data(), light[1].data(), light[2].data()});
    EncodeGreys(width, light[0].data(), light[1].data(), light[2].data(), greys);
  };
}

double Ssim(int width, int height, const GreyRows& a, const GreyRows& b) {
  const Kernel window = GaussianKernel(kSsimSigma, kSsimRadius);
  const auto columns = static_cast<size_t>(width);
  const size_t padded = RoundUp(columns, kBatchPadding);
  const int window_rows = height - 2 * kSsimRadius;
  std::vector<double> sums(static_cast<size_t>((window_rows + kBandRows - 1) / kBandRows));
  ParallelFor(sums.size(), 0, [&](size_t band) {
    const int first = static_cast<int>(band) * kBandRows;
    const int rows = std::min(kBandRows, window_rows - first);
    const auto inputs = static_cast<size_t>(rows + 2 * kSsimRadius);
    AlignedArray<float> greys_a(inputs * padded), greys_b(inputs * padded);
    std::vector<const float*> rows_a, rows_b;
    for (size_t i = 0; i < inputs; ++i) {
      a(first + static_cast<int>(i), &greys_a[i * padded]);
      b(first + static_cast<int>(i), &greys_b[i * padded]);
      rows_a.push_back(&greys_a[i * padded]);
      rows_b.push_back(&greys_b[i * padded]);
    }
    AlignedArray<double> scratch(SsimScratch(columns));
    for (size_t row = 0; row < static_cast<size_t>(rows); ++row) {
      sums[band] += SsimRowSum(window, columns, &rows_a[row], &rows_b[row], scratch.data());
    }
  });
  double sum = 0;
  for (const double of_band : sums) sum += of_band;
  return sum / (static_cast<double>(width - 2 * kSsimRadius) * window_rows);
}

}  // namespace nacre
