// SPDX-License-Identifier: Apache-2.0
#include "stress/gallery.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "brdf/ggx.h"
#include "scene_io/load_scene.h"
#include "stress/truth_reflect.h"

namespace nacre {
namespace {

constexpr GalleryScene kScenes[] = {
    {"far_spheres", "equal spheres 1e2 to 1e6 radii away: rings, then holes"},
    {"telescope", "spheres at 1e6 radii in a view of 1e-4 degrees"},
    {"dark_limb", "a full moon at 8e5 radii: a dark limb"},
    {"tiny_spheres", "radii 1e-6 to 1e-3 near the eye: speckles of self-shadow"},
    {"thin_shells", "shells 4e-5 and 1e-5 apart: the inner one shines through"},
    {"large_coordinates", "everything 1e6 from the origin: noise"},
    {"planet", "ground of radius 1e6 under the eye: a wrong horizon, acne"},
    {"low_sun", "light half a degree above the ground: acne at the terminator"},
    {"inside", "the eye inside a sphere"},
    {"on_surface", "the eye exactly on a sphere"},
    {"between_shells", "eye and light between concentric spheres"},
    {"coincident", "equal spheres: the first one must win everywhere"},
    {"touching", "spheres that touch in a point: leaks and acne there"},
    {"all_sizes", "radii 1e-6 to 1e7 in one picture"},
    {"close_light", "a light 1e-3 radii above a surface"},
    {"smooth_ggx", "GGX of roughness 0.05, 0.02 and 0.01: black or infinite"},
    {"smooth_phong", "exponents of 1e4 and 1e6: noise in the highlight"},
};

Rgb SampleColor(const Image& image, size_t i) {
  return {image.Find("R")->samples[i], image.Find("G")->samples[i], image.Find("B")->samples[i]};
}

bool IsSound(const Rgb& c) {
  return std::isfinite(c.x) && std::isfinite(c.y) && std::isfinite(c.z) && c.x >= 0 && c.y >= 0 &&
         c.z >= 0;
}

// The largest error of the channels.
double RadianceError(const Rgb& got, const TruthPixel& truth) {
  double error = 0;
  for (int c = 0; c < 3; ++c) {
    const double difference = std::abs(got[c] - truth.radiance[c]);
    // Below the smallest normal float there is nothing to be right about.
    error = std::max(error, difference / std::max(truth.scale[c], 1.2e-38));
  }
  return error;
}

void CompareSurface(const Image& image, const TruthPixel& truth, size_t i, Comparison* result) {
  const Vec3d normal(image.Find("N.X")->samples[i], image.Find("N.Y")->samples[i],
                     image.Find("N.Z")->samples[i]);
  const double depth = image.Find("Z")->samples[i];
  result->normal_error = std::max(result->normal_error, (normal - truth.normal).length());
  result->depth_error =
      std::max(result->depth_error, std::abs(depth - truth.depth) / std::abs(truth.depth));
}

double Most(std::vector<float> errors, double share) {
  if (errors.empty()) return 0;
  const auto rank = static_cast<size_t>(share * static_cast<double>(errors.size() - 1));
  std::nth_element(errors.begin(), errors.begin() + static_cast<std::ptrdiff_t>(rank),
                   errors.end());
  return errors[rank];
}

}  // namespace

std::span<const GalleryScene> GalleryScenes() { return kScenes; }

Scene LoadGalleryScene(const std::string& name, int width) {
  const std::filesystem::path folder(NACRE_SOURCE_DIR "/scenes/stability");
  Scene scene = LoadScene(folder / (name + ".json"));
  if (width > 0) {
    scene.image.height = scene.image.height * width / scene.image.width;
    scene.image.width = width;
  }
  scene.image.spp = 1;
  UsePlainForms(&scene);
  return scene;
}

double RadianceBound(const Material& material) {
  constexpr double kUsual = 1e-5;
  if (const auto* phong = std::get_if<PhongMaterial>(&material.model)) {
    // 2e-5 at 1e4 and 1e-3 at 1e6, a power in between.
    return std::max(kUsual, 2e-5 * std::pow(phong->shininess / 1e4, 0.85));
  }
  if (const auto* ggx = std::get_if<MetallicRoughnessMaterial>(&material.model)) {
    if (ggx->roughness < 0.1) return 2e-6;  // half-vector terms in double
    // The float form errs by some 1e-7 / alpha: 2e-4 at roughness 0.05.
    return std::max(kUsual, 5e-7 / AlphaFromRoughness(ggx->roughness));
  }
  return kUsual;
}

Comparison Compare(const Scene& scene, const Image& image, const TruthPicture& truth) {
  Comparison result;
  result.pixels = truth.pixels.size();
  result.error.assign(result.pixels, 0);
  std::vector<float> certain;
  certain.reserve(result.pixels);
  const std::vector<float>& objects = image.Find("id.object")->samples;
  for (size_t i = 0; i < result.pixels; ++i) {
    const TruthPixel& pixel = truth.pixels[i];
    const Rgb color = SampleColor(image, i);
    if (!IsSound(color)) ++result.not_finite;
    const double error = RadianceError(color, pixel);
    result.error[i] = static_cast<float>(error);
    if (pixel.doubt != kCertain) {
      ++result.doubtful;
      continue;
    }
    const auto object = static_cast<uint32_t>(objects[i]);
    if (object != pixel.object) {
      ++(pixel.object == 0 ? result.false_hits
         : object == 0     ? result.false_misses
                           : result.wrong_objects);
      continue;
    }
    certain.push_back(static_cast<float>(error));
    if (object == 0) continue;
    CompareSurface(image, pixel, i, &result);
    const Material& material = scene.materials[pixel.material];
    const double of_bound = error / RadianceBound(material);
    if (!(of_bound <= result.of_bound)) {
      result.of_bound = of_bound;
      result.worst_material = material.name;
    }
    if (!(error <= result.radiance_error)) result.radiance_error = error;
  }
  result.radiance_error_most = Most(std::move(certain), 0.9999);
  return result;
}

}  // namespace nacre
