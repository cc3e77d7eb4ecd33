// SPDX-License-Identifier: Apache-2.0
// visibility/sphere_boxes_kernel.cc: Project on a vector of spheres, and the cells and rows that
// the bounds overlap. No product is fused, so that all targets find the boxes of Project.
#include <algorithm>
#include <cmath>
#include <limits>

#include "visibility/sphere_bins.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "visibility/sphere_boxes_kernel.cc"
#include "hwy/foreach_target.h"

#include "base/vec3-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre::HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;

using BoxTag = hn::ScalableTag<double>;
using BoxV = hn::Vec<BoxTag>;
using BoxMask = hn::Mask<BoxTag>;

struct RangeV {
  BoxV low, high;
};

// Slopes() of slopes.h for a vector of discs about (x, z).
HWY_INLINE RangeV SlopesV(BoxV x, BoxV z, BoxV radius) {
  const BoxTag d;
  const BoxV infinity = hn::Set(d, std::numeric_limits<double>::infinity());
  const BoxV far = hn::Add(z, radius);
  const BoxV product = hn::Mul(hn::Sub(z, radius), far);
  const BoxMask in_front =
      hn::And(hn::Gt(z, hn::Mul(radius, hn::Set(d, 1 + 1e-6))), hn::Gt(product, hn::Zero(d)));
  const BoxV root = hn::Mul(radius, hn::Sqrt(hn::Add(hn::Mul(x, x), product)));
  const BoxV middle = hn::Mul(x, z);
  RangeV range{hn::Div(hn::Sub(middle, root), product), hn::Div(hn::Add(middle, root), product)};
  if (!hn::AllTrue(d, in_front)) {
    const BoxV low =
        hn::IfThenElse(hn::Gt(x, radius), hn::Div(hn::Sub(x, radius), far), hn::Neg(infinity));
    const BoxV high =
        hn::IfThenElse(hn::Lt(x, hn::Neg(radius)), hn::Div(hn::Add(x, radius), far), infinity);
    range = {hn::IfThenElse(in_front, range.low, low), hn::IfThenElse(in_front, range.high, high)};
  }
  return range;
}

// Converts slopes to pixels, with the margins of Project and of samples outside their pixels.
HWY_INLINE RangeV ToPixels(const SphereBins& bins, const RangeV& slopes, double middle) {
  const BoxTag d;
  const double per_slope = bins.projector.inverse_pixel;
  const auto outward = [&](BoxV slope, double sign) HWY_ATTR {
    const BoxV out = hn::Set(d, sign);
    const BoxV at = hn::Add(hn::Mul(slope, hn::Set(d, per_slope)), hn::Set(d, middle));
    const BoxV size =
        hn::Add(hn::Abs(hn::Sub(at, hn::Set(d, middle))), hn::Set(d, std::abs(middle)));
    const BoxV rounding =
        hn::Mul(hn::Set(d, kProjectionRounding), hn::Add(size, hn::Set(d, per_slope)));
    const BoxV close = hn::Add(at, hn::Mul(out, rounding));
    const BoxV margin =
        hn::Add(hn::Add(hn::Set(d, kProjectionMargin),
                        hn::Mul(hn::Set(d, kRelativeProjectionMargin), hn::Abs(close))),
                hn::Set(d, kDirectionRounding * per_slope));
    return hn::Add(hn::Add(close, hn::Mul(out, margin)), hn::Set(d, sign * bins.sample_margin));
  };
  return {outward(slopes.low, -1), outward(slopes.high, 1)};
}

// Stores the first and the last of the `count` intervals of `size` pixels, beginning at pixel
// `begin`, that [low, high] overlaps; 1 and 0 if there are none.
HWY_INLINE void StoreIndices(const RangeV& range, int begin, int size, int count, BoxMask visible,
                             int32_t* first_to, int32_t* last_to) {
  const BoxTag d;
  const hn::Rebind<int32_t, BoxTag> di;
  const BoxV zero = hn::Zero(d);
  const auto index_of = [&](BoxV at) HWY_ATTR {
    return hn::Div(hn::Sub(at, hn::Set(d, static_cast<double>(begin))),
                   hn::Set(d, static_cast<double>(size)));
  };
  const BoxV first = hn::Max(index_of(range.low), zero);
  const BoxV last = hn::Min(index_of(range.high), hn::Set(d, count - 1.0));
  const BoxMask some =
      hn::And(visible, hn::And(hn::Ge(last, zero), hn::Lt(first, hn::Set(d, count + 0.0))));
  const BoxV one = hn::Set(d, 1.0);
  hn::StoreU(hn::DemoteTo(di, hn::IfThenElse(some, first, one)), di, first_to);
  hn::StoreU(hn::DemoteTo(di, hn::IfThenElseZero(some, last)), di, last_to);
}

// Finds the boxes of one vector of spheres.
HWY_INLINE void FindVector(const SphereBins& bins, const TraceSphere* spheres, SphereBox* boxes) {
  const BoxTag d;
  constexpr size_t kMost = hn::MaxLanes(BoxTag());
  const Projector& p = bins.projector;
  Vec3V<BoxV> center;
  BoxV radius;
  hn::LoadInterleaved4(d, &spheres->center.x, center.x, center.y, center.z, radius);
  const BoxV x = Dot(center, SetVec3(d, p.right));
  const BoxV y = Dot(center, SetVec3(d, p.down));
  const BoxV z = Dot(center, SetVec3(d, p.forward));
  RangeV across{hn::Sub(x, radius), hn::Add(x, radius)};
  RangeV along{hn::Sub(y, radius), hn::Add(y, radius)};
  if (p.perspective) {
    across = SlopesV(x, z, radius);
    along = SlopesV(y, z, radius);
  }
  const BoxMask visible = hn::Gt(hn::Add(z, radius), hn::Zero(d));
  int32_t first_column[kMost], last_column[kMost], first_row[kMost], last_row[kMost];
  StoreIndices(ToPixels(bins, across, p.middle_x), bins.window.x0, kCellSize, bins.columns, visible,
               first_column, last_column);
  StoreIndices(ToPixels(bins, along, p.middle_y), bins.window.y0, 1, bins.window.height(), visible,
               first_row, last_row);
  for (size_t i = 0; i < hn::Lanes(d); ++i) {
    const auto range = [&](const int32_t* first, const int32_t* last) {
      return SphereBox::Range{static_cast<uint16_t>(first[i]), static_cast<uint16_t>(last[i])};
    };
    boxes[i] = {range(first_column, last_column), range(first_row, last_row)};
  }
}

void FindBoxesT(const SphereBins& bins, const TraceSphere* spheres, size_t count,
                SphereBox* boxes) {
  constexpr size_t kMost = hn::MaxLanes(BoxTag());
  const size_t lanes = hn::Lanes(BoxTag());
  size_t i = 0;
  for (; i + lanes <= count; i += lanes) FindVector(bins, spheres + i, boxes + i);
  if (i == count) return;
  TraceSphere rest[kMost];
  SphereBox boxes_of_rest[kMost];
  for (size_t k = 0; k < lanes; ++k) rest[k] = spheres[std::min(i + k, count - 1)];
  FindVector(bins, rest, boxes_of_rest);
  std::copy(boxes_of_rest, boxes_of_rest + (count - i), boxes + i);
}

}  // namespace
}  // namespace nacre::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nacre {
HWY_EXPORT(FindBoxesT);

void FindBoxes(const SphereBins& bins, const TraceSphere* spheres, size_t count, SphereBox* boxes) {
  HWY_DYNAMIC_DISPATCH(FindBoxesT)(bins, spheres, count, boxes);
}
}  // namespace nacre
#endif
