// SPDX-License-Identifier: Apache-2.0
// study/study.h: studies: what the founding lesson's exercises ask, answered by pictures, curves
// and numbers that are computed when they are asked for.
//
// A study returns what it found; nothing is written or printed here.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "base/picture.h"
#include "report/plot.h"

namespace nacre {

struct StudyPicture {
  std::string name;     // of its file, without extension
  std::string caption;  // one sentence
  Rgb8Picture picture;
};

struct StudyFigure {
  std::string name;
  std::string caption;
  Figure figure;
};

struct StudyNumber {
  std::string quantity;
  double value = 0;
  std::string unit;  // empty: a pure number
};

struct StudyResult {
  std::vector<StudyPicture> pictures;
  std::vector<StudyFigure> figures;
  std::vector<StudyNumber> numbers;
  std::string answer;  // Markdown, paragraphs of sentences with the numbers in them
};

// Told the share done now and then; throwing from it ends the study.
using StudyProgress = std::function<void(double)>;

struct StudyEntry {
  const char* name;
  const char* title;
  const char* question;  // the exercise
  StudyResult (*run)(const StudyProgress& progress);
};

// All of them, in the order of the lesson.
std::span<const StudyEntry> Studies();

StudyResult StudyComponents(const StudyProgress& progress);
StudyResult StudyBlinnExponent(const StudyProgress& progress);
StudyResult StudyInterpolation(const StudyProgress& progress);
StudyResult StudyGrid(const StudyProgress& progress);
StudyResult StudyFresnel(const StudyProgress& progress);
StudyResult StudyEnergy(const StudyProgress& progress);
StudyResult StudyPrecision(const StudyProgress& progress);
StudyResult StudyTonemap(const StudyProgress& progress);

}  // namespace nacre
