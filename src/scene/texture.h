// SPDX-License-Identifier: Apache-2.0
// scene/texture.h: images, and how materials look them up.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "base/vec.h"
#include "scene/handle.h"
#include "texture/mapping.h"
#include "texture/sample.h"

namespace nacre {

// A decoded image file. Copies of a scene share its texels.
struct SceneImage {
  std::string file;  // as the scene names it
  std::shared_ptr<const MipChain> texels;
  float middle = 0.5f;       // the value that stands for 0 in a normal map: 128/255 of 8-bit files
  bool lacks_alpha = false;  // read for its alpha, but has none: 1 everywhere
  bool is_black = false, is_white = false;  // all of its values are 0, or 1
};

// An image on surfaces. (u, v) has its origin at the lower left corner of the image, v up. It comes
// from the mapping, is scaled, rotated and then translated (as in glTF's KHR_texture_transform, but
// with v up), and then wrapped.
//
// Mappings other than kUv take `axis` as up, and positions relative to a sphere's centre in units
// of its radius, or relative to `center` in units of `size` for meshes. If the axis is +y,
// longitudes begin at -z and grow to the right as seen from outside; v is 1 at the end of the axis.
struct Texture {
  std::string name{};
  ImageId image{};
  SampleSettings sampling{};
  MappingKind mapping = MappingKind::kUv;
  Vec3d axis{0, 1, 0};    // any length > 0
  double rotate_deg = 0;  // about the axis, right-handed
  Vec3d center{0, 0, 0};  // of meshes
  double size = 1;        // of meshes, > 0
  Vec2d scale{1, 1};
  double uv_rotate_deg = 0;  // counter-clockwise
  Vec2d offset{0, 0};
  bool second_uvs = false;  // kUv: uses Mesh::second_uvs
  friend bool operator==(const Texture&, const Texture&) = default;
};

// A map of tangent-space normals, x along growing u, y along growing v.
struct NormalMap {
  TextureId texture{};
  double scale = 1;  // of x and y
  // How a value c in [0, 1] is read.
  enum class Convention : uint8_t {
    kExactFlat,  // 8-bit files as (255 c - 128) / 127, so that 128 is exactly 0; others as 2 c - 1
    kLiteral,    // 2 c - 1: a flat 8-bit map, (128, 128, 255), leans by 0.3 degrees
  };
  Convention convention = Convention::kExactFlat;
};

// What is multiplied by the colours of a mesh's vertices.
enum class VertexColors : uint8_t {
  kNone,
  kBase,      // the base colour or albedo
  kEmission,  // the emission, for materials that are not lit
};

// A map of heights whose slope tilts the shading normal; the surface stays where it is.
struct BumpMap {
  TextureId texture{};
  double distance = 0.01;  // world units between the values 0 and 1; below 0: into the surface
};

}  // namespace nacre
