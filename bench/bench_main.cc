// SPDX-License-Identifier: Apache-2.0
// bench/bench_main.cc: main() of the benchmarks; says what the machine is.
#include <string>
#include <vector>

#include <benchmark/benchmark.h>
#include <fmt/ranges.h>

#include "base/target.h"

int main(int argc, char** argv) {
  std::vector<std::string> targets;
  for (const nacre::Target target : nacre::SupportedTargets()) {
    targets.push_back(nacre::TargetName(target));
  }
  benchmark::AddCustomContext("simd_targets", fmt::format("{}", fmt::join(targets, " ")));
  benchmark::AddCustomContext(
      "scalar_baseline",
      "plain per-hit float C++ in textbook form, x^5 by multiplication, -O3 "
      "-march=native");
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
