// SPDX-License-Identifier: Apache-2.0
// bench/bench_main.cc: main() of the benchmarks; says what the machine is.
#include <string>
#include <vector>

#if defined(__GLIBC__)
#include <malloc.h>
#endif

#include <benchmark/benchmark.h>
#include <fmt/ranges.h>

#include "base/target.h"

namespace {

// Freed memory stays with the process: each repetition finds that of the one before, as frames of a
// program that renders many do. By default glibc gives the buffers of a frame back and the next
// takes them page by page anew. Whole processes are timed by time_process.
void KeepFreedMemory() {
#if defined(__GLIBC__)
  mallopt(M_TRIM_THRESHOLD, 1 << 30);
  mallopt(M_MMAP_THRESHOLD, 1 << 25);
#endif
}

}  // namespace

int main(int argc, char** argv) {
  KeepFreedMemory();
  std::vector<std::string> targets;
  for (const nacre::Target target : nacre::SupportedTargets()) {
    targets.push_back(nacre::TargetName(target));
  }
  benchmark::AddCustomContext("simd_targets", fmt::format("{}", fmt::join(targets, " ")));
  benchmark::AddCustomContext(
      "scalar_baseline",
      "plain per-hit float C++ in textbook form, x^5 by multiplication, -O3 "
      "-march=native; of stack_*: the scalar twin, in double");
  benchmark::AddCustomContext("memory", "freed memory is kept from one repetition to the next");
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
