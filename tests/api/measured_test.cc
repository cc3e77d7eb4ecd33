// SPDX-License-Identifier: Apache-2.0
// tests/api/measured_test.cc: measured BRDFs through the library: exact and by kernels, and their
// samples.
#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>

#include <unistd.h>

#include "catch.h"
#include "measured_tables.h"
#include "nacre.h"

namespace {

// A folder that is the current one while it exists: names of files are relative to that.
struct CurrentFolder {
  std::filesystem::path before = std::filesystem::current_path();
  std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("nacre_measured_" + std::to_string(getpid()));
  CurrentFolder() {
    std::filesystem::create_directories(path);
    std::filesystem::current_path(path);
  }
  ~CurrentFolder() {
    std::filesystem::current_path(before);
    std::filesystem::remove_all(path);
  }
};

TEST_CASE("measured BRDFs are evaluated exactly and by kernels, whole and anisotropic") {
  const CurrentFolder folder;
  std::ofstream("whole.bsdf", std::ios::binary)
      << nacre::TensorBytes(nacre::RandomRgl(1, 5, 1).fields);
  std::ofstream("isotropic.bsdf", std::ios::binary)
      << nacre::TensorBytes(nacre::RandomRgl(2).fields);
  for (const char* file : {"whole.bsdf", "isotropic.bsdf"}) {
    const nacre::Brdf brdf("measured", {{"file", file}});
    constexpr size_t kCount = 500;
    std::vector<double> planes[9];
    std::mt19937 random(3);
    std::uniform_real_distribution<double> height(0.05, 1), turn(0, 2 * M_PI);
    const auto direction = [&](double z) -> nacre::Vec3d {
      const double phi = turn(random), sine = std::sqrt(1 - z * z);
      return {sine * std::cos(phi), sine * std::sin(phi), z};
    };
    for (size_t i = 0; i < kCount; ++i) {
      const nacre::Basis<double> about = nacre::BasisAbout(direction(height(random)));
      const nacre::Vec3d vectors[3] = {about.z, about.ToWorld(direction(height(random))),
                                       about.ToWorld(direction(height(random)))};
      for (size_t k = 0; k < 3; ++k) {
        for (size_t c = 0; c < 3; ++c) {
          planes[3 * k + c].push_back(vectors[k][static_cast<int>(c)]);
        }
      }
    }
    nacre::Directions d;
    d.count = kCount;
    for (size_t c = 0; c < 3; ++c) {
      d.normal[c] = planes[c].data();
      d.to_view[c] = planes[3 + c].data();
      d.to_light[c] = planes[6 + c].data();
    }
    const nacre::ExactReflections exact = brdf.Evaluate(d);
    const nacre::Reflections shaded = brdf.Shade(d);
    INFO(file);
    size_t off = 0;
    for (size_t i = 0; i < kCount; ++i) {
      for (size_t c = 0; c < 3; ++c) {
        CHECK(exact.diffuse[c][i] == 0);
        CHECK(exact.specular[c][i] > 0);
        const double error = std::abs(shaded.specular[c][i] / exact.specular[c][i] - 1);
        off += error > 1e-4 ? 1 : 0;
      }
    }
    CHECK(off == 0);
    CHECK(brdf.Albedo(0.5)[1] > 0);
  }
}

TEST_CASE("a measured BRDF without its file says so") {
  std::string message;
  try {
    const nacre::Brdf brdf("measured", {{"file", "there_is_none.binary"}});
  } catch (const nacre::Error& error) {
    message = error.what();
  }
  CHECK(message.find("there is no file \"there_is_none.binary\"") != std::string::npos);
}

}  // namespace
