// SPDX-License-Identifier: Apache-2.0
// image_io/exr_types.h: converts OpenEXR's windows, pixel types and errors to nacre's.
#pragma once

#include <exception>
#include <new>
#include <string>

#include <Imath/ImathBox.h>
#include <OpenEXR/ImfPixelType.h>

#include "base/error.h"
#include "base/image.h"

namespace nacre {

// The last pixel of an EXR window is inclusive.
inline Window ToWindow(const Imath::Box2i& box) {
  return {box.min.x, box.min.y, box.max.x + 1, box.max.y + 1};
}

inline PixelType ToPixelType(Imf::PixelType type) {
  if (type == Imf::HALF) return PixelType::kHalf;
  return type == Imf::UINT ? PixelType::kUint : PixelType::kFloat;
}

inline Imf::PixelType ToImfType(PixelType type) {
  if (type == PixelType::kHalf) return Imf::HALF;
  return type == PixelType::kUint ? Imf::UINT : Imf::FLOAT;
}

// Calls body(), and turns the exceptions by which OpenEXR reports what is wrong with the file into
// Error (kBadInput), with the hint.
template <class Body>
auto WithOpenExr(const std::string& path, const std::string& hint, const Body& body) {
  try {
    return body();
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw Error(ExitCode::kBadInput, path, "there is no memory for it", hint);
  } catch (const std::exception& error) {
    throw Error(ExitCode::kBadInput, path, std::string("cannot be read as EXR: ") + error.what(),
                hint);
  }
}

}  // namespace nacre
