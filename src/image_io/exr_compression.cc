// SPDX-License-Identifier: Apache-2.0
#include "image_io/exr_compression.h"

#include <algorithm>
#include <iterator>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <openexr_attr.h>

#include "base/error.h"

namespace nacre {
namespace {

struct CompressionForm {
  const char* name;
  int number;
  int chunk_rows;
};

// Indexed by Compression.
constexpr CompressionForm kForms[] = {
    {"none", EXR_COMPRESSION_NONE, 1},  {"zip", EXR_COMPRESSION_ZIP, 16},
    {"zips", EXR_COMPRESSION_ZIPS, 1},  {"piz", EXR_COMPRESSION_PIZ, 32},
    {"dwaa", EXR_COMPRESSION_DWAA, 32},
};

const CompressionForm& FormOf(Compression compression) {
  return kForms[static_cast<size_t>(compression)];
}

// The first compression whose form passes the test.
template <class Test>
std::optional<Compression> FindForm(const Test& test) {
  const auto* const found = std::find_if(std::begin(kForms), std::end(kForms), test);
  if (found == std::end(kForms)) return std::nullopt;
  return static_cast<Compression>(found - std::begin(kForms));
}

}  // namespace

std::vector<std::string> CompressionNames() { return NamesOf(kForms); }

std::string CompressionName(Compression compression) { return FormOf(compression).name; }

Compression ParseCompression(const std::string& name) {
  const auto found = FindForm([&](const CompressionForm& form) { return name == form.name; });
  if (found) return *found;
  throw Error(ExitCode::kUsage, "compression", "unknown compression \"" + name + "\"",
              fmt::format("one of: {}", fmt::join(CompressionNames(), ", ")));
}

int RowsPerChunk(Compression compression) { return FormOf(compression).chunk_rows; }

int CompressionNumber(Compression compression) { return FormOf(compression).number; }

std::optional<Compression> CompressionOfNumber(int number) {
  return FindForm([&](const CompressionForm& form) { return number == form.number; });
}

}  // namespace nacre
