// SPDX-License-Identifier: Apache-2.0
// visibility/shell_kernel.cc: traverses the tree of shells (shell_tree.h) with packets of rays.
// Hits in its leaves are decided by the same tests as elsewhere.
#include <algorithm>
#include <limits>

#include "visibility/shell_tree.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "visibility/shell_kernel.cc"
#include "hwy/foreach_target.h"

#include "visibility/fill_packet-inl.h"
#include "visibility/sphere_packet-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre::HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;

using ShellTag = hn::ScalableTag<double>;
using ShellV = hn::Vec<ShellTag>;

struct ShellRays {
  Vec3V<ShellV> origin, direction;
  ShellV inverse_dd, t_max;
  ShellV origin_sum;  // |origin|_1
};

HWY_INLINE ShellRays LoadShellRays(const Packet& packet, int lane) {
  const ShellTag d;
  ShellRays rays;
  rays.origin = Origin(d, packet, lane);
  rays.direction = Direction(d, packet, lane);
  rays.inverse_dd = hn::Load(d, packet.inverse_dd + lane);
  rays.t_max = hn::Load(d, packet.t_max + lane);
  rays.origin_sum = SumOfAbs(rays.origin);
  return rays;
}

// The least t at which rays may be in a shell; infinity if they are not in it at any t in [0,
// t_max].
//
// The margin counts twice: once for the error of the radii, and once for the error of t, because
// moving a sphere outward by a distance moves the point where a ray enters by at least as much.
HWY_INLINE ShellV EnterShell(const Shell& shell, const ShellRays& rays) {
  const ShellTag d;
  const auto zero = hn::Zero(d);
  const Vec3V<ShellV> center = SetVec3(d, shell.center);
  const ShellV sum = hn::Add(rays.origin_sum, hn::Add(SumOfAbs(center), hn::Set(d, shell.outer)));
  const ShellV margin = hn::Mul(sum, hn::Set(d, 2 * kShellMargin));
  const ShellV outer = hn::Add(hn::Set(d, shell.outer), margin);
  const ShellV inner = hn::Max(hn::Sub(hn::Set(d, shell.inner), margin), zero);
  const ShellV outer2 = hn::Mul(outer, outer);
  const ShellV inner2 = hn::Mul(inner, inner);

  const Vec3V<ShellV> to_center = Sub(center, rays.origin);
  const ShellV distance2 = Dot(to_center, to_center);
  const ShellV closest = hn::Mul(Dot(to_center, rays.direction), rays.inverse_dd);
  const Vec3V<ShellV> across = Sub(to_center, Scale(rays.direction, closest));
  const ShellV across2 = Dot(across, across);

  const auto in_hole = hn::Lt(distance2, inner2);
  const ShellV discriminant = hn::Sub(hn::IfThenElse(in_hole, inner2, outer2), across2);
  const ShellV half = hn::Sqrt(hn::Mul(hn::Max(discriminant, zero), rays.inverse_dd));
  const ShellV first = hn::Add(closest, hn::IfThenElse(in_hole, half, hn::Neg(half)));
  const auto meets = hn::Or(in_hole, hn::Ge(discriminant, zero));
  const auto ahead = hn::Or(hn::Gt(closest, zero), hn::Le(distance2, outer2));
  const auto in_time = hn::And(hn::Le(first, rays.t_max), hn::Gt(rays.t_max, zero));
  const auto enters = hn::And(hn::And(meets, ahead), in_time);
  return hn::IfThenElse(enters, first, hn::Set(d, std::numeric_limits<double>::infinity()));
}

// A node and the lanes whose rays may hit its spheres, at t >= nearest.
struct ShellVisit {
  const ShellNode* node;
  uint32_t lanes = 0;
  double nearest = 0;
};

// Fills `visits` for consecutive nodes: which of `lanes` enter their shells, and where.
template <int kNodes>
HWY_INLINE void VisitNodes(const Packet& packet, uint32_t lanes, const ShellNode* nodes,
                           ShellVisit (&visits)[kNodes]) {
  const ShellTag d;
  const int step = static_cast<int>(hn::Lanes(d));
  const ShellV infinity = hn::Set(d, std::numeric_limits<double>::infinity());
  ShellV nearest[kNodes];
  for (int i = 0; i < kNodes; ++i) {
    visits[i] = {nodes + i};
    nearest[i] = infinity;
  }
  for (int lane = 0; lane < packet.width; lane += step) {
    const auto active = MaskOfBits(d, lanes, lane);
    if (hn::AllFalse(d, active)) continue;
    const ShellRays rays = LoadShellRays(packet, lane);
    for (int i = 0; i < kNodes; ++i) {
      const ShellV first = hn::IfThenElse(active, EnterShell(nodes[i].shell, rays), infinity);
      nearest[i] = hn::Min(nearest[i], first);
      visits[i].lanes |= BitsOfMask(d, hn::Lt(first, infinity)) << lane;
    }
  }
  for (int i = 0; i < kNodes; ++i) {
    visits[i].nearest = hn::GetLane(hn::MinOfLanes(d, nearest[i]));
  }
}

HWY_INLINE double LargestLimit(const Packet& packet, uint32_t lanes) {
  double largest = -std::numeric_limits<double>::infinity();
  for (; lanes != 0; lanes &= lanes - 1) {
    largest = std::max(largest, packet.t_max[__builtin_ctz(lanes)]);
  }
  return largest;
}

// Calls test(member, lanes) for the spheres that the lanes' rays may hit at t <= t_max, nearest
// shells first. `test` may reduce t_max, and mark lanes as occluded.
template <class Test>
HWY_INLINE void WalkShells(const ShellTree& tree, uint32_t lanes, const Packet& packet,
                           const Test& test) {
  ShellVisit stack[kMaxShellDepth + 1];
  int size = 0;
  const auto push = [&](const ShellVisit& visit) {
    if (visit.lanes != 0) stack[size++] = visit;
  };
  ShellVisit root[1];
  VisitNodes(packet, lanes, tree.nodes.data(), root);
  push(root[0]);
  while (size > 0) {
    ShellVisit visit = stack[--size];
    visit.lanes &= ~packet.occluded;
    if (visit.nearest > LargestLimit(packet, visit.lanes)) continue;
    const ShellNode& node = *visit.node;
    if (node.count > 0) {
      for (uint32_t i = 0; i < node.count; ++i) test(tree.members[node.first + i], visit.lanes);
      continue;
    }
    ShellVisit children[2];
    VisitNodes(packet, visit.lanes, tree.nodes.data() + node.first, children);
    const int near = children[1].nearest < children[0].nearest ? 1 : 0;
    push(children[1 - near]);
    push(children[near]);
  }
}

// A packet together with the arrays of its float rays.
struct ShellPacket {
  explicit ShellPacket(const TraceGeometry& geometry) {
    packet.width = std::max(4, 2 * static_cast<int>(hn::Lanes(ShellTag())));
    packet.geometry = &geometry;
    packet.floats = {{floats[0], floats[1], floats[2]}, floats[3]};
  }
  ShellPacket(const ShellPacket&) = delete;  // it points into itself
  ShellPacket& operator=(const ShellPacket&) = delete;

  size_t Width() const { return static_cast<size_t>(packet.width); }

  Packet packet;
  alignas(64) float floats[4][kMaxPacketWidth];
};

void Nearer(const TraceGeometry& geometry, const RayBatch& rays, ClosestHits* hits) {
  ShellPacket shells(geometry);
  Packet& packet = shells.packet;
  for (size_t first = 0; first < rays.count; first += shells.Width()) {
    FillClosest(rays, first, hits, &packet);
    WalkShells(geometry.shells, packet.lanes, packet,
               [&](const ShellMember& member, uint32_t lanes) {
                 IntersectLanes(geometry.spheres[member.lowest], member.lowest, lanes, &packet);
               });
  }
}

void Occluded(const TraceGeometry& geometry, ShadowRayBatch* rays) {
  ShellPacket shells(geometry);
  Packet& packet = shells.packet;
  for (size_t first = 0; first < rays->count; first += shells.Width()) {
    FillShadowPacket(*rays, first, &packet);
    const PrimitiveRange& target = packet.target;
    WalkShells(geometry.shells, packet.lanes, packet,
               [&](const ShellMember& member, uint32_t lanes) {
                 if (target.Contains(member.lowest) && target.Contains(member.highest)) return;
                 OccludeLanes(geometry.spheres[member.lowest], lanes, &packet);
               });
    StoreOccluded(packet.occluded, first, shells.Width(), rays);
  }
}

}  // namespace
}  // namespace nacre::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nacre {
HWY_EXPORT(Nearer);
HWY_EXPORT(Occluded);

void NearerInShells(const TraceGeometry& geometry, const RayBatch& rays, ClosestHits* hits) {
  HWY_DYNAMIC_DISPATCH(Nearer)(geometry, rays, hits);
}

void OccludedInShells(const TraceGeometry& geometry, ShadowRayBatch* rays) {
  HWY_DYNAMIC_DISPATCH(Occluded)(geometry, rays);
}
}  // namespace nacre
#endif
