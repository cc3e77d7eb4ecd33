// SPDX-License-Identifier: Apache-2.0
// output/metadata.h: the metadata in the files of a render.
#pragma once

#include "image_io/exr_header.h"
#include "render/frame_plan.h"
#include "render/prepared_scene.h"
#include "render/stats.h"

namespace nacre {

// Names of header attributes that nacre writes.
inline constexpr char kRenderTimeAttribute[] = "renderTime";
inline constexpr char kTileAttribute[] = "nacre:tile";

// Makes a header with everything except channels. `tile`: the argument of --tile, or empty.
// `reproducible`: leaves out the render time, which otherwise is 0 until
// ExrWriter::UpdateAttribute. `prepared`: what the plan was made with, in which hashes of the
// scene's parts are kept; or null.
ExrHeader MakeExrHeader(const FramePlan& plan, bool reproducible, const std::string& tile = {},
                        PreparedScene* prepared = nullptr);

// The software that made the file: the attribute or text "Software".
std::string SoftwareName();

// The name of a type of samples in texts: half, float or uint.
const char* PixelTypeName(PixelType type);

// Adds the header's attributes to the image as text, as readers of the file return them.
void AddMetadata(const ExrHeader& header, Image* image);

// Lists the masking-shadowing forms among the materials' traits by name: "height_correlated" or
// "height_correlated, separable"; "none" if there is none.
std::string ShadowingForms(MaterialTraits traits);

}  // namespace nacre
