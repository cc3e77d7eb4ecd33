// SPDX-License-Identifier: Apache-2.0
// shading/range-inl.h: what all shading kernels share: the loop over a range of hits and the
// lights on them, loading a hit's vectors and adding to its radiance.
#if defined(NACRE_SHADING_RANGE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_SHADING_RANGE_INL_H_
#undef NACRE_SHADING_RANGE_INL_H_
#else
#define NACRE_SHADING_RANGE_INL_H_
#endif

#include <span>

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

// One light on them. Where n_dot_l is not above 0 the surface faces away: `irradiance` and
// `weight`, its share that falls on the surface, are then 0, and whatever else is made of the
// direction must be kept from the sum by `lit`.
struct IncidentV {
  Vec3V<FloatV> to_light;
  FloatV n_dot_l, irradiance, weight;
  hn::Mask<FloatTag> lit;
};

HWY_INLINE IncidentV MakeIncident(FloatTag d, const LightV& at, const PacketV& packet) {
  const FloatV n_dot_l = FusedDot(packet.normal, at.to_light);
  const auto lit = hn::Gt(n_dot_l, hn::Zero(d));
  const FloatV weight = hn::IfThenElseZero(lit, hn::Mul(n_dot_l, at.irradiance));
  return {at.to_light, n_dot_l, hn::IfThenElseZero(lit, at.irradiance), weight, lit};
}

// The arrays of three coordinates, in registers: what a kernel stores might be their pointers, for
// all that the compiler knows.
template <typename T>
struct Pointers3 {
  T* HWY_RESTRICT x;
  T* HWY_RESTRICT y;
  T* HWY_RESTRICT z;
};

HWY_INLINE Pointers3<const float> PointersTo(const Soa3<float>& soa) {
  return {soa.x.data(), soa.y.data(), soa.z.data()};
}

HWY_INLINE Pointers3<float> PointersTo(Soa3<float>* soa) {
  return {soa->x.data(), soa->y.data(), soa->z.data()};
}

HWY_INLINE Vec3V<FloatV> LoadAt(FloatTag d, const Pointers3<const float>& from, size_t i) {
  return LoadU3(d, from.x + i, from.y + i, from.z + i);
}

HWY_INLINE RgbV LoadAsRgb(FloatTag d, const Pointers3<float>& from, size_t i) {
  return {hn::LoadU(d, from.x + i), hn::LoadU(d, from.y + i), hn::LoadU(d, from.z + i)};
}

// Stores `count` lanes at most.
HWY_INLINE void StoreRgb(FloatTag d, size_t count, const RgbV& value, const Pointers3<float>& to,
                         size_t i) {
  if (count >= hn::Lanes(d)) {
    hn::StoreU(value.r, d, to.x + i);
    hn::StoreU(value.g, d, to.y + i);
    hn::StoreU(value.b, d, to.z + i);
  } else {
    const auto mask = hn::FirstN(d, count);
    hn::BlendedStore(value.r, mask, d, to.x + i);
    hn::BlendedStore(value.g, mask, d, to.y + i);
    hn::BlendedStore(value.b, mask, d, to.z + i);
  }
}

// What packets reflect.
struct RadianceV {
  RgbV diffuse, specular;
};

// One light, in the most frequent case, known before the loop.
struct OneLight {
  PointLightV light;

  template <class Model>
  HWY_INLINE RadianceV Reflect(FloatTag d, const Model& model, const typename Model::View& view,
                               const PacketV& packet) const {
    return model.Reflect(d, view, packet, MakeIncident(d, light.At(d, packet.i), packet), 0);
  }
};

// Any lights. Their sum stays in registers from light to light.
struct ManyLights {
  const HitBatch& hits;
  std::span<const LightOnBatch> lights;

  template <class Model>
  HWY_INLINE RadianceV Reflect(FloatTag d, const Model& model, const typename Model::View& view,
                               const PacketV& packet, RadianceV sum) const {
    for (size_t k = 0; k < lights.size(); ++k) {
      const LightV at = LightAt(d, lights[k], hits, packet.i);
      const RadianceV of_light = model.Reflect(d, view, packet, MakeIncident(d, at, packet), k);
      sum.diffuse = AddRgb(sum.diffuse, of_light.diffuse);
      sum.specular = AddRgb(sum.specular, of_light.specular);
    }
    return sum;
  }
};

// A range's arrays. Arrays are padded to whole vectors and ranges of a batch follow one another, so
// a packet may reach past its range: the lanes that do are not stored.
struct RangeArrays {
  Pointers3<const float> normal, to_view;
  Pointers3<float> diffuse, specular;
  size_t end;

  explicit RangeArrays(const ShadeRange& range)
      : normal(PointersTo(range.surface.normal)),
        to_view(PointersTo(range.surface.to_view)),
        diffuse(PointersTo(&range.radiance->diffuse)),
        specular(PointersTo(&range.radiance->specular)),
        end(range.end) {}

  HWY_INLINE PacketV Packet(FloatTag d, size_t i) const {
    return {i, LoadAt(d, normal, i), LoadAt(d, to_view, i)};
  }

  HWY_INLINE RadianceV Load(FloatTag d, size_t i) const {
    return {LoadAsRgb(d, diffuse, i), LoadAsRgb(d, specular, i)};
  }

  template <bool kSpecular>
  HWY_INLINE void Store(FloatTag d, const RadianceV& sum, size_t i) const {
    StoreRgb(d, end - i, sum.diffuse, diffuse, i);
    if constexpr (kSpecular) StoreRgb(d, end - i, sum.specular, specular, i);
  }
};

// ShadePackets by one light.
template <class Model>
HWY_INLINE void ShadeByOne(FloatTag d, const Model& model, const OneLight& light,
                           const ShadeRange& range) {
  const RangeArrays arrays(range);
  const bool replace = range.replace;
  for (size_t i = range.begin; i < arrays.end; i += hn::Lanes(d)) {
    const PacketV packet = arrays.Packet(d, i);
    const auto view = model.SeenBy(d, packet, range.surface);
    const RadianceV of_light = light.Reflect(d, model, view, packet);
    if (replace) {
      arrays.Store<true>(d, of_light, i);
    } else {
      const RadianceV sum = arrays.Load(d, i);
      arrays.Store<Model::kHasSpecular>(
          d, {AddRgb(sum.diffuse, of_light.diffuse), AddRgb(sum.specular, of_light.specular)}, i);
    }
  }
}

template <class Model>
HWY_INLINE void ShadeByMany(FloatTag d, const Model& model, const ManyLights& lights,
                            const ShadeRange& range) {
  const RangeArrays arrays(range);
  const FloatV zero = hn::Zero(d);
  const RgbV black{zero, zero, zero};
  const bool replace = range.replace;
  for (size_t i = range.begin; i < arrays.end; i += hn::Lanes(d)) {
    const PacketV packet = arrays.Packet(d, i);
    const auto view = model.SeenBy(d, packet, range.surface);
    const RadianceV before = replace ? RadianceV{black, black} : arrays.Load(d, i);
    arrays.Store<true>(d, lights.Reflect(d, model, view, packet, before), i);
  }
}

// For each packet of the range: what `model` reflects of every light, added in the order of the
// lights.
//   view = model.SeenBy(packet, surface)             what does not depend on the light
//   model.Reflect(view, packet, incident, k)         what it makes of light k
template <class Model>
HWY_INLINE void ShadePackets(FloatTag d, const Model& model, const ShadeRange& range) {
  const LightOnBatch& first = range.lights[0];
  if (range.lights.size() == 1 && first.evaluated == nullptr &&
      first.light->form == LightForm::kInverseSquare) {
    ShadeByOne(d, model, OneLight{PointLightV(d, *first.light, range.hits.position)}, range);
  } else {
    ShadeByMany(d, model, ManyLights{range.hits, range.lights}, range);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();
#endif
