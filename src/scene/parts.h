// SPDX-License-Identifier: Apache-2.0
// scene/parts.h: the parts of a scene that change apart from one another. What is made of a scene
// names the parts that it is made of, and is made again when one of them changes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace nacre {

inline constexpr size_t kSceneParts = 7;

enum class ScenePart : uint8_t {
  kCamera,
  kImage,       // Scene::image
  kBackground,  // Scene::background
  kTextures,    // Scene::images and Scene::textures
  kMaterials,   // all of them, those that shapes bring along as well
  kLights,
  kShapes,  // spheres, meshes and labels
};

// A set of them.
class SceneParts {
 public:
  constexpr SceneParts() = default;
  constexpr SceneParts(ScenePart part)  // NOLINT(google-explicit-constructor): {a, b} reads well
      : bits_(static_cast<uint8_t>(1u << static_cast<unsigned>(part))) {}

  static constexpr SceneParts All() { return SceneParts(uint8_t{0x7f}); }

  constexpr bool Has(ScenePart part) const { return HasAny(part); }
  // Whether the two sets have a part in common.
  constexpr bool HasAny(SceneParts others) const { return (bits_ & others.bits_) != 0; }
  constexpr bool empty() const { return bits_ == 0; }

  constexpr SceneParts Without(SceneParts others) const {
    return SceneParts(static_cast<uint8_t>(bits_ & ~others.bits_));
  }

  friend constexpr SceneParts operator|(SceneParts a, SceneParts b) {
    return SceneParts(static_cast<uint8_t>(a.bits_ | b.bits_));
  }
  constexpr SceneParts& operator|=(SceneParts others) { return *this = *this | others; }
  friend constexpr bool operator==(SceneParts a, SceneParts b) = default;

 private:
  explicit constexpr SceneParts(uint8_t bits) : bits_(bits) {}

  uint8_t bits_ = 0;
};

constexpr SceneParts operator|(ScenePart a, ScenePart b) { return SceneParts(a) | SceneParts(b); }

// How often each part has changed. What was made of some parts is still right while their numbers
// are the same.
class PartVersions {
 public:
  void Change(SceneParts parts) {
    for (size_t i = 0; i < kSceneParts; ++i) {
      if (parts.Has(static_cast<ScenePart>(i))) ++numbers_[i];
    }
  }

  // Those of these parts; all others are 0.
  PartVersions Of(SceneParts parts) const {
    PartVersions some;
    for (size_t i = 0; i < kSceneParts; ++i) {
      if (parts.Has(static_cast<ScenePart>(i))) some.numbers_[i] = numbers_[i];
    }
    return some;
  }

  friend bool operator==(const PartVersions&, const PartVersions&) = default;

 private:
  std::array<uint64_t, kSceneParts> numbers_{};
};

}  // namespace nacre
