// SPDX-License-Identifier: Apache-2.0
// table/check_table.h: compares what another program evaluated of a material with nacre's values:
// where it differs, by how much, and which mistake or which choice explains it.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "table/brdf_table.h"
#include "table/hypotheses.h"

namespace nacre {

// Errors are |theirs - nacre's| over the larger one of both. Values below kLeastValue count as
// that.
inline constexpr double kLeastValue = 1e-6;
inline constexpr double kDefaultTableTolerance = 1e-3;

// The errors of one quantity over all rows in which both are finite.
struct PartErrors {
  std::string name;  // "f", a lobe, "pdf", "albedo"
  size_t rows = 0;
  double rms = 0, largest = 0;
  size_t worst_row = 0;
  std::array<double, 3> theirs{}, ours{};  // there, in all channels
};

// The largest error of f by angle.
struct AngleErrors {
  std::vector<std::string> light, view;  // degrees from the normal, "30" or "30-45"
  std::vector<double> errors;            // light by light; below 0 where there is no row
};

struct RankedHypothesis {
  HypothesisKind kind = HypothesisKind::kMistake;
  std::string text;
  double rms = 0;  // the error that it leaves
  double largest = 0;
};

struct LobeFactor {
  std::string lobe;
  double factor = 1;
};

struct TableCheck {
  bool ok = false;  // f is finite and within the tolerance in all rows
  double tolerance = kDefaultTableTolerance;
  std::string file;
  Json material;
  size_t rows = 0;
  // Rows in which f is not finite: how many, and where the first ones are.
  size_t not_finite = 0;
  std::vector<std::string> not_finite_at{};
  PartErrors f;
  double median = 0;     // of the rows' errors of f
  std::string worst_at;  // the place of the worst row and its angles
  // For information: samplers differ, and so do the parts into which programs split f.
  std::vector<PartErrors> parts{};
  AngleErrors angles;
  // The rest is there if f is not within the tolerance.
  size_t diagnosed_rows = 0;  // up to kDiagnosedRows of those that are finite
  double diagnosed_rms = 0;   // of f in these rows
  // What explains the errors, as steps that apply together, and the error that they leave. Empty:
  // no combination leaves a tenth of the error.
  std::vector<std::string> explanation{};
  double explained_rms = 0, explained_largest = 0;
  std::vector<RankedHypothesis> also{};      // single ones that explain as much
  std::vector<RankedHypothesis> mistakes{};  // the nearest single ones, the best first
  // All rules and the nearest options likewise, among them those that the material has.
  std::vector<RankedHypothesis> choices{};
  // The factors of nacre's lobes that come nearest, and the error that they leave.
  std::vector<LobeFactor> fit{};
  double fit_rms = 0;
  std::vector<std::string> notes{};
};

inline constexpr size_t kDiagnosedRows = 2000;

// `file` is the table's name in messages. Throws Error (kBadInput) as EvaluatedOf does. on_progress
// gets the finished fraction; it may throw to stop.
TableCheck CheckTable(const Material& material, const BrdfTable& theirs, const std::string& file,
                      double tolerance, const std::function<void(double)>& on_progress = {});

// The page that `nacre table --check` prints.
std::string PageOf(const TableCheck& check);

// The same for programs.
Json CheckJson(const TableCheck& check);

}  // namespace nacre
