// SPDX-License-Identifier: Apache-2.0
// scene_io/materialx_graph.h: evaluates the nodes of a MaterialX document. Constant parts are
// folded to numbers; colours are converted to linear Rec. 709 before any arithmetic, where
// MaterialX computes in the document's own space.
#pragma once

#include <cstddef>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include "scene_io/materialx_document.h"
#include "scene_io/materialx_value.h"

namespace nacre {

// The number of components of a MaterialX type; 0 for types that are no numbers.
int MaterialXSize(std::string_view type);

class MaterialXGraph {
 public:
  explicit MaterialXGraph(const MaterialXDocument& document) : document_(document) {}

  // The value of the input `name` of an element. An input that is not there, or that has neither a
  // value nor a connection, has `otherwise`. The result has the components of `otherwise`, if these
  // are numbers. Throws Error (kBadInput), with file and line, for values that are malformed or of
  // another type, connections to what does not exist, and cycles.
  MaterialXValue Input(size_t element, std::string_view name, const MaterialXValue& otherwise);

  // Whether the element has the input, with a value or a connection.
  bool HasInput(size_t element, std::string_view name) const;

  // The element that the input of this name is connected to, through node graphs and their inputs;
  // kNoElement if it is not connected.
  size_t Connected(size_t element, std::string_view name) const;

  const MaterialXDocument& document() const { return document_; }

 private:
  // Where an input or output leads to: an element and its output, or the value of a constant.
  struct Source {
    size_t node = kNoElement;
    std::string output;
    size_t constant = kNoElement;  // the input that has a value; kNoElement if nothing is given
  };
  Source SourceOf(size_t input) const;
  MaterialXValue Constant(const MaterialXElement& input) const;
  MaterialXValue Node(size_t node, const std::string& output);
  MaterialXValue Evaluate(size_t node, const std::string& output);
  MaterialXValue Arithmetic(size_t node, bool* is_arithmetic);
  MaterialXValue Image(size_t node);
  MaterialXValue ColorImage(size_t node, const std::string& output);
  MaterialXValue NormalMap(size_t node);
  MaterialXValue Separate(size_t node, const std::string& output);
  MaterialXValue Place(size_t node);
  MaterialXValue Placed(size_t node, const MaterialXValue& pivot, const MaterialXValue& scale,
                        double degrees, const MaterialXValue& offset, bool scales_first);
  MaterialXValue Number(size_t node, std::string_view name, double otherwise) {
    return Input(node, name, MaterialXNumber(otherwise));
  }
  // An input that must be numbers; nullopt, and the reason in *unknown, if it varies.
  bool Fixed(size_t node, std::string_view name, const MaterialXValue& otherwise,
             MaterialXValue* value, MaterialXValue* unknown);
  std::string Describe(size_t node) const;

  const MaterialXDocument& document_;
  std::map<std::pair<size_t, std::string>, MaterialXValue> known_;
  std::set<std::pair<size_t, std::string>> open_;  // what is being evaluated
};

}  // namespace nacre
