// SPDX-License-Identifier: Apache-2.0
// embree/tbb_threads.h: limits the threads of Embree's builds. Only this folder knows TBB.
#pragma once

#include <functional>

namespace nacre {

// Calls body() once; parallel work that it starts through TBB uses up to `threads` threads, counted
// as in ParallelFor.
void WithThreads(int threads, const std::function<void()>& body);

}  // namespace nacre
