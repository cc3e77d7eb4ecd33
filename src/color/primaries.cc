// SPDX-License-Identifier: Apache-2.0
#include "color/primaries.h"

#include <cmath>

#include "base/numbers.h"

namespace nacre {
namespace {

Vec3d XyzOf(const Vec2d& at) { return {at.x, at.y, 1 - at.x - at.y}; }

// The XYZ of each primary as a row, up to a factor.
Imath::M33d Directions(const Primaries& p) {
  const Vec3d red = XyzOf(p.red), green = XyzOf(p.green), blue = XyzOf(p.blue);
  return {red.x, red.y, red.z, green.x, green.y, green.z, blue.x, blue.y, blue.z};
}

// The XYZ of white, with Y = 1.
Vec3d WhiteOf(const Primaries& p) { return XyzOf(p.white) / p.white.y; }

// The amounts of the rows of Directions that add up to white.
Vec3d Shares(const Primaries& p) { return WhiteOf(p) * Directions(p).inverse(); }

// Maps XYZ to the responses of sharpened cones; transposed, as all matrices here are.
const Imath::M33d kBradford(.8951, -.7502, .0389, .2664, 1.7135, -.0685, -.1614, .0367, 1.0296);

// xyz * the matrix is the colour that looks under the white `to` as xyz looks under `from`.
Imath::M33d Adapt(const Vec3d& from, const Vec3d& to) {
  const Vec3d ratio = (to * kBradford) / (from * kBradford);
  return kBradford * Imath::M33d(ratio.x, 0, 0, 0, ratio.y, 0, 0, 0, ratio.z) * kBradford.inverse();
}

bool AreXyz(const Primaries& p) { return SamePrimaries(p, {{1, 0}, {0, 1}, {0, 0}, p.white}); }

}  // namespace

std::optional<Primaries> ParsePrimaries(std::string_view text) {
  const auto numbers = ParseNumbers(text);
  if (!numbers || numbers->size() != 8) return {};
  for (const double number : *numbers) {
    if (!(std::abs(number) <= 10)) return {};
  }
  const auto at = [&](size_t i) { return Vec2d((*numbers)[2 * i], (*numbers)[2 * i + 1]); };
  const Primaries primaries{at(0), at(1), at(2), at(3)};
  // The determinant is twice the area of the primaries' triangle. Below the error of the corners,
  // the primaries count as collinear.
  if (!(std::abs(Directions(primaries).determinant()) > kPrimariesError)) return {};
  if (!(primaries.white.y > kPrimariesError)) return {};
  const Vec3d shares = Shares(primaries), cones = WhiteOf(primaries) * kBradford;
  for (int i = 0; i < 3; ++i) {
    if (!(shares[i] > 0 && cones[i] > 0)) return {};
  }
  return primaries;
}

bool SamePrimaries(const Primaries& a, const Primaries& b) {
  const auto near = [](const Vec2d& p, const Vec2d& q) {
    return std::abs(p.x - q.x) <= kPrimariesError && std::abs(p.y - q.y) <= kPrimariesError;
  };
  return near(a.red, b.red) && near(a.green, b.green) && near(a.blue, b.blue) &&
         near(a.white, b.white);
}

Imath::M33d XyzFromRgb(const Primaries& p) {
  Imath::M33d matrix = Directions(p);
  const Vec3d shares = Shares(p);
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) matrix[i][j] *= shares[i];
  }
  return matrix;
}

Imath::M33d Rec709FromPrimaries(const Primaries& primaries) {
  const Primaries rec709 = *ParsePrimaries(kRec709Primaries);
  const Imath::M33d adapt =
      AreXyz(primaries) ? Imath::M33d() : Adapt(WhiteOf(primaries), WhiteOf(rec709));
  return XyzFromRgb(primaries) * adapt * XyzFromRgb(rec709).inverse();
}

}  // namespace nacre
