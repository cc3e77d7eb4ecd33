// SPDX-License-Identifier: Apache-2.0
// light/irradiance.h: the irradiance of a surface under an unoccluded area light of uniform
// radiance, in closed form, clipped at the surface's horizon. SIMD twin: irradiance-inl.h.
//
//   Real Irradiance(light, normal)    per unit of radiance; pi where light comes from everywhere
//
// `light` is relative to the shaded point (light/area_sample.h), `normal` is unit length. Both
// faces of a flat light and both sides of a sphere count as emitting; the caller checks which ones
// do. In a flat light's own plane the irradiance is 0.
//
// In float the error is a few roundings of the result, plus the effect of rounding the inputs (of
// heights over the horizon, for lights that barely rise above it), and for polygons a few roundings
// of the result times length over width.
#pragma once

#include "light/disk_irradiance.h"
#include "light/polygon_irradiance.h"
#include "light/sphere_irradiance.h"
