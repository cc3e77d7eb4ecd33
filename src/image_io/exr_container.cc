// SPDX-License-Identifier: Apache-2.0
#include "image_io/exr_container.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <utility>

#include <openexr.h>

#include "base/error.h"
#include "image_io/exr_checksum.h"

namespace nacre {
namespace {

// Files have a single part.
constexpr int kPart = 0;

exr_pixel_type_t ToCoreType(PixelType type) {
  if (type == PixelType::kHalf) return EXR_PIXEL_HALF;
  return type == PixelType::kUint ? EXR_PIXEL_UINT : EXR_PIXEL_FLOAT;
}

// The last pixel of an EXR window is inclusive.
exr_attr_box2i_t ToCoreWindow(const Window& window) {
  exr_attr_box2i_t box;
  box.min.x = window.x0;
  box.min.y = window.y0;
  box.max.x = window.x1 - 1;
  box.max.y = window.y1 - 1;
  return box;
}

// The limit of EXR 2; longer names must be flagged in the file, and very old readers refuse them.
constexpr size_t kMaxShortName = 31;

bool HasLongName(const ExrHeader& header) {
  return std::ranges::any_of(header.channels,
                             [](const auto& c) { return c.name.size() > kMaxShortName; }) ||
         std::ranges::any_of(header.attributes,
                             [](const auto& a) { return a.first.size() > kMaxShortName; });
}

}  // namespace

ExrContainer::ExrContainer(const std::string& path, std::vector<uint8_t>* memory,
                           const ExrHeader& header, Compression compression)
    : path_(path), memory_(memory) {
  if (memory_ == nullptr) file_.emplace(path);
  exr_context_initializer_t initializer = EXR_DEFAULT_CONTEXT_INITIALIZER;
  // The result codes tell the same as the library's messages.
  initializer.error_handler_fn = [](exr_const_context_t, exr_result_t, const char*) {};
  initializer.user_data = this;
  initializer.write_fn = OnWrite;
  // The name is only informative: with a write function, the library opens and removes no file.
  Check(exr_start_write(&context_, "output", EXR_WRITE_FILE_DIRECTLY, &initializer));
  try {
    WriteHeader(header, compression);
  } catch (...) {
    exr_finish(&context_);
    throw;
  }
}

ExrContainer::~ExrContainer() {
  if (context_ != nullptr) exr_finish(&context_);
}

void ExrContainer::WriteHeader(const ExrHeader& header, Compression compression) {
  const exr_attr_box2i_t display = ToCoreWindow(header.display);
  const exr_attr_box2i_t data = ToCoreWindow(header.data);
  const exr_attr_v2f_t center{};
  int part = kPart;
  if (HasLongName(header)) Check(exr_set_longname_support(context_, 1));
  Check(exr_add_part(context_, "", EXR_STORAGE_SCANLINE, &part));
  Check(exr_initialize_required_attr(
      context_, kPart, &display, &data, 1.0f, &center, 1.0f, EXR_LINEORDER_INCREASING_Y,
      static_cast<exr_compression_t>(CompressionNumber(compression))));
  for (const ExrChannel& channel : header.channels) {
    Check(exr_add_channel(context_, kPart, channel.name.c_str(), ToCoreType(channel.type),
                          EXR_PERCEPTUALLY_LOGARITHMIC, 1, 1));
  }
  SetAttributes(header);
  Check(exr_write_header(context_));
  in_header_ = false;
  Write(0, header_);
}

void ExrContainer::SetAttributes(const ExrHeader& header) {
  // Rec. ITU-R BT.709-6, table 1: x and y of red, green, blue, white.
  const exr_attr_chromaticities_t rec709{0.64f, 0.33f, 0.30f,   0.60f,
                                         0.15f, 0.06f, 0.3127f, 0.3290f};
  Check(exr_attr_set_chromaticities(context_, kPart, "chromaticities", &rec709));
  const auto set_matrix = [&](const char* name, const std::optional<Imath::M44f>& matrix) {
    if (!matrix) return;
    exr_attr_m44f_t m44f;
    static_assert(sizeof(m44f) == sizeof(*matrix));
    std::memcpy(&m44f, matrix->getValue(), sizeof(m44f));
    Check(exr_attr_set_m44f(context_, kPart, name, &m44f));
  };
  set_matrix("worldToCamera", header.world_to_camera);
  set_matrix("worldToNDC", header.world_to_ndc);
  for (const auto& [name, value] : header.attributes) {
    if (const int* number = std::get_if<int>(&value)) {
      Check(exr_attr_set_int(context_, kPart, name.c_str(), *number));
    } else if (const float* real = std::get_if<float>(&value)) {
      Check(exr_attr_set_float(context_, kPart, name.c_str(), *real));
    } else {
      Check(
          exr_attr_set_string(context_, kPart, name.c_str(), std::get<std::string>(value).c_str()));
    }
  }
  Check(exr_attr_set_string(context_, kPart, kExrChecksumAttribute, kNoExrChecksum));
}

void ExrContainer::WriteChunk(int y, std::span<const uint8_t> bytes) {
  Check(exr_write_scanline_chunk(context_, kPart, y, bytes.data(), bytes.size()));
}

void ExrContainer::UpdateAttribute(const std::string& name, const ExrAttribute& value) {
  static_assert(sizeof(int) == 4 && sizeof(float) == 4);
  const int* const integer = std::get_if<int>(&value);
  const float* const real = std::get_if<float>(&value);
  const size_t place = FindAttribute(name, integer != nullptr ? "int" : "float");
  if (place == 0 || (integer == nullptr && real == nullptr)) {
    throw Error(ExitCode::kInternal, path_, "the header has no number called " + name);
  }
  const auto bits =
      integer != nullptr ? std::bit_cast<uint32_t>(*integer) : std::bit_cast<uint32_t>(*real);
  std::memcpy(&header_[place], &bits, 4);
  Write(place, std::span(header_).subspan(place, 4));
}

size_t ExrContainer::FindAttribute(const std::string& name, const std::string& type) const {
  // After the magic number and the version, the header repeats name NUL type NUL size value, up to
  // an empty name.
  size_t place = 8;
  const auto take = [&] {
    std::string text(reinterpret_cast<const char*>(&header_[place]));
    place += text.size() + 1;
    return text;
  };
  for (std::string found = take(); !found.empty(); found = take()) {
    const bool same_type = take() == type;
    int32_t size;
    std::memcpy(&size, &header_[place], sizeof(size));
    place += sizeof(size);
    if (same_type && found == name) return place;
    place += static_cast<size_t>(size);
  }
  return 0;
}

void ExrContainer::Finish(bool sync) {
  Check(exr_finish(&context_));
  WriteChecksum();
  if (file_) file_->Commit(sync);
}

void ExrContainer::Write(uint64_t offset, std::span<const uint8_t> bytes) {
  if (file_) return file_->Write(offset, bytes);
  if (memory_->size() < offset + bytes.size()) memory_->resize(offset + bytes.size());
  std::ranges::copy(bytes, memory_->begin() + static_cast<ptrdiff_t>(offset));
}

void ExrContainer::Count(uint64_t offset, std::span<const uint8_t> bytes) {
  if (chunks_end_ == 0) chunks_begin_ = chunks_end_ = offset;  // the table is written last
  if (offset == chunks_end_) {
    chunks_crc_ = Crc32(chunks_crc_, bytes);
    chunks_end_ += bytes.size();
    return;
  }
  table_.resize(chunks_begin_ - header_.size());
  if (offset < header_.size() || offset + bytes.size() > chunks_begin_) {
    throw Error(ExitCode::kInternal, path_, "OpenEXR wrote its file in an unknown order");
  }
  std::ranges::copy(bytes, table_.begin() + static_cast<ptrdiff_t>(offset - header_.size()));
}

void ExrContainer::WriteChecksum() {
  const size_t place = FindAttribute(kExrChecksumAttribute, "string");
  const uint32_t head = Crc32(Crc32(0, header_), table_);
  const std::string digits =
      ExrChecksumDigits(CombineCrc32(head, chunks_crc_, chunks_end_ - chunks_begin_));
  Write(place, {reinterpret_cast<const uint8_t*>(digits.data()), digits.size()});
}

int64_t ExrContainer::OnWrite(exr_const_context_t, void* user, const void* bytes, uint64_t size,
                              uint64_t offset, exr_stream_error_func_ptr_t) {
  auto* self = static_cast<ExrContainer*>(user);
  const std::span source(static_cast<const uint8_t*>(bytes), size);
  try {
    if (self->in_header_) {
      self->header_.resize(std::max<size_t>(self->header_.size(), offset + size));
      std::ranges::copy(source, self->header_.begin() + static_cast<ptrdiff_t>(offset));
    } else {
      self->Count(offset, source);
      self->Write(offset, source);
    }
    return static_cast<int64_t>(size);
  } catch (...) {
    self->write_exception_ = std::current_exception();
    return -1;
  }
}

void ExrContainer::Check(exr_result_t result) {
  if (write_exception_) std::rethrow_exception(std::exchange(write_exception_, nullptr));
  if (result == EXR_ERR_SUCCESS) return;
  throw Error(ExitCode::kInternal, path_,
              std::string("OpenEXR: ") + exr_get_default_error_message(result));
}

}  // namespace nacre
