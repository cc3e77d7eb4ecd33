// SPDX-License-Identifier: Apache-2.0
// lesson/fault_amounts.h: measures the effect of each fault of the founding documents
// (FaultAmount): by switching it off in the lesson's pictures, by quadrature, or from its formula.
#pragma once

#include "lesson/code_change.h"

namespace nacre {

// The lines of ChangeLines for the lesson without one of its faults.
template <bool TextbookFaults::*kFault>
std::vector<std::string> AmountOfSwitch(const LessonPictures& lesson) {
  return ChangeLines(lesson, Without(kFault));
}

using AmountLines = std::vector<std::string>;

AmountLines AmountOfAlpha(const LessonPictures&);           // E1
AmountLines AmountOfDirectK(const LessonPictures&);         // E2
AmountLines AmountOfAmbientK(const LessonPictures&);        // E3
AmountLines AmountOfEpsilon(const LessonPictures&);         // E4
AmountLines AmountOfFloors(const LessonPictures&);          // E5
AmountLines AmountOfMetalF0(const LessonPictures&);         // E6
AmountLines AmountOfEnergy(const LessonPictures&);          // E7
AmountLines AmountOfEncoding(const LessonPictures&);        // E8
AmountLines AmountOfHalves(const LessonPictures&);          // E9
AmountLines AmountOfClip(const LessonPictures&);            // E10
AmountLines AmountOfBlinnCost(const LessonPictures&);       // E11
AmountLines AmountOfUngated(const LessonPictures&);         // E12
AmountLines AmountOfGrid(const LessonPictures&);            // E14
AmountLines AmountOfSmallVectors(const LessonPictures&);    // E16
AmountLines AmountOfAttenuation(const LessonPictures&);     // E17
AmountLines AmountOfLightDirection(const LessonPictures&);  // E18
AmountLines AmountOfNotesShader(const LessonPictures&);     // E19
AmountLines AmountOfTexels(const LessonPictures&);          // E20
AmountLines AmountOfSphereUv(const LessonPictures&);        // E21
AmountLines AmountOfNormalMap(const LessonPictures&);       // E22
AmountLines AmountOfDisplacement(const LessonPictures&);    // E23
AmountLines AmountOfCurves(const LessonPictures&);          // E24
AmountLines AmountOfMetalDiffuse(const LessonPictures&);    // E25
AmountLines AmountOfAmbientColor(const LessonPictures&);    // E26
AmountLines AmountOfEdges(const LessonPictures&);           // E27
AmountLines AmountOfInside(const LessonPictures&);          // E28
AmountLines NothingToMeasure(const LessonPictures&);        // E29

}  // namespace nacre
