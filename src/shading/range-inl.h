// SPDX-License-Identifier: Apache-2.0
// shading/range-inl.h: what all shading kernels share: loading a hit's vectors, the light on it,
// storing its radiance. The loops over hits: shading/packets-inl.h.
#if defined(NACRE_SHADING_RANGE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_SHADING_RANGE_INL_H_
#undef NACRE_SHADING_RANGE_INL_H_
#else
#define NACRE_SHADING_RANGE_INL_H_
#endif

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
  FloatV twice_u_length, one_minus_vh;
  bool any_short;  // false: all half vectors of the block are IsUpright
};

// With LobeLog2 of the cosine of Phong's lobe, or of the square of Blinn's.
struct LobeIncidentV : IncidentV {
  FloatV log2_cosine;
};

HWY_INLINE hn::Mask<FloatTag> IsLit(FloatTag d, FloatV n_dot_l) {
  return hn::Gt(n_dot_l, hn::Zero(d));
}

HWY_INLINE IncidentV MakeIncident(FloatTag d, const TowardV& toward, FloatV n_dot_l,
                                  FloatV irradiance) {
  const auto lit = IsLit(d, n_dot_l);
  const FloatV on_lit = hn::IfThenElseZero(lit, irradiance);
  const FloatV weight = hn::IfThenElseZero(lit, hn::Mul(n_dot_l, on_lit));
  return {toward, n_dot_l, on_lit, weight};
}

HWY_INLINE IncidentV MakeIncident(FloatTag d, const LightV& at, const Vec3V<FloatV>& normal) {
  return MakeIncident(d, at.toward, at.toward.Dot(normal), at.irradiance);
}

HWY_INLINE Vec3V<FloatV> LoadAt(FloatTag d, const Pointers3<const float>& from, size_t i) {
  return LoadU3(d, from.x() + i, from.y() + i, from.z() + i);
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
  const ShadingLight& light;
  const HitBatch& hits;
  const LightBatch* on_hits;
  Pointers3<float> sum, diffuse, specular;
  bool components;
  size_t end;

  explicit RangeArrays(const ShadeRange& range)
      : normal(PointersTo(range.surface.normal)),
        to_view(PointersTo(range.surface.to_view)),
        light(range.light),
        hits(range.hits),
        on_hits(range.on_hits),
        sum(PointersTo(&range.radiance->sum)),
        diffuse(PointersTo(&range.radiance->diffuse)),
        specular(PointersTo(&range.radiance->specular)),
        components(range.components),
        end(range.end) {}

  HWY_INLINE Vec3V<FloatV> Normal(FloatTag d, size_t i) const { return LoadAt(d, normal, i); }

  HWY_INLINE PacketV Packet(FloatTag d, size_t i) const {
    return {i, LoadAt(d, normal, i), LoadAt(d, to_view, i)};
  }

  // The light: given, evaluated before, or evaluated here. Vectors, not structs, are what the
  // branches choose: GCC takes a struct that they choose through memory.
  HWY_INLINE LightV Light(FloatTag d, size_t i, const Vec3V<FloatV>& n) const {
    FloatV x, y, z, inverse_length, irradiance;
    const auto take = [&](const LightV& at) HWY_ATTR {
      x = at.toward.offset.x;
      y = at.toward.offset.y;
      z = at.toward.offset.z;
      inverse_length = at.toward.inverse_length;
      irradiance = at.irradiance;
    };
    if (on_hits != nullptr) {
      const Soa3<float>& l = on_hits->to_light;
      const FloatV inverse = light.form == LightForm::kGiven
                                 ? hn::Set(d, 1.0f)
                                 : hn::LoadU(d, on_hits->inverse_length.data() + i);
      take({{LoadU3(d, l.x.data() + i, l.y.data() + i, l.z.data() + i), inverse},
            hn::LoadU(d, on_hits->irradiance.data() + i)});
    } else if (light.form == LightForm::kDirectional) {
      take(DirectionalAt(d, light));
    } else {
      take(PositionalAt<LightForm::kInverseSquare>(d, light, OffsetByNormal(d, light, hits, i, n)));
    }
    return {{{x, y, z}, inverse_length}, irradiance};
  }

  HWY_INLINE void Store(FloatTag d, const ReflectedV& reflected, size_t i) const {
    const RgbV of_diffuse = RgbOf(reflected.diffuse);
    const auto& [color, scale] = reflected.specular;
    StoreRgb(
        d, end - i,
        {hn::MulAdd(color.r, scale.r, of_diffuse.r), hn::MulAdd(color.g, scale.g, of_diffuse.g),
         hn::MulAdd(color.b, scale.b, of_diffuse.b)},
        sum, i);
    if (!components) return;
    StoreRgb(d, end - i, of_diffuse, diffuse, i);
    StoreRgb(d, end - i, RgbOf(reflected.specular), specular, i);
  }
  HWY_INLINE void Store(FloatTag d, const DiffuseV& reflected, size_t i) const {
    const RgbV of_diffuse = RgbOf(reflected.diffuse);
    StoreRgb(d, end - i, of_diffuse, sum, i);
    if (!components) return;
    const FloatV zero = hn::Zero(d);
    StoreRgb(d, end - i, of_diffuse, diffuse, i);
    StoreRgb(d, end - i, {zero, zero, zero}, specular, i);
  }
};

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();
#endif
