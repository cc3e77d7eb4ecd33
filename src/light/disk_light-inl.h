// SPDX-License-Identifier: Apache-2.0
// light/disk_light-inl.h: disks as lights on SIMD vectors. Scalar twin: disk_light.h.
#if defined(NACRE_LIGHT_DISK_LIGHT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_LIGHT_DISK_LIGHT_INL_H_
#undef NACRE_LIGHT_DISK_LIGHT_INL_H_
#else
#define NACRE_LIGHT_DISK_LIGHT_INL_H_
#endif

#include <cmath>

#include "base/basis-inl.h"
#include "light/disk_light.h"
#include "light/rectangle_light-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <class V>
struct DiskLightV {
  Vec3V<V> centre, normal;
  V radius;
};

template <class V>
HWY_INLINE V LargestLength(const DiskLightV<V>& light) {
  return hn::Max(LargestComponent(light.centre), light.radius);
}
template <class V>
HWY_INLINE DiskLightV<V> Scaled(const DiskLightV<V>& light, V factor) {
  return {Scale(light.centre, factor), light.normal, hn::Mul(light.radius, factor)};
}

template <class V>
struct DiskViewV {
  Vec3V<V> x_axis, y_axis;
  V rho, z;
};

template <class D, class V = hn::Vec<D>>
HWY_INLINE DiskViewV<V> ViewOf(D d, const DiskLightV<V>& light) {
  const BasisV<V> basis = BasisAbout(d, light.normal);
  const Vec3V<V> centre = ToLocal(basis, light.centre);
  const V rho = Hypot(centre.x, centre.y);
  const V inverse = InverseIfPositive(d, rho);
  const auto beside = hn::Gt(rho, hn::Zero(d));
  const V cos = hn::IfThenElse(beside, hn::Mul(centre.x, inverse), hn::Set(d, 1.0f));
  const V sin = hn::Mul(centre.y, inverse);
  return {AddScaled(Scale(basis.x, cos), basis.y, sin),
          AddScaled(Scale(basis.y, cos), basis.x, hn::Neg(sin)), rho, centre.z};
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE auto IsNearby(D d, const DiskViewV<V>& view, V radius) {
  const V beside = hn::Max(hn::Sub(view.rho, radius), hn::Zero(d));
  const V nearest2 = hn::MulAdd(beside, beside, hn::Mul(view.z, view.z));
  return hn::Lt(nearest2, hn::Mul(hn::Set(d, 0.49f), hn::Mul(radius, radius)));
}

template <class V>
HWY_INLINE RectangleLightV<V> SquareAround(const DiskLightV<V>& light, const DiskViewV<V>& view) {
  const Vec3V<V> x = Scale(view.x_axis, light.radius), y = Scale(view.y_axis, light.radius);
  return {Sub(Sub(light.centre, x), y), Add(x, x), Add(y, y)};
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE AreaSampleV<V> SampleDiskByArea(D d, const DiskLightV<V>& light,
                                           const DiskViewV<V>& view, V u0, V u1) {
  const PointOnDisk<V> on_disk = ConcentricDisk(d, u0, u1);
  const Vec3V<V> point =
      AddScaled(AddScaled(light.centre, view.x_axis, hn::Mul(on_disk.x, light.radius)), view.y_axis,
                hn::Mul(on_disk.y, light.radius));
  const V distance = Length(point);
  const V inverse = InverseIfPositive(d, distance);
  const V cos_light = hn::Neg(hn::Mul(view.z, inverse));
  const V area = hn::Mul(hn::Set(d, kTwoPi / 2), hn::Mul(light.radius, light.radius));
  return {Scale(point, inverse), distance,
          hn::Mul(hn::Mul(area, hn::Abs(cos_light)), hn::Mul(inverse, inverse)), cos_light};
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE AreaSampleV<V> SampleLight(D d, const DiskLightV<V>& given, V u0, V u1) {
  const V zero = hn::Zero(d);
  const auto scaled = ScaleToUnit(d, given);
  const DiskLightV<V>& light = scaled.light;
  const DiskViewV<V> view = ViewOf(d, light);
  AreaSampleV<V> square = SampleScaled(d, SquareAround(light, view), u0, u1);
  const Vec3V<V> from_centre = Sub(Scale(square.to_light, square.distance), light.centre);
  const auto hit = hn::Ge(hn::Mul(light.radius, light.radius), FusedDot(from_centre, from_centre));
  square.inverse_pdf = hn::IfThenElseZero(hit, square.inverse_pdf);
  AreaSampleV<V> sample =
      Select(IsNearby(d, view, light.radius), square, SampleDiskByArea(d, light, view, u0, u1));
  sample.distance = hn::Mul(sample.distance, scaled.unit);
  return SampleIf(d, hn::And(hn::Gt(hn::Abs(view.z), zero), hn::Gt(light.radius, zero)), sample);
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE V LightPdf(D d, const DiskLightV<V>& given, const Vec3V<V>& direction) {
  const V zero = hn::Zero(d);
  const DiskLightV<V> light = ScaleToUnit(d, given).light;
  const V one = hn::Set(d, 1.0f);
  const DiskViewV<V> view = ViewOf(d, light);
  const V towards = FusedDot(direction, light.normal);
  const auto ahead = hn::Gt(hn::Mul(view.z, towards), zero);
  const V t = hn::Div(view.z, hn::IfThenElse(ahead, towards, one));
  const V radius2 = hn::Mul(light.radius, light.radius);
  const Vec3V<V> from_centre = Sub(Scale(direction, t), light.centre);
  const auto hit = hn::And(ahead, hn::Ge(radius2, FusedDot(from_centre, from_centre)));
  const V area = hn::Mul(hn::Mul(hn::Set(d, kTwoPi / 2), radius2), hn::Abs(towards));
  const V by_area = hn::Mul(hn::Mul(t, t), InverseIfPositive(d, area));
  const V by_square = PdfScaled(d, SquareAround(light, view), direction);
  return hn::IfThenElseZero(hit,
                            hn::IfThenElse(IsNearby(d, view, light.radius), by_square, by_area));
}

template <class V>
struct DiskHorizonTermsV {
  Vec3V<V> n;
  V rho, z, radius, centre_height, rim_height;
};

template <class D, class V = hn::Vec<D>>
HWY_INLINE DiskHorizonTermsV<V> MakeDiskHorizonTerms(D d, const DiskLightV<V>& light,
                                                     const Vec3V<V>& normal) {
  const DiskViewV<V> view = ViewOf(d, light);
  const Vec3V<V> n{FusedDot(normal, view.x_axis), FusedDot(normal, view.y_axis),
                   FusedDot(normal, light.normal)};
  return {n,
          view.rho,
          view.z,
          light.radius,
          FusedDot(normal, light.centre),
          hn::Mul(light.radius, Hypot(n.x, n.y))};
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE V IrradianceOfWholeDisk(D d, const DiskHorizonTermsV<V>& disk) {
  const V zero = hn::Zero(d);
  const V one = hn::Set(d, 1.0f);
  const V radius2 = hn::Mul(disk.radius, disk.radius), z2 = hn::Mul(disk.z, disk.z);
  const V a = hn::Add(z2, hn::MulAdd(disk.rho, disk.rho, radius2));
  const V w = hn::MulAdd(hn::Sub(disk.radius, disk.rho), hn::Add(disk.radius, disk.rho), z2);
  const V cross = hn::Mul(hn::Add(disk.z, disk.z), disk.rho);
  const V q = Hypot(w, cross);
  const auto beside = hn::Gt(zero, w);
  const V apart = hn::IfThenElse(beside, hn::Sub(q, w), one);
  const V w_plus_q = hn::IfThenElse(beside, hn::Div(hn::Mul(cross, cross), apart), hn::Add(w, q));
  const V numerator = hn::Abs(hn::MulAdd(disk.n.z, w_plus_q, hn::Mul(cross, disk.n.x)));
  const V pi_radius2 = hn::Mul(hn::Set(d, kTwoPi / 2), radius2);
  return hn::Mul(hn::Mul(pi_radius2, numerator), InverseIfPositive(d, hn::Mul(q, hn::Add(a, q))));
}

// Recomputes the lanes of disks that the horizon clips, one by one with the scalar twin: they are
// rare, and their formula needs double.
template <class D, class V>
HWY_NOINLINE void FillClippedDisks(D d, const DiskHorizonTermsV<V>& disk, V* irradiance) {
  constexpr size_t kMaxLanes = 2 * 64 / sizeof(float);
  const V columns[] = {disk.n.x, disk.n.y,    disk.n.z,           disk.rho,
                       disk.z,   disk.radius, disk.centre_height, disk.rim_height};
  alignas(64) float lanes[std::size(columns)][kMaxLanes];
  alignas(64) float results[kMaxLanes];
  for (size_t c = 0; c < std::size(columns); ++c) hn::Store(columns[c], d, lanes[c]);
  hn::Store(*irradiance, d, results);
  for (size_t i = 0; i < hn::Lanes(d); ++i) {
    const DiskHorizonTerms<double> lane{{lanes[0][i], lanes[1][i], lanes[2][i]},
                                        lanes[3][i],
                                        lanes[4][i],
                                        lanes[5][i],
                                        lanes[6][i],
                                        lanes[7][i]};
    if (lane.z == 0 || !(std::abs(lane.centre_height) < lane.rim_height)) continue;
    results[i] = static_cast<float>(IrradianceOfClippedDisk(lane));
  }
  *irradiance = hn::Load(d, results);
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE V Irradiance(D d, const DiskLightV<V>& given, const Vec3V<V>& normal) {
  const V zero = hn::Zero(d);
  const DiskLightV<V> light = ScaleToUnit(d, given).light;
  const DiskHorizonTermsV<V> disk = MakeDiskHorizonTerms(d, light, normal);
  const auto above = hn::Ge(disk.centre_height, disk.rim_height);
  V irradiance = hn::IfThenElseZero(above, IrradianceOfWholeDisk(d, disk));
  const auto clipped = hn::Lt(hn::Abs(disk.centre_height), disk.rim_height);
  if (!hn::AllFalse(d, clipped)) FillClippedDisks(d, disk, &irradiance);
  const auto visible = hn::And(hn::Gt(hn::Abs(disk.z), zero), hn::Gt(light.radius, zero));
  return hn::IfThenElseZero(visible, irradiance);
}

}  // namespace nacre::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
