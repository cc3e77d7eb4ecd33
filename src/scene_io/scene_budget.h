// SPDX-License-Identifier: Apache-2.0
// scene_io/scene_budget.h: upper bounds on the primitives and materials that a file expands to. A
// few bytes can ask for a hundred million spheres, several times over.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "base/error.h"

namespace nacre {

inline constexpr const char* kPrimitivesHint = "ask for fewer, or allow them with --max-primitives";

// Upper bound on the triangles that a model file of this many bytes, with its buffers, expands to.
// Strips and polygons need a byte or two a triangle and glTF instances meshes freely, so the bound
// goes by file size. A mesh without either takes at least 8 bytes a triangle.
inline uint64_t TrianglesOfBytes(uint64_t bytes) { return 1'000'000 + bytes / 4; }

// Upper bound on the materials of a model file. A name of a few bytes makes one, which takes a
// kilobyte or two.
inline constexpr size_t kMaxModelMaterials = size_t{1} << 16;

// Upper bounds on the corners of a face, and on what it takes to cut those of more than 255, which
// is n^2 steps of nanoseconds: a few seconds a file. Throws Error (kBadInput).
inline constexpr size_t kMaxCorners = 32767;
inline void CheckCuts(std::span<const uint16_t> corner_counts, const std::string& file) {
  constexpr double kMaxSteps = 1 << 30;
  double steps = 0;
  for (const uint16_t count : corner_counts) {
    if (count > 255) steps += static_cast<double>(count) * count;
  }
  if (steps <= kMaxSteps) return;
  throw Error(ExitCode::kBadInput, file,
              fmt::format("its faces of up to {} corners take too long to cut into triangles",
                          *std::ranges::max_element(corner_counts)),
              "let the program that made it cut them");
}

class SceneBudget {
 public:
  // The count of a sphere with a material of its own: such a pair takes about as much memory as
  // that many plain spheres.
  static constexpr uint64_t kWithMaterial = 16;

  explicit SceneBudget(uint64_t primitives) : allowed_(primitives), left_(primitives) {}

  // To be called before primitives are made. Throws Error (kBadInput), located at `where`, if there
  // are too many.
  void Spend(uint64_t primitives, const std::string& where = {},
             const char* hint = kPrimitivesHint) {
    if (primitives > left_) {
      throw Error(ExitCode::kBadInput, where,
                  fmt::format("the scene would have more than {} spheres and triangles", allowed_),
                  hint);
    }
    left_ -= primitives;
  }

  bool IsSpent() const { return left_ == 0; }

  // False from the second time on: a scene has one environment, whose picture may be large.
  bool TakeSkyPicture() { return !std::exchange(has_sky_picture_, true); }

 private:
  uint64_t allowed_, left_;
  bool has_sky_picture_ = false;
};

// The hint for files that do not instance anything, and whose bound therefore is their size alone.
inline constexpr const char* kTooManyForItsSize =
    "these are more than a file of its size needs: name each vertex a few times";

}  // namespace nacre
