// SPDX-License-Identifier: Apache-2.0
// scene_io/npy_file.h: a matrix of floats in NumPy's format (.npy), and the header of such files.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "scene_io/stored_number.h"

namespace nacre {

// The text of the header, a Python dictionary, of versions 1 to 3 of the format. Sets *offset to
// where the data begins. Throws Error (kBadInput), located in `file` and with this hint, if this is
// not an .npy file.
std::string_view NpyHeaderText(std::string_view bytes, const std::string& file, const char* hint,
                               size_t* offset);

class NpyMatrix {
 public:
  // Reads the header. Throws Error (kBadInput), located in `file`, if this is not an .npy file, if
  // its numbers are not floats of 4 or 8 bytes (the message names their type), or if the number of
  // bytes does not match its shape. Refers to `bytes`, which must outlive it.
  NpyMatrix(const std::string& bytes, const std::string& file);

  uint64_t rows() const { return rows_; }
  uint64_t columns() const { return columns_; }
  double At(uint64_t row, uint64_t column) const {
    const uint64_t place = by_columns_ ? column * rows_ + row : row * columns_ + column;
    return LoadNumber(numbers_ + place * size_, type_, big_endian_);
  }

 private:
  const char* numbers_ = nullptr;
  NumberType type_ = NumberType::kFloat;
  size_t size_ = 4;
  bool big_endian_ = false;
  bool by_columns_ = false;  // Fortran order: column-major
  uint64_t rows_ = 0, columns_ = 0;
};

}  // namespace nacre
