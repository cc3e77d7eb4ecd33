// SPDX-License-Identifier: Apache-2.0
// scene/pair_edges.h: which triangles on one edge are neighbours.
#pragma once

#include <cstddef>

namespace nacre {

// Pairs `count` directed edges between the same two vertices: the k-th of one direction with the
// k-th of the other, by calls pair(i, j) with rises(i) and not rises(j). Surplus edges of the more
// frequent direction have no neighbour. Each edge's direction is asked for at most twice, however
// many triangles meet there.
template <class Rises, class Pair>
void PairEdges(size_t count, const Rises& rises, const Pair& pair) {
  for (size_t up = 0, down = 0;; ++up, ++down) {
    while (up < count && !rises(up)) ++up;
    if (up == count) return;
    while (down < count && rises(down)) ++down;
    if (down == count) return;
    pair(up, down);
  }
}

}  // namespace nacre
