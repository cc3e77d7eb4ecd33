// SPDX-License-Identifier: Apache-2.0
// visibility/pixel_spans_kernel.cc: computes the spans of outlines, for all rows of a tile at once.
#include <algorithm>
#include <limits>

#include "base/aligned.h"
#include "hit/batch.h"
#include "visibility/sphere_bins.h"
#include "visibility/tile_kernel.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "visibility/pixel_spans_kernel.cc"
#include "hwy/foreach_target.h"

#include "hwy/highway.h"

#include "base/vec3-inl.h"

#ifndef NACRE_VISIBILITY_PIXEL_SPANS_KERNEL_ONCE_
#define NACRE_VISIBILITY_PIXEL_SPANS_KERNEL_ONCE_
namespace nacre {
namespace {

// With more outlines in a tile, most spans overlap.
constexpr size_t kMaxOutlines = 32;

// An ellipse that extends beyond this coordinate, in pixels, is replaced by whole rows. The outline
// of a sphere that nearly touches the camera's plane is so large that no digits of its near end are
// left.
constexpr double kFarthest = 1e6;

// The error bound of floats, relative to the sum of an outline's distance from the tile, half its
// size and 32 pixels: 16 roundings. No side in ComputeSpans has more than 8: in x the roundings of
// the middle, the lean and the chord, which has a root and a product; in y those of the middle, of
// the row's edge and of t, and that of the extreme that t is compared with.
constexpr double kFloatSlack = 16 * 0x1p-24;

// The outlines of spheres in the image, in pixels from the tile's top left corner. Each is an
// ellipse, x = middle + lean t -+ half_chord sqrt(1 - t^2) with t = (y - middle_y)
// inverse_half_height from -1 to 1. Its rightmost point is at t = extreme, its leftmost at
// -extreme. An outline that is no ellipse becomes an infinite strip. Each middle is stored twice,
// moved to either side by the bound of the rounding errors.
struct Outlines {
  size_t count = 0;
  alignas(
      kVectorBytes) double sphere[4][kMaxOutlines];  // centre and radius: ComputeOutlines' input
  alignas(kVectorBytes) float left[kMaxOutlines], right[kMaxOutlines];
  alignas(kVectorBytes) float left_middle[kMaxOutlines], right_middle[kMaxOutlines];
  alignas(kVectorBytes) float upper_middle[kMaxOutlines], lower_middle[kMaxOutlines];
  alignas(kVectorBytes) float inverse_half_height[kMaxOutlines], half_chord[kMaxOutlines];
  alignas(kVectorBytes) float lean[kMaxOutlines], extreme[kMaxOutlines];
};

// The pixels of a tile's row that an outline covers, [begin(), end()) from the tile's left edge,
// and the outline's index, packed into one word so that sorting words sorts spans by their begin.
struct RowSpan {
  uint32_t bits;

  static constexpr uint32_t kNone = ~0u;  // the outline does not cover any
  static constexpr int kOutlineBits = 5, kPixelBits = 12, kBeginBits = kOutlineBits + kPixelBits;
  static_assert(kMaxOutlines <= 1 << kOutlineBits);
  static_assert(kBatchCapacity < 1 << kPixelBits);  // no tile has as many pixels

  uint32_t begin() const { return bits >> kBeginBits; }
  uint32_t end() const { return bits >> kOutlineBits & ((1u << kPixelBits) - 1); }
  uint32_t outline() const { return bits & ((1u << kOutlineBits) - 1); }
  bool operator<(const RowSpan& other) const { return bits < other.bits; }
};

// The RowSpan of an outline in each of a tile's rows.
struct OutlineSpans {
  alignas(64) uint32_t rows[kCellSize];
};

}  // namespace
}  // namespace nacre
#endif

HWY_BEFORE_NAMESPACE();
namespace nacre::HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;

// The extent of an outline along one axis: its middle and half its size, in pixels.
template <class V>
struct ExtentV {
  V middle, half;
};

// In slopes u = x / z, v = y / z the outline is (x u + y v + z)^2 = (|c|^2 - r^2) (u^2 + v^2 + 1):
// an ellipse about z (x, y) / (z^2 - r^2). The entries of the inverse of its matrix are the square
// of half its width, the skew, and the square of half its height.
//
// A margin is added to half the width and to half the height, while the middle and the skew stay:
// the larger ellipse contains the outline.
void ComputeOutlines(const Projector& projector, const Window& tile, Outlines* o) {
  const hn::CappedTag<double, kMaxOutlines> d;
  const hn::Rebind<float, decltype(d)> df;
  using V = hn::Vec<decltype(d)>;
  const V zero = hn::Zero(d), one = hn::Set(d, 1.0);
  const auto set3 = [&](const Vec3d& v) HWY_ATTR { return SetVec3(d, v); };
  const auto right = set3(projector.right), down = set3(projector.down);
  const auto forward = set3(projector.forward);
  const V inverse_pixel = hn::Set(d, projector.inverse_pixel);
  for (size_t i = 0; i < o->count; i += hn::Lanes(d)) {
    const auto center = Load3(d, o->sphere, i);
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
    const V margin = hn::MulAdd(hn::Set(d, kRelativeProjectionMargin), farthest,
                                hn::Set(d, ProjectionMargin(projector, 0)));
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
    store(hn::Div(lean, half_width), 0, o->extreme);
  }
}

// Computes the spans of outline i. Samples lie up to `sample_margin` pixels outside their pixels.
// `width` is that of the tile.
void ComputeSpans(const Outlines& o, size_t i, float sample_margin, int width,
                  OutlineSpans* spans) {
  const hn::CappedTag<float, kCellSize> d;
  const hn::Rebind<int32_t, decltype(d)> di;
  const hn::Rebind<uint32_t, decltype(d)> du;
  const auto zero = hn::Zero(d), one = hn::Set(d, 1.0f), minus_one = hn::Set(d, -1.0f);
  const auto columns = hn::Set(d, static_cast<float>(width));
  const auto outline = hn::Set(du, static_cast<uint32_t>(i)), none = hn::Set(du, RowSpan::kNone);
  const auto left_middle = hn::Set(d, o.left_middle[i]);
  const auto right_middle = hn::Set(d, o.right_middle[i]);
  const auto upper_middle = hn::Set(d, o.upper_middle[i] + sample_margin);
  const auto lower_middle = hn::Set(d, o.lower_middle[i] - (1 + sample_margin));
  const auto half_chord = hn::Set(d, o.half_chord[i]), lean = hn::Set(d, o.lean[i]);
  const auto extreme = hn::Set(d, o.extreme[i]);
  const auto inverse = hn::Set(d, o.inverse_half_height[i]);
  for (int row = 0; row < kCellSize; row += static_cast<int>(hn::Lanes(d))) {
    const auto y = hn::Iota(d, static_cast<float>(row));
    // The part of the outline between the row's upper and lower edge.
    const auto upper = hn::Mul(hn::Sub(y, upper_middle), inverse);
    const auto lower = hn::Mul(hn::Sub(y, lower_middle), inverse);
    const auto met = hn::And(hn::Lt(upper, one), hn::Gt(lower, minus_one));
    const auto low = hn::Max(upper, minus_one), high = hn::Min(lower, one);
    const auto chord = [&](auto t) HWY_ATTR {
      const auto squared = hn::Mul(hn::Sub(one, t), hn::Add(one, t));  // 1 - t^2 loses digits
      return hn::Mul(half_chord, hn::Sqrt(hn::Max(squared, zero)));
    };
    const auto low_chord = chord(low), high_chord = chord(high);
    const auto contains = [&](auto t) HWY_ATTR { return hn::And(hn::Le(low, t), hn::Le(t, high)); };
    const auto right_at = [&](auto t, auto half)
                              HWY_ATTR { return hn::Add(hn::MulAdd(lean, t, right_middle), half); };
    const auto left_at = [&](auto t, auto half)
                             HWY_ATTR { return hn::Sub(hn::MulAdd(lean, t, left_middle), half); };
    const auto right =
        hn::IfThenElse(contains(extreme), hn::Set(d, o.right[i]),
                       hn::Max(right_at(low, low_chord), right_at(high, high_chord)));
    const auto left = hn::IfThenElse(contains(hn::Neg(extreme)), hn::Set(d, o.left[i]),
                                     hn::Min(left_at(low, low_chord), left_at(high, high_chord)));
    const auto pixel = [&](auto x) HWY_ATTR {
      const auto inside = hn::Min(hn::Max(x, zero), columns);
      return hn::BitCast(du, hn::ConvertTo(di, inside));  // rounded down: none is below 0
    };
    const auto begin = pixel(hn::Sub(left, hn::Set(d, sample_margin)));
    const auto end =
        pixel(hn::IfThenElse(met, hn::Add(right, hn::Set(d, sample_margin + 1)), zero));
    const auto bits = hn::Or(hn::ShiftLeft<RowSpan::kBeginBits>(begin),
                             hn::Or(hn::ShiftLeft<RowSpan::kOutlineBits>(end), outline));
    hn::StoreU(hn::IfThenElse(hn::Lt(begin, end), bits, none), du, spans->rows + row);
  }
}

void FindOutlineSpansT(const Projector& projector, double sample_margin, const Window& tile,
                       Outlines* outlines, OutlineSpans* spans) {
  ComputeOutlines(projector, tile, outlines);
  for (size_t i = 0; i < outlines->count; ++i) {
    ComputeSpans(*outlines, i, static_cast<float>(sample_margin), tile.width(), spans + i);
  }
}

}  // namespace
}  // namespace nacre::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nacre {
HWY_EXPORT(FindOutlineSpansT);

namespace {

// Appends a row's spans; those that overlap are merged. `in_front` are the candidates of the
// outlines, or null for those that do not lie in front of the camera. `first` is the row's first
// pixel.
void AppendSpansOfRow(RowSpan* row, size_t count, const TileCandidate* const* in_front,
                      uint32_t first, std::vector<PixelSpan>* spans) {
  std::sort(row, row + count);
  for (size_t i = 0; i < count;) {
    const RowSpan& span = row[i++];
    const TileCandidate* only = in_front[span.outline()];
    uint32_t end = span.end();
    for (; i < count && row[i].begin() < end; ++i) {
      end = std::max(end, row[i].end());
      only = nullptr;
    }
    spans->push_back({first + span.begin(), end - span.begin(), only});
  }
}

void AppendWholeRows(const Window& tile, std::vector<PixelSpan>* spans) {
  const auto width = static_cast<uint32_t>(tile.width());
  for (uint32_t y = 0; y < static_cast<uint32_t>(tile.height()); ++y) {
    spans->push_back({y * width, width, nullptr});
  }
}

// Collects the tile's spheres, each once. `in_front` is the same as in AppendSpansOfRow.
void GatherSpheres(const TileCandidates& candidates, Outlines* outlines,
                   const TileCandidate** in_front) {
  for (const std::vector<TileCandidate>& cell : candidates.cells) {
    for (const TileCandidate& candidate : cell) {
      if (candidate.in_cell_before) continue;
      const size_t i = outlines->count++;
      for (int c = 0; c < 3; ++c) outlines->sphere[c][i] = candidate.sphere.center[c];
      outlines->sphere[3][i] = candidate.sphere.radius;
      in_front[i] = candidate.in_front ? &candidate : nullptr;
    }
  }
  // Whole vectors are computed: the lanes behind the last sphere repeat the first one.
  for (size_t i = outlines->count; i % (kVectorBytes / sizeof(double)) != 0; ++i) {
    for (auto& values : outlines->sphere) values[i] = values[0];
  }
}

}  // namespace

void FindPixelSpans(const SphereBins& bins, TileCandidates* candidates) {
  const Window& tile = candidates->tile;
  if (!bins.projector.perspective || candidates->spheres > kMaxOutlines) {
    return AppendWholeRows(tile, &candidates->spans);
  }
  Outlines outlines;
  const TileCandidate* in_front[kMaxOutlines];
  OutlineSpans of_outline[kMaxOutlines];
  GatherSpheres(*candidates, &outlines, in_front);
  HWY_DYNAMIC_DISPATCH(FindOutlineSpansT)
  (bins.projector, bins.sample_margin, tile, &outlines, of_outline);
  RowSpan row[kMaxOutlines];
  for (int y = 0; y < tile.height(); ++y) {
    size_t in_row = 0;
    for (size_t i = 0; i < outlines.count; ++i) {
      row[in_row] = {of_outline[i].rows[y]};
      in_row += row[in_row].bits != RowSpan::kNone ? 1 : 0;
    }
    AppendSpansOfRow(row, in_row, in_front, static_cast<uint32_t>(y * tile.width()),
                     &candidates->spans);
  }
}
}  // namespace nacre
#endif
