// SPDX-License-Identifier: Apache-2.0
// tests/render/film_kernel_test.cc: the loops from a batch's hits into the film, on every target.
#include "render/film_kernel.h"

#include <algorithm>
#include <random>
#include <vector>

#include "base/aligned.h"
#include "catch.h"
#include "targets.h"

namespace nacre {
namespace {

// One way a tile's batch may be hit: every ray, most or few of them.
struct Rays {
  size_t pixels, samples;
  double hit_share;
};

// The rays that hit, in their order. What lies behind them would go on as if they did.
AlignedArray<uint32_t> MakeHits(const Rays& rays, std::mt19937* random, size_t* count) {
  const size_t all = rays.pixels * rays.samples;
  AlignedArray<uint32_t> hits(all + 2 * kBatchPadding);
  std::bernoulli_distribution is_hit(rays.hit_share);
  *count = 0;
  for (uint32_t ray = 0; ray < all; ++ray) {
    if (is_hit(*random)) hits[(*count)++] = ray;
  }
  for (size_t i = *count; i < hits.size(); ++i) {
    hits[i] = i == 0 ? 0 : hits[i - 1] + 1;
  }
  return hits;
}

constexpr Rays kRays[] = {{256, 8, 1},   {256, 4, 1},  {256, 4, 0.98},
                          {256, 4, 0.5}, {35, 3, 0.9}, {64, 1, 0}};

TEST_CASE("Spans are as long as hits follow one another, within a row and a sample", "[render]") {
  std::mt19937 random(5);
  const double weights[] = {1, 2, 3, 4, 5, 6, 7, 8};
  for (const Rays& rays : kRays) {
    for (const size_t row : {rays.pixels, rays.pixels == 35 ? size_t{7} : size_t{32}}) {
      size_t count = 0;
      const AlignedArray<uint32_t> hits = MakeHits(rays, &random, &count);
      for (const size_t begin : {size_t{0}, count / 3}) {
        ForEachTarget([&](Target) {
          std::vector<HitSpan> spans(3);  // of an earlier batch
          FindHitSpans({hits.data(), begin, count}, rays.pixels, row, weights, &spans);
          CAPTURE(rays.pixels, rays.hit_share, row, begin);
          size_t hit = begin, wrong = 0;
          for (size_t k = 0; k < spans.size(); ++k) {
            const HitSpan& span = spans[k];
            wrong += span.hit != hit || span.count == 0 || hit + span.count > count;
            for (size_t i = 0; i < span.count && hit < count; ++i, ++hit) {
              const size_t ray = hits[hit];
              wrong += ray % rays.pixels != span.pixel + i;
              wrong += ray / row != hits[span.hit] / row;
              wrong += weights[ray / rays.pixels] != span.weight;
            }
            // No shorter than they need be.
            if (hit < count) {
              wrong += hits[hit] == hits[hit - 1] + 1 && hits[hit] / row == hits[hit - 1] / row;
            }
          }
          CHECK(wrong == 0);
          CHECK(hit == count);
        });
      }
    }
  }
}

// Into one channel, into three, of which the first alone has constants to add, and into these and
// coverage.
TEST_CASE("Hits add their weight times what they are worth, in doubles", "[render]") {
  std::mt19937 random(6);
  std::uniform_real_distribution<float> value(-1, 3);
  constexpr double kWeights[][8] = {{1, 1, 1, 1, 1, 1, 1, 1},
                                    {0.75, 0.75, 0.75, 0.75},
                                    {-0.25, -0.25, -0.25, -0.25},
                                    {1, 1, -0.25, 1}};
  for (const auto& weights : kWeights) {
    for (const Rays& rays : kRays) {
      size_t count = 0;
      const AlignedArray<uint32_t> hits = MakeHits(rays, &random, &count);
      std::vector<AlignedArray<float>> floats;
      for (int i = 0; i < 3; ++i) {
        for (float& v : floats.emplace_back(hits.size())) v = value(random);
      }
      std::vector<HitSpan> spans;
      FindHitSpans({hits.data(), 0, count}, rays.pixels, rays.pixels, weights, &spans);
      for (const int channels : {1, 3, 4}) {
        for (const bool constant_only : {true, false}) {
          for (const auto& [constant, constant2] : {std::pair{0.0, 0.0}, {0.1, 0.0}, {0.1, 0.7}}) {
            HitValues values{.channels = channels,
                             .values = {},
                             .constant = {constant, 0, 0},
                             .constant2 = {constant2, 0, 0}};
            // Each ray's pixel once more, by itself.
            std::vector<double> expected[4];
            for (int c = 0; c < std::min(channels, 3); ++c) {
              const auto& a = floats[static_cast<size_t>(c)];
              if (!constant_only) values.values[c] = a.data();
              expected[c].assign(rays.pixels, 0.0);
              for (size_t i = 0; i < count; ++i) {
                double worth = constant_only ? 0.0 : double{a[i]};
                worth = worth + values.constant[c] + values.constant2[c];
                const double weighted = weights[hits[i] / rays.pixels] * worth;  // never fused
                expected[c][hits[i] % rays.pixels] += weighted;
              }
            }
            expected[3].assign(rays.pixels, 0.0);
            for (size_t i = 0; i < count; ++i) {
              expected[3][hits[i] % rays.pixels] += weights[hits[i] / rays.pixels];
            }
            ForEachTarget([&](Target) {
              std::vector<AlignedArray<double>> sums;
              for (int c = 0; c < 4; ++c) sums.emplace_back(rays.pixels);
              double* const to[4] = {sums[0].data(), sums[1].data(), sums[2].data(),
                                     sums[3].data()};
              AddHits(values, spans, to);
              CAPTURE(weights[2], rays.pixels, rays.hit_share, channels, constant_only, constant,
                      constant2);
              for (int c = 0; c < channels; ++c) {
                CHECK(std::vector<double>(sums[c].begin(), sums[c].end()) == expected[c]);
              }
            });
          }
        }
      }
    }
  }
}

}  // namespace
}  // namespace nacre
