// SPDX-License-Identifier: Apache-2.0
#include "scene_io/sphere_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "base/error.h"
#include "base/excerpt.h"
#include "base/numbers.h"
#include "base/path.h"
#include "scene/limits.h"
#include "scene_io/model_files.h"
#include "scene_io/npy_file.h"
#include "scene_io/text_file.h"
#include "scene_io/text_lines.h"

namespace nacre {
namespace {

constexpr uint64_t kMaxSphereFileBytes = uint64_t{4} << 30;

// Collects spheres and refuses invalid rows. In an error's location, `row_word` stands between the
// file's name and the number of the row: "cloud.csv:17", "cloud.npy: row 16".
class SphereRows {
 public:
  SphereRows(const SphereRowSettings& settings, SceneBudget* budget, std::string file,
             const char* row_word)
      : settings_(settings), budget_(budget), file_(std::move(file)), row_word_(row_word) {}

  [[noreturn]] void Refuse(std::string what, std::string hint) const {
    throw Error(ExitCode::kBadInput, file_, std::move(what), std::move(hint));
  }
  [[noreturn]] void RefuseRow(uint64_t row, std::string what, std::string hint = {}) const {
    throw Error(ExitCode::kBadInput, file_ + row_word_ + std::to_string(row), std::move(what),
                std::move(hint));
  }

  // What the file lacks, the scene must specify.
  void CheckColumns(bool has_radii, bool has_materials) const {
    if (!has_radii && !settings_.radius) {
      Refuse("has no radii", "give the shape a \"radius\", or the file a column of that name");
    }
    if (!has_materials && !settings_.material.valid()) {
      Refuse("has no materials",
             "give the shape a \"material\", or the file a column of that name");
    }
  }

  // To be called with the number of rows, or of some of them, before they are added.
  void Announce(uint64_t rows) { budget_->Spend(rows); }
  void Reserve(uint64_t rows) {
    Announce(rows);
    spheres_.reserve(rows);
  }

  double RadiusOf(uint64_t row) const {
    if (!settings_.radius) RefuseRow(row, "has no radius", "the shape has none either");
    return *settings_.radius;
  }

  MaterialId MaterialOf(uint64_t row) const {
    if (!settings_.material.valid()) {
      RefuseRow(row, "has no material", "the shape has none either");
    }
    return settings_.material;
  }

  MaterialId MaterialOfNumber(double number, uint64_t row) const {
    const size_t count = settings_.materials.size();
    if (count == 0) {
      Refuse("has materials by number", "give the shape \"materials\", the list that they are of");
    }
    if (!(number >= 0) || number != std::floor(number) || number >= static_cast<double>(count)) {
      RefuseRow(row, fmt::format("has material {}", number),
                fmt::format("\"materials\" has {}, counted from 0", count));
    }
    return settings_.materials[static_cast<size_t>(number)];
  }

  MaterialId MaterialOfName(std::string_view name, uint64_t row) {
    if (last_material_.valid() && name == last_name_) return last_material_;
    last_name_ = name;
    const auto found = settings_.by_name->find(last_name_);
    if (found == settings_.by_name->end()) {
      std::vector<std::string> names;
      for (const auto& [known, id] : *settings_.by_name) names.push_back(known);
      std::sort(names.begin(), names.end());
      RefuseRow(row, fmt::format("unknown material \"{}\"", Excerpt(name)),
                NearestHint(last_name_, names, "the name of one in the scene's \"materials\""));
    }
    last_material_ = found->second;
    return last_material_;
  }

  void Add(const Vec3d& center, double radius, MaterialId material, uint64_t row) {
    if (!limits::kCoordinate.Contains(center)) {
      RefuseRow(row, fmt::format("[{}, {}, {}] is out of range", center.x, center.y, center.z),
                "each coordinate " + Describe(limits::kCoordinate));
    }
    if (!limits::kLength.Contains(radius)) {
      RefuseRow(row, fmt::format("the radius {} is out of range", radius),
                "a length " + Describe(limits::kLength));
    }
    spheres_.push_back({center, radius, material});
  }

  std::vector<Sphere> Take() {
    if (spheres_.empty()) Refuse("has no rows", "one for each sphere");
    return std::move(spheres_);
  }

 private:
  const SphereRowSettings& settings_;
  SceneBudget* budget_;
  std::string file_;
  const char* row_word_;
  std::string last_name_;     // rows of one material
  MaterialId last_material_;  // often come in a row
  std::vector<Sphere> spheres_;
};

// The indices of a table's columns x, y, z, radius and material; kNone for missing ones.
using TableColumns = std::array<size_t, 5>;
constexpr size_t kRadius = 3, kMaterial = 4;  // indices into TableColumns
constexpr size_t kNone = static_cast<size_t>(-1);

TableColumns ColumnsInOrder(size_t count) {
  TableColumns columns;
  for (size_t i = 0; i < columns.size(); ++i) columns[i] = i < count ? i : kNone;
  return columns;
}

// Reads a table as text. Ignores blanks around cells, empty lines and lines that begin with #.
class CsvReader {
 public:
  CsvReader(std::string_view text, SphereRows* rows) : text_(text), rows_(*rows) {}

  void Read() {
    if (!NextRow()) return;
    // The first row tells the number of columns. It may hold their names.
    const size_t count = cells_.size();
    const bool has_names = !ParseNumber(cells_[0]);
    columns_ = has_names ? ColumnsByName() : ColumnsInOrder(count);
    if (!has_names && (count < 3 || count > 5)) {
      rows_.RefuseRow(line_, fmt::format("has {} columns", count),
                      "x, y, z, radius and material; or begin with a row of names");
    }
    rows_.CheckColumns(columns_[kRadius] != kNone, columns_[kMaterial] != kNone);
    if (!has_names) AddRow();
    while (NextRow()) {
      if (cells_.size() != count) {
        rows_.RefuseRow(line_, fmt::format("has {} columns", cells_.size()),
                        fmt::format("the first row has {}", count));
      }
      AddRow();
    }
  }

 private:
  // Splits the next row into cells_. Returns false at the end.
  bool NextRow() {
    while (!text_.empty()) {
      const std::string_view line = text_.substr(0, text_.find('\n'));
      text_.remove_prefix(std::min(line.size() + 1, text_.size()));
      ++line_;
      std::string_view rest = line;
      const std::string_view word = NextWord(&rest);
      if (word.empty() || word[0] == '#') continue;
      Split(line);
      return true;
    }
    return false;
  }

  void Split(std::string_view line) {
    if (separator_ == '\0') {  // the first row decides for all
      const size_t place = line.find_first_of(",;\t");
      separator_ = place == std::string_view::npos ? ' ' : line[place];
    }
    cells_.clear();
    if (separator_ == ' ') {
      for (std::string_view word = NextWord(&line); !word.empty(); word = NextWord(&line)) {
        AddCell(word);
      }
      return;
    }
    for (;;) {
      const size_t end = line.find(separator_);
      AddCell(Trimmed(line.substr(0, end)));
      if (end == std::string_view::npos) return;
      line.remove_prefix(end + 1);
    }
  }

  void AddCell(std::string_view cell) {
    constexpr size_t kMaxColumns = 1000;
    if (cells_.size() == kMaxColumns) {
      rows_.RefuseRow(line_, fmt::format("has more than {} columns", kMaxColumns));
    }
    cells_.push_back(cell);
  }

  TableColumns ColumnsByName() const {
    constexpr std::array<std::string_view, 5> kNames = {"x", "y", "z", "radius", "material"};
    TableColumns places;
    places.fill(kNone);
    std::vector<std::pair<std::string, size_t>> others;
    for (size_t i = 0; i < cells_.size(); ++i) {
      std::string name = LowerCase(cells_[i]);
      const auto found = std::find(kNames.begin(), kNames.end(), name);
      if (found == kNames.end()) {
        others.emplace_back(std::move(name), i);
        continue;
      }
      size_t& place = places[static_cast<size_t>(found - kNames.begin())];
      if (place != kNone) {
        rows_.RefuseRow(line_, fmt::format("names two columns \"{}\"", name));
      }
      place = i;
    }
    RefuseMistyped(others, {kNames.begin(), kNames.end()}, places);
    for (size_t i = 0; i < 3; ++i) {
      if (places[i] != kNone) continue;
      rows_.RefuseRow(line_, fmt::format("names no column \"{}\"", kNames[i]),
                      "the first row is names, or numbers: x, y, z, radius, material");
    }
    return places;
  }

  // Ignores columns with unknown names, but refuses one that looks like the name of a missing
  // column.
  void RefuseMistyped(const std::vector<std::pair<std::string, size_t>>& others,
                      const std::vector<std::string>& names, const TableColumns& places) const {
    std::vector<std::string> missing;
    for (size_t i = 0; i < names.size(); ++i) {
      if (places[i] == kNone) missing.push_back(names[i]);
    }
    for (const auto& [name, cell] : others) {
      const std::string nearest = NearestName(name, missing);
      if (nearest.empty()) continue;
      rows_.RefuseRow(line_, fmt::format("unknown column \"{}\"", Excerpt(cells_[cell])),
                      fmt::format("did you mean \"{}\"?", nearest));
    }
  }

  double Number(size_t column) const {
    const std::optional<double> number = ParseNumber(cells_[column]);
    if (!number) {
      rows_.RefuseRow(line_, fmt::format("\"{}\" is not a number", Excerpt(cells_[column], 40)));
    }
    return *number;
  }

  bool Says(size_t column) const { return column != kNone && !cells_[column].empty(); }

  void AddRow() {
    rows_.Announce(1);
    const Vec3d center(Number(columns_[0]), Number(columns_[1]), Number(columns_[2]));
    const double radius =
        Says(columns_[kRadius]) ? Number(columns_[kRadius]) : rows_.RadiusOf(line_);
    rows_.Add(center, radius, Material(), line_);
  }

  MaterialId Material() {
    if (!Says(columns_[kMaterial])) return rows_.MaterialOf(line_);
    const std::string_view cell = cells_[columns_[kMaterial]];
    const std::optional<double> number = ParseNumber(cell);
    return number ? rows_.MaterialOfNumber(*number, line_) : rows_.MaterialOfName(cell, line_);
  }

  std::string_view text_;
  SphereRows& rows_;
  size_t line_ = 0;
  char separator_ = '\0';
  std::vector<std::string_view> cells_;
  TableColumns columns_{};
};

// Adds `count` rows of numbers: at(row, column), the columns in the order of ColumnsInOrder.
template <class At>
void AddNumbers(uint64_t count, bool has_radii, bool has_materials, const At& at,
                SphereRows* rows) {
  rows->CheckColumns(has_radii, has_materials);
  rows->Reserve(count);
  for (uint64_t row = 0; row < count; ++row) {
    const Vec3d center(at(row, 0), at(row, 1), at(row, 2));
    const double radius = has_radii ? at(row, 3) : rows->RadiusOf(row);
    const MaterialId material =
        has_materials ? rows->MaterialOfNumber(at(row, 4), row) : rows->MaterialOf(row);
    rows->Add(center, radius, material, row);
  }
}

}  // namespace

std::vector<Sphere> ReadSphereFile(const std::filesystem::path& path,
                                   const SphereRowSettings& settings, SceneBudget* budget) {
  const std::string file = path.string();
  if (HasExtension(file, ".ply")) {
    SphereRows rows(settings, budget, file, ": vertex ");
    const PlyPoints points = ReadPlyPoints(path);
    const auto at = [&](uint64_t row, int column) {
      return column < 3    ? points.positions[row][column]
             : column == 3 ? points.radii[row]
                           : points.materials[row];
    };
    AddNumbers(points.positions.size(), !points.radii.empty(), !points.materials.empty(), at,
               &rows);
    return rows.Take();
  }
  if (HasExtension(file, ".npy")) {
    SphereRows rows(settings, budget, file, ": row ");
    const std::string bytes = ReadBytes(path, kMaxSphereFileBytes);
    const NpyMatrix matrix(bytes, file);
    const auto at = [&](uint64_t row, uint64_t column) { return matrix.At(row, column); };
    AddNumbers(matrix.rows(), matrix.columns() > 3, matrix.columns() > 4, at, &rows);
    return rows.Take();
  }
  if (HasExtension(file, ".csv")) {
    SphereRows rows(settings, budget, file, ":");
    const std::string text = ReadTextFile(path, kMaxSphereFileBytes);
    CsvReader(WithoutByteOrderMark(text, file), &rows).Read();
    return rows.Take();
  }
  throw Error(ExitCode::kBadInput, file, "is no table of spheres", "a .ply, .csv or .npy file");
}

}  // namespace nacre
