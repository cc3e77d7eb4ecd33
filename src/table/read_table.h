// SPDX-License-Identifier: Apache-2.0
// table/read_table.h: tables of any program: CSV, JSON and NPY files, and what their columns mean.
//
// Files may come from strangers: sizes are bounded, and each fault is told with its line.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/vec.h"
#include "table/brdf_table.h"
#include "table/direction_pairs.h"

namespace nacre {

inline constexpr size_t kMostTableRows = 1 << 20;
inline constexpr size_t kMostTableColumns = 1024;
inline constexpr uint64_t kMostTableBytes = 512u << 20;
inline constexpr uint64_t kMostJsonTableBytes = 64u << 20;  // as a tree, JSON takes ten times that

// Reads the columns of a file, whose format its extension tells:
//   .csv (and any other): names, then numbers, between commas, semicolons, tabs or blanks; lines
//     that begin with # are comments, of which those of nacre are the header. Without names, the
//     columns have the name "".
//   .json: {"columns": [...], "rows": [[...], ...]}, or arrays by name, of numbers or of three
//     numbers each, or a list of objects. NaN, Infinity and null may stand for numbers.
//   .npy: see table/npy.h.
// Throws Error (kBadInput).
BrdfTable ReadTable(const std::string& path);

// What another program evaluated.
struct EvaluatedTable {
  std::vector<DirectionPair> pairs;
  std::vector<Rgb> f;
  std::map<std::string, std::vector<Rgb>> lobes;  // those of `lobes` below that it has
  std::optional<std::vector<double>> pdf;
  std::optional<std::vector<Rgb>> albedo;
  std::vector<std::string> notes;  // what was left out or taken for something, for people
};

// The directions of a table. Columns are found by their names, among which are obvious others
// (L.x, lightX, to_light_0). Throws Error (kBadInput), located in `file`, for missing columns and
// for vectors that are not unit, row by row. Those that are rounded are normalised; a note is added
// to `notes`, unless it is null.
std::vector<DirectionPair> DirectionsOf(const BrdfTable& table, const std::string& file,
                                        std::vector<std::string>* notes = nullptr);

// What a table has of f, pdf, albedo and the lobes of a material, whose own table has `columns`
// (ColumnsOf). A single column f is grey. Throws as DirectionsOf does.
EvaluatedTable EvaluatedOf(const BrdfTable& table, const std::string& file,
                           const std::vector<std::string>& columns,
                           const std::vector<std::string>& lobes);

// "line 17" or "row 17" of a table's row, counted from 0.
std::string PlaceOf(const BrdfTable& table, size_t row);

}  // namespace nacre
