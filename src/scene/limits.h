// SPDX-License-Identifier: Apache-2.0
// scene/limits.h: the ranges of the numbers in a scene, defined once. The reader of scene files,
// Validate() and the test of the JSON Schema all use them.
#pragma once

#include <cstdint>
#include <string>

#include "base/vec.h"

namespace nacre {

struct Range {
  double min = 0;
  double max = 0;
  bool min_open = false;  // min itself is outside
  bool max_open = false;  // max itself is outside

  // False for NaN.
  bool Contains(double x) const {
    return (min_open ? x > min : x >= min) && (max_open ? x < max : x <= max);
  }
  bool Contains(const Vec3d& v) const { return Contains(v.x) && Contains(v.y) && Contains(v.z); }
  bool operator==(const Range&) const = default;
};

// "from 0 to 1", "greater than 0 and at most 16".
std::string Describe(const Range& range);

namespace limits {

// Positions and lengths. Products of four of them stay finite in double, and so do the squares in
// float. In metres the range goes from the size of an atom's nucleus to a tenth of a light year.
inline constexpr Range kCoordinate{-1e15, 1e15};
inline constexpr Range kLength{1e-15, 1e15};

// Radiance, irradiance, radiant intensity: finite in float, with room for a sum of many lights.
// 1e30f is a little more than 1e30, so that values that were floats are in the range.
inline constexpr Range kRadiance{0, 1e30f};
inline constexpr Range kUnit{0, 1};
// Indices of refraction. A metal's eta may be far below 1, and its k reaches 10 or more in the red.
inline constexpr Range kIor{1, 10};
inline constexpr Range kEta{0.001, 100};
inline constexpr Range kExtinction{0, 100};
// Of OpenPBR, which has no upper limits.
inline constexpr Range kOpenPbrIor{0.015625, 100};
inline constexpr Range kOpenPbrWeight{0, 1e6};
inline constexpr Range kOpenPbrLength{0, 1e9};
inline constexpr Range kScatterAnisotropy{-1, 1};
inline constexpr Range kAbbeNumber{1, 1e6};
// Of thin films. Fringes of thicker ones are too narrow for tables of them.
inline constexpr Range kFilmIor{1, 10};
inline constexpr Range kFilmThicknessUm{0, 10};
inline constexpr Range kFilmThicknessNm{0, 1e4};

inline constexpr Range kFovYDeg{0, 180, true, true};
inline constexpr Range kImageSide{1, 65536};
inline constexpr Range kSpp{1, 65536};
inline constexpr Range kFilterWidth{0, 16, true, false};
inline constexpr Range kSeed{0, 4294967295.0};

// Exponents of cosines, of the Phong family and of spot lights.
inline constexpr Range kExponent{0, 1e9};
inline constexpr Range kAttenuation{0, 1e15};
inline constexpr Range kCutoffDeg{0, 180, true, false};
inline constexpr Range kInnerDeg{0, 180};
// Terms of a quadratic sky.
inline constexpr Range kSkyTerm{-1e6, 1e6};
inline constexpr Range kSplitAt{0, 1, true, true};

// Factors on texture coordinates, and offsets added to them. Far from 0, coordinates lose digits.
inline constexpr Range kTextureScale{-1e6, 1e6};
inline constexpr Range kAngleDeg{-36000, 36000};
inline constexpr Range kDisplacedSegments{3, 4096};
inline constexpr Range kNormalScale{-100, 100};
inline constexpr Range kOpacityCutoff{0, 1e6};

// width x height x spp: about a day of rendering at 1e8 samples a second; more is a slip.
inline constexpr double kMaxSamples = 1e13;

// Spheres and triangles together: ids are 32 bits wide and the last one means none.
inline constexpr uint64_t kMaxPrimitives = 0xfffffffeu;

// The most primitives that a file may generate: 100 bytes of text can ask for a cloud of 1e8
// spheres, and a file can do so many times. As spheres they take 8 GB.
inline constexpr uint64_t kMaxPrimitivesMade = 200'000'000;

inline constexpr Range kCloudCount{1, 1e8};
inline constexpr Range kGridCount{1, 1000};

inline constexpr Range kCreaseAngleDeg{0, 180};
// Spheres as meshes. An icosphere has at most 327 680 faces, a uv sphere 4 194 304.
inline constexpr Range kSubdivisions{0, 7};
inline constexpr Range kSegments{3, 2048};
inline constexpr Range kRings{2, 1025};

}  // namespace limits
}  // namespace nacre
