// SPDX-License-Identifier: Apache-2.0
// tests/embree/embree_packet_test.cc: packets of which Embree hands on some rays in another order.
#include "embree/embree_packet.h"

#include "catch.h"

namespace nacre {
namespace {

TEST_CASE("rays handed on as a copy are found by their ids") {
  EmbreePacket packet(8, nullptr, nullptr);
  for (unsigned i = 0; i < 8; ++i) packet.packet.floats.depth[i] = static_cast<float>(10 + i);
  const int all_but_two[8] = {-1, -1, 0, -1, -1, -1, -1, -1};
  CHECK(ActiveLanes(packet, all_but_two, &packet.rays, 8) == 0b11111011u);

  RTCRayHit4 copy;
  auto* rays = reinterpret_cast<RTCRayN*>(&copy);
  const unsigned ids[4] = {6, 1, 5, 0};
  const int valid[4] = {-1, -1, 0, -1};
  for (unsigned i = 0; i < 4; ++i) {
    RTCRayN_id(rays, 4, i) = ids[i];
    RTCRayN_tfar(rays, 4, i) = 99;
  }
  CHECK(ActiveLanes(packet, valid, rays, 4) == 0b01000011u);
  ReturnDepths(packet, valid, rays, 4);
  CHECK(RTCRayN_tfar(rays, 4, 0) == 16);
  CHECK(RTCRayN_tfar(rays, 4, 1) == 11);
  CHECK(RTCRayN_tfar(rays, 4, 2) == 99);
  CHECK(RTCRayN_tfar(rays, 4, 3) == 10);
}

}  // namespace
}  // namespace nacre
