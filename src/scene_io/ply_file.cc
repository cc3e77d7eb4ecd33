// SPDX-License-Identifier: Apache-2.0
#include "scene_io/ply_file.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "base/error.h"
#include "base/excerpt.h"
#include "base/numbers.h"
#include "scene_io/text_lines.h"

namespace nacre {
namespace {

// Far more than any real file has; names are compared one by one.
constexpr size_t kMaxElements = 64;
constexpr size_t kMaxProperties = 256;

constexpr std::string_view kBlanks = " \t\r\n";

// The two names of each type, in the order of NumberType.
constexpr std::array<std::string_view, 8> kTypeNames = {"char", "uchar", "short", "ushort",
                                                        "int",  "uint",  "float", "double"};
constexpr std::array<std::string_view, 8> kSizedTypeNames = {
    "int8", "uint8", "int16", "uint16", "int32", "uint32", "float32", "float64"};

bool IsReal(NumberType type) { return type == NumberType::kFloat || type == NumberType::kDouble; }

// Whether an integer type holds `value`.
bool Holds(NumberType type, double value) {
  constexpr std::array<double, 6> kMin = {-128, 0, -32768, 0, -2147483648.0, 0};
  constexpr std::array<double, 6> kMax = {127, 255, 32767, 65535, 2147483647.0, 4294967295.0};
  const auto i = static_cast<size_t>(type);
  return value == std::floor(value) && value >= kMin[i] && value <= kMax[i];
}

// Splits the lines of a header into words.
class HeaderReader {
 public:
  HeaderReader(const std::string& bytes, const std::string& file)
      : bytes_(bytes),
        file_(file),
        position_(bytes.size() - WithoutByteOrderMark(bytes, file).size()) {
    // All lines are assumed to end as the first one does.
    const size_t end = bytes_.find_first_of("\r\n", position_);
    const bool is_mac = end < bytes_.size() && bytes_[end] == '\r' && bytes_[end + 1] != '\n';
    line_end_ = is_mac ? '\r' : '\n';
  }

  PlyHeader Read() {
    CheckPlyMagic(bytes_, file_);
    NextLine();
    while (true) {
      const std::vector<std::string_view> words = NextLine();
      if (words.empty() || words[0] == "comment" || words[0] == "obj_info") continue;
      if (words[0] == "end_header") break;
      if (words[0] == "format") {
        ReadFormat(words);
      } else if (words[0] == "element") {
        ReadElement(words);
      } else if (words[0] == "property") {
        ReadProperty(words);
      } else {
        Refuse(fmt::format("unknown keyword \"{}\"", Excerpt(words[0], 40)));
      }
    }
    if (!has_format_) Refuse("the header names no format");
    header_.length = position_;
    CheckCounts();
    return std::move(header_);
  }

 private:
  [[noreturn]] void Refuse(std::string what, std::string hint = {}) const {
    throw Error(ExitCode::kBadInput, fmt::format("{}:{}", file_, line_), std::move(what),
                std::move(hint));
  }

  std::vector<std::string_view> NextLine() {
    ++line_;
    constexpr size_t kMaxLine = 4096;
    const size_t end = bytes_.find(line_end_, position_);
    if (end == std::string::npos || end - position_ > kMaxLine) {
      Refuse(line_ == 1 ? "is not a PLY file" : "the header does not end");
    }
    std::string_view rest = std::string_view(bytes_).substr(position_, end - position_);
    position_ = end + 1;
    std::vector<std::string_view> words;
    while (true) {
      rest.remove_prefix(std::min(rest.find_first_not_of(kBlanks), rest.size()));
      if (rest.empty()) return words;
      const size_t length = std::min(rest.find_first_of(kBlanks), rest.size());
      words.push_back(rest.substr(0, length));
      rest.remove_prefix(length);
    }
  }

  void ReadFormat(const std::vector<std::string_view>& words) {
    constexpr std::array<std::string_view, 3> kFormats = {"ascii", "binary_little_endian",
                                                          "binary_big_endian"};
    const auto format = words.size() == 3 && words[2] == "1.0"
                            ? std::find(kFormats.begin(), kFormats.end(), words[1])
                            : kFormats.end();
    if (format == kFormats.end()) {
      Refuse("unknown format", "ascii, binary_little_endian or binary_big_endian, 1.0");
    }
    header_.format = static_cast<PlyFormat>(format - kFormats.begin());
    has_format_ = true;
  }

  void ReadElement(const std::vector<std::string_view>& words) {
    PlyElement element;
    const std::string_view count = words.size() == 3 ? words[2] : std::string_view();
    const auto [end, error] =
        std::from_chars(count.data(), count.data() + count.size(), element.count);
    if (count.empty() || error != std::errc() || end != count.data() + count.size()) {
      Refuse("not \"element NAME COUNT\"");
    }
    if (header_.elements.size() == kMaxElements) Refuse("too many elements");
    element.name = words[1];
    for (const PlyElement& other : header_.elements) {
      if (other.name == element.name) Refuse("a second element of this name");
    }
    header_.elements.push_back(std::move(element));
  }

  NumberType TypeOf(std::string_view word) const {
    for (const auto& names : {kTypeNames, kSizedTypeNames}) {
      const auto found = std::ranges::find(names, word);
      if (found != names.end()) return static_cast<NumberType>(found - names.begin());
    }
    Refuse(fmt::format("unknown type \"{}\"", Excerpt(word, 40)),
           "char, uchar, short, ushort, int, uint, float or double");
  }

  void ReadProperty(const std::vector<std::string_view>& words) {
    if (header_.elements.empty()) Refuse("a property of no element");
    PlyElement& element = header_.elements.back();
    PlyProperty property;
    property.is_list = words.size() == 5 && words[1] == "list";
    if (property.is_list) {
      property.count_type = TypeOf(words[2]);
      if (IsReal(property.count_type)) Refuse("a list is counted by whole numbers");
    } else if (words.size() != 3) {
      Refuse("not \"property TYPE NAME\" or \"property list TYPE TYPE NAME\"");
    }
    property.type = TypeOf(words[words.size() - 2]);
    property.name = words.back();
    if (element.Find(property.name) != PlyElement::kNone) Refuse("a second property of this name");
    if (element.properties.size() == kMaxProperties) Refuse("too many properties");
    element.properties.push_back(std::move(property));
  }

  // In a text, a number and the blank after it take at least two bytes; the last blank may be
  // missing.
  void CheckCounts() const {
    const size_t rest = bytes_.size() - header_.length + 1;
    for (const PlyElement& element : header_.elements) {
      size_t least = 0;
      for (const PlyProperty& property : element.properties) {
        const NumberType first = property.is_list ? property.count_type : property.type;
        least += header_.format == PlyFormat::kText ? 2 : SizeOf(first);
      }
      if (element.count > 0 && (least == 0 || element.count > rest / least)) {
        throw Error(ExitCode::kBadInput, file_,
                    fmt::format("{} elements \"{}\" are more than the file holds", element.count,
                                Excerpt(element.name)),
                    "the file is damaged or incomplete");
      }
    }
  }

  const std::string& bytes_;
  const std::string& file_;
  size_t position_;
  char line_end_;
  size_t line_ = 0;
  bool has_format_ = false;
  PlyHeader header_;
};

// Parses the names of NaN and the infinities.
std::optional<double> ParseNonFinite(std::string_view word) {
  double number = 0;
  const char* const end = word.data() + word.size();
  const auto read = std::from_chars(word.data(), end, number);
  if (read.ec != std::errc() || read.ptr != end || std::isfinite(number)) return std::nullopt;
  return number;
}

}  // namespace

void CheckPlyMagic(std::string_view head, const std::string& file) {
  std::string_view line = WithoutByteOrderMark(head, file);
  line = line.substr(0, line.find_first_of("\r\n"));
  if (NextWord(&line) == "ply" && NextWord(&line).empty()) return;
  throw Error(ExitCode::kBadInput, file, "is not a PLY file", "its first line is \"ply\"");
}

PlyHeader ReadPlyHeader(const std::string& bytes, const std::string& file) {
  return HeaderReader(bytes, file).Read();
}

void PlyNumbers::Refuse(std::string what) const {
  throw Error(ExitCode::kBadInput, place(), std::move(what), "the file is damaged or incomplete");
}

std::string PlyNumbers::place() const {
  if (format_ != PlyFormat::kText) return file_;
  const auto begin = bytes_.begin(), end = begin + static_cast<ptrdiff_t>(position_);
  // Lines end with LF, CR LF or CR.
  const bool has_lf = bytes_.find('\n') < position_;
  return fmt::format("{}:{}", file_, std::count(begin, end, has_lf ? '\n' : '\r') + 1);
}

std::string_view PlyNumbers::NextWord() {
  const std::string_view text = bytes_;
  const size_t begin = std::min(text.find_first_not_of(kBlanks, position_), text.size());
  position_ = std::min(text.find_first_of(kBlanks, begin), text.size());
  if (begin == position_) Refuse("ends too early");
  return text.substr(begin, position_ - begin);
}

double PlyNumbers::Next(NumberType type) {
  if (format_ != PlyFormat::kText) {
    const size_t size = SizeOf(type);
    if (bytes_.size() - position_ < size) Refuse("ends too early");
    const char* const bytes = bytes_.data() + position_;
    position_ += size;
    return LoadNumber(bytes, type, format_ == PlyFormat::kBigEndian);
  }
  const std::string_view word = NextWord();
  std::optional<double> number = ParseNumber(word);
  // Such a number may be in a property that is not read.
  if (!number && IsReal(type)) number = ParseNonFinite(word);
  if (!number) Refuse(fmt::format("\"{}\" is not a number", Excerpt(word, 40)));
  if (!IsReal(type) && !Holds(type, *number)) {
    Refuse(fmt::format("{} is not a number of its type", *number));
  }
  return *number;
}

size_t PlyNumbers::NextLength(const PlyProperty& list) {
  const double length = Next(list.count_type);
  const size_t least = format_ == PlyFormat::kText ? 2 : SizeOf(list.type);
  const size_t rest = bytes_.size() - position_ + 1;
  if (length < 0 || length > static_cast<double>(rest / least)) {
    Refuse(fmt::format("a list of {} is more than the file holds", length));
  }
  return static_cast<size_t>(length);
}

void PlyNumbers::Skip(const PlyProperty& property) {
  const size_t count = property.is_list ? NextLength(property) : 1;
  for (size_t i = 0; i < count; ++i) Next(property.type);
}

}  // namespace nacre
