// shading/mapped_kernel.cc: what maps make of a material at each hit, and the products of that with
// a light. The arithmetic is that of material.cc and shade.cc, operation by operation, in double:
// where a map is constant, the bits are those of the constant material. Plain loops, which the
// compiler makes vectors of for each target.
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "brdf/albedo_table.h"
#include "brdf/eon.h"
#include "brdf/fresnel.h"
#include "brdf/fresnel_average.h"
#include "brdf/multi_scatter.h"
#include "brdf/phong.h"
#include "scene/limits.h"
#include "shading/mapped.h"
#include "shading/texture_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shading/mapped_kernel.cc"
#include "hwy/foreach_target.h"

#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {
namespace {

// One channel of hits [begin, end).
template <class T>
T* Channel(Soa3<T>& soa, int c) {
  return (c == 0 ? soa.x : c == 1 ? soa.y : soa.z).data();
}
template <class T>
const T* Channel(const Soa3<T>& soa, int c) {
  return (c == 0 ? soa.x : c == 1 ? soa.y : soa.z).data();
}

struct Hits {
  size_t begin, end;

  // to[i] = of(i).
  template <class T, class Of>
  HWY_INLINE void Fill(T* HWY_RESTRICT to, const Of& of) const {
    for (size_t i = begin; i < end; ++i) to[i] = static_cast<T>(of(i));
  }
};

void FillRgb(const Hits& hits, const Rgb& value, Soa3<double>* to) {
  for (int c = 0; c < 3; ++c)
    std::fill(Channel(*to, c) + hits.begin, Channel(*to, c) + hits.end, value[c]);
}

void FillNumber(const Hits& hits, double value, AlignedArray<double>* to) {
  std::fill(to->data() + hits.begin, to->data() + hits.end, value);
}

// value *= texel, kept within [0, most].
void Multiply(const Hits& hits, const float* HWY_RESTRICT texels, double most,
              double* HWY_RESTRICT values) {
  for (size_t i = hits.begin; i < hits.end; ++i) {
    values[i] = std::min(std::max(values[i] * double{texels[i]}, 0.0), most);
  }
}

void StartMaterialT(const TexturedRun& run, HitTextures* t) {
  const Hits hits{run.begin, run.end};
  const Material& material = *run.material.textured;
  for (int c = 0; c < 3; ++c) {
    const auto emission = static_cast<float>(run.material.emission[c]);
    std::fill(Channel(t->emission, c) + run.begin, Channel(t->emission, c) + run.end, emission);
    const auto albedo = static_cast<float>(run.material.albedo[c]);
    std::fill(Channel(t->albedo, c) + run.begin, Channel(t->albedo, c) + run.end, albedo);
    const auto ambient = static_cast<float>(run.material.ambient[c]);
    std::fill(Channel(t->ambient, c) + run.begin, Channel(t->ambient, c) + run.end, ambient);
  }
  if (const auto* lambert = std::get_if<LambertMaterial>(&material.model)) {
    FillRgb(hits, lambert->albedo, &t->diffuse);
  } else if (const auto* rough = std::get_if<OrenNayarMaterial>(&material.model)) {
    FillRgb(hits, rough->albedo, &t->diffuse);
  } else if (const auto* burley = std::get_if<BurleyMaterial>(&material.model)) {
    FillRgb(hits, burley->albedo, &t->diffuse);
  } else if (const auto* phong = std::get_if<PhongMaterial>(&material.model)) {
    FillRgb(hits, phong->color, &t->diffuse);
    FillRgb(hits, phong->ks, &t->specular);
    FillNumber(hits, phong->shininess, &t->width);
  } else if (const auto* metallic = std::get_if<MetallicRoughnessMaterial>(&material.model)) {
    FillRgb(hits, metallic->base_color, &t->diffuse);
    FillNumber(hits, metallic->metallic, &t->metallic);
    FillNumber(hits, metallic->roughness, &t->width);
  }
}

void ApplyMapT(const TexturedRun& run, MapRole role, HitTextures* t) {
  const Hits hits{run.begin, run.end};
  for (int c = 0; c < 3; ++c) {
    const float* const texels = Channel(t->texels, c);
    switch (role) {
      case MapRole::kDiffuse:
        Multiply(hits, texels, 1, Channel(t->diffuse, c));
        break;
      case MapRole::kSpecular:
        Multiply(hits, texels, 1, Channel(t->specular, c));
        break;
      case MapRole::kEmission: {
        const double factor = run.material.emission[c];
        hits.Fill(Channel(t->emission, c),
                  [&](size_t i) { return std::max(factor * double{texels[i]}, 0.0); });
        break;
      }
      case MapRole::kWidth:
        if (c == 0) Multiply(hits, texels, limits::kExponent.max, t->width.data());
        break;
      case MapRole::kMetallicRoughness:
        if (c == 1) Multiply(hits, texels, 1, t->width.data());
        if (c == 2) Multiply(hits, texels, 1, t->metallic.data());
        break;
    }
  }
}

// What the layers of these names show: the albedo, and of the ambient light what a colour reflects.
void FinishLayers(const TexturedRun& run, const Rgb& of_albedo, const Rgb& of_ambient,
                  HitTextures* t) {
  const Hits hits{run.begin, run.end};
  for (int c = 0; c < 3; ++c) {
    const double* const color = Channel(t->diffuse, c);
    hits.Fill(Channel(t->albedo, c), [&](size_t i) { return color[i] * of_albedo[c]; });
    const double radiance = run.material.ambient_radiance[c];
    hits.Fill(Channel(t->ambient, c),
              [&](size_t i) { return color[i] * of_ambient[c] * radiance; });
  }
}

// EonMultipleRatio of the colours; roughness(i) is that of a hit.
template <class Roughness>
void FinishRatio(const TexturedRun& run, const Roughness& roughness, HitTextures* t) {
  for (int c = 0; c < 3; ++c) {
    const double* const color = Channel(t->diffuse, c);
    Hits{run.begin, run.end}.Fill(Channel(t->base_ratio, c), [&](size_t i) {
      return EonMultipleRatio(color[i], roughness(i));
    });
  }
}

// Lambert's, and the rough ones.
void FinishMatte(const TexturedRun& run, HitTextures* t) {
  FinishLayers(run, Rgb(1), Rgb(1), t);
  if (const auto* rough = std::get_if<RoughMatteModel>(&run.material.model)) {
    FinishRatio(
        run, [&](size_t) { return rough->roughness; }, t);
  }
  for (int c = 0; c < 3; ++c) {
    double* const diffuse = Channel(t->diffuse, c);
    Hits{run.begin, run.end}.Fill(diffuse, [&](size_t i) { return diffuse[i] * M_1_PI; });
  }
}

void FinishPhong(const TexturedRun& run, const PhongMaterial& phong, HitTextures* t) {
  FinishLayers(run, phong.kd, phong.ka, t);
  const Hits hits{run.begin, run.end};
  const bool radiometric = phong.convention == PhongConvention::kRadiometric;
  const double* const exponents = t->width.data();
  const auto scale = [&](double n) {
    if (!radiometric) return 1.0;
    return phong.model == PhongModel::kBlinnPhong ? BlinnNormalization(n) : PhongNormalization(n);
  };
  const bool one_exponent = !phong.shininess_map.valid();
  const double common = scale(phong.shininess);
  for (size_t i = run.begin; i < run.end; ++i) {
    const double by = one_exponent ? common : scale(exponents[i]);
    t->specular.x[i] *= by;
    t->specular.y[i] *= by;
    t->specular.z[i] *= by;
  }
  hits.Fill(t->alpha.data(), [&](size_t i) { return exponents[i]; });
  for (int c = 0; c < 3; ++c) {
    double* const diffuse = Channel(t->diffuse, c);
    const double kd = phong.kd[c], by = radiometric ? M_1_PI : 1;
    hits.Fill(diffuse, [&](size_t i) { return kd * diffuse[i] * by; });
  }
}

// A hit's fit; that of MakeAlbedoFit, to the bit. The coefficients of both curves are one array, so
// that blending them is a loop of vectors.
struct HitFit {
  static constexpr size_t kCoefficients = 2 * kAlbedoTerms;
  AlbedoShape shape;
  float coefficients[kCoefficients] = {};
  double e_average = 1, schlick_average = 0;
};
static_assert(offsetof(AlbedoEntry, schlick) == kAlbedoTerms * sizeof(float));

void MakeFit(const MicrofacetModel& model, double roughness, HitFit* fit) {
  if (model.compensation == Compensation::kKullaConty) {
    const AlbedoFit whole = MakeAlbedoFit(model.shadowing, roughness);
    fit->e_average = whole.e_average;
    fit->schlick_average = whole.schlick_average;
  }
  fit->shape = MakeAlbedoShape(model.shadowing, roughness);
  const AlbedoWeights at = FindAlbedoWeights(roughness);
  std::fill(fit->coefficients, fit->coefficients + HitFit::kCoefficients, 0.0f);
  for (int i = 0; i < 4; ++i) {
    const AlbedoEntry& entry = kAlbedoTable[static_cast<int>(model.shadowing)][at.first + i];
    const auto weight = static_cast<float>(at.weights[i]);
    const auto* const from = reinterpret_cast<const float*>(&entry);  // one, then schlick
    for (size_t k = 0; k < HitFit::kCoefficients; ++k) fit->coefficients[k] += weight * from[k];
  }
  if (fit->shape.offset > 0) return;
  std::fill(fit->coefficients + kAlbedoTerms, fit->coefficients + HitFit::kCoefficients, 0.0f);
}

void PutFit(const HitFit& fit, size_t i, HitTextures* t) {
  float* to = t->fit.data() + i;
  const auto put = [&](float value) {
    *to = value;
    to += HitTextures::kFitStride;
  };
  put(fit.shape.offset);
  put(fit.shape.scale);
  put(fit.shape.k);
  put(fit.shape.softening);
  for (const float coefficient : fit.coefficients) put(coefficient);
}

// Kulla and Conty's lobe of a hit: what PrepareKullaConty of material.cc does.
void FinishKullaConty(const MicrofacetModel& model, const HitFit& fit, size_t i, HitTextures* t) {
  t->multiple_scale[i] = static_cast<float>(KullaContyScale(fit.e_average));
  for (int c = 0; c < 3; ++c) {
    const double f0 = Channel(t->specular, c)[i];
    const double slope = Channel(t->exact_slope, c)[i];
    const double f_multiple = KullaContyFresnel(AverageF82(f0, slope), fit.e_average);
    Channel(t->exact_f_multiple, c)[i] = f_multiple;
    Channel(t->f_multiple, c)[i] = static_cast<float>(f_multiple);
    if (model.coupling != DiffuseCoupling::kAlbedoScaled) continue;
    const double single = f0 * (fit.e_average - fit.schlick_average) + fit.schlick_average;
    const double left = 1 - single - f_multiple * (1 - fit.e_average);
    double& diffuse = Channel(t->diffuse, c)[i];
    diffuse = left > 0 ? diffuse / left : 0;
  }
}

// Albedo fits, but for hits of the same roughness as the one before.
void FinishAlbedo(const TexturedRun& run, const MicrofacetModel& model, HitTextures* t) {
  const bool kulla_conty = model.compensation == Compensation::kKullaConty;
  const bool own_fits = HasOwnFits(run.material);
  if (!own_fits && !kulla_conty) return;
  HitFit fit;
  double last = -1;
  for (size_t i = run.begin; i < run.end; ++i) {
    if (t->width[i] != last) {
      last = t->width[i];
      MakeFit(model, last, &fit);
    }
    if (own_fits) PutFit(fit, i, t);
    if (kulla_conty) FinishKullaConty(model, fit, i, t);
  }
}

// Bases that are not Lambert's.
void FinishBase(const TexturedRun& run, const MicrofacetModel& model,
                const std::optional<double>& roughness, HitTextures* t) {
  if (model.base_form == DiffuseForm::kLambert) return;
  const auto at = [&](size_t i) { return roughness.value_or(t->width[i]); };
  Hits{run.begin, run.end}.Fill(t->base_roughness.data(), at);
  FinishRatio(run, at, t);
}

void FinishMetallicRoughness(const TexturedRun& run, const MetallicRoughnessMaterial& material,
                             HitTextures* t) {
  FinishLayers(run, Rgb(1), Rgb(1), t);
  const auto& model = std::get<MicrofacetModel>(run.material.model);
  const Hits hits{run.begin, run.end};
  const double* const roughness = t->width.data();
  const double* const metallic = t->metallic.data();
  FinishBase(run, model, material.diffuse_roughness, t);
  for (int c = 0; c < 3; ++c) {
    double* const diffuse = Channel(t->diffuse, c);
    double* const f0 = Channel(t->specular, c);
    double* const slope = Channel(t->exact_slope, c);
    hits.Fill(
        f0, [&](size_t i) { return kDielectricF0 * (1 - metallic[i]) + diffuse[i] * metallic[i]; });
    hits.Fill(diffuse, [&](size_t i) { return diffuse[i] * ((1 - metallic[i]) * M_1_PI); });
    hits.Fill(Channel(t->f0, c), [&](size_t i) { return f0[i]; });
    if (model.fresnel == FresnelForm::kSchlick) {
      hits.Fill(slope, [](size_t) { return 0.0; });
      continue;
    }
    const double tint = material.f82_tint[c];
    hits.Fill(slope, [&](size_t i) { return metallic[i] * F82SlopeFromTint(f0[i], tint); });
    hits.Fill(Channel(t->f82_slope, c), [&](size_t i) { return slope[i]; });
  }
  for (size_t i = run.begin; i < run.end; ++i) {
    const double r = roughness[i], alpha = AlphaFromRoughness(r);
    const bool delta = IsDeltaLobe(alpha);
    const double shown = delta ? 1 : alpha;
    t->alpha[i] = static_cast<float>(shown);
    t->alpha2_over_pi[i] = static_cast<float>(shown * shown * M_1_PI);
    t->schlick_k[i] = static_cast<float>((r + 1) * (r + 1) / 8);
    t->not_delta[i] = delta ? 0.0f : 1.0f;
    t->double_alpha[i] = IsNarrow(r, alpha) ? alpha : -1;
  }
  if (model.prepared) FinishAlbedo(run, model, t);
}

void FinishMaterialT(const TexturedRun& run, HitTextures* t) {
  if (!HasMappedModel(run.material)) return;
  const Material& material = *run.material.textured;
  if (const auto* phong = std::get_if<PhongMaterial>(&material.model)) {
    FinishPhong(run, *phong, t);
  } else if (const auto* metallic = std::get_if<MetallicRoughnessMaterial>(&material.model)) {
    FinishMetallicRoughness(run, *metallic, t);
  } else {
    FinishMatte(run, t);
  }
}

void MakeMicrofacetProducts(const MappedProducts& products, HitTextures* t) {
  const Hits hits{products.begin, products.end};
  const auto& model = std::get<MicrofacetModel>(products.material.model);
  const float* const not_delta = t->not_delta.data();
  for (int c = 0; c < 3; ++c) {
    const double color = products.color[c];
    const double* const diffuse = Channel(t->diffuse, c);
    const double* const f0 = Channel(t->specular, c);
    hits.Fill(Channel(t->by_diffuse, c), [&](size_t i) { return diffuse[i] * color; });
    if (model.fresnel == FresnelForm::kSchlick) {
      hits.Fill(Channel(t->by_specular_f0, c),
                [&](size_t i) { return f0[i] * (double{not_delta[i]} * color); });
      hits.Fill(Channel(t->by_specular_rest, c),
                [&](size_t i) { return (1 - f0[i]) * (double{not_delta[i]} * color); });
      hits.Fill(Channel(t->by_diffuse_rest, c),
                [&](size_t i) { return (1 - f0[i]) * diffuse[i] * color; });
    } else {
      hits.Fill(Channel(t->by_specular, c), [&](size_t i) { return double{not_delta[i]} * color; });
    }
    if (model.compensation == Compensation::kKullaConty) {
      const double* const f_multiple = Channel(t->exact_f_multiple, c);
      hits.Fill(Channel(t->by_multiple, c), [&](size_t i) { return f_multiple[i] * color; });
    }
  }
}

void MakeProductsT(const MappedProducts& products, HitTextures* t) {
  if (std::holds_alternative<MicrofacetModel>(products.material.model)) {
    return MakeMicrofacetProducts(products, t);
  }
  const Hits hits{products.begin, products.end};
  const bool phong = std::holds_alternative<PhongFamilyModel>(products.material.model);
  for (int c = 0; c < 3; ++c) {
    const double color = products.color[c];
    const double* const diffuse = Channel(t->diffuse, c);
    hits.Fill(Channel(t->by_diffuse, c), [&](size_t i) { return diffuse[i] * color; });
    if (!phong) continue;
    const double* const specular = Channel(t->specular, c);
    hits.Fill(Channel(t->by_specular, c), [&](size_t i) { return specular[i] * color; });
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nacre {
HWY_EXPORT(StartMaterialT);
HWY_EXPORT(ApplyMapT);
HWY_EXPORT(FinishMaterialT);
HWY_EXPORT(MakeProductsT);

void StartMaterial(const TexturedRun& run, HitTextures* textures) {
  HWY_DYNAMIC_DISPATCH(StartMaterialT)(run, textures);
}

void ApplyMap(const TexturedRun& run, MapRole role, HitTextures* textures) {
  HWY_DYNAMIC_DISPATCH(ApplyMapT)(run, role, textures);
}

void FinishMaterial(const TexturedRun& run, HitTextures* textures) {
  HWY_DYNAMIC_DISPATCH(FinishMaterialT)(run, textures);
}

void MakeProducts(const MappedProducts& products, HitTextures* textures) {
  HWY_DYNAMIC_DISPATCH(MakeProductsT)(products, textures);
}
}  // namespace nacre
#endif
