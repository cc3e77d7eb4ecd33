// SPDX-License-Identifier: Apache-2.0
#include "shading/bsdf.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/overloaded.h"
#include "brdf/angles.h"
#include "brdf/lobe_sampling.h"
#include "scene/coat.h"
#include "shading/kernels.h"
#include "shading/lobe_chances.h"
#include "shading/lobe_sample.h"
#include "shading/models_at_hit.h"
#include "shading/open_pbr.h"
#include "shading/scalar_bsdf.h"
#include "shading/shade.h"

namespace nacre {
namespace {

// One level of hits: level 0 is the model and its layers, level 1 + k coat k.
MaterialHits LevelOf(const MaterialHits& at, size_t level) {
  if (level == 0) return at;
  const CoatHits& coat = at.coats[level - 1];
  return {*at.material.coats[level - 1],
          coat.hits,
          coat.surface,
          at.begin,
          at.end,
          coat.textures.get()};
}

bool HasLayers(const ShadingMaterial& material, LobeKind kind) {
  return std::any_of(material.layers.begin(), material.layers.end(),
                     [&](const LayerModel& layer) { return KindOf(layer) == kind; });
}

// --- Normal maps. The hemisphere of a mapped normal extends below the unmapped surface, whose
// normal is Surface::interpolated_normal and from below which no light comes. The diffuse component
// loses the light from there. The glossy lobe must not: the part of it that lies below the surface
// is taken to be reflected by the surface once more. So light from l above the horizon reflects
// f(l) + f(l'), where l' is l mirrored in the surface. The integral over all l is then that of the
// whole lobe: a white lobe reflects all light at every roughness, and a narrow one converges to the
// perfect mirror, which BendNormal (hit/shading_normal.h) keeps above the surface. Schüssler et al.
// 2017, "Microfacet-based Normal Mapping for Robust Monte Carlo Path Tracing", conserve energy in
// the same way, by a second reflection at an additional facet.

bool HasMirroredLobe(const ShadingMaterial& material) {
  return material.by_hit.normal &&
         (HasSampledLobe(material) || HasLayers(material, LobeKind::kGlossy));
}

// Makes room->mirrored->light. Returns false if f(l') is 0 at all hits.
bool MirrorLight(const MaterialHits& level, const LightBatch& light, BsdfRoom* room) {
  if (!HasMirroredLobe(level.material)) return false;
  if (!room->mirrored) room->mirrored = std::make_unique<MirroredLobe>();
  return MirrorAtHorizon(level, light, &room->mirrored->light);
}

// Adds the term f(l') to the sum and the specular component.
void AddMirroredLobe(const LitHits& level, BsdfRoom* room) {
  if (!MirrorLight(level, *level.on_hits, room)) return;
  MirroredLobe& mirrored = *room->mirrored;
  const ShadingLight given{.form = LightForm::kGiven, .color = level.light.color};
  ShadeRun({level, given, &mirrored.light, &mirrored.radiance}, &room->shade);
  AddSoa(mirrored.radiance.specular, level.begin, level.end, &level.radiance->sum);
  AddSoa(mirrored.radiance.specular, level.begin, level.end, &level.radiance->specular);
}

// The pdf of the model's glossy lobe. Samples at l' are mirrored to l (RaiseAboveHorizon).
void ModelLobePdf(const MaterialHits& level, const LightBatch& light, BsdfRoom* room, float* pdf) {
  LobePdf(level, light, &room->shade, pdf);
  if (!MirrorLight(level, light, room)) return;
  MirroredLobe& mirrored = *room->mirrored;
  LobePdf(level, mirrored.light, &room->shade, mirrored.pdf.data());
  for (size_t i = level.begin; i < level.end; ++i) {
    if (mirrored.light.irradiance[i] > 0) pdf[i] += mirrored.pdf[i];
  }
}

void SampleModelLobe(const MaterialHits& level, const float* u, const float* v, BsdfRoom* room,
                     Soa3<float>* to_light) {
  SampleLobe(level, u, v, &room->shade, to_light);
  if (HasMirroredLobe(level.material)) RaiseAboveHorizon(level, to_light);
}

// --- Stacks.

// What the coat of hit i lets through, where maps give the coat or the base numbers of their own.
CoatTransmission TransmissionAt(const MaterialHits& at, size_t k, size_t i) {
  const ShadingMaterial& coat = *at.material.coats[k];
  CoatTransmission transmission = coat.transmission;
  if (coat.by_hit.model) {
    const HitParameters& maps = *at.coats[k].textures;
    transmission.weight *=
        NumbersOf(maps, MappedNumber::kSpecular)[i] / StrengthOf(*coat.scene_material);
  }
  if (transmission.darkening > 0 && at.Maps() != nullptr) {
    auto below = std::get<OpenPbrMaterial>(at.material.scene_material->model);
    const HitParameters& maps = *at.Maps();
    below.base_color = ColorOfHit(maps, MappedNumber::kColor, i);
    below.base_metalness = NumbersOf(maps, MappedNumber::kMetallic)[i];
    below.specular_color = ColorOfHit(maps, MappedNumber::kSpecularColor, i);
    below.specular_roughness = NumbersOf(maps, MappedNumber::kUncoatedWidth)[i];
    EstimateBelowCoat(below, &transmission);
  }
  return transmission;
}

// Computes the factors of the coats at hits [begin, end), seen from the viewer.
void FindCoatFactors(const MaterialHits& at, size_t k, CoatHits* coat) {
  const bool absorbs = AbsorbsAlongLight(at.material.coats[k]->transmission);
  for (size_t i = at.begin; i < at.end; ++i) {
    const CoatTransmission transmission = TransmissionAt(at, k, i);
    const Rgb albedo = Rgb(1) - Rgb(VectorAt(coat->surface.transmittance, i));
    const CoatFactors factors = FactorsOf(transmission, albedo, NDotV(coat->surface, i));
    if (!absorbs) {
      const Rgb whole = factors.constant + factors.along_light * CrossingOfLight(transmission, 1);
      SetVector(whole, i, &coat->constant);
      continue;
    }
    const Rgb medium = MediumOf(transmission);
    SetVector(factors.constant, i, &coat->constant);
    SetVector(factors.along_light, i, &coat->along_light);
    SetVector(MakeRgb([&](int c) { return std::log2(std::max(medium[c], 1e-300)) / 2; }), i,
              &coat->log2_medium);
  }
}

// The layers of one kind at one hit, over the model's lobe of that kind.
class LayersAtHit {
 public:
  LayersAtHit(const MaterialHits& at, LobeKind kind, size_t i)
      : material_(at.material), kind_(kind), maps_(at.Maps()), i_(i) {
    const double n_dot_v = NDotV(at.surface, i);
    albedo_ = kind == LobeKind::kDiffuse
                  ? BaseAlbedo(material_, maps_, i)
                  : AlbedosAt(material_, maps_, at.surface, i, n_dot_v).glossy;
    for (size_t k = 0; k < material_.layers.size(); ++k) {
      if (KindOf(material_.layers[k]) != kind) continue;
      const LayerModel layer = Layer(k);
      const LayerChance with = ChanceOf(layer, n_dot_v, albedo_);
      chance_[k] = with.chance;
      albedo_ = with.albedo;
      reflects_ = reflects_ || chance_[k] > 0;
    }
  }

  // The albedo of these lobes together, by estimate.
  double Albedo() const { return albedo_; }

  // Whether any of the layers reflects light.
  bool Reflects() const { return reflects_; }

  // Calls use(layer, chance) from the top down, where `chance` is the probability of sampling the
  // layer rather than what is below it, until it returns true. Returns whether it did.
  template <class Use>
  bool Visit(const Use& use) const {
    for (size_t k = material_.layers.size(); k-- > 0;) {
      if (KindOf(material_.layers[k]) == kind_ && use(Layer(k), chance_[k])) return true;
    }
    return false;
  }

 private:
  LayerModel Layer(size_t k) const { return LayerAtHit(material_.layers[k], maps_, i_); }

  const ShadingMaterial& material_;
  LobeKind kind_;
  const HitParameters* maps_;
  size_t i_;
  double albedo_ = 0;
  std::array<double, kMostLayers> chance_{};
  bool reflects_ = false;
};

bool CoatsAreSampled(const ShadingMaterial& material, LobeKind kind) {
  return kind == LobeKind::kGlossy &&
         std::any_of(material.coats.begin(), material.coats.end(),
                     [](const auto& coat) { return HasSampledLobe(*coat); });
}

// Whether the model has, or with maps may have, a diffuse base. A user model's lobe is glossy if it
// has a sampler, else diffuse.
bool HasDiffuse(const ShadingMaterial& material) {
  return std::visit(Overloaded{[](const std::monostate&) { return false; },
                               [](const UserModel& user) { return !user.brdf->sample; },
                               [](const MeasuredModel&) { return false; },
                               [&](const auto& model) {
                                 return material.by_hit.model || !IsBlack(model.diffuse);
                               }},
                    material.model);
}

// The pdf of a layer's samples at hit i. Like the model's, glossy ones are mirrored at the horizon.
double LayerPdfAt(const MaterialHits& at, const LayerModel& layer, size_t i,
                  const Vec3d& to_light) {
  const Surface& surface = at.surface;
  const Vec3d n = VectorAt(surface.normal, i), v = VectorAt(surface.to_view, i);
  const double pdf = LayerPdf(layer, LayerAnglesOf(n, to_light, v));
  if (!at.material.by_hit.normal || KindOf(layer) != LobeKind::kGlossy) return pdf;
  const Vec3d horizon = VectorAt(surface.interpolated_normal, i);
  const Vec3d mirrored = to_light - horizon * (2 * horizon.dot(to_light));
  return n.dot(mirrored) > 0 ? pdf + LayerPdf(layer, LayerAnglesOf(n, mirrored, v)) : pdf;
}

// Mixes the pdfs of the layers of a kind with that of the model's lobe, which `pdf` holds.
void MixLayerPdfs(const MaterialHits& at, LobeKind kind, const LightBatch& light, float* pdf) {
  for (size_t i = at.begin; i < at.end; ++i) {
    const LayersAtHit layers(at, kind, i);
    if (!layers.Reflects()) continue;
    const Vec3d to_light = VectorAt(light.light_vector, i);
    const double n_dot_l = VectorAt(at.surface.normal, i).dot(to_light);
    double sum = 0, left = 1;
    layers.Visit([&](const LayerModel& layer, double chance) {
      sum += left * chance * LayerPdfAt(at, layer, i, to_light);
      left *= 1 - chance;
      return false;
    });
    // n.l / pi rounds differently in double.
    const double of_model = kind == LobeKind::kDiffuse ? CosinePdf(n_dot_l) : pdf[i];
    pdf[i] = static_cast<float>(sum + left * of_model);
  }
}

void FindDiffusePdf(const MaterialHits& at, const LightBatch& light, float* pdf) {
  CosinePdfs(at, light.light_vector, pdf);
  if (HasLayers(at.material, LobeKind::kDiffuse)) MixLayerPdfs(at, LobeKind::kDiffuse, light, pdf);
}

void FindGlossyPdf(const MaterialHits& at, const LightBatch& light, BsdfRoom* room, float* pdf) {
  ModelLobePdf(at, light, room, pdf);
  if (HasLayers(at.material, LobeKind::kGlossy)) MixLayerPdfs(at, LobeKind::kGlossy, light, pdf);
  if (!CoatsAreSampled(at.material, LobeKind::kGlossy)) return;
  if (room->coat_pdf.size() == 0) room->coat_pdf = AlignedArray<float>(kBatchCapacity);
  for (size_t k = 0; k < at.material.coats.size(); ++k) {
    ModelLobePdf(LevelOf(at, 1 + k), light, room, room->coat_pdf.data());
    for (size_t i = at.begin; i < at.end; ++i) {
      const float chance = at.coats[k].chance[i];
      pdf[i] = chance * room->coat_pdf[i] + (1 - chance) * pdf[i];
    }
  }
}

// Cosine-weighted, in polar coordinates, as layers are sampled, and not by SampleCosine: the
// direction is then a continuous function of the point, which keeps the strata of Sobol points.
Vec3d SampleCosineInPolar(const Vec3d& normal, double u, double v) {
  const double sin = std::sqrt(std::clamp(u, 0.0, 1.0)), phi = 2 * M_PI * v;
  return BasisAbout(normal).ToWorld(
      {sin * std::cos(phi), sin * std::sin(phi), std::sqrt(std::max(1 - sin * sin, 0.0))});
}

// Chooses a lobe of the kind for each hit. Where it is a layer's, or the diffuse base under layers,
// the direction is sampled at once.
void ChooseLobes(const MaterialHits& at, LobeKind kind, const float* u, const float* v,
                 StackRoom* room) {
  const size_t coats = CoatsAreSampled(at.material, kind) ? at.material.coats.size() : 0;
  const bool layers = HasLayers(at.material, kind);
  for (size_t i = at.begin; i < at.end; ++i) {
    Chooser chooser(u[i]);
    StackRoom::Lobe lobe = StackRoom::kModelLobe;
    for (size_t k = coats; k-- > 0 && lobe == StackRoom::kModelLobe;) {
      if (chooser.Takes(at.coats[k].chance[i])) lobe = StackRoom::kCoatLobe + k;
    }
    if (layers && lobe == StackRoom::kModelLobe) {
      const LayersAtHit at_hit(at, kind, i);
      const Vec3d normal = VectorAt(at.surface.normal, i);
      const Vec3d to_view = VectorAt(at.surface.to_view, i);
      const bool chosen = at_hit.Visit([&](const LayerModel& layer, double chance) {
        if (!chooser.Takes(chance)) return false;
        SetVector(SampleLayer(layer, normal, to_view, chooser.rest(), v[i]), i, &room->to_light);
        return true;
      });
      const bool diffuse = kind == LobeKind::kDiffuse && at_hit.Reflects();
      if (!chosen && diffuse) {
        SetVector(SampleCosineInPolar(normal, chooser.rest(), v[i]), i, &room->to_light);
      }
      if (chosen || diffuse) lobe = StackRoom::kSampled;
    }
    room->u[i] = std::min(static_cast<float>(chooser.rest()), 1 - 0x1p-24f);
    room->lobe[i] = lobe;
  }
}

// Takes the directions at hits where this lobe was chosen.
void TakeChosen(const MaterialHits& at, const StackRoom& room, size_t lobe, const Soa3<float>& from,
                Soa3<float>* to_light) {
  for (size_t i = at.begin; i < at.end; ++i) {
    if (room.lobe[i] == lobe) SetVector(VectorAt(from, i), i, to_light);
  }
}

// The coats of the material at hit i.
std::array<CoatInView, kMostCoats> CoatsInView(const MaterialHits& at, size_t i) {
  std::array<CoatInView, kMostCoats> coats;
  for (size_t k = 0; k < at.material.coats.size(); ++k) {
    const MaterialHits coat = LevelOf(at, 1 + k);
    coats[k] = {Rgb(1) - Rgb(VectorAt(coat.surface.transmittance, i)),
                TransmittedAt(at, k, i, NDotV(coat.surface, i)), IsMirror(coat, i)};
  }
  return coats;
}

// Directions of hits without a sampled lobe at a level are never chosen, but they are finite.
void SetToNormals(const Surface& surface, size_t begin, size_t end, Soa3<float>* to) {
  for (size_t i = begin; i < end; ++i) SetVector(VectorAt(surface.normal, i), i, to);
}

// --- Mirrors.

// The factor by which the layers at hit i attenuate a mirror's reflection: all of them, or those
// over the coats.
double TransmittedByLayers(const MaterialHits& at, size_t i, bool all) {
  const HitParameters* const maps = at.Maps();
  const double n_dot_v = NDotV(at.surface, i);
  double left = 1;
  for (const LayerModel& layer : at.material.layers) {
    if (!all && !LiesOverCoats(layer)) continue;
    left *= LayerAlbedo(LayerAtHit(layer, maps, i), n_dot_v).below;
  }
  return left;
}

}  // namespace

Rgb TransmittedAt(const MaterialHits& at, size_t k, size_t i, double n_dot_l) {
  const CoatHits& coat = at.coats[k];
  const Rgb constant(VectorAt(coat.constant, i));
  if (!AbsorbsAlongLight(at.material.coats[k]->transmission)) return constant;
  return constant +
         Rgb(VectorAt(coat.along_light, i)) * CrossingOfLight(TransmissionAt(at, k, i), n_dot_l);
}

Rgb EmittedThroughCoat(const MaterialHits& at, size_t k, size_t i) {
  const CoatHits& coat = at.coats[k];
  const Rgb albedo = Rgb(1) - Rgb(VectorAt(coat.surface.transmittance, i));
  return EmittedThroughCoat(at.material.emission_through, TransmissionAt(at, k, i), albedo,
                            NDotV(coat.surface, i));
}

void CopyToCoat(const HitBatch& hits, const Surface& surface, CoatHits* coat) {
  const size_t padded = RoundUp(hits.count, kBatchPadding);
  HitBatch& to = coat->hits;
  to.count = hits.count;
  to.one_primitive = hits.one_primitive;
  std::copy_n(hits.ray.data(), padded, to.ray.data());
  std::copy_n(hits.primitive.data(), padded, to.primitive.data());
  CopySoa(hits.position, padded, &to.position);
  CopySoa(hits.normal, padded, &to.normal);
  CopySoa(hits.to_view, padded, &to.to_view);
  CopySoa(surface.normal, padded, &coat->surface.normal);
  CopySoa(surface.to_view, padded, &coat->surface.to_view);
}

void PrepareBsdf(const ShadingMaterial& material, size_t begin, size_t end, HitParameters* textures,
                 Surface* surface, std::span<CoatHits> coats) {
  PrepareRun(material, begin, end, surface, textures);
  const size_t count = material.coats.size();
  if (count == 0) return;
  const MaterialHits at{material, coats[0].hits, *surface, begin, end, textures, coats};
  for (size_t k = 0; k < count; ++k) {
    PrepareRun(*material.coats[k], begin, end, &coats[k].surface, coats[k].textures.get());
    FindCoatFactors(at, k, &coats[k]);
  }
  std::array<double, kMostCoats> chances;
  for (size_t i = begin; i < end; ++i) {
    const double glossy = LayersAtHit(at, LobeKind::kGlossy, i).Albedo();
    FindCoatChances({CoatsInView(at, i).data(), count}, glossy, chances);
    for (size_t k = 0; k < count; ++k) coats[k].chance[i] = static_cast<float>(chances[k]);
  }
}

void EvaluateBsdf(const LitHits& lit, BsdfRoom* room, const LobePdfs& pdfs) {
  for (size_t k = 0; k <= lit.material.coats.size(); ++k) {
    if (k > 0 && !room->of_coat) room->of_coat = std::make_unique<ReflectedRadiance>();
    ReflectedRadiance* const own = k > 0 ? room->of_coat.get() : lit.radiance;
    const LitHits level{LevelOf(lit, k), lit.light, lit.on_hits, own, lit.components};
    ShadeRun(level, &room->shade);
    if (level.material.by_hit.normal) AddMirroredLobe(level, room);
    if (k == 0) continue;
    CoverByCoat(level, lit.coats[k - 1], lit.radiance);
  }
  for (const LayerModel& layer : lit.material.layers) {
    if (LiesOverCoats(layer)) CoverByLayer(layer, lit);
  }
  if (pdfs.diffuse != nullptr) FindDiffusePdf(lit, *lit.on_hits, pdfs.diffuse);
  if (pdfs.glossy != nullptr) FindGlossyPdf(lit, *lit.on_hits, room, pdfs.glossy);
}

bool HasLobes(const ShadingMaterial& material, LobeKind kind) {
  if (HasLayers(material, kind) || CoatsAreSampled(material, kind)) return true;
  return kind == LobeKind::kDiffuse ? HasDiffuse(material) : HasSampledLobe(material);
}

void SampleLobes(const MaterialHits& at, LobeKind kind, const float* u, const float* v,
                 BsdfRoom* room, Soa3<float>* to_light) {
  const bool layers = HasLayers(at.material, kind), coats = CoatsAreSampled(at.material, kind);
  const bool stacked = layers || coats;
  if (stacked) {
    if (!room->stack) room->stack = std::make_unique<StackRoom>();
    ChooseLobes(at, kind, u, v, room->stack.get());
  }
  const float* const rest = stacked ? room->stack->u.data() : u;
  if (kind == LobeKind::kDiffuse) {
    SampleCosines(at, rest, v, to_light);
  } else {
    SampleModelLobe(at, rest, v, room, to_light);
  }
  if (!stacked) return;
  StackRoom& stack = *room->stack;
  if (layers && kind == LobeKind::kGlossy && at.material.by_hit.normal) {
    RaiseAboveHorizon(at, &stack.to_light);
  }
  if (layers) TakeChosen(at, stack, StackRoom::kSampled, stack.to_light, to_light);
  for (size_t k = 0; coats && k < at.material.coats.size(); ++k) {
    SampleModelLobe(LevelOf(at, 1 + k), rest, v, room, &stack.to_light);
    TakeChosen(at, stack, StackRoom::kCoatLobe + k, stack.to_light, to_light);
  }
}

bool AnyMirror(const MaterialHits& at, size_t level) {
  return level <= at.material.coats.size() && AnyMirror(LevelOf(at, level));
}

bool SampleMirror(const MaterialHits& at, size_t level, Soa3<float>* to_light,
                  Soa3<float>* weight) {
  if (!AnyMirror(at, level)) return false;
  const MaterialHits of = LevelOf(at, level);
  MirrorDirections(of, to_light);
  MirrorReflectances(of, weight);
  for (size_t i = at.begin; i < at.end; ++i) {
    Vec3d reflected(0, 0, 0);
    if (IsMirror(of, i)) {
      reflected = VectorAt(*weight, i) * TransmittedByLayers(at, i, level == 0);
      const Vec3d mirrored = VectorAt(*to_light, i);
      for (size_t k = level; k < at.material.coats.size(); ++k) {
        const double n_dot_l = VectorAt(at.coats[k].surface.normal, i).dot(mirrored);
        reflected *= TransmittedAt(at, k, i, std::clamp(n_dot_l, 0.0, 1.0));
      }
    }
    SetVector(reflected, i, weight);
  }
  return true;
}

namespace {

KindChances KindChancesAt(const MaterialHits& at, size_t i) {
  const HitParameters* const maps = at.Maps();
  const double n_dot_v = NDotV(at.surface, i);
  std::vector<LayerModel> layers;
  for (const LayerModel& layer : at.material.layers) {
    layers.push_back(LayerAtHit(layer, maps, i));
  }
  return ChancesOfKinds(layers, n_dot_v, AlbedosAt(at.material, maps, at.surface, i, n_dot_v),
                        {CoatsInView(at, i).data(), at.material.coats.size()}, true);
}

// Samples the directions of one choice and takes them, and the weights of mirrors, where it was
// chosen.
void SampleChosen(const MaterialHits& at, size_t code, const float* v, BsdfRoom* room,
                  SampleRoom* sample, BsdfSamples* samples) {
  SetToNormals(at.surface, at.begin, at.end, &sample->to_light);
  if (code < kMirrorChosen) {
    const LobeKind kind = code == kDiffuseChosen ? LobeKind::kDiffuse : LobeKind::kGlossy;
    SampleLobes(at, kind, sample->u.data(), v, room, &sample->to_light);
  } else if (!SampleMirror(at, code - kMirrorChosen, &sample->to_light, &sample->mirrored)) {
    return;
  }
  for (size_t i = at.begin; i < at.end; ++i) {
    if (sample->chosen[i] != code) continue;
    SetVector(VectorAt(sample->to_light, i), i, &samples->to_light);
    if (code >= kMirrorChosen) SetVector(VectorAt(sample->mirrored, i), i, &samples->weight);
  }
}

}  // namespace

void SampleBsdf(const MaterialHits& at, const float* u, const float* v, BsdfRoom* room,
                SampleRoom* sample, BsdfSamples* samples) {
  for (size_t i = at.begin; i < at.end; ++i) {
    sample->chances[i] = KindChancesAt(at, i);
    Chooser chooser(u[i]);
    sample->chosen[i] = ChooseKind(sample->chances[i], &chooser);
    sample->u[i] = std::min(static_cast<float>(chooser.rest()), 1 - 0x1p-24f);
  }
  const size_t codes = kMirrorChosen + 1 + at.material.coats.size();
  for (size_t code = 0; code < codes; ++code) {
    SampleChosen(at, code, v, room, sample, samples);
  }
  const Surface& surface = at.surface;
  for (size_t i = at.begin; i < at.end; ++i) {
    const Vec3d to_light = VectorAt(samples->to_light, i);
    SetVector(to_light, i, &sample->light.light_vector);
    const bool above = VectorAt(HorizonNormal(surface), i).dot(to_light) > LowestHeight(surface);
    sample->light.irradiance[i] = above ? 1.0f : 0.0f;
  }
  const ShadingLight unit{.form = LightForm::kGiven, .color = Rgb(1, 1, 1)};
  EvaluateBsdf({at, unit, &sample->light, &sample->reflected}, room,
               {sample->diffuse_pdf.data(), sample->glossy_pdf.data()});
  for (size_t i = at.begin; i < at.end; ++i) {
    const KindChances& chances = sample->chances[i];
    const size_t code = sample->chosen[i];
    double pdf = 0;
    Vec3d reflected(0, 0, 0);
    if (code < kMirrorChosen) {
      samples->kind[i] = code == kDiffuseChosen ? LobeKind::kDiffuse : LobeKind::kGlossy;
      pdf = chances.diffuse * std::max(sample->diffuse_pdf[i], 0.0f) +
            chances.glossy * sample->glossy_pdf[i];
      reflected = VectorAt(sample->reflected.sum, i);
    } else {
      samples->kind[i] = LobeKind::kDelta;
      pdf = chances.mirror[code - kMirrorChosen];
      reflected = VectorAt(samples->weight, i);
    }
    samples->pdf[i] = static_cast<float>(pdf);
    SetVector(pdf > 0 ? reflected / pdf : Vec3d(0, 0, 0), i, &samples->weight);
  }
}

bool DiffuseIsFlat(const ShadingMaterial& material) {
  if (material.by_hit.normal) return false;  // the unmapped surface's horizon cuts off light
  if (!material.layers.empty()) return false;
  if (const auto* matte = std::get_if<MatteModel>(&material.model)) {
    return matte->form == DiffuseForm::kLambert;
  }
  // A user model with a sampler has no diffuse component.
  if (std::holds_alternative<UserModel>(material.model)) return HasSampledLobe(material);
  const auto* model = std::get_if<MicrofacetModel>(&material.model);
  if (model == nullptr) return true;
  if (model->base_form != DiffuseForm::kLambert) return false;
  return model->coupling == DiffuseCoupling::kNone ||
         (model->coupling == DiffuseCoupling::kAlbedoScaled &&
          model->compensation != Compensation::kKullaConty);
}

namespace {

void SetDefaultTangents(const ShadingMaterial& material, const HitBatch& hits, Surface* surface) {
  if (!material.by_hit.tangent) return;
  for (size_t i = 0; i < hits.count; ++i) {
    SetVector(DefaultTangent(material, VectorAt(hits.normal, i)), i, &surface->tangent);
  }
}

}  // namespace

void EvaluateBatch(const ShadingMaterial& material, const HitBatch& hits, const ShadingLight& light,
                   const LightBatch& on_hits, Surface* surface, std::vector<CoatHits>* coats,
                   BsdfRoom* room, ReflectedRadiance* radiance) {
  if (coats->size() < material.coats.size()) coats->resize(material.coats.size());
  SetDefaultTangents(material, hits, surface);
  for (size_t k = 0; k < material.coats.size(); ++k) {
    CoatHits& coat = (*coats)[k];
    CopyToCoat(hits, *surface, &coat);
    SetDefaultTangents(*material.coats[k], hits, &coat.surface);
  }
  PrepareBsdf(material, 0, hits.count, nullptr, surface, *coats);
  const MaterialHits all{material, hits, *surface, 0, hits.count, nullptr, *coats};
  EvaluateBsdf({all, light, &on_hits, radiance}, room);
}

}  // namespace nacre
