// SPDX-License-Identifier: Apache-2.0
// tests/base/trig_kernel.h: base/trig-inl.h on one number, on the active target, for tests.
#pragma once

namespace nacre {

float EvaluateSinTurns(float u);
float EvaluateCosTurns(float u);
float EvaluateAtanRemainder(float x);
float EvaluateAtan2Upper(float y, float x);

}  // namespace nacre
