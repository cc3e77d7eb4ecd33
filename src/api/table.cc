// SPDX-License-Identifier: Apache-2.0
// api/table.cc: tables of BRDFs in the public API.
#include "api/table.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "table/read_table.h"
#include "table/write_table.h"

namespace nacre::v0 {

Table ToPublic(nacre::BrdfTable&& table) {
  return {JsonText(table.header), std::move(table.columns), std::move(table.values)};
}

nacre::BrdfTable ToOwn(const Table& table) {
  const size_t width = table.columns.size();
  if (width == 0 || table.values.size() % width != 0) {
    throw nacre::Error(ExitCode::kUsage, "Table",
                       fmt::format("has {} values in {} columns", table.values.size(), width),
                       "each row has a value for each column");
  }
  if (table.values.size() / width > kMostTableRows) {
    throw nacre::Error(ExitCode::kUsage, "Table",
                       fmt::format("has {} rows", table.values.size() / width),
                       fmt::format("up to {} are taken", kMostTableRows));
  }
  nacre::BrdfTable own{.columns = table.columns, .values = table.values};
  if (table.header.empty()) return own;
  const std::optional<nacre::Json> header = TryParseJson(table.header);
  if (!header || !header->is_object()) {
    throw nacre::Error(ExitCode::kUsage, "Table", "has a header that is no JSON object");
  }
  own.header = *header;
  return own;
}

Table TableDirections(const TableGrid& grid) {
  return AtBorder([&] {
    const DirectionGrid own{grid.light, grid.view, grid.phi, grid.view_phi};
    for (const std::vector<double>* const angles : {&own.light_deg, &own.view_deg}) {
      for (const double angle : *angles) {
        if (angle >= 0 && angle <= 90) continue;
        throw nacre::Error(ExitCode::kUsage, "TableGrid", fmt::format("an angle is {}", angle),
                           "angles from the normal are from 0 to 90 degrees");
      }
    }
    const size_t most = kMostTableRows;
    const size_t light = own.light_deg.size(), view = own.view_deg.size();
    if (light > most || view > most || light * view > most ||
        own.phi_deg.size() > most / std::max<size_t>(light * view, 1)) {
      throw nacre::Error(ExitCode::kUsage, "TableGrid", "has too many pairs of directions",
                         fmt::format("up to {} are possible", most));
    }
    for (const double phi : own.phi_deg) {
      if (std::isfinite(phi) && std::isfinite(own.view_phi_deg)) continue;
      throw nacre::Error(ExitCode::kUsage, "TableGrid", "an azimuth is not finite");
    }
    return ToPublic(TabulateDirections(PairsOf(own)));
  });
}

Table ReadTable(const std::string& path) {
  return AtBorder([&] { return ToPublic(nacre::ReadTable(path)); });
}

void WriteTable(const Table& table, const std::string& path) {
  AtBorder([&] { nacre::WriteTable(ToOwn(table), path); });
}

}  // namespace nacre::v0
