// SPDX-License-Identifier: Apache-2.0
// render/mapped_horizon.h: how surfaces with normal or bump maps reflect light near the horizon of
// the unmapped surface, whose normal is Surface::unturned.
//
// The hemisphere of a mapped normal extends below that surface, where no light comes from. The
// diffuse component loses the light from there. The specular lobe must not: the part of it that
// lies below the surface is taken to be reflected by the surface once more. So light from l above
// the horizon reflects f(l) + f(l'), where l' is l mirrored in the surface. The integral over all l
// is then that of the whole lobe: a white lobe reflects all light at every roughness, and a narrow
// one converges to the perfect mirror, which BendNormal (hit/shading_normal.h) keeps above the
// surface. Schüssler et al. 2017, "Microfacet-based Normal Mapping for Robust Monte Carlo Path
// Tracing", conserve energy in the same way, by a second reflection at an additional facet.
#pragma once

#include "render/direct_batch.h"

namespace nacre {

// Sets the irradiance of room.light to 0 at normal-mapped hits for which the light is below the
// horizon.
void HideLightsBelowHorizon(const DirectBatch& batch);

// Mirrors directions that were sampled by the run's lobe and lie below the horizon: l' becomes l.
void RaiseLobeSamples(const DirectBatch& batch, const MaterialRun& run, Soa3<float>* to_light);

// Adds the term f(l') for room.light, which holds `light`, to the sum and the specular component of
// `radiance`. Light that HideLightsBelowHorizon has hidden adds nothing.
void AddMirroredLobe(const DirectBatch& batch, const MaterialRun& run, const ShadingLight& light,
                     ReflectedRadiance* radiance);

// Adds the pdf of l' to that of l, because RaiseLobeSamples mirrors samples at l' to l.
void AddMirroredLobePdf(const DirectBatch& batch, const MaterialRun& run, float* pdf);

}  // namespace nacre
