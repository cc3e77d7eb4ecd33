// SPDX-License-Identifier: Apache-2.0
#include "table/read_table.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/error.h"
#include "base/excerpt.h"
#include "base/input_file.h"
#include "base/numbers.h"
#include "base/path.h"
#include "scene/fault_list.h"
#include "scene_io/text_file.h"
#include "scene_io/text_lines.h"
#include "table/npy.h"

namespace nacre {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// A number, or what programs print for those that are not finite.
std::optional<double> ParseCell(std::string_view word) {
  if (const std::optional<double> number = ParseNumber(word)) return number;
  if (!IsNoNumber(word)) return std::nullopt;
  if (LowerCase(word).find("inf") == std::string::npos) return kNan;
  return word.starts_with('-') ? -HUGE_VAL : HUGE_VAL;
}

// ---- CSV ----------------------------------------------------------------------------------------

char SeparatorOf(std::string_view line) {
  for (const char separator : {',', ';', '\t'}) {
    if (line.find(separator) != std::string_view::npos) return separator;
  }
  return ' ';
}

std::vector<std::string_view> CellsOf(std::string_view line, char separator) {
  std::vector<std::string_view> cells;
  if (separator == ' ') {
    for (std::string_view word = NextWord(&line); !word.empty(); word = NextWord(&line)) {
      cells.push_back(Trimmed(word));
    }
    return cells;
  }
  for (size_t at = 0; at <= line.size();) {
    const size_t end = std::min(line.find(separator, at), line.size());
    cells.push_back(Trimmed(line.substr(at, end - at)));
    at = end + 1;
  }
  return cells;
}

// "# NAME: JSON" of nacre's own header. Other comments are nobody's.
void ReadComment(std::string_view line, Json* header) {
  line.remove_prefix(line.find('#') + 1);
  line.remove_prefix(std::min(line.find_first_not_of(' '), line.size()));
  const size_t colon = line.find(": ");
  if (colon == std::string_view::npos || colon > 64) return;
  const std::string_view key = line.substr(0, colon);
  if (key != "nacre_table" && key != "material" && key != "nacre") return;
  if (const std::optional<Json> value = TryParseJson(line.substr(colon + 2))) {
    (*header)[std::string(key)] = *value;
  }
}

class CsvReader {
 public:
  explicit CsvReader(const std::string& file) : file_(file) { table_.places_are_lines = true; }

  BrdfTable Read(std::string_view text) {
    text = WithoutByteOrderMark(text, file_);
    size_t number = 0;
    for (size_t at = 0; at < text.size();) {
      const size_t end = std::min(text.find('\n', at), text.size());
      ++number;
      Line(text.substr(at, end - at), number);
      at = end + 1;
    }
    if (!has_header_) {
      throw Error(ExitCode::kBadInput, file_, "has no columns",
                  "the first line names them: light_x,light_y,light_z,view_x,...");
    }
    ThrowFaults(faults_, file_);
    return std::move(table_);
  }

 private:
  void Line(std::string_view line, size_t number) {
    std::string_view rest = line;
    const std::string_view word = NextWord(&rest);
    if (word.empty()) return;
    if (word[0] == '#') return ReadComment(line, &table_.header);
    if (!has_header_) {
      separator_ = SeparatorOf(line);
      has_header_ = true;
      const std::vector<std::string_view> cells = CellsOf(line, separator_);
      if (cells.size() > kMostTableColumns) {
        throw Error(ExitCode::kBadInput, file_, fmt::format("has {} columns", cells.size()),
                    fmt::format("up to {} are read", kMostTableColumns));
      }
      const bool is_row = std::all_of(cells.begin(), cells.end(), [](std::string_view cell) {
        return ParseCell(cell).has_value();
      });
      if (!is_row) {
        table_.columns.assign(cells.begin(), cells.end());
        return;
      }
      table_.columns.assign(cells.size(), "");
    }
    Row(line, number);
  }

  void Row(std::string_view line, size_t number) {
    if (table_.places.size() >= kMostTableRows) {
      throw Error(ExitCode::kBadInput, file_, fmt::format("has more than {} rows", kMostTableRows),
                  "a part of them says as much");
    }
    const std::vector<std::string_view> cells = CellsOf(line, separator_);
    if (cells.size() != table_.columns.size()) {
      faults_.Add("",
                  fmt::format("line {} has {} values, where the first one has {}", number,
                              cells.size(), table_.columns.size()),
                  "a row has a value for each column");
      return;
    }
    for (const std::string_view cell : cells) {
      const std::optional<double> value = ParseCell(cell);
      if (!value) {
        faults_.Add("", fmt::format("line {}: \"{}\" is not a number", number, Excerpt(cell, 40)));
        table_.values.resize(table_.places.size() * table_.columns.size());
        return;
      }
      table_.values.push_back(*value);
    }
    table_.places.push_back(number);
  }

  std::string file_;
  BrdfTable table_;
  FaultList faults_;
  bool has_header_ = false;
  char separator_ = ',';
};

// ---- JSON ---------------------------------------------------------------------------------------

// JSON has no NaN; Python writes it nevertheless.
std::string WithoutNan(const std::string& text) {
  std::string without;
  without.reserve(text.size() + text.size() / 8);
  bool in_string = false;
  for (size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '"') in_string = !in_string;
    if (in_string && c == '\\' && i + 1 < text.size()) without += text[i++];
    size_t length = 0;
    if (!in_string && (c == '-' || c == 'N' || c == 'I')) {
      for (const std::string_view word : {"NaN", "-NaN", "Infinity", "-Infinity"}) {
        if (text.compare(i, word.size(), word) == 0) length = word.size();
      }
    }
    if (length == 0) {
      without += text[i];
    } else {
      without += "null";
      i += length - 1;
    }
  }
  return without;
}

class JsonTableReader {
 public:
  explicit JsonTableReader(const std::string& file) : file_(file) {}

  BrdfTable Read(const std::string& text) {
    FaultList faults;
    const Json json = ParseJson(text, file_, &faults);
    ThrowFaults(faults, file_);
    if (json.is_array()) {
      Records(json);
    } else if (json.is_object() && json.contains("columns") && json.contains("rows")) {
      Rows(json);
    } else if (json.is_object()) {
      Arrays(json);
    } else {
      Fail("", "is no table");
    }
    return std::move(table_);
  }

 private:
  [[noreturn]] void Fail(const std::string& pointer, const std::string& what) const {
    throw Error(ExitCode::kBadInput, PlaceInFile(file_, pointer), what,
                R"(a table is {"columns": ["light_x", ...], "rows": [[0.1, ...], ...]})");
  }
  double Number(const Json& value, const std::string& pointer) const {
    if (value.is_null()) return kNan;
    if (!value.is_number()) Fail(pointer, "is not a number");
    return value.get<double>();
  }
  void CheckCount(size_t rows, const std::string& pointer) const {
    if (rows <= kMostTableRows) return;
    Fail(pointer, fmt::format("has {} rows, more than {}", rows, kMostTableRows));
  }
  void CheckColumns() const {
    if (table_.columns.size() <= kMostTableColumns) return;
    Fail("", fmt::format("has more than {} columns", kMostTableColumns));
  }

  void Rows(const Json& json) {
    if (const auto header = json.find("header"); header != json.end() && header->is_object()) {
      table_.header = *header;
    }
    const Json &columns = json["columns"], &rows = json["rows"];
    if (!columns.is_array()) Fail("/columns", "is not a list");
    for (const Json& name : columns) {
      if (!name.is_string()) Fail("/columns", "has a name that is not a text");
      table_.columns.push_back(name.get<std::string>());
    }
    CheckColumns();
    if (!rows.is_array()) Fail("/rows", "is not a list");
    CheckCount(rows.size(), "/rows");
    for (size_t i = 0; i < rows.size(); ++i) {
      const std::string pointer = fmt::format("/rows/{}", i);
      if (!rows[i].is_array() || rows[i].size() != table_.columns.size()) {
        Fail(pointer, fmt::format("is not a list of {} numbers", table_.columns.size()));
      }
      for (size_t k = 0; k < rows[i].size(); ++k) {
        table_.values.push_back(Number(rows[i][k], fmt::format("{}/{}", pointer, k)));
      }
    }
  }

  // Adds the names that a value has: its own, or NAME_0, NAME_1, ... for a list. Returns how many.
  void AddNames(const std::string& name, const Json& value) {
    if (!value.is_array()) return table_.columns.push_back(name);
    for (size_t i = 0; i < value.size(); ++i)
      table_.columns.push_back(fmt::format("{}_{}", name, i));
    CheckColumns();
  }
  void AddValues(const Json& value, const std::string& pointer) {
    if (!value.is_array()) return table_.values.push_back(Number(value, pointer));
    for (size_t i = 0; i < value.size(); ++i) {
      table_.values.push_back(Number(value[i], fmt::format("{}/{}", pointer, i)));
    }
  }

  // {"light": [[x, y, z], ...], "f": [1, ...]}; other members are left out.
  void Arrays(const Json& json) {
    std::vector<std::string> names;
    std::optional<size_t> rows;
    for (const auto& [name, list] : json.items()) {
      if (!list.is_array()) continue;
      if (rows && list.size() != *rows) {
        Fail("/" + PointerToken(name),
             fmt::format("has {} elements, and \"{}\" {}", list.size(), names[0], *rows));
      }
      rows = list.size();
      names.push_back(name);
    }
    if (!rows) Fail("", "has no lists of numbers");
    CheckCount(*rows, "");
    for (const std::string& name : names) {
      if (*rows > 0) AddNames(name, json[name][0]);
    }
    CheckColumns();
    for (size_t i = 0; i < *rows; ++i) {
      for (const std::string& name : names) {
        const std::string pointer = fmt::format("/{}/{}", PointerToken(name), i);
        CheckShape(json[name][i], json[name][0], pointer);
        AddValues(json[name][i], pointer);
      }
    }
  }

  // [{"light": [x, y, z], "f": 1}, ...]
  void Records(const Json& json) {
    CheckCount(json.size(), "");
    for (size_t i = 0; i < json.size(); ++i) {
      const std::string pointer = fmt::format("/{}", i);
      if (!json[i].is_object()) Fail(pointer, "is not an object");
      if (i == 0) {
        for (const auto& [name, value] : json[i].items()) AddNames(name, value);
        CheckColumns();
      }
      for (const auto& [name, value] : json[0].items()) {
        const auto found = json[i].find(name);
        if (found == json[i].end()) Fail(pointer, fmt::format("has no \"{}\"", Excerpt(name)));
        CheckShape(*found, value, pointer + "/" + PointerToken(name));
        AddValues(*found, pointer + "/" + PointerToken(name));
      }
    }
  }

  void CheckShape(const Json& value, const Json& first, const std::string& pointer) const {
    const size_t size = value.is_array() ? value.size() : 0;
    const size_t wanted = first.is_array() ? first.size() : 0;
    if (size != wanted) Fail(pointer, "has another number of elements than the first one");
  }

  std::string file_;
  BrdfTable table_;
};

BrdfTable FromNpy(const std::string& path) {
  const NpyTable npy =
      ParseNpy(ReadBytes(path, kMostTableBytes), path, kMostTableRows, kMostTableColumns);
  BrdfTable table{.columns = npy.columns, .values = npy.values};
  if (table.columns.empty()) table.columns.assign(npy.width, "");
  return table;
}

// ---- Columns ------------------------------------------------------------------------------------

// "L.x" as "l_x".
std::string Plain(std::string_view name) {
  std::string plain;
  for (const char c : LowerCase(name)) {
    const bool is_word = (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9');
    if (is_word)
      plain += c;
    else if (!plain.empty() && plain.back() != '_')
      plain += '_';
  }
  while (!plain.empty() && plain.back() == '_') plain.pop_back();
  return plain;
}

using Suffixes = std::array<std::vector<std::string>, 3>;
const Suffixes kAxes = {{{"x", "0"}, {"y", "1"}, {"z", "2"}}};
const Suffixes kChannels = {{{"r", "red", "0"}, {"g", "green", "1"}, {"b", "blue", "2"}}};

// What a column is called by others.
std::vector<std::string> NamesOfVector(std::string_view what, std::string_view letter) {
  std::vector<std::string> names;
  for (const char* form : {"{}", "to_{}", "to{}", "{}_dir", "{}dir", "{}_direction", "{}_vector"}) {
    names.push_back(fmt::format(fmt::runtime(form), what));
  }
  names.emplace_back(letter);
  return names;
}

// The columns of a table by their meaning.
class Columns {
 public:
  Columns(const BrdfTable& table, const std::string& file, const std::vector<std::string>& own)
      : file_(file) {
    names_ = table.columns;
    const bool nameless = std::all_of(names_.begin(), names_.end(),
                                      [](const std::string& name) { return name.empty(); });
    if (nameless) NameByPlace(own);
    for (size_t i = 0; i < names_.size(); ++i) {
      if (!by_name_.try_emplace(Plain(names_[i]), i).second) {
        throw Error(ExitCode::kBadInput, file,
                    fmt::format("has two columns \"{}\"", Excerpt(names_[i], 40)),
                    "each has a name of its own");
      }
    }
  }

  // The three columns of a vector or a colour, under any of the names.
  std::optional<std::array<size_t, 3>> Find(const std::vector<std::string>& names,
                                            const Suffixes& suffixes) {
    for (const std::string& name : names) {
      std::array<size_t, 3> found{};
      size_t count = 0;
      for (size_t c = 0; c < 3; ++c) {
        for (const std::string& suffix : suffixes[c]) {
          auto at = by_name_.find(name.empty() ? suffix : name + "_" + suffix);
          if (at == by_name_.end()) at = by_name_.find(name + suffix);
          if (at == by_name_.end()) continue;
          found[c] = at->second;
          ++count;
          break;
        }
      }
      if (count != 3) continue;
      used_.insert(found.begin(), found.end());
      return found;
    }
    return std::nullopt;
  }

  // The same, or a single column of a grey.
  std::optional<std::array<size_t, 3>> FindColor(const std::vector<std::string>& names) {
    if (const auto found = Find(names, kChannels)) return found;
    for (const std::string& name : names) {
      if (const auto grey = FindNumber(name)) return std::array<size_t, 3>{*grey, *grey, *grey};
    }
    return std::nullopt;
  }

  std::optional<size_t> FindNumber(const std::string& name) {
    const auto at = name.empty() ? by_name_.end() : by_name_.find(name);
    if (at == by_name_.end()) return std::nullopt;
    used_.insert(at->second);
    return at->second;
  }

  // Throws for what is missing, named as nacre names it.
  [[noreturn]] void Miss(const std::string& what) const {
    std::string hint = fmt::format("its columns are {}", Shortened(Listed(names_), 300));
    for (const auto& [name, index] : by_name_) {
      if (!name.starts_with("wi") && !name.starts_with("wo") && !name.starts_with("omega")) {
        continue;
      }
      hint =
          "wi and wo are light and view in some programs, and view and light in others: name the "
          "columns light_x, ..., view_z";
      break;
    }
    throw Error(ExitCode::kBadInput, file_, "has no columns " + what, hint);
  }

  std::vector<std::string> Unused() const {
    std::vector<std::string> unused;
    for (size_t i = 0; i < names_.size(); ++i) {
      if (!used_.contains(i)) unused.push_back(names_[i]);
    }
    return unused;
  }

  bool named_by_place() const { return named_by_place_; }
  static std::string Listed(const std::vector<std::string>& names) {
    return fmt::format("{}", fmt::join(names, ", "));
  }

 private:
  void NameByPlace(const std::vector<std::string>& own) {
    const size_t count = names_.size();
    // With all that nacre has itself, without the albedo, or with the first ones alone.
    const bool fits = count == own.size() || count + 3 == own.size() || count == 6 || count == 9;
    if (!fits || own.size() < count) {
      throw Error(ExitCode::kBadInput, file_, fmt::format("has {} columns without names", count),
                  own.size() > 6 ? "name them, or give nine: light x, y, z, view x, y, z, f r, g, b"
                                 : "name them, or give six: light x, y, z, view x, y, z");
    }
    named_by_place_ = true;
    names_.assign(own.begin(), own.begin() + static_cast<std::ptrdiff_t>(count));
  }

  const std::string& file_;
  std::vector<std::string> names_;
  std::map<std::string, size_t> by_name_;  // plain names
  std::set<size_t> used_;
  bool named_by_place_ = false;
};

Vec3d VectorAt(const BrdfTable& table, size_t row, const std::array<size_t, 3>& columns) {
  return {table.At(row, columns[0]), table.At(row, columns[1]), table.At(row, columns[2])};
}

std::vector<Rgb> ColorsAt(const BrdfTable& table, const std::array<size_t, 3>& columns) {
  std::vector<Rgb> colors(table.rows());
  for (size_t row = 0; row < colors.size(); ++row) colors[row] = VectorAt(table, row, columns);
  return colors;
}

std::vector<DirectionPair> CheckedDirections(const BrdfTable& table, const std::string& file,
                                             Columns* columns, std::vector<std::string>* notes) {
  const auto light = columns->Find(NamesOfVector("light", "l"), kAxes);
  const auto view = columns->Find(NamesOfVector("view", "v"), kAxes);
  if (!light) columns->Miss("light_x, light_y, light_z");
  if (!view) columns->Miss("view_x, view_y, view_z");
  if (table.rows() == 0) {
    throw Error(ExitCode::kBadInput, file, "has no rows", "a row has a pair of directions");
  }
  std::vector<DirectionPair> pairs(table.rows());
  FaultList faults;
  size_t rounded = 0;
  double most = 0;
  const auto check = [&](size_t row, const char* name, Vec3d v) {
    const double squared = v.length2();
    const double off = std::abs(squared - 1);
    if (!(off <= kRoundedSquaredError)) {
      faults.Add("",
                 fmt::format("{}: {} ({}, {}, {}) {}", PlaceOf(table, row), name, v.x, v.y, v.z,
                             std::isfinite(squared)
                                 ? fmt::format("has length {:.6g}, not 1", std::sqrt(squared))
                                 : std::string("is not finite, or far too long")),
                 "directions are unit vectors that point away from the surface");
      return v;
    }
    if (off <= kUnitSquaredError) return v;
    ++rounded;
    most = std::max(most, off / 2);
    return v / std::sqrt(squared);
  };
  for (size_t row = 0; row < pairs.size(); ++row) {
    pairs[row] = {check(row, "light", VectorAt(table, row, *light)),
                  check(row, "view", VectorAt(table, row, *view))};
  }
  ThrowFaults(faults, file);
  if (rounded > 0 && notes != nullptr) {
    notes->push_back(
        fmt::format("{} directions are rounded: their lengths are off 1 by up to {:.1e}; they are "
                    "normalised, and narrow lobes differ by that",
                    rounded, most));
  }
  return pairs;
}

const std::vector<std::string> kDirectionColumns = {"light_x", "light_y", "light_z",
                                                    "view_x",  "view_y",  "view_z"};

}  // namespace

BrdfTable ReadTable(const std::string& path) {
  CheckInputFile(path);
  if (HasExtension(path, ".npy")) return FromNpy(path);
  if (HasExtension(path, ".json")) {
    return JsonTableReader(path).Read(WithoutNan(ReadTextFile(path, kMostJsonTableBytes)));
  }
  return CsvReader(path).Read(ReadTextFile(path, kMostTableBytes));
}

std::vector<DirectionPair> DirectionsOf(const BrdfTable& table, const std::string& file,
                                        std::vector<std::string>* notes) {
  Columns columns(table, file, kDirectionColumns);
  return CheckedDirections(table, file, &columns, notes);
}

EvaluatedTable EvaluatedOf(const BrdfTable& table, const std::string& file,
                           const std::vector<std::string>& own,
                           const std::vector<std::string>& lobes) {
  Columns columns(table, file, own);
  EvaluatedTable evaluated;
  if (columns.named_by_place()) {
    evaluated.notes.push_back(fmt::format("its columns have no names and are taken for {}",
                                          table.columns.size() == 9
                                              ? "light x, y, z, view x, y, z, f r, g, b"
                                              : "those that nacre writes of this material"));
  }
  evaluated.pairs = CheckedDirections(table, file, &columns, &evaluated.notes);
  const auto f = columns.FindColor({"f", "brdf", "bsdf", "value", "fr", ""});
  if (!f) columns.Miss("f_r, f_g, f_b");
  evaluated.f = ColorsAt(table, *f);
  for (const std::string& lobe : lobes) {
    if (const auto found = columns.FindColor({lobe})) {
      evaluated.lobes[lobe] = ColorsAt(table, *found);
    }
  }
  if (const auto albedo = columns.FindColor({"albedo"})) {
    evaluated.albedo = ColorsAt(table, *albedo);
  }
  if (const auto pdf = columns.FindNumber("pdf")) {
    evaluated.pdf.emplace(table.rows());
    for (size_t row = 0; row < table.rows(); ++row) (*evaluated.pdf)[row] = table.At(row, *pdf);
  }
  const std::vector<std::string> unused = columns.Unused();
  if (!unused.empty()) {
    evaluated.notes.push_back("left out: " + Shortened(Columns::Listed(unused), 300));
  }
  return evaluated;
}

std::string PlaceOf(const BrdfTable& table, size_t row) {
  const size_t place = row < table.places.size() ? table.places[row] : row + 1;
  return fmt::format("{} {}", table.places_are_lines ? "line" : "row", place);
}

}  // namespace nacre
