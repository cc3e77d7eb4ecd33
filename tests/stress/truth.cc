// SPDX-License-Identifier: Apache-2.0
#include "stress/truth.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "base/parallel.h"
#include "stress/truth_reflect.h"

namespace nacre {
namespace {

using Real = TruthReal;
using Vec = TruthVec;

constexpr Real kInfinity = std::numeric_limits<Real>::infinity();
constexpr Real kHalfUlpDouble = 0x1p-53L;

Vec ToTruth(const Vec3d& v) { return {v.x, v.y, v.z}; }
Vec3d ToDouble(const Vec& v) {
  return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
}
Rgb ToRgb(const Vec& v) {
  return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
}

struct Line {
  Vec origin, direction;
};

// Where a line meets a sphere: twice, at t = near <= far, if clearance >= 0.
struct Meeting {
  Real clearance;  // (radius^2 - p^2) / radius^2, p the distance of the line from the centre
  Real closest;    // t of the point nearest to the centre
  Real near, far;
  Vec to_near, to_far;  // from the centre, of length radius
  // What rounding the ray and the centre to double can do, relative to the radius.
  Real input_error;
};

Meeting Meet(const Line& line, const Sphere& sphere) {
  const Vec m = ToTruth(sphere.center) - line.origin;
  const Vec& d = line.direction;
  const Real radius = sphere.radius;
  const Real dd = d.dot(d);
  Meeting meeting{};
  meeting.closest = m.dot(d) / dd;
  const Vec p = m - d * meeting.closest;
  meeting.clearance = (radius - p.length()) * (radius + p.length()) / (radius * radius);
  meeting.input_error = 16 * kHalfUlpDouble * (m.length() + radius) / radius;
  if (meeting.clearance < 0) return meeting;
  const Real half = radius * std::sqrt(meeting.clearance / dd);
  meeting.to_near = -p - d * half;
  meeting.to_far = -p + d * half;
  // Their product does not cancel for the root near the origin, as closest - half would.
  const Real larger = meeting.closest + std::copysign(half, meeting.closest);
  const Real smaller = (m.length() - radius) * (m.length() + radius) / dd / larger;
  meeting.near = std::min(larger, smaller);
  meeting.far = std::max(larger, smaller);
  return meeting;
}

bool AtLimb(const Meeting& m) {
  return std::abs(m.clearance) < std::max(Real{1e-12L}, 4 * m.input_error);
}

// How far t can be off, times the direction's length.
Real DepthError(const Meeting& m, const Sphere& sphere) {
  return m.input_error * sphere.radius / std::sqrt(std::max(m.clearance, m.input_error));
}

bool SameSphere(const Sphere& a, const Sphere& b) {
  return a.center == b.center && a.radius == b.radius;
}

struct FirstHit {
  const Sphere* sphere = nullptr;
  Real t = kInfinity;
  Real error = 0;  // of the position
  Vec from_center;
  bool inside = false;
  uint8_t doubt = kCertain;
};

FirstHit FindFirst(const Scene& scene, const Line& line) {
  const Real length = line.direction.length();
  FirstHit first;
  for (const Sphere& sphere : scene.spheres) {
    const Meeting m = Meet(line, sphere);
    if (m.clearance < 0) continue;
    const bool inside = m.near <= 0;
    const Real t = inside ? m.far : m.near;
    if (t <= 0 || t >= first.t) continue;
    first = {&sphere, t, DepthError(m, sphere), inside ? m.to_far : m.to_near, inside, kCertain};
  }
  // Whether it is in doubt that this sphere, and no other, comes first.
  for (const Sphere& sphere : scene.spheres) {
    const Meeting m = Meet(line, sphere);
    const Real slack = (DepthError(m, sphere) + first.error) / length;
    if (AtLimb(m)) {
      if (m.closest > -slack && m.closest < first.t + slack) first.doubt |= kLimb;
      continue;
    }
    if (m.clearance < 0) continue;
    for (const Real t : {m.near, m.far}) {
      // An eye that lies on the sphere in exact numbers does so for everybody.
      if (t != 0 && std::abs(t) < slack) first.doubt |= kDepth;
      const bool other = first.sphere != nullptr && !SameSphere(sphere, *first.sphere);
      if (other && std::abs(t - first.t) < slack) first.doubt |= kDepth;
    }
  }
  return first;
}

enum class Shadow : uint8_t { kLit, kDark, kDoubtful };

// Whether anything lies at 0 < t < t_max on a line that starts on the sphere `own`.
Shadow CastShadow(const Scene& scene, const Line& line, Real t_max, const Sphere& own,
                  Real start_error) {
  const Real length = line.direction.length();
  bool doubtful = false;
  for (const Sphere& sphere : scene.spheres) {
    const Meeting m = Meet(line, sphere);
    if (SameSphere(sphere, own)) {
      // One root is the start itself. Outward rays never come back.
      if (m.closest > 0 && 2 * m.closest < t_max) return Shadow::kDark;
      continue;
    }
    const Real slack = (DepthError(m, sphere) + start_error +
                        4 * kHalfUlpDouble * (line.origin.length() + length)) /
                       length;
    const Real limb = std::max({Real{2e-9L}, 4 * m.input_error, 4 * start_error / sphere.radius});
    if (std::abs(m.clearance) < limb) {
      doubtful |= m.closest > -slack && m.closest < t_max + slack;
      continue;
    }
    if (m.clearance < 0) continue;
    bool near_end = false;
    for (const Real t : {m.near, m.far}) {
      near_end |= std::abs(t) < slack || std::abs(t - t_max) < slack;
    }
    const Real t = m.near > 0 ? m.near : m.far;
    const bool dark = t > 0 && t < t_max;
    if (dark && !near_end) return Shadow::kDark;
    doubtful |= near_end;
  }
  return doubtful ? Shadow::kDoubtful : Shadow::kLit;
}

struct Arrival {
  Vec offset;           // to the light, or along its direction
  Real t_max = 1;       // of the offset, where the light is
  Real irradiance = 0;  // perpendicular to it, per unit of its colour
  Rgb color;
};

Real FallOff(const Attenuation& a, Real d) {
  return d > 0 ? 1 / (a.constant + a.linear * d + a.quadratic * d * d) : 0;
}

Real ConeFactor(const SpotLight& spot, Real cosine) {
  const Real degree = std::acos(Real{-1}) / 180;
  const Real cutoff = std::cos(spot.cutoff_deg * degree);
  const Real inner = std::cos(spot.inner_deg * degree);
  if (cosine <= cutoff) return 0;
  const Real edge = cosine < inner ? (cosine - cutoff) / (inner - cutoff) : 1;
  const Real axis = spot.exponent == 0 ? 1 : std::pow(std::max(cosine, Real{0}), spot.exponent);
  return axis * edge * edge * (3 - 2 * edge);
}

Arrival Arrive(const Light& light, const Vec& position) {
  if (const auto* sun = std::get_if<DirectionalLight>(&light.kind)) {
    return {-ToTruth(sun->direction_of_travel).normalized(), kInfinity, 1, sun->irradiance};
  }
  if (const auto* point = std::get_if<PointLight>(&light.kind)) {
    const Vec offset = ToTruth(point->position) - position;
    return {offset, 1, FallOff(point->attenuation, offset.length()), point->intensity};
  }
  const auto& spot = std::get<SpotLight>(light.kind);
  const Vec offset = ToTruth(spot.position) - position;
  const Real cosine = -offset.normalized().dot(ToTruth(spot.direction_of_travel).normalized());
  return {offset, 1, FallOff(spot.attenuation, offset.length()) * ConeFactor(spot, cosine),
          spot.intensity};
}

const Material& MaterialOf(const Scene& scene, MaterialId id, Real film_x, uint32_t* index) {
  const Material* material = &scene.materials[id.index];
  if (const auto* split = std::get_if<SplitMaterial>(&material->model)) {
    size_t band = 0;
    while (band < split->at.size() && film_x / scene.image.width >= split->at[band]) ++band;
    id = split->materials[band];
    material = &scene.materials[id.index];
  }
  *index = id.index;
  return *material;
}

// Adds up all lights at a hit.
void Shade(const Scene& scene, const Line& line, const FirstHit& hit, const Material& material,
           TruthPixel* pixel) {
  const Vec normal = hit.from_center.normalized() * Real{hit.inside ? -1.0L : 1.0L};
  const Vec position = ToTruth(hit.sphere->center) + hit.from_center;
  const Vec to_view = -line.direction.normalized();
  Vec radiance(material.emission.x, material.emission.y, material.emission.z);
  Vec scale = radiance;
  for (const Light& light : scene.lights) {
    if (const auto* ambient = std::get_if<AmbientLight>(&light.kind)) {
      const Rgb& sky = ambient->radiance;
      const Vec reflected = AmbientTruth(material) * Vec(sky.x, sky.y, sky.z);
      radiance += reflected;
      scale += reflected;
      continue;
    }
    const Arrival arrival = Arrive(light, position);
    const Vec to_light = arrival.offset.normalized();
    const Real n_dot_l = normal.dot(to_light);
    if (std::abs(n_dot_l) < Real{kTerminatorCosine} + hit.error / arrival.offset.length()) {
      pixel->doubt |= kTerminator;
    }
    if (n_dot_l <= 0) continue;
    if (light.shadows && scene.image.shadows) {
      const Shadow shadow =
          CastShadow(scene, {position, arrival.offset}, arrival.t_max, *hit.sphere, hit.error);
      if (shadow == Shadow::kDoubtful) pixel->doubt |= kShadowEdge;
      if (shadow != Shadow::kLit) continue;
    }
    const TruthReflection reflection = ReflectTruth(material, normal, to_light, to_view);
    const Rgb& color = arrival.color;
    const Vec added = (reflection.diffuse + reflection.specular) * Vec(color.x, color.y, color.z) *
                      arrival.irradiance;
    radiance += added;
    scale += added * std::max(Real{1}, Real{kGrazingCosine} / n_dot_l);
  }
  pixel->normal = ToDouble(normal);
  pixel->radiance = ToRgb(radiance);
  pixel->scale = ToRgb(scale);
}

struct View {
  Vec position, right, up, forward;
  Real pixel;  // side of a pixel at distance 1, or in world units
};

View MakeView(const Scene& scene) {
  const Camera& camera = scene.camera;
  View view{};
  view.position = ToTruth(camera.position);
  view.forward = (ToTruth(camera.look_at) - view.position).normalized();
  view.right = view.forward.cross(ToTruth(camera.up)).normalized();
  view.up = view.right.cross(view.forward);
  const Real degree = std::acos(Real{-1}) / 180;
  const Real height = camera.projection == Projection::kPerspective
                          ? 2 * std::tan(camera.fov_y_deg * degree / 2)
                          : Real{camera.height};
  view.pixel = height / scene.image.height;
  return view;
}

TruthPixel RenderPixel(const Scene& scene, const View& view, int x, int y) {
  const Real film_x = x + Real{0.5};
  const Vec across = view.right * ((film_x - Real{0.5} * scene.image.width) * view.pixel) +
                     view.up * ((Real{0.5} * scene.image.height - y - Real{0.5}) * view.pixel);
  const bool perspective = scene.camera.projection == Projection::kPerspective;
  const Line line = perspective ? Line{view.position, view.forward + across}
                                : Line{view.position + across, view.forward};
  const FirstHit hit = FindFirst(scene, line);
  TruthPixel pixel;
  pixel.doubt = hit.doubt;
  if (hit.sphere == nullptr) {
    pixel.radiance = pixel.scale = scene.background;
    return pixel;
  }
  pixel.object = 1 + static_cast<uint32_t>(hit.sphere - scene.spheres.data());
  pixel.depth = static_cast<double>(hit.t);  // the direction is one long along the view
  const Material& material = MaterialOf(scene, hit.sphere->material, film_x, &pixel.material);
  Shade(scene, line, hit, material, &pixel);
  return pixel;
}

}  // namespace

TruthPicture RenderTruth(const Scene& scene, int threads) {
  if (!scene.meshes.empty()) throw std::invalid_argument("the truth knows spheres only");
  const View view = MakeView(scene);
  TruthPicture picture{scene.image.width, scene.image.height, {}};
  const auto width = static_cast<size_t>(picture.width);
  picture.pixels.resize(width * static_cast<size_t>(picture.height));
  ParallelFor(static_cast<size_t>(picture.height), threads, [&](size_t y) {
    for (size_t x = 0; x < width; ++x) {
      picture.pixels[y * width + x] =
          RenderPixel(scene, view, static_cast<int>(x), static_cast<int>(y));
    }
  });
  return picture;
}

}  // namespace nacre
