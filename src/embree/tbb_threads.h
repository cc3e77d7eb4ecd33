// SPDX-License-Identifier: Apache-2.0
// embree/tbb_threads.h: how many threads Embree's builds take. The only folder that knows TBB.
#pragma once

#include <functional>

namespace nacre {

// Calls body() once; parallel work that it starts through TBB uses up to `threads` threads, counted
// as ParallelFor's.
void WithThreads(int threads, const std::function<void()>& body);

}  // namespace nacre
