// SPDX-License-Identifier: Apache-2.0
// scene_io/gltf_accessor.h: the numbers that a glTF accessor refers to.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "scene_io/gltf_document.h"
#include "scene_io/stored_number.h"

namespace nacre {

// An accessor all of whose elements are known to lie within their buffer. Refers to the document,
// which must outlive it.
class GltfAccessor {
 public:
  // Throws Error (kBadInput), located at the accessor, unless the accessor exists, has the type
  // `type` ("VEC3"), has components of a known type, and lies in bounds, sparse values included.
  GltfAccessor(const GltfDocument& document, int index, std::string_view type);

  size_t count() const { return count_; }
  // Refuses an attribute that does not have an element for each position.
  void CheckCount(const GltfDocument& document, size_t positions) const {
    if (count_ == positions) return;
    document.Refuse(place_ + "/count",
                    fmt::format("{} elements for {} positions", count_, positions));
  }
  bool is_unsigned() const;  // unsigned integers, which can be indices
  bool is_float() const { return type_ == NumberType::kFloat; }

  // Component c of an element, normalised if the accessor says so.
  double Number(size_t element, size_t c) const;
  // Component c of an element of unsigned integers, never normalised.
  uint32_t Index(size_t element, size_t c = 0) const;

  const std::string& place() const { return place_; }

 private:
  // Where elements lie in a buffer.
  struct Elements {
    const char* first = nullptr;  // null: all are 0
    size_t stride = 0;
  };
  Elements CheckElements(const GltfDocument& document, int view, uint64_t offset, uint64_t count,
                         size_t size) const;
  void ReadSparse(const GltfDocument& document, const gltf::Sparse& sparse);
  const char* Bytes(size_t element) const;

  std::string place_;
  NumberType type_;
  size_t element_size_;
  bool normalized_;
  size_t count_;
  Elements elements_;
  std::vector<uint32_t> replaced_;  // indices of the elements that sparse values replace, ascending
  Elements replacements_;
};

}  // namespace nacre
