// SPDX-License-Identifier: Apache-2.0
// tests/render/frame_window_test.cc: bands of a frame hold every row once, whatever their number.
#include "render/frame_window.h"

#include <algorithm>

#include "base/error.h"
#include "catch.h"

namespace nacre {
namespace {

Window Band(const Window& frame, int index, int count, int band_rows) {
  return FrameWindow(frame, RenderSettings{.band = {index, count}, .band_rows = band_rows});
}

// Bands follow one another, none empty, at multiples of band_rows, sizes within one of those.
void CheckBands(const Window& frame, int count, int band_rows) {
  CAPTURE(frame.height(), count, band_rows);
  int next = 0;
  int least = frame.height();
  int most = 0;
  bool sound = true;
  for (int i = 0; i < count; ++i) {
    const Window band = Band(frame, i, count, band_rows);
    sound = sound && band.x0 == 0 && band.x1 == frame.x1 && band.y0 == next && !band.empty() &&
            band.y0 % band_rows == 0;
    next = band.y1;
    const int rows = (band.height() + band_rows - 1) / band_rows;
    least = std::min(least, rows);
    most = std::max(most, rows);
  }
  CHECK(sound);
  CHECK(next == frame.height());
  CHECK(most - least <= 1);
}

TEST_CASE("bands hold every row once") {
  for (const int band_rows : {16, 32}) {
    for (const int height : {1, 15, 16, 17, 32, 33, 47, 100, 1080, 65536}) {
      const Window frame{0, 0, 5, height};
      const int most = MaxBands(frame, band_rows);
      for (const int count : {1, 2, 3, 7, 64, most - 1, most}) {
        if (count >= 1 && count <= most) CheckBands(frame, count, band_rows);
      }
      CHECK_THROWS_AS(Band(frame, 0, most + 1, band_rows), Error);
    }
  }
}

TEST_CASE("without bands the window is the region's part of the frame, or all of it") {
  const Window frame{0, 0, 64, 36};
  RenderSettings settings;
  CHECK(FrameWindow(frame, settings) == frame);
  settings.region = {60, -5, 80, 10};
  CHECK(FrameWindow(frame, settings) == Window{60, 0, 64, 10});
  settings.region = {64, 0, 80, 10};
  CHECK_THROWS_AS(FrameWindow(frame, settings), Error);
}

}  // namespace
}  // namespace nacre
