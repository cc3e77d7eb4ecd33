// SPDX-License-Identifier: Apache-2.0
// tests/stress/denormal_test.cc: rendering flushes denormals in its workers, whatever the caller's
// mode, and leaves that mode as it was. Of x86, where the mode is one register.
#if defined(__SSE2__)
#include <atomic>

#include <xmmintrin.h>

#include "catch.h"
#include "render/render.h"
#include "stress/everything.h"

namespace nacre {
namespace {

constexpr unsigned kFlushToZero = 0x8000, kDenormalsAreZero = 0x0040;
constexpr unsigned kRoundDown = 0x2000, kExceptionFlags = 0x003f;

// The mode without the record of what happened.
unsigned Mode() { return _mm_getcsr() & ~kExceptionFlags; }

TEST_CASE("workers flush denormals and the caller's mode stays") {
  const Scene scene = MakeEverything();
  const unsigned usual = _mm_getcsr();
  for (const unsigned caller : {usual, usual | kFlushToZero, usual | kDenormalsAreZero,
                                usual | kFlushToZero | kDenormalsAreZero | kRoundDown}) {
    for (const int threads : {1, 4}) {
      std::atomic<int> strips{0}, flushing{0};
      RenderSettings settings{.threads = threads};
      settings.on_progress = [&](double) {
        ++strips;
        const unsigned both = kFlushToZero | kDenormalsAreZero;
        if ((_mm_getcsr() & both) == both) ++flushing;
      };
      _mm_setcsr(caller);
      const unsigned before = Mode();
      RenderImage(scene, settings);
      const unsigned after = Mode();
      _mm_setcsr(usual);
      CAPTURE(threads, caller);
      CHECK(after == before);
      CHECK(strips == 7);  // 108 rows in strips of 16
      CHECK(flushing == strips);
    }
  }
}

TEST_CASE("a sink that throws leaves the caller's mode too") {
  const Scene scene = MakeEverything();
  const unsigned before = Mode();
  for (const int threads : {1, 4}) {
    RenderSettings settings{.threads = threads};
    settings.on_progress = [](double) { throw 1; };
    CHECK_THROWS_AS(RenderImage(scene, settings), int);
    CHECK(Mode() == before);
  }
}

}  // namespace
}  // namespace nacre
#endif
