// SPDX-License-Identifier: Apache-2.0
// shading/textures.h: textures of a scene as hits look them up: prepared once per plan, and what
// they give at the hits of a batch.
#pragma once

#include <array>
#include <bit>
#include <memory>
#include <vector>

#include "hit/batch.h"
#include "hit/camera_frame.h"
#include "scene/material_parameters.h"
#include "scene/primitives.h"
#include "scene/scene.h"
#include "scene/tangents.h"
#include "shading/kept_tables.h"
#include "shading/material.h"
#include "shading/shade.h"

namespace nacre {

// A texture with its mapping worked out.
struct PreparedTexture {
  const MipChain* image;
  SampleSettings sampling;
  MappingKind mapping;
  bool second_uvs;
  float middle;         // of a normal map: the value that is 0
  Vec3d frame[3];       // the mapping's x, y and z axes, unit; z is its axis
  Vec3d center;         // of meshes, relative to the camera
  double inverse_size;  // of meshes
  // (u, v) of the texture are these times those of the mapping, plus `offset`.
  Vec2d u_row, v_row;
  Vec2d offset;
  size_t coordinates;  // textures with the same mapping have the same number
};

// The tangents of a normal map on the coordinates of one mesh.
struct MapTangents {
  uint32_t texture;
  uint32_t tangents;  // index into TextureScene::tangents
};

// What looking textures up takes, for all hits of a plan.
struct TextureScene {
  const Scene* scene = nullptr;
  CameraFrame camera;
  Rgb ambient{0, 0, 0};  // radiance of the scene's ambient light
  // What a sample stands for, in pixels: a sample of many is a small part of its pixel.
  double footprint = 1;
  std::vector<PreparedTexture> textures;  // one per texture of the scene
  PrimitiveNumbers primitives;
  std::vector<std::shared_ptr<const CornerTangents>> tangents;
  std::vector<std::vector<MapTangents>> mesh_tangents;  // by mesh; empty if no mesh has any
};

// `threads` as in ParallelFor. Tangents are looked for in `kept`, which is of the same meshes, and
// left there.
TextureScene PrepareTextures(const Scene& scene, const CameraFrame& camera, double footprint,
                             int threads, KeptTables* kept);

// Of the hits of one batch that lie on materials with maps. Large: one per worker, and only if the
// plan has such materials.
struct HitTextures {
  // Where the hits are: for spheres their unit outward direction, for meshes the position.
  Soa3<double> point;
  AlignedArray<double> inverse_size{kBatchCapacity};
  Soa3<double> geometric;  // unit normal of the sphere or triangle, on the ray's side
  Soa3<double> unturned;   // shading normal before maps turn it: Surface::unturned, not rounded
  AlignedArray<double> side{kBatchCapacity};  // -1 where seen from behind or inside, else 1
  Soa3<double> dp_dx, dp_dy;                  // of the position, from one pixel to the next
  bool any_mesh = false;

  // (u, v), their gradients in the world, and how they change from pixel to pixel.
  AlignedArray<double> u{kBatchCapacity}, v{kBatchCapacity};
  Soa3<double> gradient_u, gradient_v;
  AlignedArray<float> du_dx{kBatchCapacity}, dv_dx{kBatchCapacity};
  AlignedArray<float> du_dy{kBatchCapacity}, dv_dy{kBatchCapacity};

  // The frame of a normal map where it is interpolated between a mesh's corners, on the ray's side
  // and not normalised, as MikkTSpace has it; `normal_length` is that of the normal in it, and 0
  // where the frame comes from the gradients. Filled for the normal map only.
  Soa3<double> tangent, bitangent;
  AlignedArray<double> normal_length{kBatchCapacity};

  Soa3<float> texels;  // looked up last

  // The parameters of the material at each hit, its own times the maps', by MappedNumber: of those
  // that are no colours in x. What follows is derived from them (derive.h).
  std::array<Soa3<double>, kMappedNumbers> numbers;
  // Of Kulla and Conty's compensation: AlbedoAverages of each hit's lobe. Of the Phong family: what
  // its convention multiplies the lobe by.
  AlignedArray<double> one_average{kBatchCapacity}, schlick_average{kBatchCapacity};
  AlignedArray<double> dielectric_average{kBatchCapacity}, phong_scale{kBatchCapacity};
  AlignedArray<double> sharp_alpha{kBatchCapacity};  // LobeWidth::sharp_alpha
  Soa3<float> albedo, ambient, emission;             // for the layers of these names

  // Columns of numbers, hit by hit: entry k of hit i is at [k * kStride + i].
  static constexpr size_t kStride = kBatchCapacity + 3 * kBatchPadding;  // no power of two
  // The coefficients of albedo fits: AlbedoShape's four, then two polynomials.
  static constexpr size_t kFitEntries = 4 + 2 * kAlbedoTerms;
  AlignedArray<float> fit{kFitEntries * kStride};
  // The constants of models, and their products with one light, of hits of whichever model: each
  // hit has one.
  AlignedArray<float> constants{ColumnsOf<MicrofacetConstants<float*>>() * kStride};
  AlignedArray<float> products{ColumnsOf<MicrofacetLight<float*>>() * kStride};
  // The hits that the products were last made for, none if the end is 0, and the light's colour:
  // lobes are shaded anew along mirrored directions, and by the unit light of several strategies.
  size_t products_begin = 0, products_end = 0;
  Rgb products_color{0, 0, 0};

  // How many columns a struct of pointers to columns has.
  template <class Columns>
  static constexpr size_t ColumnsOf() {
    return sizeof(Columns) / sizeof(float*);
  }
};

// The columns of `Columns`, which is made of nothing but float*, one behind the other in a pool.
// Only mapped_kernel.cc writes to them, in a pool that is its own to change; kernels read.
template <class Columns>
Columns ColumnsIn(const AlignedArray<float>& pool) {
  std::array<float*, HitTextures::ColumnsOf<Columns>()> columns;
  for (size_t k = 0; k < columns.size(); ++k) {
    columns[k] = const_cast<float*>(pool.data()) + k * HitTextures::kStride;
  }
  return std::bit_cast<Columns>(columns);
}

// What a material with maps has at hits [begin, end) of the batch, all of it: looks the maps up,
// turns the normals of `hits` and `surface` by normal and bump maps, and leaves the rest in
// `textures`. `hits` must have exact directions.
struct TexturedRun {
  const TextureScene& scene;
  const ShadingMaterial& material;
  size_t begin, end;
};
void TextureHits(const TexturedRun& run, HitBatch* hits, Surface* surface, HitTextures* textures);

// Takes the light from hits [begin, end) where it is below the horizon of the surface, whose normal
// is that before maps turned it, though the normal that a map turned faces the light.
void HideBelowHorizon(const Surface& surface, size_t begin, size_t end, LightBatch* light);

// Mirrors those of the hits' directions in that surface that are below it, so that none is, but
// for rounding. Directions behind the normal that a map turned stay.
void RaiseAboveHorizon(const Surface& surface, size_t begin, size_t end, Soa3<float>* to_light);

// Light of the hits mirrored in that surface, along unit vectors. Its irradiance is that of `light`
// where the normal that a map turned faces it; else it is 0, and the direction the normal itself.
// Whether any light is left.
bool MirrorAtHorizon(const Surface& surface, size_t begin, size_t end, const LightBatch& light,
                     LightBatch* mirrored);

}  // namespace nacre
