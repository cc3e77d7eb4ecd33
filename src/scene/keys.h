// SPDX-License-Identifier: Apache-2.0
// scene/keys.h: the keys of cameras, pictures and lights by name, each defined once. The reader of
// scene files, the JSON Schema, the scene's hash, Validate() and the JSON form of a model's lights
// are derived from these tables. Those of materials are in material_parameters.h.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <type_traits>

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

// The keys of a struct, in the order in which the hash takes them. Kinds of lights and skies have
// keys for all but the files that they refer to.
template <class Owner>
std::span<const SceneKey<Owner>> KeysOf();

template <>
std::span<const SceneKey<ImageSettings>> KeysOf();
template <>
std::span<const SceneKey<AmbientLight>> KeysOf();
template <>
std::span<const SceneKey<DirectionalLight>> KeysOf();
template <>
std::span<const SceneKey<PointLight>> KeysOf();
template <>
std::span<const SceneKey<SpotLight>> KeysOf();
template <>
std::span<const SceneKey<SphereAreaLight>> KeysOf();
template <>
std::span<const SceneKey<RectangleAreaLight>> KeysOf();
template <>
std::span<const SceneKey<DiskAreaLight>> KeysOf();
template <>
std::span<const SceneKey<MeshAreaLight>> KeysOf();
template <>
std::span<const SceneKey<EnvironmentLight>> KeysOf();
template <>
std::span<const SceneKey<ConstantSky>> KeysOf();
template <>
std::span<const SceneKey<GradientSky>> KeysOf();
template <>
std::span<const SceneKey<QuadraticSky>> KeysOf();
template <>
std::span<const SceneKey<PictureSky>> KeysOf();

// The keys of a camera: a perspective one has a field of view, an orthographic one a height.
std::span<const SceneKey<Camera>> CameraKeys(Projection projection);

template <class Owner>
std::span<const SceneKey<Owner>> KeysFor(const Owner& owner) {
  if constexpr (std::is_same_v<Owner, Camera>) {
    return CameraKeys(owner.projection);
  } else {
    return KeysOf<Owner>();
  }
}

struct LightKind {
  std::string_view name;            // a light's "type"
  decltype(Light::kind) (*make)();  // makes one with every default
};

// All kinds of lights.
std::span<const LightKind> LightKinds();

// The kind of this light.
const LightKind& KindOf(const Light& light);

}  // namespace nacre
