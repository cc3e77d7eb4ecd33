// SPDX-License-Identifier: Apache-2.0
// scene/parts.h: the parts of a scene that change independently of one another. Data derived from a
// scene names the parts that it depends on, and is derived again when one of them changes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace nacre {

inline constexpr size_t kSceneParts = 7;

enum class ScenePart : uint8_t {
  kCamera,
  kImage,       // Scene::image
  kBackground,  // Scene::background
  kTextures,    // Scene::images and Scene::textures
  kMaterials,   // all materials, including those that come with shapes
  kLights,
  kShapes,  // spheres, meshes and labels
};

// A set of parts.
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

// What a change of the scene may have affected: some parts, and of the materials and shapes perhaps
// only some.
struct SceneChange {
  SceneChange() = default;
  SceneChange(SceneParts all_of)  // NOLINT(google-explicit-constructor): without lists
      : parts(all_of) {}
  SceneChange(ScenePart all_of) : parts(all_of) {}  // NOLINT(google-explicit-constructor)

  SceneParts parts;
  std::vector<uint32_t> materials;  // if not empty, the only materials that have changed
  std::vector<uint32_t> spheres;    // if not empty, the only shapes that have changed
};

// Counts the changes of each part. Data derived from some parts is still valid while their counts
// are the same.
class PartVersions {
 public:
  void Change(SceneParts parts) {
    for (size_t i = 0; i < kSceneParts; ++i) {
      if (parts.Has(static_cast<ScenePart>(i))) ++numbers_[i];
    }
  }

  // The counts of these parts; all others are 0.
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

// The versions of a scene that changes, and logs of the materials and spheres that the last changes
// affected, for data that is kept for each of them.
class SceneVersions {
 public:
  void Change(const SceneChange& change) {
    now_.Change(change.parts);
    if (change.parts.Has(ScenePart::kMaterials)) materials_.Add(change.materials);
    if (change.parts.Has(ScenePart::kShapes)) shapes_.Add(change.spheres);
  }

  PartVersions Of(SceneParts parts) const { return now_.Of(parts); }

  // How often materials have changed.
  uint64_t materials() const { return materials_.count; }
  // The materials that have changed since materials() was `then`; nullopt: any may have.
  std::optional<std::span<const uint32_t>> MaterialsSince(uint64_t then) const {
    return materials_.Since(then);
  }

  // The same of shapes: the spheres that have changed, or nullopt if any shape may have.
  uint64_t shapes() const { return shapes_.count; }
  std::optional<std::span<const uint32_t>> SpheresSince(uint64_t then) const {
    return shapes_.Since(then);
  }

 private:
  // Change number first + i affected items [begins[i], begins[i + 1]); earlier ones may have
  // affected any.
  struct Log {
    uint64_t count = 0, first = 0;
    std::vector<size_t> begins;
    std::vector<uint32_t> items;

    void Add(const std::vector<uint32_t>& changed) {
      constexpr size_t kMost = 1024;  // callers that have not asked for so long derive all again
      ++count;
      if (changed.empty() || items.size() + changed.size() > kMost) {
        begins.clear();
        items.clear();
        first = count;
        return;
      }
      begins.push_back(items.size());
      items.insert(items.end(), changed.begin(), changed.end());
    }
    std::optional<std::span<const uint32_t>> Since(uint64_t then) const {
      if (then < first) return std::nullopt;
      if (then >= count) return std::span<const uint32_t>();
      return std::span(items).subspan(begins[then - first]);
    }
  };

  PartVersions now_;
  Log materials_, shapes_;
};

}  // namespace nacre
