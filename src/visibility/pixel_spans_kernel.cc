// SPDX-License-Identifier: Apache-2.0
// visibility/pixel_spans_kernel.cc: the outlines' spans in all rows of a tile at once.
#include <algorithm>
#include <limits>

#include "visibility/pixel_spans.h"
#include "visibility/sphere_bins.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "visibility/pixel_spans_kernel.cc"
#include "hwy/foreach_target.h"

#include "hwy/highway.h"

#include "base/geometry-inl.h"

#ifndef NACRE_VISIBILITY_PIXEL_SPANS_KERNEL_ONCE_
#define NACRE_VISIBILITY_PIXEL_SPANS_KERNEL_ONCE_
namespace nacre {
namespace {

// Beyond these, most spans overlap.
constexpr size_t kMaxOutlines = 32;

// Beyond this coordinate, in pixels, an ellipse is left to be any row: that of a sphere that nearly
// touches the plane of the camera ends so far away that its near end is lost in roundings.
constexpr double kFarthest = 1e6;

// What floats may be off by, of the sum of an outline's distance from the tile, half its size and
// 32 pixels: 16 roundings. The most that one side of FindSpans adds up is 8: of x, those of the
// middle, the lean and the chord, whose own are a root's and a product's; of y, those of the
// middle, of the row's edge and of t, with the turn's that t is compared with.
constexpr double kFloatSlack = 16 * 0x1p-24;

// Spheres as they are seen on the film, in pixels from the tile's top left corner: each an ellipse,
// x = middle + lean t -+ half_chord sqrt(1 - t^2) with t = (y - middle_y) inverse_half_height from
// -1 to 1. Its rightmost point is at t = turn, its leftmost at -turn. What is no ellipse is a strip
// that covers all. Of each middle there are two, so far apart that roundings lie between them.
struct Outlines {
  size_t count = 0;
  alignas(kVectorBytes) double sphere[4][kMaxOutlines];  // centre and radius; the rest follows
  alignas(kVectorBytes) float left[kMaxOutlines], right[kMaxOutlines];
  alignas(kVectorBytes) float left_middle[kMaxOutlines], right_middle[kMaxOutlines];
  alignas(kVectorBytes) float upper_middle[kMaxOutlines], lower_middle[kMaxOutlines];
  alignas(kVectorBytes) float inverse_half_height[kMaxOutlines], half_chord[kMaxOutlines];
  alignas(kVectorBytes) float lean[kMaxOutlines], turn[kMaxOutlines];
};

// The pixels of a tile's row that an outline reaches, from begin() to end(), counted from the
// tile's left edge, and the outline's number: in one word, so that words are sorted as spans are.
struct RowSpan {
  uint32_t bits;

  static constexpr uint32_t kNone = ~0u;  // it reaches none
  static constexpr int kOutlineBits = 5, kPixelBits = 12, kBeginBits = kOutlineBits + kPixelBits;
  static_assert(kMaxOutlines <= 1 << kOutlineBits);
  static_assert(kBatchCapacity < 1 << kPixelBits);  // no tile has as many pixels

  uint32_t begin() const { return bits >> kBeginBits; }
  uint32_t end() const { return bits >> kOutlineBits & ((1u << kPixelBits) - 1); }
  uint32_t outline() const { return bits & ((1u << kOutlineBits) - 1); }
  bool operator<(const RowSpan& other) const { return bits < other.bits; }
};

// Those of an outline in each of a tile's rows.
struct OutlineSpans {
  alignas(64) uint32_t rows[kCellSize];
};

}  // namespace
}  // namespace nacre
#endif

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;

// What the sphere's outline reaches along one axis: its middle and half its size, in pixels.
template <class V>
struct ExtentV {
  V middle, half;
};

// By slopes u = x / z, v = y / z the outline is (x u + y v + z)^2 = (|c|^2 - r^2) (u^2 + v^2 + 1):
// an ellipse about z (x, y) / (z^2 - r^2), with half its width squared, the skew and half its
// height squared for the entries of the inverse of its matrix.
//
// With a margin all around: half the width and half the height grow by as much, about the same
// middle and with the same skew, so what was the outline lies inside.
void FindOutlines(const Projector& projector, const Window& tile, Outlines* o) {
  const hn::CappedTag<double, kMaxOutlines> d;
  const hn::Rebind<float, decltype(d)> df;
  using V = hn::Vec<decltype(d)>;
  const V zero = hn::Zero(d), one = hn::Set(d, 1.0);
  const auto set3 = [&](const Vec3d& v) HWY_ATTR { return SetVec3(d, v); };
  const auto right = set3(projector.right), down = set3(projector.down);
  const auto forward = set3(projector.forward);
  const V inverse_pixel = hn::Set(d, projector.inverse_pixel);
  for (size_t i = 0; i < o->count; i += hn::Lanes(d)) {
    const auto center = Load3(d, o->sphere[0] + i, o->sphere[1] + i, o->sphere[2] + i);
    const V radius = hn::Load(d, o->sphere[3] + i);
    const V x = Dot(center, right), y = Dot(center, down), z = Dot(center, forward);
    const V product = hn::Mul(hn::Sub(z, radius), hn::Add(z, radius));
    const V scale = hn::Div(inverse_pixel, product);  // from slopes times the product to pixels
    const auto extent = [&](V at, double film_middle) HWY_ATTR {
      const V root = hn::Sqrt(hn::Max(hn::MulAdd(at, at, product), zero));
      return ExtentV<V>{hn::MulAdd(hn::Mul(at, z), scale, hn::Set(d, film_middle)),
                        hn::Mul(hn::Mul(radius, root), scale)};
    };
    const auto across = extent(x, projector.middle_x), along = extent(y, projector.middle_y);
    const V farthest = hn::Max(hn::Add(hn::Abs(across.middle), across.half),
                               hn::Add(hn::Abs(along.middle), along.half));
    const V margin =
        hn::MulAdd(hn::Set(d, kMarginOfPlace), farthest, hn::Set(d, FilmMargin(projector, 0)));
    const V half_width = hn::Add(across.half, margin), half_height = hn::Add(along.half, margin);
    const V inverse_half_height = hn::Div(one, half_height);
    const V skew = hn::Mul(hn::Mul(x, y), hn::Mul(hn::Mul(radius, scale), hn::Mul(radius, scale)));
    const V lean = hn::Mul(skew, inverse_half_height);
    const V chord2 = hn::Sub(hn::Mul(half_width, half_width), hn::Mul(lean, lean));
    const auto is_ellipse =
        hn::And(hn::Gt(z, hn::Mul(radius, hn::Set(d, 1 + 1e-6))),
                hn::And(hn::Gt(product, zero), hn::Le(farthest, hn::Set(d, kFarthest))));
    const auto store = [&](V value, double otherwise, float* to) HWY_ATTR {
      const V stored = hn::IfThenElse(is_ellipse, value, hn::Set(d, otherwise));
      hn::Store(hn::DemoteTo(df, stored), df, to + i);
    };
    const V middle_x = hn::Sub(across.middle, hn::Set(d, tile.x0));
    const V middle_y = hn::Sub(along.middle, hn::Set(d, tile.y0));
    const auto slack_of = [&](V middle, V half) HWY_ATTR {
      const V size = hn::Add(hn::Add(hn::Abs(middle), half), hn::Set(d, 32.0));
      return hn::Mul(size, hn::Set(d, kFloatSlack));
    };
    const V slack_x = slack_of(middle_x, half_width), slack_y = slack_of(middle_y, half_height);
    const V left_middle = hn::Sub(middle_x, slack_x), right_middle = hn::Add(middle_x, slack_x);
    const double infinity = std::numeric_limits<double>::infinity();
    store(hn::Sub(left_middle, half_width), -infinity, o->left);
    store(hn::Add(right_middle, half_width), infinity, o->right);
    store(left_middle, 0, o->left_middle);
    store(right_middle, 0, o->right_middle);
    store(hn::Add(middle_y, slack_y), 0, o->upper_middle);
    store(hn::Sub(middle_y, slack_y), 0, o->lower_middle);
    store(inverse_half_height, 0, o->inverse_half_height);
    store(hn::Sqrt(hn::Max(chord2, zero)), 0, o->half_chord);
    store(lean, 0, o->lean);
    store(hn::Div(lean, half_width), 0, o->turn);
  }
}

// Samples lie up to `reach` outside their pixels. `width`: the tile's.
void FindSpans(const Outlines& o, size_t i, float reach, int width, OutlineSpans* spans) {
  const hn::CappedTag<float, kCellSize> d;
  const hn::Rebind<int32_t, decltype(d)> di;
  const hn::Rebind<uint32_t, decltype(d)> du;
  const auto zero = hn::Zero(d), one = hn::Set(d, 1.0f), minus_one = hn::Set(d, -1.0f);
  const auto columns = hn::Set(d, static_cast<float>(width));
  const auto outline = hn::Set(du, static_cast<uint32_t>(i)), none = hn::Set(du, RowSpan::kNone);
  const auto left_middle = hn::Set(d, o.left_middle[i]);
  const auto right_middle = hn::Set(d, o.right_middle[i]);
  const auto upper_middle = hn::Set(d, o.upper_middle[i] + reach);
  const auto lower_middle = hn::Set(d, o.lower_middle[i] - (1 + reach));
  const auto half_chord = hn::Set(d, o.half_chord[i]), lean = hn::Set(d, o.lean[i]);
  const auto turn = hn::Set(d, o.turn[i]);
  const auto inverse = hn::Set(d, o.inverse_half_height[i]);
  for (int row = 0; row < kCellSize; row += static_cast<int>(hn::Lanes(d))) {
    const auto y = hn::Iota(d, static_cast<float>(row));
    // The outline from the row's upper edge to its lower one.
    const auto upper = hn::Mul(hn::Sub(y, upper_middle), inverse);
    const auto lower = hn::Mul(hn::Sub(y, lower_middle), inverse);
    const auto met = hn::And(hn::Lt(upper, one), hn::Gt(lower, minus_one));
    const auto low = hn::Max(upper, minus_one), high = hn::Min(lower, one);
    const auto chord = [&](auto t) HWY_ATTR {
      const auto squared = hn::Mul(hn::Sub(one, t), hn::Add(one, t));  // 1 - t^2 loses digits
      return hn::Mul(half_chord, hn::Sqrt(hn::Max(squared, zero)));
    };
    const auto low_chord = chord(low), high_chord = chord(high);
    const auto turns_at = [&](auto t) HWY_ATTR { return hn::And(hn::Le(low, t), hn::Le(t, high)); };
    const auto right_at = [&](auto t, auto half)
                              HWY_ATTR { return hn::Add(hn::MulAdd(lean, t, right_middle), half); };
    const auto left_at = [&](auto t, auto half)
                             HWY_ATTR { return hn::Sub(hn::MulAdd(lean, t, left_middle), half); };
    const auto right =
        hn::IfThenElse(turns_at(turn), hn::Set(d, o.right[i]),
                       hn::Max(right_at(low, low_chord), right_at(high, high_chord)));
    const auto left = hn::IfThenElse(turns_at(hn::Neg(turn)), hn::Set(d, o.left[i]),
                                     hn::Min(left_at(low, low_chord), left_at(high, high_chord)));
    const auto pixel = [&](auto x) HWY_ATTR {
      const auto inside = hn::Min(hn::Max(x, zero), columns);
      return hn::BitCast(du, hn::ConvertTo(di, inside));  // rounded down: none is below 0
    };
    const auto begin = pixel(hn::Sub(left, hn::Set(d, reach)));
    const auto end = pixel(hn::IfThenElse(met, hn::Add(right, hn::Set(d, reach + 1)), zero));
    const auto bits = hn::Or(hn::ShiftLeft<RowSpan::kBeginBits>(begin),
                             hn::Or(hn::ShiftLeft<RowSpan::kOutlineBits>(end), outline));
    hn::StoreU(hn::IfThenElse(hn::Lt(begin, end), bits, none), du, spans->rows + row);
  }
}

void FindOutlineSpansT(const Projector& projector, double reach, const Window& tile,
                       Outlines* outlines, OutlineSpans* spans) {
  FindOutlines(projector, tile, outlines);
  for (size_t i = 0; i < outlines->count; ++i) {
    FindSpans(*outlines, i, static_cast<float>(reach), tile.width(), spans + i);
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nacre {
HWY_EXPORT(FindOutlineSpansT);

namespace {

// Those that overlap become one. `first`: the row's first pixel.
void PutRow(RowSpan* row, size_t count, const TileCandidate* const* alone, uint32_t first,
            std::vector<PixelSpan>* spans) {
  if (!std::is_sorted(row, row + count)) std::sort(row, row + count);
  for (size_t i = 0; i < count;) {
    const RowSpan& span = row[i++];
    const TileCandidate* only = alone[span.outline()];
    uint32_t end = span.end();
    for (; i < count && row[i].begin() < end; ++i) {
      end = std::max(end, row[i].end());
      only = nullptr;
    }
    spans->push_back({first + span.begin(), end - span.begin(), only});
  }
}

// Of a tile's only outline, without a branch for the rows that it does not reach.
void PutRows(const OutlineSpans& outline, const TileCandidate* alone, const Window& tile,
             std::vector<PixelSpan>* spans) {
  const auto width = static_cast<uint32_t>(tile.width());
  spans->resize(static_cast<size_t>(tile.height()));
  size_t count = 0;
  for (uint32_t y = 0; y < static_cast<uint32_t>(tile.height()); ++y) {
    const RowSpan span{outline.rows[y]};
    (*spans)[count] = {y * width + span.begin(), span.end() - span.begin(), alone};
    count += span.bits != RowSpan::kNone ? 1 : 0;
  }
  spans->resize(count);
}

void PutWholeRows(const Window& tile, std::vector<PixelSpan>* spans) {
  const auto width = static_cast<uint32_t>(tile.width());
  for (uint32_t y = 0; y < static_cast<uint32_t>(tile.height()); ++y) {
    spans->push_back({y * width, width, nullptr});
  }
}

// The tile's spheres, each once. `alone`: those in front of the camera.
void PutSpheres(const TileCandidates& candidates, Outlines* outlines, const TileCandidate** alone) {
  for (const std::vector<TileCandidate>& cell : candidates.cells) {
    for (const TileCandidate& candidate : cell) {
      if (candidate.in_cell_before) continue;
      const size_t i = outlines->count++;
      for (int c = 0; c < 3; ++c) outlines->sphere[c][i] = candidate.sphere.center[c];
      outlines->sphere[3][i] = candidate.sphere.radius;
      alone[i] = candidate.in_front ? &candidate : nullptr;
    }
  }
  // Whole vectors are worked on.
  for (size_t i = outlines->count; i % (kVectorBytes / sizeof(double)) != 0; ++i) {
    for (auto& values : outlines->sphere) values[i] = values[0];
  }
}

}  // namespace

void FindPixelSpans(const SphereBins& bins, TileCandidates* candidates) {
  const Window& tile = candidates->tile;
  if (!bins.projector.perspective || candidates->spheres > kMaxOutlines) {
    return PutWholeRows(tile, &candidates->spans);
  }
  Outlines outlines;
  const TileCandidate* alone[kMaxOutlines];
  OutlineSpans of_outline[kMaxOutlines];
  PutSpheres(*candidates, &outlines, alone);
  HWY_DYNAMIC_DISPATCH(FindOutlineSpansT)(bins.projector, bins.reach, tile, &outlines, of_outline);
  candidates->alone = outlines.count == 1 ? alone[0] : nullptr;
  if (outlines.count == 1) return PutRows(of_outline[0], alone[0], tile, &candidates->spans);
  RowSpan row[kMaxOutlines];
  for (int y = 0; y < tile.height(); ++y) {
    size_t in_row = 0;
    for (size_t i = 0; i < outlines.count; ++i) {
      row[in_row] = {of_outline[i].rows[y]};
      in_row += row[in_row].bits != RowSpan::kNone ? 1 : 0;
    }
    PutRow(row, in_row, alone, static_cast<uint32_t>(y * tile.width()), &candidates->spans);
  }
}
}  // namespace nacre
#endif
