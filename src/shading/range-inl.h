// shading/range-inl.h: what all shading kernels share: the loop over a range of hits and the
// lights on them, loading a hit's vectors and adding to its radiance.
#if defined(NACRE_SHADING_RANGE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_SHADING_RANGE_INL_H_
#undef NACRE_SHADING_RANGE_INL_H_
#else
#define NACRE_SHADING_RANGE_INL_H_
#endif

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

HWY_INLINE void StoreRgb(FloatTag d, hn::Mask<FloatTag> mask, const RgbV& value, size_t i,
                         Soa3<float>* soa) {
  hn::BlendedStore(value.r, mask, d, soa->x.data() + i);
  hn::BlendedStore(value.g, mask, d, soa->y.data() + i);
  hn::BlendedStore(value.b, mask, d, soa->z.data() + i);
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

HWY_INLINE IncidentV IncidentAt(FloatTag d, const LightOnBatch& light, const HitBatch& hits,
                                const PacketV& packet) {
  const LightV at = LightAt(d, light, hits, packet.i);
  const FloatV n_dot_l = FusedDot(packet.normal, at.to_light);
  const auto lit = hn::Gt(n_dot_l, hn::Zero(d));
  const FloatV weight = hn::IfThenElseZero(lit, hn::Mul(n_dot_l, at.irradiance));
  return {at.to_light, n_dot_l, hn::IfThenElseZero(lit, at.irradiance), weight, lit};
}

// For each packet of the range: what `model` reflects of every light, in the order of the lights.
//   view = model.SeenBy(packet, surface)              what does not depend on the light
//   model.Add(view, packet, incident, k, &radiance)   adds what light k makes of it
// Sums stay in registers from light to light. Arrays are padded to whole vectors and ranges of a
// batch follow one another, so a packet may reach past its range: the lanes that do are not stored.
struct RadianceV {
  RgbV diffuse, specular;
};

template <class Model>
HWY_INLINE void ShadePackets(FloatTag d, const Model& model, const ShadeRange& range) {
  const Soa3<float>& n = range.surface.normal;
  const Soa3<float>& v = range.surface.to_view;
  const LightOnBatch* const lights = range.lights.data();
  const size_t light_count = range.lights.size();
  for (size_t i = range.begin; i < range.end; i += hn::Lanes(d)) {
    const PacketV packet{i, LoadU3(d, n.x.data() + i, n.y.data() + i, n.z.data() + i),
                         LoadU3(d, v.x.data() + i, v.y.data() + i, v.z.data() + i)};
    const auto view = model.SeenBy(d, packet, range.surface);
    RadianceV sum{LoadRgb(d, range.radiance->diffuse, i), LoadRgb(d, range.radiance->specular, i)};
    for (size_t k = 0; k < light_count; ++k) {
      model.Add(d, view, packet, IncidentAt(d, lights[k], range.hits, packet), k, &sum);
    }
    const auto mask = hn::FirstN(d, range.end - i);
    StoreRgb(d, mask, sum.diffuse, i, &range.radiance->diffuse);
    if constexpr (Model::kHasSpecular) {
      StoreRgb(d, mask, sum.specular, i, &range.radiance->specular);
    }
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();
#endif
