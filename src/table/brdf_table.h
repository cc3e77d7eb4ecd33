// SPDX-License-Identifier: Apache-2.0
// table/brdf_table.h: the values of a material's BRDF over pairs of directions, as numbers with
// named columns and a header that says all that they depend on.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "scene/material.h"
#include "scene_io/json_text.h"
#include "table/direction_pairs.h"

namespace nacre {

struct BrdfTable {
  Json header = Json::object();  // see HeaderOf
  std::vector<std::string> columns{};
  std::vector<double> values{};  // row by row
  // The line or index of each row in the file it was read from; empty: counted from 1.
  std::vector<size_t> places{};
  bool places_are_lines = false;

  size_t rows() const { return columns.empty() ? 0 : values.size() / columns.size(); }
  double At(size_t row, size_t column) const { return values[row * columns.size() + column]; }
};

// The rows that hold a value that is not finite.
std::vector<size_t> RowsNotFinite(const BrdfTable& table);

struct TableOptions {
  // The columns albedo_r, albedo_g and albedo_b: quadratures of some milliseconds to some hundred
  // for each different n.v.
  bool albedo = true;
  std::function<void(double)> on_progress{};  // gets the finished fraction; may throw to stop
};

// The columns: light_x, light_y, light_z, view_x, view_y, view_z, then f_r, f_g and f_b in 1/sr
// without n.l, the same of each lobe as it contributes to f (diffuse_r, ...), pdf per solid angle
// of nacre's sampler, and the albedo seen from the view. All are 0 where light or view is not above
// the surface. Maps, emission and mirrors are left out; the header names what there is of them.
BrdfTable TabulateBrdf(const Material& material, std::span<const DirectionPair> pairs,
                       const TableOptions& options = {});

// The columns of directions alone.
BrdfTable TabulateDirections(std::span<const DirectionPair> pairs);

// What a table of this material begins with: the versions of nacre and of the format, the material
// with every parameter and every choice by name (of OpenPBR also the rules that they are those of),
// and the conventions of directions, units, colours, lobes, mirrors, pdf and albedo.
Json HeaderOf(const Material& material);

// The columns of TabulateBrdf.
std::vector<std::string> ColumnsOf(const Material& material, bool albedo);

// The material in the form of scene files with all digits, every parameter and every choice. A
// function of the user's is {"model": "function"}.
Json WholeMaterialJson(const Material& material);

}  // namespace nacre
