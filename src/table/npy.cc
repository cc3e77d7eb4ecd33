// SPDX-License-Identifier: Apache-2.0
#include "table/npy.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cstdint>

#include <fmt/format.h>

#include "base/error.h"
#include "base/excerpt.h"
#include "scene_io/npy_file.h"
#include "scene_io/stored_number.h"

namespace nacre {
namespace {

constexpr std::string_view kMagic("\x93NUMPY", 6);
constexpr char kNpyHint[] = "numpy.save writes such files";

[[noreturn]] void Refuse(const std::string& file, const std::string& what,
                         const std::string& hint = kNpyHint) {
  throw Error(ExitCode::kBadInput, file, what, hint);
}

// One number as it lies in the file.
struct NumberForm {
  char kind = 'f';  // 'f', 'i', 'u' or 'b' (bool)
  size_t size = 8;
  bool swapped = false;  // its bytes are in the other order than this machine's
};

struct NpyField {
  std::string name;
  NumberForm form;
  size_t count = 1;
};

struct NpyHeader {
  std::vector<NpyField> fields;  // of an array without names, one without a name
  bool fortran_order = false;
  std::vector<size_t> shape;
};

// Reads the literal of Python that is an .npy file's header: a dict with three keys.
class HeaderParser {
 public:
  HeaderParser(std::string_view text, const std::string& file) : text_(text), file_(file) {}

  NpyHeader Parse() {
    NpyHeader header;
    bool has_descr = false, has_shape = false;
    Expect('{');
    while (!Takes('}')) {
      const std::string key = String();
      Expect(':');
      if (key == "descr") {
        header.fields = Descr();
        has_descr = true;
      } else if (key == "fortran_order") {
        header.fortran_order = Bool();
      } else if (key == "shape") {
        header.shape = Shape();
        has_shape = true;
      } else {
        Fail();
      }
      if (!Takes(',')) {
        Expect('}');
        break;
      }
    }
    if (!has_descr || !has_shape) Fail();
    return header;
  }

 private:
  [[noreturn]] void Fail() const {
    Refuse(file_, "has a header that is none of an .npy file: " + Excerpt(text_, 120));
  }
  void SkipBlanks() {
    while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\n')) ++at_;
  }
  bool Takes(char c) {
    SkipBlanks();
    if (at_ >= text_.size() || text_[at_] != c) return false;
    ++at_;
    return true;
  }
  void Expect(char c) {
    if (!Takes(c)) Fail();
  }
  bool TakesWord(std::string_view word) {
    SkipBlanks();
    if (text_.substr(at_, word.size()) != word) return false;
    at_ += word.size();
    return true;
  }
  bool Bool() {
    if (TakesWord("True")) return true;
    if (TakesWord("False")) return false;
    Fail();
  }
  std::string String() {
    SkipBlanks();
    if (at_ >= text_.size() || (text_[at_] != '\'' && text_[at_] != '"')) Fail();
    const char quote = text_[at_++];
    const size_t end = text_.find(quote, at_);
    if (end == std::string_view::npos) Fail();
    const std::string value(text_.substr(at_, end - at_));
    if (value.find('\\') != std::string::npos) Fail();
    at_ = end + 1;
    return value;
  }
  size_t Whole() {
    SkipBlanks();
    size_t value = 0;
    const char* const begin = text_.data() + at_;
    const auto [end, error] = std::from_chars(begin, text_.data() + text_.size(), value);
    if (error != std::errc() || end == begin) Fail();
    at_ += static_cast<size_t>(end - begin);
    return value;
  }
  std::vector<size_t> Shape() {
    std::vector<size_t> shape;
    Expect('(');
    while (!Takes(')')) {
      shape.push_back(Whole());
      if (shape.size() > 4) Fail();
      if (!Takes(',')) {
        Expect(')');
        break;
      }
    }
    return shape;
  }
  NumberForm Form() {
    const std::string text = String();
    if (text.find('O') != std::string::npos) {
      Refuse(file_, "holds pickled objects, which are not read: they may run code",
             "save numbers: array.astype(float)");
    }
    NumberForm form;
    const std::string_view order = "<>|=";
    if (text.size() < 3 || order.find(text[0]) == std::string_view::npos) FailForm(text);
    const bool is_big = text[0] == '>';
    form.kind = text[1];
    const std::string_view size = std::string_view(text).substr(2);
    for (const char digit : size) {
      if (digit < '0' || digit > '9') FailForm(text);
    }
    form.size = size == "1" ? 1 : size == "2" ? 2 : size == "4" ? 4 : size == "8" ? 8 : 0;
    const bool is_float = form.kind == 'f' && form.size >= 4;
    const bool is_whole = (form.kind == 'i' || form.kind == 'u') && form.size > 0;
    const bool is_bool = form.kind == 'b' && form.size == 1;
    if (!is_float && !is_whole && !is_bool) FailForm(text);
    form.swapped = is_big;
    return form;
  }
  [[noreturn]] void FailForm(const std::string& text) const {
    Refuse(file_, fmt::format("holds elements of type \"{}\", not numbers", Excerpt(text, 20)),
           "save float64 or float32");
  }
  std::vector<NpyField> Descr() {
    SkipBlanks();
    if (at_ < text_.size() && text_[at_] != '[') return {{"", Form(), 1}};
    std::vector<NpyField> fields;
    Expect('[');
    while (!Takes(']')) {
      NpyField field;
      Expect('(');
      field.name = String();
      Expect(',');
      SkipBlanks();
      if (at_ < text_.size() && text_[at_] == '[') {
        Refuse(file_, "has columns that have columns themselves", "save plain columns");
      }
      field.form = Form();
      if (Takes(',')) {
        SkipBlanks();
        if (at_ < text_.size() && text_[at_] == '(') {
          for (const size_t count : Shape()) {
            if (count > 64 || field.count > 64) Fail();
            field.count *= count;
          }
        }
      }
      Expect(')');
      fields.push_back(field);
      if (fields.size() > 4096) Fail();
      if (!Takes(',')) {
        Expect(']');
        break;
      }
    }
    return fields;
  }

  std::string_view text_;
  const std::string& file_;
  size_t at_ = 0;
};

double NumberAt(const char* at, const NumberForm& form) {
  const bool swap = form.swapped;
  if (form.kind == 'f') return form.size == 8 ? LoadAs<double>(at, swap) : LoadAs<float>(at, swap);
  if (form.kind == 'i') {
    switch (form.size) {
      case 1:
        return LoadAs<int8_t>(at, swap);
      case 2:
        return LoadAs<int16_t>(at, swap);
      case 4:
        return LoadAs<int32_t>(at, swap);
      default:
        return LoadAs<int64_t>(at, swap);
    }
  }
  switch (form.size) {
    case 1:
      return LoadAs<uint8_t>(at, swap);
    case 2:
      return LoadAs<uint16_t>(at, swap);
    case 4:
      return LoadAs<uint32_t>(at, swap);
    default:
      return LoadAs<uint64_t>(at, swap);
  }
}

}  // namespace

std::string NpyBytes(std::span<const std::string> columns, std::span<const double> values) {
  std::string descr;
  for (const std::string& column : columns) descr += fmt::format("('{}', '<f8'), ", column);
  const size_t rows = columns.empty() ? 0 : values.size() / columns.size();
  std::string header =
      fmt::format("{{'descr': [{}], 'fortran_order': False, 'shape': ({},), }}", descr, rows);
  // The numbers begin at a multiple of 64 bytes. Version 1.0 has 16 bits for the header's length.
  const bool is_long = header.size() + 80 > 0xffff;
  const size_t before = kMagic.size() + (is_long ? 6 : 4);
  header.resize((before + header.size() + 1 + 63) / 64 * 64 - before, ' ');
  header.back() = '\n';
  std::string bytes(kMagic);
  bytes += is_long ? std::string("\2\0", 2) : std::string("\1\0", 2);
  for (size_t i = 0; i < (is_long ? 4u : 2u); ++i) {
    bytes += static_cast<char>(header.size() >> (8 * i) & 0xff);
  }
  bytes += header;
  for (const double value : values) {
    const auto bits = std::bit_cast<uint64_t>(value);
    for (int i = 0; i < 8; ++i) bytes += static_cast<char>(bits >> (8 * i) & 0xff);
  }
  return bytes;
}

NpyTable ParseNpy(std::string_view bytes, const std::string& file, size_t max_rows,
                  size_t max_columns) {
  size_t offset = 0;
  if (bytes.starts_with("PK")) {
    Refuse(file, "is an .npz archive", "numpy.save writes a single array as .npy");
  }
  const std::string_view text = NpyHeaderText(bytes, file, kNpyHint, &offset);
  const NpyHeader header = HeaderParser(text, file).Parse();
  const std::string_view data = bytes.substr(offset);

  const bool is_named = !(header.fields.size() == 1 && header.fields[0].name.empty());
  NpyTable table;
  size_t row_bytes = 0;
  for (const NpyField& field : header.fields) {
    row_bytes += field.form.size * field.count;
    table.width += field.count;
    for (size_t i = 0; is_named && i < field.count; ++i) {
      table.columns.push_back(field.count == 1 ? field.name : fmt::format("{}_{}", field.name, i));
    }
  }
  const bool right_axes = header.shape.size() == (is_named ? 1u : 2u) && table.width > 0;
  if (!right_axes) {
    Refuse(file, fmt::format("has {} axes", header.shape.size()),
           "a row for each pair of directions: two axes, or one with named columns");
  }
  const size_t rows = header.shape[0];
  if (!is_named) {
    table.width = header.shape[1];
    row_bytes = std::min(table.width, max_columns + 1) * header.fields[0].form.size;
  }
  if (table.width > max_columns || table.width == 0) {
    Refuse(file, fmt::format("has {} columns", table.width),
           fmt::format("from 1 to {} are read", max_columns));
  }
  if (rows > max_rows) {
    Refuse(file, fmt::format("has {} rows", rows), fmt::format("up to {} are read", max_rows));
  }
  if (data.size() != rows * row_bytes) {
    Refuse(file,
           fmt::format("has {} bytes of numbers, but its header tells {}", data.size(),
                       rows * row_bytes),
           "is it a part of the file?");
  }
  table.values.reserve(rows * table.width);
  if (is_named) {
    const char* at = data.data();
    for (size_t row = 0; row < rows; ++row) {
      for (const NpyField& field : header.fields) {
        for (size_t i = 0; i < field.count; ++i, at += field.form.size) {
          table.values.push_back(NumberAt(at, field.form));
        }
      }
    }
    return table;
  }
  const NumberForm& form = header.fields[0].form;
  for (size_t row = 0; row < rows; ++row) {
    for (size_t column = 0; column < table.width; ++column) {
      const size_t index = header.fortran_order ? column * rows + row : row * table.width + column;
      table.values.push_back(NumberAt(data.data() + index * form.size, form));
    }
  }
  return table;
}

}  // namespace nacre
