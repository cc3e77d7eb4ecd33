// SPDX-License-Identifier: Apache-2.0
// tests/api/session_test.cc: sessions of the public API against renders of scenes.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include <unistd.h>

#include "catch.h"
#include "nacre.h"

namespace {

nacre::Scene FirstScene() {
  return nacre::Scene::FromFile(NACRE_SOURCE_DIR "/scenes/first_scene.json");
}

nacre::RenderSettings Small() {
  return {.width = 40, .height = 30, .samples = 6, .layers = {"all"}, .threads = 2};
}

void CheckEqual(const nacre::Image& a, const nacre::Image& b) {
  REQUIRE(a.channels.size() == b.channels.size());
  for (size_t i = 0; i < a.channels.size(); ++i) {
    INFO(a.channels[i].name);
    REQUIRE(a.channels[i].samples == b.channels[i].samples);
  }
  REQUIRE(a.metadata.at("nacre:sceneHash") == b.metadata.at("nacre:sceneHash"));
}

TEST_CASE("a session's pictures are those of its scene, change by change and back") {
  nacre::Scene scene = FirstScene();
  nacre::Session session(scene);
  CheckEqual(session.Render(Small()), nacre::Render(scene, Small()));
  const nacre::Image before = session.Render(Small());
  const auto change = [&](const char* pointer, const nacre::Value& value) {
    INFO(pointer);
    scene.Set(pointer, value);
    session.Set(pointer, value);
    CheckEqual(session.Render(Small()), nacre::Render(scene, Small()));
  };
  change("/materials/red/roughness", 0.1);
  change("/lights/key/intensity", 20);
  change("/shapes/0/radius", 0.5);
  change("/camera/fov_y_deg", 50);
  change("/image/spp", 3);
  change("/materials/red/roughness", 0.3);
  change("/lights/key/intensity", 140);
  change("/shapes/0/radius", 1);
  change("/camera/fov_y_deg", 32);
  CheckEqual(session.Render(Small()), before);
  // Settings of one render are not those of the next.
  nacre::RenderSettings settings{.width = 16, .height = 12};
  CHECK(session.Render(settings).width() == 16);
  session.Set("/image/height", 9);
  session.Set("/image/width", 12);
  CHECK(session.Render().width() == 12);
}

// Of more spheres than occluders are listed of: what is binned follows a sphere, a camera, or both.
TEST_CASE("a session of many spheres, sphere by sphere") {
  std::mt19937 random(5);
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  nacre::Scene scene;
  scene.AddMaterial("grey", {{"model", "blinn_phong"}, {"kd", 0.5}, {"ks", 0.3}});
  scene.AddLight("lamp", {{"type", "point"}, {"position", {2, 4, 5}}, {"intensity", 60}});
  scene.AddLight(
      "sun", {{"type", "directional"}, {"direction_of_travel", {-1, -2, -1}}, {"irradiance", 1}});
  for (int i = 0; i < 400; ++i) {
    scene.AddShape({{"type", "sphere"},
                    {"center", {uniform(-2, 2), uniform(-2, 2), uniform(-3, 2)}},
                    {"radius", uniform(0.05, 0.3)},
                    {"material", "grey"}});
  }
  scene.Set("/camera/position", {0, 0, 7});
  nacre::Session session(scene);
  const auto set = [&](const std::string& pointer, const nacre::Value& value) {
    scene.Set(pointer, value);
    session.Set(pointer, value);
  };
  const auto sphere = [&] {
    return "/shapes/" + std::to_string(std::uniform_int_distribution<int>(0, 399)(random));
  };
  CheckEqual(session.Render(Small()), nacre::Render(scene, Small()));
  for (int step = 0; step < 48; ++step) {
    INFO("step " << step);
    const std::string shape = sphere();
    if (step % 3 == 0) set(shape + "/radius", step % 9 == 0 ? 1.0 : 0.4);
    if (step % 3 == 1) {
      for (int i = 0; i < (step % 12 == 1 ? 20 : 2); ++i) {
        set(sphere() + "/center", {uniform(-2, 2), uniform(-2, 2), uniform(-3, 9)});
      }
    }
    if (step % 3 == 2) {
      set("/shapes/7/center", {0.3, 0.2, 3});  // twice the same, and as another one
      set("/shapes/7/radius", 0.5);
      set("/shapes/" + std::to_string(step) + "/radius", 0.5);
      set("/shapes/" + std::to_string(step) + "/center", {0.3, 0.2, 3});
    }
    if (step % 5 == 0) set("/camera/position", {uniform(-1, 1), uniform(-1, 1), 7});
    if (step % 7 == 0) set("/lights/lamp/position", {uniform(-3, 3), 4, 5});
    if (step % 11 == 0) set("/image/spp", step % 2 == 0 ? 1 : 3);
    CheckEqual(session.Render(Small()), nacre::Render(scene, Small()));
  }
}

TEST_CASE("a session refuses what is wrong, and keeps its scene") {
  nacre::Session session(FirstScene());
  const nacre::Image before = session.Render(Small());
  try {
    session.Set("/materials/red/roughness", 3);
    FAIL("a roughness of 3");
  } catch (const nacre::Error& error) {
    CHECK(error.faults().at(0).where.find("/materials/red/roughness") != std::string::npos);
  }
  CHECK_THROWS_AS(session.Set("/materials/read/roughness", 0.3), nacre::Error);
  CHECK_THROWS_AS(session.Set("nothing", 0.3), nacre::Error);
  CheckEqual(session.Render(Small()), before);
}

TEST_CASE("sessions of scenes with shapes from code") {
  nacre::Scene scene;
  scene.AddMaterial("grey", {{"model", "lambert"}, {"albedo", 0.5}});
  scene.AddLight("key", {{"type", "point"}, {"position", {3, 4, 5}}, {"intensity", 100}});
  scene.AddSphere({0, 0, 0}, 1, "grey");
  scene.AddShape(
      {{"type", "sphere"}, {"center", {1, 1, 0}}, {"radius", 0.3}, {"material", "grey"}});
  nacre::Session session(scene);
  CheckEqual(session.Render(Small()), nacre::Render(scene, Small()));
  session.Set("/materials/grey/albedo", 0.2);
  session.Set("/shapes/0/radius", 0.6);
  scene.Set("/materials/grey/albedo", 0.2);
  scene.Set("/shapes/0/radius", 0.6);
  CheckEqual(session.Render(Small()), nacre::Render(scene, Small()));
}

TEST_CASE("a session reads files again that have changed, when it is asked to") {
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("nacre_reload_" + std::to_string(getpid()));
  std::filesystem::create_directories(folder);
  const auto write = [&](const char* name, const std::string& text) {
    std::ofstream(folder / name) << text;
  };
  const auto mesh = [](const std::string& size) {
    return "v -" + size + " -1 0\nv " + size + " -1 0\nv 0 1 0\nf 1 2 3\n";
  };
  write("m.obj", mesh("1"));
  write("s.json", R"({"nacre": 1, "camera": {"position": [0, 0, 5]},
    "materials": {"red": {"model": "lambert"}}, "lights": {"sky": {"type": "ambient", "radiance": 1}},
    "shapes": [{"type": "mesh", "file": "m.obj", "material": "red"}]})");
  for (const char* const file : {"s.json", "m.obj"}) {
    INFO(file);
    const auto fresh = [&] {
      nacre::Scene scene = nacre::Scene::FromFile(folder / file);
      scene.Set("/background", 0.25);
      return scene;
    };
    nacre::Session session(fresh());
    CHECK_FALSE(session.Reload());
    const nacre::Image before = session.Render(Small());
    write("m.obj", mesh("0.25"));
    CheckEqual(session.Render(Small()), before);
    CHECK(session.Reload());
    CHECK_FALSE(session.Reload());
    CheckEqual(session.Render(Small()), nacre::Render(fresh(), Small()));
    CHECK(session.Render(Small()).Find("A")->samples != before.Find("A")->samples);
    write("m.obj", "f 1 2 3\n");
    for (int i = 0; i < 2; ++i) CHECK_THROWS_AS(session.Reload(), nacre::Error);
    write("m.obj", mesh("1"));
    CHECK(session.Reload());
    CheckEqual(session.Render(Small()), before);
  }
  std::filesystem::remove_all(folder);
}

TEST_CASE("passes show more and more samples, and end in the picture of all") {
  for (const char* const filter : {"box", "mitchell"}) {
    nacre::Scene scene = FirstScene();
    scene.Set("/image/filter",
              nacre::Parameters{{"type", filter}, {"width", filter[0] == 'b' ? 1 : 4}});
    nacre::Session session(scene);
    std::vector<int> shown;
    nacre::Image last;
    const nacre::Image whole =
        session.RenderProgressively(Small(), [&](const nacre::Image& image, int samples) {
          shown.push_back(samples);
          last = image;
        });
    CHECK(shown == std::vector<int>{1, 2, 4, 6});
    CheckEqual(whole, nacre::Render(scene, Small()));
    CheckEqual(last, whole);
  }
}

TEST_CASE("a render is cancelled from another thread, and the session lives on") {
  nacre::Session session(FirstScene());
  nacre::RenderSettings large = Small();
  large.samples = 65536;
  std::thread other([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    session.Cancel();
  });
  CHECK_THROWS_AS(session.Render(large), nacre::Cancelled);
  other.join();
  CheckEqual(session.Render(Small()), nacre::Render(FirstScene(), Small()));
}

// Sanitizers make everything slower, and so what ends a render: 10.1 ms were seen under tsan.
#if defined(__SANITIZE_THREAD__) || defined(__SANITIZE_ADDRESS__)
constexpr std::chrono::milliseconds kCancelTime(50);
#else
constexpr std::chrono::milliseconds kCancelTime(10);
#endif

// Of several, the quickest counts: a busy machine may keep any thread waiting. They are cancelled
// at different times, as the sanitizers' builds take a while to clear the image, a channel at a
// time.
TEST_CASE("a cancelled render ends within 10 ms") {
  nacre::Session session(nacre::Scene::FromFile(NACRE_SOURCE_DIR "/scenes/material_grid.json"));
  nacre::RenderSettings settings{.width = 1920, .height = 1080, .samples = 256};
  session.Render(Small());
  using Clock = std::chrono::steady_clock;
  Clock::duration quickest = std::chrono::hours(1);
  for (int i = 0; i < 20 && quickest > kCancelTime; ++i) {
    Clock::time_point asked;
    std::thread other([&, i] {
      std::this_thread::sleep_for(std::chrono::milliseconds(20 * (i + 1)));
      asked = Clock::now();
      session.Cancel();
    });
    REQUIRE_THROWS_AS(session.Render(settings), nacre::Cancelled);
    const Clock::time_point ended = Clock::now();
    other.join();
    quickest = std::min(quickest, ended - asked);
  }
  CHECK(quickest <= kCancelTime);
}

TEST_CASE("a render ends when its settings say so") {
  std::atomic<bool> cancel = true;
  nacre::RenderSettings settings = Small();
  settings.cancel = &cancel;
  const nacre::Scene scene = FirstScene();
  REQUIRE_THROWS_AS(nacre::Render(scene, settings), nacre::Cancelled);
  nacre::Session session(scene);
  REQUIRE_THROWS_AS(session.Render(settings), nacre::Cancelled);
  cancel = false;
  CheckEqual(session.Render(settings), nacre::Render(scene, settings));
}

TEST_CASE("passes tell how far all of them have come, and end where that throws") {
  nacre::Session session(FirstScene());
  nacre::RenderSettings settings = Small();
  std::vector<double> shares;
  settings.on_progress = [&](double share) { shares.push_back(share); };
  const auto ignore = [](const nacre::Image&, int) {};
  session.RenderProgressively(settings, ignore);
  REQUIRE(shares.size() == 8);  // four passes of two strips
  CHECK(std::is_sorted(shares.begin(), shares.end()));
  CHECK(shares.front() > 0);
  CHECK(shares.back() == 1);
  settings.on_progress = [](double) { throw std::string("enough"); };
  CHECK_THROWS_AS(session.RenderProgressively(settings, ignore), std::string);
  CheckEqual(session.Render(Small()), nacre::Render(FirstScene(), Small()));
}

}  // namespace
