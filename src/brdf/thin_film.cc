// SPDX-License-Identifier: Apache-2.0
#include "brdf/thin_film.h"

#include <algorithm>
#include <cmath>
#include <complex>

namespace nacre {
namespace {

using Complex = std::complex<double>;

// Phases above this are no longer known to a fraction of a period.
constexpr double kLargestPhase = 1e15;

// One polarisation. The film transmits what it does not reflect, so that 1 - R is 4 outside a over
// the common denominator.
ThinFilmReflectance OfPolarisation(const Admittances& y, const ThinFilmMatrix& film) {
  const Complex field(film.cosine + y.b * film.sine_over_q, y.a * film.sine_over_q);
  const Complex flux(y.a * film.cosine, film.sine_times_q - y.b * film.cosine);
  const double below = std::norm(y.outside * field + flux);
  if (!(below > 0)) return {0, 1};  // no interface, at grazing incidence
  const double attenuation2 = film.attenuation * film.attenuation;
  return {std::norm(y.outside * field - flux) / below, 4 * y.outside * y.a * attenuation2 / below};
}

}  // namespace

PolarisedAdmittances InterfaceAdmittances(const ThinFilm& film, const Substrate& substrate,
                                          double cosine) {
  // q = n cos(theta) = a - i b in the substrate, from q^2 = (n^2 - n_o^2) + q_o^2. The smaller of a
  // and b follows from their product, as in FresnelConductor.
  const double q_outside = film.outside * cosine;
  const double product = substrate.eta * substrate.k;
  const double difference = (substrate.eta - film.outside) * (substrate.eta + film.outside) -
                            substrate.k * substrate.k + q_outside * q_outside;
  const double larger = (std::hypot(difference, 2 * product) + std::abs(difference)) / 2;
  const double root = std::sqrt(larger);
  const double other = root > 0 ? product / root : 0;
  const double a = difference > 0 ? root : other;
  const double b = difference > 0 ? other : root;
  // q / n^2 for p: [a (|q|^2 + beta^2) + i b (|q|^2 - beta^2)] / |n|^4, beta = n_o sin(theta_o), is
  // the form in which its real part does not cancel.
  const double beta2 = film.outside * film.outside * (1 - cosine) * (1 + cosine);
  const double q2 = a * a + b * b;
  const double n2 = substrate.eta * substrate.eta + substrate.k * substrate.k;
  return {{q_outside, a, b},
          {cosine / film.outside, a * (q2 + beta2) / (n2 * n2), -b * (q2 - beta2) / (n2 * n2)}};
}

double ThinFilmNormalIndex2(const ThinFilm& film, double cosine) {
  const double q_outside = film.outside * cosine;
  return (film.index - film.outside) * (film.index + film.outside) + q_outside * q_outside;
}

ThinFilmMatrix MakeThinFilmMatrix(const ThinFilm& film, double normal_index2,
                                  double wavelength_nm) {
  const double q = std::sqrt(std::abs(normal_index2));
  const double thickness = std::min(2 * M_PI * film.thickness_nm / wavelength_nm, kLargestPhase);
  const double delta = std::min(q * thickness, kLargestPhase);
  const bool flat = delta < 1e-8;  // sin(delta) is delta to rounding, and q may be 0
  if (normal_index2 >= 0) {
    const double sine = std::sin(delta);
    return {std::cos(delta), flat ? thickness : sine / q, sine * q, 1};
  }
  const double attenuation = std::exp(-delta);
  const double cosh = (1 + attenuation * attenuation) / 2;
  const double sinh = -std::expm1(-2 * delta) / 2;
  return {cosh, flat ? thickness : sinh / q, -sinh * q, attenuation};
}

ThinFilmReflectance AiryReflectance(const ThinFilm& film, const PolarisedAdmittances& admittances,
                                    const ThinFilmMatrix& matrix) {
  const double index2 = film.index * film.index;
  const ThinFilmMatrix of_p{matrix.cosine, matrix.sine_over_q * index2,
                            matrix.sine_times_q / index2, matrix.attenuation};
  const ThinFilmReflectance s = OfPolarisation(admittances.s, matrix);
  const ThinFilmReflectance p = OfPolarisation(admittances.p, of_p);
  return {(s.reflected + p.reflected) / 2, (s.loss + p.loss) / 2};
}

ThinFilmReflectance AiryReflectance(const ThinFilm& film, const Substrate& substrate, double cosine,
                                    double wavelength_nm) {
  return AiryReflectance(
      film, InterfaceAdmittances(film, substrate, cosine),
      MakeThinFilmMatrix(film, ThinFilmNormalIndex2(film, cosine), wavelength_nm));
}

PolarisedSeries MakeThinFilmSeries(const ThinFilm& film, const Substrate& substrate,
                                   double cosine) {
  const PolarisedAdmittances admittances = InterfaceAdmittances(film, substrate, cosine);
  const double q_film = std::sqrt(std::max(ThinFilmNormalIndex2(film, cosine), 0.0));
  const auto series = [](const Admittances& y, double inside) -> ThinFilmSeries {
    const Complex below(y.a, -y.b);
    const double r12 = (y.outside - inside) / (y.outside + inside);
    const Complex r23 = (inside - below) / (inside + below);
    const double enters = 4 * y.outside * inside / ((y.outside + inside) * (y.outside + inside));
    const double leaves = 4 * inside * y.a / std::norm(inside + below);
    const double lost = enters + r12 * r12 * leaves;  // 1 - R12 R23
    return {lost > 0 ? enters * leaves / lost : 0, -r12 * r23};
  };
  return {series(admittances.s, q_film), series(admittances.p, q_film / (film.index * film.index))};
}

double CriticalCosine(const ThinFilm& film, const Substrate& substrate) {
  const double ratio = substrate.eta / film.outside;
  return substrate.k > 0 || ratio >= 1 ? 0 : std::sqrt((1 - ratio) * (1 + ratio));
}

Rgb ThreeLineLoss(const ThinFilm& film, const RgbSubstrate& substrate, double cosine,
                  const std::array<double, 3>& wavelengths_nm) {
  return MakeRgb([&](size_t c) {
    return AiryReflectance(film, substrate[c], cosine, wavelengths_nm[c]).loss;
  });
}

Substrate GulbrandsenIndex(double r, double g, double largest) {
  r = std::clamp(r, 0.0, largest);
  const double root = std::sqrt(r);
  const double eta = g * (1 - r) / (1 + r) + (1 - g) * (1 + root) / (1 - root);
  const double k2 = (r * (eta + 1) * (eta + 1) - (eta - 1) * (eta - 1)) / (1 - r);
  return {eta, std::sqrt(std::max(k2, 0.0))};
}

Substrate RealIndex(double r, double largest) {
  const double root = std::sqrt(std::clamp(r, 0.0, largest));
  return {(1 + root) / (1 - root), 0};
}

double ThinFilmShare(double thickness_nm, double fade_nm) {
  if (!(fade_nm > 0)) return 1;
  const double t = std::clamp(thickness_nm / fade_nm, 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

namespace {

// Belcour and Barla 2017, supplemental code: Gaussians fitted to the Fourier transforms of the CIE
// 1931 colour matching functions, in terms of the optical path difference, equal energy.
struct Gaussian {
  double value, position, variance;
};
constexpr Gaussian kXyzFits[3] = {{5.4856e-13, 1.6810e+06, 4.3278e+09},
                                  {4.4201e-13, 1.7953e+06, 9.3046e+09},
                                  {5.2481e-13, 2.2084e+06, 6.6121e+09}};
constexpr Gaussian kSecondLobeOfX{9.7470e-14, 2.2399e+06, 4.5282e+09};
constexpr double kXyzScale = 1.0685e-7;

// The linear functions of XYZ that are the channels.
constexpr double kRec709FromXyz[3][3] = {{3.2404542, -1.5371385, -0.4985314},
                                         {-0.9692660, 1.8760108, 0.0415560},
                                         {0.0556434, -0.2040259, 1.0572252}};
constexpr double kCieRgbFromXyz[3][3] = {{2.3706743, -0.9000405, -0.4706338},
                                         {-0.5138850, 1.4253036, 0.0885814},
                                         {0.0052982, -0.0146949, 1.0093968}};

double FittedCosine(const Gaussian& fit, double phase, double shift) {
  return fit.value * std::sqrt(2 * M_PI * fit.variance) * std::cos(fit.position * phase + shift) *
         std::exp(-fit.variance * phase * phase);
}

// X, Y and Z of a spectrum cos(2 pi opd / lambda + shift).
Vec3d FittedSensitivity(double opd_nm, const Vec3d& shift) {
  const double phase = 2 * M_PI * opd_nm * 1e-9;
  Vec3d xyz(FittedCosine(kXyzFits[0], phase, shift.x), FittedCosine(kXyzFits[1], phase, shift.y),
            FittedCosine(kXyzFits[2], phase, shift.z));
  xyz.x += FittedCosine(kSecondLobeOfX, phase, shift.x);
  return xyz / kXyzScale;
}

double Row(const double (&matrix)[3][3], size_t row, const Vec3d& xyz) {
  return matrix[row][0] * xyz.x + matrix[row][1] * xyz.y + matrix[row][2] * xyz.z;
}

}  // namespace

Rgb BelcourBarlaLoss(const ThinFilm& film, const RgbSubstrate& substrate, double cosine,
                     const BelcourBarlaOptions& options) {
  const double q2 = ThinFilmNormalIndex2(film, cosine);
  if (!(q2 > 0 && cosine > 0)) return {0, 0, 0};
  const double opd_nm = 2 * film.thickness_nm * std::sqrt(q2);
  const bool rec709 = options.channels == BelcourBarlaOptions::Channels::kRec709;
  const auto& matrix = rec709 ? kRec709FromXyz : kCieRgbFromXyz;
  return MakeRgb([&](size_t c) {
    // What the row makes of a constant spectrum: 1 within 1e-3 for CIE RGB, but not for Rec. 709.
    const double white = Row(matrix, c, FittedSensitivity(0, Vec3d(0)));
    const PolarisedSeries series = MakeThinFilmSeries(film, substrate[c], cosine);
    double loss = 0;
    for (const ThinFilmSeries& polarised : {series.s, series.p}) {
      const double amplitude = std::abs(polarised.ratio);
      const double shift = -std::arg(polarised.ratio);
      double sum = 1;
      for (int m = 1; m <= options.terms; ++m) {
        const Vec3d xyz = FittedSensitivity(m * opd_nm, Vec3d(m * shift));
        sum += 2 * std::pow(amplitude, m) * Row(matrix, c, xyz) / white;
      }
      loss += polarised.mean * sum / 2;
    }
    return loss;
  });
}

Rgb GltfIridescence(const ThinFilm& film, const Rgb& f0, double cosine) {
  const double outside = film.outside;
  const double fade = ThinFilmShare(film.thickness_nm, 0.03);
  const double index = outside + (film.index - outside) * fade;
  const double sine2 = (outside / index) * (outside / index) * (1 - cosine) * (1 + cosine);
  if (sine2 > 1) return {1, 1, 1};
  const double cosine2 = std::sqrt(1 - sine2);
  const auto normal = [](double below, double above) {
    const double root = (below - above) / (below + above);
    return root * root;
  };
  const auto schlick = [](double at_normal, double c) {
    return at_normal + (1 - at_normal) * std::pow(1 - c, 5);
  };
  const double r12 = schlick(normal(index, outside), cosine);
  const double t121 = 1 - r12;
  const double phase21 = index < outside ? 0 : M_PI;
  Vec3d r23, shift;
  for (int c = 0; c < 3; ++c) {
    // The text's guard against F0 = 1, which is only moved by it; Khronos' viewer clamps instead.
    const double root = std::sqrt(std::min(f0[c] + 1e-4, 0.9999));
    const double base = (1 + root) / (1 - root);
    r23[c] = schlick(normal(base, index), cosine2);
    shift[c] = phase21 + (base < index ? M_PI : 0);
  }
  const double opd_nm = 2 * index * film.thickness_nm * cosine2;
  Rgb sum, amplitude;
  Vec3d ratio;
  for (int c = 0; c < 3; ++c) {
    const double r123 = std::clamp(r12 * r23[c], 1e-5, 0.9999);
    ratio[c] = std::sqrt(r123);
    const double inner = t121 * t121 * r23[c] / (1 - r123);
    sum[c] = r12 + inner;
    amplitude[c] = inner - t121;
  }
  for (int m = 1; m <= 2; ++m) {
    // The text adds the phases of red, green and blue to X, Y and Z.
    const Vec3d xyz = FittedSensitivity(m * opd_nm, shift * m);
    for (int c = 0; c < 3; ++c) {
      amplitude[c] *= ratio[c];
      sum[c] += 2 * amplitude[c] * Row(kRec709FromXyz, static_cast<size_t>(c), xyz);
    }
  }
  return MakeRgb([&](int c) { return std::max(sum[c], 0.0); });
}

}  // namespace nacre
