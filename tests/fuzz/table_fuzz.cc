// SPDX-License-Identifier: Apache-2.0
// tests/fuzz/table_fuzz.cc: a table of another program, compared with a material.
#include "fuzz/fuzz_input.h"
#include "fuzz/targets.h"
#include "table/check_table.h"
#include "table/read_table.h"

namespace nacre {

void FuzzBrdfTable(std::string_view bytes) {
  const std::string name = bytes.starts_with("\x93NUMPY")                     ? "table.npy"
                           : bytes.starts_with("{") || bytes.starts_with("[") ? "table.json"
                                                                              : "table.csv";
  const std::string path = SharedFolder().Write(name, bytes).string();
  ReadOrRefuse([&] { DirectionsOf(ReadTable(path), path); });
  ReadOrRefuse([&] {
    // Without a mistake that is tried, for speed: the numbers alone are a stranger's.
    const TableCheck check = CheckTable({}, ReadTable(path), path, /*tolerance=*/2);
    JsonText(CheckJson(check));
    PageOf(check);
  });
}

}  // namespace nacre
