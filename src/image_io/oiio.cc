// SPDX-License-Identifier: Apache-2.0
// image_io/oiio.cc: reads TIFF files with OpenImageIO, which is loaded when first used.
//
// It is in a module of its own, nacre_oiio.so. The module is looked for beside the file that
// contains this code, program or libnacre.so, and where it is installed relative to that file:
// ../lib/nacre from a program, nacre/ from the library. Neither the working folder nor the
// environment matters.
#include <algorithm>
#include <cinttypes>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <utility>
#include <vector>

#include <dlfcn.h>
#include <fmt/format.h>
#include <link.h>

#include "base/error.h"
#include "base/input_file.h"
#include "image_io/format_readers.h"
#include "image_io/oiio_abi.h"
#include "image_io/orientation.h"

namespace nacre {
namespace {

namespace fs = std::filesystem;

constexpr char kModuleName[] = "nacre_oiio.so";

struct Module {
  decltype(&NacreOiioOpen) open;
  decltype(&NacreOiioReadRows) read_rows;
  decltype(&NacreOiioClose) close;
};

template <typename Function>
Function Find(void* library, const char* name) {
  void* const symbol = dlsym(library, name);
  if (symbol == nullptr) throw Error(ExitCode::kInternal, kModuleName, dlerror());
  return reinterpret_cast<Function>(symbol);
}

// The path of the file that this code was loaded from, libnacre.so or a program, as the kernel
// knows it. So it depends neither on a name that a caller chose (argv[0], a relative path of a
// library) nor on the working folder. Empty if it cannot be determined.
fs::path OwnFile() {
  const auto own = reinterpret_cast<uintptr_t>(&OwnFile);
  std::ifstream maps("/proc/self/maps");
  std::string line;
  while (std::getline(maps, line)) {
    // "begin-end permissions offset device inode   /path"
    const size_t slash = line.find('/');
    uintptr_t begin = 0, end = 0;
    if (slash == std::string::npos) continue;
    if (std::sscanf(line.c_str(), "%" SCNxPTR "-%" SCNxPTR, &begin, &end) != 2) continue;
    if (own >= begin && own < end) return line.substr(slash);
  }
  return {};
}

// Whether this code is linked into a program, and not loaded from libnacre.so.
bool IsInProgram() {
  Dl_info info{};
  link_map* map = nullptr;
  const auto* const own = reinterpret_cast<const void*>(&OwnFile);
  const int found = dladdr1(own, &info, reinterpret_cast<void**>(&map), RTLD_DL_LINKMAP);
  return found != 0 && map != nullptr && map->l_name[0] == '\0';
}

// Where the module may be: beside the file of this code, as in a build tree, or where it is
// installed relative to that file, so that an installation can be moved. It is not looked for
// elsewhere, since loading it executes it.
std::vector<fs::path> ModulePaths() {
  const fs::path folder = OwnFile().parent_path();
  if (!folder.is_absolute()) return {};
  const char* const installed = IsInProgram() ? NACRE_MODULE_FROM_PROGRAM : "nacre";
  return {folder / kModuleName, folder / installed / kModuleName};
}

// The path of the module; empty if there is none.
fs::path ModulePath() {
  std::error_code error;
  for (const fs::path& path : ModulePaths()) {
    if (fs::exists(path, error)) return path;
  }
  return {};
}

Module LoadModule() {
  const fs::path path = ModulePath();
  // The module is never closed: OpenImageIO's libraries do not survive that.
  void* const library = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) throw Error(ExitCode::kInternal, path, dlerror());
  return {Find<decltype(Module::open)>(library, "NacreOiioOpen"),
          Find<decltype(Module::read_rows)>(library, "NacreOiioReadRows"),
          Find<decltype(Module::close)>(library, "NacreOiioClose")};
}

const Module& GetModule() {
  static const Module module = LoadModule();
  return module;
}

Window ToWindow(const int32_t (&window)[4]) { return {window[0], window[1], window[2], window[3]}; }

// Takes the next of several consecutive NUL-terminated strings.
std::string Take(const char** strings) {
  std::string string = *strings;
  *strings += string.size() + 1;
  return string;
}

// Moves both windows of the oriented image to the origin: an offset that a scanner writes for the
// place on the page, or a camera for a part of its sensor, does not mean that the image is a crop.
Image HeaderOf(const NacreOiioFile& source, const Orientation& orientation) {
  Image header;
  header.data = ToWindow(source.data_window);
  header.display = ToWindow(source.display_window);
  const bool is_crop = header.data.width() != header.display.width() ||
                       header.data.height() != header.display.height();
  if (!is_crop || orientation != Orientation()) {
    int width = header.data.width(), height = header.data.height();
    if (orientation.transpose) std::swap(width, height);
    header.data = header.display = {0, 0, width, height};
  }
  const char* names = source.channel_names;
  for (int32_t c = 0; c < source.channel_count; ++c) {
    header.channels.push_back(
        {Take(&names), source.half_samples != 0 ? PixelType::kHalf : PixelType::kFloat, {}});
  }
  const char* attributes = source.attributes;
  while (*attributes != '\0') {
    const std::string name = Take(&attributes);
    header.metadata[name] = Take(&attributes);
  }
  header.metadata["transfer"] = source.integer_samples != 0 ? "display" : "linear";
  return header;
}

// An open file, which closes itself.
class OpenFile {
 public:
  explicit OpenFile(const std::string& path) : path_(path) {
    if (const char* const failure = GetModule().open(path.c_str(), kFreeSamples, &file_)) {
      FailToRead(path, failure);
    }
    // This comes after libtiff's own errors for files that it refuses.
    if (const std::string lacks = WhatTiffLacks(path); !lacks.empty()) {
      GetModule().close(&file_);
      FailToRead(path, lacks);
    }
  }
  ~OpenFile() { GetModule().close(&file_); }
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;

  const NacreOiioFile& get() const { return file_; }
  void ReadRows(int y0, int y1, float* values) {
    if (const char* const failure = GetModule().read_rows(&file_, y0, y1, values)) {
      FailToRead(path_, failure);
    }
  }

 private:
  std::string path_;
  NacreOiioFile file_{};
};

}  // namespace

bool HasOiio() { return !ModulePath().empty(); }

ImageFile OpenWithOiio(const std::string& path) {
  CheckInputFile(path);
  if (!HasOiio()) {
    throw Error(ExitCode::kBadInput, path,
                fmt::format("cannot be read: {} is neither beside the program or library nor where "
                            "it is installed",
                            kModuleName),
                "TIFF files need that module: install it, or build nacre with NACRE_OIIO=ON");
  }
  const OpenFile opened(path);
  const Orientation orientation = OrientationOfTag(opened.get().orientation);
  ImageFile image;
  image.path = path;
  image.file_bytes = FileBytes(path);
  image.header = HeaderOf(opened.get(), orientation);
  image.parts = {PartOf(image.header)};
  // Opens the file again for each reading, which decodes the rows from the first one on.
  image.read = [path, orientation, channels = image.header.channels.size(),
                data = image.header.data](const Window& region,
                                          std::span<const SampleTarget> targets) {
    OpenFile file(path);
    const RowPlacer placer(orientation, data, region, targets);
    const Window stored = ToWindow(file.get().data_window);
    CheckUnchanged(path, placer.stored_width() == stored.width() &&
                             placer.stored_height() == stored.height() &&
                             channels == static_cast<size_t>(file.get().channel_count));
    const size_t row = static_cast<size_t>(placer.stored_width()) * channels;
    const int band = std::clamp(file.get().band_rows, 1, placer.stored_height());
    std::vector<float> values(row * static_cast<size_t>(band));
    for (int y = 0; y < placer.stored_height(); y += band) {
      const int end = std::min(y + band, placer.stored_height());
      file.ReadRows(y, end, values.data());
      for (int i = y; i < end; ++i) {
        placer.Place(i, values.data() + static_cast<size_t>(i - y) * row, channels);
      }
    }
  };
  return image;
}

}  // namespace nacre
