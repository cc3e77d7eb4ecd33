// SPDX-License-Identifier: Apache-2.0
// scene_io/stored_number.h: numbers as binary files hold them (glTF, PLY, NumPy).
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace nacre {

enum class NumberType : uint8_t {
  kInt8,
  kUint8,
  kInt16,
  kUint16,
  kInt32,
  kUint32,
  kFloat,
  kDouble
};

inline size_t SizeOf(NumberType type) {
  constexpr std::array<size_t, 8> kSizes = {1, 1, 2, 2, 4, 4, 4, 8};
  return kSizes[static_cast<size_t>(type)];
}

template <typename T>
double LoadAs(const char* bytes, bool swap) {
  std::array<char, sizeof(T)> ordered;
  std::memcpy(ordered.data(), bytes, sizeof(T));
  if (swap) std::reverse(ordered.begin(), ordered.end());  // the host is little-endian
  T value;
  std::memcpy(&value, ordered.data(), sizeof(T));
  return static_cast<double>(value);
}

// The number stored at `bytes`. `swap`: the bytes are in big-endian order.
inline double LoadNumber(const char* bytes, NumberType type, bool swap) {
  switch (type) {
    case NumberType::kInt8:
      return LoadAs<int8_t>(bytes, swap);
    case NumberType::kUint8:
      return LoadAs<uint8_t>(bytes, swap);
    case NumberType::kInt16:
      return LoadAs<int16_t>(bytes, swap);
    case NumberType::kUint16:
      return LoadAs<uint16_t>(bytes, swap);
    case NumberType::kInt32:
      return LoadAs<int32_t>(bytes, swap);
    case NumberType::kUint32:
      return LoadAs<uint32_t>(bytes, swap);
    case NumberType::kFloat:
      return LoadAs<float>(bytes, swap);
    case NumberType::kDouble:
      break;
  }
  return LoadAs<double>(bytes, swap);
}

}  // namespace nacre
