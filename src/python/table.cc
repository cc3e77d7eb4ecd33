// SPDX-License-Identifier: Apache-2.0
// python/table.cc: tables of BRDFs, as files and as arrays.
#include "python/table.h"

#include <algorithm>

#include <pybind11/stl.h>

namespace nacre_python {

py::tuple ToPython(const nacre::Table& table) {
  const size_t width = table.columns.size();
  const size_t rows = width > 0 ? table.values.size() / width : 0;
  py::array_t<double> values({rows, width});
  std::copy(table.values.begin(), table.values.end(), values.mutable_data());
  py::list columns;
  for (const std::string& column : table.columns) columns.append(TextOf(column));
  return py::make_tuple(TextOf(table.header), columns, values);
}

nacre::Table TableOf(const std::string& header, const std::vector<std::string>& columns,
                     const TableRows& values) {
  RequireShape(values, values.ndim() > 0 ? static_cast<size_t>(values.shape(0)) : 0,
               columns.size());
  return {header, columns, {values.data(), values.data() + values.size()}};
}

void BindTables(py::module_* module) {
  module->def("table_directions",
              [](const std::vector<double>& light, const std::vector<double>& view,
                 const std::vector<double>& phi, double view_phi) {
                return ToPython(nacre::TableDirections({light, view, phi, view_phi}));
              });
  module->def("read_table", [](const py::bytes& path) {
    const std::string name = path;
    return ToPython(Unlocked([&] { return nacre::ReadTable(name); }));
  });
  module->def("write_table", [](const std::string& header, const std::vector<std::string>& columns,
                                const TableRows& values, const py::bytes& path) {
    const nacre::Table table = TableOf(header, columns, values);
    const std::string name = path;
    Unlocked([&] { nacre::WriteTable(table, name); });
  });
}

}  // namespace nacre_python
