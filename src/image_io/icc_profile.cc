// SPDX-License-Identifier: Apache-2.0
#include "image_io/icc_profile.h"

#include <array>
#include <cmath>
#include <memory>

#include <lcms2.h>

namespace nacre {
namespace {

using Profile = std::unique_ptr<void, decltype(&cmsCloseProfile)>;
using Transform = std::unique_ptr<void, decltype(&cmsDeleteTransform)>;

// The tolerance for a component. Many profiles have a gamma of 2.2 in place of sRGB's curve (libpng
// accepts that, too), which differs by .024 at 1/8. Other primaries (P3, Adobe's) and other curves
// (1, 1.8) differ by .07 and more.
constexpr double kNear = 0.03;

std::string DescriptionOf(cmsHPROFILE profile) {
  std::array<char, 256> text{};
  cmsGetProfileInfoASCII(profile, cmsInfoDescription, "en", "US", text.data(), text.size());
  return text[0] == '\0' ? "unnamed" : text.data();
}

// Whether the profile's colours are, within kNear, those of sRGB with the same components.
bool IsSrgb(cmsHPROFILE profile) {
  const bool is_grey = cmsGetColorSpace(profile) == cmsSigGrayData;
  if (!is_grey && cmsGetColorSpace(profile) != cmsSigRgbData) return false;
  const Profile srgb(cmsCreate_sRGBProfile(), &cmsCloseProfile);
  if (!srgb) return false;
  const Transform transform(
      cmsCreateTransform(profile, is_grey ? TYPE_GRAY_DBL : TYPE_RGB_DBL, srgb.get(), TYPE_RGB_DBL,
                         INTENT_RELATIVE_COLORIMETRIC, cmsFLAGS_NOCACHE | cmsFLAGS_NOOPTIMIZE),
      &cmsDeleteTransform);
  if (!transform) return false;
  // Tests greys and lines through the colour cube, in steps of an eighth.
  constexpr int kSteps = 8;
  for (int i = 0; i <= kSteps; ++i) {
    for (int color = 0; color < 8; ++color) {
      const double value = i / static_cast<double>(kSteps);
      std::array<double, 3> given{}, shown{};
      for (size_t c = 0; c < 3; ++c)
        given[c] = is_grey || (color >> c & 1) == 0 ? value : 1 - value;
      cmsDoTransform(transform.get(), given.data(), shown.data(), 1);
      for (size_t c = 0; c < 3; ++c) {
        if (!(std::abs(shown[c] - given[c]) <= kNear)) return false;
      }
    }
  }
  return true;
}

}  // namespace

IccProfile ReadIccProfile(std::span<const uint8_t> bytes) {
  const Profile profile(
      cmsOpenProfileFromMem(bytes.data(), static_cast<cmsUInt32Number>(bytes.size())),
      &cmsCloseProfile);
  if (!profile) return {"damaged", false};
  const bool is_srgb = IsSrgb(profile.get());
  return {is_srgb ? "sRGB" : DescriptionOf(profile.get()), is_srgb};
}

void NoteIccProfile(std::span<const uint8_t> profile,
                    std::map<std::string, std::string>* metadata) {
  const IccProfile read = ReadIccProfile(profile);
  (*metadata)["icc_profile"] = read.name;
  metadata->erase("not_srgb");
  if (!read.is_srgb) (*metadata)["not_srgb"] = "the ICC profile \"" + read.name + "\"";
}

}  // namespace nacre
