// SPDX-License-Identifier: Apache-2.0
// study/study.h: studies: answers to the exercises of the founding lesson, and to questions of
// those who implement materials, as pictures, curves and numbers that are computed on demand.
//
// A study returns its results; it neither writes nor prints.
#pragma once

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
  std::string unit;  // empty: dimensionless
};

struct StudyResult {
  std::vector<StudyPicture> pictures;
  std::vector<StudyFigure> figures;
  std::vector<StudyNumber> numbers;
  std::string answer;  // Markdown: paragraphs with the numbers in them
};

// Called now and then with the finished fraction. It may throw to end the study.
using StudyProgress = std::function<void(double)>;

struct StudyEntry {
  const char* name;
  const char* title;
  const char* question;  // the text of the exercise
  StudyResult (*run)(const StudyProgress& progress);
};

// All studies: the exercises in the order of the lesson, then the others.
std::span<const StudyEntry> Studies();

StudyResult StudyComponents(const StudyProgress& progress);
StudyResult StudyBlinnExponent(const StudyProgress& progress);
StudyResult StudyInterpolation(const StudyProgress& progress);
StudyResult StudyGrid(const StudyProgress& progress);
StudyResult StudyFresnel(const StudyProgress& progress);
StudyResult StudyEnergy(const StudyProgress& progress);
StudyResult StudyPrecision(const StudyProgress& progress);
StudyResult StudyTonemap(const StudyProgress& progress);
StudyResult StudyAnisotropy(const StudyProgress& progress);
StudyResult StudyThinFilm(const StudyProgress& progress);
StudyResult StudySheen(const StudyProgress& progress);
StudyResult StudyLayers(const StudyProgress& progress);

}  // namespace nacre
