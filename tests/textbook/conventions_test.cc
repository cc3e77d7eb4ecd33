// SPDX-License-Identifier: Apache-2.0
// tests/textbook/conventions_test.cc: the numbers that stand for faults which no picture shows.
#include "textbook/conventions.h"

#include <cmath>

#include "catch.h"

namespace nacre {
namespace {

TEST_CASE("k as the words and as the program have it") {
  CHECK(DirectKOfWords(0.4) == Approx(1.16 * 1.16 / 8));
  CHECK(DirectKOfProgram(0.4) == Approx(1.4 * 1.4 / 8));
  CHECK(AmbientKOfWords(0.5) == Approx(1.0 / 32));
  CHECK(AmbientKOfSource(0.5) == Approx(1.0 / 8));
}

TEST_CASE("epsilons in the shading") {
  CHECK(EpsilonLoss(0.1, 0.1) == Approx(0.0025).epsilon(0.01));
  CHECK(EpsilonLoss(0.02, 0.02) == Approx(0.059).epsilon(0.01));
  CHECK(EpsilonLoss(0.005, 0.005) == Approx(0.5));
  CHECK(FloorRoughness() == Approx(0.0487).epsilon(0.002));
  CHECK(FloorFactor(0.04) == Approx(1e-10 / (M_PI * std::pow(0.04, 8))));
  CHECK(FloorFactor(0.05) == Approx(1));
}

TEST_CASE("epsilons elsewhere") {
  // An equilateral triangle of that edge has just that cross product.
  const double edge = ShortestTriangleEdge(1e-6);
  CHECK(edge * edge * std::sin(M_PI / 3) == Approx(1e-6));
  CHECK(AttenuationLoss(0.1) == Approx(0.01).epsilon(0.02));
  CHECK(AttenuationLoss(0.01) == Approx(0.5));
  CHECK(UnnormalizedLightLength() == Approx(std::sqrt(3.0)));
}

TEST_CASE("textures and normal maps") {
  CHECK(TexelShift(4) == Approx(0.5));
  CHECK(TexelPeriodLoss(4) == 0.25);
  CHECK(FlatMapTiltPerAxisDeg() == Approx(0.225).margin(0.0005));
  CHECK(FlatMapTiltDeg() == Approx(0.318).margin(0.0005));
  CHECK(DisplacedNormalErrorDeg(1, 2 * M_PI) == Approx(45));
}

TEST_CASE("edges and operations") {
  CHECK(PixelsDrawnTwice(100) == 100);
  const OperationCount phong = CountPhongCosine();
  CHECK(phong.additions == 2 + 3 + 2);            // N.L, - L, R.V
  CHECK(phong.multiplications == 3 + 1 + 3 + 3);  // N.L, 2 (), () N, R.V
  CHECK(phong.roots == 0);
  const OperationCount blinn = CountBlinnCosine();
  CHECK(blinn.additions == 3 + 2 + 2);
  CHECK(blinn.multiplications == 3 + 3);
  CHECK(blinn.divisions == 1);
  CHECK(blinn.roots == 1);
}

}  // namespace
}  // namespace nacre
