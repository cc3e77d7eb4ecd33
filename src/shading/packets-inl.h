// SPDX-License-Identifier: Apache-2.0
// shading/packets-inl.h: the loops of all shading kernels over a range of hits.
//
// A shading formula is one long chain of dependent operations, and a processor's out-of-order
// window holds few of them. It is therefore cut into pieces: for a block of hits, small enough for
// the L1 cache, the first loop evaluates the light, the next one the half vector's angles or the
// lobe's cosine, and the last one the reflection. Each loop is short enough for several of its
// iterations to overlap.
#if defined(NACRE_SHADING_PACKETS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_SHADING_PACKETS_INL_H_
#undef NACRE_SHADING_PACKETS_INL_H_
#else
#define NACRE_SHADING_PACKETS_INL_H_
#endif

#include <algorithm>
#include <type_traits>

#include "brdf/fresnel-inl.h"
#include "shading/range-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {

inline constexpr size_t kBlockHits = 256;  // a multiple of every target's lanes

// The light on a block of hits.
class IncidentBlock {
 public:
  HWY_INLINE void Store(FloatTag d, size_t at, const LightV& light, FloatV n_dot_l) {
    hn::Store(light.toward.offset.x, d, x_ + at);
    hn::Store(light.toward.offset.y, d, y_ + at);
    hn::Store(light.toward.offset.z, d, z_ + at);
    hn::Store(light.toward.inverse_length, d, inverse_length_ + at);
    hn::Store(light.irradiance, d, irradiance_ + at);
    hn::Store(n_dot_l, d, n_dot_l_ + at);
  }

  HWY_INLINE TowardV Toward(FloatTag d, size_t at) const {
    return {{hn::Load(d, x_ + at), hn::Load(d, y_ + at), hn::Load(d, z_ + at)},
            hn::Load(d, inverse_length_ + at)};
  }

  HWY_INLINE FloatV NDotL(FloatTag d, size_t at) const { return hn::Load(d, n_dot_l_ + at); }

  HWY_INLINE IncidentV Load(FloatTag d, size_t at) const {
    return MakeIncident(d, Toward(d, at), NDotL(d, at), hn::Load(d, irradiance_ + at));
  }

 private:
  alignas(64) float x_[kBlockHits], y_[kBlockHits], z_[kBlockHits], inverse_length_[kBlockHits];
  alignas(64) float n_dot_l_[kBlockHits], irradiance_[kBlockHits];
};

// The light on a block of hits, with the angles of their half vectors.
class HalfBlock : public IncidentBlock {
 public:
  HWY_INLINE void StoreHalf(FloatTag d, size_t at, const HalfAnglesV<FloatV>& half,
                            FloatV n_dot_v) {
    hn::Store(n_dot_v, d, n_dot_v_ + at);
    hn::Store(half.n_dot_u, d, n_dot_u_ + at);
    hn::Store(half.nxu_squared, d, nxu_squared_ + at);
    hn::Store(half.lv_squared, d, lv_squared_ + at);
  }

  // Computes |u| and 1 - v.h of the `count` half vectors that were stored. This has a loop of its
  // own, for the reason that LobeBlock::TakeLogs states.
  HWY_INLINE void TakeLengths(FloatTag d, size_t count) {
    for (size_t at = 0; at < count; at += hn::Lanes(d)) {
      const FloatV n_dot_u = hn::Load(d, n_dot_u_ + at);
      const FloatV u_squared = USquared(n_dot_u, hn::Load(d, nxu_squared_ + at));
      const FloatV twice_u_length = TwiceSquareRoot(d, u_squared);
      hn::Store(twice_u_length, d, twice_u_length_ + at);
      hn::Store(OneMinusVDotH(d, hn::Load(d, lv_squared_ + at), twice_u_length), d,
                one_minus_vh_ + at);
    }
  }

  void SetAnyShort(bool any_short) { any_short_ = any_short; }

  HWY_INLINE HalfIncidentV Load(FloatTag d, size_t at) const {
    const FloatV n_dot_u = hn::Load(d, n_dot_u_ + at);
    const FloatV nxu_squared = hn::Load(d, nxu_squared_ + at);
    return {IncidentBlock::Load(d, at),
            {n_dot_u, USquared(n_dot_u, nxu_squared), nxu_squared, hn::Load(d, lv_squared_ + at)},
            hn::Load(d, n_dot_v_ + at),
            hn::Load(d, twice_u_length_ + at),
            hn::Load(d, one_minus_vh_ + at),
            any_short_,
            at};
  }

 private:
  alignas(64) float n_dot_v_[kBlockHits], n_dot_u_[kBlockHits];
  alignas(64) float nxu_squared_[kBlockHits], lv_squared_[kBlockHits];
  alignas(64) float twice_u_length_[kBlockHits], one_minus_vh_[kBlockHits];
  bool any_short_;
};

// The light on a block of hits, with the logarithms of the cosines of their lobes.
class LobeBlock : public IncidentBlock {
 public:
  HWY_INLINE void StoreLobe(FloatTag d, size_t at, const LobeCosineV<FloatV>& lobe) {
    hn::Store(lobe.one_minus_c, d, one_minus_c_ + at);
    hn::Store(lobe.c, d, c_ + at);
  }

  // Computes the logarithms of the `count` cosines that were stored. This has a loop of its own: as
  // a part of the loop before or after, it would make that one's dependency chain too long for
  // iterations to overlap in a processor's window.
  HWY_INLINE void TakeLogs(FloatTag d, size_t count) {
    for (size_t at = 0; at < count; at += hn::Lanes(d)) {
      const LobeCosineV<FloatV> cosine{hn::Load(d, one_minus_c_ + at), hn::Load(d, c_ + at)};
      hn::Store(LobeLog2(d, cosine), d, log2_cosine_ + at);
    }
  }

  HWY_INLINE LobeIncidentV Load(FloatTag d, size_t at) const {
    return {IncidentBlock::Load(d, at), hn::Load(d, log2_cosine_ + at)};
  }

 private:
  alignas(64) float one_minus_c_[kBlockHits], c_[kBlockHits], log2_cosine_[kBlockHits];
};

// Stores the light on hits [begin, end). Not inlined, because it is the same for all models.
inline HWY_NOINLINE void FillLight(const LitHits& lit, size_t begin, size_t end,
                                   IncidentBlock* block) {
  const FloatTag d;
  ForEachLit(d, lit, begin, end, [&](const PacketV& p, const LightV& light) HWY_ATTR {
    block->Store(d, p.i - begin, light, light.toward.Dot(p.normal));
  });
}

// Calls use(at, half, n_dot_v) with the half vector's angles of all hits of a block. Each hit's own
// |u|^2 decides between UprightHalfAngles and ComputeHalfAngles, whatever else is in the block.
// Usually no hit of a block needs the latter; returns whether one does.
template <class Use>
HWY_INLINE bool ForHalfAngles(const LitHits& lit, size_t begin, size_t end,
                              const IncidentBlock& block, const Use& use) {
  const FloatTag d;
  const RangeArrays arrays(lit);
  const FloatV enough = hn::Set(d, kUprightUSquared);
  FloatV least = enough;
  for (size_t at = 0; at < end - begin; at += hn::Lanes(d)) {
    const PacketV p = arrays.Packet(d, begin + at);
    const FloatV n_dot_v = FusedDot(p.normal, p.to_view);
    const TowardV toward = block.Toward(d, at);
    const HalfAnglesV<FloatV> half = UprightHalfAngles(
        d, p.normal, toward.Plus(p.to_view), toward.Minus(p.to_view), block.NDotL(d, at), n_dot_v);
    least = hn::Min(half.u_squared, least);
    use(at, half, n_dot_v);
  }
  if (hn::AllTrue(d, hn::Ge(least, enough))) return false;
  for (size_t at = 0; at < end - begin; at += hn::Lanes(d)) {
    const PacketV p = arrays.Packet(d, begin + at);
    const FloatV n_dot_v = FusedDot(p.normal, p.to_view);
    const TowardV toward = block.Toward(d, at);
    const HalfAnglesV<FloatV> upright = UprightHalfAngles(
        d, p.normal, toward.Plus(p.to_view), toward.Minus(p.to_view), block.NDotL(d, at), n_dot_v);
    const HalfAnglesV<FloatV> any = ComputeHalfAngles(d, p.normal, toward.Direction(), p.to_view);
    use(at, Choose(IsUpright(d, upright), upright, any), n_dot_v);
  }
  return true;
}

inline HWY_NOINLINE void FillHalf(const LitHits& lit, size_t begin, size_t end, HalfBlock* block) {
  const FloatTag d;
  const auto store = [&](size_t at, const HalfAnglesV<FloatV>& half, FloatV n_dot_v) HWY_ATTR {
    // Interpolated mesh normals may lean away from the viewer; n.v then counts as 0.
    block->StoreHalf(d, at, half, hn::Max(n_dot_v, hn::Zero(d)));
  };
  block->SetAnyShort(ForHalfAngles(lit, begin, end, *block, store));
  block->TakeLengths(d, end - begin);
}

// Stores, for each packet of the range, what `model` reflects of the light.
//   model.Reflect(packet, incident)       the reflected light
// Model::Incident is IncidentV, HalfIncidentV or LobeIncidentV. The logarithm in the latter is
// valid only if model.ReadsLobe(); then model.FillLobe(lit, begin, end, block) must store both
// the light and the lobes' cosines. A model of HalfIncidentV keeps the albedos that it needs of a
// block (FillAlbedos).
template <class Model>
HWY_INLINE void ShadePackets(FloatTag d, const Model& model, const LitHits& lit) {
  constexpr bool kHalf = std::is_same_v<typename Model::Incident, HalfIncidentV>;
  constexpr bool kLobe = std::is_same_v<typename Model::Incident, LobeIncidentV>;
  std::conditional_t<kHalf, HalfBlock, std::conditional_t<kLobe, LobeBlock, IncidentBlock>> block;
  for (size_t begin = lit.begin; begin < lit.end; begin += kBlockHits) {
    const size_t end = std::min(begin + kBlockHits, lit.end);
    if constexpr (kLobe) {
      if (model.ReadsLobe()) {
        model.FillLobe(lit, begin, end, &block);
        block.TakeLogs(d, end - begin);
      } else {
        FillLight(lit, begin, end, &block);
      }
    } else {
      FillLight(lit, begin, end, &block);
      if constexpr (kHalf) {
        FillHalf(lit, begin, end, &block);
        model.FillAlbedos(begin, end, block);
      }
    }
    const RangeArrays arrays(lit);
    for (size_t i = begin; i < end; i += hn::Lanes(d)) {
      const PacketV packet = arrays.Packet(d, i);
      arrays.Store(d, model.Reflect(d, packet, block.Load(d, i - begin)), i);
    }
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();
#endif
