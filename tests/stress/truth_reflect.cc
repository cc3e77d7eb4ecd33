// SPDX-License-Identifier: Apache-2.0
#include "stress/truth_reflect.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "scene/material_parameters.h"

namespace nacre {
namespace {

constexpr TruthReal kPi = 3.14159265358979323846264338327950288L;

TruthVec ToTruth(const Rgb& c) { return {c.x, c.y, c.z}; }

// cos^n of an angle given by its cosine and its squared sine: near the axis the sine tells, and an
// exponent of 0 is a constant.
TruthReal LobePower(TruthReal cosine, TruthReal sine2, TruthReal n) {
  if (n == 0) return 1;
  if (cosine <= 0) return 0;
  return std::exp(n * (sine2 < 0.25L ? std::log1p(-sine2) / 2 : std::log(cosine)));
}

TruthReflection Reflect(const LambertMaterial& m, const TruthVec& n, const TruthVec& l,
                        const TruthVec& /*v*/) {
  return {ToTruth(m.albedo) * (n.dot(l) / kPi), {0, 0, 0}};
}

// Phong 1975: R = 2 (N.L) N - L; Blinn 1977: H = (L + V) / |L + V|.
TruthReflection Reflect(const PhongMaterial& m, const TruthVec& n, const TruthVec& l,
                        const TruthVec& v) {
  const bool blinn = m.model == PhongModel::kBlinnPhong;
  const TruthReal exponent = m.shininess;
  TruthReal lobe = 0;
  if (blinn) {
    const TruthVec sum = l + v;
    const TruthReal length2 = sum.dot(sum);
    const TruthVec across = n.cross(sum);
    // Light and viewer opposed have no half vector; a constant lobe asks for none.
    if (exponent == 0) {
      lobe = 1;
    } else if (length2 > 0) {
      lobe = LobePower(n.dot(sum) / std::sqrt(length2), across.dot(across) / length2, exponent);
    }
  } else {
    const TruthVec r = n * (2 * n.dot(l)) - l;
    const TruthVec across = r.cross(v);
    lobe = LobePower(r.dot(v), across.dot(across), exponent);
  }
  TruthReal diffuse = n.dot(l);
  if (m.model == PhongModel::kModifiedPhong) lobe *= n.dot(l);
  if (m.convention == PhongConvention::kRadiometric) {
    diffuse /= kPi;
    lobe *=
        blinn ? (exponent + 2) * (exponent + 4) / (8 * kPi * (std::exp2(-exponent / 2) + exponent))
              : (exponent + 2) / (2 * kPi);
  }
  return {ToTruth(m.kd * m.color) * diffuse, ToTruth(m.ks) * lobe};
}

// Smith's Lambda as a root: sqrt(a^2 + (1 - a^2) x^2).
TruthReal SmithRoot(TruthReal x, TruthReal a) { return std::sqrt(a * a + (1 - a * a) * x * x); }

// G / (4 n.l n.v).
TruthReal Visibility(Shadowing shadowing, TruthReal nl, TruthReal nv, TruthReal roughness) {
  const TruthReal a = roughness * roughness;
  if (shadowing == Shadowing::kHeightCorrelated) {  // Heitz 2014, eq. 99
    return 1 / (2 * (nl * SmithRoot(nv, a) + nv * SmithRoot(nl, a)));
  }
  if (shadowing == Shadowing::kSeparable) {  // Walter et al. 2007, eq. 34
    return 1 / ((nl + SmithRoot(nl, a)) * (nv + SmithRoot(nv, a)));
  }
  // Karis 2013
  const TruthReal k =
      shadowing == Shadowing::kSchlickIbl ? a / 2 : (roughness + 1) * (roughness + 1) / 8;
  return 1 / (4 * (nl * (1 - k) + k) * (nv * (1 - k) + k));
}

// A GGX lobe without its Fresnel term, n.l included, and the angle that the term is a function of.
struct Lobe {
  TruthReal value = 0;
  TruthReal one_minus_vh = 1;
};

// Walter et al. 2007, eq. 33.
template <class Microfacet>
Lobe GgxLobe(const Microfacet& m, const TruthVec& n, const TruthVec& l, const TruthVec& v) {
  const TruthReal roughness = m.roughness;
  const TruthReal a = roughness * roughness;
  const TruthReal nl = n.dot(l);
  const TruthReal nv = std::max(n.dot(v), TruthReal{0});
  const TruthVec sum = l + v;
  const TruthReal length2 = sum.dot(sum);
  Lobe lobe;
  if (!(length2 > 0)) return lobe;
  const TruthVec across = n.cross(sum);
  const TruthReal cosine2 = n.dot(sum) * n.dot(sum) / length2;
  const TruthReal root = cosine2 * a * a + across.dot(across) / length2;
  constexpr TruthReal kDelta = 0x1p-40L;  // the model's own limit: narrower lobes do not show
  if (a >= kDelta && n.dot(sum) > 0) {
    lobe.value = a * a / (kPi * root * root) * Visibility(m.shadowing, nl, nv, roughness) * nl;
  }
  const TruthVec apart = l - v;  // 1 - v.h = |l - v|^2 / (4 (1 + v.h))
  lobe.one_minus_vh = apart.dot(apart) / (4 + 2 * std::sqrt(length2));
  return lobe;
}

// Schlick 1994, eq. 15.
TruthReal Schlick(TruthReal f0, TruthReal one_minus_vh) {
  return f0 + (1 - f0) * std::pow(one_minus_vh, 5);
}

// Fresnel's equations as they are written, with a complex index, averaged over both polarisations.
TruthReal Fresnel(TruthReal eta, TruthReal k, TruthReal one_minus_vh) {
  using Complex = std::complex<TruthReal>;
  const TruthReal cosine = 1 - one_minus_vh;
  const Complex index(eta, -k);
  const Complex square = index * index;
  const Complex root = std::sqrt(square - one_minus_vh * (2 - one_minus_vh));
  const Complex s = (cosine - root) / (cosine + root);
  const Complex p = (square * cosine - root) / (square * cosine + root);
  return (std::norm(s) + std::norm(p)) / 2;
}

TruthReflection Reflect(const MetallicRoughnessMaterial& m, const TruthVec& n, const TruthVec& l,
                        const TruthVec& v) {
  const Lobe lobe = GgxLobe(m, n, l, v);
  TruthReflection out;
  for (int c = 0; c < 3; ++c) {
    const TruthReal base = m.base_color[c];
    const TruthReal metallic = m.metallic;
    const TruthReal fresnel =
        Schlick(TruthReal{0.04} * (1 - metallic) + base * metallic, lobe.one_minus_vh);
    out.diffuse[c] = (1 - fresnel) * (1 - metallic) * base / kPi * n.dot(l);
    out.specular[c] = fresnel * lobe.value;
  }
  return out;
}

TruthReflection Reflect(const ConductorMaterial& m, const TruthVec& n, const TruthVec& l,
                        const TruthVec& v) {
  const Lobe lobe = GgxLobe(m, n, l, v);
  TruthReflection out;
  for (int c = 0; c < 3; ++c) {
    out.specular[c] = Fresnel(m.eta[c], m.k[c], lobe.one_minus_vh) * lobe.value;
  }
  return out;
}

TruthReflection Reflect(const DielectricMaterial& m, const TruthVec& n, const TruthVec& l,
                        const TruthVec& v) {
  const Lobe lobe = GgxLobe(m, n, l, v);
  const TruthReal fresnel = Fresnel(m.ior, 0, lobe.one_minus_vh);
  TruthReflection out;
  for (int c = 0; c < 3; ++c) {
    out.diffuse[c] = (1 - fresnel) * m.base_color[c] / kPi * n.dot(l);
    out.specular[c] = fresnel * lobe.value;
  }
  return out;
}

// The mean of Fresnel's equations over the hemisphere of directions, by the midpoint rule.
TruthReal MeanFresnel(TruthReal eta, TruthReal k) {
  constexpr int kSteps = 2000;
  TruthReal sum = 0;
  for (int i = 0; i < kSteps; ++i) {
    const TruthReal cosine = (i + TruthReal{0.5}) / kSteps;
    sum += 2 * cosine * Fresnel(eta, k, 1 - cosine) / kSteps;
  }
  return sum;
}

}  // namespace

TruthReflection ReflectTruth(const Material& material, const TruthVec& normal,
                             const TruthVec& to_light, const TruthVec& to_view) {
  if (normal.dot(to_light) <= 0) return {};
  if (const auto* lambert = std::get_if<LambertMaterial>(&material.model)) {
    return Reflect(*lambert, normal, to_light, to_view);
  }
  if (const auto* phong = std::get_if<PhongMaterial>(&material.model)) {
    return Reflect(*phong, normal, to_light, to_view);
  }
  if (const auto* ggx = std::get_if<MetallicRoughnessMaterial>(&material.model)) {
    return Reflect(*ggx, normal, to_light, to_view);
  }
  if (const auto* conductor = std::get_if<ConductorMaterial>(&material.model)) {
    return Reflect(*conductor, normal, to_light, to_view);
  }
  if (const auto* dielectric = std::get_if<DielectricMaterial>(&material.model)) {
    return Reflect(*dielectric, normal, to_light, to_view);
  }
  throw std::invalid_argument("this reflection model has no truth");
}

TruthVec AmbientTruth(const Material& material) {
  if (const auto* lambert = std::get_if<LambertMaterial>(&material.model)) {
    return ToTruth(lambert->albedo);
  }
  if (const auto* phong = std::get_if<PhongMaterial>(&material.model)) {
    return ToTruth(phong->color * phong->ka);
  }
  if (const auto* ggx = std::get_if<MetallicRoughnessMaterial>(&material.model)) {
    return ToTruth(ggx->base_color);
  }
  if (const auto* conductor = std::get_if<ConductorMaterial>(&material.model)) {
    TruthVec mean;
    for (int c = 0; c < 3; ++c) mean[c] = MeanFresnel(conductor->eta[c], conductor->k[c]);
    return mean;
  }
  if (const auto* dielectric = std::get_if<DielectricMaterial>(&material.model)) {
    const TruthReal gloss = MeanFresnel(dielectric->ior, 0);
    return TruthVec(gloss) + ToTruth(dielectric->base_color) * (1 - gloss);
  }
  throw std::invalid_argument("this reflection model has no truth");
}

void UsePlainForms(Scene* scene) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 3> kPlain = {{
      {"compensation", "none"},
      {"diffuse_coupling", "one_minus_fresnel"},
      {"fresnel", "exact"},
  }};
  for (Material& material : scene->materials) {
    const MaterialModel* const model = ModelOf(material);
    if (model == nullptr) continue;
    for (const MaterialChoice& choice : model->choices) {
      for (const auto& [name, wanted] : kPlain) {
        if (choice.name != name) continue;
        const auto option = std::find(choice.options.begin(), choice.options.end(), wanted);
        if (option == choice.options.end())
          throw std::invalid_argument("no plain form by its name");
        choice.set(material, static_cast<size_t>(option - choice.options.begin()));
      }
    }
  }
}

}  // namespace nacre
