// SPDX-License-Identifier: Apache-2.0
// visibility/single_sphere-inl.h: camera rays against the only sphere that they may hit, which lies
// in front of the camera. Most rays of most pictures take this path.
//
// A hit is computed from its film position by one long chain of dependent operations, including a
// square root, which is longer than a processor's out-of-order window. Rays are therefore collected
// in blocks, which are processed in two passes: each pass interleaves the shorter chains of several
// vectors.
#if defined(NACRE_VISIBILITY_SINGLE_SPHERE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_VISIBILITY_SINGLE_SPHERE_INL_H_
#undef NACRE_VISIBILITY_SINGLE_SPHERE_INL_H_
#else
#define NACRE_VISIBILITY_SINGLE_SPHERE_INL_H_
#endif

#include "visibility/append-inl.h"
#include "visibility/projected_sphere_test-inl.h"
#include "visibility/sphere_test-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

inline constexpr int kSingleSphereBlock = 8 * kCameraPacket;

// Consecutive rays of a batch that can hit only one sphere.
struct SingleSphereRays {
  const TileCandidate* candidate;
  uint32_t first, count;
};

// Groups of lanes between the two passes. The rays of a group are consecutive in a batch and can
// hit only one sphere.
struct SingleSphereBlock {
  int groups = 0;
  uint32_t ray[kSingleSphereBlock];   // index in the batch of a group's first ray
  uint32_t bits[kSingleSphereBlock];  // lanes to be tested; after TestRays, those that hit
  const TileCandidate* candidate[kSingleSphereBlock];
  bool projected = false;  // all spheres of the block use the projected test, or none does
  alignas(kVectorBytes) double backward[3][kSingleSphereBlock];  // the negated ray directions
  alignas(kVectorBytes) double inverse_length[kSingleSphereBlock];
  // Terms of a hit's normal. The projected test stores BackToHit in `root` and the offset in
  // `moment`. The general test stores the root and the moment of TestSphere, and |direction|^2 in
  // `dd`.
  alignas(kVectorBytes) double root[kSingleSphereBlock];
  alignas(kVectorBytes) double moment[3][kSingleSphereBlock];
  alignas(kVectorBytes) double dd[kSingleSphereBlock];
};

// The first pass: the exact test of the groups' rays, which leaves in `bits` the lanes that hit.
// Directions are negated, which changes no other bit, because hits keep the direction to the
// viewer. No depth is computed, which saves a division: a ray hits a sphere in front of the camera
// wherever its line meets it. The square root (NaN in lanes that miss) is computed in this pass,
// where its unit works in parallel with the multipliers. This function and AppendBlock are not
// inlined, so that the code around them takes none of their registers.
template <bool kProjected>
HWY_NOINLINE HWY_ATTR void TestRays(const CameraFrame& frame, const FilmBatch& film,
                                    SingleSphereBlock* block) {
  const CameraDouble d;
  const auto corner = SetVec3(d, -frame.corner);
  const auto step_x = SetVec3(d, -frame.step_x);
  const auto step_y = SetVec3(d, -frame.step_y);
  for (int g = 0; g < block->groups; ++g) {
    const int first = g * kGroupLanes;
    const TileCandidate& candidate = *block->candidate[g];
    const auto x = hn::LoadU(d, film.x.data() + block->ray[g]);
    const auto y = hn::LoadU(d, film.y.data() + block->ray[g]);
    // The same operations as in MakeCameraRays.
    const auto backward = MulAdd3(step_y, y, MulAdd3(step_x, x, corner));
    const auto dd = FusedDot(backward, backward);
    Store3(backward, d, block->backward, first);
    hn::Store(InverseLength(d, dd), d, block->inverse_length + first);
    hn::Vec<CameraDouble> discriminant;
    if constexpr (kProjected) {
      const auto hit = TestProjected(d, SetProjectedSphere(d, *candidate.projected), backward, dd);
      discriminant = hit.discriminant;
      Store3(hit.offset, d, block->moment, first);
      hn::Store(BackToHit(hn::Sqrt(discriminant), hit.back), d, block->root + first);
    } else {
      const auto moment = AccurateCross(d, SetVec3(d, candidate.sphere.center), backward);
      discriminant = Discriminant(hn::Set(d, candidate.radius2), dd, moment);
      hn::Store(dd, d, block->dd + first);
      Store3(moment, d, block->moment, first);
      hn::Store(hn::Sqrt(discriminant), d, block->root + first);
    }
    block->bits[g] &= BitsOfMask(d, hn::Ge(discriminant, hn::Zero(d)));
  }
}

// The second pass: appends the hits to `to`. Normals point outward, because the rays start outside
// the spheres.
template <bool kProjected>
HWY_NOINLINE HWY_ATTR void AppendBlock(const SingleSphereBlock& block, const HitOutput& to) {
  const CameraDouble d;
  HitWriter writer(to);
  for (int g = 0; g < block.groups; ++g) {
    const uint32_t bits = block.bits[g];
    if (bits == 0) continue;
    const int first = g * kGroupLanes;
    const TileCandidate& candidate = *block.candidate[g];
    const auto backward = Load3(d, block.backward, first);
    const auto inverse_length = hn::Load(d, block.inverse_length + first);
    const auto radius = hn::Set(d, candidate.sphere.radius);
    const auto to_view = Scale(backward, inverse_length);
    const auto root = hn::Load(d, block.root + first);
    const auto moment = Load3(d, block.moment, first);
    Vec3V<hn::Vec<CameraDouble>> normal;
    if constexpr (kProjected) {
      normal = ProjectedNormal(moment, root, to_view, inverse_length);
    } else {
      const auto to_hit = ScaledCenterToHit(backward, root, moment);
      normal = SphereNormal(d, to_hit, hn::Load(d, block.dd + first), radius);
    }
    const auto position = [&]() HWY_ATTR {
      return SpherePosition(SetVec3(d, candidate.sphere.center), normal, radius);
    };
    writer.Surfaces(normal, to_view, position, bits, block.ray[g]);
    writer.Primitive(candidate.primitive, bits);
  }
}

// Appends the hits of the block's groups, and empties the block.
HWY_INLINE void TraceBlock(const CameraFrame& frame, const FilmBatch& film,
                           SingleSphereBlock* block, const HitOutput& to) {
  if (block->groups == 0) return;
  if (block->projected) {
    TestRays<true>(frame, film, block);
    AppendBlock<true>(*block, to);
  } else {
    TestRays<false>(frame, film, block);
    AppendBlock<false>(*block, to);
  }
  block->groups = 0;
}

// Adds the rays to the block, and traces the block whenever it is full.
HWY_INLINE void AddSingleSphereRays(const CameraFrame& frame, const FilmBatch& film,
                                    const SingleSphereRays& rays, SingleSphereBlock* block,
                                    const HitOutput& to) {
  const bool projected = rays.candidate->projected != nullptr;
  if (block->projected != projected) {
    TraceBlock(frame, film, block, to);
    block->projected = projected;
  }
  for (uint32_t i = 0; i < rays.count; i += kGroupLanes) {
    const int g = block->groups++;
    const uint32_t left = rays.count - i;
    block->ray[g] = rays.first + i;
    block->bits[g] = left >= kGroupLanes ? kAllOfGroup : (1u << left) - 1;
    block->candidate[g] = rays.candidate;
    if (block->groups * kGroupLanes == kSingleSphereBlock) TraceBlock(frame, film, block, to);
  }
}

// Fills the block with the groups of lanes that pass the float test, from up to kSingleSphereBlock
// rays in any order.
HWY_INLINE void ProposeGroups(const CameraFrame& frame, const TileCandidate& candidate,
                              const FilmBatch& film, size_t first, size_t rays,
                              CameraPacket* packet, SingleSphereBlock* block) {
  for (size_t i = 0; i < rays; i += kCameraPacket) {
    const size_t left = rays - i;
    packet->lanes = left >= kCameraPacket ? 0xffffu : (1u << left) - 1;
    packet->film_x = film.x.data() + first + i;
    packet->film_y = film.y.data() + first + i;
    FillFloatRays<true>(frame, packet);
    const uint32_t lanes = ProposedLanes<true, true>(frame, candidate, *packet);
    for (int lane = 0; lane < kCameraPacket; lane += kGroupLanes) {
      const uint32_t bits = lanes >> lane & kAllOfGroup;
      const int g = block->groups;
      block->ray[g] = static_cast<uint32_t>(first + i) + static_cast<uint32_t>(lane);
      block->bits[g] = bits;
      block->candidate[g] = &candidate;
      block->groups += bits != 0 ? 1 : 0;
    }
  }
}

// Appends the hits of a batch of perspective rays, in any order, on a candidate in front of the
// camera.
HWY_INLINE void TraceSingleSphere(const CameraFrame& frame, const TileCandidate& candidate,
                                  const FilmBatch& film, CameraPacket* packet,
                                  SingleSphereBlock* block, const HitOutput& to) {
  block->projected = candidate.projected != nullptr;
  for (size_t i = 0; i < film.count; i += kSingleSphereBlock) {
    const size_t count = std::min<size_t>(kSingleSphereBlock, film.count - i);
    ProposeGroups(frame, candidate, film, i, count, packet, block);
    TraceBlock(frame, film, block, to);
  }
}

}  // namespace nacre::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
