// SPDX-License-Identifier: Apache-2.0
#include "shading/user_model.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/error.h"
#include "base/float_mode.h"
#include "brdf/lobe_sampling.h"
#include "shading/lobe_width.h"

namespace nacre {
namespace {

UserBrdf::Vectors VectorsOf(const Soa3<double>& soa) {
  return {soa.x.data(), soa.y.data(), soa.z.data()};
}

UserBrdf::Vectors VectorsOf(const Vec3d& v) { return {&v.x, &v.y, &v.z}; }

UserBrdf::Values ValuesOf(Soa3<double>* soa) {
  return {soa->x.data(), soa->y.data(), soa->z.data()};
}

std::string InWords(const Vec3d& v) {
  return fmt::format("({:.6g}, {:.6g}, {:.6g})", v.x, v.y, v.z);
}

// Describes the directions of sample i of a batch, for an error message.
std::string Describe(const UserBrdf::Batch& batch, size_t i) {
  const auto at = [&](const UserBrdf::Vectors& v) {
    return v[0] == nullptr ? std::string("to be chosen") : InWords({v[0][i], v[1][i], v[2][i]});
  };
  return fmt::format("sample {} of {}: normal {}, to_view {}, to_light {}", i, batch.count,
                     at(batch.normal), at(batch.to_view), at(batch.to_light));
}

[[noreturn]] void Refuse(const UserBrdf& brdf, const std::string& what,
                         const UserBrdf::Batch& batch, size_t i, const char* hint) {
  throw Error(ExitCode::kUsage, "material \"" + brdf.name + "\"",
              what + " for " + Describe(batch, i), hint);
}

// The caller's functions run in the default floating-point modes, not in the renderer's, which
// flush denormals.
void Evaluate(const UserBrdf& brdf, const UserBrdf::Batch& batch, const UserBrdf::Values& rgb) {
  {
    const DefaultFloatMode mode;
    brdf.evaluate(batch, rgb);
  }
  for (const double* const channel : rgb) {
    for (size_t i = 0; i < batch.count; ++i) {
      if (std::isfinite(channel[i])) continue;
      Refuse(brdf, fmt::format("its function returned {}", channel[i]), batch, i,
             "a BRDF is a finite number, in 1/sr, wherever n.l and n.v are above 0");
    }
  }
}

void Sample(const UserBrdf& brdf, const UserBrdf::Batch& batch, const double* u, const double* v,
            const UserBrdf::Values& to_light) {
  {
    const DefaultFloatMode mode;
    brdf.sample(batch, u, v, to_light);
  }
  // The same tolerance as for the directions that Brdf takes.
  constexpr double kTolerance = 16 * 0x1p-24;
  for (size_t i = 0; i < batch.count; ++i) {
    const Vec3d at(to_light[0][i], to_light[1][i], to_light[2][i]);
    if (std::abs(at.length2() - 1) <= kTolerance) continue;
    Refuse(brdf, "its sampler returned " + InWords(at), batch, i, "directions are unit vectors");
  }
}

void Pdf(const UserBrdf& brdf, const UserBrdf::Batch& batch, double* pdf) {
  {
    const DefaultFloatMode mode;
    brdf.pdf(batch, pdf);
  }
  for (size_t i = 0; i < batch.count; ++i) {
    if (pdf[i] >= 0 && std::isfinite(pdf[i])) continue;
    Refuse(brdf, fmt::format("its pdf is {}", pdf[i]), batch, i,
           "a pdf is finite and not negative, per solid angle");
  }
}

// Hits gathered into arrays without gaps, for the caller's functions.
class Gathered {
 public:
  explicit Gathered(std::unique_ptr<UserRoom>* room) {
    if (!*room) *room = std::make_unique<UserRoom>();
    room_ = room->get();
  }

  size_t count() const { return count_; }
  size_t hit(size_t k) const { return room_->hit[k]; }
  double n_dot_l(size_t k) const { return room_->n_dot_l[k]; }
  Vec3d value(size_t k) const { return VectorAt(room_->value, k); }
  UserBrdf::Values values() const { return ValuesOf(&room_->value); }
  UserBrdf::Batch batch() const {
    return {count_, VectorsOf(room_->normal), VectorsOf(room_->to_view),
            VectorsOf(room_->to_light)};
  }
  UserBrdf::Batch batch_without_light() const {
    return {count_, VectorsOf(room_->normal), VectorsOf(room_->to_view), {}};
  }

  // Adds a hit, unless light or viewer is below the surface.
  void Add(size_t hit, const Vec3d& normal, const Vec3d& to_view, const Vec3d& to_light) {
    const double n_dot_l = normal.dot(to_light);
    if (!(n_dot_l > 0) || !(normal.dot(to_view) > 0)) return;
    SetVector(to_light, count_, &room_->to_light);
    room_->n_dot_l[count_] = n_dot_l;
    AddView(hit, normal, to_view);
  }
  void AddView(size_t hit, const Vec3d& normal, const Vec3d& to_view) {
    room_->hit[count_] = static_cast<uint32_t>(hit);
    SetVector(normal, count_, &room_->normal);
    SetVector(to_view, count_++, &room_->to_view);
  }

 private:
  UserRoom* room_;
  size_t count_ = 0;
};

// The exact direction to the light from hit i, computed as in sharp_lobe_kernel.cc.
Vec3d ToLight(const LitHits& lit, size_t i) {
  const ShadingLight& from = lit.light;
  if (from.form == LightForm::kDirectional) return from.to_light;
  const Vec3d offset = from.form == LightForm::kGiven
                           ? VectorAt(lit.on_hits->light_vector, i)
                           : from.position - VectorAt(lit.hits.position, i);
  const double length = offset.length();
  return length > 0 ? offset / length : offset;
}

void ClearRange(size_t begin, size_t end, Soa3<float>* soa) {
  for (float* plane : {soa->x.data(), soa->y.data(), soa->z.data()}) {
    std::fill(plane + begin, plane + end, 0.0f);
  }
}

}  // namespace

void ShadeUser(const UserModel& model, const LitHits& lit, ShadeScratch* scratch) {
  ReflectedRadiance& radiance = *lit.radiance;
  ClearRange(lit.begin, lit.end, &radiance.sum);
  Soa3<float>* component = nullptr;
  if (lit.components) {
    ClearRange(lit.begin, lit.end, &radiance.diffuse);
    ClearRange(lit.begin, lit.end, &radiance.specular);
    component = model.brdf->sample ? &radiance.specular : &radiance.diffuse;
  }
  Gathered gathered(&scratch->user);
  const LightBatch* on_hits = lit.on_hits;
  if (on_hits == nullptr) {
    EvaluateLight(lit.light, lit.hits, lit.surface, &scratch->user->light);
    on_hits = &scratch->user->light;
  }
  const AlignedArray<float>& irradiance = on_hits->irradiance;
  for (size_t i = lit.begin; i < lit.end; ++i) {
    if (!(irradiance[i] > 0)) continue;
    gathered.Add(i, VectorAt(lit.hits.normal, i), VectorAt(lit.hits.to_view, i), ToLight(lit, i));
  }
  if (gathered.count() == 0) return;
  Evaluate(*model.brdf, gathered.batch(), gathered.values());
  for (size_t k = 0; k < gathered.count(); ++k) {
    const size_t i = gathered.hit(k);
    const Vec3d reflected =
        Vec3d(lit.light.color) * gathered.value(k) * (gathered.n_dot_l(k) * double{irradiance[i]});
    SetVector(reflected, i, &radiance.sum);
    if (component != nullptr) SetVector(reflected, i, component);
  }
}

void SampleUser(const UserModel& model, const MaterialHits& at, const float* u, const float* v,
                ShadeScratch* scratch, Soa3<float>* to_light) {
  Gathered gathered(&scratch->user);
  UserRoom* const room = scratch->user.get();
  for (size_t i = at.begin; i < at.end; ++i) {
    const Vec3d normal = VectorAt(at.hits.normal, i), to_view = VectorAt(at.hits.to_view, i);
    if (!(normal.dot(to_view) > 0)) continue;
    room->u[gathered.count()] = u[i];
    room->v[gathered.count()] = v[i];
    gathered.AddView(i, normal, to_view);
  }
  if (gathered.count() == 0) return;
  Sample(*model.brdf, gathered.batch_without_light(), room->u.data(), room->v.data(),
         gathered.values());
  for (size_t k = 0; k < gathered.count(); ++k) {
    SetVector(gathered.value(k), gathered.hit(k), to_light);
  }
}

void UserPdf(const UserModel& model, const MaterialHits& at, const LightBatch& light,
             ShadeScratch* scratch, float* pdf) {
  Gathered gathered(&scratch->user);
  for (size_t i = at.begin; i < at.end; ++i) {
    pdf[i] = 0;
    if (!(light.irradiance[i] > 0)) continue;
    const Vec3d to_light = VectorAt(light.light_vector, i);
    gathered.Add(i, VectorAt(at.hits.normal, i), VectorAt(at.hits.to_view, i),
                 to_light / to_light.length());
  }
  if (gathered.count() == 0) return;
  Pdf(*model.brdf, gathered.batch(), scratch->user->u.data());
  for (size_t k = 0; k < gathered.count(); ++k) {
    pdf[gathered.hit(k)] = static_cast<float>(scratch->user->u[k]);
  }
}

Reflection ReflectUser(const UserModel& model, const Vec3d& normal, const Vec3d& to_light,
                       const Vec3d& to_view) {
  Vec3d rgb;
  Evaluate(*model.brdf, {1, VectorsOf(normal), VectorsOf(to_view), VectorsOf(to_light)},
           {&rgb.x, &rgb.y, &rgb.z});
  const Rgb reflected = Rgb(rgb) * normal.dot(to_light);
  return model.brdf->sample ? Reflection{Rgb(0), reflected} : Reflection{reflected, Rgb(0)};
}

Vec3d SampleUser(const UserModel& model, const Vec3d& normal, const Vec3d& to_view, double u0,
                 double u1) {
  if (!model.brdf->sample) return SampleCosine(normal, u0, u1);
  if (!((normal ^ to_view) > 0)) return normal;
  Vec3d to_light;
  Sample(*model.brdf, {1, VectorsOf(normal), VectorsOf(to_view), {}}, &u0, &u1,
         {&to_light.x, &to_light.y, &to_light.z});
  return to_light;
}

double UserPdf(const UserModel& model, const Vec3d& normal, const Vec3d& to_view,
               const Vec3d& to_light) {
  if (!model.brdf->pdf) return CosinePdf(normal ^ to_light);
  if (!((normal ^ to_light) > 0) || !((normal ^ to_view) > 0)) return 0;
  double pdf = 0;
  Pdf(*model.brdf, {1, VectorsOf(normal), VectorsOf(to_view), VectorsOf(to_light)}, &pdf);
  return pdf;
}

double UserLobeWidth(const UserModel& model) {
  const auto room = std::make_unique<UserRoom>();
  return FindLobeWidth([&](const LobeWidthPairs& pairs, auto* values) {
    for (size_t k = 0; k < pairs.to_light.size(); ++k) {
      SetVector(pairs.normal, k, &room->normal);
      SetVector(pairs.to_view, k, &room->to_view);
      SetVector(pairs.to_light[k], k, &room->to_light);
    }
    Evaluate(*model.brdf,
             {pairs.to_light.size(), VectorsOf(room->normal), VectorsOf(room->to_view),
              VectorsOf(room->to_light)},
             ValuesOf(&room->value));
    for (size_t k = 0; k < values->size(); ++k) (*values)[k] = VectorAt(room->value, k);
  });
}

}  // namespace nacre
