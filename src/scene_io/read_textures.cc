// SPDX-License-Identifier: Apache-2.0
// scene_io/read_textures.cc: the part "textures", and the maps of materials, which name them.
#include <array>
#include <utility>

#include "base/error.h"
#include "scene_io/readers.h"
#include "scene_io/text_file.h"
#include "scene_io/texture_image.h"

namespace nacre {
namespace {

constexpr std::array<std::string_view, 4> kEncodings = {"auto", "srgb", "linear", "alpha"};
constexpr std::array<std::string_view, 3> kTextureFilters = {"nearest", "bilinear", "trilinear"};
constexpr std::array<std::string_view, 3> kWraps = {"repeat", "clamp", "mirror"};
constexpr std::array<std::string_view, 5> kMappings = {"uv", "spherical", "cylindrical", "planar",
                                                       "cube"};
constexpr std::array<std::string_view, 2> kConventions = {"exact_flat", "literal"};
constexpr std::string_view kTextureHint = "the name of one in \"textures\"";

// Reads [u, v], or one number for both.
void ReadUv(JsonObject* object, std::string_view name, Vec2d* out) {
  const auto value = object->Find(name);
  if (!value) return;
  ReadTwoNumbers(*value, limits::kTextureScale, "[u, v] or one number", &out->x, &out->y);
}

// Reads a mapping, which is a name or an object.
void ReadMapping(const JsonValue& value, Texture* texture) {
  if (value.json.is_string()) {
    size_t choice = 0;
    if (ReadChoice(value, "mapping", kMappings, &choice)) {
      texture->mapping = static_cast<MappingKind>(choice);
    }
    return;
  }
  JsonObject object(value, R"("spherical", or {"kind": "spherical", "rotate_deg": 90})");
  object.Require("kind", "one of: uv, spherical, cylindrical, planar, cube");
  object.Choice("kind", kMappings, &texture->mapping);
  object.Point("axis", &texture->axis);
  object.Number("rotate_deg", limits::kAngleDeg, &texture->rotate_deg);
  object.Point("center", &texture->center);
  object.Number("size", limits::kLength, &texture->size);
  object.RefuseOthers();
}

// The kept image with this key, if any scene still holds it.
std::optional<SceneImage> FindKept(const std::string& key, const SceneContext& context) {
  const auto kept = context.kept->images.find(key);
  if (kept == context.kept->images.end()) return std::nullopt;
  auto texels = kept->second.texels.lock();
  if (texels == nullptr) return std::nullopt;
  SceneImage image = kept->second.image;
  image.texels = std::move(texels);
  return image;
}

// Adds the image of a file, which is read unless it was kept. `how` identifies its path and
// reading.
ImageId AddImage(const std::filesystem::path& path, const std::string& file,
                 const TextureReading& reading, const std::string& how, SceneContext* context) {
  std::vector<SceneImage>& images = context->scene->images;
  const ImageId id{static_cast<uint32_t>(images.size())};
  std::string key;
  if (context->kept != nullptr) {
    key = how + KeyOfFile(path);
    if (std::optional<SceneImage> kept = FindKept(key, *context)) {
      kept->file = file;
      images.push_back(*std::move(kept));
      return id;
    }
  }
  context->texels->AddFile(path);
  AddTextureImage(path, file, reading, context->texels, context->scene, &context->ahead);
  if (context->kept != nullptr) {
    KeptFiles::Image kept{images.back(), images.back().texels};
    kept.image.texels = nullptr;
    context->kept->images[key] = std::move(kept);
  }
  return id;
}

// How the file of a texture is read for a given use.
TextureReading ReadingOf(const TextureSource& source, MapUse use, const SceneContext& context) {
  const auto by_use = use == MapUse::kColor     ? TextureEncoding::kSrgb
                      : use == MapUse::kOpacity ? TextureEncoding::kAlpha
                                                : TextureEncoding::kLinear;
  // An encoding that is assumed by convention gives way to what the file declares; one that the
  // scene specifies does not.
  return {.encoding = source.encoding.value_or(by_use),
          .trust_encoding = source.encoding.has_value(),
          .part = source.part,
          .threads = context.threads,
          .on_warning = context.on_warning};
}

// The image of the texture in this reading, which is added on first use.
ImageId FindImage(const TextureSource& source, const TextureReading& reading,
                  SceneContext* context) {
  const auto path = ResolveReference(source.folder, source.file, context->references);
  const std::string key = reading.Key(path);
  const auto known = context->images.find(key);
  if (known != context->images.end()) return known->second;
  const ImageId id = AddImage(path, source.file, reading, key, context);
  context->images.emplace(key, id);
  return id;
}

// Adds the texture to the scene. Errors in its file are reported at the texture's place in the
// scene.
TextureId AddTexture(TextureSource* source, const TextureReading& reading, SceneContext* context,
                     FaultList* faults) {
  Texture texture = source->texture;
  try {
    texture.image = FindImage(*source, reading, context);
  } catch (const Error& error) {
    source->is_readable = false;  // report it only once
    for (const Fault& fault : error.faults()) {
      faults->Add(
          "/textures/" + PointerToken(texture.name) + "/file",
          fault.where.empty() ? fault.what : "\"" + source->file + "\" " + fault.what,
          fault.hint.empty() ? "save it again as PNG, JPEG or EXR, or name another" : fault.hint);
    }
    return {};
  }
  std::vector<Texture>& textures = context->scene->textures;
  textures.push_back(std::move(texture));
  return {static_cast<uint32_t>(textures.size() - 1)};
}

// Adds a fault if the file does not exist or may not be read. Its contents are read when a material
// uses it, in the encoding for that use.
void CheckFile(const JsonValue& value, TextureSource* source, const SceneContext& context) {
  if (!ReadText(value, &source->file)) return;
  try {
    ResolveReference(source->folder, source->file, context.references);
    source->is_readable = true;
  } catch (const Error& error) {
    for (const Fault& fault : error.faults()) value.AddFault(fault.what, fault.hint);
  }
}

// Reads a texture whose file is looked for in `folder`.
void ReadTexture(const JsonValue& value, const std::string& name,
                 const std::filesystem::path& folder, SceneContext* context) {
  TextureSource source;
  source.folder = folder;
  Texture& texture = source.texture;
  texture.name = name;
  JsonObject object(value, R"({"file": "earth.png"})");
  if (const auto file = object.Require("file", "an image in the scene's folder")) {
    CheckFile(*file, &source, *context);
  }
  object.Text("part", &source.part);
  size_t encoding = 0;
  object.Choice("encoding", kEncodings, &encoding);
  if (encoding != 0) {
    source.encoding = static_cast<TextureEncoding>(encoding - 1);
  }
  object.Choice("filter", kTextureFilters, &texture.sampling.filter);
  if (const auto mapping = object.Find("mapping")) ReadMapping(*mapping, &texture);
  // Beyond a pole, or beyond the face of a cube, there is not the opposite edge of the image.
  if (texture.mapping == MappingKind::kSpherical || texture.mapping == MappingKind::kCylindrical) {
    texture.sampling.wrap_v = Wrap::kClamp;
  } else if (texture.mapping == MappingKind::kCube) {
    texture.sampling.wrap_u = texture.sampling.wrap_v = Wrap::kClamp;
  }
  object.Choice("wrap_u", kWraps, &texture.sampling.wrap_u);
  object.Choice("wrap_v", kWraps, &texture.sampling.wrap_v);
  ReadUv(&object, "scale", &texture.scale);
  ReadUv(&object, "offset", &texture.offset);
  object.Number("rotate_deg", limits::kAngleDeg, &texture.uv_rotate_deg);
  object.RefuseOthers();
  context->read.sources.emplace(name, std::move(source));
}

// What the map with this name means, in whatever model; nullopt if there is no such map.
std::optional<MapUse> UseOfMap(std::string_view name) {
  if (name == "bump_map") return MapUse::kData;
  for (const MaterialModel& model : MaterialModels()) {
    for (const MaterialMap& map : model.maps) {
      if (map.name == name) return map.use;
    }
    for (const MaterialNormalMap& map : model.normal_maps) {
      if (map.name == name) return MapUse::kData;
    }
  }
  return std::nullopt;
}

// The name of the texture of a map, which is the JSON itself or its member "texture".
const std::string* NameOfTexture(const Json& map) {
  const auto member = map.is_object() ? map.find("texture") : map.end();
  const Json& name = map.is_object() && member != map.end() ? *member : map;
  return name.get_ptr<const std::string*>();
}

// Refuses grey images, because height maps are often mistaken for normal maps.
void RefuseGrey(const JsonValue& value, const Scene& scene, TextureId id) {
  if (!id.valid()) return;
  const SceneImage& image = scene.images[scene.textures[id.index].image.index];
  if (image.texels->channels >= 3) return;
  value.AddFault(fmt::format("\"{}\" is grey, and holds no normals", image.file),
                 "heights are for \"bump_map\"");
}

}  // namespace

void ReadTextures(const JsonValue& value, SceneContext* context) {
  const JsonObject object(value, R"(textures by name: {"earth": {"file": "earth.png"}})");
  if (!object.is_object()) return;
  for (const auto& [name, json] : value.json.items()) {
    ReadTexture({json, value.path.Member(name), value.faults}, name, context->folder, context);
  }
}

void ReadTexturesOf(const MaterialXMaterial& material, const std::filesystem::path& folder,
                    const JsonValue& value, SceneContext* context) {
  for (const auto& [name, json] : material.textures) {
    FaultList faults;
    ReadTexture({json, JsonPath{}, &faults}, name, folder, context);
    for (const Fault& fault : faults.kept()) {
      value.AddFault(fmt::format("{}: {}", name, fault.what), fault.hint);
    }
  }
}

void DecodeMapsAhead(const Json& materials, SceneContext* context) {
  if (context->read.sources.size() < 2 || !materials.is_object()) return;
  for (const Json& material : materials) {
    if (!material.is_object()) continue;
    for (const auto& [member, map] : material.items()) {
      const std::string* const name = NameOfTexture(map);
      const std::optional<MapUse> use = name != nullptr ? UseOfMap(member) : std::nullopt;
      if (!use) continue;
      const auto found = context->read.sources.find(*name);
      if (found == context->read.sources.end() || !found->second.is_readable) continue;
      const TextureReading reading = ReadingOf(found->second, *use, *context);
      try {
        const auto path =
            ResolveReference(found->second.folder, found->second.file, context->references);
        const bool is_kept = context->kept != nullptr &&
                             FindKept(reading.Key(path) + KeyOfFile(path), *context).has_value();
        if (!is_kept) context->ahead.Want(path, reading);
      } catch (const Error&) {  // NOLINT(bugprone-empty-catch): its reader will throw it again
      }
    }
  }
  context->ahead.Decode(*context->texels, context->threads);
}

void ReadTextureId(const JsonValue& value, MapUse use, SceneContext* context, TextureId* id) {
  std::string name;
  if (!value.Expect(value.json.is_string(), "a texture", kTextureHint)) return;
  ReadText(value, &name);
  const auto found = context->read.sources.find(name);
  if (found == context->read.sources.end()) {
    return FaultUnknownKey(value, "texture", name, context->read.sources);
  }
  TextureSource& source = found->second;
  if (!source.is_readable) return;  // reported already
  const TextureReading reading = ReadingOf(source, use, *context);
  TextureId& known = source.decoded[static_cast<size_t>(reading.encoding)];
  if (!known.valid()) known = AddTexture(&source, reading, context, value.faults);
  if (use == MapUse::kOpacity && known.valid()) {
    const ImageId image = context->scene->textures[known.index].image;
    if (context->scene->images[image.index].lacks_alpha) {
      value.AddFault("\"" + source.file + "\" has no alpha",
                     "\"encoding\": \"linear\" in the texture takes its first channel as opacity");
      return;
    }
  }
  *id = known;
}

void ReadMaps(const MaterialModel& model, JsonObject* object, SceneContext* context,
              Material* material) {
  for (const MaterialMap& map : model.maps) {
    const auto value = object->Find(map.name);
    if (!value) continue;
    TextureId id;
    if (!value->json.is_null()) ReadTextureId(*value, map.use, context, &id);
    map.set(*material, id);
  }
  // Reads a texture's name, or an object with the member "texture".
  const auto texture_of = [&](const JsonValue& value, TextureId* id, const auto& read_others) {
    if (!value.json.is_object()) return ReadTextureId(value, MapUse::kData, context, id);
    JsonObject map(value);
    if (const auto texture = map.Require("texture", kTextureHint)) {
      ReadTextureId(*texture, MapUse::kData, context, id);
    }
    read_others(&map);
    map.RefuseOthers();
  };
  for (const MaterialNormalMap& row : model.normal_maps) {
    const auto value = object->Find(row.name);
    if (!value) continue;
    NormalMap& normal = row.of(*material);
    if (value->json.is_null()) {
      normal = {};
      continue;
    }
    texture_of(*value, &normal.texture, [&](JsonObject* map) {
      map->Number("scale", limits::kNormalScale, &normal.scale);
      map->Choice("convention", kConventions, &normal.convention);
    });
    RefuseGrey(*value, *context->scene, normal.texture);
  }
  const auto value = object->Find("bump_map");
  if (!value) return;
  BumpMap& bump = material->bump_map;
  if (value->json.is_null()) {
    bump = {};
    return;
  }
  texture_of(*value, &bump.texture, [&](JsonObject* map) {
    map->Number("distance", limits::kCoordinate, &bump.distance);
  });
}

}  // namespace nacre
