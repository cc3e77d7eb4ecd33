// SPDX-License-Identifier: Apache-2.0
#include "table/write_table.h"

#include <cmath>
#include <iterator>
#include <memory>
#include <span>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/error.h"
#include "base/path.h"
#include "image_io/output_file.h"
#include "table/npy.h"

namespace nacre {
namespace {

void WriteAll(OutputFile* file, const std::string& bytes) {
  file->Write(0, std::span(reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size()));
}

}  // namespace

std::string CsvOf(const BrdfTable& table) {
  std::string text;
  for (const auto& [key, value] : table.header.items()) {
    text += fmt::format("# {}: {}\n", key, JsonText(value));
  }
  text += fmt::format("{}\n", fmt::join(table.columns, ","));
  const size_t width = table.columns.size();
  for (size_t row = 0; row < table.rows(); ++row) {
    for (size_t column = 0; column < width; ++column) {
      // The shortest text that is read as the same double.
      fmt::format_to(std::back_inserter(text), "{}{}", table.At(row, column),
                     column + 1 < width ? ',' : '\n');
    }
  }
  return text;
}

std::string TableJsonText(const BrdfTable& table) {
  std::string text = fmt::format("{{\"header\": {},\n \"columns\": {},\n \"rows\": [",
                                 JsonText(table.header), JsonText(Json(table.columns)));
  const size_t width = table.columns.size();
  for (size_t row = 0; row < table.rows(); ++row) {
    text += row == 0 ? "\n  [" : ",\n  [";
    for (size_t column = 0; column < width; ++column) {
      const double value = table.At(row, column);
      if (column > 0) text += ", ";
      if (std::isfinite(value)) {
        fmt::format_to(std::back_inserter(text), "{}", value);
      } else {
        text += "null";
      }
    }
    text += ']';
  }
  return text + "]}\n";
}

std::vector<std::string> FilesOfTable(const std::string& path) {
  if (HasExtension(path, ".csv") || HasExtension(path, ".json")) return {path};
  if (HasExtension(path, ".npy")) return {path, path + ".json"};
  throw Error(ExitCode::kUsage, path, "is not the name of a table",
              "it ends in .csv, .json or .npy");
}

void WriteTable(const BrdfTable& table, const std::string& path) {
  const std::vector<std::string> paths = FilesOfTable(path);
  OutputFile file(path);
  if (paths.size() == 1) {
    WriteAll(&file, HasExtension(path, ".csv") ? CsvOf(table) : TableJsonText(table));
    file.Commit();
    return;
  }
  OutputFile header(paths[1]);
  WriteAll(&header, JsonText(table.header, 2) + "\n");
  WriteAll(&file, NpyBytes(table.columns, table.values));
  header.Commit();
  file.Commit();
}

}  // namespace nacre
