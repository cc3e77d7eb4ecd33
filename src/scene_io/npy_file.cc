// SPDX-License-Identifier: Apache-2.0
#include "scene_io/npy_file.h"

#include <algorithm>
#include <charconv>
#include <string_view>
#include <system_error>

#include <fmt/format.h>

#include "base/error.h"
#include "base/excerpt.h"

namespace nacre {
namespace {

constexpr std::string_view kMagic = "\x93NUMPY";
constexpr const char* kNpyHint =
    "numpy.save of N rows and 3 to 5 columns of floats: x, y, z, radius, material";

// The text of the header, a Python dictionary:
//   {'descr': '<f4', 'fortran_order': False, 'shape': (1000, 4), }
class NpyHeader {
 public:
  NpyHeader(std::string_view text, const std::string& file) : text_(text), file_(file) {}

  [[noreturn]] void Refuse(std::string what) const {
    throw Error(ExitCode::kBadInput, file_, std::move(what), kNpyHint);
  }

  // The text after the key and its colon.
  std::string_view ValueOf(std::string_view key) const {
    const size_t found = text_.find(key);
    std::string_view rest = text_.substr(std::min(found, text_.size()));
    rest.remove_prefix(std::min(key.size(), rest.size()));
    if (!Take(':', &rest)) Refuse(fmt::format("its header has no {}", key));
    SkipBlanks(&rest);
    return rest;
  }

  std::string_view Text(std::string_view key) const {
    std::string_view rest = ValueOf(key);
    if (rest.starts_with('[')) Refuse("its rows are records, not numbers");
    const size_t end = rest.find('\'', 1);
    if (!rest.starts_with('\'') || end == std::string_view::npos) {
      Refuse(fmt::format("its {} is not a string", key));
    }
    return rest.substr(1, end - 1);
  }

  bool Flag(std::string_view key) const {
    const std::string_view rest = ValueOf(key);
    const bool is_true = rest.starts_with("True");
    if (!is_true && !rest.starts_with("False")) {
      Refuse(fmt::format("its {} is neither True nor False", key));
    }
    return is_true;
  }

  void Shape(uint64_t* rows, uint64_t* columns) const {
    std::string_view rest = ValueOf("'shape'");
    if (!Take('(', &rest) || !Number(&rest, rows) || !Take(',', &rest) || !Number(&rest, columns)) {
      Refuse("its array has not two dimensions");
    }
    Take(',', &rest);
    if (!Take(')', &rest)) Refuse("its array has not two dimensions");
  }

 private:
  static void SkipBlanks(std::string_view* rest) {
    rest->remove_prefix(std::min(rest->find_first_not_of(" \t"), rest->size()));
  }

  static bool Take(char c, std::string_view* rest) {
    SkipBlanks(rest);
    if (!rest->starts_with(c)) return false;
    rest->remove_prefix(1);
    return true;
  }

  static bool Number(std::string_view* rest, uint64_t* number) {
    SkipBlanks(rest);
    const auto [end, error] = std::from_chars(rest->data(), rest->data() + rest->size(), *number);
    if (error != std::errc()) return false;
    rest->remove_prefix(static_cast<size_t>(end - rest->data()));
    return true;
  }

  std::string_view text_;
  const std::string& file_;
};

}  // namespace

// Version 1 has two bytes for the header's length, the others four.
std::string_view NpyHeaderText(std::string_view bytes, const std::string& file, const char* hint,
                               size_t* offset) {
  const auto refuse = [&](const char* what) { throw Error(ExitCode::kBadInput, file, what, hint); };
  constexpr size_t kVersion = 6, kLength = 8;
  if (!bytes.starts_with(kMagic) || bytes.size() < kLength) refuse("is not a NumPy file");
  const auto byte = [&](size_t i) { return static_cast<unsigned char>(bytes[i]); };
  if (byte(kVersion) < 1 || byte(kVersion) > 3) refuse("is of an unknown version of the format");
  const size_t length_bytes = byte(kVersion) == 1 ? 2 : 4;
  *offset = kLength + length_bytes;
  if (bytes.size() < *offset) refuse("ends in its header");
  size_t length = 0;
  for (size_t i = 0; i < length_bytes; ++i) length |= size_t{byte(kLength + i)} << (8 * i);
  constexpr size_t kMaxHeader = size_t{1} << 16;  // that of a matrix has about a hundred bytes
  if (length > kMaxHeader) refuse("has too long a header");
  if (bytes.size() - *offset < length) refuse("ends in its header");
  const std::string_view text = bytes.substr(*offset, length);
  *offset += length;
  return text;
}

NpyMatrix::NpyMatrix(const std::string& bytes, const std::string& file) {
  size_t offset = 0;
  const NpyHeader header(NpyHeaderText(bytes, file, kNpyHint, &offset), file);
  const std::string_view type = header.Text("'descr'");
  const bool is_double = type.ends_with("f8");
  if (type.size() != 3 || (!is_double && !type.ends_with("f4")) ||
      std::string_view("<>=").find(type[0]) == std::string_view::npos) {
    header.Refuse(fmt::format("its numbers are \"{}\", not floats of 4 or 8 bytes", Excerpt(type)));
  }
  type_ = is_double ? NumberType::kDouble : NumberType::kFloat;
  size_ = is_double ? 8 : 4;
  big_endian_ = type[0] == '>';
  by_columns_ = header.Flag("'fortran_order'");
  header.Shape(&rows_, &columns_);
  if (columns_ < 3 || columns_ > 5) header.Refuse(fmt::format("has {} columns", columns_));
  const uint64_t held = bytes.size() - offset, row = columns_ * size_;
  if (held % row != 0 || held / row != rows_) {
    header.Refuse(
        fmt::format("its {} rows are not {} bytes: it is damaged or incomplete", rows_, held));
  }
  numbers_ = bytes.data() + offset;
}

}  // namespace nacre
