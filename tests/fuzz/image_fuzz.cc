// SPDX-License-Identifier: Apache-2.0
// tests/fuzz/image_fuzz.cc: images as textures, as environments and as what is compared.
#include <algorithm>

#include "compare/verdict.h"
#include "fuzz/fuzz_input.h"
#include "fuzz/targets.h"
#include "image_io/read_image.h"
#include "scene_io/texture_image.h"

namespace nacre {
namespace {

// The reader of EXR goes by the name.
bool IsExr(std::string_view bytes) { return bytes.starts_with("\x76\x2f\x31\x01"); }

// Images that would take long are none that find faults faster. The limits themselves have tests.
bool IsSmall(const std::filesystem::path& path, std::string_view bytes) {
  constexpr int64_t kMaxPixels = 1 << 16;
  const auto big = [&](size_t at) {
    int64_t value = 0;
    for (size_t i = at; i < at + 4; ++i) value = value << 8 | static_cast<unsigned char>(bytes[i]);
    return std::min<int64_t>(value, kMaxPixels + 1);
  };
  if (bytes.starts_with("\x89PNG")) return bytes.size() < 24 || big(16) * big(20) <= kMaxPixels;
  if (!IsExr(bytes)) return true;
  bool small = true;
  ReadOrRefuse([&] {
    const Window data = OpenImage(path.string()).header.data;
    small = (int64_t{data.x1} - data.x0) * (int64_t{data.y1} - data.y0) <= kMaxPixels;
  });
  return small;
}

std::filesystem::path WriteImage(std::string_view bytes) {
  return SharedFolder().Write(IsExr(bytes) ? "fuzz.exr" : "fuzz.image", bytes);
}

}  // namespace

void FuzzTextureImage(std::string_view bytes) {
  const std::filesystem::path path = WriteImage(bytes);
  if (!IsSmall(path, bytes)) return;
  for (const TextureEncoding encoding : {TextureEncoding::kSrgb, TextureEncoding::kLinear}) {
    TexelBudget budget(bytes.size());
    ReadOrRefuse(
        [&] { ReadTextureImage(path, "fuzz", {.encoding = encoding, .part = {}}, &budget); });
  }
}

void FuzzEnvironmentImage(std::string_view bytes) {
  const std::filesystem::path path = WriteImage(bytes);
  if (!IsSmall(path, bytes)) return;
  const std::string scene = R"({"nacre": 1, "lights": {"sky": {"type": "environment", "image": ")" +
                            path.filename().string() + R"("}}})";
  ReadOrRefuse([&] { LoadSceneText(scene, "scene.json", SharedFolder().path()); });
}

void FuzzCompareImage(std::string_view bytes) {
  const std::filesystem::path path = WriteImage(bytes);
  if (!IsSmall(path, bytes)) return;
  ReadOrRefuse([&] { DescribeImage(path.string()); });
  ReadOrRefuse([&] {
    const Image image = ReadImage(path.string());
    Judge(image, image, {}, {});
  });
}

}  // namespace nacre
