// SPDX-License-Identifier: Apache-2.0
// table/npy.h: numpy's .npy files (format 1.0 to 3.0) of numbers: one axis with named columns, or
// two axes. Pickled objects, which may run code, are refused.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace nacre {

// An array of one axis whose elements have a float64 for each column, by name.
std::string NpyBytes(std::span<const std::string> columns, std::span<const double> values);

struct NpyTable {
  std::vector<std::string> columns;  // empty: an array of two axes, without names
  size_t width = 0;                  // numbers in a row
  std::vector<double> values;        // row by row
};

// Numbers are whole or floating-point ones of any size and byte order; a named column may have
// several, which are named "light_0", "light_1", ... Throws Error (kBadInput), located in `file`,
// for anything else, for files that are cut off, and for more than `max_rows` rows or `max_columns`
// columns.
NpyTable ParseNpy(std::string_view bytes, const std::string& file, size_t max_rows,
                  size_t max_columns);

}  // namespace nacre
