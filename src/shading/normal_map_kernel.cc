// SPDX-License-Identifier: Apache-2.0
// shading/normal_map_kernel.cc: applies normal maps and the slopes of bump maps to shading normals.
#include "shading/bsdf.h"
#include "shading/lobe_sample.h"
#include "shading/texture_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shading/normal_map_kernel.cc"
#include "hwy/foreach_target.h"

#include "hwy/highway.h"

#include "base/basis-inl.h"
#include "hit/shading_normal-inl.h"
#include "shading/soa-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::ScalableTag<double>;
using V = hn::Vec<D>;
using F = hn::Rebind<float, D>;

HWY_INLINE Vec3V<V> Normalized(const Vec3V<V>& v) {
  return Scale(v, hn::Div(hn::Set(D(), 1.0), hn::Sqrt(FusedDot(v, v))));
}

// v minus its component along the unit normal n.
HWY_INLINE Vec3V<V> Across(const Vec3V<V>& v, const Vec3V<V>& n) {
  return Sub(v, Scale(n, FusedDot(v, n)));
}

HWY_INLINE hn::Mask<D> IsSound(const Vec3V<V>& v) {
  return hn::And(hn::IsFinite(v.x), hn::And(hn::IsFinite(v.y), hn::IsFinite(v.z)));
}

// Stores a normal-mapped normal. The normal is left bit for bit where the map is level, where its
// vector has length 0, and where there are no tangents. A normal that points below the surface is
// first mirrored at it, because the viewer sees the upper side only; then BendNormal bends it to
// where reflection models can use it.
HWY_INLINE void StoreNormal(const Vec3V<V>& mapped, hn::Mask<D> level, size_t i,
                            const TexturedRun& run) {
  const D d;
  const F f;
  const Vec3V<V> interpolated = LoadSoa(d, run.textures.interpolated_normal, i);
  const auto mask = hn::And(hn::AndNot(level, IsSound(mapped)), hn::FirstN(d, run.end - i));
  const V below = hn::Min(FusedDot(mapped, interpolated), hn::Zero(d));
  const Vec3V<V> upper = Sub(mapped, Scale(interpolated, hn::Add(below, below)));
  const Vec3V<V> normal = BendNormal(d, upper, interpolated, LoadSoa(d, run.hits.to_view, i));
  const auto store = [&](V value, AlignedArray<double>* exact, AlignedArray<float>* rounded)
                         HWY_ATTR {
                           double* const to = exact->data() + i;
                           const V kept = hn::IfThenElse(mask, value, hn::LoadU(d, to));
                           hn::StoreU(kept, d, to);
                           hn::StoreU(hn::DemoteTo(f, kept), f, rounded->data() + i);
                         };
  store(normal.x, &run.hits.normal.x, &run.surface.normal.x);
  store(normal.y, &run.hits.normal.y, &run.surface.normal.y);
  store(normal.z, &run.hits.normal.z, &run.surface.normal.z);
}

// The vectors by which the components of a normal map are multiplied.
struct Frame {
  Vec3V<V> tangent, bitangent, normal;
};

// With the gradients of u and v across the normal n, dP/du is (dv x n) / det and dP/dv is
// (n x du) / det, det = (du x dv).n, which is below 0 where the image is mirrored. The tangent is
// unit along dP/du, the bitangent n x tangent on dP/dv's side, so that the three are orthonormal;
// both are reversed where the surface is seen from behind.
HWY_INLINE Frame FrameOfGradients(const HitParameters& t, size_t i, const Vec3V<V>& n) {
  const D d;
  const Vec3V<V> du = Across(LoadSoa(d, t.gradient_u, i), n),
                 dv = Across(LoadSoa(d, t.gradient_v, i), n);
  const V det = FusedDot(FusedCross(du, dv), n);
  const V hand = hn::CopySign(hn::Set(d, 1.0), det);
  const Vec3V<V> tangent = Normalized(Scale(FusedCross(dv, n), hand));
  const V side = hn::LoadU(d, t.side.data() + i);
  return {Scale(tangent, side), Scale(FusedCross(n, tangent), hn::Mul(hand, side)), n};
}

// The frame that was interpolated between a mesh's corners, or `otherwise` where there is none.
HWY_INLINE Frame FrameOfCorners(const HitParameters& t, size_t i, const Frame& otherwise) {
  const D d;
  const V length = hn::LoadU(d, t.normal_length.data() + i);
  const auto own = hn::Gt(length, hn::Zero(d));
  return {Select(own, LoadSoa(d, t.tangent, i), otherwise.tangent),
          Select(own, LoadSoa(d, t.bitangent, i), otherwise.bitangent),
          Select(own, Scale(otherwise.normal, length), otherwise.normal)};
}

HWY_INLINE Frame FrameAt(const HitParameters& t, size_t i, const Vec3V<V>& n, bool frames) {
  const Frame frame = FrameOfGradients(t, i, n);
  return frames ? FrameOfCorners(t, i, frame) : frame;
}

void MapNormalsT(const TexturedRun& run, float middle, float scale, bool frames) {
  const D d;
  const HitParameters& t = run.textures;
  const V zero = hn::Zero(d);
  const V middle_v = hn::Set(d, double{middle});
  const V stretch = hn::Set(d, 1 / (1 - double{middle}));
  for (size_t i = run.begin; i < run.end; i += hn::Lanes(d)) {
    const Vec3V<V> n = LoadSoa(d, run.hits.normal, i);
    const Frame frame = FrameAt(t, i, n, frames);
    const auto component = [&](const AlignedArray<float>& from) HWY_ATTR {
      return hn::Mul(hn::Sub(PromoteAt(d, from, i), middle_v), stretch);
    };
    const V factor = hn::Set(d, double{scale});
    const V x = hn::Mul(component(t.texels.x), factor), y = hn::Mul(component(t.texels.y), factor);
    const V z = component(t.texels.z);
    const Vec3V<V> mapped = Normalized(
        Add(Add(Scale(frame.tangent, x), Scale(frame.bitangent, y)), Scale(frame.normal, z)));
    StoreNormal(mapped, hn::And(hn::And(hn::Eq(x, zero), hn::Eq(y, zero)), hn::Gt(z, zero)), i,
                run);
  }
}

// Blinn 1978: the surface P + h n has the normal n - grad h, up to h times the curvature.
void MapNormalsBySlopesT(const TexturedRun& run, double distance) {
  const D d;
  const HitParameters& t = run.textures;
  const V zero = hn::Zero(d);
  for (size_t i = run.begin; i < run.end; i += hn::Lanes(d)) {
    const Vec3V<V> n = LoadSoa(d, run.hits.normal, i);
    // Heights point outwards, from whichever side the surface is seen.
    const V scale = hn::Mul(hn::LoadU(d, t.side.data() + i), hn::Set(d, distance));
    const V slope_u = hn::Mul(PromoteAt(d, t.texels.x, i), scale);
    const V slope_v = hn::Mul(PromoteAt(d, t.texels.y, i), scale);
    const Vec3V<V> gradient = Add(Scale(LoadSoa(d, t.gradient_u, i), slope_u),
                                  Scale(LoadSoa(d, t.gradient_v, i), slope_v));
    const Vec3V<V> mapped = Normalized(Sub(n, Across(gradient, n)));
    StoreNormal(mapped, hn::And(hn::Eq(slope_u, zero), hn::Eq(slope_v, zero)), i, run);
  }
}

// The tangents of a sphere's mapping are undefined at its poles, those of a mesh where it has none,
// and a normal map may turn the normal into the tangent: any direction across the normal then has
// to do.
void StoreTangentsT(const TexturedRun& run, bool frames, bool by_map) {
  const D d;
  const F f;
  const auto& [cos, sin] = run.material.tangent_turn;
  const V turn_cos = hn::Set(d, cos), turn_sin = hn::Set(d, sin);
  const V half = hn::Set(d, 0.5);
  for (size_t i = run.begin; i < run.end; i += hn::Lanes(d)) {
    const Vec3V<V> n = LoadSoa(d, run.hits.normal, i);
    const Frame frame = FrameAt(run.textures, i, n, frames);
    V x = turn_cos, y = turn_sin;  // of the direction in that frame
    if (by_map) {
      const V u = hn::Sub(PromoteAt(d, run.textures.texels.x, i), half);
      const V v = hn::Sub(PromoteAt(d, run.textures.texels.y, i), half);
      x = hn::Sub(hn::Mul(turn_cos, u), hn::Mul(turn_sin, v));
      y = hn::Add(hn::Mul(turn_sin, u), hn::Mul(turn_cos, v));
    }
    const Vec3V<V> along =
        Normalized(Add(Scale(Normalized(frame.tangent), x), Scale(Normalized(frame.bitangent), y)));
    const Vec3V<V> across = Across(along, n);
    const auto sound = hn::Gt(FusedDot(across, across), hn::Set(d, 1e-12));
    const Vec3V<V> tangent = Select(sound, Normalized(across), BasisAbout(d, n).x);
    BlendedStoreSoa(f, Demote3(d, tangent), hn::FirstN(f, run.end - i), i, &run.surface.tangent);
  }
}

using FF = hn::ScalableTag<float>;

void RaiseAboveHorizonT(const MaterialHits& at, Soa3<float>* to_light) {
  const FF d;
  const Surface& surface = at.surface;
  const auto zero = hn::Zero(d);
  for (size_t i = at.begin; i < at.end; i += hn::Lanes(d)) {
    const auto n = LoadSoa(d, surface.interpolated_normal, i), l = LoadSoa(d, *to_light, i);
    const auto height = FusedDot(n, l);
    const auto faces = hn::Gt(FusedDot(LoadSoa(d, surface.normal, i), l), zero);
    const auto mask = hn::And(hn::And(faces, hn::Lt(height, zero)), hn::FirstN(d, at.end - i));
    BlendedStoreSoa(d, Sub(l, Scale(n, hn::Add(height, height))), mask, i, to_light);
  }
}

bool MirrorAtHorizonT(const MaterialHits& at, const LightBatch& light, LightBatch* mirrored) {
  const FF d;
  const Surface& surface = at.surface;
  const auto zero = hn::Zero(d);
  bool any = false;
  for (size_t i = at.begin; i < at.end; i += hn::Lanes(d)) {
    const auto n = LoadSoa(d, surface.interpolated_normal, i),
               l = LoadSoa(d, light.light_vector, i);
    const auto height = FusedDot(n, l);
    const auto below = Sub(l, Scale(n, hn::Add(height, height)));
    const auto unit = Scale(below, hn::Div(hn::Set(d, 1.0f), hn::Sqrt(FusedDot(below, below))));
    const auto normal = LoadSoa(d, surface.normal, i);
    const auto irradiance = hn::LoadU(d, light.irradiance.data() + i);
    const auto in_range = hn::FirstN(d, at.end - i);
    const auto lit =
        hn::And(hn::And(hn::Gt(FusedDot(normal, unit), zero), hn::Gt(irradiance, zero)), in_range);
    any = any || !hn::AllFalse(d, lit);
    BlendedStoreSoa(d, Select(lit, unit, normal), in_range, i, &mirrored->light_vector);
    hn::BlendedStore(hn::IfThenElseZero(lit, irradiance), in_range, d,
                     mirrored->irradiance.data() + i);
  }
  return any;
}

void HideUnreflectedLightT(const MaterialHits& at, LightBatch* light) {
  const FF d;
  const auto zero = hn::Zero(d);
  for (size_t i = at.begin; i < at.end; i += hn::Lanes(d)) {
    const auto l = LoadSoa(d, light->light_vector, i);
    auto faces = hn::Gt(FusedDot(LoadSoa(d, at.surface.normal, i), l), zero);
    for (size_t k = 0; k < at.material.coats.size(); ++k) {
      const Soa3<float>& normal = at.coats[k].surface.normal;
      faces = hn::Or(faces, hn::Gt(FusedDot(LoadSoa(d, normal, i), l), zero));
    }
    float* const irradiance = light->irradiance.data() + i;
    const auto keep = hn::Or(faces, hn::Not(hn::FirstN(d, at.end - i)));
    hn::StoreU(hn::IfThenElseZero(keep, hn::LoadU(d, irradiance)), d, irradiance);
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nacre {
HWY_EXPORT(MapNormalsT);
HWY_EXPORT(MapNormalsBySlopesT);
HWY_EXPORT(StoreTangentsT);
HWY_EXPORT(HideUnreflectedLightT);
HWY_EXPORT(RaiseAboveHorizonT);
HWY_EXPORT(MirrorAtHorizonT);

void MapNormals(const TexturedRun& run, float middle, float scale, bool frames) {
  HWY_DYNAMIC_DISPATCH(MapNormalsT)(run, middle, scale, frames);
}

void MapNormalsBySlopes(const TexturedRun& run, double distance) {
  HWY_DYNAMIC_DISPATCH(MapNormalsBySlopesT)(run, distance);
}

void StoreTangents(const TexturedRun& run, bool frames, bool by_map) {
  HWY_DYNAMIC_DISPATCH(StoreTangentsT)(run, frames, by_map);
}

void HideUnreflectedLight(const MaterialHits& at, LightBatch* light) {
  HWY_DYNAMIC_DISPATCH(HideUnreflectedLightT)(at, light);
}

void RaiseAboveHorizon(const MaterialHits& at, Soa3<float>* to_light) {
  HWY_DYNAMIC_DISPATCH(RaiseAboveHorizonT)(at, to_light);
}

bool MirrorAtHorizon(const MaterialHits& at, const LightBatch& light, LightBatch* mirrored) {
  return HWY_DYNAMIC_DISPATCH(MirrorAtHorizonT)(at, light, mirrored);
}
}  // namespace nacre
#endif
