// SPDX-License-Identifier: Apache-2.0
// scene_io/materialx_document.h: the elements of a MaterialX document and of those that it
// includes, with what they inherit. What the elements mean is materialx_graph.h's.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "scene_io/text_file.h"

namespace nacre {

inline constexpr size_t kNoElement = static_cast<size_t>(-1);

struct MaterialXElement {
  std::string kind;  // "nodegraph", "image", "input"
  std::vector<std::pair<std::string, std::string>> attributes;
  size_t parent = kNoElement;  // index in MaterialXDocument::elements
  std::vector<size_t> children;
  size_t file = 0;  // index in MaterialXDocument::files
  size_t line = 0;  // counted from 1
  // Those in force: the element's own, or the nearest ancestor's.
  std::string colorspace, fileprefix;

  // Empty if there is no such attribute.
  const std::string& Attribute(std::string_view attribute) const;
  const std::string& name() const { return Attribute("name"); }
  const std::string& type() const { return Attribute("type"); }
};

struct MaterialXDocument {
  // The main document, whose root is element 0, and those that it includes, relative to `folder`.
  // Elements of included documents are children of that root, but inherit from the root of their
  // own.
  std::vector<std::string> files;
  std::vector<MaterialXElement> elements;
  std::filesystem::path folder;
  std::vector<std::string> notes;  // what was not read
  // The first child of each parent and name. Names with a namespace ("lib:gold") stand without it.
  std::map<std::pair<size_t, std::string>, size_t> by_name;

  const MaterialXElement& root() const { return elements.front(); }
  // The child of this name of element `parent`; kNoElement if there is none.
  size_t FindChild(size_t parent, std::string_view name) const;
  // The path of a file, and of an element with its line, for people.
  std::string PathOf(size_t file) const;
  std::string PlaceOf(const MaterialXElement& element) const;
  [[noreturn]] void Refuse(const MaterialXElement& element, std::string what,
                           std::string hint = {}) const;
};

// Reads the document `file` and what it includes. All files are resolved in `folder` by the rules.
// Throws Error (kBadInput), with the line, for text that is not XML, has a document type, or is
// deeper or larger than any material; for files that are missing or may not be read; and for
// documents that include themselves.
MaterialXDocument ReadMaterialXDocument(const std::filesystem::path& folder,
                                        const std::string& file, const ReferenceRules& rules);

// The name without its namespace.
std::string_view WithoutNamespace(std::string_view name);

}  // namespace nacre
