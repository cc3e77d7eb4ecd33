// SPDX-License-Identifier: Apache-2.0
// Grids, pairs and clouds: where the spheres are, what they are made of, what the labels say.
#include "scene/generators.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

#include "base/error.h"
#include "catch.h"
#include "messages.h"
#include "scene/validate.h"

namespace nacre {
namespace {

Material Metal() {
  return {.name = "base", .emission = Rgb(0, 0, 0), .model = MetallicRoughnessMaterial{}};
}
Material Phong() { return {.name = "phong", .emission = Rgb(0, 0, 0), .model = PhongMaterial{}}; }
Rgb Grey(double x) { return {x, x, x}; }

const MetallicRoughnessMaterial& MetalOf(const Scene& scene, size_t sphere) {
  return std::get<MetallicRoughnessMaterial>(
      scene.materials[scene.spheres[sphere].material.index].model);
}

TEST_CASE("a linear axis includes both of its ends exactly") {
  const GridAxis axis = LinearAxis("base_color", Rgb(0.1, 0, 1), Rgb(0.9, 0.3, 0), 7);
  REQUIRE(axis.values.size() == 7);
  CHECK(axis.values.front() == Rgb(0.1, 0, 1));
  CHECK(axis.values.back() == Rgb(0.9, 0.3, 0));
  CHECK(axis.values[3].x == Approx(0.5).epsilon(1e-15));
  CHECK(LinearAxis("metallic", Grey(0.3), Grey(1), 1).values == std::vector<Rgb>{Grey(0.3)});
}

TEST_CASE("a logarithmic axis has equal ratios and exact ends") {
  const GridAxis axis = LogarithmicAxis("shininess", Grey(0.1), Grey(300), 5);
  REQUIRE(axis.values.size() == 5);
  CHECK(axis.values.front() == Grey(0.1));
  CHECK(axis.values.back() == Grey(300));
  for (size_t i = 1; i < 5; ++i) {
    // A power and a product, a few roundings of double.
    CHECK(axis.values[i].x / axis.values[i - 1].x ==
          Approx(std::pow(3000, 0.25)).epsilon(1e-14).margin(0));
  }
  CHECK(LogarithmicAxis("shininess", Grey(4), Grey(8), 1).values == std::vector<Rgb>{Grey(4)});
}

TEST_CASE("a grid runs downwards from the top and from left to right") {
  Scene scene;
  scene.materials.push_back(Phong());  // what is there already stays in front
  Grid grid{.center = Vec3d(10, 20, 30),
            .spacing = Vec2d(2, 3),
            .radius = 0.75,
            .material = Metal(),
            .rows = LinearAxis("roughness", Grey(0.1), Grey(0.9), 3),
            .columns = LinearAxis("metallic", Grey(0), Grey(1), 5)};
  AddGrid(grid, &scene);

  REQUIRE(scene.spheres.size() == 15);
  REQUIRE(scene.materials.size() == 16);
  CHECK(scene.spheres[0].center == Vec3d(6, 23, 30));
  CHECK(scene.spheres[4].center == Vec3d(14, 23, 30));
  CHECK(scene.spheres[7].center == Vec3d(10, 20, 30));
  CHECK(scene.spheres[14].center == Vec3d(14, 17, 30));
  for (size_t i = 0; i < 15; ++i) {
    CHECK(scene.spheres[i].radius == 0.75);
    CHECK(scene.spheres[i].material.index == i + 1);
    CHECK(MetalOf(scene, i).metallic == static_cast<double>(i % 5) / 4);
  }
  CHECK(MetalOf(scene, 0).roughness == 0.1);
  CHECK(MetalOf(scene, 14).roughness == 0.9);
  CHECK(scene.materials[2].name == "grid roughness=0.1 metallic=0.25");
  CHECK(Validate(scene).empty());
}

TEST_CASE("a grid's labels stand at its edges") {
  Scene scene;
  Grid grid{.radius = 0.4,
            .material = Metal(),
            .rows = LinearAxis("roughness", Grey(0.1), Grey(0.9), 5),
            .columns = {2, "base_color", {Rgb(0.9, 0.6, 0.2), Grey(1)}}};
  AddGrid(grid, &scene);
  REQUIRE(scene.labels.size() == 7);
  CHECK(scene.labels[0].text == "roughness 0.1");
  CHECK(scene.labels[0].side == Label::Side::kLeft);
  CHECK(scene.labels[0].anchor == Vec3d(-0.5 - 0.4, 2, 0));
  CHECK(scene.labels[1].text == "roughness 0.3");  // not 0.30000000000000004
  CHECK(scene.labels[4].anchor == Vec3d(-0.5 - 0.4, -2, 0));
  CHECK(scene.labels[5].text == "base_color 0.9 0.6 0.2");
  CHECK(scene.labels[5].side == Label::Side::kAbove);
  CHECK(scene.labels[5].anchor == Vec3d(-0.5, 2.4, 0));
  CHECK(scene.labels[6].anchor == Vec3d(0.5, 2.4, 0));
}

TEST_CASE("one axis, repeated rows, other models") {
  Scene scene;
  Grid grid{.material = Phong()};
  grid.rows.count = 2;
  grid.columns = {3, "shininess", {Grey(1), Grey(1e3), Grey(1e6)}};
  AddGrid(grid, &scene);
  REQUIRE(scene.spheres.size() == 6);
  CHECK(scene.labels.size() == 3);
  CHECK(scene.materials[5].name == "grid shininess=1e+06");
  CHECK(std::get<PhongMaterial>(scene.materials[5].model).shininess == 1e6);
}

TEST_CASE("grids that make no sense are refused") {
  const auto error_of = [](const std::function<void(Grid&)>& spoil) {
    Grid grid{.material = Metal()};
    spoil(grid);
    Scene scene;
    return ErrorOf([&] { AddGrid(grid, &scene); });
  };
  CHECK(Contains(error_of([](Grid& g) {
                   g.rows = {2, "shininess", {Grey(1), Grey(2)}};
                 }),
                 "grid rows: the material has no parameter \"shininess\""));
  CHECK(Contains(error_of([](Grid& g) {
                   g.columns = {2, "roughness", {Grey(1)}};
                 }),
                 "grid columns: 1 values for 2 places"));
  CHECK(Contains(error_of([](Grid& g) { g.rows.count = 0; }), "0 spheres along one axis"));
  CHECK(Contains(error_of([](Grid& g) { g.rows.count = 1001; }), "1001 spheres"));
  CHECK(Contains(error_of([](Grid& g) { g.radius = -1; }), "-1 as a spacing or radius"));
  CHECK(Contains(error_of([](Grid& g) { g.spacing.y = 0; }), "0 as a spacing or radius"));
  CHECK(Contains(error_of([](Grid& g) {
                   g.material.model = SplitMaterial{};
                   g.rows = {1, "roughness", {Grey(1)}};
                 }),
                 "a split has none"));
}

PairRow TwoPairs() {
  return {.pair_spacing = 3,
          .spacing = 2,
          .radius = 0.5,
          .a = {"Phong", Phong(), {2, "shininess", {Grey(30), Grey(100)}}},
          .b = {"PBR", Metal(), {2, "roughness", {Grey(0.5), Grey(0.25)}}}};
}

TEST_CASE("stacked pairs have A above B") {
  Scene scene;
  AddPair(TwoPairs(), &scene);
  REQUIRE(scene.spheres.size() == 4);
  CHECK(scene.spheres[0].center == Vec3d(-1.5, 1, 0));
  CHECK(scene.spheres[1].center == Vec3d(-1.5, -1, 0));
  CHECK(scene.spheres[2].center == Vec3d(1.5, 1, 0));
  CHECK(scene.spheres[3].center == Vec3d(1.5, -1, 0));
  CHECK(std::get<PhongMaterial>(scene.materials[2].model).shininess == 100);
  CHECK(MetalOf(scene, 3).roughness == 0.25);
  CHECK(scene.materials[2].name == "pair Phong shininess=100");

  REQUIRE(scene.labels.size() == 6);
  CHECK(scene.labels[1].text == "shininess 100");
  CHECK(scene.labels[1].anchor == Vec3d(1.5, 1.5, 0));
  CHECK(scene.labels[1].side == Label::Side::kAbove);
  CHECK(scene.labels[2].text == "Phong");
  CHECK(scene.labels[2].anchor == Vec3d(-2, 1, 0));
  CHECK(scene.labels[2].side == Label::Side::kLeft);
  CHECK(scene.labels[4].text == "roughness 0.25");
  CHECK(scene.labels[4].anchor == Vec3d(1.5, -1.5, 0));
  CHECK(scene.labels[4].side == Label::Side::kBelow);
}

TEST_CASE("pairs side by side have A left of B") {
  Scene scene;
  PairRow row = TwoPairs();
  row.arrangement = PairRow::Arrangement::kSideBySide;
  AddPair(row, &scene);
  CHECK(scene.spheres[0].center == Vec3d(-2.5, 0, 0));
  CHECK(scene.spheres[1].center == Vec3d(-0.5, 0, 0));
  CHECK(scene.spheres[2].center == Vec3d(0.5, 0, 0));
  CHECK(scene.labels.size() == 4);  // no names: they would stand in the way
}

TEST_CASE("pairs need as many values on both sides") {
  Scene scene;
  PairRow row = TwoPairs();
  row.b.values = {1, "roughness", {Grey(0.5)}};
  CHECK(Contains(ErrorOf([&] { AddPair(row, &scene); }), "pair: 2 values for a, 1 for b"));
}

Cloud SomeCloud(uint64_t count) {
  return {.count = count,
          .seed = 7,
          .min = Vec3d(-1, 10, 100),
          .max = Vec3d(1, 10, 300),
          .radius_min = 0.25,
          .radius_max = 0.75,
          .materials = {MaterialId{2}, MaterialId{0}, MaterialId{2}}};
}

TEST_CASE("no two spheres of a large cloud are alike") {
  Cloud cloud = SomeCloud(200000);  // more than what one task makes
  Scene scene;
  AddCloud(cloud, 0, &scene);
  std::vector<double> x;
  x.reserve(scene.spheres.size());
  for (const Sphere& sphere : scene.spheres) x.push_back(sphere.center.x);
  std::sort(x.begin(), x.end());
  CHECK(std::adjacent_find(x.begin(), x.end()) == x.end());
}

TEST_CASE("a cloud is the same everywhere") {
  // From an independent SplitMix64 in integers. Sizes that are powers of two make all products
  // exact, so every bit counts.
  Cloud cloud = SomeCloud(3);
  cloud.min = Vec3d(0, 0, 0);
  cloud.max = Vec3d(1, 2, 4);
  Scene scene;
  AddCloud(cloud, 0, &scene);
  REQUIRE(scene.spheres.size() == 3);
  CHECK(scene.spheres[0].center.x == 0x1.e67b8d7aabff5p-1);
  CHECK(scene.spheres[0].center.y == 0x1.c26654fb68258p+0);
  CHECK(scene.spheres[2].center.z == 0x1.494f94a226be8p-2);
  CHECK(scene.spheres[2].radius == 0x1.0872523c4b1dbp-2);
  CHECK(scene.spheres[2].material.index == 2);
}

TEST_CASE("a cloud does not depend on how long it is or what was there before") {
  constexpr uint64_t kLong = 200000;  // several blocks of work
  Scene one;
  Scene other;
  other.spheres.resize(5);
  AddCloud(SomeCloud(kLong), 0, &one);
  AddCloud(SomeCloud(1000), 1, &other);
  REQUIRE(one.spheres.size() == kLong);
  REQUIRE(other.spheres.size() == 1005);
  bool same = true;
  for (size_t i = 0; i < 1000; ++i) {
    same = same && one.spheres[i].center == other.spheres[i + 5].center &&
           one.spheres[i].radius == other.spheres[i + 5].radius &&
           one.spheres[i].material == other.spheres[i + 5].material;
  }
  CHECK(same);
}

TEST_CASE("a cloud fills its box evenly") {
  constexpr size_t kCount = 100000;
  Scene scene;
  AddCloud(SomeCloud(kCount), 0, &scene);
  Vec3d sum(0, 0, 0);
  double radii = 0;
  size_t of_material_2 = 0;
  for (const Sphere& sphere : scene.spheres) {
    REQUIRE((sphere.center.x >= -1 && sphere.center.x < 1));
    REQUIRE(sphere.center.y == 10);
    REQUIRE((sphere.center.z >= 100 && sphere.center.z < 300));
    REQUIRE((sphere.radius >= 0.25 && sphere.radius < 0.75));
    sum += sphere.center;
    radii += sphere.radius;
    of_material_2 += sphere.material.index == 2;
  }
  // Five standard deviations of a mean of kCount uniform variables: 5 w / sqrt(12 kCount).
  const double five_sigma = 5 / std::sqrt(12.0 * kCount);
  CHECK(std::abs(sum.x / kCount) < 2 * five_sigma);
  CHECK(std::abs(sum.z / kCount - 200) < 200 * five_sigma);
  CHECK(std::abs(radii / kCount - 0.5) < 0.5 * five_sigma);
  // And of a count: 5 sqrt(p (1 - p) / kCount).
  const double share = static_cast<double>(of_material_2) / kCount;
  CHECK(std::abs(share - 2.0 / 3) < 5 * std::sqrt(2.0 / 9 / kCount));
}

TEST_CASE("seeds give other clouds") {
  Scene scene;
  Cloud cloud = SomeCloud(100);
  AddCloud(cloud, 0, &scene);
  cloud.seed = 8;
  AddCloud(cloud, 0, &scene);
  size_t equal = 0;
  for (size_t i = 0; i < 100; ++i) {
    for (size_t j = 100; j < 200; ++j) {
      equal += scene.spheres[i].center.x == scene.spheres[j].center.x;
    }
  }
  CHECK(equal == 0);
}

TEST_CASE("clouds that make no sense are refused") {
  const auto error_of = [](const std::function<void(Cloud&)>& spoil) {
    Cloud cloud = SomeCloud(10);
    spoil(cloud);
    Scene scene;
    return ErrorOf([&] { AddCloud(cloud, 0, &scene); });
  };
  CHECK(Contains(error_of([](Cloud& c) { c.count = 0; }), "number of spheres"));
  CHECK(Contains(error_of([](Cloud& c) { c.count = 100000001; }), "number of spheres"));
  CHECK(Contains(error_of([](Cloud& c) { c.materials.clear(); }), "no materials"));
  CHECK(Contains(error_of([](Cloud& c) { c.min.x = 2; }), "inside out"));
  CHECK(Contains(error_of([](Cloud& c) { c.max.x = std::nan(""); }), "inside out"));
  CHECK(Contains(error_of([](Cloud& c) { c.radius_min = 0; }), "radii"));
  CHECK(Contains(error_of([](Cloud& c) { c.radius_min = 1; }), "radii"));
}

}  // namespace
}  // namespace nacre
