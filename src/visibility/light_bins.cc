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

// Cells are made so large that at least about this many spheres meet in one, unless there is room.
constexpr double kMeeting = 12;
constexpr size_t kSampleSize = 4096;
constexpr double kFar = 1e30;  // in place of infinity, where it has to be computed with
constexpr double kTiny = 1e-30;

// The share of a double coordinate that its roundings, those of rays and of the projections may
// amount to, many times over; and of a float one, of which the kernel's are a few 2^-24.
constexpr double kDoubleShare = 4e-12;
constexpr double kFloatShare = 32 * 0x1p-24;

struct Bounds {
  double x0, x1, y0, y1;
};

class Binner {
 public:
  Binner(const TraceGeometry& geometry, const ShadowLight& light, size_t room, int threads)
      : spheres_(geometry.spheres),
        threads_(threads),
        room_(static_cast<double>(room) / static_cast<double>(spheres_.size())) {
    bins_.positional = light.positional;
    max_cells_each_ = static_cast<int>(std::clamp(4 * room_, 256.0, 4096.0));
    TakeSample();
    ChooseFrame(light);
    const int count = light.positional ? 6 : 1;
    for (int face = 0; face < count; ++face) ChooseGrid(face);
  }

  LightBins Bin() {
    SortIntoBlocks();
    TakeLarge();
    SortBlocks();
    if (!bins_.overfull) CountMeeting();
    return std::move(bins_);
  }

 private:
  double ReachOf(const TraceSphere& sphere) const { return sphere.center.length() + sphere.radius; }

  void TakeSample() {
    const size_t step = std::max<size_t>(spheres_.size() / kSampleSize, 1);
    for (size_t i = 0; i < spheres_.size(); i += step) sample_.push_back(i);
  }

  // All margins are relative to where most spheres are: a few that are far away go without.
  void ChooseFrame(const ShadowLight& light) {
    std::vector<double> reach;
    reach.reserve(sample_.size());
    for (const size_t i : sample_) reach.push_back(ReachOf(spheres_[i]));
    const size_t most = (reach.size() - 1) * 98 / 100;
    std::nth_element(reach.begin(), reach.begin() + static_cast<std::ptrdiff_t>(most), reach.end());
    const double usual = reach[most] + (light.positional ? light.place.length() : 0);
    bins_.max_reach = 1000 * usual;
    margin_ = kDoubleShare * usual;
    if (light.positional) {
      bins_.center = light.place;
      return;
    }
    bins_.center = spheres_[sample_[sample_.size() / 2]].center;
    const Vec3d& z = light.place;
    const Vec3d least = std::abs(z.x) < 0.6 ? Vec3d(1, 0, 0) : Vec3d(0, 1, 0);
    bins_.axes[0] = z.cross(least).normalized();
    bins_.axes[1] = z.cross(bins_.axes[0]);
    bins_.axes[2] = z;
  }

  // The sphere as it is stored: everything below is computed from that.
  BinnedSphere Place(size_t i) const {
    const auto& [center, radius] = spheres_[i];
    const Vec3d offset = center - bins_.center;
    const Vec3d placed = bins_.positional
                             ? offset
                             : Vec3d(offset.dot(bins_.axes[0]), offset.dot(bins_.axes[1]),
                                     offset.dot(bins_.axes[2]));
    const double size = std::abs(placed.x) + std::abs(placed.y) + std::abs(placed.z) + radius;
    const double bound = radius + margin_ + kFloatShare * size;
    const double z = placed.z + (bins_.positional ? 0 : bound);
    return {static_cast<float>(placed.x), static_cast<float>(placed.y), static_cast<float>(z),
            static_cast<float>(bound)};
  }

  // Where a face sees the sphere; false if it does not.
  bool See(const BinnedSphere& sphere, int face, Bounds* seen) const {
    const double radius = sphere.radius;
    if (!bins_.positional) {
      *seen = {sphere.x - radius, sphere.x + radius, sphere.y - radius, sphere.y + radius};
      return true;
    }
    const double center[3] = {sphere.x, sphere.y, sphere.z};
    const int axis = face / 2;
    const double z = face % 2 == 0 ? center[axis] : -center[axis];
    if (z + radius <= 0) return false;
    const Interval x = Slopes(center[(axis + 1) % 3], z, radius);
    const Interval y = Slopes(center[(axis + 2) % 3], z, radius);
    constexpr double kRounding = 1e-9;  // of slopes up to 1
    *seen = {x.low - kRounding, x.high + kRounding, y.low - kRounding, y.high + kRounding};
    return seen->x0 <= 1 && seen->x1 >= -1 && seen->y0 <= 1 && seen->y1 >= -1;
  }

  // What a face sees of the sample: the spheres' middles and widths.
  struct SeenSample {
    std::vector<double> x, y, width;
  };

  SeenSample SeeSample(int face) const {
    auto [x, y, width] = SeenSample{};
    for (const size_t i : sample_) {
      Bounds b{};
      if (!See(Place(i), face, &b)) continue;
      const auto middle = [](double low, double high) {
        return (std::clamp(low, -kFar, kFar) + std::clamp(high, -kFar, kFar)) / 2;
      };
      x.push_back(middle(b.x0, b.x1));
      y.push_back(middle(b.y0, b.y1));
      width.push_back(std::min(std::min(b.x1 - b.x0, b.y1 - b.y0), kFar));
    }
    return {std::move(x), std::move(y), std::move(width)};
  }

  // About the middle of what the sample shows, so that a few far spheres do not stretch it.
  void ChooseGrid(int face) {
    auto [x, y, width] = SeeSample(face);
    LightGrid& grid = bins_.grids[face];
    grid.first_block = block_count_;
    if (x.empty()) {
      x = y = {0};  // of those not in the sample some may be here
      width = {2};
    }
    const double count = static_cast<double>(spheres_.size()) * static_cast<double>(x.size()) /
                         static_cast<double>(sample_.size());
    const double size = Quantile(&width, 0.5);
    double across[2], low[2];
    std::vector<double>* places[2] = {&x, &y};
    for (int i = 0; i < 2; ++i) {
      low[i] = Quantile(places[i], 0.01) - size / 2;
      double high = Quantile(places[i], 0.99) + size / 2;
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

  // With `count` spheres of this size over the area, (cell + size)^2 count / area of them meet in
  // one cell, and each is in (1 + size / cell)^2 of them.
  double ChooseCell(const double (&across)[2], double size, double count) const {
    const double area = across[0] * across[1];
    const double room = std::sqrt(room_);
    const double widths = std::clamp(1 / std::max(room - 1, 0.1), 0.15, 1.5);
    const double most = room > 2 ? 0 : std::sqrt(kMeeting * area / count) - size;
    const double most_cells =
        std::max(room_, 1.0) * static_cast<double>(spheres_.size()) / (bins_.positional ? 6 : 1);
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

  // The boxes of cells on the faces that see a sphere.
  struct Boxes {
    int count = 0;
    int faces[6];
    CellBox boxes[6];
    bool large = false;  // it touches too many cells
  };

  Boxes BoxesOf(const BinnedSphere& sphere) const {
    Boxes found;
    int cells = 0;
    for (int face = 0; face < (bins_.positional ? 6 : 1); ++face) {
      Bounds b{};
      if (!See(sphere, face, &b)) continue;
      const CellBox box = CellsOf(bins_.grids[face], b);
      const int across = box.x1 - box.x0 + 1;
      const int along = box.y1 - box.y0 + 1;
      found.large = found.large || across > max_cells_each_ || along > max_cells_each_;
      cells += found.large ? 0 : across * along;
      found.faces[found.count] = face;
      found.boxes[found.count++] = box;
    }
    found.large = found.large || cells > max_cells_each_;
    return found;
  }

  // Calls emit(block) for each block of cells that the sphere touches; or, if it is large, for one
  // more that there is not.
  template <class Emit>
  void ForBlocks(size_t i, const Emit& emit) const {
    const Boxes found = BoxesOf(Place(i));
    const double reach = bins_.max_reach - spheres_[i].radius;
    const bool beyond = reach < 0 || spheres_[i].center.length2() > reach * reach;
    if (found.large || beyond) return emit(block_count_);
    for (int k = 0; k < found.count; ++k) {
      const LightGrid& grid = bins_.grids[found.faces[k]];
      const CellBox& box = found.boxes[k];
      for (int row = box.y0 / kBlockSize; row <= box.y1 / kBlockSize; ++row) {
        for (int column = box.x0 / kBlockSize; column <= box.x1 / kBlockSize; ++column) {
          emit(grid.Block(column * kBlockSize, row * kBlockSize));
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
          block_spheres_[position] = Place(i);
          block_numbers_[position] = static_cast<uint32_t>(i);
        });
  }

  // Calls emit(cell within the block, sphere's place in the block's list).
  template <class Emit>
  void ForCells(int face, size_t block, const Emit& emit) const {
    const LightGrid& grid = bins_.grids[face];
    const size_t number = block - grid.first_block;
    const int column = static_cast<int>(number % grid.BlockColumns()) * kBlockSize;
    const int row = static_cast<int>(number / grid.BlockColumns()) * kBlockSize;
    for (uint32_t i = block == 0 ? 0 : block_end_[block - 1]; i < block_end_[block]; ++i) {
      Bounds b{};
      if (!See(block_spheres_[i], face, &b)) continue;
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

  // From the blocks' lists to the cells'.
  void SortBlocks() {
    bins_.end.assign(block_count_ * kBlockCells, 0);
    ParallelFor(block_count_, threads_, [&](size_t block) {
      uint32_t* const count = bins_.end.data() + block * kBlockCells;
      ForCells(FaceOf(block), block, [&](size_t cell, uint32_t) { ++count[cell]; });
    });
    constexpr size_t kMostEntries = size_t{1} << 28;
    bins_.overfull = std::accumulate(bins_.end.begin(), bins_.end.end(), size_t{0}) > kMostEntries;
    if (bins_.overfull) return;
    // Counts become beginnings, and these, as spheres are put in, ends.
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

  // Takes the last list, and the room for it, from the blocks'.
  void TakeLarge() {
    const uint32_t begin = block_count_ == 0 ? 0 : block_end_[block_count_ - 1];
    bins_.large.assign(block_numbers_.data() + begin, block_numbers_.data() + block_end_.back());
    bins_.large_twin = FirstTwins(spheres_, bins_.large);
  }

  void CountMeeting() {
    double sum = 0;
    for (size_t cell = 0; cell < bins_.end.size(); ++cell) {
      const double count = bins_.end[cell] - bins_.Begin(cell);
      sum += count * count;
    }
    bins_.meeting = sum / std::max<double>(1, static_cast<double>(bins_.entries()));
  }

  const HugeArray<TraceSphere>& spheres_;
  int threads_;
  double room_;  // in entries for each sphere
  std::vector<size_t> sample_;
  double margin_ = 0;
  int max_cells_each_;  // a sphere that touches more is tested by every ray instead
  size_t block_count_ = 0;
  std::vector<uint32_t> block_end_;  // of each block's spheres in these:
  HugeArray<BinnedSphere> block_spheres_;
  HugeArray<uint32_t> block_numbers_;
  LightBins bins_;
};

}  // namespace

LightBins BinForLight(const TraceGeometry& geometry, const ShadowLight& light, size_t room,
                      int threads) {
  return Binner(geometry, light, room, threads).Bin();
}

}  // namespace nacre
