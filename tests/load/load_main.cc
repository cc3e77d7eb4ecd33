// SPDX-License-Identifier: Apache-2.0
// tests/load/load_main.cc: the program behind scripts/load: many small renders in one process,
// through the public API alone, with what a service would do around each (a scene read, changed,
// rendered, written, read back, compared, and a faulty one refused); and as many changes of
// sessions, each rendered. Memory must stay flat, and a picture the same from its first turn to its
// last.
//
// Usage: nacre_load SCENES_FOLDER RENDERS
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <iterator>
#include <string>
#include <vector>

#include <malloc.h>
#include <unistd.h>

#include "nacre.h"

namespace {

// Renders after which threads, allocators and Embree have filled their stores.
constexpr int kWarmUp = 400;
// What memory may grow by after that, the least of the last five of ten points. The heap in use is
// what tells of leaks. Of 10 000 renders it was 938 to 1020 KiB in two runs; where the second
// thread found its first work after the warm-up, 300 more from there on, its scratch. Twice that is
// 60 bytes a render. Resident memory has stacks, libraries' stores and the heap's gaps as well.
constexpr long kMaxHeapGrowthKib = 600, kMaxResidentGrowthKib = 2048;

struct Job {
  const char* scene;
  const char* intersector;
  int threads, samples;
  double max_error;
};

// Spheres, meshes, area lights, skies and textures; both intersectors; adaptive sampling.
constexpr Job kJobs[] = {
    {"first_scene.json", "tiles", 1, 1, 0},      {"first_scene.json", "embree", 2, 2, 0},
    {"mesh_and_spheres.json", "auto", 2, 1, 0},  {"area_lights.json", "auto", 1, 4, 0},
    {"evening_sky.json", "auto", 2, 2, 0},       {"textures.json", "auto", 1, 1, 0},
    {"interpolations.json", "embree", 2, 1, 0},  {"phong_vs_pbr.json", "auto", 1, 2, 0},
    {"material_grid.json", "embree", 1, 1, 0.1},
};

long HeapKib() { return static_cast<long>(mallinfo2().uordblks / 1024); }

// What is free is no leak, but resident. malloc_trim gives it back, all but the top of arenas other
// than the first: threads' own. That goes back as it grows beyond a threshold, which malloc raises
// to megabytes by itself unless it is set.
void GiveBackWhatIsFree() { mallopt(M_TRIM_THRESHOLD, 128 * 1024); }

long ResidentKib() {
  malloc_trim(0);
  std::FILE* const file = std::fopen("/proc/self/statm", "r");
  long pages = 0;
  const int read = file != nullptr ? std::fscanf(file, "%*d %ld", &pages) : 0;
  if (file != nullptr) std::fclose(file);
  return read == 1 ? pages * (sysconf(_SC_PAGESIZE) / 1024) : -1;
}

[[noreturn]] void Fail(const std::string& what) {
  std::fprintf(stderr, "load: %s\n", what.c_str());
  std::exit(1);
}

nacre::Image RenderJob(const std::string& folder, const Job& job, int turn) {
  nacre::Scene scene = nacre::Scene::FromFile(folder + "/" + job.scene);
  scene.AddMaterial("load", {{"model", "metallic_roughness"}, {"base_color", {0.2, 0.4, 0.6}}});
  scene.AddSphere({0, 100, 0}, 0.5, "load");
  nacre::RenderSettings settings{.width = 32,
                                 .height = 18,
                                 .samples = job.samples,
                                 .max_error = job.max_error,
                                 .threads = job.threads,
                                 .intersector = job.intersector};
  // Layers that come and go do not change the picture.
  if (turn % 2 == 1) settings.layers = {"N", "Z", "diffuse"};
  return nacre::Render(scene, settings);
}

// Writes, reads back and compares, as a service that hands files out.
void RoundTrip(const nacre::Image& image, const std::string& path) {
  nacre::WriteSettings settings;
  settings.half_floats = false;
  nacre::Write(image, path, settings);
  if (!nacre::Compare(nacre::Read(path), image).match) Fail("a file is not what was written");
}

void RefuseFaulty() {
  try {
    nacre::Scene::FromJson(R"({"nacre": 1, "shapes": [{"type": "cube"}, {"type": "sphere"}]})")
        .Check();
  } catch (const nacre::Error&) {
    return;
  }
  Fail("a faulty scene was not refused");
}

// KiB before the first render, after the warm-up, and at ten points from there on.
struct Use {
  long at_start = 0, warm = 0;
  std::vector<long> later;

  long Growth() const {
    const auto last = later.end() - std::min<std::ptrdiff_t>(std::ssize(later), 5);
    return *std::min_element(last, later.end()) - warm;
  }
};

struct Memory {
  Use heap, resident;
};

// What memory is in use over so many turns.
Memory Measure(int renders, const std::function<void(int)>& turn) {
  Memory memory;
  memory.heap.at_start = HeapKib();
  memory.resident.at_start = ResidentKib();
  for (int i = 0; i < renders; ++i) {
    turn(i);
    const int done = i + 1;
    if (done == kWarmUp) {
      memory.heap.warm = HeapKib();
      memory.resident.warm = ResidentKib();
    }
    if (done > kWarmUp && (done - kWarmUp) * 10 % (renders - kWarmUp) < 10) {
      memory.heap.later.push_back(HeapKib());
      memory.resident.later.push_back(ResidentKib());
    }
  }
  return memory;
}

Memory MeasureJobs(const std::string& folder, int renders) {
  const std::string path =
      (std::filesystem::temp_directory_path() / ("nacre_load_" + std::to_string(getpid()) + ".exr"))
          .string();
  constexpr int kKinds = static_cast<int>(std::size(kJobs));
  std::vector<std::vector<float>> first(kKinds);
  const Memory memory = Measure(renders, [&](int i) {
    const auto kind = static_cast<size_t>(i % kKinds);
    const nacre::Image image = RenderJob(folder, kJobs[kind], i / kKinds);
    const std::vector<float>& green = image.Find("G")->samples;
    if (first[kind].empty()) first[kind] = green;
    if (green != first[kind]) Fail(std::string(kJobs[kind].scene) + " changed between renders");
    if (i % 10 == 0) RoundTrip(image, path);
    if (i % 10 == 5) RefuseFaulty();
  });
  std::filesystem::remove(path);
  return memory;
}

// A change of a scene; every part of one changes in some.
struct SessionChange {
  const char* pointer;
  const char* values[2];
};
constexpr SessionChange kChanges[] = {
    {"/materials/red/roughness", {"0.3", "0.1"}},
    {"/camera/position", {"[0, 1.6, 6]", "[1, 2, 7]"}},
    {"/lights/key/intensity", {"140", "20"}},
    {"/lights/sky",
     {R"({"type": "ambient", "radiance": [0.1, 0.11, 0.13]})",
      R"({"type": "environment", "image": "textures/evening.exr"})"}},
    {"/shapes/0/radius", {"1", "0.7"}},
    {"/shapes/0",
     {R"({"type": "sphere", "center": [0, 1, 0], "radius": 1, "material": "red"})",
      R"({"type": "icosphere", "center": [0, 1, 0], "radius": 1, "subdivisions": 2,
                       "material": "red"})"}},
    {"/materials/red/base_color", {"[0.8, 0.1, 0.08]", "0.5"}},
    {"/image/filter", {R"({"type": "box"})", R"({"type": "gaussian", "width": 3})"}},
    {"/background", {"[0.05, 0.05, 0.08]", "0"}}};
constexpr int kRound = 2 * static_cast<int>(std::size(kChanges));

// Changes of one session, one after the other and back, and some that are refused.
Memory MeasureSession(const std::string& folder, int renders) {
  nacre::Session session(nacre::Scene::FromFile(folder + "/first_scene.json"));
  nacre::RenderSettings settings{.width = 32, .height = 18, .samples = 2, .threads = 2};
  std::vector<std::vector<float>> first(kRound);
  return Measure(renders, [&](int i) {
    const int turn = i % kRound;
    const SessionChange& change = kChanges[turn / 2];
    // There, and back: every turn of a round begins with the scene of the file.
    session.Set(change.pointer, nacre::Value::Json(change.values[(turn + 1) % 2]));
    const nacre::Image image = session.Render(settings);
    const std::vector<float>& green = image.Find("G")->samples;
    const auto place = static_cast<size_t>(turn);
    if (first[place].empty()) first[place] = green;
    if (green != first[place]) Fail(std::string(change.pointer) + " gives another picture");
    if (i % 10 != 5) return;
    try {
      session.Set("/materials/red/roughness", 7);
    } catch (const nacre::Error&) {
      return;
    }
    Fail("a roughness of 7 was not refused");
  });
}

// Prints what was used; whether it grew by no more than `allowed`.
bool Flat(const char* name, const Use& use, long allowed) {
  std::printf("%s, KiB: %ld at the start, %ld after %d renders, then", name, use.at_start, use.warm,
              kWarmUp);
  for (const long kib : use.later) std::printf(" %ld", kib);
  const long growth = use.Growth();
  std::printf("\n  growth %ld, %ld allowed\n", growth, allowed);
  return use.warm > 0 && growth <= allowed;
}

}  // namespace

int main(int argc, char** argv) {
  const int renders = argc == 3 ? std::atoi(argv[2]) : 0;
  if (renders <= kWarmUp) {
    Fail("usage: nacre_load SCENES_FOLDER RENDERS, more than " + std::to_string(kWarmUp));
  }
  GiveBackWhatIsFree();
  try {
    bool all_flat = true;
    const auto judge = [&](const char* what, const Memory& memory) {
      std::printf("%d renders of %s\n", renders, what);
      all_flat &= Flat("heap in use", memory.heap, kMaxHeapGrowthKib);
      all_flat &= Flat("resident", memory.resident, kMaxResidentGrowthKib);
    };
    judge("scenes that are read", MeasureJobs(argv[1], renders));
    judge("a session, each after a change", MeasureSession(argv[1], renders));
    return all_flat ? 0 : 1;
  } catch (const nacre::Error& error) {
    Fail(error.what());
  }
}
