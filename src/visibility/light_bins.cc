// SPDX-License-Identifier: Apache-2.0
#include "visibility/light_bins.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "visibility/cell_lists.h"
#include "visibility/slopes.h"

namespace nacre {
namespace {

// Cells are made so large that each holds about this many spheres, unless the budget allows smaller
// cells.
constexpr double kSpheresPerCell = 12;
constexpr size_t kSampleSize = 4096;
constexpr double kFar = 1e30;  // replaces infinity where differences are computed
constexpr double kTiny = 1e-30;

// Generous bounds of the relative rounding errors of coordinates: in double those of rays and
// projections, in float those of the kernel, a few 2^-24.
constexpr double kDoubleError = 4e-12;
constexpr double kFloatError = 32 * 0x1p-24;

struct Bounds {
  double x0, x1, y0, y1;
};

class Binner {
 public:
  Binner(const TraceGeometry& geometry, const ShadowLight& light, size_t entry_budget, int threads)
      : spheres_(geometry.spheres),
        threads_(threads),
        entries_per_sphere_(static_cast<double>(entry_budget) /
                            static_cast<double>(spheres_.size())) {
    bins_.positional = light.positional;
    max_cells_each_ = static_cast<int>(std::clamp(4 * entries_per_sphere_, 256.0, 4096.0));
    TakeSample();
    ChooseFrame(light);
    const int count = light.positional ? 6 : 1;
    for (int face = 0; face < count; ++face) ChooseGrid(face);
  }

  LightBins Bin() {
    SortIntoBlocks();
    TakeLarge();
    SortBlocks();
    if (!bins_.overfull) MeasureOccupancy();
    return std::move(bins_);
  }

 private:
  void TakeSample() {
    const size_t step = std::max<size_t>(spheres_.size() / kSampleSize, 1);
    for (size_t i = 0; i < spheres_.size(); i += step) sample_.push_back(i);
  }

  // All margins are proportional to the distance that contains most spheres. A few that are much
  // farther away are not binned.
  void ChooseFrame(const ShadowLight& light) {
    std::vector<double> distances;
    distances.reserve(sample_.size());
    for (const size_t i : sample_) {
      distances.push_back(spheres_[i].center.length() + spheres_[i].radius);
    }
    const size_t most = (distances.size() - 1) * 98 / 100;
    std::nth_element(distances.begin(), distances.begin() + static_cast<std::ptrdiff_t>(most),
                     distances.end());
    const double usual = distances[most] + (light.positional ? light.position.length() : 0);
    bins_.max_distance = 1000 * usual;
    margin_ = kDoubleError * usual;
    if (light.positional) {
      bins_.center = light.position;
      return;
    }
    bins_.center = spheres_[sample_[sample_.size() / 2]].center;
    const Vec3d& z = light.to_light;
    const Vec3d least = std::abs(z.x) < 0.6 ? Vec3d(1, 0, 0) : Vec3d(0, 1, 0);
    bins_.axes[0] = z.cross(least).normalized();
    bins_.axes[1] = z.cross(bins_.axes[0]);
    bins_.axes[2] = z;
  }

  // The sphere as it is stored. Everything below is computed from these rounded numbers.
  BinnedSphere Binned(size_t i) const {
    const auto& [center, radius] = spheres_[i];
    const Vec3d offset = center - bins_.center;
    const Vec3d local = bins_.positional
                            ? offset
                            : Vec3d(offset.dot(bins_.axes[0]), offset.dot(bins_.axes[1]),
                                    offset.dot(bins_.axes[2]));
    const double size = std::abs(local.x) + std::abs(local.y) + std::abs(local.z) + radius;
    const double bound = radius + margin_ + kFloatError * size;
    const double z = local.z + (bins_.positional ? 0 : bound);
    return {static_cast<float>(local.x), static_cast<float>(local.y), static_cast<float>(z),
            static_cast<float>(bound)};
  }

  // Computes the bounds of the sphere's projection to a face; false if it lies outside of the face.
  bool ProjectToFace(const BinnedSphere& sphere, int face, Bounds* bounds) const {
    const double radius = sphere.radius;
    if (!bins_.positional) {
      *bounds = {sphere.x - radius, sphere.x + radius, sphere.y - radius, sphere.y + radius};
      return true;
    }
    const double center[3] = {sphere.x, sphere.y, sphere.z};
    const int axis = face / 2;
    const double z = face % 2 == 0 ? center[axis] : -center[axis];
    if (z + radius <= 0) return false;
    const SlopeRange x = Slopes(center[(axis + 1) % 3], z, radius);
    const SlopeRange y = Slopes(center[(axis + 2) % 3], z, radius);
    constexpr double kRounding = 1e-9;  // of slopes up to 1
    *bounds = {x.low - kRounding, x.high + kRounding, y.low - kRounding, y.high + kRounding};
    return bounds->x0 <= 1 && bounds->x1 >= -1 && bounds->y0 <= 1 && bounds->y1 >= -1;
  }

  // Middles and widths of the sample's projections to a face.
  struct ProjectedSample {
    std::vector<double> x, y, width;
  };

  ProjectedSample ProjectSample(int face) const {
    auto [x, y, width] = ProjectedSample{};
    for (const size_t i : sample_) {
      Bounds b{};
      if (!ProjectToFace(Binned(i), face, &b)) continue;
      const auto middle = [](double low, double high) {
        return (std::clamp(low, -kFar, kFar) + std::clamp(high, -kFar, kFar)) / 2;
      };
      x.push_back(middle(b.x0, b.x1));
      y.push_back(middle(b.y0, b.y1));
      width.push_back(std::min(std::min(b.x1 - b.x0, b.y1 - b.y0), kFar));
    }
    return {std::move(x), std::move(y), std::move(width)};
  }

  // The grid covers the central 98 % of the sample, so that a few far spheres do not stretch it.
  void ChooseGrid(int face) {
    auto [x, y, width] = ProjectSample(face);
    LightGrid& grid = bins_.grids[face];
    grid.first_block = block_count_;
    if (x.empty()) {
      x = y = {0};  // spheres that are not in the sample may lie here
      width = {2};
    }
    const double count = static_cast<double>(spheres_.size()) * static_cast<double>(x.size()) /
                         static_cast<double>(sample_.size());
    const double size = Quantile(&width, 0.5);
    double across[2], low[2];
    std::vector<double>* middles[2] = {&x, &y};
    for (int i = 0; i < 2; ++i) {
      low[i] = Quantile(middles[i], 0.01) - size / 2;
      double high = Quantile(middles[i], 0.99) + size / 2;
      if (bins_.positional) {
        low[i] = std::max(low[i], -1.0);
        high = std::min(high, 1.0);
      }
      across[i] = std::max(high - low[i], 0.0);
    }
    const double cell = ChooseCell(across, size, count);
    grid.x0 = low[0];
    grid.y0 = low[1];
    grid.inverse_cell = 1 / cell;
    grid.columns = static_cast<int>(across[0] / cell) + 1;
    grid.rows = static_cast<int>(across[1] / cell) + 1;
    block_count_ += grid.BlockColumns() * grid.BlockRows();
  }

  // With `count` spheres of this size over the area, a cell holds (cell + size)^2 count / area of
  // them, and a sphere lies in (1 + size / cell)^2 cells.
  double ChooseCell(const double (&across)[2], double size, double count) const {
    const double area = across[0] * across[1];
    const double cells_across = std::sqrt(entries_per_sphere_);
    const double widths = std::clamp(1 / std::max(cells_across - 1, 0.1), 0.15, 1.5);
    const double most = cells_across > 2 ? 0 : std::sqrt(kSpheresPerCell * area / count) - size;
    const double most_cells = std::max(entries_per_sphere_, 1.0) *
                              static_cast<double>(spheres_.size()) / (bins_.positional ? 6 : 1);
    return std::max({most, widths * size, std::sqrt(area / most_cells),
                     std::max(across[0], across[1]) / 8192, kTiny});
  }

  static double Quantile(std::vector<double>* values, double share) {
    const auto at = values->begin() +
                    static_cast<std::ptrdiff_t>(share * static_cast<double>(values->size() - 1));
    std::nth_element(values->begin(), at, values->end());
    return *at;
  }

  struct CellBox {
    int x0, x1, y0, y1;
  };

  CellBox CellsOf(const LightGrid& grid, const Bounds& b) const {
    return {grid.Column(b.x0), grid.Column(b.x1), grid.Row(b.y0), grid.Row(b.y1)};
  }

  // Calls emit(block) for each block of cells that the sphere's projections cover; for a sphere
  // that covers too many cells or is too far away, once with the index behind the last block.
  template <class Emit>
  void ForBlocks(size_t i, const Emit& emit) const {
    const double distance = bins_.max_distance - spheres_[i].radius;
    const bool beyond = distance < 0 || spheres_[i].center.length2() > distance * distance;
    if (beyond) return emit(block_count_);
    const BinnedSphere sphere = Binned(i);
    struct {
      const LightGrid* grid;
      CellBox box;
    } covered[6];
    int count = 0, cells = 0;
    for (int face = 0; face < (bins_.positional ? 6 : 1); ++face) {
      Bounds b{};
      if (!ProjectToFace(sphere, face, &b)) continue;
      const LightGrid& grid = bins_.grids[face];
      const CellBox box = CellsOf(grid, b);
      const int across = box.x1 - box.x0 + 1, along = box.y1 - box.y0 + 1;
      if (std::max(across, along) > max_cells_each_) return emit(block_count_);
      cells += across * along;
      if (cells > max_cells_each_) return emit(block_count_);
      covered[count++] = {&grid, box};
    }
    for (int k = 0; k < count; ++k) {
      const auto& [grid, box] = covered[k];
      for (int row = box.y0 / kBlockSize; row <= box.y1 / kBlockSize; ++row) {
        for (int column = box.x0 / kBlockSize; column <= box.x1 / kBlockSize; ++column) {
          emit(grid->Block(column * kBlockSize, row * kBlockSize));
        }
      }
    }
  }

  void SortIntoBlocks() {
    SortIntoCells(
        spheres_.size(), block_count_ + 1, std::numeric_limits<uint32_t>::max(), threads_,
        [&](size_t i, const auto& emit) { ForBlocks(i, emit); }, &block_end_,
        [&](size_t entries) {
          block_spheres_ = HugeArray<BinnedSphere>(entries);
          block_numbers_ = HugeArray<uint32_t>(entries);
        },
        [&](size_t i, size_t, uint32_t position) {
          block_spheres_[position] = Binned(i);
          block_numbers_[position] = static_cast<uint32_t>(i);
        });
  }

  // Calls emit(cell within the block, index in block_spheres_).
  template <class Emit>
  void ForCells(int face, size_t block, const Emit& emit) const {
    const LightGrid& grid = bins_.grids[face];
    const size_t number = block - grid.first_block;
    const int column = static_cast<int>(number % grid.BlockColumns()) * kBlockSize;
    const int row = static_cast<int>(number / grid.BlockColumns()) * kBlockSize;
    for (uint32_t i = block == 0 ? 0 : block_end_[block - 1]; i < block_end_[block]; ++i) {
      Bounds b{};
      if (!ProjectToFace(block_spheres_[i], face, &b)) continue;
      const CellBox box = CellsOf(grid, b);
      const int x1 = std::min(box.x1, column + kBlockSize - 1);
      const int y1 = std::min(box.y1, row + kBlockSize - 1);
      for (int y = std::max(box.y0, row); y <= y1; ++y) {
        for (int x = std::max(box.x0, column); x <= x1; ++x) emit(LightGrid::InBlock(x, y), i);
      }
    }
  }

  int FaceOf(size_t block) const {
    int face = 0;
    while (bins_.positional && face < 5 && bins_.grids[face + 1].first_block <= block) ++face;
    return face;
  }

  // Sorts the spheres of each block into the lists of its cells.
  void SortBlocks() {
    bins_.end.assign(block_count_ * kBlockCells, 0);
    ParallelFor(block_count_, threads_, [&](size_t block) {
      uint32_t* const count = bins_.end.data() + block * kBlockCells;
      ForCells(FaceOf(block), block, [&](size_t cell, uint32_t) { ++count[cell]; });
    });
    constexpr size_t kMostEntries = size_t{1} << 28;
    bins_.overfull = std::accumulate(bins_.end.begin(), bins_.end.end(), size_t{0}) > kMostEntries;
    if (bins_.overfull) return;
    // The counts become the begins of the lists, and then their ends as the lists are filled.
    uint32_t sum = 0;
    for (uint32_t& count : bins_.end) sum += std::exchange(count, sum);
    bins_.binned = HugeArray<BinnedSphere>(sum + kBatchPadding);
    bins_.spheres = HugeArray<uint32_t>(sum + kBatchPadding);
    std::fill_n(bins_.binned.data() + sum, kBatchPadding, BinnedSphere{0, 0, 0, 0});
    std::fill_n(bins_.spheres.data() + sum, kBatchPadding, 0u);
    ParallelFor(block_count_, threads_, [&](size_t block) {
      uint32_t* const next = bins_.end.data() + block * kBlockCells;
      ForCells(FaceOf(block), block, [&](size_t cell, uint32_t i) {
        const uint32_t position = next[cell]++;
        bins_.binned[position] = block_spheres_[i];
        bins_.spheres[position] = block_numbers_[i];
      });
    });
    block_spheres_ = {};
    block_numbers_ = {};
  }

  // Moves the list behind the last block, which holds large and far spheres, to LightBins::large.
  void TakeLarge() {
    const uint32_t begin = block_count_ == 0 ? 0 : block_end_[block_count_ - 1];
    bins_.large.assign(block_numbers_.data() + begin, block_numbers_.data() + block_end_.back());
  }

  void MeasureOccupancy() {
    double sum = 0;
    for (size_t cell = 0; cell < bins_.end.size(); ++cell) {
      const double count = bins_.end[cell] - bins_.Begin(cell);
      sum += count * count;
    }
    bins_.mean_occupancy = sum / std::max<double>(1, static_cast<double>(bins_.entries()));
  }

  const HugeArray<TraceSphere>& spheres_;
  int threads_;
  double entries_per_sphere_;  // in the budget
  std::vector<size_t> sample_;
  double margin_ = 0;
  int max_cells_each_;  // every ray is tested against spheres that cover more cells
  size_t block_count_ = 0;
  std::vector<uint32_t> block_end_;  // where each block's list in the next two arrays ends
  HugeArray<BinnedSphere> block_spheres_;
  HugeArray<uint32_t> block_numbers_;
  LightBins bins_;
};

}  // namespace

LightBins BinForLight(const TraceGeometry& geometry, const ShadowLight& light, size_t entry_budget,
                      int threads) {
  LightBins bins = Binner(geometry, light, entry_budget, threads).Bin();
  bins.made_eye = geometry.eye;
  bins.made_center = bins.center;
  return bins;
}

// Binned spheres are relative to the centre, and so unaffected. All else is relative to the camera,
// and rounded, before the move and after it, to 2^-53 of numbers that are at most about
// max_distance: by some 1e-16 max_distance, which is a fortieth of the margins (kDoubleError of a
// thousandth of max_distance).
bool MoveBins(const TraceGeometry& geometry, LightBins* bins) {
  const Vec3d moved = bins->made_eye - geometry.eye;
  if (!(moved.length() <= bins->max_distance / 250)) return false;
  bins->center = bins->made_center + moved;
  return true;
}

// A changed sphere still has entries at its former place, which propose it in vain: the exact test
// reads the geometry.
bool TakeChanged(const std::vector<ChangedSphere>& changed, LightBins* bins) {
  constexpr size_t kMost = 8;
  for (const ChangedSphere& sphere : changed) {
    const auto end = bins->changed.end();
    if (std::find(bins->changed.begin(), end, sphere.index) != end) continue;
    bins->changed.push_back(sphere.index);
  }
  return bins->changed.size() <= kMost;
}

}  // namespace nacre
