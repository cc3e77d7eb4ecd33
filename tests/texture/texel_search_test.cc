// SPDX-License-Identifier: Apache-2.0
// Rare texels in footprints of so many that they are searched by squares, against a look at each.
#include "texture/texel_search.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>

#include "catch.h"

namespace nacre {
namespace {

constexpr float kDark = 0.125F, kBright = 4;

int TexelAt(double at, int size, Wrap wrap) {
  return std::min(static_cast<int>(WrapCoordinate(at / size, wrap) * size), size - 1);
}

struct OneBright {
  int width, height, x, y;
  std::vector<float> values;
  TexelGrid grid;

  OneBright(int w, int h, Wrap wrap, std::mt19937* random) : width(w), height(h) {
    // Texels on edges that are clamped are larger.
    x = 1 + static_cast<int>((*random)() % static_cast<unsigned>(w - 2));
    y = 1 + static_cast<int>((*random)() % static_cast<unsigned>(h - 2));
    values.assign(static_cast<size_t>(w * h), kDark);
    values[static_cast<size_t>(y * w + x)] = kBright;
    grid = {{TexelKind::kFloats, values.data(), nullptr, 1, w, h}, wrap, wrap};
  }
  bool IsBright(double u, double v) const {
    return TexelAt(u, width, grid.wrap_u) == x && TexelAt(v, height, grid.wrap_v) == y;
  }
};

bool IsInPixel(const Vec2d& offset) {
  return std::abs(offset.x) <= 0.5 && std::abs(offset.y) <= 0.5;
}

// Whether the centre of a bright texel lies in the pixel.
bool HoldsBright(const OneBright& image, const TexelFootprint& f) {
  const double determinant = f.x_dx * f.y_dy - f.x_dy * f.y_dx;
  const double half_x = (std::abs(f.x_dx) + std::abs(f.x_dy)) / 2;
  const double half_y = (std::abs(f.y_dx) + std::abs(f.y_dy)) / 2;
  for (double y = std::floor(f.y - half_y) + 0.5; y <= f.y + half_y; ++y) {
    for (double x = std::floor(f.x - half_x) + 0.5; x <= f.x + half_x; ++x) {
      const double dx = x - f.x, dy = y - f.y;
      const Vec2d offset((f.y_dy * dx - f.x_dy * dy) / determinant,
                         (f.x_dx * dy - f.y_dx * dx) / determinant);
      if (IsInPixel(offset) && image.IsBright(x, y)) return true;
    }
  }
  return false;
}

// Whether the search finds it; all that it finds must lie in the pixel.
bool Finds(const OneBright& image, const TexelFootprint& f) {
  const TexelExtremes extremes(image.grid);
  TexelSearchRoom room;
  std::vector<TexelCluster> clusters;
  FindTexelClusters(image.grid, &extremes, f, {{}}, &room, &clusters);
  bool found = false;
  for (const TexelCluster& cluster : clusters) {
    CHECK(IsInPixel(cluster.offset));
    const double x = f.x + f.x_dx * cluster.offset.x + f.x_dy * cluster.offset.y;
    const double y = f.y + f.y_dx * cluster.offset.x + f.y_dy * cluster.offset.y;
    found |= image.IsBright(x, y);
  }
  return found;
}

TEST_CASE(
    "a bright texel among thousands is found, beside and across the edges of its image, too") {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> at(-300, 300), unit(-1, 1);
  int held = 0;
  for (const Wrap wrap : {Wrap::kRepeat, Wrap::kMirror, Wrap::kClamp}) {
    for (const auto& [width, height] : {std::pair{100, 100}, {96, 37}, {64, 128}, {257, 60}}) {
      for (int i = 0; i < 60; ++i) {
        const OneBright image(width, height, wrap, &random);
        const TexelFootprint f{at(random),        at(random),        80,
                               20 * unit(random), 20 * unit(random), 80};
        CAPTURE(wrap, width, height, f.x, f.y, f.y_dx, f.x_dy, image.x, image.y);
        const bool holds = HoldsBright(image, f);
        CHECK(Finds(image, f) == holds);
        held += holds ? 1 : 0;
      }
    }
  }
  CHECK(held > 100);
}

TEST_CASE("what is found in long thin footprints lies in them") {
  std::mt19937 random(12);
  for (int i = 0; i < 200; ++i) {
    const OneBright image(512, 4096, Wrap::kRepeat, &random);
    const double offset = static_cast<double>(i % 8) - 3.5;  // of the texel from the strip
    const TexelFootprint f{image.x + 0.5 + offset, 2048, 1.5, 0, 0, 4000};
    CHECK(Finds(image, f) == HoldsBright(image, f));
  }
}

}  // namespace
}  // namespace nacre
