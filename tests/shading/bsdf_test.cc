// SPDX-License-Identifier: Apache-2.0
// tests/shading/bsdf_test.cc: the three questions to a BSDF, evaluate, pdf and sample, for whole
// stacks of lobes: samples follow their pdf, the mean of their weights is the albedo, and the
// kernels agree with the scalar twin.
#include "shading/bsdf.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <random>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "catch.h"
#include "chi_squared.h"
#include "measured_tables.h"
#include "shading/scalar_bsdf.h"
#include "shading/share.h"
#include "targets.h"

namespace nacre {
namespace {

const Vec3d kUp(0, 0, 1);

struct Stack {
  std::string name;
  Material material;
  bool whole = true;  // whether the samplers of all its lobes have directions for all of [0, 1)^2
  bool reciprocal = false;
  // Shading normals over a surface whose normal is kUp.
  Vec3d normal = kUp;
  std::vector<Vec3d> coat_normals = {};
  // The tangents of an anisotropic model and of its coat. Without them the stack is isotropic.
  std::vector<Vec3d> tangents = {};
  // If any, the coat of `material` lies over it as often as this, with these tints: no material has
  // more than one, or a tint, but stacks may.
  std::vector<Rgb> tints = {};

  bool Mapped() const { return !coat_normals.empty(); }
  StackNormals Normals() const {
    StackNormals normals(normal, coat_normals);
    if (Mapped()) normals.unmapped = kUp;
    if (!tangents.empty()) {
      normals.tangent = tangents[0];
      normals.coat_tangents = std::span(tangents).subspan(1);
    }
    return normals;
  }
};

ShadingMaterial Prepared(const Stack& stack) {
  ShadingMaterial material = PrepareMaterial(stack.material);
  if (stack.tints.empty()) return material;
  ShadingMaterial coat = *material.coats.at(0);
  material.coats.clear();
  for (const Rgb& tint : stack.tints) {
    coat.transmission.color = tint;
    coat.transmission.weight = 1;
    material.coats.push_back(std::make_shared<const ShadingMaterial>(coat));
  }
  return material;
}

MetallicRoughnessMaterial Paint() { return {.base_color = Rgb(0.7, 0.3, 0.1), .roughness = 0.6}; }

template <class Model>
void Add(const std::string& name, const Model& model, std::vector<Stack>* stacks) {
  Stack stack{name, {}};
  constexpr std::array kReciprocal = {"lambert", "oren_nayar", "modified phong",
                                      "metal without compensation", "metal, Kulla and Conty"};
  stack.reciprocal = std::find(kReciprocal.begin(), kReciprocal.end(), name) != kReciprocal.end();
  stack.material.model = model;
  stacks->push_back(stack);
}

// Stacks with normal maps on the model, on the coat, and on both.
void AddMapped(std::vector<Stack>* stacks) {
  const Vec3d leaning = Vec3d(0.4, 0.2, 0.9).normalized(), other = Vec3d(-0.2, 0.5, 1).normalized();
  for (const bool on_model : {true, false}) {
    for (const bool on_coat : {false, true}) {
      if (!on_model && !on_coat) continue;
      MetallicRoughnessMaterial paint = Paint();
      paint.sheen_color = Rgb(0.5, 0.6, 0.7);
      paint.sheen_roughness = 0.5;
      paint.coat = 0.8;
      paint.coat_roughness = 0.5;
      if (on_coat) paint.coat_normal_map.texture = TextureId{0};
      Add("mapped " + std::to_string(2 * on_model + on_coat), paint, stacks);
      Stack& stack = stacks->back();
      if (on_model) stack.material.normal_map.texture = TextureId{0};
      stack.normal = on_model ? leaning : kUp;
      stack.coat_normals = {on_coat ? other : kUp};
    }
  }
}

// Anisotropic lobes of every kind, seen from no axis of theirs.
void AddAnisotropic(std::vector<Stack>* stacks) {
  const auto add = [&](const std::string& name, const auto& model) {
    Add("anisotropic " + name, model, stacks);
    stacks->back().tangents = {Vec3d(std::cos(1.9), std::sin(1.9), 0),
                               Vec3d(std::cos(-0.3), std::sin(-0.3), 0)};
  };
  for (const Compensation compensation :
       {Compensation::kNone, Compensation::kTurquin, Compensation::kKullaConty}) {
    for (const Shadowing shadowing : {Shadowing::kHeightCorrelated, Shadowing::kSeparable}) {
      MetallicRoughnessMaterial metal = Paint();
      metal.metallic = 1;
      metal.anisotropy = 0.7;
      metal.shadowing = shadowing;
      metal.compensation = compensation;
      const std::string options = std::to_string(static_cast<int>(compensation)) +
                                  std::to_string(static_cast<int>(shadowing));
      add("metal " + options, metal);
      stacks->back().reciprocal = compensation != Compensation::kTurquin;
      metal.metallic = 0.2;
      metal.coat = 0.8;
      metal.coat_roughness = 0.5;
      add("coated paint " + options, metal);
    }
  }
  for (const OpenPbrRules rules :
       {OpenPbrRules::kSpec11, OpenPbrRules::kMaterialX, OpenPbrRules::kAdobe}) {
    OpenPbrMaterial model{.options = OptionsOf(rules)};
    const std::string name = std::to_string(static_cast<int>(rules));
    model.specular_roughness = 0.6;
    model.specular_roughness_anisotropy = 0.6;
    add("dielectric " + name, model);
    stacks->back().reciprocal = model.options.layering == Layering::kReciprocal;
    model.base_metalness = 0.4;
    model.coat_weight = 0.8;
    model.coat_roughness = 0.5;
    model.coat_roughness_anisotropy = 0.7;
    model.coat_color = Rgb(0.6, 0.4, 0.9);
    model.fuzz_weight = 0.5;
    add("stack " + name, model);
  }
}

// OpenPBR by all rules, with and without coat and fuzz.
void AddOpenPbr(std::vector<Stack>* stacks) {
  const std::pair<std::string, OpenPbrRules> all_rules[] = {{"spec_1_1", OpenPbrRules::kSpec11},
                                                            {"spec_1_2", OpenPbrRules::kSpec12},
                                                            {"materialx", OpenPbrRules::kMaterialX},
                                                            {"adobe", OpenPbrRules::kAdobe}};
  for (const auto& [name, rules] : all_rules) {
    OpenPbrMaterial model{.options = OptionsOf(rules)};
    model.base_weight = 0.9;
    model.base_color = Rgb(0.7, 0.3, 0.1);
    model.base_diffuse_roughness = 0.4;
    model.specular_weight = 0.8;
    model.specular_color = Rgb(0.9, 0.95, 1);
    model.specular_roughness = 0.5;
    const bool reciprocal = model.options.layering == Layering::kReciprocal;
    Add("open_pbr, dielectric, " + name, model, stacks);
    stacks->back().reciprocal = reciprocal;
    model.base_metalness = 0.4;
    Add("open_pbr, mix, " + name, model, stacks);
    stacks->back().reciprocal = reciprocal;
    model.coat_weight = 0.7;
    model.coat_color = Rgb(0.9, 0.5, 0.2);
    model.coat_roughness = 0.4;
    Add("open_pbr, coat, " + name, model, stacks);
    model.fuzz_weight = 0.6;
    model.fuzz_color = Rgb(0.4, 0.6, 0.9);
    Add("open_pbr, coat and fuzz, " + name, model, stacks);
  }
  OpenPbrMaterial model{.specular_roughness = 0.5};
  model.options.layering = Layering::kReciprocal;
  Add("open_pbr, reciprocal", model, stacks);
  stacks->back().reciprocal = true;
  for (const SpecularTintBelow tint :
       {SpecularTintBelow::kComplementary, SpecularTintBelow::kMaxChannel}) {
    OpenPbrMaterial tinted{.specular_color = Rgb(1, 0.2, 0.5), .specular_roughness = 0.5};
    tinted.options.specular_tint_below = tint;
    Add("open_pbr, tint below " + std::to_string(static_cast<int>(tint)), tinted, stacks);
  }
  OpenPbrMaterial changed{.base_metalness = 1, .coat_weight = 0.7};
  changed.options.coat_metal = CoatMetal::kGulbrandsen;
  Add("open_pbr, a coat that changes the metal", changed, stacks);
  OpenPbrMaterial smooth{.coat_weight = 1};
  smooth.specular_roughness = 0.5;
  smooth.coat_color = Rgb(0.9, 0.5, 0.2);
  Add("open_pbr, smooth coat", smooth, stacks);
}

// Thin films on dielectrics, metals and mixes, bare, below coats and fuzz, and on anisotropic
// lobes.
void AddFilms(std::vector<Stack>* stacks) {
  for (const Compensation compensation :
       {Compensation::kNone, Compensation::kTurquin, Compensation::kKullaConty}) {
    for (const double metallic : {0.0, 0.4, 1.0}) {
      MetallicRoughnessMaterial film = Paint();
      film.metallic = metallic;
      film.compensation = compensation;
      film.specular = 0.9;
      film.iridescence = 0.8;
      film.iridescence_model = static_cast<ThinFilmForm>(static_cast<int>(compensation) + 1);
      Add("film " + std::to_string(static_cast<int>(compensation)) + ", metallic " +
              std::to_string(metallic),
          film, stacks);
      stacks->back().reciprocal = compensation == Compensation::kKullaConty ||
                                  (compensation == Compensation::kNone && metallic == 1);
    }
  }
  for (const OpenPbrRules rules :
       {OpenPbrRules::kSpec11, OpenPbrRules::kMaterialX, OpenPbrRules::kAdobe}) {
    const std::string name = std::to_string(static_cast<int>(rules));
    OpenPbrMaterial film{.options = OptionsOf(rules)};
    film.base_color = Rgb(0.7, 0.3, 0.1);
    film.base_metalness = 0.4;
    film.specular_color = Rgb(0.9, 0.95, 1);
    film.specular_roughness = 0.6;
    film.thin_film_weight = 0.9;
    film.thin_film_thickness = 0.35;
    Add("open_pbr, film " + name, film, stacks);
    stacks->back().reciprocal = film.options.layering == Layering::kReciprocal;
    film.coat_weight = 0.7;
    film.coat_color = Rgb(0.9, 0.5, 0.2);
    film.coat_roughness = 0.4;
    film.fuzz_weight = 0.3;
    Add("open_pbr, film, coat and fuzz " + name, film, stacks);
    film.specular_roughness_anisotropy = 0.6;
    film.coat_roughness_anisotropy = 0.4;
    Add("open_pbr, anisotropic film " + name, film, stacks);
    stacks->back().tangents = {Vec3d(std::cos(1.9), std::sin(1.9), 0),
                               Vec3d(std::cos(-0.3), std::sin(-0.3), 0)};
  }
}

// Measured BRDFs: a table of MERL's form, and tables of EPFL's, of random numbers. They know
// nothing of reciprocity.
void AddMeasured(std::vector<Stack>* stacks) {
  static const auto gold = std::make_shared<const MeasuredBrdf>(AnalyticMerl({.alpha = 0.3}));
  static const auto isotropic = std::make_shared<const MeasuredBrdf>(MakeRglBrdf(RandomRgl(1)));
  static const auto quarter =
      std::make_shared<const MeasuredBrdf>(MakeRglBrdf(RandomRgl(2, 3, 4), 4));
  const auto add = [&](const char* name, const std::shared_ptr<const MeasuredBrdf>& brdf) {
    Add(std::string("measured, ") + name, MeasuredMaterial{.brdf = brdf}, stacks);
    stacks->back().whole = false;  // some half vectors face away
  };
  add("MERL", gold);
  stacks->back().reciprocal = true;
  add("EPFL", isotropic);
  add("EPFL, anisotropic", quarter);
  stacks->back().tangents = {Vec3d(std::cos(1.9), std::sin(1.9), 0)};
}

// Every kind of lobe, by itself and over and under others. Lobes are wide enough for quadrature.
std::vector<Stack> Stacks() {
  std::vector<Stack> stacks;
  Add("lambert", LambertMaterial{.albedo = Rgb(0.6)}, &stacks);
  Add("oren_nayar", OrenNayarMaterial{.albedo = Rgb(0.6), .roughness = 0.7}, &stacks);
  for (const auto& [name, model] : {std::pair{"phong", PhongModel::kPhong},
                                    {"modified phong", PhongModel::kModifiedPhong},
                                    {"blinn phong", PhongModel::kBlinnPhong}}) {
    PhongMaterial phong{
        .model = model, .convention = PhongConvention::kRadiometric, .shininess = 12};
    Add(name, phong, &stacks);
    // Some half vectors of its lobe face away.
    stacks.back().whole = model != PhongModel::kBlinnPhong;
  }
  for (const auto& [name, compensation] :
       {std::pair{"metal without compensation", Compensation::kNone},
        {"metal, Turquin", Compensation::kTurquin},
        {"metal, Kulla and Conty", Compensation::kKullaConty}}) {
    MetallicRoughnessMaterial metal = Paint();
    metal.metallic = 1;
    metal.compensation = compensation;
    Add(name, metal, &stacks);
  }
  MetallicRoughnessMaterial paint = Paint();
  Add("paint", paint, &stacks);
  paint.sheen_color = Rgb(0.5, 0.6, 0.7);
  paint.sheen_roughness = 0.5;
  Add("sheen", paint, &stacks);
  paint.coat = 0.8;
  paint.coat_roughness = 0.5;
  Add("sheen and coat", paint, &stacks);
  Add("sheen and two tinted coats", paint, &stacks);
  stacks.back().tints = {Rgb(0.9, 0.5, 0.2), Rgb(1, 0.8, 0.4)};
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
  AddMapped(&stacks);
  AddOpenPbr(&stacks);
  AddAnisotropic(&stacks);
  AddFilms(&stacks);
  AddMeasured(&stacks);
  paint.roughness = 0.6;
  paint.coat_normal_map.texture = TextureId{0};
  Add("two tinted coats with normals of their own", paint, &stacks);
  stacks.back().tints = {Rgb(0.9, 0.5, 0.2), Rgb(1, 0.8, 0.4)};
  stacks.back().coat_normals = {Vec3d(-0.2, 0.5, 1).normalized(), Vec3d(0.3, 0.1, 1).normalized()};
  stacks.back().material.normal_map.texture = TextureId{0};
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

TEST_CASE("samples of a stack follow its pdf", "[long]") {
  constexpr int kSamples = 40000;
  constexpr size_t kSteps = 30;  // of the midpoint rule, each way in a cell
  for (const Stack& stack : Stacks()) {
    const ShadingMaterial material = Prepared(stack);
    const StackNormals normals = stack.Normals();
    for (const double n_dot_v : kViewCosines) {
      CAPTURE(stack.name, n_dot_v);
      const Vec3d v = ViewAt(n_dot_v);
      std::vector<double> counts(kCells), probabilities(kCells);
      std::mt19937 random(5);
      std::uniform_real_distribution<double> unit(0, 1);
      double mirrors = 0, nowhere = 0;
      for (int i = 0; i < kSamples; ++i) {
        const double u0 = unit(random), u1 = unit(random);
        const ReflectionSample sample = SampleReflection(material, normals, v, u0, u1);
        if (sample.kind == LobeKind::kDelta) {
          mirrors += 1;
          continue;
        }
        if (sample.pdf > 0) {
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
              ReflectionPdf(material, normals, v, l) * 4 * M_PI / (kCells * kSteps * kSteps);
          probabilities[i / kSteps * kTurns + j / kSteps] += p;
          sum += p;
        }
      }
      if (stack.whole && mirrors == 0) CHECK(std::abs(sum - 1) < 1e-3);
      counts.push_back(mirrors + nowhere);
      probabilities.push_back(std::max(1 - sum, 0.0));
      CHECK(FollowsProbabilities(counts, kSamples, probabilities));
    }
  }
}

// The worst relative change of f when light and viewer are exchanged.
double Asymmetry(const ShadingMaterial& material, const StackNormals& normals) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> height(0.05, 1), turn(0, 2 * M_PI);
  const auto direction = [&]() -> Vec3d {
    const double z = height(random), phi = turn(random), sine = std::sqrt((1 - z) * (1 + z));
    return {sine * std::cos(phi), sine * std::sin(phi), z};
  };
  double worst = 0;
  for (int i = 0; i < 200; ++i) {
    const Vec3d l = direction(), v = direction();
    const double f = Reflect(material, normals, l, v).Sum().y / l.z;
    const double exchanged = Reflect(material, normals, v, l).Sum().y / v.z;
    worst = std::max(worst, std::abs(f - exchanged) / std::max(f, exchanged));
  }
  return worst;
}

// Phong's lobe is not, without the cosine; nor is what scales by an albedo at n.v alone: Turquin's
// compensation, the base under a dielectric, and what is below a coat.
TEST_CASE("stacks are reciprocal where their models are") {
  for (const Stack& stack : Stacks()) {
    if (stack.Mapped()) continue;
    const double asymmetry = Asymmetry(Prepared(stack), stack.Normals());
    CAPTURE(stack.name, asymmetry);
    CHECK((stack.reciprocal ? asymmetry < 1e-12 : asymmetry > 1e-3));
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

  void SetNormals(const Vec3d& normal, const Vec3d& to_view) {
    for (size_t i = 0; i < kBatchCapacity; ++i) {
      SetVector(normal, i, &hits.normal);
      SetVector(to_view, i, &hits.to_view);
    }
    PrepareSurface(hits, &surface);
  }

  static void SetTangents(const Vec3d& tangent, Surface* to) {
    for (size_t i = 0; i < kBatchCapacity; ++i) SetVector(tangent, i, &to->tangent);
  }

  MaterialHits Prepare(const Stack& stack, const ShadingMaterial& material, const Vec3d& to_view) {
    hits.count = kBatchCapacity;
    SetNormals(kUp, to_view);
    surface.normal_mapped = stack.Mapped();
    CopySoa(surface.normal, kBatchCapacity, &surface.interpolated_normal);
    if (coats.size() < material.coats.size()) coats.resize(material.coats.size());
    for (size_t k = 0; k < material.coats.size(); ++k) {
      if (stack.Mapped()) SetNormals(stack.coat_normals[k], to_view);
      CopyToCoat(hits, surface, &coats[k]);
      coats[k].surface.normal_mapped = surface.normal_mapped;
      if (!stack.tangents.empty()) SetTangents(stack.tangents[1 + k], &coats[k].surface);
      CopySoa(surface.interpolated_normal, kBatchCapacity, &coats[k].surface.interpolated_normal);
    }
    SetNormals(stack.normal, to_view);
    if (!stack.tangents.empty()) SetTangents(stack.tangents[0], &surface);
    PrepareBsdf(material, 0, kBatchCapacity, nullptr, &surface, coats);
    return {material, hits, surface, 0, kBatchCapacity, nullptr, coats};
  }
};

bool Grazes(const Stack& stack, const Vec3d& to_light) {
  const auto grazes = [&](const Vec3d& n) { return std::abs(n ^ to_light) < 1e-2; };
  const Vec3d mirrored(to_light.x, to_light.y, -to_light.z);
  return grazes(kUp) || grazes(stack.normal) || std::abs(stack.normal ^ mirrored) < 1e-2 ||
         std::any_of(stack.coat_normals.begin(), stack.coat_normals.end(),
                     [&](const Vec3d& n) { return grazes(n) || std::abs(n ^ mirrored) < 1e-2; });
}

// The green light that a stack with shading normals or tangents of its own reflects of a white sky.
double MappedAlbedo(const Stack& stack, const ShadingMaterial& material, const Vec3d& v) {
  constexpr size_t kRings = 400;
  double sum = 0;
  for (size_t i = 0; i < kRings; ++i) {
    const double z = (static_cast<double>(i) + 0.5) / kRings;
    const double sine = std::sqrt((1 - z) * (1 + z));
    for (size_t j = 0; j < kRings; ++j) {
      const double turn = (static_cast<double>(j) + 0.5) / kRings * 2 * M_PI;
      const Vec3d l(sine * std::cos(turn), sine * std::sin(turn), z);
      sum += Reflect(material, stack.Normals(), l, v).Sum().y;
    }
  }
  return sum * 2 * M_PI / (kRings * kRings);
}

TEST_CASE("the mean weight of samples is the albedo, and kernels agree with the scalar twin",
          "[long]") {
  const auto batch = std::make_unique<StackBatch>();
  // The same on every target, and as costly as a target's samples.
  std::map<std::pair<size_t, double>, double> albedos;
  const std::vector<Stack> stacks = Stacks();
  ForEachTarget([&](Target) {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> unit(0, 1);
    for (size_t number = 0; number < stacks.size(); ++number) {
      const Stack& stack = stacks[number];
      const ShadingMaterial material = Prepared(stack);
      const StackNormals normals = stack.Normals();
      for (const double n_dot_v : kViewCosines) {
        CAPTURE(stack.name, n_dot_v);
        const Vec3d v = ViewAt(n_dot_v);
        const MaterialHits at = batch->Prepare(stack, material, v);
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
            if (Grazes(stack, l)) continue;
            if (!((l ^ kUp) > 0)) {
              CHECK(VectorAt(samples.weight, i) == Vec3d(0, 0, 0));
              continue;
            }
            // One batch is enough for the twin, which takes nearly all of the time.
            if (repeat > 0) continue;
            const double pdf = ReflectionPdf(material, normals, v, l);
            const Rgb twin = pdf > 0 ? Reflect(material, normals, l, v).Sum() / pdf : Rgb(0, 0, 0);
            // The albedos by which lobes are chosen and attenuated are fits: 2e-4.
            if (std::abs(samples.pdf[i] - pdf) > 1e-3 * pdf) {
              FAIL("pdf " << samples.pdf[i] << " not " << pdf << " at " << l.z);
            }
            const Vec3d weights = VectorAt(samples.weight, i);
            for (int c = 0; c < 3; ++c) {
              if (std::abs(weights[c] - twin[c]) > 2e-3 * twin[c]) {
                FAIL("weight " << weights[c] << " not " << twin[c] << " at " << l.z);
              }
            }
          }
        }
        const double mean = sum / static_cast<double>(count);
        const double variance = squares / static_cast<double>(count) - mean * mean;
        const double error = std::sqrt(std::max(variance, 0.0) / static_cast<double>(count));
        const auto [known, first] = albedos.try_emplace({number, n_dot_v});
        double& albedo = known->second;
        if (first) {
          albedo = stack.Mapped() || !stack.tangents.empty()
                       ? MappedAlbedo(stack, material, v)
                       : ReflectedShare(material, ShareOf::kFurnace, n_dot_v).y;
        }
        CAPTURE(mean, albedo, error, mirrors);
        CHECK(std::abs(mean - albedo) <= 4.5 * error + 1e-3 * albedo);
        CHECK(error < 0.02 * albedo);  // the check above could fail
      }
    }
  });
}

}  // namespace
}  // namespace nacre
