// SPDX-License-Identifier: Apache-2.0
// light/irradiance.h: the irradiance of a surface under an unoccluded area light of uniform
// radiance, in closed form, clipped at the surface's horizon. SIMD twin: irradiance-inl.h.
//
//   Real Irradiance(light, normal)    per unit of radiance; pi under an all-round light
//
// `light` is relative to the shaded point (light/area_sample.h), `normal` is unit length. Flat
// lights count both faces, a sphere counts for points inside it too: which faces emit is the
// caller's to ask. In a flat light's own plane the irradiance is 0.
//
// In float the error is some roundings of the result, of what roundings of the inputs do to it
// (heights over the horizon, for lights that only just rise), and for polygons of the result times
// their length over their width.
#pragma once

#include "light/disk_irradiance.h"
#include "light/polygon_irradiance.h"
#include "light/sphere_irradiance.h"
