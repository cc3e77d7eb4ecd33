// SPDX-License-Identifier: Apache-2.0
// visibility/alone-inl.h: camera rays against the only sphere that they may hit: what most rays of
// most pictures meet.
//
// From a film position to a hit it is one long chain of dependent operations, with a division and a
// root in it, far longer than a processor's window. Blocks of rays therefore take it in steps: each
// step's chain is short, and many groups of lanes are under way in it at a time.
#if defined(NACRE_VISIBILITY_ALONE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_VISIBILITY_ALONE_INL_H_
#undef NACRE_VISIBILITY_ALONE_INL_H_
#else
#define NACRE_VISIBILITY_ALONE_INL_H_
#endif

#include "visibility/append-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

inline constexpr int kAloneBlock = 8 * kCameraPacket;

// Rays of a batch that follow one another, on their way through the steps.
struct AloneBlock {
  size_t first_ray;
  const double* film_x;
  const double* film_y;
  // The packets, as bits, that all hit when the last block's rays were tested: most likely, as
  // inside a sphere's outline, they do so again, in the next row or sample.
  uint32_t likely = 0;
  // The groups of lanes that some ray was proposed in: where they begin, and which lanes.
  int groups;
  int lane[kAloneBlock];
  uint32_t bits[kAloneBlock];
  alignas(kVectorBytes) double direction[3][kAloneBlock];
  alignas(kVectorBytes) double dd[kAloneBlock];
  alignas(kVectorBytes) double inverse_dd[kAloneBlock];
  alignas(kVectorBytes) double half_chord[kAloneBlock];
  alignas(kVectorBytes) double perpendicular[3][kAloneBlock];
};

HWY_INLINE Vec3V<hn::Vec<CameraDouble>> LoadGroup(const double (&from)[3][kAloneBlock], int lane) {
  return Load3(CameraDouble(), from[0] + lane, from[1] + lane, from[2] + lane);
}

HWY_INLINE void StoreGroup(const Vec3V<hn::Vec<CameraDouble>>& v, int lane,
                           double (&to)[3][kAloneBlock]) {
  Store3(v, CameraDouble(), to[0] + lane, to[1] + lane, to[2] + lane);
}

// Proposes lanes; those of likely packets all, unasked: the exact test decides whatever it is told.
HWY_INLINE void ProposeGroups(const CameraFrame& frame, const TileCandidate& candidate, size_t rays,
                              CameraPacket* packet, AloneBlock* block) {
  const int step = static_cast<int>(hn::Lanes(CameraDouble()));
  const uint32_t group_bits = (1u << step) - 1;
  block->groups = 0;
  for (int first = 0; static_cast<size_t>(first) < rays; first += kCameraPacket) {
    const size_t left = rays - static_cast<size_t>(first);
    packet->lanes = left >= kCameraPacket ? 0xffffu : (1u << left) - 1;
    uint32_t lanes = packet->lanes;
    if ((block->likely >> (first / kCameraPacket) & 1) == 0) {
      packet->film_x = block->film_x + first;
      packet->film_y = block->film_y + first;
      FillFloatRays<true>(frame, packet);
      lanes = ProposedLanes<true, true>(frame, candidate, *packet);
    }
    for (int lane = 0; lane < kCameraPacket; lane += step) {
      const uint32_t bits = lanes >> lane & group_bits;
      block->lane[block->groups] = first + lane;
      block->bits[block->groups] = bits;
      block->groups += bits != 0 ? 1 : 0;
    }
  }
}

// The exact rays of the proposed groups.
HWY_INLINE void FillRays(const CameraFrame& frame, AloneBlock* block) {
  const CameraDouble d;
  const auto corner = SetVec3(d, frame.corner);
  const auto step_x = SetVec3(d, frame.step_x);
  const auto step_y = SetVec3(d, frame.step_y);
  const auto one = hn::Set(d, 1.0);
  for (int g = 0; g < block->groups; ++g) {
    const int lane = block->lane[g];
    const auto x = hn::LoadU(d, block->film_x + lane);
    const auto y = hn::LoadU(d, block->film_y + lane);
    // The operations of MakeCameraRays.
    const auto direction = Add(Add(corner, Scale(step_x, x)), Scale(step_y, y));
    const auto dd = Dot(direction, direction);
    StoreGroup(direction, lane, block->direction);
    hn::Store(dd, d, block->dd + lane);
    hn::Store(hn::Div(one, dd), d, block->inverse_dd + lane);
  }
}

// Leaves the lanes that hit. No depth is needed, and the line's test and its direction decide,
// which spares a division.
HWY_INLINE void TestLines(const TileCandidate& candidate, AloneBlock* block) {
  const CameraDouble d;
  const auto center = SetVec3(d, candidate.sphere.center);
  const auto radius = hn::Set(d, candidate.sphere.radius);
  const auto zero = hn::Zero(d);
  for (int g = 0; g < block->groups; ++g) {
    const int lane = block->lane[g];
    const auto hit = TestLine(d, center, LoadGroup(block->direction, lane),
                              hn::Load(d, block->inverse_dd + lane), radius);
    hn::Store(hit.half_chord, d, block->half_chord + lane);
    StoreGroup(hit.perpendicular, lane, block->perpendicular);
    block->bits[g] &= BitsOfMask(d, hn::And(hit.hit, hn::Gt(hit.closest, zero)));
  }
}

// After TestLines.
HWY_INLINE void FindLikely(AloneBlock* block) {
  uint32_t hit[kAloneBlock / kCameraPacket] = {};
  for (int g = 0; g < block->groups; ++g) {
    hit[block->lane[g] / kCameraPacket] |= block->bits[g] << (block->lane[g] % kCameraPacket);
  }
  block->likely = 0;
  for (int p = 0; p < kAloneBlock / kCameraPacket; ++p) {
    block->likely |= static_cast<uint32_t>(hit[p] == 0xffff) << p;
  }
}

HWY_INLINE void AppendBlock(const TileCandidate& candidate, const AloneBlock& block,
                            const HitsTo& to) {
  const CameraDouble d;
  const auto center = SetVec3(d, candidate.sphere.center);
  const auto inverse_radius = hn::Set(d, candidate.inverse_radius);
  for (int g = 0; g < block.groups; ++g) {
    if (block.bits[g] == 0) continue;
    const int lane = block.lane[g];
    const auto direction = LoadGroup(block.direction, lane);
    const SurfaceV<CameraDouble> surface =
        SphereSurface(d, direction, hn::Neg(hn::Load(d, block.half_chord + lane)),
                      LoadGroup(block.perpendicular, lane), center, inverse_radius);
    AppendSurface(surface, ToView(d, direction, hn::Load(d, block.dd + lane)), block.bits[g],
                  block.first_ray + static_cast<size_t>(lane), to);
    AppendPrimitive(candidate.primitive, block.bits[g], to.hits);
  }
}

// Appends the hits of `rays` perspective rays, from outside the candidate, from first_ray on.
HWY_INLINE void TraceAlone(const CameraFrame& frame, const TileCandidate& candidate,
                           const FilmBatch& film, size_t first_ray, size_t rays,
                           CameraPacket* packet, AloneBlock* block, const HitsTo& to) {
  for (size_t i = 0; i < rays; i += kAloneBlock) {
    const size_t count = std::min<size_t>(kAloneBlock, rays - i);
    block->first_ray = first_ray + i;
    block->film_x = film.x.data() + block->first_ray;
    block->film_y = film.y.data() + block->first_ray;
    ProposeGroups(frame, candidate, count, packet, block);
    FillRays(frame, block);
    TestLines(candidate, block);
    FindLikely(block);
    AppendBlock(candidate, *block, to);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();
#endif
