// SPDX-License-Identifier: Apache-2.0
// scene/generators.h: spheres by the dozen or the million: grids over material parameters, rows of
// pairs to compare two materials, random clouds. What `grid`, `pair` and `cloud` in scene files and
// the commands of those names make.
//
// All throw Error (kBadInput) for counts, names or sizes that make no sense; ranges of parameters
// are left to Validate().
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/vec.h"
#include "scene/scene.h"

namespace nacre {

// What varies along a row or a column: `count` places, and at each its value of one parameter of
// the base material by name (scene/material_parameters.h).
struct GridAxis {
  int count = 1;
  std::string parameter;    // empty: nothing varies
  std::vector<Rgb> values;  // `count` of them; of a number, three equal components
};

// `count` values from `from` to `to`, both included, at equal distances.
GridAxis LinearAxis(std::string parameter, const Rgb& from, const Rgb& to, int count);

// The same at equal ratios; all components of both ends are above 0.
GridAxis LogarithmicAxis(std::string parameter, const Rgb& from, const Rgb& to, int count);

// Spheres in a plane of constant z: rows downwards from the top, columns from left to right.
struct Grid {
  Vec3d center{0, 0, 0};
  Vec2d spacing{1, 1};  // between the centres of neighbours in x and y, > 0
  double radius = 0.4;  // > 0
  Material material;    // what the axes do not vary
  GridAxis rows;
  GridAxis columns;
};

// Adds the grid's spheres row by row, a material for each ("grid roughness=0.1 metallic=0.25") and
// a label for each row at the left and each column at the top ("roughness 0.1").
void AddGrid(const Grid& grid, Scene* scene);

struct PairSide {
  std::string label;  // written beside the row or column of this side; may be empty
  Material material;
  GridAxis values;  // one for each pair, from left to right
};

// A row of pairs of spheres, A beside B, from left to right in a plane of constant z.
struct PairRow {
  enum class Arrangement : uint8_t {
    kStacked,     // A above B
    kSideBySide,  // A left of B
  };
  Arrangement arrangement = Arrangement::kStacked;
  Vec3d center{0, 0, 0};
  double pair_spacing = 1;  // between the centres of neighbouring pairs, > 0
  double spacing = 1;       // between the centres of A and B, > 0
  double radius = 0.4;      // > 0
  PairSide a;
  PairSide b;  // as many values as a
};

// Adds the pairs' spheres (A, B, A, B...), a material for each, and labels: A's values above, B's
// below, and, when stacked, the names of the sides at the left.
void AddPair(const PairRow& row, Scene* scene);

// Spheres scattered uniformly in a box. Each depends on (seed, its index) alone, by integer
// hashing, so a cloud is the same on every machine and a longer one begins with a shorter one.
struct Cloud {
  uint64_t count = 1000;  // at most 1e8
  uint32_t seed = 0;
  Vec3d min{-1, -1, -1};  // of the centres
  Vec3d max{1, 1, 1};     // >= min
  double radius_min = 0.01;
  double radius_max = 0.01;           // >= radius_min > 0; uniform between them
  std::vector<MaterialId> materials;  // equally likely, not empty
};

// `threads`: as ParallelFor's; they change no bits.
void AddCloud(const Cloud& cloud, int threads, Scene* scene);

}  // namespace nacre
