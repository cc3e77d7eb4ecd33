// SPDX-License-Identifier: Apache-2.0
#include "table/check_table.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "shading/scalar_bsdf.h"
#include "shading/share.h"
#include "table/read_table.h"
#include "table/variant.h"

namespace nacre {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// A mistake explains the errors if it leaves no more than this of them.
constexpr double kExplains = 0.1;
// A further mistake is believed if it leaves no more than this of the errors.
constexpr double kWorthAStep = 0.5;
constexpr size_t kMostSteps = 3;
constexpr size_t kTried = 6;          // first steps that a second one is tried on
constexpr size_t kMostAlbedos = 256;  // views at which albedos are compared
constexpr size_t kMostDistinctAngles = 12;

double ErrorOf(double theirs, double ours) {
  if (theirs == ours) return 0;
  return std::abs(theirs - ours) / std::max({std::abs(theirs), std::abs(ours), kLeastValue});
}

bool IsFinite(const Rgb& rgb) {
  return std::isfinite(rgb.x) && std::isfinite(rgb.y) && std::isfinite(rgb.z);
}

double Degrees(double cosine) { return std::acos(std::clamp(cosine, -1.0, 1.0)) * 180 / M_PI; }

// The azimuth between light and view about the normal.
double AzimuthOf(const DirectionPair& pair) {
  const Vec3d &l = pair.to_light, &v = pair.to_view;
  return std::abs(std::atan2(l.x * v.y - l.y * v.x, l.x * v.x + l.y * v.y)) * 180 / M_PI;
}

// Sums up a quantity's errors row by row.
class ErrorSum {
 public:
  explicit ErrorSum(std::string name) { part_.name = std::move(name); }

  // Returns the row's error, of the worst channel.
  double Add(size_t row, const Rgb& theirs, const Rgb& ours) {
    double largest = 0;
    for (int c = 0; c < 3; ++c) {
      const double error = ErrorOf(theirs[c], ours[c]);
      squares_ += error * error;
      largest = std::max(largest, error);
    }
    ++part_.rows;
    if (part_.rows == 1 || largest > part_.largest) {
      part_.largest = largest;
      part_.worst_row = row;
      part_.theirs = {theirs.x, theirs.y, theirs.z};
      part_.ours = {ours.x, ours.y, ours.z};
    }
    return largest;
  }

  PartErrors Finish() {
    part_.rms = part_.rows > 0 ? std::sqrt(squares_ / (3.0 * static_cast<double>(part_.rows))) : 0;
    return part_;
  }

 private:
  PartErrors part_;
  double squares_ = 0;
};

// ---- Errors by angle ----------------------------------------------------------------------------

// Sorts angles into columns: one for each angle if they are few, else ranges.
class AngleBins {
 public:
  explicit AngleBins(const std::vector<double>& degrees) {
    std::set<double> distinct;
    for (const double angle : degrees) {
      distinct.insert(Rounded(angle));
      if (distinct.size() > kMostDistinctAngles) break;
    }
    if (distinct.size() <= kMostDistinctAngles) {
      angles_.assign(distinct.begin(), distinct.end());
      for (const double angle : angles_) labels_.push_back(fmt::format("{:g}", angle));
      return;
    }
    const std::vector<int> edges = {0, 15, 30, 45, 60, 75, 85, 90, 180};
    for (size_t k = 0; k + 1 < edges.size(); ++k) {
      edges_.push_back(edges[k + 1]);
      labels_.push_back(fmt::format("{}-{}", edges[k], edges[k + 1]));
    }
  }

  size_t Of(double degrees) const {
    if (edges_.empty()) {
      const auto at = std::lower_bound(angles_.begin(), angles_.end(), Rounded(degrees));
      return static_cast<size_t>(at - angles_.begin());
    }
    const auto at = std::upper_bound(edges_.begin(), edges_.end() - 1, degrees);
    return static_cast<size_t>(at - edges_.begin());
  }
  const std::vector<std::string>& labels() const { return labels_; }

 private:
  static double Rounded(double degrees) { return std::round(degrees * 10) / 10; }

  std::vector<double> angles_, edges_;
  std::vector<std::string> labels_;
};

AngleErrors ByAngle(const std::vector<DirectionPair>& pairs, const std::vector<double>& errors) {
  std::vector<double> light, view;
  for (const DirectionPair& pair : pairs) {
    light.push_back(Degrees(pair.to_light.z));
    view.push_back(Degrees(pair.to_view.z));
  }
  const AngleBins of_light(light), of_view(view);
  AngleErrors table{of_light.labels(), of_view.labels(), {}};
  table.errors.assign(table.light.size() * table.view.size(), -1);
  for (size_t row = 0; row < pairs.size(); ++row) {
    if (errors[row] < 0) continue;
    double& cell =
        table.errors[of_light.Of(light[row]) * table.view.size() + of_view.Of(view[row])];
    cell = std::max(cell, errors[row]);
  }
  return table;
}

// ---- Diagnosis ----------------------------------------------------------------------------------

struct Residual {
  double rms = kInfinity, largest = kInfinity;
};

// The rows that hypotheses are judged by.
class Evidence {
 public:
  Evidence(const EvaluatedTable& theirs, const std::vector<size_t>& rows,
           const PreparedVariant& ours) {
    for (const size_t row : rows) {
      pairs_.push_back(theirs.pairs[row]);
      theirs_.push_back(theirs.f[row]);
    }
    ours_ = ValuesOf(ours);
    for (size_t i = 0; i < pairs_.size(); ++i) {
      scale_.push_back(MakeRgb([&](int c) {
        return 1 / std::max({std::abs(theirs_[i][c]), std::abs(ours_[i][c]), kLeastValue});
      }));
    }
  }

  size_t size() const { return pairs_.size(); }
  const std::vector<DirectionPair>& pairs() const { return pairs_; }
  const std::vector<Rgb>& theirs() const { return theirs_; }
  const std::vector<Rgb>& ours() const { return ours_; }
  const std::vector<Rgb>& scale() const { return scale_; }

  std::vector<Rgb> ValuesOf(const PreparedVariant& variant) const {
    std::vector<Rgb> values;
    values.reserve(pairs_.size());
    for (const auto& [l, v] : pairs_) values.push_back(variant.Evaluate(l, v));
    return values;
  }

  Residual ResidualOf(const std::vector<Rgb>& values) const {
    double squares = 0, largest = 0;
    for (size_t i = 0; i < values.size(); ++i) {
      for (int c = 0; c < 3; ++c) {
        const double error = std::abs(theirs_[i][c] - values[i][c]) * scale_[i][c];
        if (!std::isfinite(error)) return {};
        squares += error * error;
        largest = std::max(largest, error);
      }
    }
    return {std::sqrt(squares / std::max(1.0, 3.0 * static_cast<double>(values.size()))), largest};
  }

 private:
  std::vector<DirectionPair> pairs_;
  std::vector<Rgb> theirs_, ours_, scale_;
};

// The factor of all of f that fits best.
double BestFactor(const Evidence& evidence) {
  double both = 0, own = 0;
  for (size_t i = 0; i < evidence.size(); ++i) {
    for (int c = 0; c < 3; ++c) {
      const double ours = evidence.ours()[i][c] * evidence.scale()[i][c];
      both += ours * evidence.theirs()[i][c] * evidence.scale()[i][c];
      own += ours * ours;
    }
  }
  return own > 0 ? both / own : 1;
}

// Solves the symmetric system a x = b by elimination with pivots; empty if it is singular.
std::vector<double> Solve(std::vector<std::vector<double>> a, std::vector<double> b) {
  const size_t n = b.size();
  for (size_t k = 0; k < n; ++k) {
    size_t pivot = k;
    for (size_t i = k + 1; i < n; ++i) {
      if (std::abs(a[i][k]) > std::abs(a[pivot][k])) pivot = i;
    }
    std::swap(a[k], a[pivot]);
    std::swap(b[k], b[pivot]);
    if (!(std::abs(a[k][k]) > 1e-12)) return {};
    for (size_t i = k + 1; i < n; ++i) {
      const double factor = a[i][k] / a[k][k];
      for (size_t j = k; j < n; ++j) a[i][j] -= factor * a[k][j];
      b[i] -= factor * b[k];
    }
  }
  std::vector<double> x(n);
  for (size_t k = n; k-- > 0;) {
    double sum = b[k];
    for (size_t j = k + 1; j < n; ++j) sum -= a[k][j] * x[j];
    x[k] = sum / a[k][k];
  }
  return x;
}

// Fits factors of the lobes by least squares, if there are several lobes.
void FitLobes(const Evidence& evidence, const PreparedVariant& ours, TableCheck* check) {
  const size_t all = ours.lobes().size();
  std::vector<std::vector<Rgb>> values(all);
  std::vector<Rgb> row(all);
  for (const auto& [l, v] : evidence.pairs()) {
    ours.Evaluate(l, v, row);
    for (size_t k = 0; k < all; ++k) values[k].push_back(row[k]);
  }
  std::vector<size_t> lobes;
  for (size_t k = 0; k < all; ++k) {
    if (!std::all_of(values[k].begin(), values[k].end(), IsBlack)) lobes.push_back(k);
  }
  if (lobes.size() < 2) return;
  const auto dot = [&](const std::vector<Rgb>& a, const std::vector<Rgb>& b) {
    double sum = 0;
    for (size_t i = 0; i < evidence.size(); ++i) {
      for (int c = 0; c < 3; ++c) {
        const double scale = evidence.scale()[i][c];
        sum += a[i][c] * scale * b[i][c] * scale;
      }
    }
    return sum / static_cast<double>(evidence.size());
  };
  std::vector<std::vector<double>> a(lobes.size(), std::vector<double>(lobes.size()));
  std::vector<double> b(lobes.size());
  for (size_t i = 0; i < lobes.size(); ++i) {
    for (size_t j = 0; j < lobes.size(); ++j) a[i][j] = dot(values[lobes[i]], values[lobes[j]]);
    b[i] = dot(values[lobes[i]], evidence.theirs());
  }
  const std::vector<double> factors = Solve(a, b);
  if (factors.empty()) return;
  std::vector<Rgb> sum(evidence.size(), Rgb(0));
  for (size_t i = 0; i < lobes.size(); ++i) {
    for (size_t k = 0; k < sum.size(); ++k) sum[k] += values[lobes[i]][k] * factors[i];
  }
  check->fit_rms = evidence.ResidualOf(sum).rms;
  for (size_t i = 0; i < lobes.size(); ++i) {
    check->fit.push_back({ours.lobes()[lobes[i]], factors[i]});
  }
}

constexpr char kAsItIs[] = "as the material has them";

// Hypotheses that apply together.
struct Trial {
  Variant variant;
  std::vector<std::string> steps;
  HypothesisKind kind = HypothesisKind::kMistake;  // of the last one
  Residual residual;
};

class Diagnosis {
 public:
  Diagnosis(const Material& material, const Evidence& evidence, double tolerance,
            const std::function<void(double)>& on_progress)
      : material_(material),
        evidence_(evidence),
        tolerance_(tolerance),
        on_progress_(on_progress),
        hypotheses_(HypothesesOf(material)) {
    AddFittedFactor();
  }

  void Run(TableCheck* check) {
    const Trial start{{.material = material_}, {}, {}, evidence_.ResidualOf(evidence_.ours())};
    check->diagnosed_rms = start.residual.rms;
    Tell(0);
    const std::vector<Trial> singles = Extended(start, evidence_.ours());
    RankSingles(singles, start, check);
    RankChoices(singles, start, check);
    Explain(singles, start, check);
  }

 private:
  void Tell(double fraction) const {
    if (on_progress_) on_progress_(fraction);
  }

  void AddFittedFactor() {
    const double factor = BestFactor(evidence_);
    for (const double named : {M_PI, M_1_PI, 2.0, 0.5, 4.0, 0.25, 1.0}) {
      if (std::abs(factor / named - 1) < 1e-3) return;
    }
    hypotheses_.push_back({HypothesisKind::kMistake,
                           fmt::format("all of f is times {:.6g}", factor),
                           [factor](Variant* v) { v->factor *= factor; }});
  }

  // Residuals this small are all alike.
  double Floor() const { return tolerance_ / 100; }
  bool IsBetter(const Residual& a, const Residual& b) const {
    return std::max(a.rms, Floor()) < 0.99 * std::max(b.rms, Floor());
  }

  // Whether two evaluations differ by rounding alone.
  static bool AreAlike(const std::vector<Rgb>& a, const std::vector<Rgb>& b) {
    constexpr double kRounding = 1e-12;
    for (size_t i = 0; i < a.size(); ++i) {
      for (int c = 0; c < 3; ++c) {
        if (!(ErrorOf(a[i][c], b[i][c]) <= kRounding)) return false;
      }
    }
    return true;
  }

  // Each hypothesis, or those of a kind, on top of a trial, whose values are `values`. Those
  // without effect are left out.
  std::vector<Trial> Extended(const Trial& trial, const std::vector<Rgb>& values,
                              std::optional<HypothesisKind> kind = {}) const {
    std::vector<Trial> extended;
    for (const Hypothesis& hypothesis : hypotheses_) {
      if (kind && hypothesis.kind != *kind) continue;
      Tell(0.5);
      Trial next = trial;
      hypothesis.apply(&next.variant);
      const std::vector<Rgb> own = evidence_.ValuesOf(PreparedVariant(next.variant));
      if (AreAlike(own, values)) continue;
      next.steps.push_back(hypothesis.text);
      next.kind = hypothesis.kind;
      next.residual = evidence_.ResidualOf(own);
      extended.push_back(std::move(next));
    }
    return extended;
  }

  // The best of them; of those that are alike the first. Null if there is none.
  const Trial* BestOf(const std::vector<Trial>& trials) const {
    const Trial* best = nullptr;
    for (const Trial& trial : trials) {
      if (best == nullptr || IsBetter(trial.residual, best->residual)) best = &trial;
    }
    return best;
  }

  static RankedHypothesis Ranked(const Trial& trial) {
    return {trial.kind, fmt::format("{}", fmt::join(trial.steps, "; and ")), trial.residual.rms,
            trial.residual.largest};
  }
  static void Sort(std::vector<RankedHypothesis>* ranked) {
    std::stable_sort(ranked->begin(), ranked->end(),
                     [](const auto& a, const auto& b) { return a.rms < b.rms; });
  }

  void RankSingles(const std::vector<Trial>& singles, const Trial& start, TableCheck* check) const {
    for (const Trial& trial : singles) {
      if (trial.kind != HypothesisKind::kMistake) continue;
      if (trial.residual.rms < 0.9 * start.residual.rms) check->mistakes.push_back(Ranked(trial));
    }
    Sort(&check->mistakes);
    if (check->mistakes.size() > 5) check->mistakes.resize(5);
  }

  // Rules, single options, and the nearest rules with one other option.
  void RankChoices(const std::vector<Trial>& singles, const Trial& start, TableCheck* check) const {
    std::vector<RankedHypothesis> rules, options;
    const Trial* nearest = nullptr;
    for (const Trial& trial : singles) {
      if (trial.kind == HypothesisKind::kMistake) continue;
      const bool is_rules = trial.kind == HypothesisKind::kRules;
      (is_rules ? rules : options).push_back(Ranked(trial));
      if (is_rules && (nearest == nullptr || trial.residual.rms < nearest->residual.rms)) {
        nearest = &trial;
      }
    }
    if (nearest != nullptr) {
      const std::vector<Rgb> values = evidence_.ValuesOf(PreparedVariant(nearest->variant));
      for (const Trial& trial : Extended(*nearest, values, HypothesisKind::kChoice)) {
        options.push_back(Ranked(trial));
      }
    }
    if (options.empty()) return;
    Sort(&options);
    if (options.size() > 5) options.resize(5);
    check->choices = rules;
    check->choices.push_back(
        {HypothesisKind::kChoice, kAsItIs, start.residual.rms, start.residual.largest});
    check->choices.insert(check->choices.end(), options.begin(), options.end());
    Sort(&check->choices);
  }

  void Explain(const std::vector<Trial>& singles, const Trial& start, TableCheck* check) const {
    const Trial* const first = BestOf(singles);
    if (first == nullptr) return;
    Trial best = *first;
    if (best.residual.largest > tolerance_) best = WithSecondStep(singles, best);
    for (size_t step = 2; step < kMostSteps && step == best.steps.size(); ++step) {
      if (best.residual.largest <= tolerance_) break;
      const std::vector<Trial> next =
          Extended(best, evidence_.ValuesOf(PreparedVariant(best.variant)));
      const Trial* const better = BestOf(next);
      if (better == nullptr || better->residual.rms > kWorthAStep * best.residual.rms) break;
      best = *better;
    }
    const bool explains =
        best.residual.largest <= tolerance_ || best.residual.rms <= kExplains * start.residual.rms;
    if (!explains) return;
    check->explanation = best.steps;
    check->explained_rms = best.residual.rms;
    check->explained_largest = best.residual.largest;
    for (const Trial& trial : singles) {
      if (best.steps.size() > 1 || trial.steps == best.steps) continue;
      if (!IsBetter(best.residual, trial.residual)) check->also.push_back(Ranked(trial));
    }
  }

  // The best single trial, or the best of two steps if the second is worth it.
  Trial WithSecondStep(const std::vector<Trial>& singles, const Trial& single) const {
    std::vector<const Trial*> order;
    for (const Trial& trial : singles) order.push_back(&trial);
    std::stable_sort(order.begin(), order.end(), [](const Trial* a, const Trial* b) {
      return a->residual.rms < b->residual.rms;
    });
    if (order.size() > kTried) order.resize(kTried);
    Trial best = single;
    for (const Trial* const trial : order) {
      const std::vector<Trial> next =
          Extended(*trial, evidence_.ValuesOf(PreparedVariant(trial->variant)));
      const Trial* const better = BestOf(next);
      const double least = kWorthAStep * std::min(trial->residual.rms, single.residual.rms);
      if (better == nullptr || better->residual.rms > least) continue;
      if (IsBetter(better->residual, best.residual)) best = *better;
      if (best.residual.largest <= tolerance_) break;
    }
    return best;
  }

  const Material& material_;
  const Evidence& evidence_;
  double tolerance_;
  const std::function<void(double)>& on_progress_;
  std::vector<Hypothesis> hypotheses_;
};

// Up to kDiagnosedRows of the rows, evenly, and the worst one.
std::vector<size_t> ChosenRows(const std::vector<double>& errors, size_t worst) {
  std::vector<size_t> finite;
  for (size_t row = 0; row < errors.size(); ++row) {
    if (errors[row] >= 0) finite.push_back(row);
  }
  if (finite.size() <= kDiagnosedRows) return finite;
  std::vector<size_t> chosen = {worst};
  for (size_t i = 0; i + 1 < kDiagnosedRows; ++i) {
    chosen.push_back(finite[i * finite.size() / (kDiagnosedRows - 1)]);
  }
  return chosen;
}

// ---- Notes --------------------------------------------------------------------------------------

void NoteHeader(const BrdfTable& table, TableCheck* check) {
  const auto material = table.header.find("material");
  if (material == table.header.end() || !material->is_object()) return;
  std::vector<std::string> differences;
  for (const auto& [key, value] : material->items()) {
    const auto own = check->material.find(key);
    if (own != check->material.end() && *own == value) continue;
    differences.push_back(
        fmt::format("{} {}, here {}", key, JsonText(value),
                    own != check->material.end() ? JsonText(*own) : std::string("there is none")));
  }
  if (differences.empty()) return;
  const size_t count = differences.size();
  if (count > 4) differences.resize(4);
  check->notes.push_back(fmt::format("its header is of another material: {}{}",
                                     fmt::join(differences, "; "), count > 4 ? "; ..." : ""));
}

void NoteLobeSums(const EvaluatedTable& theirs, const std::vector<std::string>& lobes,
                  TableCheck* check) {
  for (const std::string& lobe : lobes) {
    if (!theirs.lobes.contains(lobe)) return;
  }
  size_t off = 0;
  for (size_t row = 0; row < theirs.f.size(); ++row) {
    Rgb sum(0, 0, 0);
    for (const auto& [name, values] : theirs.lobes) sum += values[row];
    for (int c = 0; c < 3; ++c) {
      if (ErrorOf(sum[c], theirs.f[row][c]) > check->tolerance) {
        ++off;
        break;
      }
    }
  }
  if (off > 0) {
    check->notes.push_back(
        fmt::format("its lobes do not sum to its f in {} of {} rows", off, theirs.f.size()));
  }
}

// The albedos at the views of the table.
PartErrors AlbedoErrors(const EvaluatedTable& theirs, const PreparedVariant& ours,
                        TableCheck* check) {
  ErrorSum sum("albedo");
  ViewAlbedos own(ours);
  size_t left_out = 0;
  for (size_t row = 0; row < theirs.pairs.size(); ++row) {
    const Vec3d& to_view = theirs.pairs[row].to_view;
    if (!(to_view.z > 0) || !IsFinite((*theirs.albedo)[row])) continue;
    if (own.size() >= kMostAlbedos && own.IsNew(to_view)) {
      ++left_out;
      continue;
    }
    sum.Add(row, (*theirs.albedo)[row], own.At(to_view));
  }
  if (left_out > 0) {
    check->notes.push_back(fmt::format("albedos are compared at {} views; {} rows are left out",
                                       kMostAlbedos, left_out));
  }
  return sum.Finish();
}

}  // namespace

TableCheck CheckTable(const Material& material, const BrdfTable& table, const std::string& file,
                      double tolerance, const std::function<void(double)>& on_progress) {
  const PreparedVariant ours({.material = material});
  const std::vector<std::string>& lobes = ours.lobes();
  const EvaluatedTable theirs =
      EvaluatedOf(table, file, ColumnsOf(material, /*albedo=*/true), lobes);
  TableCheck check;
  check.tolerance = tolerance;
  check.file = file;
  check.material = WholeMaterialJson(material);
  check.rows = theirs.pairs.size();
  check.notes = theirs.notes;
  NoteHeader(table, &check);
  NoteLobeSums(theirs, lobes, &check);
  if (HasMirror(ours.material())) {
    check.notes.emplace_back("the lobes of perfect mirrors are left out");
  }

  ErrorSum f("f"), pdf("pdf");
  std::vector<ErrorSum> of_lobes;
  for (const std::string& lobe : lobes) of_lobes.emplace_back(lobe);
  std::vector<Rgb> values(lobes.size());
  std::vector<double> errors(check.rows, -1);  // of f; -1 where theirs is not finite
  for (size_t row = 0; row < check.rows; ++row) {
    if (on_progress && row % 256 == 0) on_progress(0);
    const auto& [l, v] = theirs.pairs[row];
    ours.Evaluate(l, v, values);
    if (IsFinite(theirs.f[row])) {
      errors[row] =
          f.Add(row, theirs.f[row], std::accumulate(values.begin(), values.end(), Rgb(0)));
    } else {
      ++check.not_finite;
      if (check.not_finite_at.size() < 5) check.not_finite_at.push_back(PlaceOf(table, row));
    }
    for (size_t k = 0; k < lobes.size(); ++k) {
      const auto own = theirs.lobes.find(lobes[k]);
      if (own == theirs.lobes.end() || !IsFinite(own->second[row])) continue;
      of_lobes[k].Add(row, own->second[row], values[k]);
    }
    if (theirs.pdf && std::isfinite((*theirs.pdf)[row]) && l.z > 0 && v.z > 0) {
      pdf.Add(row, Rgb((*theirs.pdf)[row]),
              Rgb(ReflectionPdf(ours.material(), Vec3d(0, 0, 1), v, l, false)));
    }
  }
  check.f = f.Finish();
  check.ok = check.not_finite == 0 && check.f.largest <= tolerance;
  for (size_t k = 0; k < lobes.size(); ++k) {
    if (theirs.lobes.contains(lobes[k])) check.parts.push_back(of_lobes[k].Finish());
  }
  if (theirs.pdf) check.parts.push_back(pdf.Finish());
  if (theirs.albedo) check.parts.push_back(AlbedoErrors(theirs, ours, &check));
  const std::vector<size_t> chosen = ChosenRows(errors, check.f.worst_row);
  if (chosen.empty()) return check;

  check.angles = ByAngle(theirs.pairs, errors);
  std::vector<double> sorted;
  for (const double error : errors) {
    if (error >= 0) sorted.push_back(error);
  }
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  check.median = *middle;
  const DirectionPair& worst = theirs.pairs[check.f.worst_row];
  check.worst_at = fmt::format("{}: light {:.4g}, view {:.4g}, phi {:.4g} degrees",
                               PlaceOf(table, check.f.worst_row), Degrees(worst.to_light.z),
                               Degrees(worst.to_view.z), AzimuthOf(worst));
  if (check.f.largest <= tolerance) return check;
  if (std::ranges::all_of(theirs.f, [](const Rgb& f) { return IsBlack(f); })) {
    check.notes.emplace_back(
        "f is 0 in all rows: nothing was evaluated, or light or view lie below the surface");
  }
  const Evidence evidence(theirs, chosen, ours);
  check.diagnosed_rows = evidence.size();
  FitLobes(evidence, ours, &check);
  Diagnosis(material, evidence, tolerance, on_progress).Run(&check);
  return check;
}

}  // namespace nacre
