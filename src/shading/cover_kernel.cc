// SPDX-License-Identifier: Apache-2.0
// shading/cover_kernel.cc: adds a layer or a coat over what hits reflect of a light. Layers are
// computed in double, because layers have lobes near the horizon, where products with n.l leave the
// range of float. Scalar twins: layer.cc, coat_transmission.cc.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shading/cover_kernel.cc"
#include "hwy/foreach_target.h"

#include "hwy/highway.h"

#include "base/math-inl.h"
#include "base/vec3-inl.h"
#include "brdf/fuzz-inl.h"
#include "brdf/sheen-inl.h"
#include "shading/kernels.h"
#include "shading/models_at_hit.h"
#include "shading/soa-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::ScalableTag<double>;
using V = hn::Vec<D>;
using HalfFloatTag = hn::Rebind<float, D>;  // as many floats as a vector has doubles

// LayerReflection of a packet of hits.
struct LayerReflectionV {
  Vec3V<V> lobe;
  V below;
};

// Parameters of hits i...: the material's, or, where there are maps, those of each hit.
HWY_INLINE V NumberOfHits(double of_material, const HitParameters* maps, MappedNumber number,
                          size_t i) {
  const D d;
  if (maps == nullptr) return hn::Set(d, of_material);
  return hn::LoadU(d, NumbersOf(*maps, number) + i);
}
HWY_INLINE Vec3V<V> ColorOfHits(const Rgb& of_material, const HitParameters* maps,
                                MappedNumber number, size_t i) {
  const D d;
  if (maps == nullptr) return SetVec3(d, of_material);
  return LoadSoa(d, maps->numbers[static_cast<size_t>(number)], i);
}

// LayerAngles of a packet of hits.
struct LayerAnglesV : AnglesV<V> {
  Vec3V<V> normal, to_light, to_view;
};

// --- The kinds of layers. LayerOnHits(model, maps).At(i, angles) is the layer's reflection at hits
// i... Both cosines are at least 0. `maps` is null where all hits have the model's parameters.

template <class Model>
class LayerOnHits;

template <>
class LayerOnHits<SheenModel> {
 public:
  LayerOnHits(const SheenModel& sheen, const HitParameters* maps) : sheen_(sheen), maps_(maps) {}

  HWY_INLINE LayerReflectionV At(size_t i, const LayerAnglesV& a) const {
    const D d;
    const Charlie<V> charlie =
        maps_ == nullptr ? BroadcastCharlie(d, sheen_.charlie)
                         : MakeCharlie(d, NumberOfHits(0, maps_, MappedNumber::kSheenRoughness, i));
    const Vec3V<V> color = ColorOfHits(sheen_.color, maps_, MappedNumber::kSheenColor, i);
    const V albedo_v = CharlieAlbedo(d, charlie, a.n_dot_v);
    const V albedo_l = sheen_.scaling == SheenScaling::kReciprocal
                           ? CharlieAlbedo(d, charlie, a.n_dot_l)
                           : albedo_v;
    const SheenScale<V> scale =
        ScaleSheen(d, hn::Max(hn::Max(color.x, color.y), color.z), albedo_v, albedo_l);
    const V lobe = hn::Mul(hn::Mul(CharlieLobe(d, charlie, a), a.n_dot_l), scale.lobe);
    return {Scale(color, lobe), scale.below};
  }

 private:
  const SheenModel& sheen_;
  const HitParameters* maps_;
};

template <>
class LayerOnHits<FuzzModel> {
 public:
  LayerOnHits(const FuzzModel& fuzz, const HitParameters* maps) : fuzz_(fuzz), maps_(maps) {}

  HWY_INLINE LayerReflectionV At(size_t i, const LayerAnglesV& a) const {
    const D d;
    const Fuzz<V> fuzz =
        maps_ == nullptr ? BroadcastFuzz(d, fuzz_.fuzz)
                         : MakeFuzz(d, NumberOfHits(0, maps_, MappedNumber::kSheenRoughness, i));
    const FuzzView<V> view = FuzzFromView(d, fuzz, a.n_dot_v);
    const V weight = hn::Set(d, fuzz_.weight);
    const V lobe = hn::Mul(hn::Mul(FuzzLobe(d, view, a), a.n_dot_l), weight);
    return {Scale(ColorOfHits(fuzz_.color, maps_, MappedNumber::kSheenColor, i), lobe),
            hn::NegMulAdd(weight, view.albedo, hn::Set(d, 1.0))};
  }

 private:
  const FuzzModel& fuzz_;
  const HitParameters* maps_;
};

// --- Code that all kinds of layers share.

// Normalises directions that were rounded to float.
HWY_INLINE Vec3V<V> UnitOf(const Vec3V<V>& v) {
  const D d;
  const V squared = FusedDot(v, v);
  const auto some = hn::Gt(squared, hn::Zero(d));
  const V one = hn::Set(d, 1.0);
  return Scale(v, hn::Div(one, hn::Sqrt(hn::IfThenElse(some, squared, one))));
}

HWY_INLINE LayerAnglesV AnglesAt(const Surface& surface, const LightBatch& light, size_t i) {
  const D d;
  const Vec3V<V> n = UnitOf(PromoteSoa(d, surface.normal, i));
  const Vec3V<V> l = UnitOf(PromoteSoa(d, light.light_vector, i));
  const Vec3V<V> v = UnitOf(PromoteSoa(d, surface.to_view, i));
  LayerAnglesV angles{ComputeAngles(d, n, l, v), n, l, v};
  angles.n_dot_l = hn::Max(angles.n_dot_l, hn::Zero(d));
  angles.n_dot_v = hn::Max(angles.n_dot_v, hn::Zero(d));
  return angles;
}

// light * share, but 0 for a share of 0 even where the light has overflowed: infinity times 0 is
// NaN.
HWY_INLINE Vec3V<V> Left(const Vec3V<V>& light, V share) {
  const D d;
  const auto any = hn::Gt(share, hn::Zero(d));
  const Vec3V<V> left = Scale(light, share);
  return {hn::IfThenElseZero(any, left.x), hn::IfThenElseZero(any, left.y),
          hn::IfThenElseZero(any, left.z)};
}

template <class Model>
void Cover(const Model& model, const LitHits& lit) {
  const D d;
  const HalfFloatTag df;
  const LayerOnHits<Model> layer(model, lit.Maps());
  auto& [sum, diffuse, specular] = *lit.radiance;
  constexpr bool kIsDiffuse = Model::kKind == LobeKind::kDiffuse;
  Soa3<float>& own = kIsDiffuse ? diffuse : specular;  // the component that the layer adds to
  Soa3<float>& other = kIsDiffuse ? specular : diffuse;
  for (size_t i = lit.begin; i < lit.end; i += hn::Lanes(d)) {
    const auto mask = hn::FirstN(df, lit.end - i);
    const LayerAnglesV angles = AnglesAt(lit.surface, *lit.on_hits, i);
    const LayerReflectionV terms = layer.At(i, angles);
    const Vec3V<V> lobe = Scale(terms.lobe, PromoteAt(d, lit.on_hits->irradiance, i));
    const Vec3V<V> of_layer = Mul3(lobe, SetVec3(d, lit.light.color));
    const auto cover = [&](Soa3<float>& below, const Vec3V<V>& added) HWY_ATTR {
      const Vec3V<V> left = Left(PromoteSoa(d, below, i), terms.below);
      BlendedStoreSoa(df, Demote3(d, Add(left, added)), mask, i, &below);
    };
    cover(sum, of_layer);
    if (!lit.components) continue;
    cover(own, of_layer);
    cover(other, SetVec3(d, Vec3d(0)));
  }
}

// --- Coats, in float: their factors do not leave its range.

using DF = hn::ScalableTag<float>;
using F = hn::Vec<DF>;

// The cosine, in the coat, of the light at hits i...
HWY_INLINE F RefractedCosines(const LitHits& lit, float inverse_eta2, size_t i) {
  const DF d;
  const F one = hn::Set(d, 1.0f);
  const Vec3V<F> l = LoadSoa(d, lit.on_hits->light_vector, i);
  F n_dot_l = FusedDot(LoadSoa(d, lit.surface.normal, i), l);
  if (lit.light.form != LightForm::kGiven) {
    n_dot_l = hn::Mul(n_dot_l, hn::LoadU(d, lit.on_hits->inverse_length.data() + i));
  }
  const F cosine = hn::Min(hn::Max(n_dot_l, hn::Zero(d)), one);
  const F sin2 = hn::Mul(hn::Sub(one, cosine), hn::Add(one, cosine));
  const F left = hn::NegMulAdd(sin2, hn::Set(d, inverse_eta2), one);
  // A path without end absorbs all light: here the light is 0 after 2^20 crossings.
  return hn::Sqrt(hn::Max(left, hn::Set(d, 0x1p-40f)));
}

// The factors of the coat on what lies below hits i...
HWY_INLINE Vec3V<F> CoatFactorsAt(const LitHits& lit, const CoatHits& coat, size_t i) {
  const DF d;
  const Vec3V<F> constant = LoadSoa(d, coat.constant, i);
  const CoatTransmission& transmission = lit.material.transmission;
  if (!AbsorbsAlongLight(transmission)) return constant;
  const auto inverse_eta2 = static_cast<float>(transmission.inverse_eta * transmission.inverse_eta);
  const F paths = hn::Div(hn::Set(d, 1.0f), RefractedCosines(lit, inverse_eta2, i));
  const Vec3V<F> log2 = Scale(LoadSoa(d, coat.log2_medium, i), paths);
  const F least = hn::Set(d, -126.0f);  // of numbers that are not denormal
  const auto crossing = [&](F of) HWY_ATTR {
    return hn::IfThenElseZero(hn::Ge(of, least), HWY_NAMESPACE::Exp2(d, hn::Max(of, least)));
  };
  return Add(constant, Mul3(LoadSoa(d, coat.along_light, i),
                            {crossing(log2.x), crossing(log2.y), crossing(log2.z)}));
}

// below = below factor + own, but without light that is attenuated to nothing: infinity times 0 is
// NaN.
HWY_INLINE void CoverOne(const Vec3V<F>& factor, const Soa3<float>& own, size_t i, size_t end,
                         Soa3<float>* below) {
  const DF d;
  const auto one = [&](F light, F share, F added) HWY_ATTR {
    const auto any = hn::Gt(share, hn::Zero(d));
    return hn::Add(hn::IfThenElseZero(any, hn::Mul(light, share)), added);
  };
  const Vec3V<F> b = LoadSoa(d, *below, i), o = LoadSoa(d, own, i);
  BlendedStoreSoa(
      d, Vec3V<F>{one(b.x, factor.x, o.x), one(b.y, factor.y, o.y), one(b.z, factor.z, o.z)},
      hn::FirstN(d, end - i), i, below);
}

void CoverByCoatT(const LitHits& lit, const CoatHits& coat, ReflectedRadiance* radiance) {
  const ReflectedRadiance& own = *lit.radiance;
  for (size_t i = lit.begin; i < lit.end; i += hn::Lanes(DF())) {
    const Vec3V<F> factor = CoatFactorsAt(lit, coat, i);
    CoverOne(factor, own.sum, i, lit.end, &radiance->sum);
    if (!lit.components) continue;
    CoverOne(factor, own.diffuse, i, lit.end, &radiance->diffuse);
    CoverOne(factor, own.specular, i, lit.end, &radiance->specular);
  }
}

void CoverByLayerT(const LayerModel& layer, const LitHits& lit) {
  std::visit([&](const auto& model) { Cover(model, lit); }, layer);
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nacre {
HWY_EXPORT(CoverByLayerT);
HWY_EXPORT(CoverByCoatT);

void CoverByLayer(const LayerModel& layer, const LitHits& lit) {
  HWY_DYNAMIC_DISPATCH(CoverByLayerT)(layer, lit);
}

void CoverByCoat(const LitHits& lit, const CoatHits& coat, ReflectedRadiance* radiance) {
  HWY_DYNAMIC_DISPATCH(CoverByCoatT)(lit, coat, radiance);
}
}  // namespace nacre
#endif
