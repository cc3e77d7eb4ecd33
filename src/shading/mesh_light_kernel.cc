// SPDX-License-Identifier: Apache-2.0
// shading/mesh_light_kernel.cc: directions to mesh lights, and the triangles that directions meet.
// Triangles are chosen hit by hit, and those that directions meet are gathered into batches of
// their own; all else runs on vectors.
#include <algorithm>
#include <array>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shading/mesh_light_kernel.cc"
#include "hwy/foreach_target.h"

#include "hwy/highway.h"

#include "light/mesh_light-inl.h"
#include "shading/area_light_view-inl.h"
#include "shading/mesh_light_kernel.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::ScalableTag<float>;
using V = hn::Vec<D>;

HWY_INLINE TriangleLightV<V> TriangleAt(const TriangleBatch& seen, size_t i) {
  const D d;
  return {LoadSoa(d, seen.corner, i), LoadSoa(d, seen.edge_x, i), LoadSoa(d, seen.edge_y, i)};
}

void SampleTrianglesT(const TriangleBatch& seen, size_t count, const float* u, const float* v,
                      Soa3<float>* to_light) {
  const D d;
  for (size_t i = 0; i < count; i += hn::Lanes(d)) {
    const AreaSampleV<V> sample =
        SampleLight(d, TriangleAt(seen, i), hn::LoadU(d, u + i), hn::LoadU(d, v + i));
    StoreSoa(d, sample.to_light, i, to_light);
  }
}

void TrianglePdfT(const TriangleBatch& seen, size_t count, const Soa3<float>& to_light,
                  float* pdf) {
  const D d;
  for (size_t i = 0; i < count; i += hn::Lanes(d)) {
    hn::StoreU(PdfInside(d, TriangleAt(seen, i), LoadSoa(d, to_light, i)), d, pdf + i);
  }
}

// The irradiance at hits i..., as a sum over the triangles that emit towards them.
HWY_INLINE V SumTriangles(const SampledLight& light, const HitBatch& hits, const Vec3V<V>& normal,
                          size_t i) {
  const D d;
  const V zero = hn::Zero(d);
  const MeshLight& mesh = *light.mesh;
  const double by_area = ByArea(light);
  V sum = zero;
  for (size_t k = 0; k < mesh.triangles.size(); ++k) {
    const TriangleLightV<V> seen = TriangleFrom(light, hits, k, i);
    const auto front = hn::Lt(FusedDot(seen.corner, SetVec3(D(), mesh.crosses[k] * by_area)), zero);
    if (!light.two_sided && hn::AllFalse(d, front)) continue;
    const V value = hn::Max(Irradiance(d, seen, normal), zero);
    sum = hn::Add(sum, light.two_sided ? value : hn::IfThenElseZero(front, value));
  }
  return sum;
}

// The irradiance at hits i..., from the outline of the mesh.
HWY_INLINE V SumOutline(const SampledLight& light, const HitBatch& hits, const Vec3V<V>& normal,
                        size_t i) {
  EmittingFaces faces;
  FindFaces(light, hits, i, &faces);
  return OutlineIrradiance(light, hits, i, faces, normal,
                           [](const Vec3V<V>& offset) HWY_ATTR { return offset; });
}

void MeshIrradianceT(const SampledLight& light, const HitBatch& hits, const Surface& surface,
                     float* irradiance) {
  const D d;
  const bool by_outline = !light.mesh->outline.edges.empty();
  for (size_t i = 0; i < hits.count; i += hn::Lanes(d)) {
    const Vec3V<V> normal = LoadSoa(d, surface.normal, i);
    hn::StoreU(
        by_outline ? SumOutline(light, hits, normal, i) : SumTriangles(light, hits, normal, i), d,
        irradiance + i);
  }
}

using DD = hn::ScalableTag<double>;
using VD = hn::Vec<DD>;

// Finds all triangles that the ray of hit i meets. Stores where it meets the nearest one (infinity
// if it meets none), and the dot product of its direction and that triangle's normal.
HWY_INLINE void MeetTriangles(const MeshLight& mesh, const LightBoxRays& boxes, size_t lane,
                              const Vec3d& point, const Vec3d& direction, size_t i,
                              MeshLightScratch* scratch) {
  double nearest = std::numeric_limits<double>::infinity(), nearest_towards = 0;
  ForEachMeshLightHit(mesh, boxes, lane, point, direction,
                      [&](uint32_t triangle, double t, double towards) HWY_ATTR {
                        scratch->meetings.Add({static_cast<uint32_t>(i), triangle});
                        if (!(t < nearest)) return;
                        nearest = t;
                        nearest_towards = towards;
                      });
  scratch->end[i] = nearest;
  scratch->towards[i] = nearest_towards;
}

void MeetMeshT(const SampledLight& light, const HitBatch& hits, const Soa3<float>& to_light,
               float* distance, MeshLightScratch* scratch) {
  const DD d;
  const VD zero = hn::Zero(d), infinity = hn::Set(d, std::numeric_limits<double>::infinity());
  scratch->meetings.count = 0;
  LightBoxRays boxes;
  for (size_t i = 0; i < hits.count; i += hn::Lanes(d)) {
    const Vec3V<VD> point = Sub(LoadSoa(d, hits.position, i), SetVec3(d, light.place));
    const Vec3V<VD> direction = PromoteSoa(d, to_light, i);
    hn::StoreU(infinity, d, scratch->end.data() + i);
    alignas(8) uint8_t bits[8] = {};
    hn::StoreMaskBits(d, MakeLightBoxRays(d, *light.mesh, point, direction, &boxes), bits);
    for (uint32_t lanes = bits[0]; lanes != 0; lanes &= lanes - 1) {
      const size_t lane = hwy::Num0BitsBelowLS1Bit_Nonzero32(lanes);
      const size_t hit = i + lane;
      if (hit >= hits.count) break;
      MeetTriangles(*light.mesh, boxes, lane, VectorAt(hits.position, hit) - light.place,
                    VectorAt(to_light, hit), hit, scratch);
    }
    const VD nearest = hn::LoadU(d, scratch->end.data() + i);
    const auto met = hn::Lt(nearest, infinity);
    const auto front = hn::Lt(hn::LoadU(d, scratch->towards.data() + i), zero);
    const auto seen = light.two_sided ? met : hn::And(met, front);
    const VD length = hn::Sqrt(Dot(direction, direction));
    const VD away = hn::IfThenElseZero(seen, hn::Mul(hn::IfThenElseZero(met, nearest), length));
    hn::StoreU(hn::DemoteTo(hn::Rebind<float, DD>(), away), hn::Rebind<float, DD>(), distance + i);
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nacre {
HWY_EXPORT(SampleTrianglesT);
HWY_EXPORT(TrianglePdfT);
HWY_EXPORT(MeshIrradianceT);
HWY_EXPORT(MeetMeshT);

namespace {

// Sets entry i to a triangle relative to a hit; the offset is computed in double.
void SetTriangle(const SampledLight& light, const HitBatch& hits, uint32_t triangle, size_t hit,
                 size_t i, TriangleBatch* seen) {
  const TriangleLight<double>& t = light.mesh->triangles[triangle];
  SetVector(light.place + t.corner - VectorAt(hits.position, hit), i, &seen->corner);
  SetVector(t.edge_x, i, &seen->edge_x);
  SetVector(t.edge_y, i, &seen->edge_y);
}

// Adds up, for each hit, the pdfs of triangles along its direction. Computes them in batches.
class PdfSum {
 public:
  PdfSum(const SampledLight& light, const HitBatch& hits, LightDirections* directions)
      : light_(light), hits_(hits), directions_(*directions), scratch_(*directions->mesh) {}

  void Add(size_t hit, uint32_t triangle) {
    if (count_ == kBatchCapacity) Flush();
    SetTriangle(light_, hits_, triangle, hit, count_, &scratch_.seen);
    SetVector(VectorAt(directions_.to_light, hit), count_, &scratch_.to_light);
    scratch_.hit[count_] = static_cast<uint32_t>(hit);
    scratch_.probability[count_] = static_cast<float>(light_.mesh->probabilities[triangle]);
    ++count_;
  }

  void Flush() {
    HWY_DYNAMIC_DISPATCH(TrianglePdfT)
    (scratch_.seen, count_, scratch_.to_light, scratch_.pdf.data());
    for (size_t i = 0; i < count_; ++i) {
      directions_.pdf[scratch_.hit[i]] += scratch_.probability[i] * scratch_.pdf[i];
    }
    count_ = 0;
  }

 private:
  const SampledLight& light_;
  const HitBatch& hits_;
  LightDirections& directions_;
  MeshLightScratch& scratch_;
  size_t count_ = 0;
};

void MakeScratch(LightDirections* directions) {
  if (!directions->mesh) directions->mesh = std::make_shared<MeshLightScratch>();
}

}  // namespace

void SampleMesh(const SampledLight& light, const HitBatch& hits, const UnitPoints& points,
                LightDirections* directions) {
  MakeScratch(directions);
  MeshLightScratch& scratch = *directions->mesh;
  for (size_t i = 0; i < hits.count; ++i) {
    const CdfPick pick = PickIndex(light.mesh->by_area, points.u_bits[i] * 0x1p-32);
    SetTriangle(light, hits, pick.index, i, i, &scratch.seen);
    scratch.rest[i] = std::min(static_cast<float>(pick.remapped), 1 - 0x1p-24f);
  }
  HWY_DYNAMIC_DISPATCH(SampleTrianglesT)
  (scratch.seen, hits.count, scratch.rest.data(), points.v.data(), &directions->to_light);
  FindMesh(light, hits, directions);
}

void FindMesh(const SampledLight& light, const HitBatch& hits, LightDirections* directions) {
  MakeScratch(directions);
  HWY_DYNAMIC_DISPATCH(MeetMeshT)
  (light, hits, directions->to_light, directions->distance.data(), directions->mesh.get());
  std::fill_n(directions->pdf.data(), hits.count, 0.0f);
  PdfSum sum(light, hits, directions);
  const CrossedTriangles& meetings = directions->mesh->meetings;
  for (size_t i = 0; i < meetings.count; ++i) {
    const CrossedTriangle& meeting = meetings.entries[i];
    if (directions->distance[meeting.hit] > 0) sum.Add(meeting.hit, meeting.triangle);
  }
  sum.Flush();
}

void MeshEnds(size_t count, const LightDirections& directions, AlignedArray<double>* t_max) {
  const AlignedArray<double>& end = directions.mesh->end;
  for (size_t i = 0; i < count; ++i) (*t_max)[i] = (*t_max)[i] > 0 ? end[i] : 0;
}

void MeshIrradiance(const SampledLight& light, const HitBatch& hits, const Surface& surface,
                    float* irradiance) {
  HWY_DYNAMIC_DISPATCH(MeshIrradianceT)(light, hits, surface, irradiance);
}

}  // namespace nacre
#endif
