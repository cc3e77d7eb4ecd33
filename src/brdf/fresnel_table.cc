// SPDX-License-Identifier: Apache-2.0
#include "brdf/fresnel_table.h"

#include "brdf/quadrature.h"

namespace nacre {
namespace {

// The variable of a table, on [0, 1].
struct Variable {
  double corner;
  double begin, end;  // signed roots of the distances of both ends of the table from the corner

  Variable(double corner_cosine, double least_cosine)
      : corner(corner_cosine),
        begin(corner_cosine > least_cosine ? -std::sqrt(corner_cosine - least_cosine) : 0),
        end(std::sqrt(1 - corner_cosine)) {}

  double Root(double x) const { return begin + (end - begin) * x; }
  double Cosine(double x) const {
    const double root = Root(x);
    return std::clamp(corner + root * std::abs(root), 0.0, 1.0);
  }
};

// What the spline is multiplied by to give the loss.
struct Factor {
  double constant, slope;
  double At(double cosine) const { return constant + slope * cosine; }
};

// The phase in a film that is tunnelled through beyond which it counts as thick.
constexpr double kThickFilmPhase = 5;

// The least cosine at which (1 - R) / cosine is computed: its limit there is that at 0.
constexpr double kLeastTableCosine = 1e-9;

// A loss that does not fall to 0 with the cosine, of an interface that hardly exists, cannot be
// divided by it.
Factor ChooseFactor(const FresnelCurve& curve) {
  constexpr double kNearGrazing = 1e-3;
  if (curve.critical_cosine > 0) return {1, 0};
  const Rgb loss = curve.loss(kNearGrazing);
  return std::max({loss.x, loss.y, loss.z}) > 0.25 ? Factor{1, 0} : Factor{0, 1};
}

// The values a spline goes through, at equal distances.
using Samples = std::vector<Rgb>;

// The slope at the front in units of the interval, by a formula of five points.
template <class At>
Rgb EndSlope(const At& at) {
  return (at(0) * -25.0 + at(1) * 48.0 - at(2) * 36.0 + at(3) * 16.0 - at(4) * 3.0) / 12.0;
}

// The coefficients of the cubic B-splines that sum to the samples and to the slopes at both ends:
// (c[i] + 4 c[i + 1] + c[i + 2]) / 6 is sample i, (c[2] - c[0]) / 2 the slope at the first.
std::vector<Rgb> Coefficients(const Samples& samples) {
  const size_t n = samples.size() - 1;
  const Rgb first_slope = EndSlope([&](size_t i) { return samples[i]; });
  const Rgb last_slope = EndSlope([&](size_t i) { return samples[n - i]; }) * -1.0;
  std::vector<double> above(n + 1);  // Thomas' algorithm
  std::vector<Rgb> c(n + 3);
  above[0] = 0.5;
  c[1] = (samples[0] * 6.0 + first_slope * 2.0) / 4.0;
  for (size_t i = 1; i <= n; ++i) {
    const double off_diagonal = i == n ? 2 : 1;
    const Rgb right = samples[i] * 6.0 - (i == n ? last_slope * 2.0 : Rgb(0, 0, 0));
    const double pivot = 4 - off_diagonal * above[i - 1];
    above[i] = 1 / pivot;
    c[i + 1] = (right - c[i] * off_diagonal) / pivot;
  }
  for (size_t i = n; i > 0; --i) c[i] -= c[i + 1] * above[i - 1];
  c[0] = c[2] - first_slope * 2.0;
  c[n + 2] = c[n] + last_slope * 2.0;
  return c;
}

// The spline of a curve in one variable, refined step by step.
class SplineFit {
 public:
  SplineFit(const FresnelCurve& curve, const Variable& variable, const Factor& factor,
            int intervals)
      : curve_(&curve), variable_(variable), factor_(factor) {
    for (int i = 0; i <= intervals; ++i) {
      samples_.push_back(Sample(static_cast<double>(i) / intervals));
    }
    SampleMiddles();
  }

  const Variable& variable() const { return variable_; }
  const Factor& factor() const { return factor_; }
  int intervals() const { return static_cast<int>(samples_.size()) - 1; }
  std::vector<Rgb> Coefficients() const { return nacre::Coefficients(samples_); }
  // The largest error of the loss in the middles of the intervals, and that before Refine.
  double error() const { return error_; }
  double error_before() const { return error_before_; }

  // Twice as many intervals.
  void Refine() {
    TakeMiddles();
    SampleMiddles();
  }

  // Refine without knowing the error, which costs no evaluation of the curve.
  void TakeMiddles() {
    Samples finer;
    for (size_t i = 0; i < middles_.size(); ++i) {
      finer.push_back(samples_[i]);
      finer.push_back(middles_[i]);
    }
    finer.push_back(samples_.back());
    samples_ = std::move(finer);
  }

 private:
  Rgb Sample(double x) const {
    const double cosine =
        std::max(variable_.Cosine(x), factor_.constant > 0 ? 0.0 : kLeastTableCosine);
    return curve_->loss(cosine) / factor_.At(cosine);
  }

  void SampleMiddles() {
    const std::vector<Rgb> c = Coefficients();
    error_before_ = error_;
    error_ = 0;
    middles_.clear();
    for (size_t i = 0; i + 1 < samples_.size(); ++i) {
      const double x = (static_cast<double>(i) + 0.5) / intervals();
      middles_.push_back(Sample(x));
      const Rgb spline = (c[i] + (c[i + 1] + c[i + 2]) * 23.0 + c[i + 3]) / 48.0;
      const Rgb off = (spline - middles_.back()) * factor_.At(variable_.Cosine(x));
      error_ = std::max({error_, std::abs(off.x), std::abs(off.y), std::abs(off.z)});
    }
  }

  const FresnelCurve* curve_;
  Variable variable_;
  Factor factor_;
  Samples samples_, middles_;
  double error_ = 1, error_before_ = 1;
};

FresnelTable MakeTable(const SplineFit& fit) {
  FresnelTable table;
  table.intervals = fit.intervals();
  const Variable& variable = fit.variable();
  const double scale = table.intervals / (variable.end - variable.begin);
  table.corner = static_cast<float>(variable.corner);
  table.start = static_cast<float>(-variable.begin * scale);
  table.scale = static_cast<float>(scale);
  table.constant = static_cast<float>(fit.factor().constant);
  table.slope = static_cast<float>(fit.factor().slope);
  for (const Rgb& c : fit.Coefficients()) {
    for (int i = 0; i < 3; ++i) table.coefficients.push_back(static_cast<float>(c[i]));
    table.coefficients.push_back(0);
  }
  return table;
}

}  // namespace

FresnelTable MakeFresnelTable(const FresnelCurve& curve, const FresnelTableOptions& options) {
  const Factor factor = options.over_cosine ? ChooseFactor(curve) : Factor{1, 0};
  SplineFit fit(curve, Variable(curve.corner, curve.critical_cosine), factor, options.fewest);
  while (fit.error() > options.tolerance && fit.intervals() < options.most) {
    // Where twice as many intervals make errors 16 times smaller, as they do once a spline follows
    // the curve, the next refinement need not be measured.
    const bool follows = fit.error() * 8 < fit.error_before();
    if (2 * fit.intervals() >= options.most || (follows && fit.error() <= 6 * options.tolerance)) {
      fit.TakeMiddles();
      break;
    }
    fit.Refine();
  }
  return MakeTable(fit);
}

FresnelCurve ThinFilmCurve(const ThinFilm& film, const RgbSubstrate& substrate,
                           const ThinFilmOptions& options, double weight,
                           const std::function<Rgb(double cosine)>& filmless_loss) {
  FresnelCurve curve;
  curve.critical_cosine = CriticalCosine(film, substrate[0]);
  for (const Substrate& other : substrate) {
    curve.critical_cosine = std::min(curve.critical_cosine, CriticalCosine(film, other));
  }
  curve.corner = curve.critical_cosine;
  // A film of a lower index than the medium above is tunnelled through below its own critical
  // cosine. Thin ones let light pass nearly as if they were not there; of thick ones, which damp it
  // by exp(-phase) at the substrate's critical cosine, the fringes next to their own are sharpest.
  const double film_critical = CriticalCosine(film, {film.index, 0});
  if (film_critical > curve.critical_cosine) {
    const double critical = curve.critical_cosine;
    const double phase = 2 * M_PI * film.thickness_nm / 555 * film.outside *
                         std::sqrt((film_critical - critical) * (film_critical + critical));
    if (phase > kThickFilmPhase) curve.corner = film_critical;
    // Belcour and Barla's films are not tunnelled through.
    if (options.model == ThinFilmModel::kBelcourBarla) {
      curve.corner = film_critical;
      if (!(weight < 1)) curve.critical_cosine = film_critical;
    }
  }
  curve.loss = [=](double cosine) {
    Rgb loss;
    switch (options.model) {
      case ThinFilmModel::kSpectral:
        loss = SpectralLoss(film, substrate, cosine, options.illuminant);
        break;
      case ThinFilmModel::kBelcourBarla:
        loss = BelcourBarlaLoss(film, substrate, cosine, options.belcour_barla);
        break;
      case ThinFilmModel::kThreeLines:
        loss = ThreeLineLoss(film, substrate, cosine, options.lines_nm);
        break;
    }
    if (weight < 1) loss += (filmless_loss(cosine) - loss) * (1 - weight);
    return loss;
  };
  return curve;
}

Rgb AverageLoss(const FresnelCurve& curve) {
  const Variable variable(curve.corner, curve.critical_cosine);
  const QuadratureRule& rule = GaussLegendre(8);
  const auto average = [&](int panels) {
    Rgb sum(0, 0, 0);
    for (int panel = 0; panel < panels; ++panel) {
      for (size_t i = 0; i < rule.x.size(); ++i) {
        const double x = (panel + rule.x[i]) / panels;
        // 2 c dc, where c is corner +- root^2
        const double cosine = variable.Cosine(x);
        const double slope = 2 * std::abs(variable.Root(x)) * (variable.end - variable.begin);
        sum += curve.loss(cosine) * (rule.w[i] / panels * 2 * cosine * slope);
      }
    }
    return sum;
  };
  Rgb before = average(2);
  for (int panels = 4;; panels *= 2) {
    const Rgb now = average(panels);
    const Rgb change = now - before;
    if (std::max({std::abs(change.x), std::abs(change.y), std::abs(change.z)}) <= 1e-7 ||
        panels >= 512) {
      return now;
    }
    before = now;
  }
}

Rgb AverageLoss(const FresnelTable& table) {
  // Within an interval, loss times 2 c dc is a polynomial of degree 8 unless the corner lies in it.
  const QuadratureRule& rule = GaussLegendre(6);
  Rgb sum(0, 0, 0);
  for (int i = 0; i < table.intervals; ++i) {
    for (size_t j = 0; j < rule.x.size(); ++j) {
      const double root = (i + rule.x[j] - double{table.start}) / double{table.scale};
      const double cosine = std::clamp(double{table.corner} + root * std::abs(root), 0.0, 1.0);
      const double weight = rule.w[j] * 4 * cosine * std::abs(root) / double{table.scale};
      const std::array<double, 3> loss = UnclampedLoss(table, cosine);
      sum += Rgb(loss[0], loss[1], loss[2]) * weight;
    }
  }
  return sum;
}

}  // namespace nacre
