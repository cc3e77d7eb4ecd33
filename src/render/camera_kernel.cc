// SPDX-License-Identifier: Apache-2.0
// render/camera_kernel.cc: the kernel of MakeCameraRays. The operations are those of
// visibility/camera_packet-inl.h, so that rays have the same bits wherever they are made.
#include "render/camera.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/camera_kernel.cc"
#include "hwy/foreach_target.h"

#include "base/vec3-inl.h"
#include "visibility/projected_sphere_test.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

void MakeCameraRaysT(const CameraFrame& frame, const double* film_x, const double* film_y,
                     size_t count, RayBatch* rays) {
  const hn::ScalableTag<double> d;
  const bool perspective = frame.projection == Projection::kPerspective;
  Soa3<double>& varying = perspective ? rays->direction : rays->origin;
  Soa3<double>& constant = perspective ? rays->origin : rays->direction;
  const auto fixed = SetVec3(d, perspective ? Vec3d(0, 0, 0) : frame.forward);
  const auto corner = SetVec3(d, frame.corner);
  const auto step_x = SetVec3(d, frame.step_x);
  const auto step_y = SetVec3(d, frame.step_y);
  rays->count = count;
  const auto make = [&](size_t i, auto x, auto y) HWY_ATTR {
    const auto varying_value = MulAdd3(step_y, y, MulAdd3(step_x, x, corner));
    Store3(varying_value, d, varying.x.data() + i, varying.y.data() + i, varying.z.data() + i);
    Store3(fixed, d, constant.x.data() + i, constant.y.data() + i, constant.z.data() + i);
  };
  const size_t step = hn::Lanes(d);
  size_t i = 0;
  for (; i + step <= count; i += step) make(i, hn::LoadU(d, film_x + i), hn::LoadU(d, film_y + i));
  if (i == count) return;
  HWY_ALIGN double x[hn::MaxLanes(d)] = {}, y[hn::MaxLanes(d)] = {};
  for (size_t k = 0; k < count - i; ++k) {
    x[k] = film_x[i + k];
    y[k] = film_y[i + k];
  }
  make(i, hn::Load(d, x), hn::Load(d, y));
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nacre {
HWY_EXPORT(MakeCameraRaysT);

void MakeCameraRays(const CameraFrame& frame, const double* film_x, const double* film_y,
                    size_t count, RayBatch* rays) {
  rays->view = MakeProjectedTestView(frame);
  HWY_DYNAMIC_DISPATCH(MakeCameraRaysT)(frame, film_x, film_y, count, rays);
}
}  // namespace nacre
#endif
