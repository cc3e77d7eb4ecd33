// SPDX-License-Identifier: Apache-2.0
// shading/area_light_kernel.cc: directions to area lights from the hits of a batch, and where
// directions meet them.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shading/area_light_kernel.cc"
#include "hwy/foreach_target.h"

#include "hwy/highway.h"

#include "shading/area_kernels.h"
#include "shading/area_light_view-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::ScalableTag<float>;
using V = hn::Vec<D>;

// Calls use(at), where at(i) is the light relative to hits i...
template <class Use>
HWY_INLINE void VisitShape(const SampledLight& light, const HitBatch& hits, const Use& use) {
  if (light.form == SampledForm::kSphere) {
    return use([&](size_t i) HWY_ATTR {
      return SphereLightV<V>{Offset(light, hits, i),
                             hn::Set(D(), static_cast<float>(light.radius))};
    });
  }
  if (light.form == SampledForm::kRectangle) {
    return use([&](size_t i) HWY_ATTR {
      return RectangleLightV<V>{Offset(light, hits, i), SetVec3(D(), light.edge_x),
                                SetVec3(D(), light.edge_y)};
    });
  }
  use([&](size_t i) HWY_ATTR {
    return DiskLightV<V>{Offset(light, hits, i), SetVec3(D(), light.normal),
                         hn::Set(D(), static_cast<float>(light.radius))};
  });
}

// Where a direction meets the light: the distance, and the cosine at the light, of which callers
// use the sign only.
struct MeetingV {
  V distance, cos_light;
};

// The distance to a sphere is the product of the distances to both intersections, divided by the
// farther one.
HWY_INLINE MeetingV Meet(const SphereLightV<V>& light, const Vec3V<V>& direction, const Vec3V<V>&) {
  const D d;
  const V zero = hn::Zero(d);
  const V distance = Length(light.centre);
  const Vec3V<V> across = FusedCross(direction, light.centre);
  const V along = FusedDot(direction, light.centre);
  const V half_chord =
      hn::Sqrt(hn::Max(hn::MulSub(light.radius, light.radius, FusedDot(across, across)), zero));
  const V product = hn::Mul(hn::Sub(distance, light.radius), hn::Add(distance, light.radius));
  return {hn::Mul(product, InverseIfPositive(d, hn::Add(along, half_chord))),
          hn::Sub(distance, light.radius)};
}

HWY_INLINE Vec3V<V> PointOf(const RectangleLightV<V>& light) { return light.corner; }
HWY_INLINE Vec3V<V> PointOf(const DiskLightV<V>& light) { return light.centre; }

// A flat light, which has this normal.
template <class Flat>
HWY_INLINE MeetingV Meet(const Flat& light, const Vec3V<V>& direction, const Vec3V<V>& normal) {
  const D d;
  const V towards = FusedDot(direction, normal);
  const auto parallel = hn::Eq(towards, hn::Zero(d));
  const V safe = hn::IfThenElse(parallel, hn::Set(d, 1.0f), towards);
  return {hn::IfThenElseZero(hn::Not(parallel), hn::Div(FusedDot(PointOf(light), normal), safe)),
          hn::Neg(towards)};
}

// Stores a direction's distance and pdf. Both are 0 if it misses the light or meets a side of it
// that does not emit.
HWY_INLINE void Keep(const SampledLight& light, V distance, V pdf, V cos_light, size_t i,
                     LightDirections* directions) {
  const D d;
  const V zero = hn::Zero(d);
  auto seen = hn::And(hn::Gt(pdf, zero), hn::Gt(distance, zero));
  if (!light.two_sided) seen = hn::And(seen, hn::Gt(cos_light, zero));
  hn::StoreU(hn::IfThenElseZero(seen, distance), d, directions->distance.data() + i);
  hn::StoreU(hn::IfThenElseZero(seen, pdf), d, directions->pdf.data() + i);
}

// at(i) is the light relative to hits i...
template <class At>
void SampleShape(const SampledLight& light, size_t count, const UnitPoints& points,
                 LightDirections* directions, const At& at) {
  const D d;
  for (size_t i = 0; i < count; i += hn::Lanes(d)) {
    const AreaSampleV<V> sample =
        SampleLight(d, at(i), hn::LoadU(d, points.u.data() + i), hn::LoadU(d, points.v.data() + i));
    StoreSoa(d, sample.to_light, i, &directions->to_light);
    Keep(light, sample.distance, InverseIfPositive(d, sample.inverse_pdf), sample.cos_light, i,
         directions);
  }
}

template <class At>
void FindShape(const SampledLight& light, size_t count, LightDirections* directions, const At& at) {
  const D d;
  const Vec3V<V> normal = SetVec3(d, light.normal);
  for (size_t i = 0; i < count; i += hn::Lanes(d)) {
    const Vec3V<V> to_light = LoadSoa(D(), directions->to_light, i);
    const auto shape = at(i);
    const MeetingV meeting = Meet(shape, to_light, normal);
    Keep(light, meeting.distance, LightPdf(d, shape, to_light), meeting.cos_light, i, directions);
  }
}

// Whether hits see a side that emits. `normal` is that of flat lights.
HWY_INLINE hn::Mask<D> IsSeen(const SphereLightV<V>& light, const Vec3V<V>&) {
  return hn::Gt(Length(light.centre), light.radius);
}
template <class Flat>
HWY_INLINE hn::Mask<D> IsSeen(const Flat& light, const Vec3V<V>& normal) {
  return hn::Lt(FusedDot(PointOf(light), normal), hn::Zero(D()));
}

template <class At>
void ShapeIrradiance(const SampledLight& light, const Surface& surface, size_t count,
                     float* irradiance, const At& at) {
  const D d;
  const Soa3<float>& n = surface.normal;
  const Vec3V<V> normal = SetVec3(d, light.normal);
  for (size_t i = 0; i < count; i += hn::Lanes(d)) {
    const auto shape = at(i);
    const V value = hn::Max(Irradiance(d, shape, LoadSoa(D(), n, i)), hn::Zero(d));
    hn::StoreU(light.two_sided ? value : hn::IfThenElseZero(IsSeen(shape, normal), value), d,
               irradiance + i);
  }
}

void SampleAreaT(const SampledLight& light, const HitBatch& hits, const UnitPoints& points,
                 LightDirections* directions) {
  VisitShape(light, hits,
             [&](const auto& at) { SampleShape(light, hits.count, points, directions, at); });
}

void FindAreaT(const SampledLight& light, const HitBatch& hits, LightDirections* directions) {
  VisitShape(light, hits, [&](const auto& at) { FindShape(light, hits.count, directions, at); });
}

void AreaIrradianceT(const SampledLight& light, const HitBatch& hits, const Surface& surface,
                     float* irradiance) {
  VisitShape(light, hits,
             [&](const auto& at) { ShapeIrradiance(light, surface, hits.count, irradiance, at); });
}

using DD = hn::ScalableTag<double>;
using VD = hn::Vec<DD>;

// Meet in double, for directions of nearly unit length.
HWY_INLINE VD EndOnSphere(const Vec3V<VD>& centre, double radius, const Vec3V<VD>& direction) {
  const DD d;
  const VD dd = Dot(direction, direction);
  const VD along = Dot(direction, centre);
  const Vec3V<VD> across = Cross(direction, centre);
  const VD square = hn::Mul(hn::Set(d, radius * radius), dd);
  const VD root = hn::Sqrt(hn::Max(hn::Sub(square, Dot(across, across)), hn::Zero(d)));
  const VD product = hn::Sub(Dot(centre, centre), hn::Set(d, radius * radius));
  return hn::Div(product, hn::Add(along, root));
}

void AreaEndsT(const SampledLight& light, const HitBatch& hits, const Soa3<float>& to_light,
               double* t_max) {
  const DD d;
  const VD zero = hn::Zero(d);
  const Vec3V<VD> place = SetVec3(d, light.place), normal = SetVec3(d, light.normal);
  for (size_t i = 0; i < hits.count; i += hn::Lanes(d)) {
    const VD given = hn::LoadU(d, t_max + i);
    const auto asked = hn::Gt(given, zero);
    if (hn::AllFalse(d, asked)) continue;
    const Vec3V<VD> offset = Sub(place, LoadSoa(d, hits.position, i));
    const Vec3V<VD> direction = PromoteSoa(d, to_light, i);
    const VD end = light.form == SampledForm::kSphere
                       ? EndOnSphere(offset, light.radius, direction)
                       : hn::Div(Dot(offset, normal), Dot(direction, normal));
    // This is false for NaN, too, which directions that are not asked for may give.
    const auto exists = hn::And(hn::Gt(end, zero), hn::Lt(end, hn::Inf(d)));
    hn::StoreU(hn::IfThenElse(hn::And(exists, asked), end, given), d, t_max + i);
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nacre {
HWY_EXPORT(SampleAreaT);
HWY_EXPORT(FindAreaT);
HWY_EXPORT(AreaIrradianceT);
HWY_EXPORT(AreaEndsT);

void SampleArea(const SampledLight& light, const HitBatch& hits, const UnitPoints& points,
                LightDirections* directions) {
  HWY_DYNAMIC_DISPATCH(SampleAreaT)(light, hits, points, directions);
}

void FindArea(const SampledLight& light, const HitBatch& hits, LightDirections* directions) {
  HWY_DYNAMIC_DISPATCH(FindAreaT)(light, hits, directions);
}

void AreaIrradiance(const SampledLight& light, const HitBatch& hits, const Surface& surface,
                    float* irradiance) {
  HWY_DYNAMIC_DISPATCH(AreaIrradianceT)(light, hits, surface, irradiance);
}

void AreaEnds(const SampledLight& light, const HitBatch& hits, const LightDirections& directions,
              AlignedArray<double>* t_max) {
  HWY_DYNAMIC_DISPATCH(AreaEndsT)(light, hits, directions.to_light, t_max->data());
}
}  // namespace nacre
#endif
