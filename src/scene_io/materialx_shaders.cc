// SPDX-License-Identifier: Apache-2.0
#include "scene_io/materialx_shaders.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/error.h"
#include "base/excerpt.h"
#include "scene/material_parameters.h"
#include "scene_io/materialx_color.h"

namespace nacre {
namespace {

using Value = MaterialXValue;
using ValueKind = MaterialXValue::Kind;

// An input of a shader with its default, as MaterialX's node definitions have them.
struct ShaderInput {
  std::string_view name;
  int size;  // of components; 0: a vector in space, which has no default here
  Rgb otherwise{0, 0, 0};
};

constexpr Rgb Grey(double number) { return {number, number, number}; }

// open_pbr_surface 1.1.1, and what the branch of 1.2 adds.
const std::array kOpenPbrInputs = std::to_array<ShaderInput>({
    {"base_weight", 1, Grey(1)},
    {"base_color", 3, Grey(0.8)},
    {"base_diffuse_roughness", 1},
    {"base_metalness", 1},
    {"specular_weight", 1, Grey(1)},
    {"specular_color", 3, Grey(1)},
    {"specular_roughness", 1, Grey(0.3)},
    {"specular_ior", 1, Grey(1.5)},
    {"specular_roughness_anisotropy", 1},
    {"specular_haze", 1},
    {"specular_haze_spread", 1, Grey(0.3)},
    {"specular_retroreflectivity", 1},
    {"transmission_weight", 1},
    {"transmission_color", 3, Grey(1)},
    {"transmission_depth", 1},
    {"transmission_scatter", 3},
    {"transmission_scatter_anisotropy", 1},
    {"transmission_dispersion_scale", 1},
    {"transmission_dispersion_abbe_number", 1, Grey(20)},
    {"subsurface_weight", 1},
    {"subsurface_color", 3, Grey(0.8)},
    {"subsurface_radius", 1, Grey(1)},
    {"subsurface_radius_scale", 3, {1, 0.5, 0.25}},
    {"subsurface_scatter_anisotropy", 1},
    {"fuzz_weight", 1},
    {"fuzz_color", 3, Grey(1)},
    {"fuzz_roughness", 1, Grey(0.5)},
    {"coat_weight", 1},
    {"coat_color", 3, Grey(1)},
    {"coat_roughness", 1},
    {"coat_roughness_anisotropy", 1},
    {"coat_ior", 1, Grey(1.6)},
    {"coat_darkening", 1, Grey(1)},
    {"thin_film_weight", 1},
    {"thin_film_thickness", 1, Grey(0.5)},
    {"thin_film_ior", 1, Grey(1.4)},
    {"emission_weight", 1},
    {"emission_luminance", 1},
    {"emission_color", 3, Grey(1)},
    {"geometry_opacity", 1, Grey(1)},
    {"geometry_thin_walled", 1},
    {"geometry_normal", 0},
    {"geometry_coat_normal", 0},
    {"geometry_tangent", 0},
    {"geometry_coat_tangent", 0},
});

// The inputs of it that only version 1.2 has.
constexpr std::array<std::string_view, 4> kOpenPbr12Names = {
    "specular_haze", "specular_haze_spread", "specular_retroreflectivity", "emission_weight"};

// standard_surface 1.0.1.
const std::array kStandardInputs = std::to_array<ShaderInput>({
    {"base", 1, Grey(1)},
    {"base_color", 3, Grey(0.8)},
    {"diffuse_roughness", 1},
    {"metalness", 1},
    {"specular", 1, Grey(1)},
    {"specular_color", 3, Grey(1)},
    {"specular_roughness", 1, Grey(0.2)},
    {"specular_IOR", 1, Grey(1.5)},
    {"specular_anisotropy", 1},
    {"specular_rotation", 1},
    {"transmission", 1},
    {"transmission_color", 3, Grey(1)},
    {"transmission_depth", 1},
    {"transmission_scatter", 3},
    {"transmission_scatter_anisotropy", 1},
    {"transmission_dispersion", 1},
    {"transmission_extra_roughness", 1},
    {"subsurface", 1},
    {"subsurface_color", 3, Grey(1)},
    {"subsurface_radius", 3, Grey(1)},
    {"subsurface_scale", 1, Grey(1)},
    {"subsurface_anisotropy", 1},
    {"sheen", 1},
    {"sheen_color", 3, Grey(1)},
    {"sheen_roughness", 1, Grey(0.3)},
    {"coat", 1},
    {"coat_color", 3, Grey(1)},
    {"coat_roughness", 1, Grey(0.1)},
    {"coat_anisotropy", 1},
    {"coat_rotation", 1},
    {"coat_IOR", 1, Grey(1.5)},
    {"coat_normal", 0},
    {"coat_affect_color", 1},
    {"coat_affect_roughness", 1},
    {"thin_film_thickness", 1},
    {"thin_film_IOR", 1, Grey(1.5)},
    {"emission", 1},
    {"emission_color", 3, Grey(1)},
    {"opacity", 3, Grey(1)},
    {"thin_walled", 1},
    {"normal", 0},
    {"tangent", 0},
});

// gltf_pbr 2.0.1.
const std::array kGltfInputs = std::to_array<ShaderInput>({
    {"base_color", 3, Grey(1)},
    {"metallic", 1, Grey(1)},
    {"roughness", 1, Grey(1)},
    {"normal", 0},
    {"tangent", 0},
    {"occlusion", 1, Grey(1)},
    {"transmission", 1},
    {"specular", 1, Grey(1)},
    {"specular_color", 3, Grey(1)},
    {"ior", 1, Grey(1.5)},
    {"alpha", 1, Grey(1)},
    {"alpha_mode", 1},
    {"alpha_cutoff", 1, Grey(0.5)},
    {"iridescence", 1},
    {"iridescence_ior", 1, Grey(1.3)},
    {"iridescence_thickness", 1, Grey(100)},
    {"sheen_color", 3},
    {"sheen_roughness", 1},
    {"clearcoat", 1},
    {"clearcoat_roughness", 1},
    {"clearcoat_normal", 0},
    {"emissive", 3},
    {"emissive_strength", 1, Grey(1)},
    {"thickness", 1},
    {"attenuation_distance", 1},
    {"attenuation_color", 3, Grey(1)},
    {"anisotropy_strength", 1},
    {"anisotropy_rotation", 1},
    {"dispersion", 1},
});

struct ShaderKind {
  std::string_view kind;
  std::span<const ShaderInput> inputs;
};
const std::array kShaderKinds = {ShaderKind{"open_pbr_surface", kOpenPbrInputs},
                                 ShaderKind{"standard_surface", kStandardInputs},
                                 ShaderKind{"gltf_pbr", kGltfInputs}};

std::string NumbersText(const Rgb& color, bool is_color) {
  return is_color ? fmt::format("{:.4g} {:.4g} {:.4g}", color.x, color.y, color.z)
                  : fmt::format("{:.4g}", color.x);
}

// ---- Reading a shader's inputs, and writing a model's parameters --------------------------------

class ShaderConverter {
 public:
  ShaderConverter(MaterialXGraph* graph, size_t shader, std::string label,
                  MaterialXMaterial* result)
      : graph_(*graph), shader_(shader), label_(std::move(label)), result_(*result) {
    const std::string& kind = element().kind;
    inputs_ = std::ranges::find(kShaderKinds, kind, &ShaderKind::kind)->inputs;
    TellUnknownInputs();
  }

  void Convert() {
    const std::string& kind = element().kind;
    if (kind == "open_pbr_surface") FromOpenPbr();
    if (kind == "standard_surface") FromStandardSurface();
    if (kind == "gltf_pbr") FromGltf();
  }

 private:
  const MaterialXElement& element() const { return graph_.document().elements[shader_]; }

  void Note(std::string_view input, const std::string& text) {
    std::string note = fmt::format("{}: {}: {}: {}", graph_.document().PlaceOf(element()),
                                   Excerpt(result_.name), input, text);
    if (std::ranges::find(result_.notes, note) == result_.notes.end()) {
      result_.notes.push_back(std::move(note));
    }
  }

  void TellUnknownInputs() {
    constexpr size_t kMostNotes = 20;
    size_t count = 0;
    for (const size_t child : element().children) {
      const MaterialXElement& input = graph_.document().elements[child];
      if (input.kind != "input" || std::ranges::find(inputs_, std::string_view(input.name()),
                                                     &ShaderInput::name) != inputs_.end()) {
        continue;
      }
      if (++count > kMostNotes) return Note("...", "more inputs are not known");
      const std::string near = NearestName(input.name(), NamesOf(inputs_));
      Note(Excerpt(input.name()),
           fmt::format("{} has no such input{}", element().kind,
                       near.empty() ? "" : fmt::format("; did you mean \"{}\"?", near)));
    }
  }

  const ShaderInput& FindInput(std::string_view name) const {
    return *std::ranges::find(inputs_, name, &ShaderInput::name);
  }
  static Value DefaultOf(const ShaderInput& input) {
    return input.size == 3   ? MaterialXColor(input.otherwise)
           : input.size == 1 ? MaterialXNumber(input.otherwise.x)
                             : MaterialXUnknown("");
  }
  Value Get(std::string_view name) {
    return graph_.Input(shader_, name, DefaultOf(FindInput(name)));
  }
  // The same for inputs whose value decides what others mean: one that varies, or cannot be
  // followed, is told and has its default.
  Value GetFixed(std::string_view name) {
    Value value = Get(name);
    if (value.is_numbers()) return value;
    value = Followed(name, value, DefaultOf(FindInput(name)));
    if (value.is_numbers()) return value;
    const Value otherwise = DefaultOf(FindInput(name));
    Note(name, fmt::format("images of it are not shown; it is {}",
                           NumbersText(otherwise.Color(), otherwise.size == 3)));
    return otherwise;
  }

  // The value, or what is told to stand for a graph that cannot be followed.
  Value Followed(std::string_view input, const Value& value, const Value& otherwise) {
    if (!value.is_unknown() && value.kind != ValueKind::kNormal && value.kind != ValueKind::kText &&
        value.kind != ValueKind::kCoordinates) {
      return value;
    }
    Note(input, fmt::format("its graph is not followed: {}; it is {}",
                            value.is_unknown() ? value.text : "what is no number",
                            NumbersText(otherwise.Color(), otherwise.size == 3)));
    return otherwise;
  }

  // ---- Writing ----

  void Begin(std::string_view model) {
    model_ = FindModel(model);
    defaults_ = model_->make();
    result_.material = {{"model", model}};
  }

  // Sets the model's parameter. `input` is its name in the document; `otherwise` stands for what
  // cannot be followed or shown.
  void Put(std::string_view parameter, std::string_view input, const Value& given,
           const Value& otherwise) {
    const MaterialParameter& row = *FindParameter(*model_, parameter);
    Value value = Followed(input, given, otherwise);
    if (value.is_image() && !PutImage(parameter, input, value, otherwise)) value = otherwise;
    value.kind = ValueKind::kNumbers;  // of an image the factors
    PutNumbers(row, input, Resized(value, row.is_color ? 3 : 1).Color());
  }
  void Put(std::string_view parameter, std::string_view input, const Value& given) {
    Put(parameter, input, given, DefaultOf(FindInput(input)));
  }

  // An input that is followed before anything is computed with it.
  Value GetFollowed(std::string_view input) {
    return Followed(input, Get(input), DefaultOf(FindInput(input)));
  }

  void PutEmission(std::string_view color, std::string_view strength,
                   const Value& weight = MaterialXNumber(1)) {
    if (!HasWeight(Get(color)) || !HasWeight(Get(strength)) || !HasWeight(weight)) return;
    const Value whole = Multiply(GetFollowed(color), GetFollowed(strength));
    Put("emission", color, Multiply(whole, weight), MaterialXColor(Rgb(0)));
  }

  void PutNumbers(const MaterialParameter& row, std::string_view input, const Rgb& given) {
    Rgb value = given;
    // Conversions between colour spaces leave 1 by rounding.
    constexpr double kRounding = 1e-6;
    bool is_told = false;
    for (int c = 0; c < 3; ++c) {
      value[c] = std::clamp(given[c], row.range.min, row.range.max);
      is_told |= std::abs(value[c] - given[c]) > kRounding;
    }
    if (is_told) {
      Note(input, fmt::format(
                      "{}{} is out of range, and clamped to {}", NumbersText(given, row.is_color),
                      row.is_color ? " in linear Rec. 709" : "", NumbersText(value, row.is_color)));
    }
    Rgb otherwise = row.get(defaults_);
    if (value == otherwise) return;
    result_.material[std::string(row.name)] =
        row.is_color ? Json{value.x, value.y, value.z} : Json(value.x);
  }

  // Sets the map of the parameter; false, and the reason is told, if the model has none that shows
  // these channels.
  bool PutImage(std::string_view parameter, std::string_view input, const Value& value,
                const Value& otherwise) {
    const std::string name = std::string(parameter) + "_map";
    const auto map = std::ranges::find(model_->maps, std::string_view(name), &MaterialMap::name);
    const auto refuse = [&](const std::string& why) {
      Note(input,
           fmt::format("{}; it is {}", why, NumbersText(otherwise.Color(), otherwise.size == 3)));
      return false;
    };
    if (map == model_->maps.end()) return refuse("images of it are not shown");
    const auto& channels = value.channels;
    if (map->use == MapUse::kColor) {
      if (channels[0] == 0 && channels[1] == 0 && channels[2] == 0) {
        Note(input, "the image is shown in its own colours, not as the grey of its red");
      } else if (channels[0] != 0 || channels[1] != 1 || channels[2] != 2) {
        return refuse("an image with its channels in another order is not shown");
      }
      return PutTexture(name, input, value.image, {});
    }
    if (channels[0] == 3) return PutTexture(name, input, value.image, "alpha");
    const int wanted = map->use == MapUse::kTwoData ? 1 : 0;
    if (channels[0] != wanted) {
      return refuse(fmt::format("channel {} of an image is not shown, where channel {} is",
                                channels[0], wanted));
    }
    // Without an encoding, opacities would be read of the image's alpha.
    return PutTexture(name, input, value.image, map->use == MapUse::kOpacity ? "linear" : "");
  }

  // Adds the image as a texture, with an encoding or that of its colour space, and makes it the
  // map.
  bool PutTexture(const std::string& map, std::string_view input, const MaterialXImage& image,
                  std::string_view encoding) {
    result_.material[map] = AddTexture(map, input, image, encoding);
    return true;
  }

  std::string AddTexture(std::string_view map, std::string_view input, const MaterialXImage& image,
                         std::string_view encoding) {
    if (encoding.empty()) {
      const MaterialXColorSpace* space = FindMaterialXColorSpace(image.colorspace);
      if (space == nullptr) {
        Note(input, fmt::format("the colour space \"{}\" of its image is not known: it is read as "
                                "lin_rec709",
                                Excerpt(image.colorspace, 40)));
        space = FindMaterialXColorSpace("lin_rec709");
      }
      if (!TextureEncodingOf(*space, &encoding)) {
        Note(input, fmt::format("its image is in {}, and read as {}", space->name,
                                encoding == "srgb" ? "srgb_texture" : "lin_rec709"));
      }
    }
    if (image.has_border) {
      Note(input,
           "beyond its edges the image is continued, where the address mode \"constant\" has "
           "one colour");
    }
    const TexturePlacement place =
        *PlacementOf(image.at);  // the graph has checked that there is one
    Json texture = {{"file", image.file}, {"encoding", encoding}};
    if (image.filter != "trilinear") texture["filter"] = image.filter;
    if (image.wrap_u != "repeat") texture["wrap_u"] = image.wrap_u;
    if (image.wrap_v != "repeat") texture["wrap_v"] = image.wrap_v;
    if (place.scale != Vec2d(1, 1)) texture["scale"] = {place.scale.x, place.scale.y};
    if (place.offset != Vec2d(0, 0)) texture["offset"] = {place.offset.x, place.offset.y};
    if (place.rotate_deg != 0) texture["rotate_deg"] = place.rotate_deg;
    std::string name = fmt::format("{}/{}", label_, map);
    result_.textures.emplace_back(name, std::move(texture));
    return name;
  }

  // Sets a normal map of the model.
  void PutNormal(const char* map, std::string_view input) {
    if (!graph_.HasInput(shader_, input)) return;
    const Value normal = Get(input);
    if (normal.kind != ValueKind::kNormal) {
      return Note(input,
                  normal.is_unknown()
                      ? fmt::format("its graph is not followed: {}; it is left out", normal.text)
                      : "only normal maps are read; it is left out");
    }
    if (normal.image.file.empty() || normal.numbers[0] == 0) return;
    const double scale =
        std::clamp(normal.numbers[0], limits::kNormalScale.min, limits::kNormalScale.max);
    if (scale != normal.numbers[0]) Note(input, fmt::format("its scale is clamped to {}", scale));
    // MaterialX's nodes take 2 c - 1, so that code 128 of 255 is not quite 0.
    Json value = {{"texture", AddTexture(map, input, normal.image, {})}, {"convention", "literal"}};
    if (scale != 1) value["scale"] = scale;
    result_.material[map] = std::move(value);
  }

  // Whether the input has any effect by this weight.
  static bool HasWeight(const Value& weight) { return !weight.Is(0); }

  static std::string WeightText(const Value& weight) {
    return weight.is_numbers() ? NumbersText(weight.Color(), weight.size == 3) : "an image";
  }

  // ---- OpenPBR ----

  // What OpenPBR and shaders that are converted to it have in common, and the names of it there.
  struct OpenPbrBase {
    Value weight, color, metalness, subsurface_weight, subsurface_color, transmission;
    std::string_view weight_name, color_name, metalness_name, subsurface_name, transmission_name;
  };

  // Subsurface scattering as diffuse reflection, and transmission as none.
  void PutBase(const OpenPbrBase& base) {
    Value weight = base.weight, color = base.color;
    const Value& scattered = base.subsurface_weight;
    if (HasWeight(scattered) && scattered.is_numbers() && base.subsurface_color.is_numbers()) {
      Put("subsurface_weight", base.subsurface_name, scattered);
      Put("subsurface_color", "subsurface_color", base.subsurface_color);
      Note(base.subsurface_name, fmt::format("{}: shown as diffuse reflection of the subsurface "
                                             "colour",
                                             WeightText(scattered)));
    } else if (HasWeight(scattered)) {  // the model has no maps of subsurfaces
      const Value diffuse = Multiply(color, weight);
      const Value mixed = Mix(diffuse, base.subsurface_color, scattered);
      if (mixed.is_unknown()) {
        Note(base.subsurface_name,
             fmt::format("{}: not shown: {}", WeightText(scattered), mixed.text));
      } else {
        Note(base.subsurface_name, fmt::format("{}: shown as diffuse reflection of the subsurface "
                                               "colour",
                                               WeightText(scattered)));
        if (HasWeight(base.metalness)) {
          Note(base.metalness_name,
               "the metal has the colour that stands for subsurface scattering");
        }
        color = mixed;
        weight = MaterialXNumber(1);
      }
    }
    if (HasWeight(base.transmission)) {
      Note(base.transmission_name,
           fmt::format("{}: transmission is not rendered: the material is opaque, with its diffuse "
                       "base",
                       WeightText(base.transmission)));
    }
    Put("base_weight", base.weight_name, weight);
    Put("base_color", base.color_name, color);
    Put("base_metalness", base.metalness_name, base.metalness);
  }

  void PutOpacity(std::string_view input, const Value& opacity) {
    if (opacity.Is(1)) return;
    if (opacity.is_image()) {
      Note(input, "shown as holes, where it is below 0.5");
      return Put("opacity", input, opacity);
    }
    Note(input, opacity.is_unknown()
                    ? fmt::format("its graph is not followed: {}; it is 1", opacity.text)
                    : fmt::format("{}: not shown: the material is opaque", WeightText(opacity)));
  }

  void TellTangent(std::string_view input, const Value& anisotropy) {
    if (HasWeight(anisotropy) && graph_.HasInput(shader_, input)) {
      Note(input,
           "directions of its own are not read: highlights are stretched along the tangents");
    }
  }

  void TellThinWalls(std::string_view input) {
    if (HasWeight(Get(input))) Note(input, "what passes through thin walls is not rendered");
  }

  void TellCoatNormal(std::string_view input, std::string_view normal, const Value& coat) {
    if (!HasWeight(coat)) return;
    const bool has_own = graph_.HasInput(shader_, input),
               has_base = graph_.HasInput(shader_, normal);
    if (has_own && graph_.Connected(shader_, input) != graph_.Connected(shader_, normal)) {
      Note(input, "the coat has the normals of what lies below it");
    }
    if (!has_own && has_base) Note(normal, "the coat has these normals, too");
  }

  // Whether an open_pbr_surface is of version 1.2, by what it says or by its inputs.
  bool IsOpenPbr12() const {
    if (element().Attribute("version") == "1.2") return true;
    return std::ranges::any_of(
        kOpenPbr12Names, [&](std::string_view name) { return graph_.HasInput(shader_, name); });
  }

  void FromOpenPbr() {
    Begin("open_pbr");
    const bool is_12 = IsOpenPbr12();
    if (is_12) result_.material["version"] = "1.2";
    PutBase({.weight = Get("base_weight"),
             .color = Get("base_color"),
             .metalness = Get("base_metalness"),
             .subsurface_weight = Get("subsurface_weight"),
             .subsurface_color = Get("subsurface_color"),
             .transmission = Get("transmission_weight"),
             .weight_name = "base_weight",
             .color_name = "base_color",
             .metalness_name = "base_metalness",
             .subsurface_name = "subsurface_weight",
             .transmission_name = "transmission_weight"});
    for (const char* const name :
         {"base_diffuse_roughness", "specular_weight", "specular_color", "specular_roughness",
          "specular_ior", "specular_roughness_anisotropy", "coat_weight", "coat_color",
          "coat_roughness", "coat_roughness_anisotropy", "coat_ior", "coat_darkening",
          "fuzz_weight", "fuzz_color", "fuzz_roughness"}) {
      Put(name, name, Get(name));
    }
    PutEmission("emission_color", "emission_luminance",
                is_12 ? GetFollowed("emission_weight") : MaterialXNumber(1));
    if (is_12 && graph_.HasInput(shader_, "emission_luminance") &&
        !graph_.HasInput(shader_, "emission_weight")) {
      Note("emission_luminance", "emits nothing, because emission_weight is 0 in version 1.2");
    }
    for (const char* const name :
         {"specular_haze", "specular_haze_spread", "specular_retroreflectivity"}) {
      Put(name, name, Get(name));
    }
    PutOpacity("geometry_opacity", Get("geometry_opacity"));
    TellThinWalls("geometry_thin_walled");
    PutNormal("normal_map", "geometry_normal");
    TellCoatNormal("geometry_coat_normal", "geometry_normal", Get("coat_weight"));
    TellTangent("geometry_tangent", Get("specular_roughness_anisotropy"));
    if (HasWeight(Get("coat_weight"))) {
      TellTangent("geometry_coat_tangent", Get("coat_roughness_anisotropy"));
    }
    if (HasWeight(Get("transmission_weight"))) {
      for (const char* const name :
           {"transmission_weight", "transmission_color", "transmission_depth",
            "transmission_scatter", "transmission_scatter_anisotropy",
            "transmission_dispersion_scale", "transmission_dispersion_abbe_number"}) {
        Put(name, name, Get(name));
      }
    }
    if (HasWeight(Get("thin_film_weight"))) {
      for (const char* const name : {"thin_film_weight", "thin_film_thickness", "thin_film_ior"}) {
        Put(name, name, Get(name));
      }
    }
  }

  // ---- standard_surface ----

  // Sets roughness and anisotropy. standard_surface has alphas r^2 / a and r^2 a of the aspect
  // a = sqrt(1 - anisotropy); OpenPBR has alpha_b = (1 - anisotropy) alpha_t and
  // alpha_t^2 + alpha_b^2 = 2 r^4.
  void PutAnisotropic(std::string_view roughness, std::string_view roughness_input,
                      std::string_view anisotropy, std::string_view anisotropy_input) {
    const Value given = GetFixed(anisotropy_input);
    const double stretch = std::clamp(given.numbers[0], 0.0, 0.98);
    const double ratio = 1 - stretch;  // of the alphas: a^2
    Put(anisotropy, anisotropy_input, MaterialXNumber(stretch));
    const double widening = std::pow((1 / ratio + ratio) / 2, 0.25);
    Put(roughness, roughness_input, Multiply(Get(roughness_input), MaterialXNumber(widening)));
  }

  // A rotation of standard_surface: 1 is a whole turn.
  void PutRotation(std::string_view parameter, std::string_view input, const Value& anisotropy) {
    if (!HasWeight(anisotropy)) return;
    Put(parameter, input, Multiply(GetFixed(input), MaterialXNumber(360)));
  }

  void FromStandardSurface() {
    Begin("open_pbr");
    Value base = Get("base"), base_color = Get("base_color");
    // Version 1.0.0 has these two defaults the other way round.
    if (element().Attribute("version") == "1.0.0") {
      base = graph_.Input(shader_, "base", MaterialXNumber(0.8));
      base_color = graph_.Input(shader_, "base_color", MaterialXColor(Rgb(1)));
    }
    const Value metalness = Get("metalness"), coat = Get("coat"), coat_color = Get("coat_color");
    const bool is_metal = HasWeight(metalness), is_coated = HasWeight(coat);
    base_color = Multiply(base_color, Mix(MaterialXColor(Rgb(1)), coat_color, coat));
    PutBase({.weight = base,
             .color = base_color,
             .metalness = metalness,
             .subsurface_weight = Get("subsurface"),
             .subsurface_color = Get("subsurface_color"),
             .transmission = Get("transmission"),
             .weight_name = "base",
             .color_name = "base_color",
             .metalness_name = "metalness",
             .subsurface_name = "subsurface",
             .transmission_name = "transmission"});
    Put("base_diffuse_roughness", "diffuse_roughness", Get("diffuse_roughness"));
    // MaterialX's translation takes standard_surface's specular as that of the dielectric alone.
    const Value specular = Get("specular");
    if (is_metal && !metalness.Is(1) && !specular.Is(1)) {
      Note("specular", fmt::format("{}: 1 is taken, as metalness is not 0", WeightText(specular)));
    }
    Put("specular_weight", "specular", is_metal ? MaterialXNumber(1) : specular);
    const Value specular_color = Get("specular_color");
    Put("specular_color", "specular_color",
        specular_color.Is(0) ? MaterialXColor(Rgb(1)) : specular_color);
    PutAnisotropic("specular_roughness", "specular_roughness", "specular_roughness_anisotropy",
                   "specular_anisotropy");
    PutRotation("geometry_tangent_deg", "specular_rotation", Get("specular_anisotropy"));
    Put("specular_ior", "specular_IOR", Get("specular_IOR"));
    if (is_coated && is_metal) {
      Note("coat", fmt::format("{}: it tints the metal, and has no highlight of its own",
                               WeightText(coat)));
    } else if (is_coated) {
      Put("coat_weight", "coat", coat);
      Put("coat_color", "coat_color", coat_color);
      PutAnisotropic("coat_roughness", "coat_roughness", "coat_roughness_anisotropy",
                     "coat_anisotropy");
      PutRotation("geometry_coat_tangent_deg", "coat_rotation", Get("coat_anisotropy"));
      Put("coat_ior", "coat_IOR", Get("coat_IOR"));
      Put("coat_darkening", "coat_affect_roughness", Get("coat_affect_roughness"));
      if (!coat_color.Is(1)) Note("coat_color", "it tints the base as well as the coat");
      TellCoatNormal("coat_normal", "normal", coat);
    }
    if (is_coated && HasWeight(Get("coat_affect_color"))) {
      Note("coat_affect_color", "what lies below the coat is not saturated by it");
    }
    if (is_coated && HasWeight(Get("coat_affect_roughness"))) {
      Note("coat_affect_roughness", "taken for OpenPBR's coat_darkening");
    }
    const Value sheen = Get("sheen");
    Put("fuzz_weight", "sheen", sheen);
    if (HasWeight(sheen)) {
      Put("fuzz_color", "sheen_color", Get("sheen_color"));
      const auto fuzz_roughness = [](const Value& roughness) {
        return OfNumbers("a power", roughness, MaterialXNumber(0.4),
                         [](double x, double y) { return std::pow(std::max(x, 0.0), y); });
      };
      Put("fuzz_roughness", "sheen_roughness", fuzz_roughness(Get("sheen_roughness")),
          fuzz_roughness(DefaultOf(FindInput("sheen_roughness"))));
      Note("sheen", "shown as OpenPBR's fuzz, of roughness sheen_roughness^0.4");
    }
    PutEmission("emission_color", "emission");
    const Value opacity = Get("opacity");
    PutOpacity("opacity", Component(opacity, 0));
    TellThinWalls("thin_walled");
    PutNormal("normal_map", "normal");
    TellTangent("tangent", Get("specular_anisotropy"));
    if (const Value thickness = Get("thin_film_thickness"); HasWeight(thickness)) {
      Put("thin_film_weight", "thin_film_thickness", MaterialXNumber(1));
      // From nanometres to micrometres.
      Put("thin_film_thickness", "thin_film_thickness",
          Multiply(thickness, MaterialXNumber(0.001)));
      Put("thin_film_ior", "thin_film_IOR", Get("thin_film_IOR"));
    }
  }

  // ---- glTF ----

  void FromGltf() {
    Begin("metallic_roughness");
    Put("base_color", "base_color", Get("base_color"));
    PutMetallicRoughness();
    double ior = GetFixed("ior").numbers[0];  // 0: an infinite index, which reflects everything
    if (!(ior == 0 || ior >= 1)) {
      Note("ior", fmt::format("{} is below 1, and taken for 1", NumbersText(Rgb(ior), false)));
      ior = 1;
    }
    const double root = (ior - 1) / (ior + 1);
    const Value f0 = MaterialXNumber(root * root);
    Put("dielectric_f0", "specular_color", Multiply(GetFollowed("specular_color"), f0),
        Resized(f0, 3));
    Put("specular", "specular", Get("specular"));
    const Value anisotropy = Get("anisotropy_strength");
    Put("anisotropy", "anisotropy_strength", anisotropy);
    if (HasWeight(anisotropy)) {
      Put("anisotropy_rotation_deg", "anisotropy_rotation",
          Multiply(GetFixed("anisotropy_rotation"), MaterialXNumber(180 / M_PI)));
    }
    TellTangent("tangent", anisotropy);
    const Value coat = Get("clearcoat");
    Put("coat", "clearcoat", coat);
    if (HasWeight(coat)) {
      Put("coat_roughness", "clearcoat_roughness", Get("clearcoat_roughness"));
      PutNormal("coat_normal_map", "clearcoat_normal");
    }
    const Value sheen = Get("sheen_color"), sheen_roughness = Get("sheen_roughness");
    if (HasWeight(sheen) && HasWeight(sheen_roughness)) {
      Put("sheen_color", "sheen_color", sheen);
      Put("sheen_roughness", "sheen_roughness", sheen_roughness);
    }
    PutEmission("emissive", "emissive_strength");
    PutNormal("normal_map", "normal");
    PutAlpha();
    if (!Get("occlusion").Is(1)) {
      Note("occlusion", "left out: lights and their shadows are computed");
    }
    if (const Value transmission = Get("transmission"); HasWeight(transmission)) {
      Note("transmission", fmt::format("{}: transmission is not rendered: the material is opaque, "
                                       "with its diffuse base",
                                       WeightText(transmission)));
    }
    if (const Value iridescence = Get("iridescence"); HasWeight(iridescence)) {
      Put("iridescence", "iridescence", iridescence);
      Put("iridescence_ior", "iridescence_ior", Get("iridescence_ior"));
      Put("iridescence_thickness_nm", "iridescence_thickness", Get("iridescence_thickness"));
    }
  }

  // Roughness and metallic have one map: green of the first, blue of the second.
  void PutMetallicRoughness() {
    const Value roughness = Get("roughness"), metallic = Get("metallic");
    const bool is_packed = roughness.is_image() && metallic.is_image() &&
                           roughness.image == metallic.image && roughness.channels[0] == 1 &&
                           metallic.channels[0] == 2;
    const bool no_metal = roughness.is_image() && metallic.Is(0) && roughness.channels[0] == 1;
    if (!is_packed && !no_metal) {
      PutSeparate("roughness", roughness);
      PutSeparate("metallic", metallic);
      return;
    }
    PutTexture("metallic_roughness_map", "roughness", roughness.image, {});
    PutNumbers(*FindParameter(*model_, "roughness"), "roughness", Rgb(roughness.numbers[0]));
    PutNumbers(*FindParameter(*model_, "metallic"), "metallic", Rgb(metallic.numbers[0]));
  }

  void PutSeparate(std::string_view name, const Value& value) {
    if (!value.is_image()) return Put(name, name, value);
    const Value otherwise = DefaultOf(FindInput(name));
    Note(name,
         fmt::format("an image of it is shown only where one image has roughness in green and "
                     "metallic in blue; it is {}",
                     NumbersText(otherwise.Color(), false)));
    Put(name, name, otherwise);
  }

  void PutAlpha() {
    const double mode = GetFixed("alpha_mode").numbers[0];
    if (mode == 0) return;  // opaque
    const Value alpha = Get("alpha");
    if (mode != 1 && mode != 2) {
      Note("alpha_mode",
           fmt::format("{} is none of 0 (opaque), 1 (mask), 2 (blend), and taken for 2",
                       NumbersText(Rgb(mode), false)));
    }
    if (mode != 1) {
      if (!alpha.Is(1)) Note("alpha_mode", "transparency is not shown: the material is opaque");
      return;
    }
    Put("opacity", "alpha", alpha);
    Put("opacity_cutoff", "alpha_cutoff", GetFixed("alpha_cutoff"));
  }

  MaterialXGraph& graph_;
  const size_t shader_;
  const std::string label_;
  MaterialXMaterial& result_;
  std::span<const ShaderInput> inputs_;
  const MaterialModel* model_ = nullptr;
  Material defaults_;
};

}  // namespace

bool IsMaterialXShader(std::string_view kind) {
  return std::ranges::find(kShaderKinds, kind, &ShaderKind::kind) != kShaderKinds.end();
}

std::string MaterialXShaderKinds() {
  std::vector<std::string_view> kinds;
  for (const ShaderKind& row : kShaderKinds) kinds.push_back(row.kind);
  return fmt::format("{}", fmt::join(kinds, ", "));
}

void MaterialXShaderToMaterial(MaterialXGraph* graph, size_t shader, const std::string& label,
                               MaterialXMaterial* result) {
  ShaderConverter(graph, shader, label, result).Convert();
}

}  // namespace nacre
