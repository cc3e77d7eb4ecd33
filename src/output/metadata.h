// SPDX-License-Identifier: Apache-2.0
// output/metadata.h: what the files of a render say about it.
#pragma once

#include "image_io/exr_header.h"
#include "render/frame_plan.h"
#include "render/prepared_scene.h"
#include "render/stats.h"

namespace nacre {

// Names of header attributes that nacre writes.
inline constexpr char kRenderTimeAttribute[] = "renderTime";
inline constexpr char kTileAttribute[] = "nacre:tile";

// Everything but the channels. `tile`: as --tile has it, or empty. `reproducible`: without the
// render time, which is 0 until ExrWriter::UpdateAttribute. `prepared`: what the plan was made
// with, which keeps what the scene's hash is made of; or null.
ExrHeader MakeExrHeader(const FramePlan& plan, bool reproducible, const std::string& tile = {},
                        PreparedScene* prepared = nullptr);

// What made the file: the attribute or text "Software".
std::string SoftwareName();

// The header's attributes as text, as readers of its file return them.
void AddMetadata(const ExrHeader& header, Image* image);

// The masking-shadowing forms among the traits of materials by name, "height_correlated" or
// "height_correlated, separable"; "none" if there is none.
std::string ShadowingForms(MaterialTraits traits);

}  // namespace nacre
