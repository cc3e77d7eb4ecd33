// SPDX-License-Identifier: Apache-2.0
// brdf/table_albedo.h: directional albedos of GGX lobes whose Fresnel curve is a table
// (brdf/fresnel_table.h), a thin film's: in each channel that of a mirror, and what the lobe's
// width adds. SIMD twin: table_albedo-inl.h.
//
// Worst errors found, over films up to 1 um on dielectrics in air and below coats: isotropic lobes
// 1e-3, most 3e-4; anisotropic ones 2e-3. The narrower the fringes, the larger they are.
#pragma once

#include <array>
#include <vector>

#include "brdf/albedo.h"
#include "brdf/anisotropic_albedo.h"
#include "brdf/fresnel_table.h"

namespace nacre {

// The curves of one isotropic lobe, whose own albedos are an AlbedoFit, by channel.
struct TableAlbedoFit {
  std::array<AlbedoPolynomial, 3> wider{};
  Rgb average{0, 0, 0};  // 2 int of the albedo mu dmu
};

// Computed by quadrature, in some milliseconds.
TableAlbedoFit MakeTableAlbedoFit(Shadowing shadowing, double roughness, const AlbedoFit& lobe,
                                  const FresnelTable& table);

// The same of an anisotropic lobe, in some 30 ms. `bend` is that of FittedFresnel.
std::array<AnisotropicFresnelCurve, 3> FitAnisotropicTable(Shadowing shadowing,
                                                           const GgxAlphas<double>& alpha,
                                                           const FresnelTable& table, double bend);

// That at all roughnesses along a path of alphas, by channel.
std::vector<AnisotropicFresnelCurves> MakeAnisotropicTableCurves(Shadowing shadowing,
                                                                 const AlphasOfRoughness& alphas,
                                                                 const FresnelTable& table,
                                                                 double bend);

// TableAlbedoFit at all roughnesses of brdf/albedo_table.h, for hits that have one each. Made in
// some tenths of a second.
struct TableAlbedoCurves {
  std::vector<TableAlbedoFit> nodes;
};
TableAlbedoCurves MakeTableAlbedoCurves(Shadowing shadowing, const FresnelTable& table);
TableAlbedoFit BlendTableAlbedo(const TableAlbedoCurves& curves, double roughness);

// The albedos in a direction.
Rgb TableAlbedo(const TableAlbedoFit& fit, const AlbedoFit& lobe, const FresnelTable& table,
                double n_dot_v);
Rgb TableAlbedo(const std::array<AnisotropicFresnelCurve, 3>& fit, const AnisotropicAlbedoFit& lobe,
                const FresnelTable& table, double n_dot_v, double t_dot_v, double b_dot_v);

}  // namespace nacre
