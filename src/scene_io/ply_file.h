// SPDX-License-Identifier: Apache-2.0
// scene_io/ply_file.h: PLY files (Turk 1994) as their headers describe them: elements of numbers
// and lists of numbers, as text or as bytes of either order. What the names mean: ply.h.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace nacre {

enum class PlyType : uint8_t { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kFloat, kDouble };

struct PlyProperty {
  std::string name;
  PlyType type = PlyType::kFloat;
  bool is_list = false;
  PlyType count_type = PlyType::kUint8;  // of a list
};

struct PlyElement {
  std::string name;
  uint64_t count = 0;
  std::vector<PlyProperty> properties;

  // The place of the property of this name, or kNone.
  static constexpr size_t kNone = static_cast<size_t>(-1);
  size_t Find(std::string_view property) const;
};

enum class PlyFormat : uint8_t { kText, kLittleEndian, kBigEndian };

struct PlyHeader {
  PlyFormat format = PlyFormat::kText;
  std::vector<PlyElement> elements;
  size_t length = 0;  // bytes of the header
};

// The number whose bytes begin here. `swap`: they are in big-endian order.
double LoadPlyNumber(const char* bytes, PlyType type, bool swap);

// Throws Error (kBadInput) unless a file that begins like this says that it is a PLY file.
void CheckPlyMagic(std::string_view head, const std::string& file);

// Throws Error (kBadInput) with `file` and the line for what is no header, for more elements than
// the rest of the file can hold, and for names that an element has twice.
PlyHeader ReadPlyHeader(const std::string& bytes, const std::string& file);

// Reads the numbers after a header, one after the other.
class PlyNumbers {
 public:
  // Refers to all of its arguments.
  PlyNumbers(const std::string& bytes, const PlyHeader& header, const std::string& file);

  // The next number. Throws Error (kBadInput) at the end of the file, and in text for what is not a
  // number of the type.
  double Next(PlyType type);
  // Where the last number was, for errors: in text the file and the line.
  std::string place() const;
  // The length of the next list, which the rest of the file can hold.
  size_t NextLength(const PlyProperty& list);
  // Leaves out the next value of the property.
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
