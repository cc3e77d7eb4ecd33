// SPDX-License-Identifier: Apache-2.0
#include "brdf/thin_film_spectrum.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <vector>

namespace nacre {
namespace {

using Complex = std::complex<double>;

// 1 if the channels have the same index, and so are computed together, otherwise 3.
size_t CountDistinct(const RgbSubstrate& substrate) {
  for (const Substrate& other : substrate) {
    if (other.eta != substrate[0].eta || other.k != substrate[0].k) return 3;
  }
  return 1;
}

// Terms of the series are dropped when their sum is below this, relative to the first.
constexpr double kDropped = 1e-8;
// Where the series has more terms than this, the fringes are few and sharp, and a sum over
// wavelengths is faster.
constexpr double kMostTerms = 400;

double TermsUntilDropped(double ratio) {
  if (!(ratio > 0)) return 0;
  if (!(ratio < 1)) return std::numeric_limits<double>::infinity();
  return std::log(kDropped * (1 - ratio)) / std::log(ratio);
}

// How often light is reflected at both interfaces before it is lost: the larger |r12 r23| of both
// polarisations.
double LargestRatio(const PolarisedSeries& series) {
  return std::sqrt(std::max(std::norm(series.s.ratio), std::norm(series.p.ratio)));
}

// The step between wavelengths. A sum over steps h takes a fringe of local frequency
// opd / lambda^2 + 1 / h for one of frequency opd / lambda^2. The overtone m of the fringes, whose
// amplitude is ratio^m, must have fallen below kDropped at that frequency.
double WavelengthStep(double opd_nm, double ratio, double step) {
  const double overtones = std::max(1.0, TermsUntilDropped(ratio));
  constexpr double kShortest2 = 400.0 * 400.0;  // little is seen below
  while (step * (opd_nm * overtones / kShortest2 + 0.1) > 1 && step > 1e-3) step /= 2;
  return step;
}

// Without fringes. D65 has a corner every 10 nm.
double WidestStep(Illuminant illuminant) { return illuminant == Illuminant::kD65 ? 1.25 : 2.5; }

// The sum over a list of wavelengths, each with what the channels make of it.
struct WeighedWavelength {
  double wavelength;
  Rgb weight;
};

Rgb SumOverWavelengths(const ThinFilm& film, const RgbSubstrate& substrate, double cosine,
                       const std::vector<WeighedWavelength>& rule) {
  const double q2 = ThinFilmNormalIndex2(film, cosine);
  const size_t channels = CountDistinct(substrate);
  std::array<PolarisedAdmittances, 3> admittances{};
  for (size_t c = 0; c < channels; ++c) {
    admittances[c] = InterfaceAdmittances(film, substrate[c], cosine);
  }
  Rgb sum(0, 0, 0);
  for (const auto& [wavelength, weight] : rule) {
    const ThinFilmMatrix matrix = MakeThinFilmMatrix(film, q2, wavelength);
    std::array<double, 3> loss{};
    for (size_t c = 0; c < channels; ++c) {
      loss[c] = AiryReflectance(film, admittances[c], matrix).loss;
    }
    for (int c = 0; c < 3; ++c) {
      sum[c] += weight[c] * loss[channels == 1 ? 0 : static_cast<size_t>(c)];
    }
  }
  return sum;
}

// Wavelengths `step` apart.
std::vector<WeighedWavelength> EquidistantRule(Illuminant illuminant, double step) {
  std::vector<WeighedWavelength> rule;
  Rgb total(0, 0, 0);
  const int steps =
      static_cast<int>(std::lround((kLongestWavelength - kShortestWavelength) / step));
  for (int i = 0; i <= steps; ++i) {
    const double wavelength = kShortestWavelength + step * i;
    rule.push_back({wavelength, ChannelSensitivity(illuminant, wavelength)});
    total += rule.back().weight;
  }
  for (WeighedWavelength& at : rule) at.weight /= total;
  return rule;
}

// The rule for spectra without fringes, polynomials in the wavenumber of a degree below its size:
// Chebyshev's nodes, and the integrals of the polynomials that are 1 at one node and 0 at the
// others. (No node is a whole number of nm, of which the integrals are sums.)
std::vector<WeighedWavelength> MakeSmoothRule(Illuminant illuminant) {
  constexpr size_t kNodes = 24;
  const double middle = (1 / kShortestWavelength + 1 / kLongestWavelength) / 2;
  const double half = (1 / kShortestWavelength - 1 / kLongestWavelength) / 2;
  std::array<double, kNodes> x{}, barycentric{};
  std::vector<WeighedWavelength> rule;
  for (size_t i = 0; i < kNodes; ++i) {
    const double angle = M_PI * (static_cast<double>(i) + 0.5) / kNodes;
    x[i] = std::cos(angle);
    barycentric[i] = (i % 2 == 0 ? 1 : -1) * std::sin(angle);
    rule.push_back({1 / (middle + half * x[i]), Rgb(0, 0, 0)});
  }
  for (const auto& [wavelength, sensitivity] : EquidistantRule(illuminant, 1)) {
    const double at = (1 / wavelength - middle) / half;
    std::array<double, kNodes> terms{};
    double sum = 0;
    for (size_t i = 0; i < kNodes; ++i) sum += terms[i] = barycentric[i] / (at - x[i]);
    for (size_t i = 0; i < kNodes; ++i) rule[i].weight += sensitivity * (terms[i] / sum);
  }
  return rule;
}

const std::vector<WeighedWavelength>& SmoothRule(Illuminant illuminant) {
  static const std::array<std::vector<WeighedWavelength>, 2> kRules{
      MakeSmoothRule(Illuminant::kEqualEnergy), MakeSmoothRule(Illuminant::kD65)};
  return kRules[static_cast<size_t>(illuminant)];
}

// Fringes of a ratio up to `sharpest` are resolved.
Rgb SumOverFringes(const ThinFilm& film, const RgbSubstrate& substrate, double cosine,
                   Illuminant illuminant, double sharpest) {
  const double q2 = ThinFilmNormalIndex2(film, cosine);
  double step = WidestStep(illuminant);
  if (q2 > 0) {
    const double opd = 2 * film.thickness_nm * std::sqrt(q2);
    for (const Substrate& below : substrate) {
      const double ratio = LargestRatio(MakeThinFilmSeries(film, below, cosine));
      step = WavelengthStep(opd, std::min(ratio, sharpest), step);
    }
  }
  return SumOverWavelengths(film, substrate, cosine, EquidistantRule(illuminant, step));
}

}  // namespace

Rgb SpectralLossByQuadrature(const ThinFilm& film, const RgbSubstrate& substrate, double cosine,
                             Illuminant illuminant) {
  return SumOverFringes(film, substrate, cosine, illuminant, 0.9999);
}

Rgb SpectralLoss(const ThinFilm& film, const RgbSubstrate& substrate, double cosine,
                 Illuminant illuminant) {
  const double q2 = ThinFilmNormalIndex2(film, cosine);
  if (!(q2 > 0)) return SumOverWavelengths(film, substrate, cosine, SmoothRule(illuminant));
  if (!(cosine > 0)) return ThreeLineLoss(film, substrate, cosine);  // 0 but without an interface
  const double q = std::sqrt(q2);
  const double opd = 2 * film.thickness_nm * q;
  const size_t channels = CountDistinct(substrate);
  std::array<PolarisedSeries, 3> series{};
  double most_terms = 0;
  for (size_t c = 0; c < channels; ++c) {
    series[c] = MakeThinFilmSeries(film, substrate[c], cosine);
    most_terms = std::max(most_terms, TermsUntilDropped(LargestRatio(series[c])));
  }
  most_terms = std::min(most_terms, kCoherenceLength / opd);
  if (!(most_terms <= kMostTerms)) {
    // The optical path difference is less than a third of a wavelength: only the phases that
    // conductors add make fringes of that, and no conductor reflects more than this.
    return SumOverFringes(film, substrate, cosine, illuminant, 0.995);
  }
  const Coherence& coherence = CoherenceOf(illuminant);
  const Complex turn = std::polar(1.0, -2 * M_PI * Coherence::kMeanWavenumber * opd);
  std::array<Complex, 3> ratio_s, ratio_p, power_s, power_p;
  Rgb fringes(0, 0, 0);
  for (size_t c = 0; c < channels; ++c) {
    ratio_s[c] = series[c].s.ratio * turn;
    ratio_p[c] = series[c].p.ratio * turn;
    power_s[c] = series[c].s.mean / 2;
    power_p[c] = series[c].p.mean / 2;
  }
  const auto times = [](const Complex& a, const Complex& b) {
    return Complex(a.real() * b.real() - a.imag() * b.imag(),
                   a.real() * b.imag() + a.imag() * b.real());
  };
  for (int m = 1; m <= most_terms; ++m) {
    const std::array<Complex, 3> envelope = coherence.Envelope(m * opd);
    for (size_t c = 0; c < channels; ++c) {
      power_s[c] = times(power_s[c], ratio_s[c]);
      power_p[c] = times(power_p[c], ratio_p[c]);
    }
    for (size_t c = 0; c < 3; ++c) {
      const size_t own = channels == 1 ? 0 : c;
      const Complex power = power_s[own] + power_p[own];
      fringes[static_cast<int>(c)] +=
          power.real() * envelope[c].real() - power.imag() * envelope[c].imag();
    }
  }
  return MakeRgb([&](int c) {
    const size_t own = channels == 1 ? 0 : static_cast<size_t>(c);
    return (series[own].s.mean + series[own].p.mean) / 2 + 2 * fringes[c];
  });
}

}  // namespace nacre
