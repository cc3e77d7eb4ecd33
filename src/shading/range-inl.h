// SPDX-License-Identifier: Apache-2.0
// shading/range-inl.h: code that all shading kernels share: loading a hit's vectors and the light
// on it, storing its radiance. The loops over hits are in shading/packets-inl.h.
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
#include "shading/soa-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using RgbV = Vec3V<FloatV>;

HWY_INLINE RgbV GreyOf(FloatV value) { return {value, value, value}; }

HWY_INLINE RgbV SetRgb(FloatTag d, const float (&rgb)[3]) {
  return {hn::Set(d, rgb[0]), hn::Set(d, rgb[1]), hn::Set(d, rgb[2])};
}

// A constant that all hits share, or the constants of hits i...
HWY_INLINE FloatV NumberAt(FloatTag d, float number, size_t) { return hn::Set(d, number); }
HWY_INLINE FloatV NumberAt(FloatTag d, const float* numbers, size_t i) {
  return hn::LoadU(d, numbers + i);
}

template <class Number>
HWY_INLINE RgbV RgbAt(FloatTag d, const Number (&rgb)[3], size_t i) {
  return {NumberAt(d, rgb[0], i), NumberAt(d, rgb[1], i), NumberAt(d, rgb[2], i)};
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

// One light on the hits of a packet. `irradiance` is perpendicular to the light, `weight` is
// irradiance n.l. Where n_dot_l is not above 0, the surface faces away: both are 0, and terms that
// are computed from the direction must be masked by IsLit.
struct IncidentV {
  TowardV toward;
  FloatV n_dot_l, irradiance, weight;
};

// IncidentV with the angles of the half vector and to the viewer.
struct HalfIncidentV : IncidentV {
  HalfAnglesV<FloatV> half;
  FloatV n_dot_v;
  FloatV twice_u_length, one_minus_vh;
  bool any_short;  // false: all half vectors of the block are IsUpright
  size_t at;       // the first lane's place in its block
};

// IncidentV with LobeLog2 of the cosine of Phong's lobe, or of the squared cosine of Blinn's.
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

// Stores at most `count` lanes.
HWY_INLINE void StoreRgb(FloatTag d, size_t count, const RgbV& value, const Pointers3<float>& to,
                         size_t i) {
  if (count >= hn::Lanes(d)) {
    hn::StoreU(value.x, d, to.x() + i);
    hn::StoreU(value.y, d, to.y() + i);
    hn::StoreU(value.z, d, to.z() + i);
  } else {
    const auto mask = hn::FirstN(d, count);
    hn::BlendedStore(value.x, mask, d, to.x() + i);
    hn::BlendedStore(value.y, mask, d, to.y() + i);
    hn::BlendedStore(value.z, mask, d, to.z() + i);
  }
}

// The light that a packet reflects. Each component is a product of two factors, such as a colour
// and the light that falls on it.
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
HWY_INLINE RgbV RgbOf(const PartV& part) { return Mul3(part.color, part.scale); }

// The arrays of a range. Arrays are padded to whole vectors, and ranges of a batch follow one
// another, so a packet may extend past its range; lanes past the end are not stored.
struct RangeArrays {
  Pointers3<const float> normal, to_view;
  Pointers3<float> sum, diffuse, specular;
  bool components;
  size_t end;

  explicit RangeArrays(const LitHits& lit)
      : normal(PointersTo(lit.surface.normal)),
        to_view(PointersTo(lit.surface.to_view)),
        sum(PointersTo(&lit.radiance->sum)),
        diffuse(PointersTo(&lit.radiance->diffuse)),
        specular(PointersTo(&lit.radiance->specular)),
        components(lit.components),
        end(lit.end) {}

  HWY_INLINE PacketV Packet(FloatTag d, size_t i) const {
    return {i, LoadAt(d, normal, i), LoadAt(d, to_view, i)};
  }

  HWY_INLINE void Store(FloatTag d, const ReflectedV& reflected, size_t i) const {
    const RgbV of_diffuse = RgbOf(reflected.diffuse);
    const auto& [color, scale] = reflected.specular;
    StoreRgb(
        d, end - i,
        {hn::MulAdd(color.x, scale.x, of_diffuse.x), hn::MulAdd(color.y, scale.y, of_diffuse.y),
         hn::MulAdd(color.z, scale.z, of_diffuse.z)},
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

// Calls use(at), where at(d, i, normal) is the light at hits i..., which was evaluated before
// (LitHits::on_hits) or is evaluated here.
template <class Use>
HWY_INLINE void VisitLight(FloatTag d, const LitHits& lit, const Use& use) {
  const ShadingLight& light = lit.light;
  if (lit.on_hits != nullptr) {
    const Pointers3<const float> toward = PointersTo(lit.on_hits->light_vector);
    const float* const irradiance = lit.on_hits->irradiance.data();
    const float* const inverse_length = lit.on_hits->inverse_length.data();
    const bool is_unit = light.form == LightForm::kGiven;
    use([=](FloatTag tag, size_t i, const Vec3V<FloatV>&) HWY_ATTR {
      const FloatV inverse = is_unit ? hn::Set(tag, 1.0f) : hn::LoadU(tag, inverse_length + i);
      return LightV{{LoadAt(tag, toward, i), inverse}, hn::LoadU(tag, irradiance + i)};
    });
  } else if (light.form == LightForm::kDirectional) {
    const LightV same = DirectionalAt(d, light);
    use([same](FloatTag, size_t, const Vec3V<FloatV>&) HWY_ATTR { return same; });
  } else {
    VisitOffsets(d, light, lit.hits, [&](const auto& offset) HWY_ATTR {
      use([&, offset](FloatTag tag, size_t i, const Vec3V<FloatV>& normal) HWY_ATTR {
        return PositionalAt<LightForm::kInverseSquare>(tag, light, offset(tag, i, normal));
      });
    });
  }
}

// Calls use(p, light) for each packet p of hits [begin, end) and the light on it.
template <class Use>
HWY_INLINE void ForEachLit(FloatTag d, const LitHits& lit, size_t begin, size_t end,
                           const Use& use) {
  const RangeArrays arrays(lit);  // a local copy stays in registers: no store can alias it
  VisitLight(d, lit, [&](const auto& light_at) HWY_ATTR {
    for (size_t i = begin; i < end; i += hn::Lanes(d)) {
      const PacketV p = arrays.Packet(d, i);
      use(p, light_at(d, i, p.normal));
    }
  });
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();
#endif
