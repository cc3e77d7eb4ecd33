// SPDX-License-Identifier: Apache-2.0
#include "table/hypotheses.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include <fmt/format.h>

#include "color/transfer.h"
#include "scene/material_parameters.h"

namespace nacre {
namespace {

struct NamedFactor {
  double factor;
  const char* text;
};
constexpr NamedFactor kFactors[] = {{M_PI, "times pi: a 1/pi is missing"},
                                    {M_1_PI, "divided by pi once too often"},
                                    {2, "times 2"},
                                    {0.5, "times 1/2"},
                                    {4, "times 4: the 1/4 of the microfacet lobe is missing"},
                                    {0.25, "times 1/4"}};

class HypothesisList {
 public:
  explicit HypothesisList(const Material& material)
      : material_(material), prepared_({.material = material}) {}

  std::vector<Hypothesis> Make() {
    AddFactors();
    AddDirections();
    AddLobes();
    if (!material_.user) {
      model_ = ModelOf(material_);
      for (const MaterialParameter& parameter : model_->parameters) AddParameter(parameter);
      AddFormulas();
      for (const MaterialChoice& choice : model_->choices) AddChoice(choice);
    }
    return std::move(list_);
  }

 private:
  void Add(std::string text, std::function<void(Variant*)> apply,
           HypothesisKind kind = HypothesisKind::kMistake) {
    list_.push_back({kind, std::move(text), std::move(apply)});
  }

  void AddFactors() {
    for (const auto& [factor, text] : kFactors) {
      Add(fmt::format("all of f is {}", text),
          [factor = factor](Variant* v) { v->factor *= factor; });
    }
    Add("n.l is part of f", [](Variant* v) { ++v->cosines_of_light; });
    Add("n.v is part of f", [](Variant* v) { ++v->cosines_of_view; });
    Add("f is divided by n.l once too often", [](Variant* v) { --v->cosines_of_light; });
    Add("f is divided by n.v once too often", [](Variant* v) { --v->cosines_of_view; });
  }

  void AddDirections() {
    const auto add = [&](DirectionSlip slip, const char* text) {
      Add(text, [slip](Variant* v) { v->directions = slip; });
    };
    add(DirectionSlip::kSwapped, "light and view have changed places");
    add(DirectionSlip::kYUp, "y is taken for the normal: y and z have changed places");
    add(DirectionSlip::kTangentTurned, "tangent and bitangent have changed places");
    add(DirectionSlip::kLightReversed, "the light's direction is the one in which light travels");
    add(DirectionSlip::kViewReversed, "the view's direction is the one of sight, into the surface");
    add(DirectionSlip::kBothReversed, "both directions point into the surface");
  }

  // Whether a lobe reflects anything along a pair of directions off the highlight.
  std::vector<bool> LobesThatReflect() const {
    std::vector<bool> reflect(prepared_.lobes().size(), false);
    std::vector<Rgb> values(reflect.size());
    for (const double x : {0.1, 0.5, 0.9}) {
      const Vec3d direction(x, 0, std::sqrt(1 - x * x));
      for (const Vec3d& view : {direction, Vec3d(-x, 0, direction.z)}) {
        prepared_.Evaluate(direction, view, values);
        for (size_t k = 0; k < values.size(); ++k) {
          if (!IsBlack(values[k])) reflect[k] = true;
        }
      }
    }
    return reflect;
  }

  void AddLobes() {
    const std::vector<bool> reflect = LobesThatReflect();
    if (std::count(reflect.begin(), reflect.end(), true) < 2) return;
    for (size_t k = 0; k < reflect.size(); ++k) {
      if (!reflect[k]) continue;
      const std::string& lobe = prepared_.lobes()[k];
      const auto add = [&](double factor, const std::string& text) {
        Add(text, [lobe, factor](Variant* v) { v->lobe_factors.emplace_back(lobe, factor); });
      };
      add(0, fmt::format("the lobe \"{}\" is missing", lobe));
      for (const auto& [factor, text] : kFactors) {
        add(factor, fmt::format("the lobe \"{}\" is {}", lobe, text));
      }
    }
  }

  void AddValue(const MaterialParameter& parameter, const Rgb& value, const std::string& text) {
    const Rgb was = parameter.get(material_);
    bool is_new = false, is_finite = true;
    for (int c = 0; c < 3; ++c) {
      is_new = is_new || std::abs(value[c] - was[c]) > 1e-9 * (1 + std::abs(was[c]));
      is_finite = is_finite && std::isfinite(value[c]);
    }
    if (!is_new || !is_finite || !parameter.range.Contains(value)) return;
    const auto shown = [&](const Rgb& v) {
      return parameter.is_color ? fmt::format("[{:.4g}, {:.4g}, {:.4g}]", v.x, v.y, v.z)
                                : fmt::format("{:.4g}", v.x);
    };
    Add(fmt::format("{} (as if {} were {})", text, parameter.name, shown(value)),
        [set = parameter.set, value](Variant* v) { set(v->material, value); });
  }

  template <class Change>
  void AddChanged(const MaterialParameter& parameter, const Change& change,
                  const std::string& text) {
    const Rgb was = parameter.get(material_);
    AddValue(parameter, MakeRgb([&](int c) { return change(was[c]); }), text);
  }

  void AddParameter(const MaterialParameter& parameter) {
    const std::string name(parameter.name);
    if (name == "emission" || name == "opacity" || name == "opacity_cutoff") return;
    const auto contains = [&](std::string_view part) { return name.find(part) != name.npos; };
    const auto square = [](double x) { return x * x; };
    const auto root = [](double x) { return std::sqrt(x); };
    if (contains("roughness") && !contains("anisotropy")) {
      AddChanged(parameter, root, name + " is taken for alpha, which is its square");
      AddChanged(parameter, square, name + " is squared once too often on its way to alpha");
    } else if (contains("ior") || name == "eta") {
      AddChanged(
          parameter, [](double x) { return 1 / x; }, name + " is inverted");
    } else if (name == "shininess") {
      AddChanged(
          parameter, [](double x) { return 4 * x; },
          "the exponent is four times as large, as between Phong and Blinn-Phong");
      AddChanged(
          parameter, [](double x) { return x / 4; },
          "the exponent is a fourth, as between Blinn-Phong and Phong");
    } else if (contains("_deg")) {
      AddChanged(
          parameter, [](double x) { return -x; }, name + " is turned the other way");
      AddChanged(
          parameter, [](double x) { return x < 0 ? x + 90 : x - 90; },
          name + " is off by a right angle");
      AddChanged(
          parameter, [](double x) { return std::remainder(x * 180 / M_PI, 360); },
          name + " is taken for radians");
    } else {
      AddChanged(parameter, square, name + " is squared, as if applied twice");
      AddChanged(parameter, root, "the root is taken of " + name);
    }
    if (parameter.is_color && name != "eta" && name != "k") {
      AddChanged(
          parameter, [](double x) { return x <= 1 ? SrgbOetf(x) : x; },
          name + " is gamma-encoded: sRGB codes are taken for linear values");
      AddChanged(
          parameter, [](double x) { return x <= 1 ? SrgbEotf(x) : x; },
          name + " is decoded from sRGB, though it is linear");
      const Rgb was = parameter.get(material_);
      AddValue(parameter, Rgb(was.z, was.y, was.x), name + " has red and blue changed places");
    }
    AddValue(parameter, parameter.get(model_->make()), name + " is left at its default");
  }

  void AddFormula(FormulaSlip slip, const char* text) {
    Add(text, [slip](Variant* v) { v->formula |= slip; });
  }

  void AddFormulas() {
    const ShadingMaterial& shading = prepared_.material();
    const auto* const model = std::get_if<MicrofacetModel>(&shading.model);
    const bool layered = !shading.layers.empty() || !shading.coats.empty();
    if (model != nullptr && !model->delta) {
      if (model->fresnel == FresnelForm::kF82 || model->fresnel == FresnelForm::kOpenPbr) {
        AddFormula(kNoF82Clamp, "F82's curve is not clamped to [0, 1]");
      }
      if (model->compensation == Compensation::kKullaConty) {
        AddFormula(kF0ForAverage, "the compensation has F0 for the average of Fresnel's curve");
      }
      if (model->compensation == Compensation::kTurquin) {
        AddFormula(kAverageForF0, "the compensation has the average of Fresnel's curve for F0");
      }
      if (model->compensation != Compensation::kNone) {
        AddFormula(kFullyCompensated, "the compensation is white: it lacks Fresnel's colour");
      }
      AddFormula(kFresnelAtNormal, "Fresnel's curve is taken at n.h, not at v.h");
      AddFormula(kFresnelAtView, "Fresnel's curve is taken at n.v, not at v.h");
      AddFormula(kFresnelAtLight, "Fresnel's curve is taken at n.l, not at v.h");
      AddFormula(kNoShadowing, "the shadowing term G is missing");
    }
    const bool covered = model != nullptr && model->coupling == DiffuseCoupling::kAlbedoScaled;
    if (layered || (covered && model->reciprocal)) {
      AddFormula(kViewForLight, "the view's cosine is taken for the light's, too, in layering");
    }
    if (layered || covered) {
      AddFormula(kLightForView, "the light's cosine is taken for the view's in layering");
      AddFormula(kNothingCovered, "what lies above takes no light from what lies below");
    }
    if (covered && !model->reciprocal) {
      AddFormula(kCoveredBothWays,
                 "the base is left by 1 - E of the view times 1 - E of the light");
    }
  }

  void AddChoice(const MaterialChoice& choice) {
    const bool is_rules = choice.name == "rules";
    if ((choice.get == nullptr && !is_rules) || choice.name == "sides") return;
    for (size_t option = 0; option < choice.options.size(); ++option) {
      Add(
          fmt::format("{}: {}", choice.name, choice.options[option]),
          [set = choice.set, option](Variant* v) { set(v->material, option); },
          is_rules ? HypothesisKind::kRules : HypothesisKind::kChoice);
    }
  }

  const Material& material_;
  PreparedVariant prepared_;
  const MaterialModel* model_ = nullptr;
  std::vector<Hypothesis> list_;
};

}  // namespace

std::vector<Hypothesis> HypothesesOf(const Material& material) {
  return HypothesisList(material).Make();
}

}  // namespace nacre
