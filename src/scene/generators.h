// SPDX-License-Identifier: Apache-2.0
// scene/generators.h: generators of many spheres: grids over material parameters, rows of pairs
// that compare two materials, and random clouds. They make what `grid`, `pair` and `cloud` in scene
// files and the commands of those names describe.
//
// All throw Error (kBadInput) for invalid counts, names or sizes. The ranges of parameters are left
// to Validate().
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/vec.h"
#include "scene/scene.h"

namespace nacre {

// One axis of a grid: `count` places along a row or a column, and at each of them a value of the
// named parameter of the base material (scene/material_parameters.h).
struct GridAxis {
  int count = 1;
  std::string parameter{};    // empty: nothing varies
  std::vector<Rgb> values{};  // `count` of them; a number has three equal components
};

// Makes an axis of `count` evenly spaced values, from `from` to `to`, both included.
GridAxis LinearAxis(std::string parameter, const Rgb& from, const Rgb& to, int count);

// Makes an axis of `count` values at equal ratios, from `from` to `to`, both included. All
// components of both must be > 0.
GridAxis LogarithmicAxis(std::string parameter, const Rgb& from, const Rgb& to, int count);

// Spheres in a plane of constant z: rows downwards from the top, columns from left to right.
struct Grid {
  Vec3d center{0, 0, 0};
  Vec2d spacing{1, 1};  // between the centres of neighbours in x and y, > 0
  double radius = 0.4;  // > 0
  Material material{};  // gives the parameters that no axis varies
  GridAxis rows{};
  GridAxis columns{};
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

// Spheres scattered uniformly in a box. Each depends only on the seed and its index, by integer
// hashing, so a cloud is the same on every machine, and a longer cloud begins with the shorter one.
struct Cloud {
  uint64_t count = 1000;  // at most 1e8
  uint32_t seed = 0;
  Vec3d min{-1, -1, -1};  // of the centres
  Vec3d max{1, 1, 1};     // >= min
  double radius_min = 0.01;
  double radius_max = 0.01;           // >= radius_min > 0; uniform between them
  std::vector<MaterialId> materials;  // equally likely, not empty
};

// Appends the cloud's spheres. `threads` is that of ParallelFor; the result does not depend on it.
void AddCloud(const Cloud& cloud, int threads, Scene* scene);

}  // namespace nacre
