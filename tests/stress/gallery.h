// SPDX-License-Identifier: Apache-2.0
// tests/stress/gallery.h: the scenes of scenes/stability, each of which shows where renderers are
// known to fail, and what a picture of them is held to against the truth.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "base/image.h"
#include "stress/truth.h"

namespace nacre {

struct GalleryScene {
  const char* name;   // of the file scenes/stability/NAME.json
  const char* shows;  // what goes wrong there elsewhere, in a few words
};

std::span<const GalleryScene> GalleryScenes();

// The scene, plain forms of its materials, one sample a pixel; scaled down to `width` pixels
// unless that is 0.
Scene LoadGalleryScene(const std::string& name, int width = 0);

// The bound on the error of a material's radiance, relative to TruthPixel::scale.
double RadianceBound(const Material& material);

// Angle between a normal and its true value, rad.
inline constexpr double kNormalBound = 2e-7;

struct Comparison {
  size_t pixels = 0, doubtful = 0;
  // The rest is about pixels that are not doubtful.
  size_t false_hits = 0, false_misses = 0, wrong_objects = 0;
  size_t not_finite = 0;                     // or negative
  double normal_error = 0, depth_error = 0;  // largest; depths relative
  double radiance_error = 0;                 // largest
  double radiance_error_most = 0;            // of 99.99 % of the pixels
  double of_bound = 0;                       // largest radiance error over its bound
  std::string worst_material;                // where that is
  std::vector<float> error;                  // radiance error of each pixel

  bool GeometryHolds() const {
    return false_hits + false_misses + wrong_objects + not_finite == 0 &&
           normal_error <= kNormalBound;
  }
  bool RadianceHolds() const { return of_bound <= 1; }
};

// `image` has the layers N, Z and id.object.
Comparison Compare(const Scene& scene, const Image& image, const TruthPicture& truth);

}  // namespace nacre
