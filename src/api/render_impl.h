// SPDX-License-Identifier: Apache-2.0
// api/render_impl.h: what renders of scenes and of sessions share.
#pragma once

#include "api/border.h"
#include "render/render.h"

namespace nacre::v0 {

// AtBorder of what may be cancelled, which comes out as the public exception.
template <class Body>
auto Cancellable(const Body& body) -> decltype(body()) {
  return AtBorder([&] {
    try {
      return body();
    } catch (const nacre::Cancelled&) {
      throw Cancelled();
    }
  });
}

// Throws nacre::Error for settings that are out of range.
nacre::RenderSettings ToOwn(const RenderSettings& settings);

// With the size, samples and seed that the settings have.
nacre::ImageSettings Adjusted(nacre::ImageSettings image, const RenderSettings& settings);

// The picture of a plan for the caller, with its metadata; `prepared`, as MakeExrHeader's, and
// `stats` may be null.
Image Finish(const FramePlan& plan, PreparedScene* prepared, nacre::Image rendered,
             const nacre::RenderStats& counted, double plan_seconds, RenderStats* stats);

}  // namespace nacre::v0
