// SPDX-License-Identifier: Apache-2.0
#include "scene_io/gltf_accessor.h"

#include <algorithm>
#include <array>
#include <optional>

#include <fmt/format.h>

namespace nacre {
namespace {

// Elements without a buffer (zeros) take no space in the file, so their number is limited here.
constexpr size_t kMaxZeros = size_t{1} << 24;

// The type that a componentType means; nullopt if it is none of glTF's, which are the constants of
// OpenGL from GL_BYTE on without GL_INT.
std::optional<NumberType> TypeOf(int component_type) {
  constexpr int kByte = 5120, kInt = 5124, kFloat = 5126;
  if (component_type < kByte || component_type > kFloat || component_type == kInt) {
    return std::nullopt;
  }
  return static_cast<NumberType>(component_type - kByte);
}

// The number of components of an element, for the types that nacre reads.
size_t ComponentCount(std::string_view type) {
  if (type == "MAT4") return 16;
  return type == "SCALAR" ? 1 : static_cast<size_t>(type.back() - '0');
}

bool IsUnsigned(NumberType type) {
  return type == NumberType::kUint8 || type == NumberType::kUint16 || type == NumberType::kUint32;
}

}  // namespace

GltfAccessor::GltfAccessor(const GltfDocument& document, int index, std::string_view type)
    : place_(fmt::format("/accessors/{}", index)) {
  const gltf::Accessor& accessor =
      document.At(document.model.accessors, index, place_, "there is no such accessor");
  const std::optional<NumberType> number_type = TypeOf(accessor.componentType);
  if (!number_type) {
    document.Refuse(place_ + "/componentType", fmt::format("{} is none", accessor.componentType),
                    "one of 5120 to 5123, 5125 and 5126");
  }
  type_ = *number_type;
  if (accessor.type != type) {
    document.Refuse(
        place_ + "/type", "is not the type that its use asks for",
        "positions and normals are VEC3, texture coordinates VEC2, indices SCALAR, joints and "
        "weights VEC4, inverse bind matrices MAT4");
  }
  element_size_ = SizeOf(type_) * ComponentCount(type);
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
  if (accessor.sparse) ReadSparse(document, *accessor.sparse);
}

// The comparisons only subtract the smaller operand from the larger, so that nothing wraps around.
GltfAccessor::Elements GltfAccessor::CheckElements(const GltfDocument& document, int view,
                                                   uint64_t offset, uint64_t count,
                                                   size_t size) const {
  const gltf::BufferView& bytes = document.At(document.model.bufferViews, view, place_,
                                              fmt::format("there is no buffer view {}", view));
  const std::string view_place = fmt::format("/bufferViews/{}", view);
  const gltf::Buffer& buffer =
      document.At(document.model.buffers, bytes.buffer, view_place + "/buffer",
                  fmt::format("there is no buffer {}", bytes.buffer));
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
  return {data.data() + bytes.byteOffset + offset, stride};
}

void GltfAccessor::ReadSparse(const GltfDocument& document, const gltf::Sparse& sparse) {
  const std::string place = place_ + "/sparse";
  const auto count = static_cast<size_t>(sparse.count);
  if (count < 1 || count > count_) {
    document.Refuse(place + "/count", fmt::format("{} of {} elements", count, count_));
  }
  const std::optional<NumberType> type = TypeOf(sparse.indices.componentType);
  if (!type || !IsUnsigned(*type)) {
    document.Refuse(place + "/indices/componentType", "is not an unsigned type");
  }
  const Elements indices = CheckElements(document, sparse.indices.bufferView,
                                         sparse.indices.byteOffset, count, SizeOf(*type));
  replacements_ = CheckElements(document, sparse.values.bufferView, sparse.values.byteOffset, count,
                                element_size_);
  replaced_.reserve(count);
  for (size_t i = 0; i < count; ++i) {
    const auto element =
        static_cast<uint32_t>(LoadNumber(indices.first + i * indices.stride, *type, false));
    if (element >= count_ || (i > 0 && element <= replaced_.back())) {
      document.Refuse(
          place + "/indices",
          fmt::format("index {} of element {}: not ascending below {}", element, i, count_));
    }
    replaced_.push_back(element);
  }
}

bool GltfAccessor::is_unsigned() const { return IsUnsigned(type_); }

const char* GltfAccessor::Bytes(size_t element) const {
  const auto found = std::lower_bound(replaced_.begin(), replaced_.end(), element);
  if (found != replaced_.end() && *found == element) {
    const auto i = static_cast<size_t>(found - replaced_.begin());
    return replacements_.first + i * replacements_.stride;
  }
  return elements_.first == nullptr ? nullptr : elements_.first + element * elements_.stride;
}

double GltfAccessor::Number(size_t element, size_t c) const {
  const char* const bytes = Bytes(element);
  if (bytes == nullptr) return 0;
  const double number = LoadNumber(bytes + c * SizeOf(type_), type_, false);
  // Of the types that can be normalised.
  constexpr std::array<double, 8> kMax = {127, 255, 32767, 65535};
  const double max = kMax[static_cast<size_t>(type_)];
  return normalized_ && max > 0 ? std::max(number / max, -1.0) : number;
}

uint32_t GltfAccessor::Index(size_t element, size_t c) const {
  const char* const bytes = Bytes(element);
  if (bytes == nullptr) return 0;
  return static_cast<uint32_t>(LoadNumber(bytes + c * SizeOf(type_), type_, false));
}

}  // namespace nacre
