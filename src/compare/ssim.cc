// SPDX-License-Identifier: Apache-2.0
#include "compare/ssim.h"

#include <algorithm>
#include <numeric>

namespace nacre {
namespace {

Plane Product(const Plane& a, const Plane& b) {
  Plane product = a;
  for (size_t i = 0; i < a.size(); ++i) product.values[i] *= b.values[i];
  return product;
}

// Eqs. 14 to 16: weighted means, and variances and covariance as E[ab] - E[a] E[b].
double SsimAt(double mean_a, double mean_b, double aa, double bb, double ab) {
  const double variance_a = aa - mean_a * mean_a;
  const double variance_b = bb - mean_b * mean_b;
  const double covariance = ab - mean_a * mean_b;
  return (2 * mean_a * mean_b + kSsimC1) * (2 * covariance + kSsimC2) /
         ((mean_a * mean_a + mean_b * mean_b + kSsimC1) * (variance_a + variance_b + kSsimC2));
}

}  // namespace

Plane SsimMap(const Plane& a, const Plane& b) {
  const Kernel window = GaussianKernel(kSsimSigma, kSsimRadius);
  const auto mean = [&](const Plane& plane) { return Filter(plane, window, window); };
  Plane map(a.width - 2 * kSsimRadius, a.height - 2 * kSsimRadius);
  for (const Band& band : BandsOf(a.height, kSsimRadius)) {
    const Plane rows_a = RowsOf(a, band.input_first, band.input_end);
    const Plane rows_b = RowsOf(b, band.input_first, band.input_end);
    const Plane mean_a = mean(rows_a);
    const Plane mean_b = mean(rows_b);
    const Plane aa = mean(Product(rows_a, rows_a));
    const Plane bb = mean(Product(rows_b, rows_b));
    const Plane ab = mean(Product(rows_a, rows_b));
    const int end = std::min(band.end, a.height - kSsimRadius);
    for (int row = std::max(band.first, kSsimRadius); row < end; ++row) {
      const int v = row - band.input_first;
      for (int x = 0; x < map.width; ++x) {
        const int u = x + kSsimRadius;
        map.at(x, row - kSsimRadius) =
            SsimAt(mean_a.at(u, v), mean_b.at(u, v), aa.at(u, v), bb.at(u, v), ab.at(u, v));
      }
    }
  }
  return map;
}

double Ssim(const Plane& a, const Plane& b) {
  const Plane map = SsimMap(a, b);
  return std::accumulate(map.values.begin(), map.values.end(), 0.0) /
         static_cast<double>(map.size());
}

}  // namespace nacre
