// SPDX-License-Identifier: Apache-2.0
// scene/handle.h: typed indices into the scene's arrays.
#pragma once

#include <cstdint>

namespace nacre {

// An index into one of the scene's arrays; kInvalid means none.
template <typename Tag>
struct Handle {
  static constexpr uint32_t kInvalid = 0xffffffffu;
  uint32_t index = kInvalid;

  bool valid() const { return index != kInvalid; }
  bool operator==(const Handle&) const = default;
};
using MaterialId = Handle<struct MaterialTag>;
using ImageId = Handle<struct ImageTag>;
using TextureId = Handle<struct TextureTag>;

}  // namespace nacre
