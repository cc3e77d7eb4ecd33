// SPDX-License-Identifier: Apache-2.0
// tests/api/float_mode_test.cc: whatever floating-point modes the caller has, and threads inherit,
// results have the same bits, and the caller has his modes back.
#include <cfenv>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <functional>
#include <thread>
#include <vector>

#include <unistd.h>

#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

#include "catch.h"
#include "nacre.h"

namespace {

// The bytes of all that the library computes, in order.
class Results {
 public:
  template <class Number>
  void Add(const std::vector<Number>& numbers) {
    const size_t at = bytes_.size();
    bytes_.resize(at + numbers.size() * sizeof(Number));
    if (!numbers.empty()) std::memcpy(&bytes_[at], numbers.data(), bytes_.size() - at);
  }
  void Add(const nacre::Image& image) {
    for (const nacre::Channel& channel : image.channels) Add(channel.samples);
  }
  const std::vector<uint8_t>& bytes() const { return bytes_; }

 private:
  std::vector<uint8_t> bytes_;
};

// Numbers that no double holds: they are read as the mode rounds. The lights' forms are all here,
// and lobes whose tails are denormals.
const char kScene[] = R"({
  "nacre": 1,
  "camera": {"position": [0.1, 0.3, 7.7], "look_at": [0, 0.1, 0], "fov_y_deg": 33.3},
  "image": {"filter": {"type": "mitchell"}},
  "lights": {
    "point": {"type": "point", "position": [3.3, 4.1, 5.7], "intensity": [33.3, 31.1, 29.7]},
    "sun": {"type": "directional", "direction_of_travel": [1, -2, -0.7], "irradiance": 0.7},
    "spot": {"type": "spot", "position": [-3.1, 4.2, 1.3], "direction_of_travel": [3, -4, -1],
             "intensity": 41.3, "cutoff_deg": 17.3, "inner_deg": 3.1, "exponent": 1.7},
    "lamp": {"type": "sphere", "center": [-2.3, 1.9, 2.1], "radius": 0.33, "radiance": 3.7},
    "panel": {"type": "mesh", "icosphere": {"center": [2.1, 2.3, 0.4], "radius": 0.3,
              "subdivisions": 1}, "radiance": 2.3},
    "sky": {"type": "environment", "gradient": {"zenith": [0.1, 0.2, 0.3], "horizon": 0.3}}
  },
  "shapes": [
    {"type": "sphere", "center": [0.1, 0.2, 0.3], "radius": 0.7,
     "material": {"model": "phong", "shininess": 901.7, "ks": 0.3}},
    {"type": "sphere", "center": [1.5, 0.1, -0.3], "radius": 0.6,
     "material": {"model": "conductor", "preset": "gold", "roughness": 0.07}},
    {"type": "icosphere", "center": [-1.3, 0.3, 0.2], "radius": 0.7, "subdivisions": 2,
     "material": {"model": "metallic_roughness", "roughness": 0.3,
                  "compensation": "kulla_conty"}, "interpolation": "gouraud"},
    {"type": "sphere", "center": [0, -100.5, 0], "radius": 100,
     "material": {"model": "oren_nayar", "albedo": 0.7}}
  ]
})";

void AddRenders(Results* results) {
  const nacre::Scene scenes[] = {
      nacre::Scene::FromJson(kScene),
      nacre::Scene::FromFile(NACRE_SOURCE_DIR "/scenes/textures.json"),
  };
  for (const nacre::Scene& scene : scenes) {
    for (const int threads : {1, 3}) {
      nacre::RenderSettings settings{
          .width = 48, .height = 40, .samples = 3, .layers = {"all"}, .threads = threads};
      const nacre::Image image = nacre::Render(scene, settings);
      results->Add(image);
      const std::string path = (std::filesystem::temp_directory_path() /
                                ("nacre_float_mode_test_" + std::to_string(getpid()) + ".png"))
                                   .string();
      nacre::Write(image, path, {true, "zip", false, "agx", 0.3});
      results->Add(nacre::Read(path));
      std::filesystem::remove(path);
      settings.max_error = 0.1;
      settings.samples = 64;
      const nacre::Image adaptive = nacre::Render(scene, settings);
      results->Add(adaptive);
      nacre::CompareSettings compare;
      compare.layers = {""};
      compare.perceptual = true;
      const nacre::LayerMetrics metrics = nacre::Compare(adaptive, image, compare).layers[0];
      results->Add(std::vector<double>{metrics.rmse, metrics.rel_mse, metrics.mean, *metrics.ssim,
                                       *metrics.flip});
    }
  }
}

void AddBrdfs(Results* results) {
  const double n[] = {0, 0, 1}, v[] = {0.6, 0, 0.8}, l[] = {-0.28, 0, 0.96};
  const nacre::Directions one{1, {n, n + 1, n + 2}, {v, v + 1, v + 2}, {l, l + 1, l + 2}};
  for (const char* const model : {"lambert", "oren_nayar", "burley", "phong", "blinn_phong",
                                  "metallic_roughness", "conductor", "dielectric"}) {
    const nacre::Brdf brdf(model);
    const nacre::Reflection exact =
        brdf.Evaluate({n[0], n[1], n[2]}, {v[0], v[1], v[2]}, {l[0], l[1], l[2]});
    results->Add(std::vector<double>(exact.diffuse.begin(), exact.diffuse.end()));
    results->Add(std::vector<double>(exact.specular.begin(), exact.specular.end()));
    const nacre::Reflections shaded = brdf.Shade(one);
    for (size_t c = 0; c < 3; ++c) {
      results->Add(shaded.diffuse[c]);
      results->Add(shaded.specular[c]);
    }
  }
}

std::vector<uint8_t> Compute() {
  Results results;
  AddRenders(&results);
  AddBrdfs(&results);
  return results.bytes();
}

struct Mode {
  int rounding;
  bool flush, traps;
};

std::vector<Mode> Modes() {
  std::vector<Mode> modes;
  for (const int rounding : {FE_TONEAREST, FE_DOWNWARD, FE_UPWARD, FE_TOWARDZERO}) {
    for (const bool flush : {false, true}) modes.push_back({rounding, flush, false});
  }
  modes.push_back({FE_TONEAREST, false, true});
  return modes;
}

constexpr unsigned kFlush = 0x8040;  // FTZ and DAZ

void Set(const Mode& mode) {
  std::fesetround(mode.rounding);
#if defined(__SSE2__)
  if (mode.flush) _mm_setcsr(_mm_getcsr() | kFlush);
#endif
  if (mode.traps) feenableexcept(FE_DIVBYZERO | FE_INVALID | FE_OVERFLOW);
}

bool IsSet(const Mode& mode) {
  bool set = std::fegetround() == mode.rounding;
#if defined(__SSE2__)
  set = set && (_mm_getcsr() & kFlush) == (mode.flush ? kFlush : 0);
#endif
  return set && (fegetexcept() != 0) == mode.traps;
}

// Calls body() in a thread that has the mode; returns whether it has it afterwards, too.
bool InMode(const Mode& mode, const std::function<void()>& body) {
  bool kept = false;
  std::thread thread([&] {
    Set(mode);
    body();
    kept = IsSet(mode);
  });
  thread.join();
  return kept;
}

// Odd modes first: workers keep those of the caller that started them.
TEST_CASE("the caller's floating-point modes change no bit and are left as they were") {
  std::vector<std::vector<uint8_t>> results;
  const std::vector<Mode> modes = Modes();
  for (auto mode = modes.rbegin(); mode != modes.rend(); ++mode) {
    CAPTURE(mode->rounding, mode->flush, mode->traps);
    results.emplace_back();
    REQUIRE(InMode(*mode, [&] { results.back() = Compute(); }));
  }
  const std::vector<uint8_t> plain = Compute();
  REQUIRE(plain.size() > 100000);
  for (size_t i = 0; i < results.size(); ++i) {
    const Mode& mode = modes[modes.size() - 1 - i];
    CAPTURE(mode.rounding, mode.flush, mode.traps);
    CHECK((results[i] == plain));
  }
}

// Errors leave by an exception.
TEST_CASE("the modes are left as they were by errors and callbacks that throw") {
  for (const Mode& mode : Modes()) {
    CAPTURE(mode.rounding, mode.flush, mode.traps);
    REQUIRE(InMode(mode, [] {
      try {
        nacre::Brdf("metallic_roughness").Evaluate({0, 0, 3}, {0, 0, 1}, {0, 0, 1});
      } catch (const nacre::Error&) {
      }
    }));
    REQUIRE(InMode(mode, [] {
      nacre::RenderSettings settings;
      settings.on_progress = [](double) { throw 1; };
      try {
        nacre::Render(nacre::Scene::FromJson(kScene), settings);
      } catch (int) {
      }
    }));
  }
}

}  // namespace
