// SPDX-License-Identifier: Apache-2.0
// base/parallel.h: loops that run on several threads.
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>

namespace nacre {

// Calls body(i) for every i in [0, count), on up to `threads` threads (0: as many as the machine
// has). Indices are begun in ascending order. Each worker runs with denormals flushed to zero
// (FlushDenormals). An exception of a body stops the loop and is thrown to the caller. Calls may be
// nested in bodies, and may come from several threads at once.
void ParallelFor(size_t count, int threads, const std::function<void(size_t)>& body);

// Calls body(begin, end) in this way for consecutive blocks of `block` indices, of which the last
// may be shorter, that make up [0, count).
template <class Body>
void ParallelForBlocks(size_t count, size_t block, int threads, const Body& body) {
  ParallelFor((count + block - 1) / block, threads,
              [&](size_t i) { body(i * block, std::min(count, (i + 1) * block)); });
}

// The number of threads that ParallelFor uses for `threads`.
int ThreadCount(int threads);

}  // namespace nacre
