// SPDX-License-Identifier: Apache-2.0
// api/border.h: the border between the public header and the library's own types, with conversions.
// Inside namespace v0, names are the public ones; the library's own are written nacre::Scene.
#pragma once

#include <new>
#include <string>

#define NACRE_OWN_SOURCE
#include "base/error.h"
#include "base/float_mode.h"
#include "base/image.h"
#include "base/vec.h"
#include "nacre.h"

namespace nacre::v0 {

Error ToPublic(const nacre::Error& error);

// Calls body() in the default floating-point modes, so that the caller's modes do not affect
// results. Errors of the library and a lack of memory are thrown as v0::Error, other exceptions
// (those of the caller's own functions) unchanged.
template <class Body>
auto AtBorder(const Body& body) -> decltype(body()) {
  const DefaultFloatMode mode;
  try {
    return body();
  } catch (const nacre::Error& error) {
    throw ToPublic(error);
  } catch (const std::bad_alloc&) {
    throw ToPublic(nacre::Error(ExitCode::kInternal, "", "out of memory",
                                "a smaller picture or scene needs less"));
  }
}

inline nacre::Window ToOwn(const Window& window) {
  return {window.x0, window.y0, window.x1, window.y1};
}
inline Window ToPublic(const nacre::Window& window) {
  return {window.x0, window.y0, window.x1, window.y1};
}
inline Vec3d ToOwn(const Vec3& v) { return {v[0], v[1], v[2]}; }
inline Vec3 ToPublic(const Vec3d& v) { return {v.x, v.y, v.z}; }
inline Rgb ToPublic(const nacre::Rgb& c) { return {c.x, c.y, c.z}; }

Image ToPublic(nacre::Image&& image);
// Copies an image. Throws Error unless each channel has one sample for each pixel.
nacre::Image ToOwn(const Image& image);

// The channel with this name. Throws Error if there is none; `what` says who needs it.
const Channel& RequireChannel(const Image& image, const std::string& name, const std::string& what);

// Throws Error (kUsage) unless the image has pixels, and each channel one sample for each pixel.
void CheckImage(const Image& image);

}  // namespace nacre::v0
