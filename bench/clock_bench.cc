// SPDX-License-Identifier: Apache-2.0
// bench/clock_bench.cc: the processor's clock, which port_bound.py turns cycles into time with.
#include <cstdint>

#include <benchmark/benchmark.h>

namespace nacre {
namespace {

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
  return true;
}();

}  // namespace
}  // namespace nacre
