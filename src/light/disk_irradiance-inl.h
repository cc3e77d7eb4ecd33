// SPDX-License-Identifier: Apache-2.0
// light/disk_irradiance-inl.h: the irradiance under disks on SIMD vectors. Scalar twin:
// disk_irradiance.h.
//
// Disks that cross the horizon are rare, and their formula needs double: those lanes are computed
// one by one with the scalar twin.
#if defined(NACRE_LIGHT_DISK_IRRADIANCE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_LIGHT_DISK_IRRADIANCE_INL_H_
#undef NACRE_LIGHT_DISK_IRRADIANCE_INL_H_
#else
#define NACRE_LIGHT_DISK_IRRADIANCE_INL_H_
#endif

#include <cmath>

#include "light/disk_irradiance.h"
#include "light/disk_light-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

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

// Recomputes the lanes of disks that the horizon clips.
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

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();
#endif
