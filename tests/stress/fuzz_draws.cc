// SPDX-License-Identifier: Apache-2.0
#include "stress/fuzz_draws.h"

#include <algorithm>

#include "scene/limits.h"
#include "scene/scene.h"
#include "scene/validate.h"

namespace nacre {
namespace {

// Along an axis, or as near to it as 1 - u, with components that are 0, -0, denormal or tiny.
Vec3d AxisDirection(FuzzRandom* random) {
  constexpr double kSmall[] = {0.0, -0.0, 1e-40, -1e-42, 1e-20, 6e-8, -3e-4, 1e-300};
  Vec3d v(random->Pick(kSmall), random->Pick(kSmall), random->Pick(kSmall));
  v[static_cast<int>(random->Below(3))] = random->OneIn(2) ? 1 : -1;
  return v / std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
}

// A unit direction whose cosine with n is this.
Vec3d AtCosine(const Vec3d& n, double cosine, FuzzRandom* random) {
  const Vec3d across = n.cross(random->Direction()).normalized();
  return n * cosine + across * std::sqrt(1 - cosine * cosine);
}

double GrazingCosine(FuzzRandom* random) {
  constexpr double kSigns[] = {-1, 0, 1, 1};
  return random->Pick(kSigns) * random->Magnitude(1e-8, 1e-2);
}

Vec3d Mirrored(const Vec3d& n, const Vec3d& v) { return n * (2 * n.dot(v)) - v; }

FuzzDirections SpecialDirections(FuzzRandom* random) {
  FuzzDirections d;
  d.normal = random->OneIn(2) ? AxisDirection(random) : random->Direction();
  d.to_light = random->OneIn(2) ? AxisDirection(random) : random->Direction();
  d.to_view = random->OneIn(2) ? AxisDirection(random) : random->Direction();
  switch (random->Below(8)) {
    case 0:
      d.to_light = d.to_view = d.normal;
      break;
    case 1:
      d.to_light = d.to_view;
      break;
    case 2:
      d.to_light = -d.to_view;
      break;
    case 3:
      d.to_light = AtCosine(d.normal, GrazingCosine(random), random);
      d.to_view = -d.to_light;
      break;
    case 4:
      d.to_light = AtCosine(d.normal, GrazingCosine(random), random);
      break;
    case 5:
      d.to_light = AtCosine(d.normal, GrazingCosine(random), random);
      d.to_view = AtCosine(d.normal, GrazingCosine(random), random);
      break;
    case 6: {
      const Vec3d off = random->Direction() * random->Magnitude(1e-8, 1e-2);
      d.to_light = (Mirrored(d.normal, d.to_view) + off).normalized();
      break;
    }
    default:
      break;  // axes
  }
  return d;
}

Rgb DrawColor(double largest, FuzzRandom* random) {
  constexpr double kValues[] = {0, 0.04, 1};
  Rgb color;
  for (int c = 0; c < 3; ++c) {
    color[c] =
        random->OneIn(2) ? random->Pick(kValues) : random->Uniform(0, std::min(largest, 1.0));
  }
  return color;
}

double DrawNumber(const MaterialParameter& parameter, FuzzRandom* random) {
  const Range& range = parameter.range;
  if (random->OneIn(4) && !range.min_open) return range.min;
  if (parameter.name == "shininess") {
    constexpr double kExponents[] = {0, 1e-30, 1, 2, 1e6, 1e9};
    return random->OneIn(4) ? random->Pick(kExponents) : random->Magnitude(1e-3, 1e6);
  }
  if (parameter.name.ends_with("roughness")) {
    // About the limit of delta lobes, 2^-20, too.
    constexpr double kRoughness[] = {0, 1e-8, 0x1p-20, 0x1.001p-20, 0x1.fp-21, 1};
    return random->OneIn(4) ? random->Pick(kRoughness) : random->Magnitude(1e-8, 1);
  }
  if (random->OneIn(4) && !range.max_open) return range.max;
  if (range.max <= 1e3) return random->Uniform(range.min, range.max);
  return random->Magnitude(std::max(range.min, 1e-6), range.max);
}

}  // namespace

FuzzDirections DrawDirections(FuzzRandom* random) {
  if (random->OneIn(4)) return SpecialDirections(random);
  FuzzDirections d{random->Direction(), random->Direction(), random->Direction()};
  // Viewers behind the surface, which interpolated normals make, need no half of the draws.
  if (d.normal.dot(d.to_view) < 0 && !random->OneIn(8)) d.to_view = -d.to_view;
  if (d.normal.dot(d.to_light) < 0 && !random->OneIn(8)) d.to_light = -d.to_light;
  return d;
}

double DrawDistance(FuzzRandom* random) {
  constexpr double kDistances[] = {0, 1e-300, 1e-40, 1e-25, 1e-19, 1e-15, 1e-9, 1e15};
  return random->OneIn(8) ? random->Pick(kDistances) : random->Magnitude(1e-3, 1e3);
}

Rgb DrawLight(FuzzRandom* random) {
  Rgb color;
  for (int c = 0; c < 3; ++c) {
    constexpr double kValues[] = {0, 1, 1e-38, 1e-45, 1e30};
    color[c] = random->OneIn(3) ? random->Pick(kValues) : random->Magnitude(1e-6, 1e30);
  }
  return color;
}

namespace {

// Whether options do not go together. Numbers are in their ranges.
bool IsRefused(const Material& material) {
  Scene scene;
  scene.materials.push_back(material);
  return !Validate(scene).empty();
}

Material DrawAnything(const MaterialModel& model, FuzzRandom* random) {
  Material material = model.make();
  for (const MaterialChoice& choice : model.choices) {
    size_t option = random->Below(choice.options.size());
    // The exact dielectric prepares for half a millisecond, longer than all hits of a run take.
    const bool costly = model.name == "dielectric" && choice.options[option] == "exact";
    if (costly && !random->OneIn(8)) ++option;
    choice.set(material, option);
  }
  for (const MaterialParameter& parameter : model.parameters) {
    double number = DrawNumber(parameter, random);
    // Films, and anisotropic lobes of exact dielectrics, prepare for some ten milliseconds.
    const bool costly = parameter.name == "thin_film_weight" || parameter.name == "iridescence" ||
                        parameter.name.ends_with("_anisotropy");
    if (costly && !random->OneIn(8)) number = 0;
    // So do bases thinner than air.
    const bool is_thin = parameter.name == "specular_ior" && number < 1;
    if (is_thin && !random->OneIn(8)) number = 1 / number;
    Rgb value(number, number, number);
    if (parameter.is_color) value = DrawColor(parameter.range.max, random);
    for (int c = 0; c < 3; ++c) value[c] = std::max(value[c], parameter.range.min);
    parameter.set(material, value);
  }
  return material;
}

}  // namespace

Material DrawMaterial(const MaterialModel& model, FuzzRandom* random) {
  Material material = DrawAnything(model, random);
  while (IsRefused(material)) material = DrawAnything(model, random);
  return material;
}

}  // namespace nacre
