// SPDX-License-Identifier: Apache-2.0
#include "visibility/hidden_spheres.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <variant>
#include <vector>

#include "base/overloaded.h"
#include "base/parallel.h"
#include "scene/light_shapes.h"
#include "visibility/shadow_light.h"

namespace nacre {
namespace {

// Fewer spheres are tested sooner than judged.
constexpr size_t kFewestSpheres = 512;
// Hiders are looked for among so many spheres, and judged by how many of a quarter of these they
// hide: one for whom that is not a 64th is not worth asking.
constexpr size_t kSample = 2048;
constexpr size_t kMostHiders = 16;

struct Hider {
  uint32_t number;
  TraceSphere sphere;
  bool around_eye;
};

bool Hides(const Hider& hider, uint32_t number, const TraceSphere& sphere) {
  if (Coincide(hider.sphere, sphere)) return hider.number < number;
  const auto& [center, radius] = hider.sphere;
  const double distance = (sphere.center - center).length();
  const double margin =
      BoundMargin(radius + sphere.radius, center.length() + sphere.center.length());
  if (!hider.around_eye) return distance + sphere.radius + margin < radius;
  return distance > radius + sphere.radius + margin || distance + radius + margin < sphere.radius;
}

// Balls around all lights that have a place, relative to the camera; `far`: others shine, too.
struct LightPlaces {
  std::vector<LightBall> balls;
  bool far = false;
};

LightPlaces PlacesOfLights(const Scene& scene, const Vec3d& camera_position) {
  LightPlaces places;
  const auto add = [&](const Vec3d& center, double radius) {
    places.balls.push_back({center - camera_position, radius});
  };
  for (const Light& light : scene.lights) {
    std::visit(
        Overloaded{[](const AmbientLight&) {}, [&](const DirectionalLight&) { places.far = true; },
                   [&](const EnvironmentLight&) { places.far = true; },
                   [&](const PointLight& point) { add(point.position, 0); },
                   [&](const SpotLight& spot) { add(spot.position, 0); },
                   [&](const SphereAreaLight& sphere) { add(sphere.center, sphere.radius); },
                   [&](const RectangleAreaLight& rectangle) {
                     add(rectangle.center, std::hypot(rectangle.width, rectangle.height) / 2);
                   },
                   [&](const DiskAreaLight& disk) { add(disk.center, disk.radius); },
                   [&](const MeshAreaLight& area) {
                     const LightBall ball = BallAround(area.mesh->positions);
                     add(ball.center, ball.radius);
                   }},
        light.kind);
  }
  return places;
}

class HiderFinder {
 public:
  HiderFinder(const Scene& scene, const Vec3d& camera_position, const TraceGeometry& geometry)
      : scene_(scene), spheres_(geometry.spheres), lights_(PlacesOfLights(scene, camera_position)) {
    const size_t step = std::max<size_t>(spheres_.size() / kSample, 1);
    for (size_t i = 0; i < spheres_.size(); i += step) sample_.push_back(static_cast<uint32_t>(i));
  }

  // Empty if it is not worth it.
  std::vector<Hider> Find() const {
    std::vector<Hider> hiders;
    // The largest hide what is inside, the smallest around the eye what is not.
    for (const bool around_eye : {false, true}) {
      for (const Hider& candidate : Candidates(around_eye)) {
        if (hiders.size() == kMostHiders) break;
        const auto hidden = [&](const Hider& by) {
          return Hides(by, candidate.number, candidate.sphere);
        };
        if (std::any_of(hiders.begin(), hiders.end(), hidden)) continue;
        if (HiddenBy({&candidate, 1}) * 64 >= Judged()) hiders.push_back(candidate);
      }
    }
    if (HiddenBy(hiders) * 8 < Judged()) hiders.clear();
    return hiders;
  }

 private:
  size_t Judged() const { return (sample_.size() + 3) / 4; }

  size_t HiddenBy(std::span<const Hider> hiders) const {
    size_t count = 0;
    for (size_t i = 0; i < sample_.size(); i += 4) {
      const uint32_t number = sample_[i];
      count += std::any_of(hiders.begin(), hiders.end(), [&](const Hider& hider) {
        return Hides(hider, number, spheres_[number]);
      });
    }
    return count;
  }

  std::vector<Hider> Candidates(bool around_eye) const {
    std::vector<Hider> candidates;
    for (const uint32_t number : sample_) {
      const Hider candidate{number, spheres_[number], around_eye};
      if (MayHide(candidate)) candidates.push_back(candidate);
    }
    const auto most = candidates.begin() +
                      static_cast<std::ptrdiff_t>(std::min(candidates.size(), 2 * kMostHiders));
    std::partial_sort(candidates.begin(), most, candidates.end(),
                      [&](const Hider& a, const Hider& b) {
                        const double x = a.sphere.radius, y = b.sphere.radius;
                        if (x != y) return around_eye ? x < y : x > y;
                        return a.number < b.number;
                      });
    candidates.erase(most, candidates.end());
    return candidates;
  }

  bool MayHide(const Hider& hider) const {
    const auto& [center, radius] = hider.sphere;
    const double margin = BoundMargin(radius, center.length());
    const bool perspective = scene_.camera.projection == Projection::kPerspective;
    if (hider.around_eye) {
      if (!perspective || lights_.far || !scene_.meshes.empty()) return false;
      if (!(center.length() + margin < radius)) return false;
    } else {
      // Parallel rays begin anywhere on a plane.
      const Vec3d forward = (scene_.camera.look_at - scene_.camera.position).normalized();
      const double away = perspective ? center.length() : std::abs(center.dot(forward));
      if (!(away > radius + margin)) return false;
    }
    return std::all_of(lights_.balls.begin(), lights_.balls.end(), [&](const LightBall& light) {
      const double distance = (light.center - center).length();
      const double both = margin + BoundMargin(light.radius, light.center.length());
      return hider.around_eye ? distance + light.radius + both < radius
                              : distance > radius + light.radius + both;
    });
  }

  const Scene& scene_;
  const HugeArray<TraceSphere>& spheres_;
  LightPlaces lights_;
  std::vector<uint32_t> sample_;
};

}  // namespace

void MarkHiddenSpheres(const Scene& scene, const Vec3d& camera_position, int threads,
                       TraceGeometry* geometry) {
  const HugeArray<TraceSphere>& spheres = geometry->spheres;
  if (spheres.size() < kFewestSpheres) return;
  const std::vector<Hider> hiders = HiderFinder(scene, camera_position, *geometry).Find();
  if (hiders.empty()) return;
  std::vector<uint8_t>& hidden = geometry->hidden;
  hidden.assign(spheres.size(), 0);
  constexpr size_t kBlock = size_t{1} << 12;
  ParallelFor((spheres.size() + kBlock - 1) / kBlock, threads, [&](size_t block) {
    const size_t end = std::min((block + 1) * kBlock, spheres.size());
    for (size_t i = block * kBlock; i < end; ++i) {
      hidden[i] = std::any_of(hiders.begin(), hiders.end(), [&](const Hider& hider) {
        return Hides(hider, static_cast<uint32_t>(i), spheres[i]);
      });
    }
  });
}

}  // namespace nacre
