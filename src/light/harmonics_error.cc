// SPDX-License-Identifier: Apache-2.0
#include "light/harmonics_error.h"

#include "base/parallel.h"

namespace nacre {
namespace {

constexpr int kCellRows = 128;
constexpr size_t kNormals = 256;

// How texels and cells divide one side of the image: one of the two is 1.
struct Division {
  int pieces;  // of a texel
  int group;   // texels of a cell
  int cells;

  Division(int texels, int wanted)
      : pieces((wanted + texels - 1) / texels),
        group(std::max(texels / wanted, 1)),
        cells((texels * pieces + group - 1) / group) {}
};

// The integrals of sine and minus cosine of longitude over every piece of a row: x and z.
struct PieceColumn {
  double x, z;
};

std::vector<PieceColumn> MakeColumns(int count) {
  std::vector<PieceColumn> columns;
  columns.reserve(static_cast<size_t>(count));
  for (int i = 0; i < count; ++i) {
    const double first = 2 * M_PI * i / count, last = 2 * M_PI * (i + 1) / count;
    columns.push_back({std::cos(first) - std::cos(last), std::sin(first) - std::sin(last)});
  }
  return columns;
}

// Adds the light of one row of pieces, of `pieces` a texel, to a row of cells.
void AddRow(const EnvironmentMap& map, int row, const std::vector<PieceColumn>& columns,
            const Division& across, int rows, LightCell* cells) {
  // The integrals of sin^2 and sin cos of the angle from +y.
  const double step = M_PI / rows, sum = step * (2 * row + 1);
  const double sin2 = (step - std::sin(step) * std::cos(sum)) / 2;
  const double height =
      std::sin(step) * std::sin(sum) / 2 * 2 * M_PI / static_cast<double>(columns.size());
  const int texel_row = row / (rows / map.height);
  const EnvironmentTexel* const texels =
      map.texels.data() + static_cast<size_t>(texel_row) * static_cast<size_t>(map.width);
  for (size_t i = 0; i < columns.size(); ++i) {
    const EnvironmentTexel& texel = texels[i / static_cast<size_t>(across.pieces)];
    const Vec3d flow(columns[i].x * sin2, height, columns[i].z * sin2);
    LightCell& cell = cells[i / static_cast<size_t>(across.group)];
    cell.red += flow * double{texel.red};
    cell.green += flow * double{texel.green};
    cell.blue += flow * double{texel.blue};
  }
}

// Even over the sphere: a spiral of the golden angle (Gonzalez 2010).
Vec3d SpiralNormal(size_t i) {
  const double y = 1 - (2 * static_cast<double>(i) + 1) / kNormals;
  const double r = std::sqrt((1 - y) * (1 + y));
  const double phi = static_cast<double>(i) * M_PI * (3 - std::sqrt(5.0));
  return {r * std::sin(phi), y, r * std::cos(phi)};
}

}  // namespace

std::vector<LightCell> MakeLightCells(const EnvironmentMap& map, int threads) {
  const Division down(map.height, kCellRows), across(map.width, 2 * kCellRows);
  const std::vector<PieceColumn> columns = MakeColumns(map.width * across.pieces);
  const int rows = map.height * down.pieces;
  std::vector<LightCell> cells(static_cast<size_t>(down.cells) * static_cast<size_t>(across.cells));
  ParallelFor(static_cast<size_t>(down.cells), threads, [&](size_t y) {
    const int first = static_cast<int>(y) * down.group;
    for (int row = first; row < std::min(first + down.group, rows); ++row) {
      AddRow(map, row, columns, across, rows, cells.data() + y * static_cast<size_t>(across.cells));
    }
  });
  return cells;
}

Vec3d Irradiance(const std::vector<LightCell>& cells, const Vec3d& normal) {
  Vec3d sum(0);
  for (const LightCell& cell : cells) {
    sum += Vec3d(std::max(cell.red ^ normal, 0.0), std::max(cell.green ^ normal, 0.0),
                 std::max(cell.blue ^ normal, 0.0));
  }
  return sum;
}

HarmonicsError MeasureHarmonics(const EnvironmentMap& map,
                                const IrradianceHarmonics<double>& harmonics, int threads) {
  const std::vector<LightCell> cells = MakeLightCells(map, threads);
  std::vector<Vec3d> exact(kNormals);
  ParallelFor(kNormals, threads, [&](size_t i) { exact[i] = Irradiance(cells, SpiralNormal(i)); });
  Vec3d mean(0);
  for (const Vec3d& irradiance : exact) mean += irradiance / double{kNormals};
  HarmonicsError error{kNormals, 0, 0};
  double squares = 0, count = 0;
  for (size_t i = 0; i < kNormals; ++i) {
    const Vec3d difference = Irradiance(harmonics, SpiralNormal(i)) - exact[i];
    for (int c = 0; c < 3; ++c) {
      if (!(mean[c] > 0)) continue;  // a channel without light
      const double relative = std::abs(difference[c]) / mean[c];
      error.worst = std::max(error.worst, relative);
      squares += relative * relative;
      count += 1;
    }
  }
  error.rms = count > 0 ? std::sqrt(squares / count) : 0;
  return error;
}

}  // namespace nacre
