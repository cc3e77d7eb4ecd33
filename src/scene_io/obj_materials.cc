#include "scene_io/obj_materials.h"

#include <algorithm>
#include <array>
#include <sstream>
#include <string_view>
#include <unordered_set>
#include <utility>

#include <fmt/format.h>

#include "base/error.h"
#include "scene_io/obj_file.h"
#include "scene_io/text_file.h"

namespace nacre {
namespace {

constexpr uint64_t kMaxBytes = uint64_t{64} << 20;

// tinyobjloader takes numbers that it cannot read as 0, and materials that name no illumination
// for those of illumination 0, which is none. They get 2 at first, ambient, diffuse and specular.
std::string Prepare(const std::string& text, const std::string& file) {
  std::string prepared;
  constexpr std::array<std::string_view, 4> kColors = {"Ka", "Kd", "Ks", "Ke"};
  constexpr std::array<std::string_view, 4> kNumbers = {"Ns", "d", "Tr", "illum"};
  const auto is_one_of = [](const auto& words, std::string_view word) {
    return std::find(words.begin(), words.end(), word) != words.end();
  };
  size_t start = 0;
  for (size_t number = 1; start < text.size(); ++number) {
    const size_t end = std::min(text.find('\n', start), text.size());
    std::string_view line = std::string_view(text).substr(start, end - start);
    const std::string_view keyword = NextObjWord(&line);
    const std::string place = fmt::format("{}:{}", file, number);
    std::string_view rest = line;
    const std::string_view first = NextObjWord(&rest);
    start = end + 1;
    prepared.append(text, static_cast<size_t>(keyword.data() - text.data()),
                    end - static_cast<size_t>(keyword.data() - text.data()));
    prepared += keyword == "newmtl" ? "\nillum 2\n" : "\n";
    if (is_one_of(kColors, keyword)) {
      if (first == "spectral" || first == "xyz") {
        throw Error(ExitCode::kBadInput, place, fmt::format("a color by \"{}\"", first),
                    "three numbers, red, green and blue, are read");
      }
      CheckObjNumbers(line, keyword, 3, 3, place);
    } else if (is_one_of(kNumbers, keyword) && first != "-halo") {
      CheckObjNumbers(line, keyword, 1, 1, place);
    }
  }
  return prepared;
}

Rgb ColorOf(const tinyobj::real_t (&color)[3]) { return {color[0], color[1], color[2]}; }

}  // namespace

MtlReader::MtlReader(const std::filesystem::path& obj, const LoadOptions& options)
    : folder_(obj.parent_path()), file_(obj.string()), options_(options) {}

void MtlReader::Warn(const std::string& text) {
  if (std::find(told_.begin(), told_.end(), text) != told_.end()) return;
  told_.push_back(text);
  if (options_.on_warning) options_.on_warning(file_ + ": " + text);
}

bool MtlReader::operator()(const std::string& name, std::vector<tinyobj::material_t>* materials,
                           std::map<std::string, int>* numbers, std::string* warning,
                           std::string* error) {
  std::error_code ignored;
  std::filesystem::path path;
  try {
    path = ResolveReference(folder_, name, options_.allow_paths);
  } catch (const Error& refused) {
    const Fault& fault = refused.faults().front();
    if (fault.what.starts_with("there is no file")) {
      Warn(fmt::format("its materials are left out: there is no file \"{}\"", name));
      return false;
    }
    throw Error(ExitCode::kBadInput, file_, fault.what, fault.hint);
  }
  std::istringstream stream(Prepare(ReadTextFile(path, kMaxBytes), path.string()));
  tinyobj::LoadMtl(numbers, materials, &stream, warning, error);
  return true;
}

Material MtlReader::MakeMaterial(const tinyobj::material_t& source) {
  Material result;
  result.emission = ColorOf(source.emission);
  for (const std::string* image :
       {&source.diffuse_texname, &source.specular_texname, &source.ambient_texname,
        &source.bump_texname, &source.normal_texname, &source.emissive_texname,
        &source.alpha_texname, &source.specular_highlight_texname}) {
    if (!image->empty()) Warn("images are not shown, only the numbers of materials");
  }
  if (source.dissolve < 1) Warn("transparency is not shown: all materials are opaque");
  if (source.illum > 2) Warn("reflections and refraction (illum above 2) are not shown");
  PhongMaterial phong;
  phong.model = PhongModel::kBlinnPhong;
  phong.convention = PhongConvention::kClassic;
  phong.ka = ColorOf(source.ambient);
  phong.kd = ColorOf(source.diffuse);
  phong.ks = source.illum == 1 ? Rgb(0) : ColorOf(source.specular);
  phong.shininess = source.shininess;
  if (source.illum == 0) {  // a constant colour
    result.emission += phong.kd;
    phong.ka = phong.kd = phong.ks = Rgb(0);
  }
  result.model = phong;
  return result;
}

std::vector<Material> MtlReader::MakeMaterials(const std::vector<tinyobj::material_t>& sources) {
  std::vector<Material> materials;
  materials.reserve(sources.size() + 1);
  std::unordered_set<std::string> names;
  for (size_t i = 0; i < sources.size(); ++i) {
    std::string name = sources[i].name;
    if (name.empty() || !names.insert(name).second) name += fmt::format("#{}", i);
    names.insert(name);
    materials.push_back(MakeMaterial(sources[i]));
    materials.back().name = std::move(name);
  }
  materials.push_back(MakeClay());
  // In the reading of the others, so that the same light suits it.
  if (!sources.empty()) {
    materials.back().model = PhongMaterial{.model = PhongModel::kBlinnPhong,
                                           .convention = PhongConvention::kClassic,
                                           .ka = Rgb(0.7),
                                           .ks = Rgb(0.1)};
  }
  return materials;
}

Material MakeClay() {
  Material clay;
  clay.name = "default";
  clay.model = MetallicRoughnessMaterial{.base_color = Rgb(0.7), .roughness = 0.5};
  return clay;
}

}  // namespace nacre
