// SPDX-License-Identifier: Apache-2.0
// shading/packets-inl.h: the loops of all shading kernels over a range of hits and its lights.
//
// A shading formula is one long chain of dependent operations, and a processor's window holds few
// of them. So it is cut in pieces: for a block of hits, small enough for the nearest cache, first
// what the light is, then the half vector's angles, then what is reflected. Each loop is short
// enough for several of its turns to overlap.
#if defined(NACRE_SHADING_PACKETS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_SHADING_PACKETS_INL_H_
#undef NACRE_SHADING_PACKETS_INL_H_
#else
#define NACRE_SHADING_PACKETS_INL_H_
#endif

#include <algorithm>
#include <type_traits>

#include "shading/range-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {

// One light on a block of hits.
class IncidentBlock {
 public:
  static constexpr size_t kHits = 256;  // a multiple of every target's lanes

  template <bool kWithIrradiance>
  HWY_INLINE void Store(FloatTag d, size_t at, const IncidentV& in) {
    hn::Store(in.toward.offset.x, d, x_ + at);
    hn::Store(in.toward.offset.y, d, y_ + at);
    hn::Store(in.toward.offset.z, d, z_ + at);
    hn::Store(in.toward.inverse_length, d, inverse_length_ + at);
    hn::Store(in.n_dot_l, d, n_dot_l_ + at);
    if (kWithIrradiance) hn::Store(in.irradiance, d, irradiance_ + at);
    hn::Store(in.weight, d, weight_ + at);
  }

  HWY_INLINE TowardV Toward(FloatTag d, size_t at) const {
    return {{hn::Load(d, x_ + at), hn::Load(d, y_ + at), hn::Load(d, z_ + at)},
            hn::Load(d, inverse_length_ + at)};
  }

  HWY_INLINE FloatV NDotL(FloatTag d, size_t at) const { return hn::Load(d, n_dot_l_ + at); }

  HWY_INLINE IncidentV Load(FloatTag d, size_t at) const {
    const FloatV n_dot_l = NDotL(d, at);
    return {Toward(d, at), n_dot_l, hn::Load(d, irradiance_ + at), hn::Load(d, weight_ + at)};
  }

  template <bool kWithLv>
  HWY_INLINE void StoreHalf(FloatTag d, size_t at, const HalfAnglesV<FloatV>& half,
                            FloatV n_dot_v) {
    hn::Store(n_dot_v, d, n_dot_v_ + at);
    hn::Store(half.n_dot_u, d, n_dot_u_ + at);
    hn::Store(half.nxu_squared, d, nxu_squared_ + at);
    if (kWithLv) hn::Store(half.lv_squared, d, lv_squared_ + at);
  }

  HWY_INLINE void StoreLobe(FloatTag d, size_t at, const LobeCosineV<FloatV>& lobe) {
    hn::Store(lobe.one_minus_c, d, one_minus_c_ + at);
    hn::Store(lobe.c, d, c_ + at);
  }

  HWY_INLINE FloatV LoadLobeLog2(FloatTag d, size_t at) const {
    return hn::Load(d, log2_cosine_ + at);
  }

  void SetAnyShort(bool any_short) { any_short_ = any_short; }

  // The logarithms of `count` cosines that were stored, in a loop of their own: with them either of
  // the loops around it would be one chain longer than a processor's window overlaps.
  HWY_INLINE void TakeLobeLogs(FloatTag d, size_t count) {
    for (size_t at = 0; at < count; at += hn::Lanes(d)) {
      const LobeCosineV<FloatV> cosine{hn::Load(d, one_minus_c_ + at), hn::Load(d, c_ + at)};
      hn::Store(LobeLog2(d, cosine), d, log2_cosine_ + at);
    }
  }

  HWY_INLINE HalfIncidentV LoadHalf(FloatTag d, size_t at) const {
    const FloatV n_dot_u = hn::Load(d, n_dot_u_ + at);
    const FloatV nxu_squared = hn::Load(d, nxu_squared_ + at);
    return {Load(d, at),
            {n_dot_u, USquared(n_dot_u, nxu_squared), nxu_squared, hn::Load(d, lv_squared_ + at)},
            hn::Load(d, n_dot_v_ + at),
            any_short_};
  }

 private:
  static constexpr size_t kAlignment = 64;
  alignas(kAlignment) float x_[kHits], y_[kHits], z_[kHits], inverse_length_[kHits];
  alignas(kAlignment) float n_dot_l_[kHits], weight_[kHits];
  alignas(kAlignment) float n_dot_v_[kHits], n_dot_u_[kHits], nxu_squared_[kHits];
  // Loaded by all models, used by those alone for which they were stored.
  alignas(kAlignment) float irradiance_[kHits], lv_squared_[kHits];
  alignas(kAlignment) float one_minus_c_[kHits], c_[kHits], log2_cosine_[kHits];
  bool any_short_;
};

// The light of hits [begin, end), with or without its irradiance. Not inlined, as it is the same
// for all models.
template <bool kWithIrradiance>
HWY_NOINLINE void FillLight(const LightOnBatch& light, const HitBatch& hits,
                            const RangeArrays& arrays, size_t begin, size_t end,
                            IncidentBlock* block) {
  const FloatTag d;
  VisitLight(d, light, hits, [&](const auto& known) HWY_ATTR {
    for (size_t i = begin; i < end; i += hn::Lanes(d)) {
      const Vec3V<FloatV> normal = arrays.Normal(d, i);
      block->Store<kWithIrradiance>(d, i - begin, MakeIncident(d, known.At(d, i, normal), normal));
    }
  });
}

// Calls use(at, half, n_dot_v) with the half vector's angles of all hits of a block. Hits choose
// how they are formed by their own |u|^2, whatever else is in the block; but as a rule none of a
// block's needs more than u as it is.
template <class Use>
HWY_INLINE bool ForHalfAngles(const RangeArrays& given, size_t begin, size_t end,
                              const IncidentBlock& block, const Use& use) {
  const FloatTag d;
  const RangeArrays arrays = given;  // kept in registers: what is stored cannot be this copy
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

// The angles of their half vectors, with or without |l - v|^2, and to the viewer.
template <bool kWithLv>
HWY_NOINLINE void FillHalf(const RangeArrays& arrays, size_t begin, size_t end,
                           IncidentBlock* block) {
  const FloatTag d;
  const auto store = [&](size_t at, const HalfAnglesV<FloatV>& half, FloatV n_dot_v) HWY_ATTR {
    // Interpolated mesh normals may lean away from the viewer: that counts as 0.
    block->StoreHalf<kWithLv>(d, at, half, hn::Max(n_dot_v, hn::Zero(d)));
  };
  block->SetAnyShort(ForHalfAngles(arrays, begin, end, *block, store));
}

template <class Model>
HWY_INLINE void ShadeBlock(FloatTag d, const Model& model, const ShadeRange& range,
                           const RangeArrays& arrays, size_t k, size_t begin, size_t end,
                           IncidentBlock* block) {
  constexpr bool kHalf = std::is_same_v<typename Model::Incident, HalfIncidentV>;
  constexpr bool kLobe = std::is_same_v<typename Model::Incident, LobeIncidentV>;
  FillLight<Model::kReadsIrradiance>(range.lights[k], range.hits, arrays, begin, end, block);
  if constexpr (kHalf) {
    const auto fill = model.ReadsLv() ? FillHalf<true> : FillHalf<false>;
    fill(arrays, begin, end, block);
  } else if constexpr (kLobe) {
    if (model.ReadsLobe()) {
      model.FillLobe(arrays, begin, end, block);
      block->TakeLobeLogs(d, end - begin);
    }
  }
  ReflectLight(d, model, range, arrays, k, begin, end, [&](const PacketV& p) HWY_ATTR {
    if constexpr (kHalf) {
      return block->LoadHalf(d, p.i - begin);
    } else if constexpr (kLobe) {
      return LobeIncidentV{block->Load(d, p.i - begin), block->LoadLobeLog2(d, p.i - begin)};
    } else {
      return block->Load(d, p.i - begin);
    }
  });
}

// For each packet of the range: what `model` reflects of every light, added in the order of the
// lights.
//   view = model.SeenBy(packet, surface)             what does not depend on the light
//   model.Reflect(view, packet, incident, k)         what it makes of light k
// `Model::Incident`: IncidentV, HalfIncidentV or LobeIncidentV. Model::kReadsIrradiance tells
// whether IncidentV::irradiance has a meaning to the model, model.ReadsLv() whether
// HalfAnglesV::lv_squared has, and model.ReadsLobe() whether LobeIncidentV::log2_cosine has, of
// the cosines that model.FillLobe(arrays, begin, end, block) stores; else they need not be there.
template <class Model>
HWY_INLINE void ShadePackets(FloatTag d, const Model& model, const ShadeRange& range) {
  const RangeArrays arrays(range);
  IncidentBlock block;
  for (size_t begin = range.begin; begin < range.end; begin += IncidentBlock::kHits) {
    const size_t end = std::min(begin + IncidentBlock::kHits, range.end);
    for (size_t k = 0; k < range.lights.size(); ++k) {
      ShadeBlock(d, model, range, arrays, k, begin, end, &block);
    }
  }
}

// The same in one loop, for models with next to nothing to overlap.
template <class Model>
HWY_INLINE void ShadeBriefly(FloatTag d, const Model& model, const ShadeRange& range) {
  const RangeArrays arrays(range);
  for (size_t k = 0; k < range.lights.size(); ++k) {
    VisitLight(d, range.lights[k], range.hits, [&](const auto& visited) HWY_ATTR {
      const auto light = visited;  // kept in registers: what is stored cannot be this copy
      ReflectLight(d, model, range, arrays, k, range.begin, range.end,
                   [&](const PacketV& p)
                       HWY_ATTR { return MakeIncident(d, light.At(d, p.i, p.normal), p.normal); });
    });
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();
#endif
