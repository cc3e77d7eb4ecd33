// SPDX-License-Identifier: Apache-2.0
// tests/light/ellipse_kernel.cc: the loop behind ellipse_kernel.h.
#include "light/ellipse_kernel.h"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "light/ellipse_kernel.cc"
#include "hwy/foreach_target.h"

#include "hwy/highway.h"

#include "light/ellipse_irradiance-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {

void AskEllipsesT(const std::vector<EllipseQuery>& queries, std::vector<double>* answers) {
  const hn::ScalableTag<double> d;
  constexpr size_t kMost = 64 / sizeof(double);
  for (size_t first = 0; first < queries.size(); first += hn::Lanes(d)) {
    alignas(64) double lanes[4][3][kMost];
    alignas(64) double results[kMost];
    for (size_t i = 0; i < hn::Lanes(d); ++i) {
      const EllipseQuery& q = queries[std::min(first + i, queries.size() - 1)];
      const Vec3d* const vectors[] = {&q.light.centre, &q.light.x, &q.light.y, &q.normal};
      for (size_t k = 0; k < 4; ++k) {
        lanes[k][0][i] = vectors[k]->x;
        lanes[k][1][i] = vectors[k]->y;
        lanes[k][2][i] = vectors[k]->z;
      }
    }
    const auto at = [&](size_t k)
                        HWY_ATTR { return Load3(d, lanes[k][0], lanes[k][1], lanes[k][2]); };
    const EllipseLightV<hn::Vec<hn::ScalableTag<double>>> light{at(0), at(1), at(2)};
    hn::Store(Irradiance(d, light, at(3)), d, results);
    for (size_t i = 0; i < hn::Lanes(d) && first + i < queries.size(); ++i) {
      (*answers)[first + i] = results[i];
    }
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nacre {
HWY_EXPORT(AskEllipsesT);

std::vector<double> AskEllipses(const std::vector<EllipseQuery>& queries) {
  std::vector<double> answers(queries.size());
  HWY_DYNAMIC_DISPATCH(AskEllipsesT)(queries, &answers);
  return answers;
}
}  // namespace nacre
#endif
