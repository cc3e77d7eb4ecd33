// SPDX-License-Identifier: Apache-2.0
// visibility/exact_lanes-inl.h: the exact tests of a packet of camera rays, group of lanes by
// group.
#if defined(NACRE_VISIBILITY_EXACT_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_VISIBILITY_EXACT_LANES_INL_H_
#undef NACRE_VISIBILITY_EXACT_LANES_INL_H_
#else
#define NACRE_VISIBILITY_EXACT_LANES_INL_H_
#endif

#include "visibility/camera_packet-inl.h"
#include "visibility/film_test-inl.h"
#include "visibility/sphere_test-inl.h"
#include "visibility/surface-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// A group's rays on their spheres.
struct ExactHits {
  hn::Mask<CameraDouble> hit;
  hn::Vec<CameraDouble> t;
  Vec3V<hn::Vec<CameraDouble>> normal;
  hn::Vec<CameraDouble> turned_radius;
};

// Of any spheres.
template <bool kPerspective>
HWY_INLINE ExactHits HitsAnywhere(const CameraFrame& frame, const CameraPacket& packet, int lane,
                                  const Vec3V<hn::Vec<CameraDouble>>& center,
                                  hn::Vec<CameraDouble> radius) {
  const CameraDouble d;
  const auto to_center = kPerspective ? center : Sub(center, LoadLanes(packet.exact_own, lane));
  const auto direction = ExactDirection<kPerspective>(d, frame, lane, packet);
  const auto dd = hn::Load(d, packet.exact_dd + lane);
  const auto hit = TestSphere(d, to_center, direction, hn::Div(hn::Set(d, 1.0), dd), radius);
  const auto root = hn::IfThenElse(hit.inside, hit.root, hn::Neg(hit.root));
  const auto turned = TurnedRadius(radius, root);
  return {hit.hit, hit.t,
          SphereNormal(d, ScaledCenterToHit(direction, root, hit.moment), dd, turned), turned};
}

// Of spheres that have a place on the film.
HWY_INLINE ExactHits HitsOnFilm(const CameraPacket& packet, int lane,
                                const FilmSphereV<hn::Vec<CameraDouble>>& film,
                                const Vec3V<hn::Vec<CameraDouble>>& center,
                                hn::Vec<CameraDouble> radius) {
  const CameraDouble d;
  const auto inverse_length = hn::Load(d, packet.inverse_length + lane);
  const auto backward = Negated(LoadLanes(packet.exact_own, lane));
  const auto hit = TestOnFilm(d, film, backward, hn::Load(d, packet.exact_dd + lane));
  const auto root = hn::Sqrt(hit.discriminant);
  return {hn::Ge(hit.discriminant, hn::Zero(d)), FilmDepth(center, radius, backward, root),
          FilmNormal(hit.offset, BackToHit(root, hit.back), Scale(backward, inverse_length),
                     inverse_length),
          radius};
}

HWY_INLINE void StoreAll(const ExactHits& hits, int lane, CameraPacket* packet) {
  const CameraDouble d;
  Store3(hits.normal, d, packet->normal[0] + lane, packet->normal[1] + lane,
         packet->normal[2] + lane);
  hn::Store(hits.turned_radius, d, packet->turned_radius + lane);
}

HWY_INLINE void StoreLanes(const ExactHits& hits, hn::Mask<CameraDouble> lanes, int lane,
                           CameraPacket* packet) {
  const CameraDouble d;
  const auto store = [&](hn::Vec<CameraDouble> value, double* to) HWY_ATTR {
    hn::Store(hn::IfThenElse(lanes, value, hn::Load(d, to + lane)), d, to + lane);
  };
  store(hits.normal.x, packet->normal[0]);
  store(hits.normal.y, packet->normal[1]);
  store(hits.normal.z, packet->normal[2]);
  store(hits.turned_radius, packet->turned_radius);
}

// Keeps the hits that come before the best ones: those nearer, and among equals the lower id.
HWY_INLINE void KeepNearer(const ExactHits& hits, hn::Mask<CameraDouble> proposed,
                           const TileCandidate& candidate, int lane, CameraPacket* packet) {
  const CameraDouble d;
  const auto found = hn::And(proposed, hits.hit);
  const auto best = hn::Load(d, packet->t + lane);
  auto nearer = hn::And(found, hn::Lt(hits.t, best));
  uint32_t bits = BitsOfMask(d, nearer);
  uint32_t ties = BitsOfMask(d, hn::And(found, hn::Eq(hits.t, best)));
  for (; ties != 0; ties &= ties - 1) {
    const int tie = __builtin_ctz(ties);
    if (candidate.primitive < packet->primitive[lane + tie]) bits |= 1u << tie;
  }
  if (bits == 0) return;
  nearer = MaskOfBits(d, bits, 0);
  const auto t = hn::IfThenElse(nearer, hits.t, best);
  hn::Store(t, d, packet->t + lane);
  StoreLanes(hits, nearer, lane, packet);
  const hn::Rebind<float, CameraDouble> df;
  hn::StoreU(UpperDepth(d, t, hn::Load(d, packet->exact_dd + lane)), df, packet->depth + lane);
  packet->hit |= bits << lane;
  SetSphere(candidate, lane, bits, packet);
}

// One of several candidates.
template <bool kPerspective>
HWY_INLINE bool TestOneOfMany(const CameraFrame& frame, const TileCandidate& candidate,
                              CameraPacket* packet) {
  const uint32_t lanes = ProposedLanes<kPerspective, false>(frame, candidate, *packet);
  if (lanes == 0) return false;
  const CameraDouble d;
  const auto center = SetVec3(d, candidate.sphere.center);
  const auto radius = hn::Set(d, candidate.sphere.radius);
  const int step = static_cast<int>(hn::Lanes(d));
  for (int lane = 0; lane < kCameraPacket; lane += step) {
    const auto proposed = MaskOfBits(d, lanes, lane);
    if (hn::AllFalse(d, proposed)) continue;
    if ((packet->exact >> lane & 1) == 0) {
      FillExactRays<kPerspective>(d, frame, lane, packet);
      packet->exact |= 1u << lane;
    }
    const ExactHits hits =
        kPerspective && candidate.film != nullptr
            ? HitsOnFilm(*packet, lane, SetFilmSphere(d, *candidate.film), center, radius)
            : HitsAnywhere<kPerspective>(frame, *packet, lane, center, radius);
    KeepNearer(hits, proposed, candidate, lane, packet);
  }
  return true;
}

// Asks the exact tests about the spheres that the lanes `one` are proposed.
template <bool kPerspective>
HWY_INLINE void TestProposed(const CameraFrame& frame, uint32_t one, CameraPacket* packet) {
  const CameraDouble d;
  const int step = static_cast<int>(hn::Lanes(d));
  for (int lane = 0; lane < kCameraPacket; lane += step) {
    const uint32_t bits = (one >> lane) & ((1u << step) - 1);
    if (bits == 0) continue;
    FillExactRays<kPerspective>(d, frame, lane, packet);
    packet->exact |= 1u << lane;
    const auto center = LoadLanes(packet->center, lane);
    const auto radius = hn::Load(d, packet->radius + lane);
    const uint32_t on_film = bits & packet->on_film >> lane;
    if (!kPerspective || on_film != bits) {
      const ExactHits hits = HitsAnywhere<kPerspective>(frame, *packet, lane, center, radius);
      packet->hit |= (BitsOfMask(d, hits.hit) & bits & ~on_film) << lane;
      StoreAll(hits, lane, packet);
    }
    if (kPerspective && on_film != 0) {
      const FilmSphereV<hn::Vec<CameraDouble>> film{LoadLanes(packet->film_center, lane),
                                                    LoadLanes(packet->film_rest, lane),
                                                    hn::Load(d, packet->film_scale + lane)};
      const ExactHits hits = HitsOnFilm(*packet, lane, film, center, radius);
      packet->hit |= (BitsOfMask(d, hits.hit) & on_film) << lane;
      StoreLanes(hits, MaskOfBits(d, on_film, 0), lane, packet);
    }
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();
#endif
