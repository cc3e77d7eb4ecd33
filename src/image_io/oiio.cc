// SPDX-License-Identifier: Apache-2.0
#include "image_io/oiio.h"

#include <cinttypes>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <vector>

#include <dlfcn.h>
#include <link.h>

#include "base/error.h"
#include "base/printable.h"
#include "image_io/oiio_abi.h"

namespace nacre {
namespace {

namespace fs = std::filesystem;

constexpr char kModuleName[] = "nacre_oiio.so";
constexpr uint64_t kMaxSamples = (uint64_t{2} << 30) / sizeof(float);

struct Module {
  decltype(&NacreOiioReadImage) read_image;
  decltype(&NacreOiioFreeImage) free_image;
  decltype(&NacreOiioDrawText) draw_text;
};

template <typename Function>
Function Find(void* library, const char* name) {
  void* const symbol = dlsym(library, name);
  if (symbol == nullptr) throw Error(ExitCode::kInternal, kModuleName, dlerror());
  return reinterpret_cast<Function>(symbol);
}

// The file that this code was loaded from, libnacre.so or a program, as the kernel knows it: no
// name that a caller chose (argv[0], a relative path of a library) and no working folder has a part
// in it. Empty if it cannot be told.
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

// Whether this code is a program's own, and not libnacre.so's.
bool IsInProgram() {
  Dl_info info{};
  link_map* map = nullptr;
  const auto* const own = reinterpret_cast<const void*>(&OwnFile);
  const int found = dladdr1(own, &info, reinterpret_cast<void**>(&map), RTLD_DL_LINKMAP);
  return found != 0 && map != nullptr && map->l_name[0] == '\0';
}

// Where the module may be: beside the file of this code, as in a build tree, and where it is
// installed as seen from there, so that an installation can be moved. Nowhere else: what is loaded
// runs.
std::vector<fs::path> ModulePaths() {
  const fs::path folder = OwnFile().parent_path();
  if (!folder.is_absolute()) return {};
  const char* const installed = IsInProgram() ? NACRE_MODULE_FROM_PROGRAM : "nacre";
  return {folder / kModuleName, folder / installed / kModuleName};
}

Module LoadModule() {
  std::error_code error;
  for (const fs::path& path : ModulePaths()) {
    if (!fs::exists(path, error)) continue;
    // Never closed: OpenImageIO's libraries do not survive it.
    void* const library = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (library == nullptr) throw Error(ExitCode::kInternal, path, dlerror());
    return {Find<decltype(Module::read_image)>(library, "NacreOiioReadImage"),
            Find<decltype(Module::free_image)>(library, "NacreOiioFreeImage"),
            Find<decltype(Module::draw_text)>(library, "NacreOiioDrawText")};
  }
  throw Error(
      ExitCode::kInternal, kModuleName,
      "the module for it is neither beside the program or library nor where it is installed",
      "EXR files need no module; for other formats and labels build or install it");
}

const Module& GetModule() {
  static const Module module = LoadModule();
  return module;
}

Window ToWindow(const int32_t (&window)[4]) { return {window[0], window[1], window[2], window[3]}; }

// The next of several strings that stand one after the other.
std::string Take(const char** strings) {
  std::string string = *strings;
  *strings += string.size() + 1;
  return string;
}

Image ToImage(const NacreOiioImage& source) {
  Image image;
  image.data = ToWindow(source.data_window);
  image.display = ToWindow(source.display_window);
  const auto channel_count = static_cast<size_t>(source.channel_count);
  const char* names = source.channel_names;
  for (size_t c = 0; c < channel_count; ++c) {
    Channel& channel = image.channels.emplace_back();
    channel.name = Take(&names);
    channel.type = source.half_samples != 0 ? PixelType::kHalf : PixelType::kFloat;
    channel.samples.resize(image.data.pixel_count());
    for (size_t i = 0; i < channel.samples.size(); ++i) {
      channel.samples[i] = source.samples[i * channel_count + c];
    }
  }
  const char* attributes = source.attributes;
  while (*attributes != '\0') {
    const std::string name = Take(&attributes);
    image.metadata[name] = Take(&attributes);
  }
  image.metadata["transfer"] = source.integer_samples != 0 ? "display" : "linear";
  return image;
}

}  // namespace

Image ReadWithOiio(const std::string& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (!fs::exists(status)) throw Error(ExitCode::kBadInput, path, "no such file");
  if (!fs::is_regular_file(status)) {
    throw Error(ExitCode::kBadInput, path, "is not a regular file");
  }
  const Module& module = GetModule();
  NacreOiioImage image{};
  const char* const failure = module.read_image(path.c_str(), kMaxSamples, &image);
  if (failure != nullptr) {
    throw Error(ExitCode::kBadInput, path, std::string("cannot be read: ") + failure);
  }
  const auto free_image = [&](NacreOiioImage* read) { module.free_image(read); };
  const std::unique_ptr<NacreOiioImage, decltype(free_image)> owner(&image, free_image);
  return ToImage(image);
}

void DrawText(std::span<uint8_t> rgb8, int width, int height, const std::vector<TextItem>& items) {
  if (width < 1 || height < 1 ||
      rgb8.size() != 3 * static_cast<size_t>(width) * static_cast<size_t>(height)) {
    throw Error(ExitCode::kInternal, "labels", "the buffer is not of the picture's size");
  }
  std::vector<std::string> printable;
  printable.reserve(items.size());
  std::vector<NacreOiioText> texts;
  texts.reserve(items.size());
  for (const TextItem& item : items) {
    printable.push_back(Printable(item.text));
    texts.push_back({printable.back().c_str(),
                     item.x,
                     item.y,
                     item.size_px,
                     static_cast<int32_t>(item.align_x) - 1,
                     static_cast<int32_t>(item.align_y) - 1,
                     {item.color[0], item.color[1], item.color[2]},
                     static_cast<uint8_t>(item.outline ? 1 : 0)});
  }
  const char* const failure = GetModule().draw_text(rgb8.data(), width, height, texts.data(),
                                                    static_cast<int32_t>(texts.size()));
  if (failure != nullptr) throw Error(ExitCode::kInternal, "labels", failure);
}

}  // namespace nacre
