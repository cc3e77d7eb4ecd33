// SPDX-License-Identifier: Apache-2.0
// visibility/alone-inl.h: camera rays against the only sphere that they may hit, in front of the
// camera: what most rays of most pictures meet.
//
// From a film position to a hit it is one long chain of dependent operations, with a root in it,
// longer than a processor's window. Blocks of rays therefore take it in two steps, with several
// groups of lanes under way in each at a time.
#if defined(NACRE_VISIBILITY_ALONE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_VISIBILITY_ALONE_INL_H_
#undef NACRE_VISIBILITY_ALONE_INL_H_
#else
#define NACRE_VISIBILITY_ALONE_INL_H_
#endif

#include "visibility/append-inl.h"
#include "visibility/film_test-inl.h"
#include "visibility/sphere_test-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

inline constexpr int kAloneBlock = 8 * kCameraPacket;

// Rays that follow one another in a batch and may hit one sphere.
struct AloneRays {
  const TileCandidate* candidate;
  uint32_t first, count;
  double x = 0, y = 0;  // of FilmBatch::centers: the first one's place
};

// Groups of lanes on their way through the steps, each of rays that follow one another in a batch
// and may hit one sphere.
struct AloneBlock {
  int groups = 0;
  uint32_t ray[kAloneBlock];   // the batch's, of a group's first lane
  uint32_t bits[kAloneBlock];  // its lanes that are proposed, then those that hit
  const TileCandidate* candidate[kAloneBlock];
  double x[kAloneBlock], y[kAloneBlock];  // of FilmBatch::centers: the place of its first lane
  // The packets, as bits, of the last block of a batch in any order, that all hit: most likely
  // they do so again in the next.
  uint32_t likely = 0;
  bool on_film = false;  // all spheres have a place on the film, or none has
  alignas(kVectorBytes) double backward[3][kAloneBlock];  // minus the rays' directions
  alignas(kVectorBytes) double inverse_length[kAloneBlock];
  // What a hit's normal is made of. On the film: BackToHit, and the offset in place of a moment.
  // Elsewhere TestSphere's root and moment, and the squares of the directions' lengths.
  alignas(kVectorBytes) double root[kAloneBlock];
  alignas(kVectorBytes) double moment[3][kAloneBlock];
  alignas(kVectorBytes) double dd[kAloneBlock];
};

HWY_INLINE Vec3V<hn::Vec<CameraDouble>> LoadGroup(const double (&from)[3][kAloneBlock], int place) {
  return Load3(CameraDouble(), from[0] + place, from[1] + place, from[2] + place);
}

HWY_INLINE void StoreGroup(const Vec3V<hn::Vec<CameraDouble>>& v, int place,
                           double (&to)[3][kAloneBlock]) {
  Store3(v, CameraDouble(), to[0] + place, to[1] + place, to[2] + place);
}

// The groups' exact rays: turned round, bit for bit, as the way back to the viewer is what hits
// keep. Leaves the lanes that hit: no depth is needed, and in front of the camera the line's test
// decides, which spares a division. The root, NaN of lanes that miss, is taken here: its unit works
// beside those of so many products. A function of its own, as AppendBlock: what lies around them
// takes none of their registers.
template <bool kOnFilm>
HWY_NOINLINE HWY_ATTR void TestRays(const CameraFrame& frame, const FilmBatch& film,
                                    AloneBlock* block) {
  const CameraDouble d;
  const auto corner = SetVec3(d, -frame.corner);
  const auto step_x = SetVec3(d, -frame.step_x);
  const auto step_y = SetVec3(d, -frame.step_y);
  const auto lanes = hn::Iota(d, 0);
  for (int g = 0; g < block->groups; ++g) {
    const int place = g * kGroupLanes;
    const TileCandidate& candidate = *block->candidate[g];
    hn::Vec<CameraDouble> x, y;
    if (film.centers) {
      x = hn::Add(hn::Set(d, block->x[g]), lanes);
      y = hn::Set(d, block->y[g]);
    } else {
      x = hn::LoadU(d, film.x.data() + block->ray[g]);
      y = hn::LoadU(d, film.y.data() + block->ray[g]);
    }
    // The operations of MakeCameraRays.
    const auto backward = MulAdd3(step_y, y, MulAdd3(step_x, x, corner));
    const auto dd = FusedDot(backward, backward);
    StoreGroup(backward, place, block->backward);
    hn::Store(InverseLength(d, dd), d, block->inverse_length + place);
    hn::Vec<CameraDouble> discriminant;
    if constexpr (kOnFilm) {
      const auto hit = TestOnFilm(d, SetFilmSphere(d, *candidate.film), backward, dd);
      discriminant = hit.discriminant;
      StoreGroup(hit.offset, place, block->moment);
      hn::Store(BackToHit(hn::Sqrt(discriminant), hit.back), d, block->root + place);
    } else {
      const auto moment = AccurateCross(d, SetVec3(d, candidate.sphere.center), backward);
      discriminant = Discriminant(hn::Set(d, candidate.radius2), dd, moment);
      hn::Store(dd, d, block->dd + place);
      StoreGroup(moment, place, block->moment);
      hn::Store(hn::Sqrt(discriminant), d, block->root + place);
    }
    block->bits[g] &= BitsOfMask(d, hn::Ge(discriminant, hn::Zero(d)));
  }
}

// The rays start outside, so the normals point outward.
template <bool kOnFilm>
HWY_NOINLINE HWY_ATTR void AppendBlock(const AloneBlock& block, const FilmBatch& film,
                                       const HitsTo& to) {
  const CameraDouble d;
  HitWriter writer(to);
  const uint32_t* HWY_RESTRICT const ray = film.ray.data();
  for (int g = 0; g < block.groups; ++g) {
    const uint32_t bits = block.bits[g];
    if (bits == 0) continue;
    const int place = g * kGroupLanes;
    const TileCandidate& candidate = *block.candidate[g];
    const auto backward = LoadGroup(block.backward, place);
    const auto inverse_length = hn::Load(d, block.inverse_length + place);
    const auto radius = hn::Set(d, candidate.sphere.radius);
    const auto to_view = Scale(backward, inverse_length);
    const auto root = hn::Load(d, block.root + place);
    const auto moment = LoadGroup(block.moment, place);
    Vec3V<hn::Vec<CameraDouble>> normal;
    if constexpr (kOnFilm) {
      normal = FilmNormal(moment, root, to_view, inverse_length);
    } else {
      const auto to_hit = ScaledCenterToHit(backward, root, moment);
      normal = SphereNormal(d, to_hit, hn::Load(d, block.dd + place), radius);
    }
    const auto position = [&]() HWY_ATTR {
      return SpherePosition(SetVec3(d, candidate.sphere.center), normal, radius);
    };
    writer.Surfaces(normal, to_view, position, bits, ray + block.ray[g]);
    writer.Primitive(candidate.primitive, bits);
  }
}

HWY_INLINE void TestRays(const CameraFrame& frame, const FilmBatch& film, AloneBlock* block) {
  if (block->on_film) return TestRays<true>(frame, film, block);
  TestRays<false>(frame, film, block);
}

HWY_INLINE void AppendBlock(const AloneBlock& block, const FilmBatch& film, const HitsTo& to) {
  if (block.on_film) return AppendBlock<true>(block, film, to);
  AppendBlock<false>(block, film, to);
}

// Appends the hits of the block's groups, and empties it.
HWY_INLINE void TraceBlock(const CameraFrame& frame, const FilmBatch& film, AloneBlock* block,
                           const HitsTo& to) {
  if (block->groups == 0) return;
  TestRays(frame, film, block);
  AppendBlock(*block, film, to);
  block->groups = 0;
}

// Puts the rays into the block, which is traced whenever it is full.
HWY_INLINE void PutRays(const CameraFrame& frame, const FilmBatch& film, const AloneRays& rays,
                        AloneBlock* block, const HitsTo& to) {
  const bool on_film = rays.candidate->film != nullptr;
  if (block->on_film != on_film) {
    TraceBlock(frame, film, block, to);
    block->on_film = on_film;
  }
  for (uint32_t i = 0; i < rays.count; i += kGroupLanes) {
    const int g = block->groups++;
    const uint32_t left = rays.count - i;
    block->ray[g] = rays.first + i;
    block->bits[g] = left >= kGroupLanes ? kAllOfGroup : (1u << left) - 1;
    block->candidate[g] = rays.candidate;
    block->x[g] = rays.x + i;
    block->y[g] = rays.y;
    if (block->groups * kGroupLanes == kAloneBlock) TraceBlock(frame, film, block, to);
  }
}

// Puts the lanes of up to kAloneBlock rays, in any order, that are proposed; those of likely
// packets all, unasked: the exact test decides whatever it is told.
HWY_INLINE void ProposeGroups(const CameraFrame& frame, const TileCandidate& candidate,
                              const FilmBatch& film, size_t first, size_t rays,
                              CameraPacket* packet, AloneBlock* block) {
  for (size_t i = 0; i < rays; i += kCameraPacket) {
    const size_t left = rays - i;
    packet->lanes = left >= kCameraPacket ? 0xffffu : (1u << left) - 1;
    uint32_t lanes = packet->lanes;
    if ((block->likely >> (i / kCameraPacket) & 1) == 0) {
      packet->film_x = film.x.data() + first + i;
      packet->film_y = film.y.data() + first + i;
      FillFloatRays<true>(frame, packet);
      lanes = ProposedLanes<true, true>(frame, candidate, *packet);
    }
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

// After TestRays, of rays from `first` on.
HWY_INLINE void FindLikely(size_t first, AloneBlock* block) {
  uint32_t hit[kAloneBlock / kCameraPacket] = {};
  for (int g = 0; g < block->groups; ++g) {
    const size_t ray = block->ray[g] - first;
    hit[ray / kCameraPacket] |= block->bits[g] << (ray % kCameraPacket);
  }
  block->likely = 0;
  for (int p = 0; p < kAloneBlock / kCameraPacket; ++p) {
    block->likely |= static_cast<uint32_t>(hit[p] == 0xffff) << p;
  }
}

// Appends the hits of a batch of perspective rays in any order, of a candidate in front of them.
HWY_INLINE void TraceAlone(const CameraFrame& frame, const TileCandidate& candidate,
                           const FilmBatch& film, CameraPacket* packet, AloneBlock* block,
                           const HitsTo& to) {
  block->on_film = candidate.film != nullptr;
  for (size_t i = 0; i < film.count; i += kAloneBlock) {
    const size_t count = std::min<size_t>(kAloneBlock, film.count - i);
    ProposeGroups(frame, candidate, film, i, count, packet, block);
    TestRays(frame, film, block);
    FindLikely(i, block);
    AppendBlock(*block, film, to);
    block->groups = 0;
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();
#endif
