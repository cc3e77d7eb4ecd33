// SPDX-License-Identifier: Apache-2.0
// textbook/conventions.h: quantifies faults of the founding documents that neither picture shows,
// from their formulas.
#pragma once

namespace nacre {

// k of Schlick's G1 for direct light: (alpha + 1)^2 / 8 in the text, and (r + 1)^2 / 8 in the
// program, as in its source (Karis 2013).
double DirectKOfWords(double roughness);
double DirectKOfProgram(double roughness);

// k for light from everywhere: alpha^2 / 2 = r^4 / 2 in the text, and r^2 / 2 in the source.
double AmbientKOfWords(double roughness);
double AmbientKOfSource(double roughness);

// E4: the fraction of the highlight that "+ 0.0001" removes.
double EpsilonLoss(double n_dot_l, double n_dot_v);

// E5: the factor by which the floor of 1e-10 lowers the peak of D, and the roughness below which it
// does.
double FloorFactor(double roughness);
double FloorRoughness();

// E16: the edge of the equilateral triangle whose normal, the cross product of its edges, has
// length `epsilon`; smaller ones count as degenerate.
double ShortestTriangleEdge(double epsilon);

// E17: the fraction of 1 / d^2 that 1 / (d^2 + 0.0001) loses.
double AttenuationLoss(double distance);

// E18: the factor by which doc1's light direction (1, -1, 1) is too long, and thus n.l too large.
double UnnormalizedLightLength();

// E20: the largest distance, in texels, between u (W - 1) and the texel that u denotes, u W - 1/2;
// and the fraction of a repeated texture's period that is missing.
double TexelShift(int width);
double TexelPeriodLoss(int width);

// E22: tilt of the flat normal map (128, 128, 255) / 255 under 2 T - 1, in degrees, about one axis
// and in total.
double FlatMapTiltPerAxisDeg();
double FlatMapTiltDeg();

// E23: the maximum angle, in degrees, between the original normal and that of a plane displaced by
// h = amplitude sin(2 pi x / wavelength).
double DisplacedNormalErrorDeg(double amplitude, double wavelength);

// E24: the largest difference between x^(1/2.2) and the sRGB curve, and where it occurs.
struct GammaError {
  double difference = 0, at_linear = 0;
};
GammaError LargestGammaError();

// E27: the number of pixel centres that are covered by both of two triangles, the halves of a
// square of `side` pixels, if edges count as inside.
int PixelsDrawnTwice(int side);

// E11: the arithmetic operations for the two cosines R.V and N.H from unit vectors.
struct OperationCount {
  int additions = 0, multiplications = 0, divisions = 0, roots = 0;
};
OperationCount CountPhongCosine();
OperationCount CountBlinnCosine();

}  // namespace nacre
