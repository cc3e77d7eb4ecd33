// SPDX-License-Identifier: Apache-2.0
// tests/install/example.cc: nacre as a library: a grid of spheres, rendered and compared.
//
// Usage: example OUTPUT.exr
#include <cmath>
#include <cstdio>
#include <exception>
#include <string>

#include <nacre/nacre.h>

namespace {

// 4 x 4 spheres: roughness grows downwards, metallic to the right.
nacre::Scene MakeGrid(const std::string& shadowing) {
  nacre::Scene scene;
  scene.SetCamera({{"position", {0, 0, 14}}, {"fov_y_deg", 40}});
  scene.AddLight("key", {{"type", "point"}, {"position", {5, 5, 10}}, {"intensity", 300}});
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 4; ++column) {
      const std::string name = "r" + std::to_string(row) + "c" + std::to_string(column);
      scene.AddMaterial(name, {{"model", "metallic_roughness"},
                               {"base_color", {0.9, 0.2, 0.1}},
                               {"roughness", 0.1 + 0.3 * row},
                               {"metallic", column / 3.0},
                               {"shadowing", shadowing}});
      scene.AddSphere({2.2 * column - 3.3, 3.3 - 2.2 * row, 0}, 1, name);
    }
  }
  return scene;
}

int Run(const std::string& output) {
  nacre::RenderSettings settings;
  settings.width = settings.height = 96;
  settings.samples = 4;
  settings.layers = {"diffuse", "specular"};
  const nacre::Image picture = nacre::Render(MakeGrid("height_correlated"), settings);
  nacre::Write(picture, output);

  const nacre::Image simpler = nacre::Render(MakeGrid("schlick_direct"), settings);
  for (const nacre::LayerMetrics& layer : nacre::Compare(simpler, picture).layers) {
    std::printf("%-8s rmse %.5f max %.5f\n", layer.layer.empty() ? "beauty" : layer.layer.c_str(),
                layer.rmse, layer.max_abs);
  }
  const nacre::Brdf gold("conductor", {{"preset", "gold"}, {"roughness", 0.3}});
  const double c = std::sqrt(0.5);
  const nacre::Reflection mirrored = gold.Evaluate({0, 0, 1}, {c, 0, c}, {-c, 0, c});
  std::printf("gold     %.4f %.4f %.4f\n", mirrored.specular[0], mirrored.specular[1],
              mirrored.specular[2]);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return Run(argc > 1 ? argv[1] : "grid.exr");
  } catch (const nacre::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return error.exit_code();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 70;
  }
}
