// SPDX-License-Identifier: Apache-2.0
// brdf/measured_table.h: a BRDF that was measured, as tables: of the MERL database (Matusik et al.
// 2003, "A Data-Driven Reflectance Model") or of EPFL's (Dupuy and Jakob 2018, "An Adaptive
// Parameterization for Efficient Material Acquisition and Rendering"). Plain data, as the files
// have it, but for the scales that are applied when it is read; merl.h and rgl.h look it up.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "base/vec.h"
#include "brdf/tabulated_warp.h"

namespace nacre {

// How a MERL table is looked up. Those of EPFL are always linear: their parameters are warped.
enum class MeasuredInterpolation : uint8_t {
  kLinear,   // between the centres of cells
  kNearest,  // the cell that contains the directions, as the database's own program
};

// An isotropic BRDF by cells of the half vector's angle, the difference angle and its azimuth.
struct MerlTable {
  static constexpr size_t kThetaHalf = 90, kThetaDiff = 90, kPhiDiff = 180;
  static constexpr size_t kCells = kThetaHalf * kThetaDiff * kPhiDiff;
  // Three channels of each cell, in 1/sr; the azimuth varies fastest. Cells without data are 0.
  std::vector<float> rgb;
};

// A table of numbers over the unit square, bilinear.
struct SquareTable {
  size_t width = 0, height = 0;
  std::vector<float> values;  // row by row
};

// The BRDF as a product of an analytic part, by the distribution of microfacets, and of a table
// over the square that MeasuredBrdf::half warps to half vectors.
struct RglTable {
  bool jacobian = true;      // whether the analytic part is a factor
  SquareTable ndf, sigma;    // the distribution, and the projected area of the microfacets
  size_t size = 0;           // nodes along each side of the square
  std::vector<float> rgb{};  // by slice of MeasuredBrdf::half, channel, row and column
};

// Albedos are tabulated at equal steps of the viewer's angle, from 0 to pi / 2.
inline constexpr size_t kAlbedoAngles = 33;

struct MeasuredBrdf {
  std::variant<MerlTable, RglTable> table;
  // Whether reflection depends on the viewer's azimuth about the normal. If so, measurements cover
  // 1 / reduction of it, and the rest follows by symmetry: 1, 2 or 4.
  bool isotropic = true;
  int reduction = 1;
  // The density of half vectors by which directions are sampled, over the square of rgl.h: of
  // EPFL's files their own, which the table refers to; of MERL tables what they reflect, tabulated.
  TabulatedWarp half;
  // A density over the square that `half` warps, or empty.
  TabulatedWarp luminance;
  std::array<Rgb, kAlbedoAngles> albedo{};  // the fraction of light reflected to the viewer
  Rgb mean_albedo{0, 0, 0};                 // over all viewers, weighted by the cosine
  std::string description{};                // what the file says of itself
  uint64_t hash = 0;                        // of the file's bytes
};

// Derives what sampling needs: `half` of a MERL table, and the albedos, by quadrature.
void FinishMeasured(MeasuredBrdf* brdf);

}  // namespace nacre
