// SPDX-License-Identifier: Apache-2.0
// visibility/pixel_spans_kernel.cc: the outlines' spans in all rows of a tile at once.
#include <algorithm>
#include <array>
#include <cmath>

#include "visibility/pixel_spans.h"
#include "visibility/sphere_bins.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "visibility/pixel_spans_kernel.cc"
#include "hwy/foreach_target.h"

#include "hwy/highway.h"

#ifndef NACRE_VISIBILITY_PIXEL_SPANS_KERNEL_ONCE_
#define NACRE_VISIBILITY_PIXEL_SPANS_KERNEL_ONCE_
namespace nacre {
namespace {

// A sphere's outline on the film, in pixels: an ellipse, x = middle_x + lean t -+ half_chord
// sqrt(1 - t^2) with t = (y - middle_y) / half_height from -1 to 1. Its rightmost point is at
// t = turn, its leftmost at -turn.
struct Outline {
  bool is_ellipse;  // else nothing else has a meaning
  double left, right;
  double middle_x, middle_y;
  double inverse_half_height, half_chord;
  double lean, turn;
};

// The pixels from `begin` to `end` that an outline reaches in each of a tile's rows.
struct OutlineSpans {
  alignas(64) int32_t begin[kCellSize], end[kCellSize];
};

}  // namespace
}  // namespace nacre
#endif

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;

// Samples lie up to `reach` outside their pixels.
void FindOutlineSpansT(const Outline& o, double reach, const Window& tile, OutlineSpans* spans) {
  const hn::CappedTag<double, kCellSize> d;
  const hn::Rebind<int32_t, decltype(d)> di;
  const auto one = hn::Set(d, 1.0), minus_one = hn::Set(d, -1.0);
  const auto x0 = hn::Set(d, tile.x0), x1 = hn::Set(d, tile.x1);
  const auto middle_x = hn::Set(d, o.middle_x), middle_y = hn::Set(d, o.middle_y);
  const auto half_chord = hn::Set(d, o.half_chord), lean = hn::Set(d, o.lean);
  const auto turn = hn::Set(d, o.turn);
  const auto inverse = hn::Set(d, o.inverse_half_height);
  for (int row = 0; row < kCellSize; row += static_cast<int>(hn::Lanes(d))) {
    const auto y = hn::Iota(d, tile.y0 + row);
    // The outline from the row's upper edge to its lower one.
    const auto upper = hn::Mul(hn::Sub(hn::Sub(y, hn::Set(d, reach)), middle_y), inverse);
    const auto lower = hn::Mul(hn::Sub(hn::Add(y, hn::Set(d, 1 + reach)), middle_y), inverse);
    const auto met = hn::And(hn::Lt(upper, one), hn::Gt(lower, minus_one));
    const auto low = hn::Max(upper, minus_one), high = hn::Min(lower, one);
    const auto chord = [&](auto t) HWY_ATTR {
      return hn::Mul(half_chord, hn::Sqrt(hn::Max(hn::Sub(one, hn::Mul(t, t)), hn::Zero(d))));
    };
    const auto low_chord = chord(low), high_chord = chord(high);
    const auto low_middle = hn::MulAdd(lean, low, middle_x);
    const auto high_middle = hn::MulAdd(lean, high, middle_x);
    const auto turns_at = [&](auto t) HWY_ATTR { return hn::And(hn::Le(low, t), hn::Le(t, high)); };
    const auto right =
        hn::IfThenElse(turns_at(turn), hn::Set(d, o.right),
                       hn::Max(hn::Add(low_middle, low_chord), hn::Add(high_middle, high_chord)));
    const auto left =
        hn::IfThenElse(turns_at(hn::Neg(turn)), hn::Set(d, o.left),
                       hn::Min(hn::Sub(low_middle, low_chord), hn::Sub(high_middle, high_chord)));
    const auto store = [&](auto x, int32_t* to) HWY_ATTR {
      const auto inside = hn::IfThenElse(met, hn::Min(hn::Max(x, x0), x1), x0);
      hn::StoreU(hn::DemoteTo(di, inside), di, to + row);  // rounded down: none is below 0
    };
    store(hn::Sub(left, hn::Set(d, reach)), spans->begin);
    store(hn::Add(right, hn::Set(d, reach + 1)), spans->end);
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nacre {
namespace {

// Beyond these, most spans overlap.
constexpr size_t kMaxOutlines = 32;

// Beyond this coordinate, in pixels, an ellipse is left to be any row: that of a sphere that nearly
// touches the plane of the camera ends so far away that its near end is lost in roundings.
constexpr double kFarthest = 1e6;

// With a margin all around: half the width and half the height grow by as much, about the same
// middle and with the same skew, so what was the outline lies inside.
Outline OutlineOf(const Projector& projector, const TileCandidate& candidate) {
  const FilmBounds b = projector.Tangents(candidate.sphere);
  const double farthest =
      std::max({std::abs(b.x0), std::abs(b.x1), std::abs(b.y0), std::abs(b.y1)});
  const double margin = projector.Margin(farthest);
  const double half_width = (b.x1 - b.x0) / 2 + margin, half_height = (b.y1 - b.y0) / 2 + margin;
  Outline outline{};
  outline.is_ellipse = farthest <= kFarthest;
  outline.left = b.x0 - margin;
  outline.right = b.x1 + margin;
  outline.middle_x = (b.x0 + b.x1) / 2;
  outline.middle_y = (b.y0 + b.y1) / 2;
  outline.inverse_half_height = 1 / half_height;
  outline.lean = projector.Skew(candidate.sphere) * outline.inverse_half_height;
  outline.half_chord =
      std::sqrt(std::max(half_width * half_width - outline.lean * outline.lean, 0.0));
  outline.turn = outline.lean / half_width;
  return outline;
}

// Each of the tile's candidates once; nothing if there are too many.
class DistinctCandidates {
 public:
  explicit DistinctCandidates(const TileCandidates& candidates) {
    for (const std::vector<TileCandidate>& cell : candidates.cells) {
      for (const TileCandidate& candidate : cell) Put(candidate);
    }
  }
  bool fit() const { return fit_; }
  const TileCandidate* const* begin() const { return list_.data(); }
  const TileCandidate* const* end() const { return list_.data() + count_; }

 private:
  void Put(const TileCandidate& candidate) {
    const auto same = [&](const TileCandidate* other) {
      return other->primitive == candidate.primitive;
    };
    if (!fit_ || std::any_of(begin(), end(), same)) return;
    fit_ = count_ < kMaxOutlines;
    if (fit_) list_[count_++] = &candidate;
  }

  std::array<const TileCandidate*, kMaxOutlines> list_;
  size_t count_ = 0;
  bool fit_ = true;
};

struct RowSpan {
  int begin, end;
  const TileCandidate* alone;
};

// Those that overlap become one.
void PutRow(RowSpan* row, size_t count, const Window& tile, int y, std::vector<PixelSpan>* spans) {
  if (count > 1) {
    std::sort(row, row + count,
              [](const RowSpan& a, const RowSpan& b) { return a.begin < b.begin; });
  }
  const int place = (y - tile.y0) * tile.width() - tile.x0;
  for (size_t i = 0; i < count;) {
    RowSpan span = row[i++];
    for (; i < count && row[i].begin < span.end; ++i) {
      span = {span.begin, std::max(span.end, row[i].end), nullptr};
    }
    spans->push_back({static_cast<uint32_t>(place + span.begin),
                      static_cast<uint32_t>(span.end - span.begin), span.alone});
  }
}

}  // namespace

HWY_EXPORT(FindOutlineSpansT);

void FindPixelSpans(const CameraFrame& frame, double reach, TileCandidates* candidates) {
  const Window& tile = candidates->tile;
  const DistinctCandidates distinct(*candidates);
  const bool by_outlines = frame.projection == Projection::kPerspective && distinct.fit();
  OutlineSpans of_outline[kMaxOutlines];
  const TileCandidate* alone[kMaxOutlines];
  size_t count = 0;
  if (by_outlines) {
    const Projector projector(frame);
    for (const TileCandidate* candidate : distinct) {
      const Outline outline = OutlineOf(projector, *candidate);
      alone[count] = candidate->around_camera ? nullptr : candidate;
      OutlineSpans& spans = of_outline[count++];
      if (outline.is_ellipse) {
        HWY_DYNAMIC_DISPATCH(FindOutlineSpansT)(outline, reach, tile, &spans);
      } else {
        std::fill_n(spans.begin, kCellSize, tile.x0);
        std::fill_n(spans.end, kCellSize, tile.x1);
      }
    }
  }
  RowSpan row[kMaxOutlines];
  for (int y = tile.y0; y < tile.y1; ++y) {
    if (!by_outlines) row[0] = {tile.x0, tile.x1, nullptr};
    size_t in_row = by_outlines ? 0 : 1;
    for (size_t i = 0; i < count; ++i) {
      const int begin = of_outline[i].begin[y - tile.y0], end = of_outline[i].end[y - tile.y0];
      if (begin < end) row[in_row++] = {begin, end, alone[i]};
    }
    PutRow(row, in_row, tile, y, &candidates->spans);
  }
}
}  // namespace nacre
#endif
