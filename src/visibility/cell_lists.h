// SPDX-License-Identifier: Apache-2.0
// visibility/cell_lists.h: a parallel counting sort of items into the lists of the cells that they
// overlap. Each list is in the order of the items, for any number of threads.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "base/parallel.h"

namespace nacre {

// The number of pieces that items are split into. Each piece has its own counts of all cells: the
// pieces are enough to occupy the threads, and few enough to keep the counts small.
inline size_t CellListPieces(size_t items) { return items < (size_t{1} << 14) ? 1 : 8; }

struct CellListRange {
  size_t begin, end;
};
inline CellListRange CellListPiece(size_t items, size_t piece) {
  const size_t pieces = CellListPieces(items);
  return {items * piece / pieces, items * (piece + 1) / pieces};
}

// for_cells(item, emit) calls emit(cell, more...) for each cell of the item; it is called twice,
// and must emit the same cells both times. end[cell] becomes the end of the cell's list.
// allocate(entries) is called once, and then store(item, cell, position, more...) for each entry,
// from several threads. Returns false, with nothing allocated, if there would be more than
// max_entries, which is below 2^32.
template <class ForCells, class Allocate, class Store>
bool SortIntoCells(size_t items, size_t cells, size_t max_entries, int threads,
                   const ForCells& for_cells, std::vector<uint32_t>* end, const Allocate& allocate,
                   const Store& store) {
  const size_t pieces = CellListPieces(items);
  std::vector<std::vector<uint32_t>> next(pieces);  // first the counts, then the next free position
  std::atomic<size_t> entries{0};
  ParallelFor(pieces, threads, [&](size_t piece) {
    std::vector<uint32_t> count(cells);
    size_t sum = 0;
    const auto [begin, end_of_piece] = CellListPiece(items, piece);
    for (size_t item = begin; item < end_of_piece && sum <= max_entries; ++item) {
      for_cells(item, [&](size_t cell, auto...) {
        ++count[cell];
        ++sum;
      });
    }
    entries += sum;
    next[piece] = std::move(count);
  });
  if (entries > max_entries) return false;
  end->resize(cells);
  uint32_t sum = 0;
  for (size_t cell = 0; cell < cells; ++cell) {
    for (std::vector<uint32_t>& count : next) sum += std::exchange(count[cell], sum);
    (*end)[cell] = sum;
  }
  allocate(entries.load());
  ParallelFor(pieces, threads, [&](size_t piece) {
    const auto [begin, end_of_piece] = CellListPiece(items, piece);
    for (size_t item = begin; item < end_of_piece; ++item) {
      for_cells(item, [&](size_t cell, auto... more) {
        store(item, cell, next[piece][cell]++, more...);
      });
    }
  });
  return true;
}

}  // namespace nacre
