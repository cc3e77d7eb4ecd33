// SPDX-License-Identifier: Apache-2.0
#include "scene_io/obj_materials.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include <fmt/format.h>

#include "base/error.h"
#include "base/excerpt.h"
#include "scene_io/mtl_file.h"
#include "scene_io/scene_budget.h"
#include "scene_io/text_file.h"
#include "scene_io/text_lines.h"
#include "scene_io/texture_image.h"
#include "scene_io/unique_names.h"

namespace nacre {
namespace {

// A Blinn-Phong material in the classic convention, with the numbers of the library.
PhongMaterial MakePhong(const MtlMaterial& source) {
  return {.model = PhongModel::kBlinnPhong,
          .convention = PhongConvention::kClassic,
          .ka = source.ka,
          .kd = source.kd,
          .ks = source.illum == 1 ? Rgb(0) : source.ks,
          .shininess = source.ns};
}

// Reads the format's extension for physically based rendering. Without a roughness, the exponent
// gives the width of the highlight: alpha^2 = 2 / (n + 2).
MetallicRoughnessMaterial MakeMetallicRoughness(const MtlMaterial& source) {
  MetallicRoughnessMaterial result;
  result.base_color = source.kd;
  result.metallic = source.pm.value_or(source.map_pm.file.empty() ? 0 : 1);
  const double from_exponent =
      source.ns > 1 ? std::sqrt(std::sqrt(2 / (source.ns + 2))) : result.roughness;
  result.roughness = source.pr.value_or(source.map_pr.file.empty() ? from_exponent : 1);
  if (source.ni > 1) {  // 1, which has no effect, is written by default
    const double root = (source.ni - 1) / (source.ni + 1);
    result.dielectric_f0 = Rgb(root * root);
  }
  return result;
}

// Whether the material has a sheen or a clear coat.
bool HasLayers(const MtlMaterial& source) {
  return source.ps > 0 || source.pc > 0 || !source.map_ps.file.empty() ||
         !source.map_pc.file.empty() || !source.map_pcr.file.empty();
}

class ObjMaterials {
 public:
  ObjMaterials(const std::filesystem::path& obj, const LoadOptions& options, Scene* scene)
      : folder_(obj.parent_path()), file_(obj.string()), options_(options), scene_(*scene) {
    texels_.AddFile(obj);
  }

  std::vector<MaterialId> Add(const ObjFile& obj) {
    for (const std::string& line : obj.libraries) ReadLibraries(line);
    if (libraries_.empty() && !obj.material_names.empty()) ReadNamesake();
    for (const std::string& name : missing_libraries_) {
      Warn(fmt::format("{} left out: {}",
                       libraries_.empty() ? "its materials are" : "a material library is",
                       WhyMissing(name)));
    }
    DecodeAhead();
    for (size_t i = 0; i < sources_.size(); ++i) AddMaterial(i);
    const MaterialId none{static_cast<uint32_t>(scene_.materials.size())};
    scene_.materials.push_back(MakeClay());
    std::string& name_of_none = scene_.materials.back().name;
    name_of_none = names_.Take(name_of_none, "#", sources_.size());
    // In the convention of the others, so that the same lights suit it.
    if (IsClassic()) {
      scene_.materials.back().model = PhongMaterial{.model = PhongModel::kBlinnPhong,
                                                    .convention = PhongConvention::kClassic,
                                                    .ka = Rgb(0.7),
                                                    .ks = Rgb(0.1)};
    }
    std::vector<MaterialId> ids;
    for (const std::string& name : obj.material_names) {
      const std::optional<MaterialId> known = MaterialNamed(name);
      ids.push_back(known.value_or(none));
      // Missing libraries were reported already.
      if (known || name.empty() || !missing_libraries_.empty()) continue;
      if (++unknown_names_ > kMaxNames) continue;
      Warn(fmt::format("no material library has \"{}\": its faces are grey", Excerpt(name)));
    }
    if (unknown_names_ > kMaxNames) {
      Warn(fmt::format("and {} more materials that no library has", unknown_names_ - kMaxNames));
    }
    ids.push_back(none);
    return ids;
  }

 private:
  static constexpr size_t kMaxNames = 8;
  // The files of map_Pr and map_Pm; empty if there is none.
  using ImagePair = std::pair<std::filesystem::path, std::filesystem::path>;

  void Warn(const std::string& text) {
    if (warned_.insert(text).second && options_.on_warning)
      options_.on_warning(file_ + ": " + text);
  }

  // The material with this name, or with the part of it before a comment.
  std::optional<MaterialId> MaterialNamed(const std::string& name) const {
    const std::string before(WithoutHashWords(name));
    for (const auto& [names, wanted] :
         {std::pair(&by_name_, &name), {&by_name_, &before}, {&by_name_before_, &before}}) {
      const auto found = names->find(*wanted);
      if (found != names->end()) return found->second;
    }
    return std::nullopt;
  }

  static bool IsAbsolute(const std::string& name) {
    return std::filesystem::path(name).is_absolute();
  }

  // Describes why there is no file with this name.
  std::string WhyMissing(const std::string& name) const {
    const std::string quoted = fmt::format("\"{}\"", Excerpt(name));
    return IsAbsolute(name) && !options_.allow_paths ? quoted + " is outside the model's folder"
                                                     : "there is no file " + quoted;
  }

  bool IsClassic() const {
    return std::any_of(scene_.materials.begin(), scene_.materials.end(), [](const Material& m) {
      return std::holds_alternative<PhongMaterial>(m.model);
    });
  }

  // The file that a name refers to; nullopt if there is none. Names may contain the backslashes of
  // Windows, a backslash before each blank, a comment at the end, or folders of the machine on
  // which the model was made; they may be relative to the model's folder or to a library's. Throws
  // Error (kBadInput) for a relative name outside the model's folder. An absolute name mostly is
  // one of another machine, and so does not exist here.
  std::optional<std::filesystem::path> Find(const std::string& name) const {
    std::string with_slashes = name, unescaped = name;
    std::replace(with_slashes.begin(), with_slashes.end(), '\\', '/');
    for (size_t at = 0; (at = unescaped.find("\\ ", at)) != std::string::npos; ++at) {
      unescaped.erase(at, 1);
    }
    std::vector<std::string> candidates = {name, with_slashes, unescaped,
                                           std::string(WithoutHashWords(name))};
    for (const std::filesystem::path& folder : library_folders_) {
      candidates.push_back((folder / with_slashes).string());
    }
    candidates.push_back(with_slashes.substr(with_slashes.rfind('/') + 1));
    std::optional<Error> outside;
    for (size_t i = 0; i < candidates.size(); ++i) {
      if (candidates[i].empty() || (i > 0 && candidates[i] == name)) continue;
      try {
        return ResolveReference(folder_, candidates[i], {options_.allow_paths, options_.on_file});
      } catch (const Error& error) {
        const Fault& fault = error.faults().front();
        if (i == 0 && fault.what.ends_with(kIsOutside) && !IsAbsolute(name)) {
          outside = Error(ExitCode::kBadInput, file_, fault.what, fault.hint);
        }
      }
    }
    if (outside) throw Error(*outside);
    return std::nullopt;
  }

  // Find() for text that may be several names: then it is no error if the whole text is not a file.
  std::optional<std::filesystem::path> FindWhole(const std::string& name) const {
    try {
      return Find(name);
    } catch (const Error&) {
      if (name.find_first_of(" \t") == std::string::npos) throw;
      return std::nullopt;
    }
  }

  // Reads the libraries after "mtllib": one name, perhaps with blanks, or several names, each of
  // which ends with ".mtl" or is a single word.
  void ReadLibraries(const std::string& line) {
    if (const auto whole = FindWhole(line)) return ReadLibrary(*whole);
    std::string_view rest = WithoutHashWords(line);
    while (!Trimmed(rest).empty()) {
      const std::string_view before = rest;
      std::string_view word = NextWord(&rest);
      while (!LowerCase(word).ends_with(".mtl") && !Trimmed(rest).empty()) word = NextWord(&rest);
      ReadLibraryOrWords(std::string(Trimmed(before.substr(0, before.size() - rest.size()))));
    }
    if (line.empty()) missing_libraries_.push_back(line);
  }

  void ReadLibraryOrWords(const std::string& name) {
    if (const auto whole = FindWhole(name)) return ReadLibrary(*whole);
    bool is_found = false;
    std::string_view rest = name;
    for (auto word = NextWord(&rest); !word.empty(); word = NextWord(&rest)) {
      const std::string text(Trimmed(word));
      const auto path = text == name ? std::nullopt : Find(text);
      if (!path) continue;
      is_found = true;
      ReadLibrary(*path);
    }
    if (!is_found) missing_libraries_.push_back(name);
  }

  // Like other readers, looks for a library named like the model if nothing else is found.
  void ReadNamesake() {
    const std::string name = std::filesystem::path(file_).stem().string() + ".mtl";
    const auto path = Find(name);
    if (!path) return;
    ReadLibrary(*path);
    Warn(fmt::format("its materials are read from \"{}\", which it does not name", Excerpt(name)));
  }

  void ReadLibrary(const std::filesystem::path& path) {
    if (!libraries_.insert(path.string()).second) return;
    library_folders_.insert(path.parent_path());
    texels_.AddFile(path);
    for (MtlMaterial& material : ReadMtlFile(path, kMaxModelMaterials - sources_.size(),
                                             [&](const std::string& text) { Warn(text); })) {
      sources_.push_back(std::move(material));
    }
  }

  // Decodes the images that most materials have, on several threads.
  void DecodeAhead() {
    const auto want = [&](const MtlImage& image, TextureEncoding encoding) {
      if (image.file.empty()) return;
      try {
        const std::optional<std::filesystem::path> path = Find(image.file);
        if (path) ahead_.Want(*path, Reading(encoding));
      } catch (const Error&) {  // NOLINT(bugprone-empty-catch): AddTexture will throw it again
      }
    };
    for (const MtlMaterial& source : sources_) {
      want(source.map_ke, TextureEncoding::kSrgb);
      want(source.norm, TextureEncoding::kLinear);
      want(source.map_kd, TextureEncoding::kSrgb);
      want(source.map_pr, TextureEncoding::kLinear);
      want(source.map_pm, TextureEncoding::kLinear);
    }
    ahead_.Decode(texels_, options_.threads);
  }

  TextureReading Reading(TextureEncoding encoding) {
    return {.encoding = encoding,
            .part = {},
            .threads = options_.threads,
            .on_warning = [this](const std::string& text) { Warn(text); }};
  }

  void AddMaterial(size_t index) {
    const MtlMaterial& source = sources_[index];
    const MaterialId id{static_cast<uint32_t>(scene_.materials.size())};
    by_name_.try_emplace(source.name, id);  // the first of several wins
    by_name_before_.try_emplace(std::string(WithoutHashWords(source.name)), id);
    Material material = MakeMaterial(source);
    material.name = names_.Take(std::string(WithoutComment(source.name)), "#", index);
    scene_.materials.push_back(std::move(material));
  }

  Material MakeMaterial(const MtlMaterial& source) {
    Material result;
    result.emission = source.ke;
    const bool has_roughness =
        source.pr || source.pm || !source.map_pr.file.empty() || !source.map_pm.file.empty();
    if (HasLayers(source) && (source.illum == 0 || !has_roughness)) {
      Warn(
          "sheen and clear coats (Ps, Pc) are shown only of materials with a roughness or a "
          "metallic (Pr, Pm)");
    }
    if (source.opacity < 1) Warn("transparency is not shown: all materials are opaque");
    if (source.illum > 2) Warn("reflections and refraction (illum above 2) are not shown");
    AddCommonMaps(source, &result);
    const TextureId diffuse = AddTexture(source.map_kd, TextureEncoding::kSrgb);
    // Exporters that write a map often leave its factor at 0.
    const Rgb kd = diffuse.valid() && source.kd == Rgb(0) ? Rgb(1) : source.kd;
    if (source.illum == 0) {
      AddConstantColor(source, kd, diffuse, &result);
      return result;
    }
    if (has_roughness) {
      MetallicRoughnessMaterial model = MakeMetallicRoughness(source);
      model.base_color = kd;
      model.base_color_map = diffuse;
      model.metallic_roughness_map = AddMetallicRoughness(source);
      AddLayers(source, &model);
      if (!source.map_ks.file.empty() || !source.map_ns.file.empty()) {
        Warn("images of highlights (map_Ks, map_Ns) are not shown beside roughness and metallic");
      }
      result.model = model;
      return result;
    }
    PhongMaterial model = MakePhong(source);
    model.kd = kd;
    model.diffuse_map = diffuse;
    model.specular_map = AddTexture(source.map_ks, TextureEncoding::kSrgb);
    model.shininess_map = AddTexture(source.map_ns, TextureEncoding::kLinear);
    result.model = model;
    return result;
  }

  // The format's sheen is only a strength: it becomes white, with the default roughness of
  // Blender's sheen.
  void AddLayers(const MtlMaterial& source, MetallicRoughnessMaterial* model) {
    // Exporters that write a map often leave its factor at 0.
    const auto factor = [](double number, TextureId map) {
      return map.valid() && number == 0 ? 1 : number;
    };
    model->sheen_color_map = AddTexture(source.map_ps, TextureEncoding::kLinear);
    model->sheen_color = Rgb(factor(source.ps, model->sheen_color_map));
    if (!IsBlack(model->sheen_color)) model->sheen_roughness = 0.5;
    model->coat_map = AddTexture(source.map_pc, TextureEncoding::kLinear);
    model->coat = factor(source.pc, model->coat_map);
    if (model->coat == 0) return;
    model->coat_roughness_map = AddTexture(source.map_pcr, TextureEncoding::kLinear);
    model->coat_roughness = factor(source.pcr, model->coat_roughness_map);
  }

  // illum 0: the diffuse colour and its image are emitted, independent of lights. Images of
  // highlights and normals have no effect then.
  void AddConstantColor(const MtlMaterial& source, const Rgb& kd, TextureId diffuse,
                        Material* material) {
    PhongMaterial black = MakePhong(source);
    black.ka = black.kd = black.ks = Rgb(0);
    material->model = black;
    material->normal_map = {};
    if (kd == Rgb(0)) return;
    if (!diffuse.valid() && !material->emission_map.valid()) {
      material->emission += kd;
      return;
    }
    if (material->emission != Rgb(0)) {  // a material has only one emission image
      Warn("constant colours (illum 0) are shown without their emission (Ke, map_Ke)");
    }
    material->emission = kd;
    material->emission_map = diffuse;
  }

  void AddCommonMaps(const MtlMaterial& source, Material* material) {
    material->emission_map = AddTexture(source.map_ke, TextureEncoding::kSrgb);
    if (material->emission_map.valid() && material->emission == Rgb(0)) material->emission = Rgb(1);
    material->normal_map.texture = AddTexture(source.norm, TextureEncoding::kLinear);
    material->normal_map.scale = source.norm.multiplier;
    if (IsGrey(material->normal_map.texture)) {
      Warn("an image of normals (norm) is left out: it is grey, as heights are");
      material->normal_map = {};
    }
    const bool ambient = !source.map_ka.file.empty() && source.map_ka.file != source.map_kd.file;
    if (ambient) Warn("ambient images (map_Ka) are not shown");
    if (!source.bump.file.empty()) Warn("bump images are not shown: normal ones (norm) are");
    if (!source.disp.file.empty()) Warn("displacement images are not shown");
    if (!source.map_d.file.empty()) Warn("transparency is not shown: all materials are opaque");
  }

  bool IsGrey(TextureId id) const {
    return id.valid() && scene_.images[scene_.textures[id.index].image.index].texels->channels < 3;
  }

  // Adds an image once per file, however the file's name is spelled.
  std::optional<ImageId> AddImage(const MtlImage& source, TextureEncoding encoding) {
    const std::filesystem::path path = FindImage(source.file);
    if (path.empty()) return std::nullopt;
    const auto [known, is_new] = images_.try_emplace({path, encoding});
    if (is_new) {
      known->second = WithImage(source, [&] {
        return AddTextureImage(path, source.file, Reading(encoding), &texels_, &scene_, &ahead_);
      });
    }
    return known->second;
  }

  // The path of the image; empty if there is no name or no such file, as models often come without
  // their images.
  std::filesystem::path FindImage(const std::string& name) {
    if (name.empty()) return {};
    const auto [known, is_new] = image_paths_.try_emplace(name);
    if (!is_new) return known->second;
    const std::optional<std::filesystem::path> path = Find(name);
    if (!path) {
      Warn("an image is left out: " + WhyMissing(name));
      return {};
    }
    texels_.AddFile(*path);
    known->second = *path;
    return *path;
  }

  // The result of read() for the image; nullopt, with a warning, if it cannot be read: one broken
  // image should not prevent the model from being shown.
  template <class Read>
  auto WithImage(const MtlImage& source, const Read& read) -> std::optional<decltype(read())> {
    try {
      return read();
    } catch (const Error& error) {
      if (error.code() != ExitCode::kBadInput) throw;
      Warn(fmt::format("an image is left out: {}: \"{}\": {}", source.place, Excerpt(source.file),
                       error.faults().front().what));
      return std::nullopt;
    }
  }

  TextureId AddTextureOf(const MtlImage& source, ImageId image) {
    Texture& texture = scene_.textures.emplace_back();
    texture.name = source.file;
    texture.image = image;
    texture.scale = source.scale;
    texture.offset = source.offset;
    if (source.clamp) texture.sampling.wrap_u = texture.sampling.wrap_v = Wrap::kClamp;
    return {static_cast<uint32_t>(scene_.textures.size() - 1)};
  }

  TextureId AddTexture(const MtlImage& source, TextureEncoding encoding) {
    const std::optional<ImageId> image = AddImage(source, encoding);
    return image ? AddTextureOf(source, *image) : TextureId{};
  }

  // Adds map_Pr and map_Pm as the green and blue channels of one image. If both are the same colour
  // image, it has them there already.
  TextureId AddMetallicRoughness(const MtlMaterial& source) {
    const ImagePair paths(FindImage(source.map_pr.file), FindImage(source.map_pm.file));
    const auto& [roughness, metallic] = paths;
    if (roughness.empty() && metallic.empty()) return {};
    const auto [known, is_new] = metallic_roughness_.try_emplace(paths);
    if (is_new) known->second = MakeMetallicRoughnessImage(source, paths);
    if (!known->second) return {};
    return AddTextureOf(roughness.empty() ? source.map_pm : source.map_pr, *known->second);
  }

  std::optional<ImageId> MakeMetallicRoughnessImage(const MtlMaterial& source,
                                                    const ImagePair& paths) {
    const auto read = [&](const std::filesystem::path& path,
                          const MtlImage& image) -> std::shared_ptr<const MipChain> {
      if (path.empty()) return nullptr;
      const auto texture = WithImage(image, [&] {
        return ReadTextureImage(path, image.file, Reading(TextureEncoding::kLinear), &texels_,
                                &ahead_);
      });
      return texture ? texture->texels : nullptr;
    };
    const auto roughness = read(paths.first, source.map_pr);
    const auto metallic = read(paths.second, source.map_pm);
    if (roughness == nullptr && metallic == nullptr) return std::nullopt;
    const MipLevel& size = (roughness != nullptr ? roughness : metallic)->levels[0];
    if (roughness != nullptr && metallic != nullptr &&
        (metallic->levels[0].width != size.width || metallic->levels[0].height != size.height)) {
      Warn("images of roughness and metallic (map_Pr, map_Pm) that differ in size are not shown");
      return std::nullopt;
    }
    const bool is_packed = paths.first == paths.second && roughness->channels >= 3;
    const auto value = [&](const std::shared_ptr<const MipChain>& image, size_t texel,
                           size_t packed_channel) {
      if (image == nullptr) return 1.0f;
      return image->Level(
          0)[texel * static_cast<size_t>(image->channels) + (is_packed ? packed_channel : 0)];
    };
    const MtlImage& first = roughness != nullptr ? source.map_pr : source.map_pm;
    const auto has_room = WithImage(first, [&] {
      texels_.Spend({}, size.width, size.height, 3);
      return true;
    });
    if (!has_room) return std::nullopt;
    const size_t texels = static_cast<size_t>(size.width) * static_cast<size_t>(size.height);
    std::vector<float> values;
    values.reserve(3 * texels);
    for (size_t i = 0; i < texels; ++i) {
      values.insert(values.end(), {1.0f, value(roughness, i, 1), value(metallic, i, 2)});
    }
    SceneImage& image = scene_.images.emplace_back();
    image.file = first.file;
    image.texels =
        std::make_shared<const MipChain>(MakeMipChain(size.width, size.height, 3, values));
    return ImageId{static_cast<uint32_t>(scene_.images.size() - 1)};
  }

  std::filesystem::path folder_;
  std::string file_;
  const LoadOptions& options_;
  Scene& scene_;
  std::vector<MtlMaterial> sources_;
  std::vector<std::string> missing_libraries_;
  std::set<std::filesystem::path> library_folders_;
  size_t unknown_names_ = 0;
  // By the library's names, and by the part of these before a comment.
  std::unordered_map<std::string, MaterialId> by_name_, by_name_before_;
  UniqueNames names_;
  std::unordered_set<std::string> warned_, libraries_;
  TexelBudget texels_{0};
  TexturesAhead ahead_;
  std::unordered_map<std::string, std::filesystem::path> image_paths_;  // by name; empty: no file
  // nullopt for images that cannot be read, or do not fit each other.
  std::map<std::pair<std::filesystem::path, TextureEncoding>, std::optional<ImageId>> images_;
  std::map<ImagePair, std::optional<ImageId>> metallic_roughness_;
};

}  // namespace

std::vector<MaterialId> AddObjMaterials(const std::filesystem::path& path, const ObjFile& obj,
                                        const LoadOptions& options, Scene* scene) {
  return ObjMaterials(path, options, scene).Add(obj);
}

Material MakeClay() {
  Material clay;
  clay.name = "default";
  clay.model = MetallicRoughnessMaterial{.base_color = Rgb(0.7), .roughness = 0.5};
  return clay;
}

}  // namespace nacre
