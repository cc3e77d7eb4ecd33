// SPDX-License-Identifier: Apache-2.0
// render/mapped_horizon.h: what normal and bump maps make of light near the horizon of the surface
// that lies under them, whose normal is Surface::unturned.
//
// The hemisphere of a normal-mapped normal reaches below that surface, where no light comes from.
// The diffuse part loses what it would reflect of it. The specular lobe does not: the half of it
// that the surface cuts off is reflected by the surface, so light from l above the horizon leaves
// f(l) + f(l'), l' being l mirrored in the surface. Over all l that is the whole lobe, so a white
// one reflects all light at every roughness, and a narrow one becomes the perfect mirror, which
// BendNormal (hit/shading_normal.h) keeps above the surface. Schüssler et al. 2017,
// "Microfacet-based Normal Mapping for Robust Monte Carlo Path Tracing", close the energy balance
// in the same way, by a second reflection, at facets of their own.
#pragma once

#include "render/direct_batch.h"

namespace nacre {

// Takes room.light from the hits that it reaches from below the horizon.
void HideLightsBelowHorizon(const DirectBatch& batch);

// Brings directions that were sampled by the run's lobe above the horizon: l' in the place of l.
void RaiseLobeSamples(const DirectBatch& batch, const MaterialRun& run, Soa3<float>* to_light);

// Adds f(l') of room.light, which is `light`, to the specular part of `radiance`, or to its sum, or
// both, as `output` says. Hidden light is not above the horizon: it counts as none.
void AddMirroredLobe(const DirectBatch& batch, const MaterialRun& run, const ShadingLight& light,
                     OutputMode output, ReflectedRadiance* radiance);

// Adds the pdf of l', which RaiseLobeSamples brings to l, to that of l.
void AddMirroredLobePdf(const DirectBatch& batch, const MaterialRun& run, float* pdf);

}  // namespace nacre
