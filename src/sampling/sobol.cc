// SPDX-License-Identifier: Apache-2.0
#include "sampling/sobol.h"

#include <array>

#include "sampling/hash.h"

namespace nacre {
namespace {

// A dimension's primitive polynomial over GF(2), of degree `degree`, whose inner coefficients are
// the bits of `coefficients`, and the initial direction numbers.
struct Polynomial {
  uint32_t degree;
  uint32_t coefficients;
  std::array<uint32_t, 6> initial;
};

// Joe and Kuo 2008, "Constructing Sobol sequences with better two-dimensional projections", file
// new-joe-kuo-6.21201, dimensions 2 to 16. Dimension 1 is van der Corput's sequence.
constexpr Polynomial kPolynomials[kSobolDimensions - 1] = {
    {1, 0, {1}},
    {2, 1, {1, 3}},
    {3, 1, {1, 3, 1}},
    {3, 2, {1, 1, 1}},
    {4, 1, {1, 1, 3, 3}},
    {4, 4, {1, 3, 5, 13}},
    {5, 2, {1, 1, 5, 5, 17}},
    {5, 4, {1, 1, 5, 5, 5}},
    {5, 7, {1, 1, 7, 11, 19}},
    {5, 11, {1, 1, 5, 1, 1}},
    {5, 13, {1, 1, 1, 3, 11}},
    {5, 14, {1, 3, 5, 5, 31}},
    {6, 1, {1, 3, 3, 9, 7, 49}},
    {6, 13, {1, 1, 1, 15, 21, 21}},
    {6, 16, {1, 3, 1, 13, 27, 49}},
};

// Column k of a dimension's generator matrix: what bit k of the index adds.
using Matrix = std::array<uint32_t, 32>;

constexpr Matrix MakeMatrix(uint32_t dimension) {
  Matrix columns{};
  if (dimension == 0) {
    for (uint32_t k = 0; k < 32; ++k) columns[k] = 1u << (31 - k);
    return columns;
  }
  const Polynomial& polynomial = kPolynomials[dimension - 1];
  const uint32_t degree = polynomial.degree;
  for (uint32_t k = 0; k < 32; ++k) {
    if (k < degree) {
      columns[k] = polynomial.initial[k] << (31 - k);
      continue;
    }
    // Bratley and Fox 1988, the recurrence for direction numbers.
    columns[k] = columns[k - degree] ^ (columns[k - degree] >> degree);
    for (uint32_t i = 1; i < degree; ++i) {
      if ((polynomial.coefficients >> (degree - 1 - i)) & 1u) columns[k] ^= columns[k - i];
    }
  }
  return columns;
}

constexpr std::array<Matrix, kSobolDimensions> MakeMatrices() {
  std::array<Matrix, kSobolDimensions> matrices{};
  for (uint32_t dimension = 0; dimension < kSobolDimensions; ++dimension) {
    matrices[dimension] = MakeMatrix(dimension);
  }
  return matrices;
}

constexpr std::array<Matrix, kSobolDimensions> kMatrices = MakeMatrices();

constexpr uint32_t ReverseBits(uint32_t x) {
  x = (x << 16) | (x >> 16);
  x = ((x & 0x00ff00ffu) << 8) | ((x >> 8) & 0x00ff00ffu);
  x = ((x & 0x0f0f0f0fu) << 4) | ((x >> 4) & 0x0f0f0f0fu);
  x = ((x & 0x33333333u) << 2) | ((x >> 2) & 0x33333333u);
  return ((x & 0x55555555u) << 1) | ((x >> 1) & 0x55555555u);
}

}  // namespace

uint32_t SobolBits(uint32_t index, uint32_t dimension) {
  uint32_t bits = 0;
  for (uint32_t k = 0; index != 0; index >>= 1, ++k) {
    bits ^= kMatrices[dimension][k] & (0u - (index & 1u));  // no branch: bits are unpredictable
  }
  return bits;
}

// The bits are reversed, so that each may depend on lower bits only, as it does in sums and
// products. The hash is that of Laine and Karras 2011 in the better form of Vegdahl 2021, "Building
// a Better LK Hash".
uint32_t OwenScramble(uint32_t bits, uint32_t seed) {
  uint32_t x = ReverseBits(bits);
  x ^= x * 0x3d20adeau;
  x += seed;
  x *= (seed >> 16) | 1u;
  x ^= x * 0x05526c56u;
  x ^= x * 0x53a22864u;
  return ReverseBits(x);
}

Vec2d SobolSample2D(uint32_t index, uint32_t pair, uint64_t seed) {
  const uint64_t sequence_seed = HashCombine(seed, pair / kSobolPairs);
  const uint64_t pair_seed = HashCombine(sequence_seed, 1 + pair % kSobolPairs);
  // The first sequence keeps its order. The others are shuffled, so that they are not correlated
  // with it.
  const uint32_t shuffled =
      pair < kSobolPairs ? index : OwenScramble(index, static_cast<uint32_t>(sequence_seed));
  const uint32_t dimension = 2 * (pair % kSobolPairs);
  return {
      UnitFromBits(OwenScramble(SobolBits(shuffled, dimension), static_cast<uint32_t>(pair_seed))),
      UnitFromBits(OwenScramble(SobolBits(shuffled, dimension + 1),
                                static_cast<uint32_t>(pair_seed >> 32)))};
}

}  // namespace nacre
