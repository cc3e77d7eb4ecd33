// SPDX-License-Identifier: Apache-2.0
#include "scene_io/merl_file.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "base/error.h"
#include "scene_io/stored_number.h"

namespace nacre {
namespace {

constexpr std::array<size_t, 3> kCounts = {MerlTable::kThetaHalf, MerlTable::kThetaDiff,
                                           MerlTable::kPhiDiff};
// Stored values are these multiples of 1/sr.
constexpr std::array<double, 3> kScales = {1.0 / 1500, 1.15 / 1500, 1.66 / 1500};
constexpr std::array<const char*, 3> kChannels = {"red", "green", "blue"};

[[noreturn]] void RefuseMerl(const std::string& file, std::string what, std::string hint) {
  throw Error(ExitCode::kBadInput, file, std::move(what), std::move(hint));
}

int64_t CountAt(std::string_view head, size_t i, bool swap) {
  return static_cast<int64_t>(LoadNumber(head.data() + 4 * i, NumberType::kInt32, swap));
}

}  // namespace

void CheckMerlHeader(std::string_view head, uint64_t bytes, const std::string& file) {
  constexpr const char* kHint = "download it again: a MERL table has 34992012 bytes";
  if (head.size() < kMerlHeaderBytes) {
    RefuseMerl(file, fmt::format("ends after {} bytes, in its header", head.size()), kHint);
  }
  bool right = true, swapped = true;
  for (size_t i = 0; i < kCounts.size(); ++i) {
    right = right && CountAt(head, i, false) == static_cast<int64_t>(kCounts[i]);
    swapped = swapped && CountAt(head, i, true) == static_cast<int64_t>(kCounts[i]);
  }
  if (swapped) {
    RefuseMerl(file, "is big-endian",
               "MERL tables are little-endian: swap the bytes of its "
               "integers and doubles");
  }
  if (!right) {
    const int64_t half = CountAt(head, 0, false), diff = CountAt(head, 1, false),
                  phi = CountAt(head, 2, false);
    const bool whole_circle = half == 90 && diff == 90 && phi == 360;
    RefuseMerl(file,
               fmt::format("has {} x {} x {} cells, not 90 x 90 x 180 as tables of the MERL "
                           "database",
                           half, diff, phi),
               whole_circle ? "keep the first 180 azimuths of each row: the rest is their mirror"
                            : "is it a MERL .binary?");
  }
  if (bytes != kMerlBytes) {
    RefuseMerl(file,
               fmt::format("has {} bytes instead of {}: it is {}", bytes, kMerlBytes,
                           bytes < kMerlBytes ? "incomplete" : "longer than its table"),
               kHint);
  }
}

MerlTable ReadMerl(std::string_view bytes, const std::string& file) {
  CheckMerlHeader(bytes.substr(0, kMerlHeaderBytes), bytes.size(), file);
  MerlTable table;
  table.rgb.resize(3 * MerlTable::kCells);
  constexpr double kMost = 1e9;  // products with light stay finite in float
  for (size_t c = 0; c < 3; ++c) {
    const char* const from = bytes.data() + kMerlHeaderBytes + 8 * c * MerlTable::kCells;
    for (size_t cell = 0; cell < MerlTable::kCells; ++cell) {
      const double value = LoadNumber(from + 8 * cell, NumberType::kDouble, false) * kScales[c];
      if (!(std::abs(value) <= kMost)) {
        const size_t phi = cell % MerlTable::kPhiDiff, row = cell / MerlTable::kPhiDiff;
        RefuseMerl(
            file,
            fmt::format("{} of cell ({}, {}, {}) of theta_half, theta_diff and phi_diff is "
                        "{}",
                        kChannels[c], row / MerlTable::kThetaDiff, row % MerlTable::kThetaDiff, phi,
                        LoadNumber(from + 8 * cell, NumberType::kDouble, false)),
            "values are finite, up to 1e9 / sr; cells without data are negative");
      }
      table.rgb[3 * cell + c] = static_cast<float>(value);
    }
  }
  // A cell without data has none in any channel.
  for (size_t cell = 0; cell < MerlTable::kCells; ++cell) {
    float* const rgb = table.rgb.data() + 3 * cell;
    if (std::min({rgb[0], rgb[1], rgb[2]}) < 0) std::fill_n(rgb, 3, 0.0f);
  }
  return table;
}

}  // namespace nacre
