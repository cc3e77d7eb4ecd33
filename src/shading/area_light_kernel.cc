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

HWY_INLINE SphereLightV<V> SphereAt(const SampledLight& light, const HitBatch& hits, size_t i) {
  return {Offset(light, hits, i), hn::Set(D(), static_cast<float>(light.radius))};
}

HWY_INLINE RectangleLightV<V> RectangleAt(const SampledLight& light, const HitBatch& hits,
                                          size_t i) {
  return {Offset(light, hits, i), SetVec3(D(), light.edge_x), SetVec3(D(), light.edge_y)};
}

HWY_INLINE DiskLightV<V> DiskAt(const SampledLight& light, const HitBatch& hits, size_t i) {
  return {Offset(light, hits, i), SetVec3(D(), light.normal),
          hn::Set(D(), static_cast<float>(light.radius))};
}

// Where a direction meets the light: the distance, and the cosine at the light, of which callers
// use the sign only.
struct MeetingV {
  V distance, cos_light;
};

// The distance to a sphere is the product of the distances to both intersections, divided by the
// farther one.
HWY_INLINE MeetingV Meet(const SphereLightV<V>& light, const Vec3V<V>& direction) {
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

HWY_INLINE MeetingV MeetPlane(const Vec3V<V>& point, const Vec3V<V>& normal,
                              const Vec3V<V>& direction) {
  const D d;
  const V towards = FusedDot(direction, normal);
  const auto parallel = hn::Eq(towards, hn::Zero(d));
  const V safe = hn::IfThenElse(parallel, hn::Set(d, 1.0f), towards);
  return {hn::IfThenElseZero(hn::Not(parallel), hn::Div(FusedDot(point, normal), safe)),
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

template <class At, class MeetAt>
void FindShape(const SampledLight& light, size_t count, LightDirections* directions, const At& at,
               const MeetAt& meet) {
  const D d;
  for (size_t i = 0; i < count; i += hn::Lanes(d)) {
    const Vec3V<V> to_light = LoadSoa(D(), directions->to_light, i);
    const auto shape = at(i);
    const MeetingV meeting = meet(shape, to_light);
    Keep(light, meeting.distance, LightPdf(d, shape, to_light), meeting.cos_light, i, directions);
  }
}

void SampleAreaT(const SampledLight& light, const HitBatch& hits, const UnitPoints& points,
                 LightDirections* directions) {
  const auto sample = [&](const auto& at) {
    SampleShape(light, hits.count, points, directions, at);
  };
  if (light.form == SampledForm::kSphere) {
    return sample([&](size_t i) HWY_ATTR { return SphereAt(light, hits, i); });
  }
  if (light.form == SampledForm::kRectangle) {
    return sample([&](size_t i) HWY_ATTR { return RectangleAt(light, hits, i); });
  }
  sample([&](size_t i) HWY_ATTR { return DiskAt(light, hits, i); });
}

void FindAreaT(const SampledLight& light, const HitBatch& hits, LightDirections* directions) {
  const auto find = [&](const auto& at, const auto& meet) {
    FindShape(light, hits.count, directions, at, meet);
  };
  if (light.form == SampledForm::kSphere) {
    return find([&](size_t i) HWY_ATTR { return SphereAt(light, hits, i); },
                [](const SphereLightV<V>& sphere, const Vec3V<V>& direction)
                    HWY_ATTR { return Meet(sphere, direction); });
  }
  const Vec3V<V> normal = SetVec3(D(), light.normal);
  if (light.form == SampledForm::kRectangle) {
    return find([&](size_t i) HWY_ATTR { return RectangleAt(light, hits, i); },
                [&](const RectangleLightV<V>& rectangle, const Vec3V<V>& direction)
                    HWY_ATTR { return MeetPlane(rectangle.corner, normal, direction); });
  }
  find([&](size_t i) HWY_ATTR { return DiskAt(light, hits, i); },
       [&](const DiskLightV<V>& disk, const Vec3V<V>& direction)
           HWY_ATTR { return MeetPlane(disk.centre, normal, direction); });
}

// front(shape) selects the hits that see a side that emits.
template <class At, class Front>
void ShapeIrradiance(const SampledLight& light, const Surface& surface, size_t count,
                     float* irradiance, const At& at, const Front& front) {
  const D d;
  const Soa3<float>& n = surface.normal;
  for (size_t i = 0; i < count; i += hn::Lanes(d)) {
    const auto shape = at(i);
    const V value = hn::Max(Irradiance(d, shape, LoadSoa(D(), n, i)), hn::Zero(d));
    hn::StoreU(light.two_sided ? value : hn::IfThenElseZero(front(shape), value), d,
               irradiance + i);
  }
}

void AreaIrradianceT(const SampledLight& light, const HitBatch& hits, const Surface& surface,
                     float* irradiance) {
  const auto fill = [&](const auto& at, const auto& front) {
    ShapeIrradiance(light, surface, hits.count, irradiance, at, front);
  };
  const Vec3V<V> normal = SetVec3(D(), light.normal);
  const auto before = [&](const Vec3V<V>& offset)
                          HWY_ATTR { return hn::Lt(FusedDot(offset, normal), hn::Zero(D())); };
  if (light.form == SampledForm::kSphere) {
    return fill([&](size_t i) HWY_ATTR { return SphereAt(light, hits, i); },
                [](const SphereLightV<V>& sphere)
                    HWY_ATTR { return hn::Gt(Length(sphere.centre), sphere.radius); });
  }
  if (light.form == SampledForm::kRectangle) {
    return fill([&](size_t i) HWY_ATTR { return RectangleAt(light, hits, i); },
                [&](const RectangleLightV<V>& r) HWY_ATTR { return before(r.corner); });
  }
  fill([&](size_t i) HWY_ATTR { return DiskAt(light, hits, i); },
       [&](const DiskLightV<V>& disk) HWY_ATTR { return before(disk.centre); });
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
    const Vec3V<VD> offset =
        Sub(place, LoadU3(d, hits.position.x.data() + i, hits.position.y.data() + i,
                          hits.position.z.data() + i));
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
