// SPDX-License-Identifier: Apache-2.0
// scene_io/gltf_accessor.h: the numbers that a glTF accessor stands for.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "scene_io/gltf_document.h"

namespace nacre {

// An accessor whose every element is known to lie in its buffer. Refers to the document.
class GltfAccessor {
 public:
  // Throws Error (kBadInput), in the place of the accessor, unless it is there, of the type `type`
  // ("VEC3"), with components of a known type, and in bounds: so are its sparse values.
  GltfAccessor(const GltfDocument& document, int index, std::string_view type);

  size_t count() const { return count_; }
  bool is_unsigned() const;  // of unsigned integers, which can be indices
  bool is_float() const { return component_type_ == gltf::kFloat; }

  // Component c of an element, normalised if the accessor says so.
  double Number(size_t element, size_t c) const;
  // The same of an element of unsigned integers, as it is written.
  uint32_t Index(size_t element, size_t c = 0) const;

  const std::string& place() const { return place_; }

 private:
  // Elements in a buffer.
  struct Elements {
    const unsigned char* first = nullptr;  // null: all are 0
    size_t stride = 0;
  };
  Elements CheckElements(const GltfDocument& document, int view, uint64_t offset, uint64_t count,
                         size_t size) const;
  void ReadSparse(const GltfDocument& document, const gltf::Accessor& accessor);
  const unsigned char* Bytes(size_t element) const;

  std::string place_;
  int component_type_;
  size_t component_size_;
  size_t element_size_;
  bool normalized_;
  size_t count_;
  Elements elements_;
  std::vector<uint32_t> replaced_;  // sparse: the elements that are, ascending
  Elements replacements_;
};

}  // namespace nacre
