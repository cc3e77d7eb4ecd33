// SPDX-License-Identifier: Apache-2.0
// tests/shading/bsdf_test.cc: the three questions to a BSDF, evaluate, pdf and sample, for whole
// stacks of lobes: samples follow their pdf, the mean of their weights is the albedo, and the
// kernels agree with the scalar twin.
#include "shading/bsdf.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "catch.h"
#include "chi_squared.h"
#include "shading/scalar_bsdf.h"
#include "shading/share.h"
#include "targets.h"

namespace nacre {
namespace {

const Vec3d kUp(0, 0, 1);

struct Stack {
  std::string name;
  Material material;
};

MetallicRoughnessMaterial Paint() {
  MetallicRoughnessMaterial paint;
  paint.base_color = Rgb(0.7, 0.3, 0.1);
  paint.roughness = 0.6;
  return paint;
}

template <class Model>
void Add(const std::string& name, const Model& model, std::vector<Stack>* stacks) {
  Stack stack{name, {}};
  stack.material.model = model;
  stacks->push_back(stack);
}

// Every kind of lobe, by itself and over and under others. Lobes are wide enough for quadrature.
std::vector<Stack> Stacks() {
  std::vector<Stack> stacks;
  Add("lambert", LambertMaterial{.albedo = Rgb(0.6)}, &stacks);
  Add("oren_nayar", OrenNayarMaterial{.albedo = Rgb(0.6), .roughness = 0.7}, &stacks);
  for (const PhongModel model :
       {PhongModel::kPhong, PhongModel::kModifiedPhong, PhongModel::kBlinnPhong}) {
    PhongMaterial phong;
    phong.model = model;
    phong.convention = PhongConvention::kRadiometric;
    phong.shininess = 12;
    Add("phong " + std::to_string(static_cast<int>(model)), phong, &stacks);
  }
  for (const Compensation compensation :
       {Compensation::kNone, Compensation::kTurquin, Compensation::kKullaConty}) {
    MetallicRoughnessMaterial metal = Paint();
    metal.metallic = 1;
    metal.compensation = compensation;
    Add("metal " + std::to_string(static_cast<int>(compensation)), metal, &stacks);
  }
  MetallicRoughnessMaterial paint = Paint();
  Add("paint", paint, &stacks);
  paint.sheen_color = Rgb(0.5, 0.6, 0.7);
  paint.sheen_roughness = 0.5;
  Add("sheen", paint, &stacks);
  paint.coat = 0.8;
  paint.coat_roughness = 0.5;
  Add("sheen and coat", paint, &stacks);
  paint.metallic = 1;
  Add("metal, sheen and coat", paint, &stacks);
  paint.coat_roughness = 0;
  Add("metal, sheen and smooth coat", paint, &stacks);
  paint.roughness = 0;
  Add("mirror, sheen and smooth coat", paint, &stacks);
  paint.coat_roughness = 0.5;
  paint.metallic = 0;
  Add("smooth plastic, sheen and coat", paint, &stacks);
  Add("glass, opaque", DielectricMaterial{.roughness = 0.6}, &stacks);
  return stacks;
}

constexpr double kViewCosines[] = {1.0, 0.7, 0.2};

Vec3d ViewAt(double n_dot_v) {
  const double sine = std::sqrt((1 - n_dot_v) * (1 + n_dot_v));
  return {sine * std::cos(0.7), sine * std::sin(0.7), n_dot_v};
}

// Cells over the sphere of directions, even in height and azimuth.
constexpr size_t kHeights = 12, kTurns = 16, kCells = kHeights * kTurns;

size_t CellOf(const Vec3d& direction) {
  const auto height = static_cast<size_t>(std::clamp(direction.z / 2 + 0.5, 0.0, 1.0) * kHeights);
  const double turn = std::atan2(direction.y, direction.x) / (2 * M_PI) + 0.5;
  return std::min(height, kHeights - 1) * kTurns +
         std::min(static_cast<size_t>(turn * kTurns), kTurns - 1);
}

TEST_CASE("samples of a stack follow its pdf") {
  constexpr int kSamples = 40000;
  constexpr size_t kSteps = 60;  // of the midpoint rule, each way in a cell
  for (const Stack& stack : Stacks()) {
    const ShadingMaterial material = PrepareMaterial(stack.material);
    for (const double n_dot_v : kViewCosines) {
      CAPTURE(stack.name, n_dot_v);
      const Vec3d v = ViewAt(n_dot_v);
      std::vector<double> counts(kCells), probabilities(kCells);
      std::mt19937 random(5);
      std::uniform_real_distribution<double> unit(0, 1);
      double mirrors = 0, nowhere = 0;
      for (int i = 0; i < kSamples; ++i) {
        const double u0 = unit(random), u1 = unit(random);
        const ReflectionSample sample = SampleReflection(material, kUp, v, u0, u1);
        if (sample.kind == LobeKind::kDelta) {
          mirrors += 1;
          continue;
        }
        const double pdf = ReflectionPdf(material, kUp, v, sample.to_light);
        if (pdf != sample.pdf) FAIL(pdf << " not " << sample.pdf);
        if (pdf > 0) {
          counts[CellOf(sample.to_light)] += 1;
        } else {
          nowhere += 1;  // half vectors of Blinn's lobe that face away
        }
      }
      double sum = 0;
      for (size_t i = 0; i < kHeights * kSteps; ++i) {
        const double z = 2 * (static_cast<double>(i) + 0.5) / (kHeights * kSteps) - 1;
        for (size_t j = 0; j < kTurns * kSteps; ++j) {
          const double turn = (2 * (static_cast<double>(j) + 0.5) / (kTurns * kSteps) - 1) * M_PI;
          const double sine = std::sqrt((1 - z) * (1 + z));
          const Vec3d l(sine * std::cos(turn), sine * std::sin(turn), z);
          const double p =
              ReflectionPdf(material, kUp, v, l) * 4 * M_PI / (kCells * kSteps * kSteps);
          probabilities[i / kSteps * kTurns + j / kSteps] += p;
          sum += p;
        }
      }
      const bool whole = stack.name != "phong 2";
      if (whole && mirrors == 0) CHECK(std::abs(sum - 1) < 1e-3);
      counts.push_back(mirrors + nowhere);
      probabilities.push_back(std::max(1 - sum, 0.0));
      CHECK(FollowsProbabilities(counts, kSamples, probabilities));
    }
  }
}

// Batches of hits on one material, seen from one direction.
struct StackBatch {
  HitBatch hits;
  Surface surface;
  std::vector<CoatHits> coats;
  BsdfRoom room;
  SampleRoom sample_room;
  BsdfSamples samples;
  AlignedArray<float> u{kBatchCapacity}, v{kBatchCapacity};

  BsdfHits Prepare(const ShadingMaterial& material, const Vec3d& to_view) {
    hits.count = kBatchCapacity;
    for (size_t i = 0; i < kBatchCapacity; ++i) {
      SetVector(kUp, i, &hits.normal);
      SetVector(to_view, i, &hits.to_view);
    }
    PrepareSurface(hits, &surface);
    if (coats.size() < material.coats.size()) coats.resize(material.coats.size());
    for (size_t k = 0; k < material.coats.size(); ++k) CopyToCoat(hits, surface, &coats[k]);
    PrepareBsdf(material, 0, kBatchCapacity, nullptr, &surface, coats);
    return {material, hits, surface, 0, kBatchCapacity, nullptr, coats};
  }
};

TEST_CASE("the mean weight of samples is the albedo, and kernels agree with the scalar twin") {
  const auto batch = std::make_unique<StackBatch>();
  ForEachTarget([&](Target) {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> unit(0, 1);
    for (const Stack& stack : Stacks()) {
      const ShadingMaterial material = PrepareMaterial(stack.material);
      for (const double n_dot_v : kViewCosines) {
        CAPTURE(stack.name, n_dot_v);
        const Vec3d v = ViewAt(n_dot_v);
        const BsdfHits at = batch->Prepare(material, v);
        double sum = 0, squares = 0;
        size_t count = 0, mirrors = 0;
        for (int repeat = 0; repeat < 4; ++repeat) {
          for (size_t i = 0; i < kBatchCapacity; ++i) {
            batch->u[i] = std::min(unit(random), 1 - 0x1p-24f);
            batch->v[i] = std::min(unit(random), 1 - 0x1p-24f);
          }
          const BsdfSamples& samples = batch->samples;
          SampleBsdf(at, batch->u.data(), batch->v.data(), &batch->room, &batch->sample_room,
                     &batch->samples);
          for (size_t i = 0; i < kBatchCapacity; ++i, ++count) {
            const double weight = samples.weight.y[i];
            sum += weight;
            squares += weight * weight;
            if (samples.kind[i] == LobeKind::kDelta) {
              ++mirrors;
              continue;
            }
            const Vec3d l = VectorAt(samples.to_light, i).normalized();
            // Directions in float that graze the surface have a cosine of few digits.
            if (l.z < 1e-2) continue;
            const double pdf = ReflectionPdf(material, kUp, v, l);
            const Rgb twin = Reflect(material, kUp, l, v).Sum() / pdf;
            // The albedos by which lobes are chosen and attenuated are fits: 2e-4.
            if (std::abs(samples.pdf[i] - pdf) > 1e-3 * pdf) {
              FAIL("pdf " << samples.pdf[i] << " not " << pdf << " at " << l.z);
            }
            if (std::abs(weight - twin.y) > 2e-3 * twin.y) {
              FAIL("weight " << weight << " not " << twin.y << " at " << l.z);
            }
          }
        }
        const double mean = sum / static_cast<double>(count);
        const double variance = squares / static_cast<double>(count) - mean * mean;
        const double error = std::sqrt(std::max(variance, 0.0) / static_cast<double>(count));
        const double albedo = ReflectedShare(material, ShareOf::kFurnace, n_dot_v).y;
        CAPTURE(mean, albedo, error, mirrors);
        CHECK(std::abs(mean - albedo) <= 4.5 * error + 1e-3 * albedo);
        CHECK(error < 0.02 * albedo);  // the check above could fail
      }
    }
  });
}

}  // namespace
}  // namespace nacre
