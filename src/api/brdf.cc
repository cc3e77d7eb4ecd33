// SPDX-License-Identifier: Apache-2.0
// api/brdf.cc: reflection models of the public API, evaluated in double and by the SIMD kernels.
#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include "api/scene_impl.h"
#include "api/table.h"
#include "base/float_mode.h"
#include "brdf/fresnel.h"
#include "brdf/ggx.h"
#include "shading/bsdf.h"
#include "shading/scalar_bsdf.h"
#include "shading/share.h"
#include "table/brdf_table.h"
#include "table/check_table.h"
#include "table/read_table.h"

namespace nacre::v0 {

struct Brdf::Impl {
  ShadingMaterial material;
  nacre::Material source;  // what it was prepared from
};

namespace {

struct Prepared {
  ShadingMaterial material;
  nacre::Material source;
};

Prepared Prepare(const Scene& scene, const std::string& name) {
  const std::shared_ptr<const nacre::Scene> made = scene.impl().Made();
  for (const nacre::Material& material : made->materials) {
    if (material.name != name) continue;
    // Maps need a place on a shape; without one, the model has its constant factors only.
    ShadingMaterial prepared = PrepareWithoutMaps(material);
    if (std::holds_alternative<std::monostate>(prepared.model)) {
      throw nacre::Error(ExitCode::kUsage, "Brdf", "\"" + name + "\" is a split",
                         "name one of the materials that it chooses from");
    }
    return {std::move(prepared), material};
  }
  throw nacre::Error(
      ExitCode::kUsage, "Brdf", "unknown material \"" + name + "\"",
      NearestHint(name, NamesOf(made->materials), "Scene::material_names lists them"));
}

// Tolerance for |v|^2 of a unit vector. A vector normalised in float arithmetic is off by up to 9
// roundings of 2^-24 (a sum of squares, its root, the reciprocal and products, each counted twice),
// and by some more with the processor's approximate root. The reflected light changes as little.
// For vectors that are not unit the formulas are meaningless.
constexpr double kUnitSquaredTolerance = 16 * 0x1p-24;

// Throws Error (kUsage) for a vector that is not finite and unit; `number` is its index in an
// array, negative for a single vector.
void CheckUnit(const Vec3& v, const char* function, const char* name, std::ptrdiff_t number) {
  const double squared = v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
  if (std::abs(squared - 1) <= kUnitSquaredTolerance) return;  // false for NaN
  const std::string what = number < 0 ? name : fmt::format("{} {}", name, number);
  const std::string length = std::isfinite(squared)
                                 ? fmt::format("has length {}, not 1", std::sqrt(squared))
                                 : std::string("is not finite, or far too long");
  throw nacre::Error(ExitCode::kUsage, std::string("Brdf::") + function,
                     fmt::format("{} ({}, {}, {}) {}", what, v[0], v[1], v[2], length),
                     "directions are unit vectors: divide them by their lengths in double");
}

void CheckUnits(const Directions& d, const char* function, bool lights = true) {
  const auto check = [&](const std::array<const double*, 3>& vectors, const char* name) {
    for (const double* component : vectors) {
      if (component != nullptr) continue;
      throw nacre::Error(ExitCode::kUsage, std::string("Brdf::") + function,
                         std::string("a component of ") + name + " is a null pointer",
                         "Directions has three arrays of `count` numbers for each");
    }
    for (size_t i = 0; i < d.count; ++i) {
      CheckUnit({vectors[0][i], vectors[1][i], vectors[2][i]}, function, name,
                static_cast<std::ptrdiff_t>(i));
    }
  };
  check(d.normal, "normal");
  check(d.to_view, "to_view");
  if (lights) check(d.to_light, "to_light");
}

Vec3d At(const std::array<const double*, 3>& vectors, size_t i) {
  return {vectors[0][i], vectors[1][i], vectors[2][i]};
}

template <class Number>
std::array<std::vector<Number>, 3> Planes(size_t count) {
  return {std::vector<Number>(count), std::vector<Number>(count), std::vector<Number>(count)};
}

template <class Number>
void CopyTo(const std::array<const double*, 3>& from, size_t begin, size_t count,
            Soa3<Number>* to) {
  Number* const planes[3] = {to->x.data(), to->y.data(), to->z.data()};
  for (size_t c = 0; c < 3; ++c) {
    for (size_t i = 0; i < count; ++i) planes[c][i] = static_cast<Number>(from[c][begin + i]);
  }
}

// Sets vector `i` of the planes.
void Store(const Vec3d& v, size_t i, std::array<std::vector<double>, 3>* planes) {
  for (size_t c = 0; c < 3; ++c) (*planes)[c][i] = v[static_cast<int>(c)];
}

void CopyFrom(const Soa3<float>& from, size_t begin, size_t count,
              std::array<std::vector<float>, 3>* to) {
  const float* const planes[3] = {from.x.data(), from.y.data(), from.z.data()};
  for (size_t c = 0; c < 3; ++c) {
    std::copy_n(planes[c], count, (*to)[c].begin() + static_cast<std::ptrdiff_t>(begin));
  }
}

// A batch of directions under a light of irradiance 1, with the buffers to shade it.
class Batch {
 public:
  Batch() {
    light_.form = LightForm::kGiven;
    light_.color = nacre::Rgb(1);
  }

  void Shade(const ShadingMaterial& material, const Directions& d, size_t begin, size_t count) {
    hits_.count = count;
    CopyTo(d.normal, begin, count, &hits_.normal);
    CopyTo(d.to_view, begin, count, &hits_.to_view);
    CopyTo(d.to_light, begin, count, &lit_.light_vector);
    for (size_t i = 0; i < count; ++i) {
      const Vec3d normal = At(d.normal, begin + i);
      const bool above =
          (normal ^ At(d.to_light, begin + i)) > 0 && (normal ^ At(d.to_view, begin + i)) > 0;
      lit_.irradiance[i] = above ? 1.0f : 0.0f;
    }
    PrepareSurface(hits_, &surface_);
    EvaluateBatch(material, hits_, light_, lit_, &surface_, &coats_, &room_, &radiance_);
  }

  const ReflectedRadiance& radiance() const { return radiance_; }

 private:
  HitBatch hits_;
  Surface surface_;
  ShadingLight light_;
  LightBatch lit_;
  std::vector<CoatHits> coats_;
  BsdfRoom room_;
  ReflectedRadiance radiance_;
};

// The thread's batch, which is kept for the thread's next call: making one takes as long as shading
// some hundred pairs. While a call uses it, a nested call (which a user's own model may make) gets
// a batch of its own.
class BorrowedBatch {
 public:
  BorrowedBatch() : batch_(std::move(Kept())) {
    if (!batch_) batch_ = std::make_unique<Batch>();
  }
  ~BorrowedBatch() { Kept() = std::move(batch_); }
  BorrowedBatch(const BorrowedBatch&) = delete;
  BorrowedBatch& operator=(const BorrowedBatch&) = delete;
  Batch* operator->() { return batch_.get(); }

 private:
  static std::unique_ptr<Batch>& Kept() {
    static thread_local std::unique_ptr<Batch> kept;
    return kept;
  }

  std::unique_ptr<Batch> batch_;
};

}  // namespace

Brdf::Brdf(const std::string& model, const Parameters& parameters) {
  impl_ = AtBorder([&] {
    Parameters material = {{"model", model}};
    material.insert(material.end(), parameters.begin(), parameters.end());
    Scene scene;
    scene.AddMaterial("material", material);
    Prepared prepared = Prepare(scene, "material");
    return std::make_shared<const Impl>(
        Impl{std::move(prepared.material), std::move(prepared.source)});
  });
}

Brdf::Brdf(const Scene& scene, const std::string& material) {
  impl_ = AtBorder([&] {
    Prepared prepared = Prepare(scene, material);
    return std::make_shared<const Impl>(
        Impl{std::move(prepared.material), std::move(prepared.source)});
  });
}

Brdf::Brdf(const UserBrdf& brdf) {
  impl_ = AtBorder([&] {
    nacre::Material material;
    material.user = ToOwn(brdf, "Brdf");
    return std::make_shared<const Impl>(Impl{PrepareMaterial(material), material});
  });
}

Reflection Brdf::Evaluate(const Vec3& normal, const Vec3& to_view, const Vec3& to_light) const {
  return AtBorder([&]() -> Reflection {
    CheckUnit(normal, "Evaluate", "normal", -1);
    CheckUnit(to_view, "Evaluate", "to_view", -1);
    CheckUnit(to_light, "Evaluate", "to_light", -1);
    const nacre::Reflection own =
        Reflect(impl_->material, ToOwn(normal), ToOwn(to_light), ToOwn(to_view));
    return {ToPublic(own.diffuse), ToPublic(own.specular)};
  });
}

Reflections Brdf::Shade(const Directions& directions) const {
  return AtBorder([&] {
    Reflections result{Planes<float>(directions.count), Planes<float>(directions.count)};
    if (directions.count == 0) return result;
    CheckUnits(directions, "Shade");
    const FlushDenormals flush;  // as in renders
    BorrowedBatch batch;
    for (size_t begin = 0; begin < directions.count; begin += kBatchCapacity) {
      const size_t count = std::min(kBatchCapacity, directions.count - begin);
      batch->Shade(impl_->material, directions, begin, count);
      CopyFrom(batch->radiance().diffuse, begin, count, &result.diffuse);
      CopyFrom(batch->radiance().specular, begin, count, &result.specular);
    }
    return result;
  });
}

ExactReflections Brdf::Evaluate(const Directions& d) const {
  return AtBorder([&] {
    CheckUnits(d, "Evaluate");
    ExactReflections result{Planes<double>(d.count), Planes<double>(d.count)};
    for (size_t i = 0; i < d.count; ++i) {
      const nacre::Reflection own =
          Reflect(impl_->material, At(d.normal, i), At(d.to_light, i), At(d.to_view, i));
      Store(own.diffuse, i, &result.diffuse);
      Store(own.specular, i, &result.specular);
    }
    return result;
  });
}

std::array<std::vector<double>, 3> Brdf::Sample(const Directions& d, const double* u,
                                                const double* v) const {
  return AtBorder([&] {
    CheckUnits(d, "Sample", false);
    std::array<std::vector<double>, 3> to_light = Planes<double>(d.count);
    for (size_t i = 0; i < d.count; ++i) {
      if (!(u[i] >= 0 && u[i] < 1 && v[i] >= 0 && v[i] < 1)) {
        throw nacre::Error(ExitCode::kUsage, "Brdf::Sample",
                           fmt::format("point {} is ({}, {})", i, u[i], v[i]),
                           "points lie in [0, 1)^2");
      }
      Store(SampleReflection(impl_->material, At(d.normal, i), At(d.to_view, i), u[i], v[i], false)
                .to_light,
            i, &to_light);
    }
    return to_light;
  });
}

std::vector<double> Brdf::Pdf(const Directions& d) const {
  return AtBorder([&] {
    CheckUnits(d, "Pdf");
    std::vector<double> pdf(d.count);
    for (size_t i = 0; i < d.count; ++i) {
      pdf[i] = ReflectionPdf(impl_->material, At(d.normal, i), At(d.to_view, i), At(d.to_light, i),
                             false);
    }
    return pdf;
  });
}

Rgb Brdf::Albedo(double n_dot_v) const {
  return AtBorder([&] {
    if (!(n_dot_v > 0 && n_dot_v <= 1)) {
      throw nacre::Error(ExitCode::kUsage, "Brdf::Albedo", fmt::format("n.v is {}", n_dot_v),
                         "it is above 0, up to 1");
    }
    return ToPublic(ReflectedShare(impl_->material, ShareOf::kFurnace, n_dot_v));
  });
}

Table Brdf::Tabulate(const Table& directions, bool albedo) const {
  return AtBorder([&] {
    const std::vector<DirectionPair> pairs = DirectionsOf(ToOwn(directions), "Brdf::Tabulate");
    return ToPublic(TabulateBrdf(impl_->source, pairs, {.albedo = albedo}));
  });
}

TableCheck Brdf::CheckTable(const Table& theirs, double tolerance, const std::string& name) const {
  return AtBorder([&]() -> TableCheck {
    if (!(tolerance >= 0)) {
      throw nacre::Error(ExitCode::kUsage, "Brdf::CheckTable",
                         fmt::format("the tolerance is {}", tolerance), "it is not below 0");
    }
    const nacre::TableCheck check =
        nacre::CheckTable(impl_->source, ToOwn(theirs), name, tolerance);
    return {check.ok, PageOf(check), JsonText(CheckJson(check))};
  });
}

MicrofacetTerms Brdf::Terms(const Directions& d) const {
  return AtBorder([&] {
    CheckUnits(d, "Terms");
    const auto* model = std::get_if<MicrofacetModel>(&impl_->material.model);
    if (model == nullptr || model->delta) {
      throw nacre::Error(ExitCode::kUsage, "Brdf::Terms", "the model has no microfacet lobe",
                         "metallic_roughness, conductor and dielectric have, above roughness 0");
    }
    MicrofacetTerms terms;
    for (auto* values : {&terms.d, &terms.g, &terms.lambda_view, &terms.lambda_light}) {
      values->resize(d.count);
    }
    terms.f = Planes<double>(d.count);
    for (size_t i = 0; i < d.count; ++i) {
      const Angles<double> a = ComputeAngles(At(d.normal, i), At(d.to_light, i), At(d.to_view, i));
      if (!(a.n_dot_l > 0) || !(a.n_dot_v > 0)) continue;
      // Lambda = (sqrt(1 + alpha^2 tan^2) - 1) / 2.
      const auto lambda = [&](double cosine) {
        return (SmithRoot(cosine, model->alpha) / cosine - 1) / 2;
      };
      terms.d[i] = GgxDistribution(a, model->alpha);
      terms.g[i] = 4 * a.n_dot_l * a.n_dot_v * VisibilityOf(*model, a.n_dot_l, a.n_dot_v);
      terms.lambda_view[i] = lambda(a.n_dot_v);
      terms.lambda_light[i] = lambda(a.n_dot_l);
      Store(FresnelOf(*model, VDotH(a), OneMinusVDotH(a)), i, &terms.f);
    }
    return terms;
  });
}

}  // namespace nacre::v0
