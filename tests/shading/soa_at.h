// SPDX-License-Identifier: Apache-2.0
// tests/shading/soa_at.h: hits' numbers as vectors.
#pragma once

#include "base/vec.h"
#include "shading/shade.h"

namespace nacre {

template <class Real>
void SetAt(size_t i, const Vec3d& from, Soa3<Real>* to) {
  to->x[i] = static_cast<Real>(from.x);
  to->y[i] = static_cast<Real>(from.y);
  to->z[i] = static_cast<Real>(from.z);
}

inline Rgb ColorAt(const Soa3<float>& soa, size_t i) { return {soa.x[i], soa.y[i], soa.z[i]}; }

}  // namespace nacre
