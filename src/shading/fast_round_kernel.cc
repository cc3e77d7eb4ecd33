// SPDX-License-Identifier: Apache-2.0
// shading/fast_round_kernel.cc: the part of lobes that area lights fill, by linearly transformed
// cosines: of disks, and of spheres, which from any point are the disk that they look like. In
// double: the ellipse that a matrix makes of them is a matter of eigenvalues. Scalar twin:
// SeenLight::Share of seen_light.h.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shading/fast_round_kernel.cc"
#include "hwy/foreach_target.h"

#include "hwy/highway.h"

#include "base/basis-inl.h"
#include "base/geometry-inl.h"
#include "light/ellipse_irradiance-inl.h"
#include "light/ltc-inl.h"
#include "shading/fast_area_kernels.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;

using DD = hn::ScalableTag<double>;
using VD = hn::Vec<DD>;
using Floats = hn::Rebind<float, DD>;

HWY_INLINE Vec3V<VD> PromoteSoa(const Soa3<float>& soa, size_t i) {
  const auto promote = [i](const AlignedArray<float>& from) HWY_ATTR {
    return hn::PromoteTo(DD(), hn::LoadU(Floats(), from.data() + i));
  };
  return {promote(soa.x), promote(soa.y), promote(soa.z)};
}

// From hits i... to the light's centre.
HWY_INLINE Vec3V<VD> CentreFrom(const SampledLight& light, const Soa3<double>& from, size_t i) {
  const DD d;
  return Sub(SetVec3(DD(), light.place),
             LoadU3(d, from.x.data() + i, from.y.data() + i, from.z.data() + i));
}

// What hits see of a light; nothing where its front is not towards them.
struct SeenEllipse {
  EllipseLightV<VD> ellipse;
  hn::Mask<DD> shines;
};

HWY_INLINE SeenEllipse DiskFrom(const SampledLight& light, const Vec3V<VD>& centre) {
  const DD d;
  const EllipseLight ellipse = EllipseOf(DiskLight<double>{Vec3d(0), light.normal, light.radius});
  const VD towards = FusedDot(centre, SetVec3(DD(), light.normal));
  const auto front = hn::Lt(towards, hn::Zero(d));
  return {{centre, SetVec3(DD(), ellipse.x), SetVec3(DD(), ellipse.y)},
          light.two_sided ? hn::Ne(towards, hn::Zero(d)) : front};
}

HWY_INLINE SeenEllipse SphereFrom(const SampledLight& light, const Vec3V<VD>& centre) {
  const DD d;
  const VD one = hn::Set(d, 1.0), radius = hn::Set(d, light.radius);
  const VD distance = Length(centre);
  const auto outside = hn::Gt(distance, radius);
  const VD inverse = hn::Div(one, hn::IfThenElse(outside, distance, one));
  const VD sin = hn::IfThenElseZero(outside, hn::Mul(radius, inverse));
  const VD cos2 = hn::Mul(hn::Sub(one, sin), hn::Add(one, sin));
  const VD rim = hn::Mul(radius, hn::Sqrt(cos2));
  const BasisV<VD> basis = BasisAbout(d, Scale(centre, inverse));
  return {{Scale(centre, cos2), Scale(basis.x, rim), Scale(basis.y, rim)}, outside};
}

HWY_INLINE VD Share(const SeenEllipse& seen, const LobeFrameV<VD>& frame, const MatrixV<VD>& m) {
  const DD d;
  const VD zero = hn::Zero(d);
  const auto map = [&](const Vec3V<VD>& v) HWY_ATTR { return m.Map(frame.ToLocal(v)); };
  const EllipseLightV<VD>& e = seen.ellipse;
  const VD irradiance = Irradiance(d, EllipseLightV<VD>{map(e.centre), map(e.x), map(e.y)},
                                   Vec3V<VD>{zero, zero, hn::Set(d, 1.0)});
  return hn::IfThenElseZero(seen.shines, hn::Mul(irradiance, hn::Set(d, 1 / M_PI)));
}

void RoundSharesT(const LtcRows& rows, const SampledLight& light, const LobeRange& range,
                  LobeShares* shares) {
  const DD d;
  for (size_t i = range.begin; i < range.end; i += hn::Lanes(d)) {
    const Vec3V<VD> centre = CentreFrom(light, range.hits.position, i);
    const SeenEllipse seen =
        light.form == SampledForm::kDisk ? DiskFrom(light, centre) : SphereFrom(light, centre);
    if (hn::AllFalse(d, seen.shines)) {
      std::fill_n(shares->one.data() + i, std::min(hn::Lanes(d), range.end - i), 0.0f);
      std::fill_n(shares->schlick.data() + i, std::min(hn::Lanes(d), range.end - i), 0.0f);
      continue;
    }
    const LobeFrameV<VD> frame =
        FrameAt(d, rows, PromoteSoa(range.surface.normal, i), PromoteSoa(range.surface.to_view, i));
    const auto mask = hn::FirstN(Floats(), range.end - i);
    const auto store = [&](VD share, AlignedArray<float>* to) HWY_ATTR {
      hn::BlendedStore(hn::DemoteTo(Floats(), share), mask, Floats(), to->data() + i);
    };
    store(Share(seen, frame, frame.one), &shares->one);
    store(Share(seen, frame, frame.schlick), &shares->schlick);
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nacre {
HWY_EXPORT(RoundSharesT);

void RoundShares(const LtcRows& rows, const SampledLight& light, const LobeRange& range,
                 LobeShares* shares) {
  HWY_DYNAMIC_DISPATCH(RoundSharesT)(rows, light, range, shares);
}

}  // namespace nacre
#endif
