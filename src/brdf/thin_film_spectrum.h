// SPDX-License-Identifier: Apache-2.0
// brdf/thin_film_spectrum.h: the colour of a thin film, Airy's sum (thin_film.h) integrated over
// the visible spectrum. Scalar and in double; kernels read brdf/fresnel_table.h.
#pragma once

#include "brdf/thin_film.h"
#include "brdf/visible_spectrum.h"

namespace nacre {

// 1 - R in linear Rec. 709, not clamped: thin films have colours outside of the gamut, so that a
// channel may be a little below 0 or above 1. Each channel is the integral over its own sensitivity
// for its own index, which does not depend on the wavelength.
//
// Computed as Belcour and Barla's series, with the spectrum's Fourier transform itself where they
// have Gaussians, and with all its terms:
//
//   1 - R = (1 - R12) (1 - R23) / (1 - R12 R23) (1 + 2 Re sum_m (-r12 r23)^m C(m opd)),
//
// which is Poisson's kernel and cancels nowhere (C: brdf/visible_spectrum.h). It costs one term for
// thick films and some dozens for thin ones on metals. Where light enters the film by tunnelling,
// or hardly leaves it, the integral is the sum over wavelengths below. Differs from that sum by at
// most 2e-5, which is what Coherence drops, and by 1e-6 for optical thicknesses below 2 um.
Rgb SpectralLoss(const ThinFilm& film, const RgbSubstrate& substrate, double cosine,
                 Illuminant illuminant = Illuminant::kEqualEnergy);

// The same as a sum over equidistant wavelengths, 2.5 nm apart for thin films, and as much closer
// as the fringes of this film and their overtones need, which may take thousands of them. Slow, for
// tests and for SpectralLoss. Error 2e-6.
Rgb SpectralLossByQuadrature(const ThinFilm& film, const RgbSubstrate& substrate, double cosine,
                             Illuminant illuminant = Illuminant::kEqualEnergy);

}  // namespace nacre
