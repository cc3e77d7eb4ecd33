// SPDX-License-Identifier: Apache-2.0
// shading/packed_phong-inl.h: Phong's lobe on hits of one sphere under one point light. Of what is
// seen of a sphere, much of it has none: the light is behind it, or its reflection goes elsewhere.
// The lobe's power, nearly half of the work, is taken for the hits that have one.
#if defined(NACRE_SHADING_PACKED_PHONG_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_SHADING_PACKED_PHONG_INL_H_
#undef NACRE_SHADING_PACKED_PHONG_INL_H_
#else
#define NACRE_SHADING_PACKED_PHONG_INL_H_
#endif

#include <algorithm>

#include "base/pack-inl.h"
#include "shading/packets-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {

// From here on the power of kDarkLog2 is 0, as hits without a lobe are taken to have it.
inline constexpr float kLeastPackedExponent = 256 / -kDarkLog2;

// A block of hits. Before hit i there are i packed numbers at most, so whole vectors that are
// stored or loaded there end within the block.
struct PackedLobes {
  static constexpr size_t kHits = 512;  // a multiple of every target's lanes
  alignas(64) float irradiance[kHits], weight[kHits];
  alignas(64) float number[kHits], lobe[kHits];  // packed
  uint8_t kept[kHits + 7];  // LaneBytes of each packet, and what these ask for after the last
};

// What falls on hits [begin, begin + count), and the numbers of those that have a lobe, packed;
// returns how many.
template <class Cosine>
HWY_INLINE size_t FillPacked(const ShadeRange& range, const RangeArrays& given, size_t begin,
                             size_t count, PackedLobes* block) {
  const FloatTag d;
  const RangeArrays arrays = given;
  const FromOneSphere light(d, *range.lights[0].light, range.hits);
  size_t lobes = 0;
  uint8_t* kept = block->kept;
  for (size_t at = 0; at < count; at += hn::Lanes(d), kept += LaneBytes(d)) {
    const PacketV p = arrays.Packet(d, begin + at);
    // Not by MakeIncident: GCC takes no struct apart that is this large, but through memory.
    const Vec3V<FloatV> offset = light.At(d, p.i, p.normal);
    const FloatV inverse = InverseDistance<FromOneSphere::kApart>(d, FusedDot(offset, offset));
    const FloatV n_dot_l = hn::Mul(FusedDot(p.normal, offset), inverse);
    const auto lit = IsLit(d, n_dot_l);
    const FloatV if_lit = Cosine::Number(p, offset, inverse);
    const FloatV number = hn::IfThenElse(lit, if_lit, Cosine::NumberWithout(d));
    const FloatV irradiance = hn::IfThenElseZero(lit, hn::Mul(inverse, inverse));
    const FloatV weight = hn::IfThenElseZero(lit, hn::Mul(n_dot_l, irradiance));
    hn::Store(irradiance, d, block->irradiance + at);
    hn::Store(weight, d, block->weight + at);
    lobes += Pack(d, number, Cosine::HasLobe(d, number), block->number + lobes, kept);
  }
  return lobes;
}

// Their lobes.
template <class Cosine>
HWY_INLINE void TakePacked(float exponent, size_t lobes, PackedLobes* block) {
  const FloatTag d;
  const FloatV shininess = hn::Set(d, exponent);
  for (size_t at = 0; at < lobes; at += hn::Lanes(d)) {
    const FloatV number = hn::Load(d, block->number + at);
    hn::Store(Cosine::Lobe(d, number, shininess), d, block->lobe + at);
  }
}

// What the hits reflect.
template <bool kByWeight>
HWY_INLINE void SumPacked(const PhongLight& light, const RangeArrays& given, size_t begin,
                          size_t count, const PackedLobes& block) {
  const FloatTag d;
  const size_t lanes = hn::Lanes(d);
  const RangeArrays arrays = given;
  const RgbV diffuse = SetRgb(d, light.diffuse);
  const RgbV specular = SetRgb(d, light.specular);
  const float* packed = block.lobe;
  const uint8_t* kept = block.kept;
  const auto next_sum = [&](size_t at) HWY_ATTR {
    const FloatV lobe = Unpack(d, kept, &packed);
    kept += LaneBytes(d);
    const FloatV weight = hn::Load(d, block.weight + at);
    const FloatV by = kByWeight ? weight : hn::Load(d, block.irradiance + at);
    return SumOf(
        ReflectedV{{ScaledPart(diffuse, weight)}, ScaledPart(specular, hn::Mul(lobe, by))});
  };
  size_t at = 0;
  for (; at + lanes <= count; at += lanes) {
    StoreWhole(d, next_sum(at), arrays.sum, begin + at);
  }
  if (at < count) StoreRgb(d, count - at, next_sum(at), arrays.sum, begin + at);
}

// Leaves the bits that ShadePackets does, of ranges that are IsOneSphereUnderOneLight and exponents
// from kLeastPackedExponent on.
//   Cosine::Number(packet, offset, inverse_length)   what the lobe is a function of
//   Cosine::NumberWithout()                          the same of hits that are not lit: no lobe
//   Cosine::HasLobe(number)
//   Cosine::Lobe(number, shininess)
// kByWeight: the lobe has a cosine of its own, modified Phong's.
template <class Cosine, bool kByWeight>
HWY_NOINLINE void ShadePackedPhong(const PhongUniforms& uniforms, const ShadeRange& range) {
  const RangeArrays arrays(range);
  PackedLobes block;
  for (size_t begin = range.begin; begin < range.end; begin += PackedLobes::kHits) {
    const size_t count = std::min(range.end - begin, PackedLobes::kHits);
    const size_t lobes = FillPacked<Cosine>(range, arrays, begin, count, &block);
    TakePacked<Cosine>(uniforms.shininess, lobes, &block);
    SumPacked<kByWeight>(uniforms.lights[0], arrays, begin, count, block);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();
#endif
