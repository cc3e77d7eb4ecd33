// SPDX-License-Identifier: Apache-2.0
// tests/fuzz/replay_main.cc: seeds and once harmful files through the targets, without libFuzzer.
//
// Usage: nacre_fuzz_replay FOLDER...   FOLDER/<target>/* goes to that target
//        nacre_fuzz_replay TARGET FILE...
#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "fuzz/targets.h"
#include "scene_io/text_file.h"

namespace nacre {
namespace {

namespace fs = std::filesystem;

struct Target {
  std::string_view name;
  void (*run)(std::string_view bytes);
};
constexpr std::array kTargets = {Target{"scene_json", FuzzSceneJson},
                                 Target{"set_path", FuzzSetPath},
                                 Target{"obj", FuzzObj},
                                 Target{"ply", FuzzPly},
                                 Target{"sphere_file", FuzzSphereFile},
                                 Target{"gltf", FuzzGltf},
                                 Target{"glb", FuzzGlb},
                                 Target{"materialx", FuzzMaterialX},
                                 Target{"texture_image", FuzzTextureImage},
                                 Target{"environment_image", FuzzEnvironmentImage},
                                 Target{"compare_image", FuzzCompareImage},
                                 Target{"merl", FuzzMerl},
                                 Target{"rgl", FuzzRgl},
                                 Target{"table", FuzzBrdfTable}};

void Replay(const Target& target, const fs::path& file) {
  // The last line before a crash names the culprit.
  std::printf("%s\n", file.c_str());
  std::fflush(stdout);
  constexpr uint64_t kMaxBytes = 1 << 24;
  target.run(ReadBytes(file, kMaxBytes));
}

// How many files there were.
size_t ReplayFolder(const fs::path& folder) {
  size_t count = 0;
  for (const Target& target : kTargets) {
    if (!fs::is_directory(folder / target.name)) continue;
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(folder / target.name)) files.push_back(entry);
    std::sort(files.begin(), files.end());
    for (const fs::path& file : files) Replay(target, file);
    count += files.size();
  }
  return count;
}

int Main(const std::vector<std::string>& arguments) {
  size_t count = 0;
  const auto target = std::find_if(kTargets.begin(), kTargets.end(), [&](const Target& known) {
    return !arguments.empty() && known.name == arguments[0];
  });
  if (target == kTargets.end()) {
    for (const std::string& folder : arguments) {
      const size_t found = ReplayFolder(folder);
      if (found == 0) std::fprintf(stderr, "%s: no files for any target\n", folder.c_str());
      if (found == 0) return 1;
      count += found;
    }
  } else {
    count = arguments.size() - 1;
    for (size_t i = 1; i <= count; ++i) Replay(*target, arguments[i]);
  }
  std::printf("%zu files read or refused\n", count);
  return count == 0 ? 1 : 0;
}

}  // namespace
}  // namespace nacre

int main(int argc, char** argv) { return nacre::Main({argv + 1, argv + argc}); }
