// SPDX-License-Identifier: Apache-2.0
// shading/range-inl.h: what all shading kernels share: loading a hit's vectors, the light on it,
// adding to its radiance. The loops over hits and lights: shading/packets-inl.h.
#if defined(NACRE_SHADING_RANGE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_SHADING_RANGE_INL_H_
#undef NACRE_SHADING_RANGE_INL_H_
#else
#define NACRE_SHADING_RANGE_INL_H_
#endif

#include <span>
#include <type_traits>

#include "brdf/angles-inl.h"
#include "brdf/phong-inl.h"
#include "shading/kernels.h"
#include "shading/light_at-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

struct RgbV {
  FloatV r, g, b;
};

HWY_INLINE RgbV SetRgb(FloatTag d, const float (&rgb)[3]) {
  return {hn::Set(d, rgb[0]), hn::Set(d, rgb[1]), hn::Set(d, rgb[2])};
}

// A number that all hits share, or that of each of hits i...
HWY_INLINE FloatV NumberAt(FloatTag d, float number, size_t) { return hn::Set(d, number); }
HWY_INLINE FloatV NumberAt(FloatTag d, const float* numbers, size_t i) {
  return hn::LoadU(d, numbers + i);
}

template <class Number>
HWY_INLINE RgbV RgbAt(FloatTag d, const Number (&rgb)[3], size_t i) {
  return {NumberAt(d, rgb[0], i), NumberAt(d, rgb[1], i), NumberAt(d, rgb[2], i)};
}

HWY_INLINE RgbV LoadRgb(FloatTag d, const Soa3<float>& soa, size_t i) {
  return {hn::LoadU(d, soa.x.data() + i), hn::LoadU(d, soa.y.data() + i),
          hn::LoadU(d, soa.z.data() + i)};
}

HWY_INLINE RgbV ScaleRgb(const RgbV& color, FloatV s) {
  return {hn::Mul(color.r, s), hn::Mul(color.g, s), hn::Mul(color.b, s)};
}

HWY_INLINE RgbV MulRgb(const RgbV& a, const RgbV& b) {
  return {hn::Mul(a.r, b.r), hn::Mul(a.g, b.g), hn::Mul(a.b, b.b)};
}

// a b + c.
HWY_INLINE RgbV MulAddRgb(const RgbV& a, FloatV b, const RgbV& c) {
  return {hn::MulAdd(a.r, b, c.r), hn::MulAdd(a.g, b, c.g), hn::MulAdd(a.b, b, c.b)};
}

// Of sums of light this is an Add of its own, never fused with the product before it: a light then
// adds the same bits whether it is summed with the others or kept apart in a layer.
HWY_INLINE RgbV AddRgb(const RgbV& a, const RgbV& b) {
  return {hn::Add(a.r, b.r), hn::Add(a.g, b.g), hn::Add(a.b, b.b)};
}

// Hits i... of a batch.
struct PacketV {
  size_t i;
  Vec3V<FloatV> normal, to_view;
};

// Interpolated mesh normals may lean away from the viewer; the cosine then counts as 0.
HWY_INLINE FloatV CosineToView(FloatTag d, const PacketV& p) {
  return hn::Max(FusedDot(p.normal, p.to_view), hn::Zero(d));
}

// One light on them. Where n_dot_l is not above 0 the surface faces away: `irradiance` and
// `weight`, its share that falls on the surface, are then 0, and whatever else is made of the
// direction must be kept from the sum by IsLit.
struct IncidentV {
  TowardV toward;
  FloatV n_dot_l, irradiance, weight;
};

// The same with the angles of the half vector and to the viewer.
struct HalfIncidentV : IncidentV {
  HalfAnglesV<FloatV> half;
  FloatV n_dot_v;
  bool any_short;  // false: all half vectors of the block are IsUpright
};

// With LobeLog2 of the cosine of Phong's lobe, or of the square of Blinn's.
struct LobeIncidentV : IncidentV {
  FloatV log2_cosine;
};

HWY_INLINE hn::Mask<FloatTag> IsLit(FloatTag d, FloatV n_dot_l) {
  return hn::Gt(n_dot_l, hn::Zero(d));
}

HWY_INLINE IncidentV MakeIncident(FloatTag d, const LightV& at, const Vec3V<FloatV>& normal) {
  const FloatV n_dot_l = at.toward.Dot(normal);
  const auto lit = IsLit(d, n_dot_l);
  const FloatV irradiance = hn::IfThenElseZero(lit, at.irradiance);
  const FloatV weight = hn::IfThenElseZero(lit, hn::Mul(n_dot_l, irradiance));
  return {at.toward, n_dot_l, irradiance, weight};
}

HWY_INLINE Vec3V<FloatV> LoadAt(FloatTag d, const Pointers3<const float>& from, size_t i) {
  return LoadU3(d, from.x() + i, from.y() + i, from.z() + i);
}

HWY_INLINE RgbV LoadAsRgb(FloatTag d, const Pointers3<float>& from, size_t i) {
  return {hn::LoadU(d, from.x() + i), hn::LoadU(d, from.y() + i), hn::LoadU(d, from.z() + i)};
}

HWY_INLINE void StoreWhole(FloatTag d, const RgbV& value, const Pointers3<float>& to, size_t i) {
  hn::StoreU(value.r, d, to.x() + i);
  hn::StoreU(value.g, d, to.y() + i);
  hn::StoreU(value.b, d, to.z() + i);
}

// Stores `count` lanes at most.
HWY_INLINE void StoreRgb(FloatTag d, size_t count, const RgbV& value, const Pointers3<float>& to,
                         size_t i) {
  if (count >= hn::Lanes(d)) {
    StoreWhole(d, value, to, i);
  } else {
    const auto mask = hn::FirstN(d, count);
    hn::BlendedStore(value.r, mask, d, to.x() + i);
    hn::BlendedStore(value.g, mask, d, to.y() + i);
    hn::BlendedStore(value.b, mask, d, to.z() + i);
  }
}

// What packets reflect: each part is the product of two, such as a colour and what falls on it.
struct PartV {
  RgbV color, scale;
};
struct DiffuseV {
  PartV diffuse;
};
struct ReflectedV : DiffuseV {
  PartV specular;
};

HWY_INLINE PartV ScaledPart(const RgbV& color, FloatV scale) {
  return {color, {scale, scale, scale}};
}
HWY_INLINE PartV WholePart(FloatTag d, const RgbV& value) {
  return ScaledPart(value, hn::Set(d, 1.0f));
}
HWY_INLINE RgbV RgbOf(const PartV& part) { return MulRgb(part.color, part.scale); }

// A range's arrays. Arrays are padded to whole vectors and ranges of a batch follow one another, so
// a packet may reach past its range: the lanes that do are not stored.
struct RangeArrays {
  Pointers3<const float> normal, to_view;
  Pointers3<float> diffuse, specular, sum;
  size_t end;

  explicit RangeArrays(const ShadeRange& range)
      : normal(PointersTo(range.surface.normal)),
        to_view(PointersTo(range.surface.to_view)),
        diffuse(PointersTo(&range.radiance->diffuse)),
        specular(PointersTo(&range.radiance->specular)),
        sum(PointersTo(&range.radiance->sum)),
        end(range.end) {}

  HWY_INLINE Vec3V<FloatV> Normal(FloatTag d, size_t i) const { return LoadAt(d, normal, i); }

  HWY_INLINE PacketV Packet(FloatTag d, size_t i) const {
    return {i, LoadAt(d, normal, i), LoadAt(d, to_view, i)};
  }

  HWY_INLINE void Store(FloatTag d, const RgbV& value, const Pointers3<float>& to, size_t i) const {
    StoreRgb(d, end - i, value, to, i);
  }
};

// The light of a batch's hits i..., of any form.
struct AnyLight {
  const LightOnBatch& light;
  const HitBatch& hits;
  HWY_INLINE LightV At(FloatTag d, size_t i, const Vec3V<FloatV>& normal) const {
    return LightAt(d, light, hits, i, normal);
  }
};

// Calls with_light(light): the most frequent form's numbers are then known before the loop.
template <class WithLight>
HWY_INLINE void VisitLight(FloatTag d, const LightOnBatch& light, const HitBatch& hits,
                           const WithLight& with_light) {
  if (light.evaluated == nullptr && light.light->form == LightForm::kInverseSquare) {
    VisitOffset(d, *light.light, hits,
                [&](const auto& offset) HWY_ATTR { with_light(PointLightV(offset)); });
  } else {
    with_light(AnyLight{light, hits});
  }
}

HWY_INLINE RgbV SumOf(const DiffuseV& of_light) { return RgbOf(of_light.diffuse); }
HWY_INLINE RgbV SumOf(const ReflectedV& of_light) {
  const RgbV diffuse = RgbOf(of_light.diffuse);
  const auto& [color, scale] = of_light.specular;
  return {hn::MulAdd(color.r, scale.r, diffuse.r), hn::MulAdd(color.g, scale.g, diffuse.g),
          hn::MulAdd(color.b, scale.b, diffuse.b)};
}

// Stores a packet's reflection of one light as `output` says.
template <class Reflected>
HWY_INLINE void StoreReflected(FloatTag d, const Reflected& of_light, OutputMode output,
                               const RangeArrays& arrays, size_t i) {
  constexpr bool kHasSpecular = std::is_same_v<Reflected, ReflectedV>;
  const RgbV diffuse = RgbOf(of_light.diffuse);
  if (output == OutputMode::kAccumulate) {
    arrays.Store(d, AddRgb(LoadAsRgb(d, arrays.diffuse, i), diffuse), arrays.diffuse, i);
    if constexpr (kHasSpecular) {
      const RgbV specular = RgbOf(of_light.specular);
      arrays.Store(d, AddRgb(LoadAsRgb(d, arrays.specular, i), specular), arrays.specular, i);
    }
    return;
  }
  if (output != OutputMode::kSum) {
    const FloatV zero = hn::Zero(d);
    RgbV specular{zero, zero, zero};
    if constexpr (kHasSpecular) specular = RgbOf(of_light.specular);
    arrays.Store(d, diffuse, arrays.diffuse, i);
    arrays.Store(d, specular, arrays.specular, i);
    if (output == OutputMode::kOverwrite) return;
  }
  arrays.Store(d, SumOf(of_light), arrays.sum, i);
}

// What `incident_at(packet)` brings to hits [begin, end) is reflected and stored.
template <class Model, class IncidentAt>
HWY_INLINE void ReflectLight(FloatTag d, const Model& model, const ShadeRange& range,
                             const RangeArrays& given, size_t k, size_t begin, size_t end,
                             const IncidentAt& incident_at) {
  const RangeArrays arrays = given;  // kept in registers: what is stored cannot be this copy
  const OutputMode output = k == 0 ? range.output : OutputMode::kAccumulate;
  for (size_t i = begin; i < end; i += hn::Lanes(d)) {
    const PacketV packet = arrays.Packet(d, i);
    const auto view = model.SeenBy(d, packet, range.surface);
    StoreReflected(d, model.Reflect(d, view, packet, incident_at(packet), k), output, arrays, i);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();
#endif
