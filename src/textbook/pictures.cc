// SPDX-License-Identifier: Apache-2.0
#include "textbook/pictures.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace nacre {
namespace {

const Vec3d kEye(0, 0, 0);
const Vec3d kSphereCenter(0, 0, -3);  // centre of the comparison's sphere, and of the grid
const Rgb kBackground(0.05, 0.05, 0.08);

TextbookPicture MakePicture(int width, int height) {
  TextbookPicture picture{width, height, {}, {}, {}};
  const size_t count = static_cast<size_t>(width) * static_cast<size_t>(height);
  picture.film.assign(count, Rgb(0, 0, 0));
  picture.display.assign(count, Rgb(0, 0, 0));
  picture.sphere.assign(count, 0);
  return picture;
}

TextbookPoint MakePoint(const Vec3d& point, const Vec3d& normal, const Vec3d& light_position,
                        double light_color, const TextbookFaults& faults) {
  TextbookPoint p;
  p.normal = TextbookNormalize(normal, faults);
  p.to_view = TextbookNormalize(kEye - point, faults);
  p.to_light = TextbookNormalize(light_position - point, faults);
  double color = light_color;
  if (!faults.no_falloff) {
    const Vec3d to_center = light_position - kSphereCenter;
    const Vec3d to_point = light_position - point;
    color *= to_center.length2() / to_point.length2();
  }
  p.light = Rgb(color, color, color);
  return p;
}

void Store(const Rgb& radiance, const Rgb& display, size_t pixel, const TextbookFaults& faults,
           TextbookPicture* picture) {
  picture->display[pixel] = display;
  picture->film[pixel] = faults.encode_per_light ? display : radiance;
}

// Stores the sum of `light_count` lights in one place, each with its share of the light's colour.
void StorePbr(const TextbookPoint& p, const TextbookPbr& material, const Rgb& ambient,
              int light_count, const TextbookFaults& faults, size_t pixel,
              TextbookPicture* picture) {
  const Rgb radiance = TextbookPbrRadiance(p, material, faults) + ambient;
  Rgb display;
  if (faults.encode_per_light) {
    display = TextbookEncode(radiance / light_count, faults) * light_count;
    for (int c = 0; c < 3; ++c) display[c] = std::min(display[c], 1.0);
  } else {
    display = TextbookEncode(radiance, faults);
  }
  Store(radiance, display, pixel, faults, picture);
}

void StoreRaw(const Rgb& color, const TextbookFaults& faults, size_t pixel,
              TextbookPicture* picture) {
  Store(color, faults.raw_left_half ? color : TextbookEncode(color, faults), pixel, faults,
        picture);
}

// Calls shade(x, y, point, normal) for pixels where the comparison's camera sees the sphere, and
// miss(x, y) for others.
void ForEachComparisonPixel(int width, int height, const TextbookFaults& faults,
                            const std::function<void(int, int, const Vec3d&, const Vec3d&)>& shade,
                            const std::function<void(int, int)>& miss) {
  const double aspect = static_cast<double>(width) / height;
  const double in_pixel = faults.pixel_corners ? 0 : 0.5;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const double u = (2 * (x + in_pixel) / width - 1) * aspect;
      const double v = 1 - 2 * (y + in_pixel) / height;
      const Vec3d direction = TextbookNormalize(Vec3d(u, v, -1), faults);
      const double t = TextbookIntersectSphere(kEye, direction, kSphereCenter, 1, faults);
      if (t < 0) {
        miss(x, y);
        continue;
      }
      const Vec3d point = kEye + direction * t;
      shade(x, y, point, TextbookNormalize(point - kSphereCenter, faults));
    }
  }
}

// A disc of the grid: centre and radius in pixels, and the sphere that it represents.
struct Disc {
  double cx, cy, radius;
  Vec3d center;  // the sphere's centre, if each had its own position
};

constexpr int kRows = 5, kColumns = 5;
constexpr double kSphereRadius = 0.35;  // the lesson defines it but never uses it

Disc DiscAt(int row, int column, int width, int height) {
  Disc disc;
  disc.cx = (column + 0.5) / kColumns * width;
  disc.cy = (row + 0.5) / kRows * height;
  disc.radius =
      std::min(static_cast<double>(width) / kColumns, static_cast<double>(height) / kRows) * 0.4;
  const double per_pixel = kSphereRadius / disc.radius;
  disc.center = kSphereCenter +
                Vec3d((disc.cx - width / 2.0) * per_pixel, (height / 2.0 - disc.cy) * per_pixel, 0);
  return disc;
}

// Calls shade(px, py, normal) for the pixels of the disc that are in the picture.
void ForEachDiscPixel(const Disc& disc, const TextbookGrid& settings,
                      const std::function<void(int, int, const Vec3d&)>& shade) {
  const int reach = static_cast<int>(disc.radius);
  for (int dy = -reach; dy <= reach; ++dy) {
    for (int dx = -reach; dx <= reach; ++dx) {
      const int px = static_cast<int>(disc.cx + dx);
      const int py = static_cast<int>(disc.cy + dy);
      if (px < 0 || px >= settings.width || py < 0 || py >= settings.height) continue;
      const bool corners = settings.faults.pixel_corners;
      const double nx = (corners ? dx : px + 0.5 - disc.cx) / disc.radius;
      const double ny = -(corners ? dy : py + 0.5 - disc.cy) / disc.radius;
      const double r2 = nx * nx + ny * ny;
      if (r2 > 1) continue;
      shade(px, py, Vec3d(nx, ny, std::sqrt(1 - r2)));
    }
  }
}

// The point at which the lesson shades all discs.
Vec3d SharedPoint(const Vec3d& normal) { return kSphereCenter + normal; }

}  // namespace

TextbookPicture RenderTextbookComparison(const TextbookComparison& s) {
  constexpr double kLightColor = 3;
  TextbookPicture picture = MakePicture(s.width, s.height);
  const auto index = [&](int x, int y) {
    return static_cast<size_t>(y) * static_cast<size_t>(s.width) + static_cast<size_t>(x);
  };
  const Rgb ambient = s.faults.pbr_without_ambient ? Rgb(0, 0, 0) : s.pbr.albedo * s.phong.ka;
  ForEachComparisonPixel(
      s.width, s.height, s.faults,
      [&](int x, int y, const Vec3d& point, const Vec3d& normal) {
        const TextbookPoint p = MakePoint(point, normal, s.light_position, kLightColor, s.faults);
        picture.sphere[index(x, y)] = 1;
        if (x < s.width / 2) {
          StoreRaw(TextbookPhongShading(p, s.phong, s.faults), s.faults, index(x, y), &picture);
        } else {
          StorePbr(p, s.pbr, ambient, s.light_count, s.faults, index(x, y), &picture);
        }
      },
      [&](int x, int y) { StoreRaw(kBackground, s.faults, index(x, y), &picture); });
  return picture;
}

TextbookPicture RenderTextbookGrid(const TextbookGrid& s) {
  const Vec3d light_position(5, 5, 5);
  constexpr double kLightColor = 5;
  TextbookPicture picture = MakePicture(s.width, s.height);
  for (int row = 0; row < kRows; ++row) {
    for (int column = 0; column < kColumns; ++column) {
      TextbookPbr material;
      material.albedo = Rgb(0.9, 0.6, 0.2);
      material.roughness = 0.1 + 0.8 * row / (kRows - 1);
      material.metallic = static_cast<double>(column) / (kColumns - 1);
      const Disc disc = DiscAt(row, column, s.width, s.height);
      ForEachDiscPixel(disc, s, [&](int px, int py, const Vec3d& normal) {
        const size_t pixel =
            static_cast<size_t>(py) * static_cast<size_t>(s.width) + static_cast<size_t>(px);
        const Vec3d point =
            s.faults.shared_grid_point ? SharedPoint(normal) : disc.center + normal * kSphereRadius;
        TextbookPoint p = MakePoint(point, normal, light_position, kLightColor, s.faults);
        if (!s.faults.perspective_view) p.to_view = Vec3d(0, 0, 1);
        picture.sphere[pixel] = 1;
        StorePbr(p, material, Rgb(0, 0, 0), s.light_count, s.faults, pixel, &picture);
      });
    }
  }
  return picture;
}

std::vector<uint8_t> TextbookCodes(const TextbookPicture& picture, const TextbookFaults& faults) {
  const double up = faults.png_truncation ? 0 : 0.5;
  std::vector<uint8_t> codes;
  codes.reserve(3 * picture.pixel_count());
  for (const Rgb& color : picture.display) {
    for (int c = 0; c < 3; ++c) {
      codes.push_back(static_cast<uint8_t>(std::clamp(color[c], 0.0, 1.0) * 255 + up));
    }
  }
  return codes;
}

TextbookLeak MeasureLeak(const Vec3d& light_position, double shininess, bool blinn) {
  const TextbookComparison s;
  constexpr double kVisible = 1.0 / 255;
  TextbookLeak leak;
  int pixels = 0;
  int leaking = 0;
  ForEachComparisonPixel(
      s.width, s.height, s.faults,
      [&](int, int, const Vec3d& point, const Vec3d& normal) {
        const TextbookPoint p = MakePoint(point, normal, light_position, 1, s.faults);
        ++pixels;
        if ((p.normal ^ p.to_light) > 0) return;
        const double lobe =
            blinn ? TextbookBlinnLobe(p, shininess, s.faults) : TextbookPhongLobe(p, shininess);
        leaking += lobe >= kVisible;
        leak.largest = std::max(leak.largest, lobe);
      },
      [](int, int) {});
  leak.share = static_cast<double>(leaking) / pixels;
  return leak;
}

double GridShareSeenFromBehind(const TextbookGrid& settings) {
  int pixels = 0;
  int behind = 0;
  const Disc disc = DiscAt(0, 0, settings.width, settings.height);
  ForEachDiscPixel(disc, settings, [&](int, int, const Vec3d& normal) {
    ++pixels;
    behind += (normal ^ (kEye - SharedPoint(normal))) <= 0;
  });
  return static_cast<double>(behind) / pixels;
}

}  // namespace nacre
