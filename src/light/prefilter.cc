// SPDX-License-Identifier: Apache-2.0
#include "light/prefilter.h"

#include "base/parallel.h"

namespace nacre {
namespace {

constexpr int kColumns = 2 * kPrefilterRows;
constexpr size_t kParts = size_t{kPrefilterRows} * kColumns;

// The image in parts of one size by latitude and longitude: the direction of each one's middle, its
// solid angle and its mean radiance. Arrays, for the loop over them to become vectors.
struct ImageParts {
  std::vector<float> x, y, z, solid_angle, red, green, blue;
};

// How much of texels' range [at, at + 1) is in part `part` of `parts` of `texels`.
double Overlap(double texels, double parts, double part, double at) {
  const double scale = texels / parts;
  return std::max(std::min((part + 1) * scale, at + 1) - std::max(part * scale, at), 0.0);
}

// The mean of radiance over a part. Within it latitudes count alike.
Vec3d MeanRadiance(const EnvironmentMap& map, int column, int row) {
  const auto first = [](int texels, int parts, int part) {
    return static_cast<int>(int64_t{texels} * part / parts);
  };
  const auto last = [](int texels, int parts, int part) {
    return static_cast<int>((int64_t{texels} * (part + 1) + parts - 1) / parts);
  };
  Vec3d sum(0);
  double weights = 0;
  for (int y = first(map.height, kPrefilterRows, row); y < last(map.height, kPrefilterRows, row);
       ++y) {
    const double across =
        Overlap(map.height, kPrefilterRows, row, y) * TexelSolidAngle(map.width, map.height, y);
    for (int x = first(map.width, kColumns, column); x < last(map.width, kColumns, column); ++x) {
      const EnvironmentTexel& texel =
          map.texels[static_cast<size_t>(y) * static_cast<size_t>(map.width) +
                     static_cast<size_t>(x)];
      const double weight = across * Overlap(map.width, kColumns, column, x);
      sum += Vec3d(texel.red, texel.green, texel.blue) * weight;
      weights += weight;
    }
  }
  return sum / weights;
}

ImageParts MakeParts(const EnvironmentMap& map, int threads) {
  ImageParts parts;
  for (std::vector<float>* array :
       {&parts.x, &parts.y, &parts.z, &parts.solid_angle, &parts.red, &parts.green, &parts.blue}) {
    array->resize(kParts);
  }
  ParallelFor(kPrefilterRows, threads, [&](size_t row) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < kColumns; ++x) {
      const size_t i = row * kColumns + static_cast<size_t>(x);
      const Vec3f middle(DirectionFromLatLong((x + 0.5) / kColumns, (y + 0.5) / kPrefilterRows));
      const Vec3f radiance(MeanRadiance(map, x, y));
      parts.x[i] = middle.x;
      parts.y[i] = middle.y;
      parts.z[i] = middle.z;
      parts.solid_angle[i] = static_cast<float>(TexelSolidAngle(kColumns, kPrefilterRows, y));
      parts.red[i] = radiance.x;
      parts.green[i] = radiance.y;
      parts.blue[i] = radiance.z;
    }
  });
  return parts;
}

// The mean of radiance under the lobe about a direction.
Vec3f Blur(const ImageParts& parts, const Vec3f& mirror, double alpha) {
  // D's shape: 1 / (1 + n.h^2 (alpha^2 - 1))^2, with n.h^2 = (1 + cos t) / 2.
  const auto slope = static_cast<float>((alpha * alpha - 1) / 2);
  double red = 0, green = 0, blue = 0, weights = 0;
  // Rows are added in float, and their sums in double.
  for (size_t row = 0; row < kParts; row += kColumns) {
    // Apart from the sums, whose order is fixed: these may become vectors.
    float row_weights[kColumns];
    for (size_t i = 0; i < kColumns; ++i) {
      const size_t part = row + i;
      const float cosine =
          mirror.x * parts.x[part] + mirror.y * parts.y[part] + mirror.z * parts.z[part];
      const float root = 1 + (1 + cosine) * slope;
      row_weights[i] = std::max(cosine, 0.0f) / (root * root) * parts.solid_angle[part];
    }
    float sums[4] = {0, 0, 0, 0};
    for (size_t i = 0; i < kColumns; ++i) {
      const float weight = row_weights[i];
      sums[0] += weight * parts.red[row + i];
      sums[1] += weight * parts.green[row + i];
      sums[2] += weight * parts.blue[row + i];
      sums[3] += weight;
    }
    red += sums[0];
    green += sums[1];
    blue += sums[2];
    weights += sums[3];
  }
  return Vec3f(Vec3d(red, green, blue) / weights);
}

}  // namespace

PrefilteredMap Prefilter(const EnvironmentMap& map, double alpha, int threads) {
  const ImageParts parts = MakeParts(map, threads);
  int rows = kPrefilterRows;
  while (rows > 16 && alpha * rows >= 2 * kLeastPrefilterAlpha * kPrefilterRows) rows /= 2;
  const auto columns = 2 * static_cast<size_t>(rows);
  PrefilteredMap filtered{alpha, rows,
                          std::vector<Vec3f>((static_cast<size_t>(rows) + 1) * columns)};
  ParallelFor(static_cast<size_t>(rows) + 1, threads, [&](size_t row) {
    for (size_t x = 0; x < columns; ++x) {
      const Vec3f mirror(DirectionFromLatLong(static_cast<double>(x) / static_cast<double>(columns),
                                              static_cast<double>(row) / rows));
      filtered.texels[row * columns + x] = Blur(parts, mirror, alpha);
    }
  });
  return filtered;
}

}  // namespace nacre
