// SPDX-License-Identifier: Apache-2.0
// image_io/exr_header_check.cc: CheckExrHeader() of exr_check.h.
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string_view>

#include <openexr.h>

#include "base/error.h"
#include "image_io/exr_check.h"

namespace nacre {
namespace {

// Whether the file is at least as long as its chunk tables, 8 bytes per chunk, for which the C++
// reader allocates memory.
bool HasRoomForTables(exr_const_context_t context, const std::string& path) {
  int parts = 0;
  if (exr_get_count(context, &parts) != EXR_ERR_SUCCESS) return false;
  uint64_t chunks = 0;
  for (int part = 0; part < parts; ++part) {
    int32_t count = 0;
    if (exr_get_chunk_count(context, part, &count) != EXR_ERR_SUCCESS || count < 0) return false;
    chunks += static_cast<uint64_t>(count);
  }
  std::error_code error;
  return chunks * sizeof(uint64_t) <= std::filesystem::file_size(path, error) && !error;
}

// The first error that OpenEXR's C library reports about the header. Its C++ reader allocates as
// much memory as an attribute claims to have, 2 GiB of text in a file of 40 bytes. The C library
// compares the size with that of the file and reports an error, but then continues; so any report
// counts.
exr_result_t FirstComplaint(const std::string& path) {
  exr_result_t complaint = EXR_ERR_SUCCESS;
  exr_context_initializer_t initializer = EXR_DEFAULT_CONTEXT_INITIALIZER;
  initializer.user_data = &complaint;
  initializer.error_handler_fn = [](exr_const_context_t context, exr_result_t code, const char*) {
    void* first = nullptr;
    if (exr_get_user_data(context, &first) != EXR_ERR_SUCCESS || first == nullptr) return;
    if (auto* const kept = static_cast<exr_result_t*>(first); *kept == EXR_ERR_SUCCESS)
      *kept = code;
  };
  exr_context_t context = nullptr;
  exr_result_t result = exr_start_read(&context, path.c_str(), &initializer);
  if (result == EXR_ERR_SUCCESS && !HasRoomForTables(context, path)) {
    result = EXR_ERR_FILE_BAD_HEADER;
  }
  exr_finish(&context);
  return complaint != EXR_ERR_SUCCESS ? complaint : result;
}

// Whether a list of channels, which have a name and 16 bytes each, ends with an empty name exactly
// at its end.
bool EndsWhereItSays(std::string_view list) {
  constexpr size_t kDescription = 16;
  while (!list.empty()) {
    const size_t end = list.find('\0');
    if (end == 0) return list.size() == 1;
    if (end == std::string_view::npos || list.size() <= end + kDescription) return false;
    list.remove_prefix(end + 1 + kDescription);
  }
  return false;
}

// The C++ reader continues after the last channel's name instead of after the attribute's size, and
// takes what is there for an attribute. Here, sizes have been checked to lie within the file.
bool ChannelListsEnd(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  constexpr std::streamoff kMagic = 4;
  constexpr uint32_t kMultiPart = 0x1000;
  uint32_t version = 0;
  file.seekg(kMagic).read(reinterpret_cast<char*>(&version), sizeof(version));
  bool after_header = false;  // a second empty name ends the headers of a multi-part file
  std::string name, type, value;
  while (std::getline(file, name, '\0')) {
    if (name.empty()) {
      if ((version & kMultiPart) == 0 || after_header) return true;
      after_header = true;
      continue;
    }
    after_header = false;
    int32_t size = 0;
    if (!std::getline(file, type, '\0') ||
        !file.read(reinterpret_cast<char*>(&size), sizeof(size)) || size < 0) {
      return false;
    }
    if (type != "chlist") {
      file.seekg(size, std::ios::cur);
      continue;
    }
    value.resize(static_cast<size_t>(size));
    if (!file.read(value.data(), size) || !EndsWhereItSays(value)) return false;
  }
  return false;
}

}  // namespace

void CheckExrHeader(const std::string& path) {
  const exr_result_t complaint = FirstComplaint(path);
  if (complaint != EXR_ERR_SUCCESS) {
    throw Error(ExitCode::kBadInput, path,
                std::string("cannot be read as EXR: ") + exr_get_default_error_message(complaint));
  }
  if (!ChannelListsEnd(path)) {
    throw Error(ExitCode::kBadInput, path,
                "cannot be read as EXR: its list of channels is not as long as it says");
  }
}

}  // namespace nacre
