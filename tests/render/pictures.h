// SPDX-License-Identifier: Apache-2.0
// tests/render/pictures.h: what tests of whole pictures share: a sphere under a light, and pictures
// held beside one another, to the bit or to their noise.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

#include "base/image.h"
#include "catch.h"
#include "scene/scene.h"

namespace nacre {

inline Light Named(const std::string& name, decltype(Light::kind) kind) {
  return {.name = name, .kind = std::move(kind)};
}

// A sphere that fills the middle of a square picture, of one material.
inline Scene OneSphere(decltype(Material::model) model, int side = 64, int spp = 16) {
  Scene scene;
  scene.materials.emplace_back().model = std::move(model);
  scene.spheres.push_back({Vec3d(0, 0, 0), 1, {0}});
  scene.camera.position = Vec3d(0, 0, 10);
  scene.camera.fov_y_deg = 14;
  scene.image.width = scene.image.height = side;
  scene.image.spp = spp;
  return scene;
}

// The same seen in parallel along -z, so that all its points are seen from (0, 0, 1).
inline Scene OrthographicSphere(decltype(Material::model) model, int spp) {
  Scene scene = OneSphere(std::move(model), 64, spp);
  scene.camera.projection = Projection::kOrthographic;
  scene.camera.height = 2.2;
  return scene;
}

// Calls use(i, normal) for each pixel i of a picture of OrthographicSphere that the sphere covers
// whole, with the normal at the pixel's centre, where n.v is `least` at least.
template <class Use>
void ForEachSphereNormal(const Image& image, double least, const Use& use) {
  const std::vector<float>& coverage = image.Find("A")->samples;
  for (size_t i = 0; i < coverage.size(); ++i) {
    if (coverage[i] < 1) continue;
    const double x = (static_cast<double>(i % 64) + 0.5 - 32) / 64 * 2.2;
    const double y = (32 - static_cast<double>(i / 64) - 0.5) / 64 * 2.2;
    const double z2 = 1 - x * x - y * y;
    if (z2 >= least * least) use(i, Vec3d(x, y, std::sqrt(z2)));
  }
}

// A sky of radiance 1 that is not seen itself, so that shapes stand out.
inline Light WhiteSky() {
  return Named("sky",
               EnvironmentLight{.sky = ConstantSky{Rgb(1)}, .rotate_deg = 0, .background = false});
}

inline bool SameBits(const std::vector<float>& a, const std::vector<float>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0;
}

inline bool SameBits(const Image& a, const Image& b) {
  if (a.channels.size() != b.channels.size()) return false;
  for (size_t i = 0; i < a.channels.size(); ++i) {
    if (!SameBits(a.channels[i].samples, b.channels[i].samples)) return false;
  }
  return true;
}

// Mean and standard error over pixels wholly on the object.
struct Mean {
  double value = 0, error = 0;
};

template <class Value>
Mean MeanOf(const Image& image, const Value& value) {
  const std::vector<float>& alpha = image.Find("A")->samples;
  double sum = 0, squares = 0, count = 0;
  for (size_t i = 0; i < alpha.size(); ++i) {
    if (alpha[i] < 1) continue;
    const double x = value(i);
    sum += x;
    squares += x * x;
    count += 1;
  }
  REQUIRE(count > 100);
  const double mean = sum / count;
  return {mean, std::sqrt(std::max(squares / count - mean * mean, 0.0) / count)};
}

inline Mean MeanRed(const Image& image) {
  const std::vector<float>& red = image.Find("R")->samples;
  return MeanOf(image, [&](size_t i) { return double{red[i]}; });
}

// Of the difference of two pictures, which is 0 but for their noise.
inline Mean MeanDifference(const Image& a, const Image& b) {
  const std::vector<float>& x = a.Find("R")->samples;
  const std::vector<float>& y = b.Find("R")->samples;
  return MeanOf(a, [&](size_t i) { return double{x[i]} - y[i]; });
}

// Pixels' errors are independent: 4 standard errors, plus what float sums leave.
inline void CheckSameMean(const Image& a, const Image& b) {
  const Mean difference = MeanDifference(a, b);
  const double mean = MeanRed(a).value;
  CAPTURE(difference.value, difference.error, mean);
  CHECK(std::abs(difference.value) <= 4 * difference.error + 1e-6 * mean);
  CHECK(difference.error <= 0.02 * mean);  // the check above could fail
}

}  // namespace nacre
