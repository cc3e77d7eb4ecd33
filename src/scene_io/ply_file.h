// SPDX-License-Identifier: Apache-2.0
// scene_io/ply_file.h: PLY files (Turk 1994) as their headers describe them: elements that consist
// of numbers and lists of numbers, as text or as bytes of either order. ply.cc interprets the
// names.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "scene_io/stored_number.h"

namespace nacre {

struct PlyProperty {
  std::string name;
  NumberType type = NumberType::kFloat;
  bool is_list = false;
  NumberType count_type = NumberType::kUint8;  // for lists: the type of the count
};

struct PlyElement {
  std::string name;
  uint64_t count = 0;
  std::vector<PlyProperty> properties;

  // The index of the property with this name, or kNone.
  static constexpr size_t kNone = static_cast<size_t>(-1);
  size_t Find(std::string_view property) const {
    for (size_t i = 0; i < properties.size(); ++i) {
      if (properties[i].name == property) return i;
    }
    return kNone;
  }
};

enum class PlyFormat : uint8_t { kText, kLittleEndian, kBigEndian };

struct PlyHeader {
  PlyFormat format = PlyFormat::kText;
  std::vector<PlyElement> elements;
  size_t length = 0;  // size of the header in bytes
};

// Throws Error (kBadInput) unless `head`, the beginning of a file, has the magic word of PLY.
void CheckPlyMagic(std::string_view head, const std::string& file);

// Throws Error (kBadInput), with `file` and the line, for a malformed header, for more elements
// than the rest of the file can hold, and for names that occur twice in an element.
PlyHeader ReadPlyHeader(const std::string& bytes, const std::string& file);

// Reads the numbers after a header, one by one.
class PlyNumbers {
 public:
  // Refers to all of its arguments, which must outlive it.
  PlyNumbers(const std::string& bytes, const PlyHeader& header, const std::string& file)
      : bytes_(bytes), file_(file), format_(header.format), position_(header.length) {}

  // Reads the next number. Throws Error (kBadInput) at the end of the file, and, in text, for a
  // word that is not a number of the type.
  double Next(NumberType type);
  // The location of the last number, for errors: in text, the file and the line.
  std::string place() const;
  // Reads the length of the next list. Throws Error (kBadInput) if the rest of the file cannot hold
  // it.
  size_t NextLength(const PlyProperty& list);
  // Skips the next value of the property.
  void Skip(const PlyProperty& property);

 private:
  [[noreturn]] void Refuse(std::string what) const;
  std::string_view NextWord();

  const std::string& bytes_;
  const std::string& file_;
  PlyFormat format_;
  size_t position_;
};

}  // namespace nacre
