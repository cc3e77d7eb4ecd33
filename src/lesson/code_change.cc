// SPDX-License-Identifier: Apache-2.0
#include "lesson/code_change.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include <fmt/format.h>

namespace nacre {

CodedPicture RenderComparison(const TextbookComparison& settings) {
  TextbookPicture picture = RenderTextbookComparison(settings);
  std::vector<uint8_t> codes = TextbookCodes(picture, settings.faults);
  return {std::move(picture), std::move(codes)};
}

CodedPicture RenderGrid(const TextbookGrid& settings) {
  TextbookPicture picture = RenderTextbookGrid(settings);
  std::vector<uint8_t> codes = TextbookCodes(picture, settings.faults);
  return {std::move(picture), std::move(codes)};
}

LessonPictures RenderLesson(const TextbookFaults& faults) {
  return {RenderComparison({.faults = faults}), RenderGrid({.faults = faults})};
}

CodeChange MeasureChange(const std::vector<uint8_t>& codes_a, const std::vector<uint8_t>& codes_b,
                         const std::vector<uint8_t>& sphere_a,
                         const std::vector<uint8_t>& sphere_b) {
  CodeChange change;
  size_t pixels = 0;
  size_t changed = 0;
  double sum = 0;
  for (size_t i = 0; i < sphere_a.size(); ++i) {
    if (sphere_a[i] == 0 && sphere_b[i] == 0) continue;
    ++pixels;
    int largest = 0;
    for (size_t c = 3 * i; c < 3 * i + 3; ++c) {
      const int difference = std::abs(codes_a[c] - codes_b[c]);
      sum += difference;
      largest = std::max(largest, difference);
    }
    changed += largest > 0;
    change.largest = std::max(change.largest, largest);
  }
  if (pixels == 0) return change;
  change.mean = sum / static_cast<double>(3 * pixels);
  change.share = static_cast<double>(changed) / static_cast<double>(pixels);
  return change;
}

CodeChange MeasureChange(const CodedPicture& a, const CodedPicture& b) {
  CodeChange change = MeasureChange(a.codes, b.codes, a.picture.sphere, b.picture.sphere);
  for (size_t i = 0; i < a.picture.pixel_count(); ++i) {
    if (a.picture.sphere[i] == 0 && b.picture.sphere[i] == 0) continue;
    for (int c = 0; c < 3; ++c) {
      change.largest_float =
          std::max(change.largest_float, std::abs(a.picture.film[i][c] - b.picture.film[i][c]));
    }
  }
  return change;
}

std::string ChangeText(const CodeChange& change) {
  if (change.largest == 0 && change.largest_float < 1e-12) return "no change";
  if (change.largest == 0) {
    return fmt::format("no code changes; the float image by up to {:.2g}", change.largest_float);
  }
  return fmt::format("up to {} {}, mean {:.3g}; {:.1f} % of the sphere pixels change",
                     change.largest, change.largest == 1 ? "code" : "codes", change.mean,
                     100 * change.share);
}

std::vector<std::string> ChangeLines(const LessonPictures& lesson, const TextbookFaults& faults) {
  const LessonPictures other = RenderLesson(faults);
  const CodeChange comparison = MeasureChange(lesson.comparison, other.comparison);
  const CodeChange grid = MeasureChange(lesson.grid, other.grid);
  if (comparison.largest == 0 && grid.largest == 0) {
    const CodeChange& larger = comparison.largest_float > grid.largest_float ? comparison : grid;
    return {"not shown by these pictures: " + ChangeText(larger)};
  }
  return {"comparison: " + ChangeText(comparison), "grid: " + ChangeText(grid)};
}

}  // namespace nacre
