// SPDX-License-Identifier: Apache-2.0
// light/irradiance-inl.h: the irradiance of area lights on SIMD vectors. Scalar twin: irradiance.h.
#if defined(NACRE_LIGHT_IRRADIANCE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_LIGHT_IRRADIANCE_INL_H_
#undef NACRE_LIGHT_IRRADIANCE_INL_H_
#else
#define NACRE_LIGHT_IRRADIANCE_INL_H_
#endif

#include "light/disk_irradiance-inl.h"
#include "light/polygon_irradiance-inl.h"
#include "light/sphere_irradiance-inl.h"

#endif
