// SPDX-License-Identifier: Apache-2.0
#include "study/interpolation.h"

#include <algorithm>
#include <cmath>

#include "scene/sphere_mesh.h"
#include "study/picture.h"

namespace nacre {

Image RenderIcosphere(Interpolation interpolation, int subdivisions, int pixels) {
  Material material;
  material.model = PhongMaterial{.convention = PhongConvention::kClassic,
                                 .ka = Rgb(0),
                                 .kd = Rgb(0.7),
                                 .ks = Rgb(0.5),
                                 .shininess = 64};
  Scene scene = SphereScene(material, pixels);
  scene.image.spp = 1;
  scene.image.shadows = false;
  scene.spheres.clear();
  Mesh mesh = MakeMesh(Icosphere{.subdivisions = subdivisions});
  mesh.material = {0};
  mesh.interpolation = interpolation;
  scene.meshes.push_back(std::move(mesh));
  scene.lights = {SunTowards({2, 3, 3}, Rgb(1))};
  return RenderLayers(scene, {"diffuse", "specular"});
}

InterpolationError MeasureInterpolation(const Image& image, const Image& exact) {
  const std::vector<float>& alpha = exact.Find("A")->samples;
  const auto measure = [&](const char* channel, double* max, double* rms) {
    const std::vector<float>& got = image.Find(channel)->samples;
    const std::vector<float>& truth = exact.Find(channel)->samples;
    double squares = 0;
    size_t count = 0;
    for (size_t i = 0; i < alpha.size(); ++i) {
      if (alpha[i] == 0) continue;
      const double difference = double{got[i]} - double{truth[i]};
      *max = std::max(*max, std::abs(difference));
      squares += difference * difference;
      ++count;
    }
    *rms = std::sqrt(squares / static_cast<double>(count));
  };
  InterpolationError error;
  measure("diffuse.G", &error.diffuse_max, &error.diffuse_rms);
  measure("specular.G", &error.specular_max, &error.specular_rms);
  const std::vector<float>& specular = image.Find("specular.G")->samples;
  error.specular_peak = double{*std::max_element(specular.begin(), specular.end())};
  return error;
}

}  // namespace nacre
