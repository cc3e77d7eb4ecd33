// SPDX-License-Identifier: Apache-2.0
// shading/hit_parameters.h: the results of texture look-ups at the hits of a batch, and the
// material parameters and constants that follow from them.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <vector>

#include "brdf/albedo.h"
#include "hit/batch.h"
#include "scene/mapped_number.h"
#include "shading/constants.h"
#include "shading/models.h"

namespace nacre {

// The data of the hits of one batch that lie on materials with maps. It is large, so there is one
// per worker, and only if the plan has such materials.
struct HitParameters {
  // The point that is mapped to (u, v): on spheres the unit outward direction, on meshes the
  // position relative to the mapping's centre, over its size.
  Soa3<double> point;
  AlignedArray<double> inverse_size{kBatchCapacity};  // 1 / (sphere's radius or mapping's size)
  Soa3<double> geometric;            // unit normal of the sphere or triangle, on the ray's side
  Soa3<double> interpolated_normal;  // Surface::interpolated_normal in double
  AlignedArray<double> side{kBatchCapacity};  // -1 where seen from behind or inside, else 1
  Soa3<double> dp_dx, dp_dy;                  // change of the position from one pixel to the next
  bool any_mesh = false;                      // whether any of the hits is on a mesh

  // (u, v), their gradients in world space, and their change from pixel to pixel.
  AlignedArray<double> u{kBatchCapacity}, v{kBatchCapacity};
  Soa3<double> gradient_u, gradient_v;
  AlignedArray<float> du_dx{kBatchCapacity}, dv_dx{kBatchCapacity};
  AlignedArray<float> du_dy{kBatchCapacity}, dv_dy{kBatchCapacity};

  // The frame of a normal map where it is interpolated between a mesh's corners, on the ray's side
  // and not normalised, as MikkTSpace defines it. `normal_length` is the length of the interpolated
  // normal, or 0 where the frame comes from the gradients. Filled for the normal map only.
  Soa3<double> tangent, bitangent;
  AlignedArray<double> normal_length{kBatchCapacity};

  Soa3<float> texels;  // the result of the last look-up

  // The material's parameters at each hit, by MappedNumber: the material's own times the maps'.
  // Parameters that are not colours are in x. All that follows is derived from them (derive.h).
  std::array<Soa3<double>, kMappedNumbers> numbers;
  // one_average, schlick_average and dielectric_average are AlbedoAverages of each hit's lobe, for
  // Kulla and Conty's compensation. phong_scale is DerivePhongScale, for the Phong family.
  AlignedArray<double> one_average{kBatchCapacity}, schlick_average{kBatchCapacity};
  AlignedArray<double> phong_scale{kBatchCapacity};
  Soa3<double> dielectric_average;
  // FilmAtHit, if MicrofacetModel::film_by_hit.
  Soa3<double> film_dielectric, film_metal;
  AlignedArray<double> sharp_alpha{kBatchCapacity};  // LobeWidth::sharp_alpha
  // Of anisotropic hits with alphas each; made for the first of them, as it is large.
  std::vector<AnisotropicLobe> lobes;
  Soa3<float> albedo, ambient, emission;  // for the output layers of these names

  // Pools of columns, with one entry per hit: column k of hit i is at [k * kStride + i].
  static constexpr size_t kStride = kBatchCapacity + 3 * kBatchPadding;  // not a power of two
  // The coefficients of albedo fits: the four numbers of AlbedoShape, then two polynomials.
  static constexpr size_t kFitEntries = 4 + 2 * kAlbedoTerms;
  AlignedArray<float> fit{kFitEntries * kStride};
  // The constants of models, and their products with one light. Hits of all models share these
  // pools, because each hit has one model only.
  AlignedArray<float> constants{ColumnsOf<MicrofacetConstants<float*>>() * kStride};
  AlignedArray<float> products{ColumnsOf<MicrofacetLight<float*>>() * kStride};
  // The hits, and the light's colour, that the products were last made for; products_end is 0 if
  // there are none. The same products are used again when a lobe is shaded along mirrored
  // directions, and with the unit light of several sampling strategies.
  size_t products_begin = 0, products_end = 0;
  Rgb products_color{0, 0, 0};

  // The number of columns of a struct of pointers to columns.
  template <class Columns>
  static constexpr size_t ColumnsOf() {
    return sizeof(Columns) / sizeof(float*);
  }
};

// The numbers of a parameter at the hits, channel c.
inline const double* NumbersOf(const HitParameters& t, MappedNumber number, int c = 0) {
  return ChannelOf(t.numbers[static_cast<size_t>(number)], c).data();
}

inline Rgb ColorOfHit(const HitParameters& t, MappedNumber number, size_t i) {
  return {NumbersOf(t, number, 0)[i], NumbersOf(t, number, 1)[i], NumbersOf(t, number, 2)[i]};
}

// A number of a hit in one column of a pool. Cheaper than pointers to all of them for one number.
template <class Columns>
float NumberIn(const AlignedArray<float>& pool, float* Columns::*column, size_t hit) {
  static constexpr Columns kNone{};
  const auto* const first = reinterpret_cast<float* const*>(&kNone);
  const auto k = static_cast<size_t>(&(kNone.*column) - first);
  return pool[k * HitParameters::kStride + hit];
}

// Pointers to the columns of `Columns`, a struct of nothing but float*, one after the other in a
// pool. Only mapped_kernel.cc writes to them, through a pool that is not const; kernels only read.
template <class Columns>
Columns ColumnsIn(const AlignedArray<float>& pool) {
  std::array<float*, HitParameters::ColumnsOf<Columns>()> columns;
  for (size_t k = 0; k < columns.size(); ++k) {
    columns[k] = const_cast<float*>(pool.data()) + k * HitParameters::kStride;
  }
  return std::bit_cast<Columns>(columns);
}

}  // namespace nacre
