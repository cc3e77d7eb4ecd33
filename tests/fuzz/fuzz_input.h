// SPDX-License-Identifier: Apache-2.0
// tests/fuzz/fuzz_input.h: what the targets share: files to be read, and what a reader may do.
#pragma once

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include <unistd.h>

#include "base/error.h"
#include "scene_io/load_scene.h"

namespace nacre {

// A folder of this process's own, gone when it ends.
class FuzzFolder {
 public:
  FuzzFolder()
      : path_(std::filesystem::temp_directory_path() / ("nacre_fuzz." + std::to_string(getpid()))) {
    std::filesystem::create_directories(path_);
  }
  ~FuzzFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  FuzzFolder(const FuzzFolder&) = delete;
  FuzzFolder& operator=(const FuzzFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path Write(const std::string& name, std::string_view bytes) const {
    std::ofstream(path_ / name, std::ios::binary)
        .write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    return path_ / name;
  }

 private:
  std::filesystem::path path_;
};

// Holds what scenes and models may refer to.
const FuzzFolder& SharedFolder();

[[noreturn]] inline void Fail(const std::string& what) {
  std::fprintf(stderr, "not what a reader may do: %s\n", what.c_str());
  std::abort();
}

inline bool IsRefusal(ExitCode code) {
  return code == ExitCode::kBadInput || code == ExitCode::kUsage ||
         code == ExitCode::kCannotCompare;
}

// Calls `read`, which may succeed or refuse its input with words.
template <class Read>
void ReadOrRefuse(const Read& read) {
  try {
    read();
  } catch (const Error& error) {
    if (!IsRefusal(error.code())) Fail(error.what());
    for (const Fault& fault : error.faults()) {
      if (fault.what.empty()) Fail("a fault without words");
    }
  }  // other exceptions end the process, and so they should
}

// What small inputs may be made into. The default would let one input take seconds.
inline LoadOptions SmallScenes() { return {.max_primitives = 20'000}; }

}  // namespace nacre
