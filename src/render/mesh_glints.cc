// SPDX-License-Identifier: Apache-2.0
#include "render/mesh_glints.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "base/parallel.h"
#include "scene/mesh.h"

namespace nacre {
namespace {

constexpr double kFarDistance = std::numeric_limits<double>::infinity();

// A triangle as hits on it are shaded, relative to the camera.
struct GlossyTriangle {
  uint32_t primitive;
  uint32_t material;
  double lobe;                   // HalfVectorWidth
  std::array<Vec3d, 3> corners;  // all before the camera
  std::array<Vec3d, 3> normals;  // unit, on the side that is seen
};

// Weights of the second and the third corner.
using Weights = Vec2d;

template <class T>
T Interpolate(const std::array<T, 3>& of, const Weights& w) {
  return of[0] * (1 - w.x - w.y) + of[1] * w.x + of[2] * w.y;
}

// The unit vector between the ways to the eye and to the light; none where they are opposite.
Vec3d HalfVector(const Projector& projector, const HighlightLight& light, const Vec3d& place) {
  const Vec3d to_view = projector.perspective ? -place.normalized() : -projector.forward;
  const Vec3d to_light = light.far ? light.place : (light.place - place).normalized();
  return (to_view + to_light).normalized();
}

// By how much the normal differs from the half vector: the sine of the angle, where it is small.
Vec3d Deviation(const Projector& projector, const GlossyTriangle& t, const HighlightLight& light,
                const Weights& w) {
  return Interpolate(t.normals, w).normalized() -
         HalfVector(projector, light, Interpolate(t.corners, w));
}

// How something changes with the weights.
template <class T>
struct Slopes {
  T of_x, of_y;
};

template <class Function>
auto SlopesOf(const Function& f, const Weights& w) {
  // Of smooth functions of order 1 over the triangle: what rounds and what bends is alike, 1e-11.
  constexpr double kStep = 1e-5;
  using T = decltype(f(w));
  return Slopes<T>{(f({w.x + kStep, w.y}) - f({w.x - kStep, w.y})) / (2 * kStep),
                   (f({w.x, w.y + kStep}) - f({w.x, w.y - kStep})) / (2 * kStep)};
}

double Determinant(const Slopes<Vec2d>& s) { return s.of_x.cross(s.of_y); }

// The step by which a function with these slopes changes by `change`.
Weights StepFor(const Slopes<Vec2d>& s, const Vec2d& change) {
  const double determinant = Determinant(s);
  return {change.cross(s.of_y) / determinant, s.of_x.cross(change) / determinant};
}

bool IsInside(const Weights& w, double slack) {
  return w.x >= -slack && w.y >= -slack && w.x + w.y <= 1 + slack;
}

// Two directions across a unit vector and one another.
std::array<Vec3d, 2> Across(const Vec3d& n) {
  const Vec3d other = std::abs(n.x) < 0.6 ? Vec3d(1, 0, 0) : Vec3d(0, 1, 0);
  const Vec3d first = n.cross(other).normalized();
  return {first, n.cross(first)};
}

// Where the normal is the half vector.
std::optional<Weights> FindPeak(const Projector& projector, const GlossyTriangle& t,
                                const HighlightLight& light) {
  constexpr int kMostSteps = 20;
  // Newton's first step, from the middle, tells of most triangles that it is none of them.
  constexpr double kFirstSlack = 1;
  Weights at(1.0 / 3, 1.0 / 3);
  for (int i = 0; i < kMostSteps; ++i) {
    const auto across = Across(Interpolate(t.normals, at).normalized());
    const auto deviation = [&](const Weights& w) {
      const Vec3d d = Deviation(projector, t, light, w);
      return Vec2d(d.dot(across[0]), d.dot(across[1]));
    };
    const Weights step = StepFor(SlopesOf(deviation, at), -deviation(at));
    at += step;
    if (!IsInside(at, kFirstSlack)) return std::nullopt;  // so is what is not finite
    if (step.length() < 1e-9) {
      // A neighbour has those on the edge as well: alike, they count as often as they are found.
      if (!IsInside(at, 1e-9)) return std::nullopt;
      const Vec3d half = HalfVector(projector, light, Interpolate(t.corners, at));
      return Interpolate(t.normals, at).dot(half) > 0 ? std::optional(at) : std::nullopt;
    }
  }
  return std::nullopt;
}

// Whether some normal of the triangle may be a half vector of its: that of its middle differs by
// more than all of them do.
bool MayShow(const Projector& projector, const GlossyTriangle& t, const HighlightLight& light,
             double turn) {
  const Weights middle(1.0 / 3, 1.0 / 3);
  const Vec3d place = Interpolate(t.corners, middle);
  double extent = 0;
  for (const Vec3d& corner : t.corners) extent = std::max(extent, (corner - place).length());
  // Half vectors turn by half of what the ways to the eye and the light do.
  const double to_eye = projector.perspective ? place.length() : kFarDistance;
  const double to_light = light.far ? kFarDistance : (light.place - place).length();
  const double nearer = std::min(to_eye, to_light);
  if (!(extent < nearer / 2)) return true;
  return Deviation(projector, t, light, middle).length() <= 2 * (turn + 2 * extent / nearer);
}

// Whether the triangle is seen within these bounds of the film.
bool IsSeen(const Projector& projector, const std::array<Vec3d, 3>& corners, const Window& window,
            double reach) {
  double x0 = kFarDistance, x1 = -kFarDistance, y0 = x0, y1 = x1;
  for (const Vec3d& corner : corners) {
    if (!(corner.dot(projector.forward) > 0)) return false;
    const FilmPlace place = ProjectPoint(projector, corner);
    x0 = std::min(x0, place.x);
    x1 = std::max(x1, place.x);
    y0 = std::min(y0, place.y);
    y1 = std::max(y1, place.y);
  }
  return x1 > window.x0 - reach && x0 < window.x1 + reach && y1 > window.y0 - reach &&
         y0 < window.y1 + reach;
}

class Finder {
 public:
  Finder(const SurfacePlan& surfaces, const AdaptivePlan& adaptive, const CameraFrame& camera)
      : surfaces_(surfaces), adaptive_(adaptive), projector_(MakeProjector(camera)) {}

  void Find(const TriangleRef& triangle, uint32_t primitive, const Window& window, double reach,
            double largest, std::vector<Glint>* glints) const {
    GlossyTriangle t{};
    t.primitive = primitive;
    const Scene& scene = *surfaces_.primitives.scene;
    for (size_t c = 0; c < 3; ++c) {
      t.corners[c] = triangle.mesh->positions[triangle.Vertex(c)] - scene.camera.position;
    }
    if (!IsSeen(projector_, t.corners, window, reach)) return;
    const Vec3d middle = Interpolate(t.corners, {1.0 / 3, 1.0 / 3});
    t.material = MaterialAt(surfaces_, primitive, ProjectPoint(projector_, middle).x).index;
    t.lobe = HalfVectorWidth(surfaces_, adaptive_, t.material);
    if (t.lobe == kFarDistance) return;
    Vec3d face = FaceNormal(*triangle.mesh, triangle.triangle);
    if (face.dot(projector_.perspective ? middle : projector_.forward) > 0) face = -face;
    const bool smooth = HasSmoothNormals(*triangle.mesh);
    double turn = 0;
    for (size_t c = 0; c < 3; ++c) {
      const Vec3d normal = smooth ? triangle.mesh->normals[triangle.Vertex(c)] : face;
      t.normals[c] = normal.dot(face) < 0 ? -normal : normal;
    }
    const Vec3d mean = Interpolate(t.normals, {1.0 / 3, 1.0 / 3}).normalized();
    for (const Vec3d& normal : t.normals) turn = std::max(turn, (normal - mean).length());
    for (const HighlightLight& light : adaptive_.lights) {
      if (t.lobe == 0 && light.radius == 0) continue;
      if (MayShow(projector_, t, light, turn)) Add(t, light, largest, glints);
    }
  }

 private:
  void Add(const GlossyTriangle& t, const HighlightLight& light, double largest,
           std::vector<Glint>* glints) const {
    const std::optional<Weights> peak = FindPeak(projector_, t, light);
    if (!peak) return;
    const Vec3d place = Interpolate(t.corners, *peak);
    const auto across = Across(Interpolate(t.normals, *peak).normalized());
    const Slopes<Vec2d> turns = SlopesOf(
        [&](const Weights& w) {
          const Vec3d d = Deviation(projector_, t, light, w);
          return Vec2d(d.dot(across[0]), d.dot(across[1]));
        },
        *peak);
    const auto on_film = [&](const Weights& w) {
      const FilmPlace at = ProjectPoint(projector_, Interpolate(t.corners, w));
      return Vec2d(at.x, at.y);
    };
    const Slopes<Vec2d> moves = SlopesOf(on_film, *peak);
    // A light's angular radius turns the half vector by half as much.
    const double of_light = light.far ? 0 : light.radius / (light.place - place).length() / 2;
    const double width2 = t.lobe * t.lobe + of_light * of_light;
    const double area = M_PI * width2 * std::abs(Determinant(moves) / Determinant(turns));
    if (!(area > 0 && area < largest)) return;
    // Along the way on which it is narrower of two across one another, to the triangle's middle.
    const double reach = 4 * std::sqrt(width2);
    const auto step = [&](const Vec2d& turn) {
      const Weights w = StepFor(turns, turn);
      return moves.of_x * w.x + moves.of_y * w.y;
    };
    const Vec2d one = step({reach, 0}), other = step({0, reach});
    const Vec2d at = on_film(*peak);
    const Vec2d inwards = on_film({1.0 / 3, 1.0 / 3}) - at;
    Vec2d beside = one.length2() < other.length2() ? one : other;
    if (beside.dot(inwards) < 0) beside = -beside;
    glints->push_back(
        {t.primitive, t.material, light.number, at.x, at.y, area, beside.x, beside.y});
  }

  const SurfacePlan& surfaces_;
  const AdaptivePlan& adaptive_;
  Projector projector_;
};

// Whether a mesh's triangles are shaded by the normals of their points.
bool ShowsGlints(const Mesh& mesh) {
  return mesh.interpolation == Interpolation::kPhong ||
         mesh.interpolation == Interpolation::kFaceted;
}

}  // namespace

std::vector<Glint> FindMeshGlints(const Scene& scene, const SurfacePlan& surfaces,
                                  const AdaptivePlan& adaptive, const CameraFrame& camera,
                                  const Window& window, double reach, double largest, int threads) {
  constexpr size_t kAtOnce = 1 << 14;
  std::vector<Glint> glints;
  if (adaptive.lights.empty()) return glints;
  const Finder finder(surfaces, adaptive, camera);
  auto first = static_cast<uint32_t>(scene.spheres.size());
  for (size_t number = 0; number < scene.meshes.size(); ++number) {
    const Mesh& mesh = scene.meshes[number];
    const size_t count = mesh.triangles.size() / 3;
    if (ShowsGlints(mesh)) {
      std::vector<std::vector<Glint>> found((count + kAtOnce - 1) / kAtOnce);
      ParallelFor(found.size(), threads, [&](size_t piece) {
        const size_t end = std::min(count, (piece + 1) * kAtOnce);
        for (size_t i = piece * kAtOnce; i < end; ++i) {
          const auto triangle = static_cast<uint32_t>(i);
          finder.Find({&mesh, number, triangle}, first + triangle, window, reach, largest,
                      &found[piece]);
        }
      });
      for (const std::vector<Glint>& some : found) {
        glints.insert(glints.end(), some.begin(), some.end());
      }
    }
    first += static_cast<uint32_t>(count);
  }
  std::stable_sort(glints.begin(), glints.end(),
                   [](const Glint& a, const Glint& b) { return a.y < b.y; });
  return glints;
}

}  // namespace nacre
