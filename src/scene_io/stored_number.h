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
  constexpr std::array<double (*)(const char*, bool), 8> kLoad = {
      LoadAs<int8_t>,  LoadAs<uint8_t>,  LoadAs<int16_t>, LoadAs<uint16_t>,
      LoadAs<int32_t>, LoadAs<uint32_t>, LoadAs<float>,   LoadAs<double>};
  return kLoad[static_cast<size_t>(type)](bytes, swap);
}

}  // namespace nacre
