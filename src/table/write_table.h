// SPDX-License-Identifier: Apache-2.0
// table/write_table.h: tables as files: CSV, JSON and NPY. Numbers have all their digits: they are
// read back as the same doubles.
#pragma once

#include <string>
#include <vector>

#include "table/brdf_table.h"

namespace nacre {

// CSV: the members of the header as comments, "# NAME: JSON", then the names of the columns, then a
// line for each row.
std::string CsvOf(const BrdfTable& table);

// JSON: {"header": {...}, "columns": [...], "rows": [[...], ...]}, a line for each row. Numbers
// that are not finite are null.
std::string TableJsonText(const BrdfTable& table);

// The files that WriteTable writes for this path: itself and, of NPY, which has no place for a
// header, PATH.json with the header, so that numpy.load reads the numbers as they are. Throws Error
// (kUsage) for other extensions than .csv, .json and .npy.
std::vector<std::string> FilesOfTable(const std::string& path);

// Writes the table in the format of the path's extension. All files appear whole or not at all.
void WriteTable(const BrdfTable& table, const std::string& path);

}  // namespace nacre
