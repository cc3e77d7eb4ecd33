// SPDX-License-Identifier: Apache-2.0
// textbook/conventions.h: faults of the founding documents that neither picture shows, as numbers
// from their formulas.
#pragma once

#include <cstdint>

namespace nacre {

// k of Schlick's G1 for direct light: the words (alpha + 1)^2 / 8 and the program (r + 1)^2 / 8,
// which is its source's (Karis 2013).
double DirectKOfWords(double roughness);
double DirectKOfProgram(double roughness);

// k for light from everywhere: the words alpha^2 / 2 = r^4 / 2, and the source r^2 / 2.
double AmbientKOfWords(double roughness);
double AmbientKOfSource(double roughness);

// E4: what "+ 0.0001" takes off the highlight.
double EpsilonLoss(double n_dot_l, double n_dot_v);

// E5: by what factor the floor of 1e-10 lowers the peak of D, and below which roughness it does.
double FloorFactor(double roughness);
double FloorRoughness();

// E16: the edge of the equilateral triangle whose normal, the cross product of its edges, has
// length `epsilon`; smaller ones count as degenerate.
double ShortestTriangleEdge(double epsilon);

// E17: what 1 / (d^2 + 0.0001) takes off 1 / d^2.
double AttenuationLoss(double distance);

// E18: how much too long doc1's light direction (1, -1, 1) is; n.l grows by it.
double UnnormalizedLightLength();

// E20: the largest distance between u (W - 1) and the texel that u names, u W - 1/2, in texels; and
// the share of a repeated texture's period that is missing.
double TexelShift(int width);
double TexelPeriodLoss(int width);

// E22: tilt of the flat normal map (128, 128, 255) / 255 under 2 T - 1, in degrees, about one axis
// and in total.
double FlatMapTiltPerAxisDeg();
double FlatMapTiltDeg();

// E23: the angle between the old normal and that of a plane displaced by h = amplitude
// sin(2 pi x / wavelength), where it is largest, in degrees.
double DisplacedNormalErrorDeg(double amplitude, double wavelength);

// E24: the largest difference between x^(1/2.2) and the sRGB curve, and where it is.
struct GammaError {
  double difference = 0, at_linear = 0;
};
GammaError LargestGammaError();

// E27: pixel centres that two triangles, halves of a square of `side` pixels, both cover when
// edges count as inside.
int PixelsDrawnTwice(int side);

// E11: arithmetic of the two cosines R.V and N.H from unit vectors.
struct OperationCount {
  int additions = 0, multiplications = 0, divisions = 0, roots = 0;
};
OperationCount CountPhongCosine();
OperationCount CountBlinnCosine();

}  // namespace nacre
