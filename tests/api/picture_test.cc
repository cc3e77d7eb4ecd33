// SPDX-License-Identifier: Apache-2.0
// tests/api/picture_test.cc: pictures for a display, in memory: the codes and bytes of files.
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>

#include <unistd.h>

#include "catch.h"
#include "nacre.h"

namespace {

nacre::Image Rendered(const std::vector<std::string>& layers = {}) {
  nacre::RenderSettings settings{.width = 61, .height = 37, .samples = 2, .layers = layers};
  return nacre::Render(nacre::Scene::FromFile(NACRE_SOURCE_DIR "/scenes/first_scene.json"),
                       settings);
}

std::string PathOf(const std::string& name) {
  return (std::filesystem::temp_directory_path() / (std::to_string(getpid()) + name)).string();
}

// The file's codes, times 255.
std::vector<long> CodesIn(const std::string& path) {
  const nacre::Image image = nacre::Read(path);
  std::vector<long> codes;
  for (size_t i = 0; i < image.channels[0].samples.size(); ++i) {
    for (const char* const name : {"R", "G", "B"}) {
      codes.push_back(std::lround(255 * image.Find(name)->samples[i]));
    }
  }
  std::filesystem::remove(path);
  return codes;
}

std::vector<long> CodesOf(const nacre::Picture& picture) {
  std::vector<long> codes;
  for (size_t i = 0; i < picture.rgba.size(); ++i) {
    if (i % 4 != 3) codes.push_back(picture.rgba[i]);
  }
  return codes;
}

std::string PutInFile(const std::vector<uint8_t>& bytes, const std::string& name) {
  const std::string path = PathOf(name);
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()), static_cast<long>(bytes.size()));
  return path;
}

TEST_CASE("a tone-mapped picture has the codes of the PNG file") {
  const nacre::Image image = Rendered();
  for (const char* const tonemap : {"neutral", "agx", "none"}) {
    for (const double exposure : {0.0, -1.3}) {
      nacre::WriteSettings settings;
      settings.tonemap = tonemap;
      settings.exposure = exposure;
      const std::string path = PathOf("nacre_picture_codes.png");
      nacre::Write(image, path, settings);
      nacre::ToneMapSettings same;
      same.tonemap = tonemap;
      same.exposure = exposure;
      const nacre::Picture picture = nacre::ToneMap(image, same);
      REQUIRE(picture.width == 61);
      REQUIRE(picture.height == 37);
      REQUIRE(picture.rgba.size() == size_t{4} * 61 * 37);
      for (size_t i = 3; i < picture.rgba.size(); i += 4) REQUIRE(picture.rgba[i] == 255);
      REQUIRE(CodesOf(picture) == CodesIn(path));
    }
  }
}

TEST_CASE("a layer is shown alone") {
  const nacre::Image image = Rendered({"diffuse", "specular"});
  nacre::Image alone = image;
  alone.channels.clear();
  for (const char* const name : {"R", "G", "B"}) {
    nacre::Channel channel = *image.Find(std::string("specular.") + name);
    channel.name = name;
    alone.channels.push_back(channel);
  }
  nacre::ToneMapSettings settings;
  settings.layer = "specular";
  REQUIRE(nacre::ToneMap(image, settings).rgba == nacre::ToneMap(alone).rgba);
  REQUIRE(nacre::ToneMap(image).rgba != nacre::ToneMap(alone).rgba);
}

TEST_CASE("what is not a number is magenta") {
  nacre::Image image = Rendered();
  image.channels[1].samples[5] = std::numeric_limits<float>::quiet_NaN();
  const nacre::Picture picture = nacre::ToneMap(image);
  REQUIRE(std::vector<uint8_t>(&picture.rgba[20], &picture.rgba[24]) ==
          std::vector<uint8_t>{255, 0, 255, 255});
}

TEST_CASE("an encoded PNG holds the picture's codes") {
  const nacre::Picture picture = nacre::ToneMap(Rendered());
  const std::string path = PutInFile(nacre::EncodePng(picture), "nacre_picture_encoded.png");
  REQUIRE(CodesIn(path) == CodesOf(picture));
}

TEST_CASE("an encoded JPEG is near the picture's codes") {
  const nacre::Picture picture = nacre::ToneMap(Rendered());
  const std::vector<uint8_t> best = nacre::EncodeJpeg(picture, 100);
  const std::vector<uint8_t> small = nacre::EncodeJpeg(picture, 20);
  REQUIRE(small.size() < best.size() / 2);
  const std::vector<long> codes = CodesOf(picture);
  const std::vector<long> found = CodesIn(PutInFile(best, "nacre_picture_encoded.jpg"));
  REQUIRE(found.size() == codes.size());
  // At quality 100 all of libjpeg's steps of quantisation are 1: a code is off by the roundings of
  // the colour transform, of 64 coefficients and back.
  for (size_t i = 0; i < codes.size(); ++i) REQUIRE(std::abs(found[i] - codes[i]) <= 4);
}

template <class Call>
std::string MessageOf(const Call& call) {
  try {
    call();
  } catch (const nacre::Error& error) {
    REQUIRE(error.exit_code() == 64);
    return error.what();
  }
  return "none";
}

TEST_CASE("pictures that cannot be are refused") {
  const nacre::Image image = Rendered();
  nacre::Picture picture = nacre::ToneMap(image);
  nacre::ToneMapSettings settings;
  settings.layer = "diffuse";
  CHECK(MessageOf([&] { nacre::ToneMap(image, settings); }).find("diffuse.R") != std::string::npos);
  settings = {};
  settings.tonemap = "filmic";
  CHECK(MessageOf([&] { nacre::ToneMap(image, settings); }) != "none");
  settings = {};
  settings.exposure = std::numeric_limits<double>::quiet_NaN();
  CHECK(MessageOf([&] { nacre::ToneMap(image, settings); }).find("stops") != std::string::npos);
  for (const int quality : {0, 101, -5}) {
    CHECK(MessageOf([&] { nacre::EncodeJpeg(picture, quality); }).find("quality") !=
          std::string::npos);
  }
  picture.rgba.pop_back();
  CHECK(MessageOf([&] { nacre::EncodePng(picture); }).find("four bytes") != std::string::npos);
  CHECK(MessageOf([&] { nacre::EncodeJpeg(picture); }).find("four bytes") != std::string::npos);
  CHECK(MessageOf([&] { nacre::EncodePng({}); }) != "none");
  CHECK(MessageOf([&] { nacre::EncodePng({-1, 4, {}}); }) != "none");
  nacre::Picture wide{70000, 1, std::vector<uint8_t>(280000)};
  CHECK(MessageOf([&] { nacre::EncodeJpeg(wide); }).find("65500") != std::string::npos);
}

}  // namespace
