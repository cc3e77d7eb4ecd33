// SPDX-License-Identifier: Apache-2.0
// tests/shading/lobe_coverage_test.cc: whatever a reflection model reflects, some sampling strategy
// meets, with a pdf that bounds what one sample can be: directions by the lobe for the specular
// part, by the cosine for the diffuse part, and nothing else, as under skies without light samples.
#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "base/float_mode.h"
#include "brdf/albedo_integral.h"
#include "catch.h"
#include "scene/material_parameters.h"
#include "shading/anisotropic_lobe.h"
#include "shading/lobe_sample.h"
#include "shading/scalar_bsdf.h"
#include "shading/shade.h"
#include "targets.h"

namespace nacre {
namespace {

constexpr size_t kCoverageHits = kBatchCapacity;

// A batch of hits that are all seen from n.v.
class SampledHits {
 public:
  SampledHits(const ShadingMaterial& material, double n_dot_v) : material_(material) {
    light_.form = LightForm::kGiven;
    light_.color = Rgb(1);
    hits_.count = kCoverageHits;
    const double sine = std::sqrt((1 - n_dot_v) * (1 + n_dot_v));
    for (size_t i = 0; i < kCoverageHits; ++i) {
      const double turn = 2 * M_PI * static_cast<double>(i) / kCoverageHits;
      hits_.normal.z[i] = 1;
      hits_.to_view.x[i] = sine * std::cos(turn);
      hits_.to_view.y[i] = sine * std::sin(turn);
      hits_.to_view.z[i] = n_dot_v;
    }
    PrepareSurface(hits_, &surface_);
    PrepareRun(material, 0, kCoverageHits, &surface_);
  }

  MaterialHits Hits() const { return {material_, hits_, surface_, 0, kCoverageHits}; }

  void Sample(const float* u, const float* v) {
    SampleLobe(Hits(), u, v, &scratch_, &lit_.light_vector);
    Shade();
  }

  void Look(const std::function<Vec3f(size_t)>& to_light) {
    for (size_t i = 0; i < kCoverageHits; ++i) {
      const Vec3f l = to_light(i);
      lit_.light_vector.x[i] = l.x;
      lit_.light_vector.y[i] = l.y;
      lit_.light_vector.z[i] = l.z;
    }
    Shade();
  }

  double Pdf(size_t i) const { return pdf_[i]; }
  double Specular(size_t i) const { return radiance_.specular.y[i]; }
  double Diffuse(size_t i) const { return radiance_.diffuse.y[i]; }
  double NDotL(size_t i) const { return lit_.light_vector.z[i]; }

 private:
  void Shade() {
    for (size_t i = 0; i < kCoverageHits; ++i)
      lit_.irradiance[i] = lit_.light_vector.z[i] > 0 ? 1.0f : 0.0f;
    LobePdf(Hits(), lit_, &scratch_, pdf_.data());
    ShadeRun({Hits(), light_, &lit_, &radiance_}, &scratch_);
  }

  const ShadingMaterial& material_;
  HitBatch hits_;
  Surface surface_;
  ShadingLight light_;
  LightBatch lit_;
  ShadeScratch scratch_;
  ReflectedRadiance radiance_;
  AlignedArray<float> pdf_{kCoverageHits};
};

struct Surfaced {
  std::string name;
  Material material;
};

// Every choice of every model with every other, at widths from a mirror's on: the Cartesian product
// of the options, and of the ends of what is mixed.
std::vector<Surfaced> AllCombinations() {
  std::vector<Surfaced> all;
  for (const MaterialModel& model : MaterialModels()) {
    std::vector<Surfaced> made = {{std::string(model.name), model.make()}};
    for (const MaterialChoice& choice : model.choices) {
      if (choice.get == nullptr) continue;               // a preset
      if (choice.name == "iridescence_model") continue;  // does nothing without a film
      // Of OpenPBR's options, which are millions together, those of the lobe by itself.
      const bool of_lobe = choice.name == "smith" || choice.name == "compensation";
      if (model.name == "open_pbr" && !of_lobe) continue;
      std::vector<Surfaced> more;
      for (const Surfaced& one : made) {
        for (size_t option = 0; option < choice.options.size(); ++option) {
          more.push_back(one);
          choice.set(more.back().material, option);
          more.back().name += " " + std::string(choice.options[option]);
        }
      }
      made = std::move(more);
    }
    const auto vary = [&](const char* name, const std::vector<double>& values) {
      const MaterialParameter* const parameter = FindParameter(model, name);
      if (parameter == nullptr) return;
      std::vector<Surfaced> more;
      for (const Surfaced& one : made) {
        for (const double value : values) {
          more.push_back(one);
          parameter->set(more.back().material, Rgb(value));
          more.back().name += " " + std::string(name) + " " + std::to_string(value);
        }
      }
      made = std::move(more);
    };
    vary("roughness", {0, 0.01, 0.1, 0.4, 1});
    vary("specular_roughness", {0, 0.01, 0.1, 0.4, 1});
    for (const char* ratio : {"anisotropy", "specular_roughness_anisotropy"}) vary(ratio, {0, 0.8});
    for (const char* mix : {"metallic", "base_metalness"}) vary(mix, {0, 0.5, 1});
    vary("f82_tint", {1, 0.6});
    // Of a material that is no metal the tint does not show.
    std::erase_if(made, [](const Surfaced& one) {
      const auto* mixed = std::get_if<MetallicRoughnessMaterial>(&one.material.model);
      return mixed != nullptr && mixed->metallic == 0 && mixed->f82_tint != Rgb(1);
    });
    vary("shininess", {0, 1e-30, 0.5, 20, 1e4});
    for (const char* white : {"base_color", "albedo", "color"}) vary(white, {1});
    all.insert(all.end(), made.begin(), made.end());
  }
  // Anisotropic ones last: the others keep their draws. Schlick's forms of shadowing ignore it.
  const auto is_isotropic = [](const Surfaced& one) { return !IsAnisotropic(one.material); };
  std::stable_partition(all.begin(), all.end(), is_isotropic);
  std::erase_if(all, [&](const Surfaced& one) {
    const bool is_schlick = one.name.find("schlick_") != std::string::npos;
    return is_schlick && !is_isotropic(one);
  });
  return all;
}

// Angles of view: straight, slanted, grazing, and where rounding leaves n.v at or below 0.
constexpr double kViews[] = {1, 0.6, 0.1, 1e-3, 0, -1e-7};

TEST_CASE("wherever a model reflects light there is a strategy that looks", "[long]") {
  const FlushDenormals flush;
  ForEachTarget([](Target) {
    // Drawn once, and taken from another place on by each material and view.
    std::mt19937 random(1);
    std::uniform_real_distribution<double> unit(0, 1);
    std::vector<Vec3f> directions(101 * kCoverageHits);
    for (size_t i = 0; i < directions.size(); ++i) {
      // From zenith to horizon evenly in the logarithm of n.l, too.
      const double z = i % 2 == 0 ? unit(random) : std::pow(10, -6 * unit(random));
      const double turn = 2 * M_PI * unit(random), sine = std::sqrt(1 - z * z);
      directions[i] = Vec3f(Vec3d(sine * std::cos(turn), sine * std::sin(turn), z));
    }
    size_t reflecting = 0, first = 0;
    for (const Surfaced& surfaced : AllCombinations()) {
      CAPTURE(surfaced.name);
      const ShadingMaterial material = PrepareMaterial(surfaced.material);
      for (const double n_dot_v : kViews) {
        CAPTURE(n_dot_v);
        SampledHits hits(material, n_dot_v);
        hits.Look([&](size_t i) { return directions[first + i]; });
        first = (first + kCoverageHits) % directions.size();
        for (size_t i = 0; i < kCoverageHits; ++i) {
          if (hits.Specular(i) > 0) ++reflecting;
          // Pdfs may leave float's range where lobes do: 1e-30 of a lobe's part is nothing.
          // Where n.v is below 0 by its rounding, so is the half vector of light that grazes as
          // much.
          if (n_dot_v < 0 && hits.NDotL(i) < 3e-7) continue;
          if (hits.Specular(i) > 1e-30 && !(hits.Pdf(i) > 0)) {
            CAPTURE(i, hits.Specular(i), hits.Diffuse(i), hits.NDotL(i), hits.Pdf(i));
            FAIL("reflects where nothing looks");
          }
        }
      }
    }
    CHECK(reflecting > 1'000'000);
  });
}

// Over the hemisphere by the midpoint rule, evenly in both angles: for wide lobes that are not seen
// at grazing angles.
double QuadratureOfSpecular(const ShadingMaterial& material, double n_dot_v) {
  constexpr size_t kAzimuths = 128, kRings = 512, kRingsAtOnce = kCoverageHits / kAzimuths;
  SampledHits hits(material, n_dot_v);
  double sum = 0;
  const double step = M_PI / 2 / kRings;
  const auto angle = [&](size_t ring) { return (static_cast<double>(ring) + 0.5) * step; };
  for (size_t first = 0; first < kRings; first += kRingsAtOnce) {
    hits.Look([&](size_t i) {
      // Each viewer has an azimuth of its own; the light's is relative to that.
      const double viewer = static_cast<double>(i) / kCoverageHits;
      const double relative = (static_cast<double>(i % kAzimuths) + 0.5) / kAzimuths;
      const double turn = 2 * M_PI * (viewer + relative);
      const double theta = angle(first + i / kAzimuths);
      return Vec3f(Vec3d(std::sin(theta) * std::cos(turn), std::sin(theta) * std::sin(turn),
                         std::cos(theta)));
    });
    for (size_t i = 0; i < kCoverageHits; ++i) {
      sum += hits.Specular(i) * std::sin(angle(first + i / kAzimuths));
    }
  }
  return sum * step * 2 * M_PI / kAzimuths;
}

// The green albedo of a lobe by quadrature of its Fresnel curve, compensation included.
double AlbedoOfLobe(const MicrofacetModel& model, double roughness, double n_dot_v) {
  const auto integral = [&](const auto& term) {
    return AlbedoOf(model.shadowing, roughness, n_dot_v, [&](double v_dot_h, double one_minus_vh) {
      return term(model, v_dot_h, one_minus_vh)[1];
    });
  };
  const double one = AlbedoOfOne(model.shadowing, roughness, n_dot_v);
  const double single = integral(FresnelOf);
  switch (model.compensation) {
    case Compensation::kTurquin:
      return single + (1 / one - 1) * integral(TurquinTerm);
    case Compensation::kKullaConty:
      return single + model.f_multiple[1] * (1 - one);
    case Compensation::kNone:
      break;
  }
  return single;
}

TEST_CASE("samples of every lobe have its albedo for their mean, and none is out of proportion",
          "[long]") {
  const FlushDenormals flush;
  std::mt19937 random(1);
  std::uniform_real_distribution<float> unit(0, 1);
  AlignedArray<float> u(kCoverageHits), v(kCoverageHits);
  for (const Surfaced& surfaced : AllCombinations()) {
    const ShadingMaterial material = PrepareMaterial(surfaced.material);
    if (!HasSampledLobe(material)) continue;
    const auto* microfacet = std::get_if<MicrofacetModel>(&material.model);
    const bool mirror = HasDeltaLobe(material);
    const auto* phong = std::get_if<PhongFamilyModel>(&material.model);
    for (const double n_dot_v : {1.0, 0.6, 0.1, 1e-3}) {
      CAPTURE(surfaced.name, n_dot_v);
      SampledHits hits(material, n_dot_v);
      double sum = 0, squares = 0, largest = 0;
      constexpr int kBatches = 8;
      for (int k = 0; k < kBatches; ++k) {
        for (size_t i = 0; i < kCoverageHits; ++i) {
          u[i] = unit(random);
          v[i] = unit(random);
        }
        hits.Sample(u.data(), v.data());
        for (size_t i = 0; i < kCoverageHits; ++i) {
          const double value = hits.Pdf(i) > 0 ? hits.Specular(i) / hits.Pdf(i) : 0;
          REQUIRE(std::isfinite(value));
          sum += value;
          squares += value * value;
          largest = std::max(largest, value);
        }
      }
      const double count = double{kBatches} * kCoverageHits;
      const double mean = sum / count;
      const double error = std::sqrt(std::max(squares / count - mean * mean, 0.0) / count);
      // The albedos of anisotropic lobes are held in bsdf_test.cc.
      if (microfacet != nullptr && microfacet->anisotropic) continue;
      double expected = 0, tolerance = 0;
      if (microfacet != nullptr && !mirror) {
        expected = AlbedoOfLobe(*microfacet, std::sqrt(microfacet->alpha), n_dot_v);
        tolerance = 1e-4;  // of the fits that compensation goes by (brdf/albedo.h)
      } else if (microfacet != nullptr) {
        // Of a mirror Kulla and Conty's part alone; the mirror's own is seen where it looks.
        expected = microfacet->f_multiple[1] * AlbedoLoss(microfacet->albedo.lobe, n_dot_v);
        tolerance = 1e-4;
      } else {
        if (phong->shininess > 100 || n_dot_v < 0.1) continue;
        expected = QuadratureOfSpecular(material, n_dot_v);
        tolerance = 1e-3 * expected;
      }
      // What is as rare as five in all samples, these may lack.
      tolerance += 5 * error + 5 * largest / count;
      CAPTURE(mean, error, expected, largest);
      CHECK(std::abs(mean - expected) <= tolerance);
      if (microfacet == nullptr) continue;
      CHECK(std::sqrt(squares / count) <= 2);
      // G2 / G1 is 1 at most, and Turquin's scale at most 1 / E = 3.3 of it. Of a smooth surface
      // with the lesson's masking E goes to 0 for grazing viewers, and what is left of it comes
      // from the lobe's tail as much as from its peak: there G2 is the lesson's G1(v) at most.
      double bound = 3.5;
      if (microfacet->shadowing == Shadowing::kSchlickDirect &&
          microfacet->compensation == Compensation::kTurquin && n_dot_v < 0.1) {
        const double k = microfacet->schlick_k;
        const double lesson = n_dot_v / (n_dot_v * (1 - k) + k);
        const double smith = 2 * n_dot_v / (n_dot_v + SmithRoot(n_dot_v, microfacet->alpha));
        const double float_terms = 1 + 1e-3;
        bound = std::max(
            bound, float_terms * lesson / smith / AlbedoOne(microfacet->albedo.lobe, n_dot_v));
      }
      CHECK(largest <= bound);
    }
  }
}

}  // namespace
}  // namespace nacre
