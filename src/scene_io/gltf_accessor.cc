// SPDX-License-Identifier: Apache-2.0
#include "scene_io/gltf_accessor.h"

#include <algorithm>
#include <cstring>

#include <fmt/format.h>

namespace nacre {
namespace {

// Elements without a buffer (zeros) take no space in the file, so their number is limited here.
constexpr size_t kMaxZeros = size_t{1} << 24;

template <typename T>
T Load(const unsigned char* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof(T));  // glTF and our machines are little-endian
  return value;
}

// The size of a component in bytes; 0 if `type` is not a component type of glTF.
size_t ComponentSize(int type) {
  switch (type) {
    case gltf::kByte:
    case gltf::kUnsignedByte:
      return 1;
    case gltf::kShort:
    case gltf::kUnsignedShort:
      return 2;
    case gltf::kUnsignedInt:
    case gltf::kFloat:
      return 4;
    default:
      return 0;
  }
}

// The number of components of an element, for the types that nacre reads.
size_t ComponentCount(std::string_view type) {
  if (type == "MAT4") return 16;
  return type == "SCALAR" ? 1 : static_cast<size_t>(type.back() - '0');
}

bool IsUnsigned(int type) {
  return type == gltf::kUnsignedByte || type == gltf::kUnsignedShort || type == gltf::kUnsignedInt;
}

uint32_t LoadIndex(const unsigned char* bytes, int type) {
  switch (type) {
    case gltf::kUnsignedByte:
      return *bytes;
    case gltf::kUnsignedShort:
      return Load<uint16_t>(bytes);
    default:
      return Load<uint32_t>(bytes);
  }
}

}  // namespace

GltfAccessor::GltfAccessor(const GltfDocument& document, int index, std::string_view type)
    : place_(fmt::format("/accessors/{}", index)) {
  const auto& accessors = document.model.accessors;
  if (index < 0 || static_cast<size_t>(index) >= accessors.size()) {
    document.Refuse(place_, "there is no such accessor",
                    fmt::format("the file has {}", accessors.size()));
  }
  const gltf::Accessor& accessor = accessors[static_cast<size_t>(index)];
  component_type_ = accessor.componentType;
  component_size_ = ComponentSize(component_type_);
  if (component_size_ == 0) {
    document.Refuse(place_ + "/componentType", fmt::format("{} is none", component_type_),
                    "one of 5120 to 5123, 5125 and 5126");
  }
  if (accessor.type != type) {
    document.Refuse(
        place_ + "/type", "is not the type that its use asks for",
        "positions and normals are VEC3, texture coordinates VEC2, indices SCALAR, joints and "
        "weights VEC4, inverse bind matrices MAT4");
  }
  element_size_ = component_size_ * ComponentCount(type);
  normalized_ = accessor.normalized;
  count_ = accessor.count;
  if (count_ == 0) document.Refuse(place_ + "/count", "is 0");
  if (accessor.bufferView >= 0) {
    elements_ =
        CheckElements(document, accessor.bufferView, accessor.byteOffset, count_, element_size_);
  } else if (count_ > kMaxZeros) {
    document.Refuse(place_ + "/count", fmt::format("{} elements without a buffer view", count_),
                    fmt::format("at most {}", kMaxZeros));
  }
  if (accessor.isSparse) ReadSparse(document, accessor);
}

// The comparisons only subtract the smaller operand from the larger, so that nothing wraps around.
GltfAccessor::Elements GltfAccessor::CheckElements(const GltfDocument& document, int view,
                                                   uint64_t offset, uint64_t count,
                                                   size_t size) const {
  const gltf::Model& model = document.model;
  if (view < 0 || static_cast<size_t>(view) >= model.bufferViews.size()) {
    document.Refuse(place_, fmt::format("there is no buffer view {}", view),
                    fmt::format("the file has {}", model.bufferViews.size()));
  }
  const gltf::BufferView& bytes = model.bufferViews[static_cast<size_t>(view)];
  const std::string view_place = fmt::format("/bufferViews/{}", view);
  if (bytes.buffer < 0 || static_cast<size_t>(bytes.buffer) >= model.buffers.size()) {
    document.Refuse(view_place + "/buffer", fmt::format("there is no buffer {}", bytes.buffer),
                    fmt::format("the file has {}", model.buffers.size()));
  }
  const gltf::Buffer& buffer = model.buffers[static_cast<size_t>(bytes.buffer)];
  if (buffer.data == nullptr && bytes.extensions != nullptr && !bytes.extensions->empty()) {
    document.RefuseExtension(view_place, bytes.extensions->begin().key());
  }
  if (buffer.data == nullptr) {
    document.Refuse(fmt::format("/buffers/{}", bytes.buffer), "has no \"uri\" and no data");
  }
  const std::string& data = *buffer.data;
  if (bytes.byteOffset > data.size() || bytes.byteLength > data.size() - bytes.byteOffset) {
    document.Refuse(view_place,
                    fmt::format("{} bytes from byte {} on", bytes.byteLength, bytes.byteOffset),
                    fmt::format("buffer {} has {}", bytes.buffer, data.size()));
  }
  const size_t stride = bytes.byteStride == 0 ? size : bytes.byteStride;
  if (stride < size) {
    document.Refuse(view_place + "/byteStride",
                    fmt::format("{} is less than an element of accessor {}", stride, place_),
                    fmt::format("that has {} bytes", size));
  }
  if (offset > bytes.byteLength || size > bytes.byteLength - offset ||
      count - 1 > (bytes.byteLength - offset - size) / stride) {
    document.Refuse(place_, fmt::format("{} elements reach beyond buffer view {}", count, view),
                    fmt::format("that has {} bytes", bytes.byteLength));
  }
  return {reinterpret_cast<const unsigned char*>(data.data()) + bytes.byteOffset + offset, stride};
}

void GltfAccessor::ReadSparse(const GltfDocument& document, const gltf::Accessor& accessor) {
  const auto& sparse = accessor.sparse;
  const std::string place = place_ + "/sparse";
  if (sparse.count < 1 || sparse.count > count_) {
    document.Refuse(place + "/count", fmt::format("{} of {} elements", sparse.count, count_));
  }
  if (!IsUnsigned(sparse.indices.componentType)) {
    document.Refuse(place + "/indices/componentType", "is not an unsigned type");
  }
  const size_t count = sparse.count;
  const Elements indices =
      CheckElements(document, sparse.indices.bufferView, sparse.indices.byteOffset, count,
                    ComponentSize(sparse.indices.componentType));
  replacements_ = CheckElements(document, sparse.values.bufferView, sparse.values.byteOffset, count,
                                element_size_);
  replaced_.reserve(count);
  for (size_t i = 0; i < count; ++i) {
    const uint32_t element =
        LoadIndex(indices.first + i * indices.stride, sparse.indices.componentType);
    if (element >= count_ || (i > 0 && element <= replaced_.back())) {
      document.Refuse(
          place + "/indices",
          fmt::format("index {} of element {}: not ascending below {}", element, i, count_));
    }
    replaced_.push_back(element);
  }
}

bool GltfAccessor::is_unsigned() const { return IsUnsigned(component_type_); }

const unsigned char* GltfAccessor::Bytes(size_t element) const {
  const auto found = std::lower_bound(replaced_.begin(), replaced_.end(), element);
  if (found != replaced_.end() && *found == element) {
    const auto i = static_cast<size_t>(found - replaced_.begin());
    return replacements_.first + i * replacements_.stride;
  }
  return elements_.first == nullptr ? nullptr : elements_.first + element * elements_.stride;
}

double GltfAccessor::Number(size_t element, size_t c) const {
  const unsigned char* bytes = Bytes(element);
  if (bytes == nullptr) return 0;
  bytes += c * component_size_;
  const auto signed_unit = [&](double value, double max) {
    return normalized_ ? std::max(value / max, -1.0) : value;
  };
  switch (component_type_) {
    case gltf::kByte:
      return signed_unit(Load<int8_t>(bytes), 127);
    case gltf::kShort:
      return signed_unit(Load<int16_t>(bytes), 32767);
    case gltf::kUnsignedByte:
      return signed_unit(*bytes, 255);
    case gltf::kUnsignedShort:
      return signed_unit(Load<uint16_t>(bytes), 65535);
    case gltf::kUnsignedInt:
      return Load<uint32_t>(bytes);
    default:
      return Load<float>(bytes);
  }
}

uint32_t GltfAccessor::Index(size_t element, size_t c) const {
  const unsigned char* const bytes = Bytes(element);
  return bytes == nullptr ? 0 : LoadIndex(bytes + c * component_size_, component_type_);
}

}  // namespace nacre
