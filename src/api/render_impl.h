// SPDX-License-Identifier: Apache-2.0
// api/render_impl.h: what rendering of scenes and of sessions has in common.
#pragma once

#include "api/border.h"
#include "render/render.h"

namespace nacre::v0 {

// AtBorder for work that may be cancelled, which then throws the public Cancelled.
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

// `image` with the size, samples and seed that the settings specify.
nacre::ImageSettings Adjusted(nacre::ImageSettings image, const RenderSettings& settings);

// Completes a rendered picture for the caller, with its metadata. `prepared` is as for
// MakeExrHeader; `stats` may be null.
Image Finish(const FramePlan& plan, PreparedScene* prepared, nacre::Image rendered,
             const nacre::RenderStats& counted, double plan_seconds, RenderStats* stats);

}  // namespace nacre::v0
