// SPDX-License-Identifier: Apache-2.0
// scene/keys.h: the keys of cameras, pictures and lights by name, each defined once. The reader of
// scene files, the JSON Schema, the scene's hash, Validate() and the JSON form of a model's lights
// are derived from these tables. Those of materials are in material_parameters.h.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "base/vec.h"
#include "scene/limits.h"
#include "scene/scene.h"

namespace nacre {

enum class KeyForm : uint8_t { kNumber, kWhole, kColor, kPoint, kDirection, kBoolean, kChoice };

enum class KeyUse : uint8_t {
  kOptional,  // if absent, the default of the struct
  kRequired,
  kDerived,  // if absent, derived from other keys by the reader
};

// A key for a member of a struct, or for a member of a struct in it: "attenuation/linear".
template <class Owner>
struct SceneKey {
  std::string_view name;
  KeyForm form;
  KeyUse use;
  Range range;                                // of numbers, and of each component of a colour
  std::span<const std::string_view> options;  // of choices
  std::string_view meaning;                   // for people
  // Numbers, booleans (0 or 1) and indices into `options` are the x component of a value.
  Vec3d (*get)(const Owner&);
  void (*set)(Owner&, const Vec3d&);
};

template <class Owner>
using SceneKeys = std::span<const SceneKey<Owner>>;

// The keys of a struct, in the order in which the hash takes them. A perspective camera has a field
// of view, an orthographic one a height. Kinds of lights and skies have keys for all but the files
// that they refer to.
SceneKeys<Camera> KeysFor(const Camera& camera);
SceneKeys<ImageSettings> KeysFor(const ImageSettings&);
SceneKeys<AmbientLight> KeysFor(const AmbientLight&);
SceneKeys<DirectionalLight> KeysFor(const DirectionalLight&);
SceneKeys<PointLight> KeysFor(const PointLight&);
SceneKeys<SpotLight> KeysFor(const SpotLight&);
SceneKeys<SphereAreaLight> KeysFor(const SphereAreaLight&);
SceneKeys<RectangleAreaLight> KeysFor(const RectangleAreaLight&);
SceneKeys<DiskAreaLight> KeysFor(const DiskAreaLight&);
SceneKeys<MeshAreaLight> KeysFor(const MeshAreaLight&);
SceneKeys<EnvironmentLight> KeysFor(const EnvironmentLight&);
SceneKeys<ConstantSky> KeysFor(const ConstantSky&);
SceneKeys<GradientSky> KeysFor(const GradientSky&);
SceneKeys<QuadraticSky> KeysFor(const QuadraticSky&);
SceneKeys<PictureSky> KeysFor(const PictureSky&);

struct LightKind {
  std::string_view name;            // a light's "type"
  decltype(Light::kind) (*make)();  // makes one with every default
};

// All kinds of lights.
std::span<const LightKind> LightKinds();

// The kind of this light.
const LightKind& KindOf(const Light& light);

}  // namespace nacre
