// SPDX-License-Identifier: Apache-2.0
// tests/textbook/pictures_test.cc: the lesson's pictures against those that its own program made
// (tests/references/textbook: its float image as EXR, its 8-bit image as PNG).
#include "textbook/pictures.h"

#include <cmath>
#include <cstdlib>
#include <string>

#include "catch.h"
#include "image_io/read_image.h"

namespace nacre {
namespace {

std::string ReferencePath(const std::string& file) {
  return std::string(NACRE_SOURCE_DIR) + "/tests/references/textbook/" + file;
}

const std::vector<float>& Samples(const Image& image, const char* channel) {
  const Channel* found = image.Find(channel);
  REQUIRE(found != nullptr);
  return found->samples;
}

double LargestDifference(const std::vector<Rgb>& got, const Image& reference) {
  double largest = 0;
  for (int c = 0; c < 3; ++c) {
    const char name[] = {"RGB"[c], '\0'};
    const std::vector<float>& samples = Samples(reference, name);
    REQUIRE(samples.size() == got.size());
    for (size_t i = 0; i < got.size(); ++i) {
      largest = std::max(largest, std::abs(got[i][c] - static_cast<double>(samples[i])));
    }
  }
  return largest;
}

struct CodeDifference {
  size_t count = 0;
  int largest = 0;
};

CodeDifference CompareCodes(const std::vector<uint8_t>& got, const Image& reference) {
  CodeDifference difference;
  for (size_t c = 0; c < 3; ++c) {
    const char name[] = {"RGB"[c], '\0'};
    const std::vector<float>& samples = Samples(reference, name);
    REQUIRE(3 * samples.size() == got.size());
    for (size_t i = 0; i < samples.size(); ++i) {
      const int code = static_cast<int>(std::lround(samples[i] * 255));
      const int off = std::abs(static_cast<int>(got[3 * i + c]) - code);
      difference.count += off != 0;
      difference.largest = std::max(difference.largest, off);
    }
  }
  return difference;
}

void CheckAgainstReference(const TextbookPicture& picture, const std::string& name) {
  CAPTURE(name);
  // The reference is double rounded to float once: half an ulp below 1 is 3e-8. What is left to
  // 1e-7 are a few roundings of double through the powers.
  const double largest = LargestDifference(picture.film, ReadImage(ReferencePath(name + ".exr")));
  CAPTURE(largest);
  CHECK(largest <= 1e-7);
  // Codes are made by truncation, so a rounding of double may move a value across a code's edge.
  // Five codes of one are allowed of a C library with another pow; here there are none.
  const CodeDifference codes = CompareCodes(TextbookCodes(picture, TextbookFaults()),
                                            ReadImage(ReferencePath(name + ".png")));
  CAPTURE(codes.count, codes.largest);
  CHECK(codes.count <= 5);
  CHECK(codes.largest <= 1);
}

TEST_CASE("the comparison is the lesson's") {
  CheckAgainstReference(RenderTextbookComparison({}), "phong_vs_pbr");
}

TEST_CASE("the material grid is the lesson's") {
  CheckAgainstReference(RenderTextbookGrid({}), "material_grid");
}

}  // namespace
}  // namespace nacre
