// SPDX-License-Identifier: Apache-2.0
// lesson/code_change.h: measures the difference between two versions of the lesson's pictures.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "textbook/pictures.h"

namespace nacre {

// A picture and its 8-bit codes.
struct CodedPicture {
  TextbookPicture picture;
  std::vector<uint8_t> codes;
};

struct LessonPictures {
  CodedPicture comparison, grid;
};

// Renders both pictures with these faults.
LessonPictures RenderLesson(const TextbookFaults& faults);
CodedPicture RenderComparison(const TextbookComparison& settings);
CodedPicture RenderGrid(const TextbookGrid& settings);

// The difference over the pixels that show a sphere in either picture.
struct CodeChange {
  int largest = 0;           // in any channel, in codes
  double mean = 0;           // over pixels and channels, in codes
  double share = 0;          // fraction of pixels that change in any channel
  double largest_float = 0;  // in the float images
};
CodeChange MeasureChange(const std::vector<uint8_t>& codes_a, const std::vector<uint8_t>& codes_b,
                         const std::vector<uint8_t>& sphere_a,
                         const std::vector<uint8_t>& sphere_b);
CodeChange MeasureChange(const CodedPicture& a, const CodedPicture& b);

// "up to 12 codes, mean 0.031; 4.1 % of the sphere's pixels change", or a text that nothing
// changes.
std::string ChangeText(const CodeChange& change);

// A line for each picture that tells how it changes if it is rendered with `faults` instead.
std::vector<std::string> ChangeLines(const LessonPictures& lesson, const TextbookFaults& faults);

}  // namespace nacre
