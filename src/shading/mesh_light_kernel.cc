// SPDX-License-Identifier: Apache-2.0
// shading/mesh_light_kernel.cc: directions to lights made of triangles, and what is met along
// directions. Triangles are chosen, and found, hit by hit; what follows of them runs on vectors.
#include <algorithm>
#include <array>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shading/mesh_light_kernel.cc"
#include "hwy/foreach_target.h"

#include "hwy/highway.h"

#include "base/target_ops-inl.h"
#include "light/irradiance-inl.h"
#include "shading/mesh_light_kernel.h"
#include "shading/soa-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::ScalableTag<float>;
using V = hn::Vec<D>;

HWY_INLINE TriangleLightV<V> TriangleAt(const SeenTriangles& seen, size_t i) {
  const D d;
  return {LoadSoa(d, seen.corner, i), LoadSoa(d, seen.edge_x, i), LoadSoa(d, seen.edge_y, i)};
}

void SampleSeenT(const SeenTriangles& seen, size_t count, const float* u, const float* v,
                 Soa3<float>* to_light) {
  const D d;
  for (size_t i = 0; i < count; i += hn::Lanes(d)) {
    const AreaSampleV<V> sample =
        SampleLight(d, TriangleAt(seen, i), hn::LoadU(d, u + i), hn::LoadU(d, v + i));
    StoreSoa(d, sample.to_light, i, to_light);
  }
}

void SeenDensityT(const SeenTriangles& seen, size_t count, const Soa3<float>& to_light,
                  float* density) {
  const D d;
  for (size_t i = 0; i < count; i += hn::Lanes(d)) {
    hn::StoreU(DensityInside(d, TriangleAt(seen, i), LoadSoa(d, to_light, i)), d, density + i);
  }
}

HWY_INLINE Vec3V<V> Set3(const Vec3d& v) {
  const D d;
  return {hn::Set(d, static_cast<float>(v.x)), hn::Set(d, static_cast<float>(v.y)),
          hn::Set(d, static_cast<float>(v.z))};
}

// The sum of the triangles that emit towards each hit.
void MeshIrradianceT(const SampledLight& light, const HitBatch& hits, const Surface& surface,
                     float* irradiance) {
  const D d;
  const V zero = hn::Zero(d);
  for (size_t i = 0; i < hits.count; i += hn::Lanes(d)) {
    const Vec3V<V> normal = LoadSoa(d, surface.normal, i);
    V sum = zero;
    for (const TriangleLight<double>& triangle : light.mesh->triangles) {
      const Vec3d corner = light.place + triangle.corner;
      const TriangleLightV<V> seen{{SubtractAndRound(d, corner.x, hits.position.x.data() + i),
                                    SubtractAndRound(d, corner.y, hits.position.y.data() + i),
                                    SubtractAndRound(d, corner.z, hits.position.z.data() + i)},
                                   Set3(triangle.edge_x),
                                   Set3(triangle.edge_y)};
      const V value = hn::Max(Irradiance(d, seen, normal), zero);
      const V height = FusedDot(seen.corner, Set3(triangle.edge_x % triangle.edge_y));
      const auto front = hn::Lt(height, zero);
      sum = hn::Add(sum, light.two_sided ? value : hn::IfThenElseZero(front, value));
    }
    hn::StoreU(sum, d, irradiance + i);
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nacre {
HWY_EXPORT(SampleSeenT);
HWY_EXPORT(SeenDensityT);
HWY_EXPORT(MeshIrradianceT);

namespace {

Vec3d At(const Soa3<double>& soa, size_t i) { return {soa.x[i], soa.y[i], soa.z[i]}; }

void Put(const Vec3d& v, size_t i, Soa3<float>* to) {
  to->x[i] = static_cast<float>(v.x);
  to->y[i] = static_cast<float>(v.y);
  to->z[i] = static_cast<float>(v.z);
}

// The triangle as hit `hit` sees it: the way there formed in double.
void PutTriangle(const SampledLight& light, const HitBatch& hits, uint32_t triangle, size_t hit,
                 size_t i, SeenTriangles* seen) {
  const TriangleLight<double>& t = light.mesh->triangles[triangle];
  Put(light.place + t.corner - At(hits.position, hit), i, &seen->corner);
  Put(t.edge_x, i, &seen->edge_x);
  Put(t.edge_y, i, &seen->edge_y);
}

// Adds up the densities of triangles along the directions of hits, in batches.
class DensitySum {
 public:
  DensitySum(const SampledLight& light, const HitBatch& hits, LightDirections* directions)
      : light_(light), hits_(hits), directions_(*directions) {}

  void Add(size_t hit, uint32_t triangle) {
    if (count_ == kBatchCapacity) Flush();
    PutTriangle(light_, hits_, triangle, hit, count_, &seen_);
    const Soa3<float>& l = directions_.to_light;
    to_light_.x[count_] = l.x[hit];
    to_light_.y[count_] = l.y[hit];
    to_light_.z[count_] = l.z[hit];
    hit_[count_] = static_cast<uint32_t>(hit);
    probability_[count_] = static_cast<float>(light_.mesh->probabilities[triangle]);
    ++count_;
  }

  void Flush() {
    HWY_DYNAMIC_DISPATCH(SeenDensityT)(seen_, count_, to_light_, density_.data());
    for (size_t i = 0; i < count_; ++i) {
      directions_.density[hit_[i]] += probability_[i] * density_[i];
    }
    count_ = 0;
  }

 private:
  const SampledLight& light_;
  const HitBatch& hits_;
  LightDirections& directions_;
  SeenTriangles seen_;
  Soa3<float> to_light_;
  AlignedArray<float> density_{kBatchCapacity}, probability_{kBatchCapacity};
  AlignedArray<uint32_t> hit_{kBatchCapacity};
  size_t count_ = 0;
};

}  // namespace

void SampleMesh(const SampledLight& light, const HitBatch& hits, const UnitPoints& points,
                LightDirections* directions) {
  SeenTriangles seen;
  AlignedArray<float> rest{kBatchCapacity};
  for (size_t i = 0; i < hits.count; ++i) {
    const CdfPick pick = PickIndex(light.mesh->by_area, points.u_bits[i] * 0x1p-32);
    PutTriangle(light, hits, pick.index, i, i, &seen);
    rest[i] = std::min(static_cast<float>(pick.rest), 1 - 0x1p-24f);
  }
  HWY_DYNAMIC_DISPATCH(SampleSeenT)
  (seen, hits.count, rest.data(), points.v.data(), &directions->to_light);
  FindMesh(light, hits, directions);
}

void FindMesh(const SampledLight& light, const HitBatch& hits, LightDirections* directions) {
  const MeshLight& mesh = *light.mesh;
  DensitySum sum(light, hits, directions);
  std::vector<MeshLightMeeting> meetings;
  for (size_t i = 0; i < hits.count; ++i) {
    const Soa3<float>& l = directions->to_light;
    const Vec3d direction(l.x[i], l.y[i], l.z[i]);
    directions->distance[i] = directions->density[i] = 0;
    FindMeetings(mesh, At(hits.position, i) - light.place, direction, &meetings);
    if (meetings.empty()) continue;
    const auto nearest = std::min_element(meetings.begin(), meetings.end(),
                                          [](const auto& a, const auto& b) { return a.t < b.t; });
    const TriangleLight<double>& seen = mesh.triangles[nearest->triangle];
    const bool front = (direction ^ (seen.edge_x % seen.edge_y)) < 0;
    if (!front && !light.two_sided) continue;
    directions->distance[i] = static_cast<float>(nearest->t * direction.length());
    for (const MeshLightMeeting& meeting : meetings) sum.Add(i, meeting.triangle);
  }
  sum.Flush();
}

void MeshIrradiance(const SampledLight& light, const HitBatch& hits, const Surface& surface,
                    float* irradiance) {
  HWY_DYNAMIC_DISPATCH(MeshIrradianceT)(light, hits, surface, irradiance);
}

}  // namespace nacre
#endif
