// SPDX-License-Identifier: Apache-2.0
// tests/visibility/geometry_test.cc: the parts beneath the intersector: geometry, exact products.
#include "visibility/geometry.h"

#include <cmath>

#include "catch.h"
#include "quad.h"
#include "targets.h"
#include "visibility/products_kernel.h"
#include "visibility/rays.h"
#include "visibility/two_product.h"

namespace nacre {
namespace {

TEST_CASE("a two-product is exact") {
  Random random(51);
  for (int i = 0; i < 1000; ++i) {
    const double a = random.Uniform(-2, 2), b = random.Magnitude(1e-9, 1e9);
    const auto [product, error] = TwoProduct(a, b);
    CHECK(static_cast<Quad>(a) * b == static_cast<Quad>(product) + error);
  }
}

TEST_CASE("a difference of products has the exact sign") {
  // (1 + e)(1 - e) - 1 = -e^2, which plain products round to 0.
  const double e = 0x1p-30;
  CHECK(DifferenceOfProducts(1 + e, 1 - e, 1.0, 1.0) == -e * e);
  CHECK(DifferenceOfProducts(1.0, 1.0, 1 + e, 1 - e) == e * e);
  CHECK(DifferenceOfProducts(3.0, 7.0, 7.0, 3.0) == 0);
}

TEST_CASE(
    "an accurate difference of products errs by two roundings at most, on vectors of any width") {
  Random random(52);
  ForEachTarget([&](Target) {
    for (int i = 0; i < 2000; ++i) {
      // c e agrees with a b to about 30 bits of 53: plain products keep at most 23.
      const double a = random.Uniform(1, 2), b = random.Uniform(1, 2), c = random.Uniform(1, 2);
      const double e = a * b / c * (1 + random.Uniform(-1, 1) * 0x1p-30);
      const double scalar = AccurateDifference(a, b, c, e, TargetProducts());
      const auto [of_many, of_one] = DifferencesOfProducts(a, b, c, e);
      CHECK(of_many == scalar);
      CHECK(of_one == scalar);
      const Quad exact = static_cast<Quad>(a) * b - static_cast<Quad>(c) * e;
      const double error = static_cast<double>(scalar - exact);
      CHECK(std::abs(error) <= 0x1p-52 * std::abs(static_cast<double>(exact)));
    }
  });
}

TEST_CASE("geometry is relative to the camera") {
  Scene scene;
  scene.spheres = {MakeSphere({1, 2, 3}, 1), MakeSphere({0, 0, 0}, 2)};
  Mesh triangle{.positions = {{0, 0, 0}, {1, 0, 0}, {0, 30, 40}}, .triangles = {0, 1, 2}};
  scene.meshes = {triangle, Mesh{}, triangle};
  const TraceGeometry geometry = MakeTraceGeometry(scene, {1, 1, 1});
  CHECK(geometry.spheres[0].center == Vec3d(0, 1, 2));
  CHECK(geometry.extent == Vec3d(-1, 29, 39).length());
}

}  // namespace
}  // namespace nacre
