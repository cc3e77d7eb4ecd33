// SPDX-License-Identifier: Apache-2.0
#include "image_io/text_width.h"

#include <array>
#include <cstdint>

namespace nacre {
namespace {

// Advance widths of the characters 32 to 126 of DejaVu Sans 2.37, in units of 1/2048 of the size.
constexpr std::array<uint16_t, 95> kAdvances = {
    651,  821,  942,  1716, 1303, 1946, 1597, 563,  799,  799,  1024, 1716, 651,  739,  651,  690,
    1303, 1303, 1303, 1303, 1303, 1303, 1303, 1303, 1303, 1303, 690,  690,  1716, 1716, 1716, 1087,
    2048, 1401, 1405, 1430, 1577, 1294, 1178, 1587, 1540, 604,  604,  1343, 1141, 1767, 1532, 1612,
    1235, 1612, 1423, 1300, 1251, 1499, 1401, 2025, 1403, 1251, 1403, 799,  690,  799,  1716, 1024,
    1024, 1255, 1300, 1126, 1300, 1260, 721,  1300, 1298, 569,  569,  1186, 569,  1995, 1298, 1253,
    1300, 1300, 842,  1067, 803,  1298, 1212, 1675, 1212, 1212, 1075, 1303, 690,  1303, 1716};
constexpr double kUnits = 2048;

}  // namespace

double TextWidth(std::string_view text, double size_px) {
  double units = 0;
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    if ((code & 0xc0u) == 0x80u) continue;  // a later byte of a letter
    const bool known = code >= 32 && code < 127;
    units += known ? kAdvances[code - 32u] : kAdvances['0' - 32];
  }
  return units / kUnits * size_px;
}

}  // namespace nacre
