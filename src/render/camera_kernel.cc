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

void MakeCameraRaysT(const CameraFrame& frame, const FilmBatch& film, RayBatch* rays) {
  const hn::ScalableTag<double> d;
  const bool perspective = frame.projection == Projection::kPerspective;
  Soa3<double>& varying = perspective ? rays->direction : rays->origin;
  Soa3<double>& constant = perspective ? rays->origin : rays->direction;
  const auto fixed = SetVec3(d, perspective ? Vec3d(0, 0, 0) : frame.forward);
  const auto corner = SetVec3(d, frame.corner);
  const auto step_x = SetVec3(d, frame.step_x);
  const auto step_y = SetVec3(d, frame.step_y);
  const double* const film_x = film.x.data();
  const double* const film_y = film.y.data();
  rays->count = film.count;
  for (size_t i = 0; i < film.count; i += hn::Lanes(d)) {
    const auto x = hn::LoadU(d, film_x + i), y = hn::LoadU(d, film_y + i);
    const auto varying_value = MulAdd3(step_y, y, MulAdd3(step_x, x, corner));
    Store3(varying_value, d, varying.x.data() + i, varying.y.data() + i, varying.z.data() + i);
    Store3(fixed, d, constant.x.data() + i, constant.y.data() + i, constant.z.data() + i);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nacre {
HWY_EXPORT(MakeCameraRaysT);

void MakeCameraRays(const CameraFrame& frame, const FilmBatch& film, RayBatch* rays) {
  rays->view = MakeProjectedTestView(frame);
  HWY_DYNAMIC_DISPATCH(MakeCameraRaysT)(frame, film, rays);
}
}  // namespace nacre
#endif
