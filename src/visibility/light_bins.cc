#include "visibility/light_bins.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include "visibility/cell_lists.h"
#include "visibility/slopes.h"

namespace nacre {
namespace {

// Cells are made so large that about this many spheres meet in one: a vector of them.
constexpr double kMeeting = 12;
// A sphere that touches more cells than this is tested by every ray instead.
constexpr int kMaxCellsEach = 64;
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

// A sphere relative to the bins' centre, in their axes, its radius with all margins.
struct Placed {
  Vec3d center;
  double radius;
};

class Binner {
 public:
  Binner(const TraceGeometry& geometry, const ShadowLight& light, int threads)
      : spheres_(geometry.spheres), threads_(threads) {
    bins_.positional = light.positional;
    TakeSample();
    ChooseFrame(light);
    const int count = light.positional ? 6 : 1;
    for (int face = 0; face < count; ++face) ChooseGrid(face);
  }

  LightBins Bin() {
    FindLarge();
    SortIntoCells(
        spheres_.size(), cell_count_, std::numeric_limits<uint32_t>::max(), threads_,
        [&](size_t i, const auto& emit) { ForCells(i, emit); }, &bins_.end,
        [&](size_t entries) {
          // Not zeroed: pages are then first touched by the threads that fill them.
          bins_.binned.reset(new BinnedSphere[entries + kBatchPadding]);
          bins_.spheres.reset(new uint32_t[entries + kBatchPadding]);
          std::fill_n(bins_.binned.get() + entries, kBatchPadding, BinnedSphere{0, 0, 0, 0});
          std::fill_n(bins_.spheres.get() + entries, kBatchPadding, 0u);
        },
        [&](size_t i, uint32_t position) {
          bins_.binned[position] = Binned(i);
          bins_.spheres[position] = static_cast<uint32_t>(i);
        });
    CountMeeting();
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

  Placed Place(size_t i) const {
    const auto& [center, radius] = spheres_[i];
    const Vec3d offset = center - bins_.center;
    const Vec3d placed = bins_.positional
                             ? offset
                             : Vec3d(offset.dot(bins_.axes[0]), offset.dot(bins_.axes[1]),
                                     offset.dot(bins_.axes[2]));
    const double size = std::abs(placed.x) + std::abs(placed.y) + std::abs(placed.z) + radius;
    return {placed, radius + margin_ + kFloatShare * size};
  }

  // Where a face sees the sphere; false if it does not. The light is never outside `seen`.
  bool See(const Placed& sphere, int face, Bounds* seen) const {
    const auto& [center, radius] = sphere;
    if (!bins_.positional) {
      *seen = {center.x - radius, center.x + radius, center.y - radius, center.y + radius};
      return true;
    }
    const int axis = face / 2;
    const double z = face % 2 == 0 ? center[axis] : -center[axis];
    if (z + radius <= 0) return false;
    const Interval x = Slopes(center[(axis + 1) % 3], z, radius);
    const Interval y = Slopes(center[(axis + 2) % 3], z, radius);
    constexpr double kRounding = 1e-9;  // of slopes up to 1
    *seen = {x.low - kRounding, x.high + kRounding, y.low - kRounding, y.high + kRounding};
    return seen->x0 <= 1 && seen->x1 >= -1 && seen->y0 <= 1 && seen->y1 >= -1;
  }

  // About the middle of what the sample shows, so that a few far spheres do not stretch it.
  void ChooseGrid(int face) {
    std::vector<double> x, y, width;
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
    LightGrid& grid = bins_.grids[face];
    grid.first_cell = cell_count_;
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
    // With n spheres of this width over the area, (cell + width)^2 n / area of them meet in one.
    const double area = across[0] * across[1];
    const double cell = std::max({std::sqrt(kMeeting * area / count) - size, 0.75 * size,
                                  std::max(across[0], across[1]) / 8192, kTiny});
    grid.x0 = low[0];
    grid.y0 = low[1];
    grid.inverse_cell = 1 / cell;
    grid.columns = static_cast<int>(across[0] / cell) + 1;
    grid.rows = static_cast<int>(across[1] / cell) + 1;
    cell_count_ += static_cast<size_t>(grid.columns) * static_cast<size_t>(grid.rows);
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

  // The boxes of cells on the faces that see the sphere; returns their number, or -1 if it touches
  // too many.
  int BoxesOf(size_t i, CellBox (&boxes)[6], int (&faces)[6]) const {
    if (ReachOf(spheres_[i]) > bins_.max_reach) return -1;
    const Placed placed = Place(i);
    int count = 0;
    int cells = 0;
    for (int face = 0; face < (bins_.positional ? 6 : 1); ++face) {
      Bounds b{};
      if (!See(placed, face, &b)) continue;
      const CellBox box = CellsOf(bins_.grids[face], b);
      if (box.x1 - box.x0 >= kMaxCellsEach || box.y1 - box.y0 >= kMaxCellsEach) return -1;
      cells += (box.x1 - box.x0 + 1) * (box.y1 - box.y0 + 1);
      if (cells > kMaxCellsEach) return -1;
      faces[count] = face;
      boxes[count++] = box;
    }
    return count;
  }

  template <class Emit>
  void ForCells(size_t i, const Emit& emit) const {
    CellBox boxes[6];
    int faces[6];
    const int count = BoxesOf(i, boxes, faces);
    for (int k = 0; k < count; ++k) {
      const LightGrid& grid = bins_.grids[faces[k]];
      for (int row = boxes[k].y0; row <= boxes[k].y1; ++row) {
        for (int column = boxes[k].x0; column <= boxes[k].x1; ++column) {
          emit(grid.first_cell + static_cast<size_t>(row) * static_cast<size_t>(grid.columns) +
               static_cast<size_t>(column));
        }
      }
    }
  }

  BinnedSphere Binned(size_t i) const {
    const Placed placed = Place(i);
    const double z = placed.center.z + (bins_.positional ? 0 : placed.radius);
    // The radius has room for these roundings.
    return {static_cast<float>(placed.center.x), static_cast<float>(placed.center.y),
            static_cast<float>(z), static_cast<float>(placed.radius)};
  }

  void FindLarge() {
    const size_t pieces = CellListPieces(spheres_.size());
    std::vector<std::vector<uint32_t>> found(pieces);
    ParallelFor(pieces, threads_, [&](size_t piece) {
      const size_t end = spheres_.size() * (piece + 1) / pieces;
      for (size_t i = spheres_.size() * piece / pieces; i < end; ++i) {
        CellBox boxes[6];
        int faces[6];
        if (BoxesOf(i, boxes, faces) < 0) found[piece].push_back(static_cast<uint32_t>(i));
      }
    });
    for (const std::vector<uint32_t>& part : found) {
      bins_.large.insert(bins_.large.end(), part.begin(), part.end());
    }
    FindTwins();
  }

  void FindTwins() {
    const auto key = [&](uint32_t i) {
      const auto& [center, radius] = spheres_[i];
      return std::make_tuple(center.x, center.y, center.z, radius, i);
    };
    std::vector<uint32_t> order = bins_.large;
    std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) { return key(a) < key(b); });
    const auto place = [&](uint32_t i) {
      return std::lower_bound(bins_.large.begin(), bins_.large.end(), i) - bins_.large.begin();
    };
    bins_.large_twin.resize(order.size());
    for (size_t i = 0, first = 0; i < order.size(); ++i) {
      if (!Coincide(spheres_[order[i]], spheres_[order[first]])) first = i;
      bins_.large_twin[static_cast<size_t>(place(order[i]))] = order[first];
    }
  }

  void CountMeeting() {
    double sum = 0;
    for (size_t cell = 0; cell < cell_count_; ++cell) {
      const double count = bins_.end[cell] - bins_.Begin(cell);
      sum += count * count;
    }
    bins_.meeting = sum / std::max<double>(1, static_cast<double>(bins_.entries()));
  }

  const std::vector<TraceSphere>& spheres_;
  int threads_;
  std::vector<size_t> sample_;
  double margin_ = 0;
  size_t cell_count_ = 0;
  LightBins bins_;
};

}  // namespace

LightBins BinForLight(const TraceGeometry& geometry, const ShadowLight& light, int threads) {
  return Binner(geometry, light, threads).Bin();
}

}  // namespace nacre
