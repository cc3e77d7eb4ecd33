// SPDX-License-Identifier: Apache-2.0
#include "scene_io/materialx_document.h"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <set>

#include <fmt/format.h>
#include <pugixml.hpp>

#include "base/error.h"
#include "base/excerpt.h"
#include "scene_io/text_lines.h"

namespace nacre {
namespace {

// Bounds for documents of strangers, each far above MaterialX's own libraries. Tags and attributes
// are counted before the parser makes nodes of them, which are larger than their text.
constexpr uint64_t kMaxDocumentBytes = uint64_t{8} << 20;
constexpr ptrdiff_t kMaxXmlTags = 400'000, kMaxXmlAttributes = 1'000'000;
constexpr size_t kMaxXmlElements = 200'000;
constexpr size_t kMaxDocuments = 64;
constexpr size_t kMaxElementDepth = 32;

size_t LineAt(std::string_view text, size_t offset) {
  const auto end = text.begin() + static_cast<ptrdiff_t>(std::min(offset, text.size()));
  return static_cast<size_t>(std::count(text.begin(), end, '\n')) + 1;
}

// Turns offsets into lines.
class LineTable {
 public:
  explicit LineTable(std::string_view text) {
    for (size_t at = text.find('\n'); at != std::string_view::npos; at = text.find('\n', at + 1)) {
      ends_.push_back(at);
    }
  }
  size_t LineOf(ptrdiff_t offset) const {
    const auto at = static_cast<size_t>(std::max<ptrdiff_t>(offset, 0));
    const auto after = std::lower_bound(ends_.begin(), ends_.end(), at);
    return static_cast<size_t>(after - ends_.begin()) + 1;
  }

 private:
  std::vector<size_t> ends_;
};

bool IsInclude(std::string_view kind) { return kind == "xi:include" || kind == "include"; }

class DocumentReader {
 public:
  DocumentReader(const ReferenceRules& rules, MaterialXDocument* document)
      : rules_(rules), document_(*document) {}

  // Adds the elements of a file. `place`: of the element that includes it; empty for the main one.
  void Read(const std::string& file, const std::string& place) {
    std::filesystem::path path;
    try {
      path = ResolveReference(document_.folder, file, rules_);
    } catch (const Error& error) {
      if (place.empty()) throw;
      const Fault& fault = error.faults().front();
      throw Error(ExitCode::kBadInput, place, fault.what, fault.hint);
    }
    const auto same = std::find(open_.begin(), open_.end(), path);
    if (same != open_.end()) {
      throw Error(ExitCode::kBadInput, place, fmt::format("\"{}\" includes itself", Excerpt(file)),
                  "remove one of the includes");
    }
    if (!known_.insert(path).second) return;  // two documents may include a third
    if (known_.size() > kMaxDocuments) {
      throw Error(ExitCode::kBadInput, place,
                  fmt::format("includes more than {} documents", kMaxDocuments));
    }
    open_.push_back(path);
    Parse(file, ReadTextFile(path, kMaxDocumentBytes));
    open_.pop_back();
  }

 private:
  // Refuses references to what is no character (XML 1.0, 4.1), of which pugixml makes other bytes.
  static void CheckCharacters(std::string_view text, const std::string& shown) {
    constexpr std::string_view kBegin = "&#";
    for (size_t at = text.find(kBegin); at != text.npos; at = text.find(kBegin, at + 1)) {
      const bool is_hex = text.substr(at + kBegin.size()).starts_with('x');
      const char* const first = text.data() + at + kBegin.size() + (is_hex ? 1 : 0);
      uint32_t code = 0;
      const auto [end, error] =
          std::from_chars(first, text.data() + text.size(), code, is_hex ? 16 : 10);
      if (error == std::errc::invalid_argument) continue;  // not a reference
      const bool is_control = code < 0x20 && code != '\t' && code != '\n' && code != '\r';
      const bool is_surrogate = code >= 0xd800 && code < 0xe000;
      if (error == std::errc() && code <= 0x10ffff && !is_control && !is_surrogate) continue;
      throw Error(ExitCode::kBadInput, fmt::format("{}:{}", shown, LineAt(text, at)),
                  fmt::format("\"{}\" is not a character",
                              Excerpt(text.substr(at, static_cast<size_t>(end - first) + 4))),
                  "write the character itself");
    }
  }

  void Parse(const std::string& file, const std::string& bytes) {
    const size_t index = document_.files.size();
    document_.files.push_back(file);
    file_ = index;
    const std::string shown = document_.PathOf(index);
    const std::string_view text = WithoutByteOrderMark(bytes, shown);
    if (std::count(text.begin(), text.end(), '<') > kMaxXmlTags ||
        std::count(text.begin(), text.end(), '=') > kMaxXmlAttributes) {
      throw Error(
          ExitCode::kBadInput, shown, "has more elements than any material",
          fmt::format("up to {} tags and {} attributes are read", kMaxXmlTags, kMaxXmlAttributes));
    }
    CheckCharacters(text, shown);
    pugi::xml_document xml;
    const pugi::xml_parse_result result = xml.load_buffer(
        text.data(), text.size(), pugi::parse_default | pugi::parse_doctype, pugi::encoding_utf8);
    if (!result) {
      const auto offset = static_cast<size_t>(std::max<ptrdiff_t>(result.offset, 0));
      throw Error(ExitCode::kBadInput, fmt::format("{}:{}", shown, LineAt(text, offset)),
                  fmt::format("is not XML: {}", result.description()),
                  "a document begins <materialx version=\"1.39\">");
    }
    const LineTable lines(text);
    for (const pugi::xml_node node : xml.children()) {
      if (node.type() != pugi::node_doctype) continue;
      throw Error(ExitCode::kBadInput,
                  fmt::format("{}:{}", shown, lines.LineOf(node.offset_debug())),
                  "has a document type, which MaterialX has not", "remove <!DOCTYPE ...>");
    }
    const pugi::xml_node root = xml.document_element();
    if (std::string_view(root.name()) != "materialx") {
      throw Error(ExitCode::kBadInput, shown,
                  fmt::format("is not MaterialX: its root is <{}>", Excerpt(root.name())),
                  "a document begins <materialx version=\"1.39\">");
    }
    if (index == 0) {
      Add(root, kNoElement, nullptr, lines, 0);
      return;
    }
    // The root of an included document is only what its elements inherit from.
    MaterialXElement own;
    Fill(root, nullptr, lines, &own);
    for (const pugi::xml_node child : root.children()) Add(child, 0, &own, lines, 1);
  }

  // Sets all but parent and children.
  void Fill(const pugi::xml_node& node, const MaterialXElement* heir_of, const LineTable& lines,
            MaterialXElement* element) const {
    element->kind = WithoutNamespaceOfInclude(node.name());
    element->file = file_;
    element->line = lines.LineOf(node.offset_debug());
    for (const pugi::xml_attribute attribute : node.attributes()) {
      element->attributes.emplace_back(attribute.name(), attribute.value());
    }
    if (heir_of != nullptr) {
      element->colorspace = heir_of->colorspace;
      element->fileprefix = heir_of->fileprefix;
    }
    const std::string& colorspace = element->Attribute("colorspace");
    const std::string& fileprefix = element->Attribute("fileprefix");
    if (!colorspace.empty()) element->colorspace = colorspace;
    if (!fileprefix.empty()) element->fileprefix = fileprefix;
  }

  static std::string WithoutNamespaceOfInclude(std::string_view kind) {
    return std::string(IsInclude(kind) ? "include" : kind);
  }

  // `heir_of` is whose colour space and prefix the element inherits; null for a main root.
  void Add(const pugi::xml_node& node, size_t parent, const MaterialXElement* heir_of,
           const LineTable& lines, size_t depth) {
    if (node.type() != pugi::node_element) return;
    MaterialXElement element;
    element.parent = parent;
    Fill(node, heir_of, lines, &element);
    if (depth > kMaxElementDepth) {
      document_.Refuse(element, fmt::format("is nested deeper than {} levels", kMaxElementDepth));
    }
    if (element.kind == "include") return Include(element, parent);
    const size_t index = document_.elements.size();
    if (index >= kMaxXmlElements) {
      document_.Refuse(element, fmt::format("is one of more than {} elements", kMaxXmlElements));
    }
    document_.elements.push_back(element);
    if (parent != kNoElement) AddToParent(element, index);
    for (const pugi::xml_node child : node.children()) {
      Add(child, index, &element, lines, depth + 1);
    }
  }

  void AddToParent(const MaterialXElement& element, size_t index) {
    document_.elements[element.parent].children.push_back(index);
    if (element.name().empty()) return;
    const std::string name(WithoutNamespace(element.name()));
    const bool is_new = document_.by_name.try_emplace({element.parent, name}, index).second;
    if (is_new || has_told_twins_) return;
    has_told_twins_ = true;
    document_.notes.push_back(fmt::format(
        "{}: there is a <{}> \"{}\" before: of several elements of a name the first is read",
        document_.PlaceOf(element), Excerpt(element.kind), Excerpt(name)));
  }

  void Include(const MaterialXElement& element, size_t parent) {
    if (parent != 0) document_.Refuse(element, "includes a document below the root");
    const std::string& href = element.Attribute("href");
    if (href.empty()) {
      document_.Refuse(element, "includes no document: it has no \"href\"");
    }
    const std::string from = document_.files[element.file];
    const std::filesystem::path folder = std::filesystem::path(from).parent_path();
    const size_t file = file_;
    Read((folder / href).string(), document_.PlaceOf(element));
    file_ = file;
  }

  const ReferenceRules& rules_;
  MaterialXDocument& document_;
  bool has_told_twins_ = false;
  size_t file_ = 0;                          // index of the one that is being read
  std::vector<std::filesystem::path> open_;  // those that include one another now
  std::set<std::filesystem::path> known_;
};

}  // namespace

std::string_view WithoutNamespace(std::string_view name) {
  const size_t colon = name.rfind(':');
  return colon == std::string_view::npos ? name : name.substr(colon + 1);
}

const std::string& MaterialXElement::Attribute(std::string_view attribute) const {
  static const std::string none;
  const auto found = std::find_if(attributes.begin(), attributes.end(),
                                  [&](const auto& pair) { return pair.first == attribute; });
  return found != attributes.end() ? found->second : none;
}

size_t MaterialXDocument::FindChild(size_t parent, std::string_view name) const {
  const auto found = by_name.find({parent, std::string(WithoutNamespace(name))});
  return found != by_name.end() ? found->second : kNoElement;
}

std::string MaterialXDocument::PathOf(size_t file) const {
  return (folder / files[file]).lexically_normal().string();
}

std::string MaterialXDocument::PlaceOf(const MaterialXElement& element) const {
  return fmt::format("{}:{}", PathOf(element.file), element.line);
}

void MaterialXDocument::Refuse(const MaterialXElement& element, std::string what,
                               std::string hint) const {
  const std::string& name = element.name();
  const std::string shown = name.empty()
                                ? fmt::format("<{}>", Excerpt(element.kind))
                                : fmt::format("<{}> \"{}\"", Excerpt(element.kind), Excerpt(name));
  throw Error(ExitCode::kBadInput, PlaceOf(element), fmt::format("{} {}", shown, what),
              std::move(hint));
}

MaterialXDocument ReadMaterialXDocument(const std::filesystem::path& folder,
                                        const std::string& file, const ReferenceRules& rules) {
  MaterialXDocument document;
  document.folder = folder;
  DocumentReader(rules, &document).Read(file, "");
  return document;
}

}  // namespace nacre
