// SPDX-License-Identifier: Apache-2.0
#include "render/mesh_glints.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include <Imath/ImathBox.h>

#include "base/parallel.h"
#include "scene/mesh.h"

namespace nacre {
namespace {

// A triangle with all that its shading depends on. Points are relative to the camera.
struct GlossyTriangle {
  uint32_t primitive;
  uint32_t material;
  double lobe;                   // HalfVectorWidth
  std::array<Vec3d, 3> corners;  // all in front of the camera
  std::array<Vec3d, 3> normals;  // unit, on the visible side
};

// Barycentric coordinates: the weights of the second and the third corner.
using Barycentrics = Vec2d;

template <class T>
T Interpolate(const std::array<T, 3>& of, const Barycentrics& w) {
  return of[0] * (1 - w.x - w.y) + of[1] * w.x + of[2] * w.y;
}

// The half vector of the directions to the eye and to the light; 0 if they are opposite.
Vec3d HalfVector(const Projector& projector, const HighlightLight& light, const Vec3d& place) {
  const Vec3d to_view = projector.perspective ? -place.normalized() : -projector.forward;
  const Vec3d to_light = light.directional ? light.position : (light.position - place).normalized();
  return (to_view + to_light).normalized();
}

// The difference between the unit normal and the half vector.
Vec3d Deviation(const Projector& projector, const GlossyTriangle& t, const HighlightLight& light,
                const Barycentrics& w) {
  return Interpolate(t.normals, w).normalized() -
         HalfVector(projector, light, Interpolate(t.corners, w));
}

// The derivatives of a function of the barycentric coordinates.
template <class T>
struct Derivatives {
  T by_x, by_y;
};

template <class Function>
auto Differentiate(const Function& f, const Barycentrics& w) {
  // For smooth functions of order 1 over the triangle, at which the rounding error and the error of
  // the central difference are about equal, 1e-11.
  constexpr double kStep = 1e-5;
  using T = decltype(f(w));
  return Derivatives<T>{(f({w.x + kStep, w.y}) - f({w.x - kStep, w.y})) / (2 * kStep),
                        (f({w.x, w.y + kStep}) - f({w.x, w.y - kStep})) / (2 * kStep)};
}

double Determinant(const Derivatives<Vec2d>& s) { return s.by_x.cross(s.by_y); }

// The step by which a linear function with these derivatives changes by `change`.
Barycentrics SolveStep(const Derivatives<Vec2d>& s, const Vec2d& change) {
  const double determinant = Determinant(s);
  return {change.cross(s.by_y) / determinant, s.by_x.cross(change) / determinant};
}

bool IsInTriangle(const Barycentrics& w, double slack) {
  return w.x >= -slack && w.y >= -slack && w.x + w.y <= 1 + slack;
}

// Two unit vectors that are perpendicular to a unit vector and to one another.
std::array<Vec3d, 2> Tangents(const Vec3d& n) {
  const Vec3d other = std::abs(n.x) < 0.6 ? Vec3d(1, 0, 0) : Vec3d(0, 1, 0);
  const Vec3d first = n.cross(other).normalized();
  return {first, n.cross(first)};
}

// The point of the triangle where the normal equals the half vector, by Newton's method.
std::optional<Barycentrics> FindPeak(const Projector& projector, const GlossyTriangle& t,
                                     const HighlightLight& light) {
  constexpr int kMaxSteps = 20;
  // For most triangles the first step, from the middle, leads so far outside that there is no peak.
  constexpr double kFirstSlack = 1;
  Barycentrics at(1.0 / 3, 1.0 / 3);
  for (int i = 0; i < kMaxSteps; ++i) {
    const auto tangents = Tangents(Interpolate(t.normals, at).normalized());
    const auto deviation = [&](const Barycentrics& w) {
      const Vec3d d = Deviation(projector, t, light, w);
      return Vec2d(d.dot(tangents[0]), d.dot(tangents[1]));
    };
    const Barycentrics step = SolveStep(Differentiate(deviation, at), -deviation(at));
    at += step;
    if (!IsInTriangle(at, kFirstSlack)) return std::nullopt;  // also if it is not finite
    if (step.length() < 1e-9) {
      // A peak on an edge may be found in two triangles. It does no harm: features of one light and
      // material are pooled.
      if (!IsInTriangle(at, 1e-9)) return std::nullopt;
      const Vec3d half = HalfVector(projector, light, Interpolate(t.corners, at));
      return Interpolate(t.normals, at).dot(half) > 0 ? std::optional(at) : std::nullopt;
    }
  }
  return std::nullopt;
}

// Whether the normal may equal the half vector anywhere in the triangle: false if they differ by
// more in the middle than they can change over the triangle. `turn` is the largest difference of a
// corner's normal from their mean.
bool MayHavePeak(const Projector& projector, const GlossyTriangle& t, const HighlightLight& light,
                 double turn) {
  const Barycentrics middle(1.0 / 3, 1.0 / 3);
  const Vec3d place = Interpolate(t.corners, middle);
  double extent = 0;
  for (const Vec3d& corner : t.corners) extent = std::max(extent, (corner - place).length());
  // The half vector turns by half as much as the directions to the eye and to the light.
  const double to_eye = projector.perspective ? place.length() : kInfiniteDistance;
  const double to_light = light.directional ? kInfiniteDistance : (light.position - place).length();
  const double nearer = std::min(to_eye, to_light);
  if (!(extent < nearer / 2)) return true;
  return Deviation(projector, t, light, middle).length() <= 2 * (turn + 2 * extent / nearer);
}

// Whether the triangle's projection comes within `margin` pixels of the window. False for a
// triangle that is not wholly in front of the camera.
bool IsNearWindow(const Projector& projector, const std::array<Vec3d, 3>& corners,
                  const Window& window, double margin) {
  Imath::Box2d box;
  for (const Vec3d& corner : corners) {
    if (!(corner.dot(projector.forward) > 0)) return false;
    const FilmPoint place = ProjectPoint(projector, corner);
    box.extendBy({place.x, place.y});
  }
  return box.max.x > window.x0 - margin && box.min.x < window.x1 + margin &&
         box.max.y > window.y0 - margin && box.min.y < window.y1 + margin;
}

class GlintFinder {
 public:
  GlintFinder(const SurfacePlan& surfaces, const HighlightCauses& causes, const CameraFrame& camera)
      : surfaces_(surfaces), causes_(causes), projector_(MakeProjector(camera)) {}

  void Find(const TriangleRef& triangle, uint32_t primitive, const Window& window, double margin,
            double max_area, std::vector<Glint>* glints) const {
    GlossyTriangle t{};
    t.primitive = primitive;
    const Scene& scene = *surfaces_.primitives.scene;
    for (size_t c = 0; c < 3; ++c) {
      t.corners[c] = triangle.mesh->positions[triangle.Vertex(c)] - scene.camera.position;
    }
    if (!IsNearWindow(projector_, t.corners, window, margin)) return;
    const Vec3d middle = Interpolate(t.corners, {1.0 / 3, 1.0 / 3});
    t.material = MaterialAt(surfaces_, primitive, ProjectPoint(projector_, middle).x).index;
    t.lobe = HalfVectorWidth(surfaces_, causes_, t.material);
    if (t.lobe == kInfiniteDistance) return;
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
    for (const HighlightLight& light : causes_.lights) {
      if (t.lobe == 0 && light.radius == 0) continue;
      if (MayHavePeak(projector_, t, light, turn)) Add(t, light, max_area, glints);
    }
  }

 private:
  void Add(const GlossyTriangle& t, const HighlightLight& light, double max_area,
           std::vector<Glint>* glints) const {
    const std::optional<Barycentrics> peak = FindPeak(projector_, t, light);
    if (!peak) return;
    const Vec3d place = Interpolate(t.corners, *peak);
    const auto tangents = Tangents(Interpolate(t.normals, *peak).normalized());
    const Derivatives<Vec2d> turns = Differentiate(
        [&](const Barycentrics& w) {
          const Vec3d d = Deviation(projector_, t, light, w);
          return Vec2d(d.dot(tangents[0]), d.dot(tangents[1]));
        },
        *peak);
    const auto on_film = [&](const Barycentrics& w) {
      const FilmPoint at = ProjectPoint(projector_, Interpolate(t.corners, w));
      return Vec2d(at.x, at.y);
    };
    const Derivatives<Vec2d> moves = Differentiate(on_film, *peak);
    const double of_light = HalfVectorTurn(light, (light.position - place).length());
    const double width2 = t.lobe * t.lobe + of_light * of_light;
    const double area = M_PI * width2 * std::abs(Determinant(moves) / Determinant(turns));
    if (!(area > 0 && area < max_area)) return;
    // A step of four half-widths along one of two perpendicular directions on the surface: the one
    // that is shorter on the film, towards the middle of the triangle.
    const double turn_length = 4 * std::sqrt(width2);
    const auto step = [&](const Vec2d& turn) {
      const Barycentrics w = SolveStep(turns, turn);
      return moves.by_x * w.x + moves.by_y * w.y;
    };
    const Vec2d one = step({turn_length, 0}), other = step({0, turn_length});
    const Vec2d at = on_film(*peak);
    const Vec2d inwards = on_film({1.0 / 3, 1.0 / 3}) - at;
    Vec2d beside = one.length2() < other.length2() ? one : other;
    if (beside.dot(inwards) < 0) beside = -beside;
    glints->push_back(
        {t.primitive, t.material, light.number, at.x, at.y, area, beside.x, beside.y});
  }

  const SurfacePlan& surfaces_;
  const HighlightCauses& causes_;
  Projector projector_;
};

}  // namespace

std::vector<Glint> FindMeshGlints(const Scene& scene, const SurfacePlan& surfaces,
                                  const HighlightCauses& causes, const CameraFrame& camera,
                                  const Window& window, double margin, double max_area,
                                  int threads) {
  constexpr size_t kAtOnce = 1 << 14;
  std::vector<Glint> glints;
  if (causes.lights.empty()) return glints;
  const GlintFinder finder(surfaces, causes, camera);
  for (size_t number = 0; number < scene.meshes.size(); ++number) {
    const Mesh& mesh = scene.meshes[number];
    if (InterpolatesRadiance(mesh)) continue;
    const auto first = static_cast<uint32_t>(scene.spheres.size()) +
                       surfaces.primitives.mesh_first_triangle[number];
    const size_t count = mesh.triangles.size() / 3;
    std::vector<std::vector<Glint>> found((count + kAtOnce - 1) / kAtOnce);
    ParallelFor(found.size(), threads, [&](size_t piece) {
      const size_t end = std::min(count, (piece + 1) * kAtOnce);
      for (size_t i = piece * kAtOnce; i < end; ++i) {
        const auto triangle = static_cast<uint32_t>(i);
        finder.Find({&mesh, number, triangle}, first + triangle, window, margin, max_area,
                    &found[piece]);
      }
    });
    for (const std::vector<Glint>& some : found) {
      glints.insert(glints.end(), some.begin(), some.end());
    }
  }
  std::ranges::stable_sort(glints, {}, &Glint::y);
  return glints;
}

}  // namespace nacre
