// SPDX-License-Identifier: Apache-2.0
#include "scene_io/materialx.h"

#include <algorithm>
#include <array>
#include <optional>
#include <set>
#include <span>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/error.h"
#include "base/excerpt.h"
#include "base/numbers.h"
#include "base/path.h"
#include "scene_io/materialx_document.h"
#include "scene_io/materialx_graph.h"
#include "scene_io/materialx_shaders.h"

namespace nacre {
namespace {

constexpr std::string_view kExtension = ".mtlx";

// Elements at the root that may change what materials look like, and are not read.
constexpr std::array<std::string_view, 7> kUnreadElements = {
    "nodedef",     "implementation", "typedef",  "variantset",
    "propertyset", "unittypedef",    "targetdef"};

bool IsOneOf(std::string_view word, std::span<const std::string_view> words) {
  return std::ranges::find(words, word) != words.end();
}

// The documents of version 1.37 and before have no nodes for materials.
void CheckMaterialXVersion(const MaterialXDocument& document) {
  const MaterialXElement& root = document.root();
  const std::string& text = root.Attribute("version");
  const std::optional<double> version = ParseNumber(text);
  if (version && *version >= 1.38 && *version < 2) return;
  const std::string shown = text.empty() ? "has no version" : "is version " + Excerpt(text, 20);
  throw Error(ExitCode::kBadInput, document.PlaceOf(root), fmt::format("the document {}", shown),
              "1.38 and 1.39 are read");
}

// What the document offers as materials, by name, in its order.
std::vector<std::pair<std::string, size_t>> MaterialsOf(const MaterialXDocument& document) {
  std::vector<std::pair<std::string, size_t>> materials;
  for (const std::string_view kind : {"surfacematerial", "shader"}) {
    if (!materials.empty()) break;  // shaders without a material are named themselves
    for (const size_t child : document.root().children) {
      const MaterialXElement& element = document.elements[child];
      const bool is_wanted =
          kind == "shader" ? IsMaterialXShader(element.kind) : element.kind == kind;
      if (is_wanted) materials.emplace_back(element.name(), child);
    }
  }
  return materials;
}

// The names of the materials that looks assign to the geometry, or assignment, of this name.
std::set<std::string> AssignedTo(const std::string& name, const MaterialXDocument& document) {
  std::set<std::string> assigned;
  for (const size_t child : document.root().children) {
    const MaterialXElement& look = document.elements[child];
    if (look.kind != "look") continue;
    for (const size_t assignment : look.children) {
      const MaterialXElement& element = document.elements[assignment];
      if (element.kind != "materialassign") continue;
      if (element.name() != name && element.Attribute("geom") != name) continue;
      assigned.emplace(WithoutNamespace(element.Attribute("material")));
    }
  }
  return assigned;
}

size_t FindMaterial(const std::string& name, const MaterialXDocument& document) {
  const auto materials = MaterialsOf(document);
  const std::string file = document.PathOf(0);
  if (materials.empty()) {
    throw Error(
        ExitCode::kBadInput, file, "has no material",
        fmt::format("a <surfacematerial> with one of these shaders: {}", MaterialXShaderKinds()));
  }
  constexpr size_t kMostNames = 40;
  std::vector<std::string> names;
  for (const auto& [own, element] : materials) {
    if (names.size() < kMostNames) names.push_back(Excerpt(own));
  }
  const std::string all = fmt::format("it has {}{}", fmt::join(names, ", "),
                                      materials.size() > kMostNames ? ", ..." : "");
  if (name.empty()) {
    if (materials.size() == 1) return materials.front().second;
    throw Error(ExitCode::kBadInput, file,
                fmt::format("has {} materials, of which none is named", materials.size()),
                fmt::format("name one, as in {}#{}: {}", file, names.front(), all));
  }
  const auto find = [&](std::string_view wanted) {
    const auto found = std::ranges::find_if(materials, [&](const auto& material) {
      return WithoutNamespace(material.first) == WithoutNamespace(wanted);
    });
    return found != materials.end() ? found->second : kNoElement;
  };
  if (const size_t found = find(name); found != kNoElement) return found;
  const std::set<std::string> assigned = AssignedTo(name, document);
  if (assigned.size() > 1) {
    throw Error(ExitCode::kBadInput, file,
                fmt::format("assigns {} to \"{}\"", fmt::join(assigned, " and "), Excerpt(name)),
                "name the material");
  }
  if (assigned.size() == 1) {
    if (const size_t found = find(*assigned.begin()); found != kNoElement) return found;
    throw Error(ExitCode::kBadInput, file,
                fmt::format("assigns \"{}\" to \"{}\", and has no such material",
                            Excerpt(*assigned.begin()), Excerpt(name)),
                all);
  }
  throw Error(ExitCode::kBadInput, file, fmt::format("has no material \"{}\"", Excerpt(name)),
              NearestHint(name, names, all));
}

// The shader node of a material, which may be such a node itself.
size_t ShaderOf(size_t material, const MaterialXGraph& graph, std::vector<std::string>* notes) {
  const MaterialXDocument& document = graph.document();
  const MaterialXElement& element = document.elements[material];
  if (IsMaterialXShader(element.kind)) return material;
  const size_t shader = graph.Connected(material, "surfaceshader");
  if (shader == kNoElement) {
    document.Refuse(element, "has no surface shader",
                    "its input \"surfaceshader\" names the node of one");
  }
  const std::string& kind = document.elements[shader].kind;
  if (!IsMaterialXShader(kind)) {
    document.Refuse(document.elements[shader], "is a shader that is not read",
                    fmt::format("these are: {}", MaterialXShaderKinds()));
  }
  for (const char* const other : {"displacementshader", "backsurfaceshader", "volumeshader"}) {
    if (!graph.HasInput(material, other)) continue;
    notes->push_back(fmt::format("{}: {}: the {} is left out", document.PlaceOf(element),
                                 Excerpt(element.name()), other));
  }
  return shader;
}

void TellUnread(const MaterialXDocument& document, std::vector<std::string>* notes) {
  std::set<std::string> kinds;
  for (const size_t child : document.root().children) {
    const std::string& kind = document.elements[child].kind;
    if (IsOneOf(kind, kUnreadElements)) kinds.insert("<" + kind + ">");
  }
  if (kinds.empty()) return;
  notes->push_back(fmt::format(
      "{}: {} not read", document.PathOf(0),
      kinds.size() == 1 ? *kinds.begin() + " is" : fmt::format("{} are", fmt::join(kinds, ", "))));
}

}  // namespace

bool IsMaterialXFile(const std::string& file) { return HasExtension(file, kExtension); }

MaterialXMaterial ReadMaterialX(const std::filesystem::path& folder, const std::string& file,
                                const std::string& name, const ReferenceRules& rules) {
  MaterialXDocument document = ReadMaterialXDocument(folder, file, rules);
  CheckMaterialXVersion(document);
  const size_t material = FindMaterial(name, document);
  MaterialXMaterial result;
  result.name = document.elements[material].name();
  result.notes = std::move(document.notes);
  MaterialXGraph graph(document);
  const size_t shader = ShaderOf(material, graph, &result.notes);
  MaterialXShaderToMaterial(&graph, shader, fmt::format("{}#{}", file, result.name), &result);
  TellUnread(document, &result.notes);
  return result;
}

namespace {

// Where the name of the document ends, at the end of the text or at the '#' before the material's
// name, which may have any characters; nothing if the text names no document.
std::optional<size_t> EndOfDocumentName(const std::string& text) {
  for (size_t hash = text.find('#'); hash != std::string::npos; hash = text.find('#', hash + 1)) {
    if (IsMaterialXFile(text.substr(0, hash))) return hash;
  }
  if (IsMaterialXFile(text)) return text.size();
  return std::nullopt;
}

}  // namespace

bool IsMaterialXReference(const std::string& text) {
  const size_t first = text.find_first_not_of(" \t\r\n");
  const bool is_json = first != std::string::npos && (text[first] == '{' || text[first] == '[');
  return !is_json && EndOfDocumentName(text).has_value();
}

Json MaterialXReference(const std::string& text) {
  const size_t end = EndOfDocumentName(text).value();
  const std::filesystem::path path = text.substr(0, end);
  const std::string name = end == text.size() ? "" : text.substr(end + 1);
  const MaterialXMaterial material =
      ReadMaterialX(path.parent_path(), path.filename().string(), name, {});
  return {{"name", material.name},
          {"model", material.material.at("model")},
          {"file", path.string()},
          {"material", material.name}};
}

std::vector<std::filesystem::path> MaterialXFilesIn(const Json& json) {
  std::vector<std::filesystem::path> files;
  for (const Json& member : json) {
    if (member.is_structured()) {
      for (auto& file : MaterialXFilesIn(member)) files.push_back(std::move(file));
    }
  }
  const auto file = json.is_object() ? json.find("file") : json.end();
  if (file != json.end() && file->is_string() && IsMaterialXFile(file->get<std::string>())) {
    files.emplace_back(file->get<std::string>());
  }
  return files;
}

}  // namespace nacre
