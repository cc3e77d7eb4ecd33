// SPDX-License-Identifier: Apache-2.0
// tests/api/render_test.cc: renders, images and comparisons of the public API.
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <stdexcept>
#include <thread>

#include <malloc.h>
#include <unistd.h>

#include "catch.h"
#include "nacre.h"

namespace {

nacre::Scene FirstScene() {
  return nacre::Scene::FromFile(NACRE_SOURCE_DIR "/scenes/first_scene.json");
}

nacre::RenderSettings Small(int threads = 2) {
  return {.width = 40, .height = 40, .samples = 2, .threads = threads};
}

std::string PathOf(const std::string& name) {
  return (std::filesystem::temp_directory_path() / (std::to_string(getpid()) + name)).string();
}

TEST_CASE("size, samples, seed, layers and regions are those asked for") {
  const nacre::Scene scene = FirstScene();
  nacre::RenderSettings settings = Small();
  settings.layers = {"N", "id.material"};
  nacre::RenderStats stats;
  const nacre::Image full = nacre::Render(scene, settings, &stats);
  REQUIRE(full.width() == 40);
  REQUIRE(full.height() == 40);
  REQUIRE(stats.camera_rays > 0);
  REQUIRE(stats.camera_rays <= 40 * 40 * 2);
  REQUIRE(full.Find("N.X") != nullptr);
  REQUIRE(full.Find("id.material")->type == nacre::SampleType::kUint);
  REQUIRE(full.Find("Z") == nullptr);

  settings.region = {7, 9, 20, 31};
  const nacre::Image part = nacre::Render(scene, settings);
  REQUIRE(part.width() == 13);
  REQUIRE(part.frame.x1 == 40);
  for (int y = 9; y < 31; ++y) {
    for (int x = 7; x < 20; ++x) {
      REQUIRE(part.Find("R")->samples[static_cast<size_t>((y - 9) * 13 + x - 7)] ==
              full.Find("R")->samples[static_cast<size_t>(y * 40 + x)]);
    }
  }
  settings = Small();
  settings.seed = 5;
  REQUIRE((nacre::Render(scene, settings).Find("R")->samples != full.Find("R")->samples));
}

TEST_CASE("pixels that have not converged are told") {
  nacre::RenderSettings settings = Small();
  nacre::RenderStats stats;
  nacre::Render(FirstScene(), settings, &stats);
  CHECK(stats.unsettled_pixels == 0);
  CHECK(stats.fewest_samples <= 2);
  CHECK(stats.most_samples == 2);
  CHECK(stats.hits > 0);
  CHECK(stats.hits <= stats.camera_rays);
  settings.samples = 16;
  settings.max_error = 1e-5;
  nacre::Session session(FirstScene());
  for (const bool in_session : {false, true}) {
    if (in_session) {
      session.Render(settings, &stats);
    } else {
      nacre::Render(FirstScene(), settings, &stats);
    }
    CHECK(stats.unsettled_pixels > 0);
    CHECK(stats.most_samples == 16);
    CHECK(stats.mean_samples > stats.fewest_samples);
    REQUIRE_FALSE(stats.notes.empty());
    CHECK(stats.notes.back() == std::to_string(stats.unsettled_pixels) +
                                    " of 1600 pixels did not settle within 16 samples");
  }
}

TEST_CASE("settings out of range are refused") {
  const nacre::Scene scene = FirstScene();
  const auto code_of = [&](auto change) {
    nacre::RenderSettings settings = Small();
    change(&settings);
    try {
      nacre::Render(scene, settings);
    } catch (const nacre::Error& error) {
      return error.exit_code();
    }
    return 0;
  };
  REQUIRE(code_of([](auto*) {}) == 0);
  REQUIRE(code_of([](auto* s) { s->width = -1; }) == 64);
  REQUIRE(code_of([](auto* s) { s->samples = 1 << 20; }) == 64);
  REQUIRE(code_of([](auto* s) { s->threads = -1; }) == 64);
  REQUIRE(code_of([](auto* s) { s->max_error = std::nan(""); }) == 64);
  REQUIRE(code_of([](auto* s) { s->layers = {"difuse"}; }) == 64);
  REQUIRE(code_of([](auto* s) { s->intersector = "bvh"; }) == 64);
  REQUIRE(code_of([](auto* s) { s->region = {5, 5, 5, 9}; }) == 64);
  REQUIRE(code_of([](auto* s) { s->region = {50, 50, 60, 60}; }) == 64);
}

TEST_CASE("settings by name are those of members, and are refused where they are wrong") {
  const nacre::Scene scene = FirstScene();
  nacre::RenderSettings members = Small();
  members.max_error = 0.2;
  members.region = {1, 2, 9, 8};
  members.threads = 1;
  nacre::RenderSettings named = Small();
  named.others = {
      {"max_error", 0.2}, {"region", "1,2,9,8"}, {"intersector", "shells"}, {"threads", 1}};
  const nacre::Image image = nacre::Render(scene, named);
  const nacre::Image expected = nacre::Render(scene, members);
  REQUIRE(image.channels.size() == expected.channels.size());
  for (size_t i = 0; i < image.channels.size(); ++i) {
    CHECK(image.channels[i].name == expected.channels[i].name);
    CHECK(image.channels[i].samples == expected.channels[i].samples);
  }
  CHECK(image.metadata.at("nacre:maxError") == expected.metadata.at("nacre:maxError"));

  const auto message_of = [&](const nacre::Parameters& others) -> std::string {
    nacre::RenderSettings settings = Small();
    settings.others = others;
    try {
      nacre::Render(scene, settings);
    } catch (const nacre::Error& error) {
      CHECK(error.exit_code() == 64);
      return error.what();
    }
    return {};
  };
  CHECK(message_of({{"max_error", 2}}).find("/max_error: ") != std::string::npos);
  CHECK(message_of({{"threads", 1.5}}).find("/threads: ") != std::string::npos);
  CHECK(message_of({{"region", "1,2"}}).find("is not a region") != std::string::npos);
  CHECK(message_of({{"intersektor", "auto"}}).find("did you mean \"intersector\"?") !=
        std::string::npos);
  CHECK(message_of({{"tile", "0/2"}}).find("unknown key") != std::string::npos);
  for (const auto& [name, meaning] : nacre::NamedSettings()) CHECK_FALSE(meaning.empty());
}

TEST_CASE("progress reaches 1, and what it throws comes out as it is") {
  nacre::RenderSettings settings = Small();
  double last = 0;
  settings.on_progress = [&](double done) { last = done; };
  nacre::Render(FirstScene(), settings);
  REQUIRE(last == 1);
  settings.on_progress = [](double) { throw std::domain_error("enough"); };
  for (const int threads : {1, 2}) {
    settings.threads = threads;
    REQUIRE_THROWS_AS(nacre::Render(FirstScene(), settings), std::domain_error);
  }
}

// While alive, what goes to stderr goes to a file.
class CaughtStderr {
 public:
  CaughtStderr() : before_(dup(2)), file_(std::tmpfile()) { dup2(fileno(file_), 2); }
  ~CaughtStderr() {
    dup2(before_, 2);
    close(before_);
    std::fclose(file_);
  }
  CaughtStderr(const CaughtStderr&) = delete;
  CaughtStderr& operator=(const CaughtStderr&) = delete;

  off_t bytes() const { return lseek(2, 0, SEEK_CUR); }

 private:
  int before_;
  FILE* file_;
};

TEST_CASE("threads may share a scene, all get the same bits, and nothing is printed") {
  const CaughtStderr caught;
  const nacre::Scene scene =
      nacre::Scene::FromFile(NACRE_SOURCE_DIR "/scenes/mesh_and_spheres.json");
  constexpr size_t kThreads = 4;
  std::vector<nacre::Image> images(kThreads);
  {
    std::vector<std::thread> threads;
    threads.reserve(kThreads);
    for (size_t i = 0; i < kThreads; ++i) {
      threads.emplace_back(
          [&, i] { images[i] = nacre::Render(scene, Small(1 + 3 * static_cast<int>(i))); });
    }
    for (std::thread& thread : threads) thread.join();
  }
  REQUIRE(caught.bytes() == 0);
  for (const nacre::Image& image : images) {
    REQUIRE((image.Find("G")->samples == images[0].Find("G")->samples));
  }
}

// Sanitizers have allocators of their own.
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
// KiB that were allocated and not freed.
long HeapInUse() { return static_cast<long>(mallinfo2().uordblks / 1024); }

TEST_CASE("two hundred renders need no more memory than a hundred") {
  const nacre::Scene scene =
      nacre::Scene::FromFile(NACRE_SOURCE_DIR "/scenes/mesh_and_spheres.json");
  for (const int threads : {1, 2}) {
    CAPTURE(threads);
    // Threads, allocators and Embree fill their stores in the first ones.
    for (int i = 0; i < 100; ++i) nacre::Render(scene, Small(threads));
    const long before = HeapInUse();
    for (int i = 0; i < 200; ++i) nacre::Render(scene, Small(threads));
    // What grew by 7 KiB a render made 1.4 MiB of it; a worker that finds its first work late
    // brings 300 KiB.
    REQUIRE(HeapInUse() - before < 700);
  }
}
#endif

TEST_CASE("images go to files and come back") {
  nacre::RenderSettings settings = Small();
  settings.layers = {"all"};
  const nacre::Image image = nacre::Render(FirstScene(), settings);
  const std::string exr = PathOf("nacre_api_test.exr");
  nacre::WriteSettings full;
  full.half_floats = false;
  nacre::Write(image, exr, full);
  const nacre::Image read = nacre::Read(exr);
  REQUIRE(read.channels.size() == image.channels.size());
  for (const nacre::Channel& channel : read.channels) {
    CAPTURE(channel.name);
    REQUIRE((channel.samples == image.Find(channel.name)->samples));
  }
  for (const auto& [name, text] : image.metadata) {
    CAPTURE(name);
    REQUIRE(read.metadata.at(name) == text);
  }
  REQUIRE(read.metadata.count("worldToCamera") == 1);
  REQUIRE(read.metadata.at("samplesPerPixel") == "2");

  nacre::Write(image, exr);
  REQUIRE(nacre::Read(exr).Find("R")->type == nacre::SampleType::kHalf);
  REQUIRE(nacre::Read(exr).Find("Z")->type == nacre::SampleType::kFloat);
  std::filesystem::remove(exr);

  // A display's codes are written as they were read.
  const std::string first = PathOf("nacre_api_test_1.png"), second = PathOf("nacre_api_test_2.png");
  nacre::Write(image, first);
  const nacre::Image codes = nacre::Read(first);
  nacre::Write(codes, second);
  REQUIRE((nacre::Read(second).Find("G")->samples == codes.Find("G")->samples));
  REQUIRE(codes.Find("G")->samples[0] > 0);
  std::filesystem::remove(first);
  std::filesystem::remove(second);
}

TEST_CASE("what cannot be written is refused") {
  const nacre::Image image = nacre::Render(FirstScene(), Small());
  const auto code_of = [](const nacre::Image& written, const std::string& path,
                          const nacre::WriteSettings& settings = {}) {
    try {
      nacre::Write(written, path, settings);
    } catch (const nacre::Error& error) {
      return error.exit_code();
    }
    return 0;
  };
  REQUIRE(code_of(image, "/no such folder/a.exr") == 74);
  REQUIRE(code_of(image, PathOf("a.jpg")) == 64);
  nacre::WriteSettings settings;
  settings.compression = "rar";
  REQUIRE(code_of(image, PathOf("a.exr"), settings) == 64);
  settings = {};
  settings.tonemap = "filmic";
  REQUIRE(code_of(image, PathOf("a.png"), settings) == 64);
  REQUIRE(code_of({}, PathOf("a.exr")) == 64);
  nacre::Image short_one = image;
  short_one.channels[0].samples.pop_back();
  REQUIRE(code_of(short_one, PathOf("a.exr")) == 64);
  nacre::Image grey = image;
  grey.channels[0].name = "Y";
  REQUIRE(code_of(grey, PathOf("a.png")) == 64);
}

TEST_CASE("a heat map shows where images differ") {
  nacre::Image image;
  image.frame = image.data = {0, 0, 2, 1};
  for (const char* name : {"R", "G", "B"}) {
    image.channels.push_back({name, nacre::SampleType::kFloat, {0.5f, 0.5f}});
  }
  nacre::Image other = image;
  other.channels[1].samples[1] = 0.75f;
  const nacre::Picture map = nacre::HeatMap(other, image);
  REQUIRE(map.width == 2);
  REQUIRE(map.rgba.size() == 8);
  CHECK((map.rgba[0] == 0 && map.rgba[1] == 0 && map.rgba[2] == 0 && map.rgba[3] == 255));
  CHECK(map.rgba[5] > 100);
  nacre::HeatMapSettings settings;
  settings.low = 2;
  CHECK_THROWS_AS(nacre::HeatMap(other, image, settings), nacre::Error);
}

TEST_CASE("comparisons count and measure") {
  const nacre::Image reference = nacre::Render(FirstScene(), Small());
  nacre::Image image = reference;
  const nacre::Comparison same = nacre::Compare(image, reference);
  REQUIRE(same.match);
  REQUIRE(same.exceeding_pixels == 0);

  image.channels[0].samples[17] += 0.5f;
  nacre::CompareSettings settings;
  settings.perceptual = true;
  const nacre::Comparison differs = nacre::Compare(image, reference, settings);
  REQUIRE(!differs.match);
  REQUIRE(differs.exceeding_pixels == 1);
  REQUIRE(differs.pixels == 1600);
  const nacre::LayerMetrics& beauty = differs.layers.at(0);
  REQUIRE(beauty.layer.empty());
  // One of 3 x 1600 samples is off by half: the sum's rounding in float is below 1e-7.
  REQUIRE(beauty.rmse == Approx(std::sqrt(0.25 / 4800)).epsilon(1e-6));
  REQUIRE(*beauty.ssim < 1);
  REQUIRE(*beauty.flip > 0);
  REQUIRE(*nacre::Compare(reference, reference, settings).layers.at(0).flip == 0);

  settings = {};
  settings.max_abs = 0.6;
  REQUIRE(nacre::Compare(image, reference, settings).match);
  nacre::RenderSettings smaller = Small();
  smaller.width = 20;
  try {
    nacre::Compare(nacre::Render(FirstScene(), smaller), reference);
    FAIL("images of two sizes were compared");
  } catch (const nacre::Error& error) {
    REQUIRE(error.exit_code() == 2);
  }
}

}  // namespace
