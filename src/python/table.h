// SPDX-License-Identifier: Apache-2.0
// python/table.h: tables of BRDFs as Python has them: a header, the names of columns, and an array
// of rows.
#pragma once

#include <string>
#include <vector>

#include "python/module.h"

namespace nacre_python {

using TableRows = py::array_t<double, py::array::c_style | py::array::forcecast>;

// (header, columns, values)
py::tuple ToPython(const nacre::Table& table);

nacre::Table TableOf(const std::string& header, const std::vector<std::string>& columns,
                     const TableRows& values);

}  // namespace nacre_python
