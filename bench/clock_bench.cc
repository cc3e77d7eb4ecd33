// SPDX-License-Identifier: Apache-2.0
// bench/clock_bench.cc: the processor's clock, which port_bound.py turns cycles into time with, and
// the products of whole vectors that it starts, by which port_bound.py knows its kind.
#include <iterator>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "clock_bench.cc"
#include "hwy/foreach_target.h"

#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// In more chains than a processor has products under way; how many products, of the widest vectors.
size_t MultiplyChainsT(size_t rounds, float* x) {
  const hn::ScalableTag<float> d;
  const auto factor = hn::Set(d, *x);
  hn::Vec<hn::ScalableTag<float>> chains[12];
  for (auto& chain : chains) chain = factor;
  for (size_t round = 0; round < rounds; ++round) {
    for (auto& chain : chains) chain = hn::Mul(chain, factor);
  }
  for (const auto& chain : chains) chains[0] = hn::Max(chains[0], chain);
  *x = hn::GetLane(chains[0]);
  return std::size(chains) * rounds;
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <cstdint>

#include <benchmark/benchmark.h>

namespace nacre {
namespace {

HWY_EXPORT(MultiplyChainsT);

void BenchProducts(benchmark::State& state) {
  float x = 1;
  size_t products = 0;
  for (auto _ : state) {
    products = HWY_DYNAMIC_DISPATCH(MultiplyChainsT)(1000, &x);
    benchmark::DoNotOptimize(x);
  }
  state.counters["products"] = benchmark::Counter(static_cast<double>(products),
                                                  benchmark::Counter::kIsIterationInvariantRate);
}

// Each multiplication waits for the one before: three cycles on every x86-64 of the last ten years.
void BenchMultiplyChain(benchmark::State& state) {
  constexpr int kLength = 1000;
  constexpr int kLatency = 3;
  uint64_t x = 3, factor = 5;
  benchmark::DoNotOptimize(factor);
  for (auto _ : state) {
    for (int i = 0; i < kLength; ++i) x *= factor;
    benchmark::DoNotOptimize(x);
  }
  state.counters["cycles"] =
      benchmark::Counter(kLatency * kLength, benchmark::Counter::kIsIterationInvariantRate);
}

const bool kRegistered = [] {
  benchmark::RegisterBenchmark("machine/multiply_chain", BenchMultiplyChain);
  benchmark::RegisterBenchmark("machine/products", BenchProducts);
  return true;
}();

}  // namespace
}  // namespace nacre
#endif
