// SPDX-License-Identifier: Apache-2.0
#include "scene_io/obj_materials.h"

#include <algorithm>
#include <array>
#include <charconv>
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

constexpr uint64_t kMaxMtlBytes = uint64_t{64} << 20;

// Of an image: tinyobjloader lets the exponents of its options overflow.
void CheckOptions(std::string_view line, const std::string& place) {
  for (auto word = NextObjWord(&line); !word.empty(); word = NextObjWord(&line)) {
    double number = 0;
    const auto sign = static_cast<size_t>(word.starts_with('+'));
    const auto read = std::from_chars(word.data() + sign, word.data() + word.size(), number);
    if (read.ec != std::errc::result_out_of_range) continue;
    throw Error(ExitCode::kBadInput, place, fmt::format("\"{}\" is not a finite number", word));
  }
}

// tinyobjloader takes numbers that it cannot read as 0, and materials that name no illumination
// for those of illumination 0, which is none. They get 2 at first, ambient, diffuse and specular.
std::string Prepare(const std::string& text, const std::string& file) {
  std::string prepared;
  constexpr std::array<std::string_view, 4> kColors = {"Ka", "Kd", "Ks", "Ke"};
  constexpr std::array<std::string_view, 4> kNumbers = {"Ns", "d", "Tr", "illum"};
  constexpr std::array<std::string_view, 4> kImages = {"norm", "bump", "disp", "refl"};
  constexpr std::array<std::string_view, 10> kUnused = {"Kt", "Tf", "Ni",  "Pr",    "Pm",
                                                        "Ps", "Pc", "Pcr", "aniso", "anisor"};
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
    if (is_one_of(kUnused, keyword)) continue;
    if (keyword.starts_with("map_") || is_one_of(kImages, keyword)) CheckOptions(line, place);
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
  if (!told_.insert(text).second) return;
  if (options_.on_warning) options_.on_warning(file_ + ": " + text);
}

bool MtlReader::operator()(const std::string& name, std::vector<tinyobj::material_t>* materials,
                           std::map<std::string, int>* numbers, std::string* warning,
                           std::string* error) {
  std::error_code ignored;
  std::filesystem::path path;
  try {
    path = ResolveReference(folder_, name, {options_.allow_paths, options_.on_file});
  } catch (const Error& refused) {
    const Fault& fault = refused.faults().front();
    if (fault.what.starts_with("there is no file")) {
      Warn(fmt::format("its materials are left out: there is no file \"{}\"", name));
      return false;
    }
    throw Error(ExitCode::kBadInput, file_, fault.what, fault.hint);
  }
  if (!libraries_.insert(path.string()).second) return true;  // a file may name it a million times
  std::istringstream stream(Prepare(ReadTextFile(path, kMaxMtlBytes), path.string()));
  tinyobj::LoadMtl(numbers, materials, &stream, warning, error);
  return true;
}

// -s and -o: uv times the scale plus the offset.
TextureId MtlReader::AddTexture(const std::string& name, const tinyobj::texture_option_t& options,
                                TextureEncoding encoding, Scene* scene) {
  if (name.empty()) return {};
  auto image = images_.find({name, encoding});
  if (image == images_.end()) {
    try {
      const auto path = ResolveReference(folder_, name, {options_.allow_paths, options_.on_file});
      AddTextureImage(path, name, {.encoding = encoding, .part = {}}, scene);
    } catch (const Error& error) {
      const Fault& fault = error.faults().front();
      if (fault.what.starts_with("there is no file")) {  // models often come without
        Warn(fmt::format("an image is left out: {}", fault.what));
        return {};
      }
      throw Error(error.code(), file_, fmt::format("its image \"{}\": {}", name, fault.what),
                  fault.hint);
    }
    const ImageId id{static_cast<uint32_t>(scene->images.size() - 1)};
    image = images_.emplace(std::make_pair(name, encoding), id).first;
  }
  Texture& texture = scene->textures.emplace_back();
  texture.name = name;
  texture.image = image->second;
  texture.scale = {options.scale[0], options.scale[1]};
  texture.offset = {options.origin_offset[0], options.origin_offset[1]};
  if (options.clamp) texture.sampling.wrap_u = texture.sampling.wrap_v = Wrap::kClamp;
  return {static_cast<uint32_t>(scene->textures.size() - 1)};
}

void MtlReader::AddMaps(const tinyobj::material_t& source, Scene* scene, Material* material) {
  auto& phong = std::get<PhongMaterial>(material->model);
  const auto add = [&](const std::string& name, const tinyobj::texture_option_t& options,
                       TextureEncoding encoding) {
    return AddTexture(name, options, encoding, scene);
  };
  phong.diffuse_map = add(source.diffuse_texname, source.diffuse_texopt, TextureEncoding::kSrgb);
  phong.specular_map = add(source.specular_texname, source.specular_texopt, TextureEncoding::kSrgb);
  phong.shininess_map = add(source.specular_highlight_texname, source.specular_highlight_texopt,
                            TextureEncoding::kLinear);
  material->emission_map =
      add(source.emissive_texname, source.emissive_texopt, TextureEncoding::kSrgb);
  material->normal_map.texture =
      add(source.normal_texname, source.normal_texopt, TextureEncoding::kLinear);
  // Exporters that write a map often leave its factor at 0.
  if (phong.diffuse_map.valid() && phong.kd == Rgb(0)) phong.kd = Rgb(1);
  if (material->emission_map.valid() && material->emission == Rgb(0)) material->emission = Rgb(1);
  for (const std::string* image : {&source.ambient_texname, &source.bump_texname,
                                   &source.displacement_texname, &source.alpha_texname}) {
    if (!image->empty()) Warn("ambient, bump, displacement and alpha images are not shown");
  }
}

Material MtlReader::MakeMaterial(const tinyobj::material_t& source, Scene* scene) {
  Material result;
  result.emission = ColorOf(source.emission);
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
  if (source.illum != 0) AddMaps(source, scene, &result);
  return result;
}

std::vector<Material> MtlReader::MakeMaterials(const std::vector<tinyobj::material_t>& sources,
                                               Scene* scene) {
  std::vector<Material> materials;
  materials.reserve(sources.size() + 1);
  std::unordered_set<std::string> names;
  for (size_t i = 0; i < sources.size(); ++i) {
    std::string name = sources[i].name;
    if (name.empty() || !names.insert(name).second) name += fmt::format("#{}", i);
    names.insert(name);
    materials.push_back(MakeMaterial(sources[i], scene));
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
