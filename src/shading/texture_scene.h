// SPDX-License-Identifier: Apache-2.0
// shading/texture_scene.h: textures of a scene, prepared once per plan, and the hits that look them
// up.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "hit/batch.h"
#include "hit/camera_frame.h"
#include "scene/primitives.h"
#include "scene/scene.h"
#include "scene/tangents.h"
#include "shading/hit_parameters.h"
#include "shading/material.h"
#include "shading/surface.h"

namespace nacre {

// A texture with its mapping prepared.
struct PreparedTexture {
  const MipChain* image;  // null for ShapeCoordinates
  SampleSettings sampling;
  MappingKind mapping;
  bool second_uvs;
  float middle;         // normal maps: the texel value that stands for 0
  Vec3d frame[3];       // unit x, y and z axes of the mapping; z is the mapping's axis
  Vec3d center;         // centre of the mapping on meshes, relative to the camera
  double inverse_size;  // 1 / size of the mapping on meshes
  // (u, v) of the texture are these rows times (u, v) of the mapping, plus `offset`.
  Vec2d u_row, v_row;
  Vec2d offset;
  size_t coordinates;  // equal for textures with the same mapping and transform
};

// The tangents of a normal map on the coordinates of one mesh.
struct MapTangents {
  uint32_t texture;
  uint32_t tangents;  // index into TextureScene::tangents
};

// The data for texture look-ups at all hits of a plan.
struct TextureScene {
  const Scene* scene = nullptr;
  Rgb ambient{0, 0, 0};  // radiance of the scene's ambient light
  // The width of a sample's footprint, in pixels: with many samples per pixel, each stands for a
  // small part of it.
  double footprint = 1;
  std::vector<PreparedTexture> textures;  // one per texture of the scene, and ShapeCoordinates
  PrimitiveNumbers primitives;
  std::vector<std::shared_ptr<const CornerTangents>> tangents;
  std::vector<std::vector<MapTangents>> mesh_tangents;  // by mesh; empty if no mesh has any
};

// The coordinates that shapes have by themselves: those of a mesh, or longitude and latitude about
// the y axis of a sphere and of a mesh that has none. It has no image.
inline const PreparedTexture& ShapeCoordinates(const TextureScene& textures) {
  return textures.textures.back();
}

// How far the points that the rays of a batch hit are apart from one pixel to the next.
struct RayFootprints {
  // The camera whose rays they are, by the differentials of its rays (Igehy 1999). Null for others.
  const CameraFrame* camera = nullptr;
  // Of other rays: the diameters, at the hits of the batch, of the cones around them that stand for
  // one pixel (Amanatides 1984), in world units. Padded like the arrays of the batch.
  const double* cone_diameter = nullptr;
};

// Hits [begin, end) of a batch, all of one material with maps, and where the results are stored.
struct TexturedRun {
  const TextureScene& scene;
  const ShadingMaterial& material;
  size_t begin, end;
  HitBatch& hits;
  Surface& surface;
  HitParameters& textures;
  RayFootprints footprints;
};

}  // namespace nacre
