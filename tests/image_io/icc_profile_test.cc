// SPDX-License-Identifier: Apache-2.0
// tests/image_io/icc_profile_test.cc: profiles are judged by what they do, not by their names.
#include "image_io/icc_profile.h"

#include <array>
#include <memory>
#include <vector>

#include <lcms2.h>

#include "catch.h"

namespace nacre {
namespace {

// The bytes of a profile, which this takes.
std::vector<uint8_t> BytesOf(cmsHPROFILE profile) {
  cmsUInt32Number size = 0;
  cmsSaveProfileToMem(profile, nullptr, &size);
  std::vector<uint8_t> bytes(size);
  cmsSaveProfileToMem(profile, bytes.data(), &size);
  cmsCloseProfile(profile);
  return bytes;
}

// Primaries of red, green and blue, D65, and one curve, under the name "sRGB".
std::vector<uint8_t> MakeProfile(const std::array<double, 6>& p, cmsToneCurve* curve) {
  const cmsCIExyY white = {0.3127, 0.3290, 1};
  const cmsCIExyYTRIPLE primaries = {{p[0], p[1], 1}, {p[2], p[3], 1}, {p[4], p[5], 1}};
  cmsToneCurve* const curves[3] = {curve, curve, curve};
  cmsHPROFILE profile = cmsCreateRGBProfile(&white, &primaries, curves);
  cmsMLU* name = cmsMLUalloc(nullptr, 1);
  cmsMLUsetASCII(name, "en", "US", "sRGB IEC61966-2.1");
  cmsWriteTag(profile, cmsSigProfileDescriptionTag, name);
  cmsMLUfree(name);
  cmsFreeToneCurve(curve);
  return BytesOf(profile);
}

constexpr std::array<double, 6> kRec709 = {0.64, 0.33, 0.30, 0.60, 0.15, 0.06};
constexpr std::array<double, 6> kDisplayP3 = {0.68, 0.32, 0.265, 0.69, 0.15, 0.06};

cmsToneCurve* SrgbCurve() {
  const cmsFloat64Number parameters[] = {2.4, 1 / 1.055, 0.055 / 1.055, 1 / 12.92, 0.04045};
  return cmsBuildParametricToneCurve(nullptr, 4, parameters);
}

TEST_CASE("sRGB is what does as sRGB does") {
  CHECK(ReadIccProfile(BytesOf(cmsCreate_sRGBProfile())).is_srgb);
  CHECK(ReadIccProfile(MakeProfile(kRec709, SrgbCurve())).is_srgb);
  CHECK(ReadIccProfile(MakeProfile(kRec709, cmsBuildGamma(nullptr, 2.2))).is_srgb);
  cmsToneCurve* const grey = SrgbCurve();
  const cmsCIExyY white = {0.3127, 0.3290, 1};
  CHECK(ReadIccProfile(BytesOf(cmsCreateGrayProfile(&white, grey))).is_srgb);
  cmsFreeToneCurve(grey);
  CHECK(ReadIccProfile(BytesOf(cmsCreate_sRGBProfile())).name == "sRGB");
}

TEST_CASE("a profile that calls itself sRGB and is not is none") {
  const IccProfile linear = ReadIccProfile(MakeProfile(kRec709, cmsBuildGamma(nullptr, 1)));
  CHECK_FALSE(linear.is_srgb);
  CHECK(linear.name == "sRGB IEC61966-2.1");
  CHECK_FALSE(ReadIccProfile(MakeProfile(kRec709, cmsBuildGamma(nullptr, 1.8))).is_srgb);
  CHECK_FALSE(ReadIccProfile(MakeProfile(kDisplayP3, SrgbCurve())).is_srgb);
  CHECK_FALSE(ReadIccProfile(BytesOf(cmsCreateLab4Profile(nullptr))).is_srgb);
}

TEST_CASE("broken profiles are none") {
  std::vector<uint8_t> bytes = BytesOf(cmsCreate_sRGBProfile());
  for (size_t size = 0; size < bytes.size(); size += 1 + bytes.size() / 50) {
    ReadIccProfile(std::span(bytes).first(size));  // does not crash
  }
  CHECK_FALSE(ReadIccProfile({}).is_srgb);
  CHECK_FALSE(ReadIccProfile(std::span(bytes).first(bytes.size() / 2)).is_srgb);
}

}  // namespace
}  // namespace nacre
