// SPDX-License-Identifier: Apache-2.0
// brdf/thin_film.h: reflectance of an interface that carries a thin transparent film, at one
// wavelength, in three lines, and in the closed forms of other renderers. Scalar and in double;
// kernels read brdf/fresnel_table.h. Its integral over the visible spectrum: thin_film_spectrum.h.
//
// Reflectances come as 1 - R, the light that is not reflected, wherever they end in a product with
// the layer below: near grazing incidence R is 1 up to rounding, and 1 - R would be lost in it.
#pragma once

#include <array>
#include <complex>
#include <cstdint>

#include "base/vec.h"

namespace nacre {

// A film between a medium above it, air or a coat, and a substrate. All indices are absolute, above
// 0 and below 1e70, and none depends on the wavelength.
struct ThinFilm {
  double outside = 1;  // index of the medium above the film
  double index = 1.5;  // of the film, real: it absorbs nothing
  double thickness_nm = 0;
};

// What lies below the film: a dielectric of index eta, or a conductor of index eta - i k. It fills
// the half space, so that what it transmits does not come back.
struct Substrate {
  double eta = 1.5;
  double k = 0;
};
using RgbSubstrate = std::array<Substrate, 3>;

inline RgbSubstrate SameSubstrate(const Substrate& substrate) {
  return {substrate, substrate, substrate};
}

// Reflected and unreflected illuminant, each without cancellation: the second is not 1 minus the
// first.
struct ThinFilmReflectance {
  double reflected;  // R
  double loss;       // 1 - R
};

// Airy's sum of all reflections in the film, the mean of both polarisations. The sum is written as
// the film's characteristic matrix (Born and Wolf, 1.6.4; Macleod, "Thin-Film Optical Filters",
// 2.6), which is the same number but has no quotient 0 / 0: a film of thickness 0 is no film, total
// reflection may happen at either interface, and a film that light enters only by tunnelling is an
// ordinary case. `cosine` is that of the angle of incidence in the medium above, from 0 to 1. An
// index-matched interface (both indices equal, no film) reflects nothing even at grazing incidence.
ThinFilmReflectance AiryReflectance(const ThinFilm& film, const Substrate& substrate, double cosine,
                                    double wavelength_nm);

// The pieces of Airy's sum, for loops over wavelengths.
//
// One polarisation's admittances in units of free space's: of the medium above, which is real, and
// of the substrate, a - i b. For s they are n cos(theta), for p cos(theta) / n, which is the
// reciprocal of the usual admittance and gives the same |r|^2.
struct Admittances {
  double outside, a, b;
};
struct PolarisedAdmittances {
  Admittances s, p;
};
PolarisedAdmittances InterfaceAdmittances(const ThinFilm& film, const Substrate& substrate,
                                          double cosine);

// (n cos(theta))^2 in the film: negative where light enters it only by tunnelling.
double ThinFilmNormalIndex2(const ThinFilm& film, double cosine);

// The film's characteristic matrix for s: cos(delta), sin(delta) / q and q sin(delta), where
// q = n cos(theta) in the film and delta = 2 pi thickness q / wavelength. All three are even in q,
// and so real if q is imaginary. They are scaled by exp(-|Im delta|), which is `attenuation`.
struct ThinFilmMatrix {
  double cosine, sine_over_q, sine_times_q, attenuation;
};
ThinFilmMatrix MakeThinFilmMatrix(const ThinFilm& film, double normal_index2, double wavelength_nm);

ThinFilmReflectance AiryReflectance(const ThinFilm& film, const PolarisedAdmittances& admittances,
                                    const ThinFilmMatrix& matrix);

// Airy's sum of one polarisation as a Fourier series in the optical path difference of light that
// crosses the film twice, opd = 2 thickness q (Belcour and Barla 2017, eq. 9, who write R):
//
//   1 - R = mean (1 + 2 Re sum_m (ratio exp(-2 pi i opd / wavelength))^m),
//
// mean = (1 - R12) (1 - R23) / (1 - R12 R23), ratio = -r12 r23: Poisson's kernel. For films that
// light does not tunnel through.
struct ThinFilmSeries {
  double mean;
  std::complex<double> ratio;
};
struct PolarisedSeries {
  ThinFilmSeries s, p;
};
PolarisedSeries MakeThinFilmSeries(const ThinFilm& film, const Substrate& substrate, double cosine);

// The cosine below which the substrate reflects everything, film or no film; 0 if there is none.
double CriticalCosine(const ThinFilm& film, const Substrate& substrate);

// 1 - R at one wavelength for each channel. The default is that of adobe/openpbr-bsdf.
inline constexpr std::array<double, 3> kThreeLines{620, 540, 450};
Rgb ThreeLineLoss(const ThinFilm& film, const RgbSubstrate& substrate, double cosine,
                  const std::array<double, 3>& wavelengths_nm = kThreeLines);

// Gulbrandsen 2014, "Artist Friendly Metallic Fresnel", eq. 5 to 9: the index of a metal, seen from
// vacuum, that reflects r at normal incidence and whose edge tint is g, both in [0, 1]. OpenPBR's
// implementations pass the specular colour as g (adobe/openpbr-bsdf, OpenPBR-viewer) or the
// reflectance at 82 degrees (Blender). r is clamped to `largest`, because a mirror has no index:
// .99 in adobe/openpbr-bsdf, .999 in Blender.
Substrate GulbrandsenIndex(double r, double g, double largest = 0.999);

// The real index above 1 with reflectance r at normal incidence, seen from vacuum.
Substrate RealIndex(double r, double largest = 0.99);

// The share of the film in a blend with the interface without it: smoothstep from 0 at thickness 0
// to 1 at fade_nm, where metals whose index was guessed have another reflectance without film
// than with one of thickness 0. Always 1 if fade_nm is 0. adobe/openpbr-bsdf: 30 nm.
double ThinFilmShare(double thickness_nm, double fade_nm);

// Belcour and Barla 2017, "A Practical Extension to Microfacet Theory for the Modeling of Varying
// Iridescence": the first terms of the Fourier series, each weighed by the spectrum's Fourier
// transform, for which they fitted Gaussians.
struct BelcourBarlaOptions {
  int terms = 2;  // of the sum: 3 in the paper's code, 2 in MaterialX, where it is an option
  // The channels that the paper's XYZ is turned into: MaterialX, like the paper's code, takes those
  // of CIE RGB, whose white is equal energy, and uses the numbers as Rec. 709.
  enum class Channels : uint8_t { kCieRgb, kRec709 } channels = Channels::kCieRgb;
};

// 1 - R, which may leave [0, 1]: MaterialX clamps it. The index of the medium above is free
// (MaterialX: always 1), and each channel takes the index of the substrate that is its own
// (MaterialX: X, Y and Z take those of red, green and blue). Where light enters the film only by
// tunnelling, which the series has no terms for, everything is reflected.
Rgb BelcourBarlaLoss(const ThinFilm& film, const RgbSubstrate& substrate, double cosine,
                     const BelcourBarlaOptions& options = {});

// KHR_materials_iridescence, the formula of its text: Schlick's curve at both interfaces, the
// substrate's index from F0 as if it were a dielectric, phases 0 or pi, two terms of Belcour and
// Barla's series. `film.outside` is 1 there. The film's index fades to the outside's below a
// thickness of 0.03 nm. As in the text, channels may exceed 1, and negative ones are clamped.
Rgb GltfIridescence(const ThinFilm& film, const Rgb& f0, double cosine);

}  // namespace nacre
