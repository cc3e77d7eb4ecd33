// SPDX-License-Identifier: Apache-2.0
#include "scene_io/measured_file.h"

#include <algorithm>
#include <cstring>
#include <utility>

#include "base/error.h"
#include "base/overloaded.h"
#include "base/path.h"
#include "sampling/hash.h"
#include "scene_io/merl_file.h"
#include "scene_io/rgl_file.h"
#include "scene_io/text_file.h"

namespace nacre {
namespace {

uint64_t HashOf(std::string_view bytes) {
  uint64_t hash = bytes.size();
  for (size_t i = 0; i < bytes.size(); i += sizeof(uint64_t)) {
    uint64_t word = 0;
    std::memcpy(&word, bytes.data() + i, std::min(sizeof(word), bytes.size() - i));
    hash = HashCombine(hash, word);
  }
  return hash;
}

uint64_t BytesOf(const TabulatedWarp& warp) {
  return 4 * (warp.density.size() + warp.along_row.size() + warp.up_to_row.size());
}

}  // namespace

std::shared_ptr<const MeasuredBrdf> ReadMeasured(std::string_view bytes, const std::string& file) {
  auto brdf = std::make_shared<MeasuredBrdf>();
  if (IsTensorFile(bytes)) {
    *brdf = ReadRgl(bytes, file);
  } else {
    brdf->table = ReadMerl(bytes, file);
  }
  brdf->hash = HashOf(bytes);
  FinishMeasured(brdf.get());
  return brdf;
}

std::shared_ptr<const MeasuredBrdf> ReadMeasuredFile(const std::filesystem::path& path) {
  // The header is judged before the rest is read.
  const std::string bytes =
      ReadBytes(path, kMaxRglBytes, [&](std::string_view head, uint64_t size) {
        if (IsTensorFile(head)) return size;
        if (HasExtension(path, ".bsdf")) {
          throw Error(ExitCode::kBadInput, path.string(),
                      "is not a list of arrays: it does not begin with \"tensor_file\"",
                      "download it again, from the database of EPFL");
        }
        CheckMerlHeader(head.substr(0, kMerlHeaderBytes), size, path.string());
        return size;
      });
  return ReadMeasured(bytes, path.string());
}

uint64_t MeasuredBytes(const MeasuredBrdf& brdf) {
  const uint64_t table = std::visit(
      Overloaded{[](const MerlTable& merl) { return merl.rgb.size(); },
                 [](const RglTable& rgl) {
                   return rgl.rgb.size() + rgl.ndf.values.size() + rgl.sigma.values.size();
                 }},
      brdf.table);
  return 4 * table + BytesOf(brdf.half) + BytesOf(brdf.luminance);
}

}  // namespace nacre
