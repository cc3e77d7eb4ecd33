// SPDX-License-Identifier: Apache-2.0
// tests/textbook/operation_counts_test.cc: what the lesson says of its two highlights, "Phong takes
// 5 operations, Blinn-Phong 4": counted. It counts vector operations; of the arithmetic below them
// both take as much, but for the square root and the divisions of Blinn's half vector. How long
// they take is bench/README.md's to tell.
#include <cmath>

#include "catch.h"

namespace nacre {
namespace {

struct Counts {
  int vector = 0;  // what the lesson counts: whole steps on vectors, and the power
  int sums = 0, products = 0, divisions = 0, roots = 0, powers = 0;
};

// Vector arithmetic that keeps count of itself.
struct Counter {
  Counts counts;

  struct Vector {
    double x, y, z;
  };

  double Dot(const Vector& a, const Vector& b) {
    ++counts.vector;
    counts.products += 3;
    counts.sums += 2;
    return a.x * b.x + a.y * b.y + a.z * b.z;
  }
  Vector Scaled(const Vector& a, double s) {
    ++counts.vector;
    counts.products += 3;
    return {a.x * s, a.y * s, a.z * s};
  }
  Vector Sum(const Vector& a, const Vector& b, double sign) {
    ++counts.vector;
    counts.sums += 3;
    return {a.x + sign * b.x, a.y + sign * b.y, a.z + sign * b.z};
  }
  Vector Normalized(const Vector& a) {
    const int before = counts.vector;
    const double length = std::sqrt(Dot(a, a));
    counts.vector = before + 1;
    ++counts.roots;
    counts.divisions += 3;
    return {a.x / length, a.y / length, a.z / length};
  }
  double Power(double x, double n) {
    ++counts.vector;
    ++counts.powers;
    return std::pow(std::fmax(x, 0), n);
  }

  // max(R.V, 0)^n with R = 2 (N.L) N - L.
  double Phong(const Vector& n, const Vector& l, const Vector& v, double shininess) {
    const double n_dot_l = Dot(n, l);
    ++counts.products;  // by 2, which is no step on a vector
    const Vector r = Sum(Scaled(n, 2 * n_dot_l), l, -1);
    return Power(Dot(r, v), shininess);
  }

  // max(N.H, 0)^n with H = (L + V) / |L + V|.
  double Blinn(const Vector& n, const Vector& l, const Vector& v, double shininess) {
    return Power(Dot(n, Normalized(Sum(l, v, 1))), shininess);
  }
};

TEST_CASE("Phong's highlight takes 5 vector operations and Blinn's 4, of as much arithmetic") {
  const Counter::Vector n{0, 0, 1}, l{0.6, 0, 0.8}, v{-0.6, 0, 0.8};
  Counter phong, blinn;
  CHECK(phong.Phong(n, l, v, 32) == Approx(1));  // in the mirror's direction
  CHECK(blinn.Blinn(n, l, v, 32) == Approx(1));
  CHECK(phong.counts.vector == 5);
  CHECK(blinn.counts.vector == 4);
  CHECK(phong.counts.sums == 7);
  CHECK(blinn.counts.sums == 7);
  CHECK(phong.counts.products == 10);
  CHECK(blinn.counts.products + blinn.counts.divisions == 9);
  CHECK(phong.counts.divisions + phong.counts.roots == 0);
  CHECK(blinn.counts.roots == 1);
  CHECK(phong.counts.powers == blinn.counts.powers);
}

}  // namespace
}  // namespace nacre
