// SPDX-License-Identifier: Apache-2.0
#include "scene_io/materialx_graph.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <optional>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/error.h"
#include "base/excerpt.h"
#include "base/numbers.h"
#include "scene_io/materialx_color.h"
#include "scene_io/text_lines.h"

namespace nacre {
namespace {

using Value = MaterialXValue;
using ValueKind = MaterialXValue::Kind;

// Graphs that people make are some ten nodes deep. The bound keeps the recursion off the end of the
// stack.
constexpr size_t kMaxGraphDepth = 400;

Value NumbersOf(std::initializer_list<double> numbers) {
  Value value{.kind = ValueKind::kNumbers, .size = static_cast<int>(numbers.size())};
  std::copy(numbers.begin(), numbers.end(), value.numbers.begin());
  return value;
}

Value Repeated(double number, int size) { return Resized(MaterialXNumber(number), size); }

bool IsColorType(std::string_view type) { return type == "color3" || type == "color4"; }

Value WithText(std::string text) { return {.kind = ValueKind::kText, .text = std::move(text)}; }

struct BinaryNode {
  std::string_view kind;
  Value (*function)(const Value&, const Value&);
  double second;  // the default of in2
};
constexpr std::array kBinaryNodes = {
    BinaryNode{"multiply", Multiply, 1}, BinaryNode{"divide", Divide, 1},
    BinaryNode{"add", Add, 0},           BinaryNode{"subtract", Subtract, 0},
    BinaryNode{"max", Maximum, 0},       BinaryNode{"min", Minimum, 0}};

// Functions of one number. MaterialX's angles are radians.
struct UnaryNode {
  std::string_view kind;
  double (*function)(double, double);
};
constexpr std::array kUnaryNodes = {
    UnaryNode{"absval", [](double x, double) { return std::abs(x); }},
    UnaryNode{"floor", [](double x, double) { return std::floor(x); }},
    UnaryNode{"ceil", [](double x, double) { return std::ceil(x); }},
    UnaryNode{"round", [](double x, double) { return std::round(x); }},
    UnaryNode{"sqrt", [](double x, double) { return std::sqrt(x); }},
    UnaryNode{"exp", [](double x, double) { return std::exp(x); }},
    UnaryNode{"ln", [](double x, double) { return std::log(x); }},
    UnaryNode{"sin", [](double x, double) { return std::sin(x); }},
    UnaryNode{"cos", [](double x, double) { return std::cos(x); }}};

}  // namespace

int MaterialXSize(std::string_view type) {
  if (type == "float" || type == "integer" || type == "boolean") return 1;
  if (type == "vector2") return 2;
  if (type == "color3" || type == "vector3") return 3;
  if (type == "color4" || type == "vector4") return 4;
  return 0;
}

std::string MaterialXGraph::Describe(size_t node) const {
  const MaterialXElement& element = document_.elements[node];
  return fmt::format("<{}> \"{}\" (line {})", Excerpt(element.kind, 40),
                     Excerpt(element.name(), 40), element.line);
}

bool MaterialXGraph::HasInput(size_t element, std::string_view name) const {
  const size_t input = document_.FindChild(element, name);
  if (input == kNoElement) return false;
  const Source source = SourceOf(input);
  return source.node != kNoElement || source.constant != kNoElement;
}

size_t MaterialXGraph::Connected(size_t element, std::string_view name) const {
  const size_t input = document_.FindChild(element, name);
  return input == kNoElement ? kNoElement : SourceOf(input).node;
}

MaterialXGraph::Source MaterialXGraph::SourceOf(size_t input) const {
  for (size_t steps = 0; steps <= kMaxGraphDepth; ++steps) {
    const MaterialXElement& element = document_.elements[input];
    const std::string& interface = element.Attribute("interfacename");
    // An input belongs to a node, which lies beside what it is connected to; an output lies there
    // itself.
    const size_t owner = element.kind == "output" ? input : element.parent;
    const size_t scope = document_.elements[owner].parent;
    if (!interface.empty()) {
      const size_t found = scope == kNoElement ? kNoElement : document_.FindChild(scope, interface);
      if (found == kNoElement || document_.elements[found].kind != "input") {
        document_.Refuse(element,
                         fmt::format("is connected to the input \"{}\" of its graph, which "
                                     "has none of this name",
                                     Excerpt(interface)));
      }
      input = found;
      continue;
    }
    const bool to_graph = !element.Attribute("nodegraph").empty();
    const std::string& target =
        to_graph ? element.Attribute("nodegraph") : element.Attribute("nodename");
    const std::string& output = element.Attribute("output");
    if (target.empty()) {
      const bool has_value = std::any_of(element.attributes.begin(), element.attributes.end(),
                                         [](const auto& pair) { return pair.first == "value"; });
      return {kNoElement, {}, has_value ? input : kNoElement};
    }
    const size_t node = scope == kNoElement ? kNoElement : document_.FindChild(scope, target);
    if (node == kNoElement) {
      std::vector<std::string> names;
      if (scope != kNoElement) {
        for (const size_t child : document_.elements[scope].children) {
          if (names.size() < 1000) names.push_back(document_.elements[child].name());
        }
      }
      document_.Refuse(element,
                       fmt::format("is connected to \"{}\", which does not exist", Excerpt(target)),
                       NearestHint(target, names, "nodes are looked for beside the element's own"));
    }
    if (document_.elements[node].kind != "nodegraph") return {node, output, kNoElement};
    size_t found = kNoElement;
    if (!output.empty()) {
      found = document_.FindChild(node, output);
    } else {
      for (const size_t child : document_.elements[node].children) {
        if (document_.elements[child].kind == "output" && found == kNoElement) found = child;
      }
    }
    if (found == kNoElement || document_.elements[found].kind != "output") {
      document_.Refuse(element, fmt::format("is connected to an output \"{}\" that \"{}\" has not",
                                            Excerpt(output), Excerpt(target)));
    }
    input = found;
  }
  document_.Refuse(document_.elements[input], "leads back to itself");
}

MaterialXValue MaterialXGraph::Constant(const MaterialXElement& input) const {
  const std::string& type = input.type();
  const std::string& text = input.Attribute("value");
  if (type == "string") return WithText(text);
  if (type == "filename") return WithText(input.fileprefix + text);
  const int size = MaterialXSize(type);
  if (size == 0) {
    return MaterialXUnknown(
        fmt::format("a value of the type \"{}\" (line {})", Excerpt(type, 40), input.line));
  }
  // Angles are degrees, and all other numbers have no unit that matters here.
  const std::string& unit = input.Attribute("unit");
  if (!unit.empty() && unit != "degree") {
    return MaterialXUnknown(
        fmt::format("a number in the unit \"{}\" (line {})", Excerpt(unit, 40), input.line));
  }
  if (type == "boolean") {
    if (text == "true" || text == "false") return MaterialXNumber(text == "true" ? 1 : 0);
    document_.Refuse(input, fmt::format("is \"{}\"", Excerpt(text)), "true or false");
  }
  std::string words = text;
  std::ranges::replace_if(
      words, [](char c) { return c == ',' || c == '\n' || c == '\r'; }, ' ');
  const std::optional<std::vector<double>> numbers = ParseNumbers(words);
  if (!numbers || numbers->size() != static_cast<size_t>(size)) {
    document_.Refuse(
        input, fmt::format("is \"{}\"", Excerpt(text)),
        size == 1
            ? fmt::format("a {} is one finite number", type)
            : fmt::format("a {} is {} finite numbers, as in \"{}\"", type, size,
                          fmt::join(std::vector<double>(static_cast<size_t>(size), 0.5), ", ")));
  }
  Value value{.kind = ValueKind::kNumbers, .size = size};
  std::copy(numbers->begin(), numbers->end(), value.numbers.begin());
  if (!IsColorType(type)) return value;
  const MaterialXColorSpace* const space = FindMaterialXColorSpace(input.colorspace);
  if (space == nullptr) {
    document_.Refuse(
        input,
        fmt::format("is in the colour space \"{}\", which is not known", Excerpt(input.colorspace)),
        NearestHint(input.colorspace, MaterialXColorSpaceNames(),
                    fmt::format("one of: {}", fmt::join(MaterialXColorSpaceNames(), ", "))));
  }
  const Rgb color = ToRec709(*space, value.Color());
  for (int c = 0; c < 3; ++c) value.numbers[static_cast<size_t>(c)] = color[c];
  if (!(std::isfinite(color.x) && std::isfinite(color.y) && std::isfinite(color.z))) {
    document_.Refuse(input,
                     fmt::format("is \"{}\", which is too large for a colour", Excerpt(text)));
  }
  return value;
}

MaterialXValue MaterialXGraph::Input(size_t element, std::string_view name,
                                     const MaterialXValue& otherwise) {
  const size_t input = document_.FindChild(element, name);
  if (input == kNoElement) return otherwise;
  const MaterialXElement& own = document_.elements[input];
  const std::string& type = own.type();
  const auto fits = [&](int size) { return size == 0 || size == MaterialXSize(type); };
  const auto fits_text = [&] { return type == "string" || type == "filename"; };
  // Nodes that take a number for each component or one for all do so by their caller's Resized.
  const bool is_right = otherwise.kind == ValueKind::kText ? fits_text()
                        : otherwise.is_numbers() ? fits(otherwise.size) || MaterialXSize(type) == 1
                                                 : true;
  if (!is_right) {
    const std::string expected =
        otherwise.kind == ValueKind::kText
            ? "a text"
            : fmt::format("{} number{}", otherwise.size, otherwise.size == 1 ? "" : "s");
    document_.Refuse(own, fmt::format("is of the type \"{}\"", Excerpt(type, 40)),
                     "it takes " + expected);
  }
  if (!own.Attribute("channels").empty()) {
    return MaterialXUnknown(fmt::format(
        "the attribute \"channels\" (line {}), which MaterialX 1.39 has not", own.line));
  }
  const Source source = SourceOf(input);
  Value value = otherwise;
  if (source.constant != kNoElement) {
    const MaterialXElement& constant = document_.elements[source.constant];
    value = Constant(constant);
    if (constant.type() != type && MaterialXSize(constant.type()) != MaterialXSize(type)) {
      document_.Refuse(own, fmt::format("is of the type \"{}\", and its value is of \"{}\"",
                                        Excerpt(type, 40), Excerpt(constant.type(), 40)));
    }
  } else if (source.node != kNoElement) {
    value = Node(source.node, source.output);
    const int size = MaterialXSize(type);
    const bool has_components = value.is_numbers() || value.is_image();
    if (has_components && size != 0 && value.size != size) {
      document_.Refuse(own,
                       fmt::format("is of the type \"{}\", and what it is connected to has {} "
                                   "component{}",
                                   Excerpt(type, 40), value.size, value.size == 1 ? "" : "s"),
                       "a node <convert> changes types");
    }
  }
  return otherwise.is_numbers() ? Resized(value, otherwise.size) : value;
}

MaterialXValue MaterialXGraph::Node(size_t node, const std::string& output) {
  const auto key = std::make_pair(node, output);
  const auto known = known_.find(key);
  if (known != known_.end()) return known->second;
  const MaterialXElement& element = document_.elements[node];
  if (!open_.insert(key).second) document_.Refuse(element, "is connected to itself in a cycle");
  if (open_.size() > kMaxGraphDepth) {
    document_.Refuse(element, fmt::format("is in a graph of more than {} levels", kMaxGraphDepth));
  }
  Value value = Evaluate(node, output);
  open_.erase(key);
  // The reason says where it is, the first time that it goes through a node.
  if (value.is_unknown() && !value.text.ends_with(')')) value.text += " at " + Describe(node);
  known_.emplace(key, value);
  return value;
}

bool MaterialXGraph::Fixed(size_t node, std::string_view name, const MaterialXValue& otherwise,
                           MaterialXValue* value, MaterialXValue* unknown) {
  *value = Input(node, name, otherwise);
  if (value->kind == otherwise.kind) return true;
  *unknown =
      value->is_unknown() ? *value : MaterialXUnknown(fmt::format("\"{}\", which varies,", name));
  return false;
}

MaterialXValue MaterialXGraph::Evaluate(size_t node, const std::string& output) {
  const MaterialXElement& element = document_.elements[node];
  const std::string& kind = element.kind;
  const int size = MaterialXSize(element.type());
  bool is_arithmetic = false;
  Value value = Arithmetic(node, &is_arithmetic);
  if (is_arithmetic) return value;
  if (kind == "constant") return Input(node, "value", Repeated(0, size));
  if (kind == "dot") return Input(node, "in", Repeated(0, size));
  if (kind == "image" || kind == "tiledimage" || kind == "gltf_image") return Image(node);
  if (kind == "gltf_colorimage") return ColorImage(node, output);
  if (kind == "normalmap" || kind == "gltf_normalmap") return NormalMap(node);
  if (kind == "convert") return Resized(Input(node, "in", {}), size);
  if (kind == "extract") {
    Value index, unknown;
    if (!Fixed(node, "index", MaterialXNumber(0), &index, &unknown)) return unknown;
    const double at = index.numbers[0];
    return Component(Input(node, "in", {}), at >= 0 && at < 4 ? static_cast<int>(at) : -1);
  }
  if (kind == "separate2" || kind == "separate3" || kind == "separate4") {
    return Separate(node, output);
  }
  if (kind == "combine2" || kind == "combine3" || kind == "combine4") {
    std::array<Value, 4> parts;
    const auto count = static_cast<size_t>(kind.back() - '0');
    // combine2 also joins a colour and its alpha.
    for (size_t i = 0; i < count; ++i) {
      const std::string name = fmt::format("in{}", i + 1);
      const size_t input = document_.FindChild(node, name);
      const int own =
          input == kNoElement ? 1 : std::max(1, MaterialXSize(document_.elements[input].type()));
      parts[i] = Input(node, name, Repeated(0, own));
    }
    return Joined(parts, count);
  }
  if (kind == "texcoord" || kind == "geompropvalue") {
    Value index = MaterialXNumber(0), unknown;
    if (kind == "texcoord") {
      if (!Fixed(node, "index", MaterialXNumber(0), &index, &unknown)) return unknown;
    } else {
      const Value name = Input(node, "geomprop", WithText(""));
      if (name.text != "UV0" && name.text != "st") {
        return MaterialXUnknown(fmt::format("the property \"{}\"", Excerpt(name.text, 40)));
      }
    }
    if (index.numbers[0] != 0) return MaterialXUnknown("a second set of coordinates");
    return {.kind = ValueKind::kCoordinates, .size = 2};
  }
  if (kind == "place2d") return Place(node);
  if (kind == "rotate2d") {
    Value degrees, unknown;
    if (!Fixed(node, "amount", MaterialXNumber(0), &degrees, &unknown)) return unknown;
    return TurnedClockwise(Input(node, "in", {}), degrees.numbers[0]);
  }
  return MaterialXUnknown("a node that is not read");
}

MaterialXValue MaterialXGraph::Arithmetic(size_t node, bool* is_arithmetic) {
  const MaterialXElement& element = document_.elements[node];
  const std::string& kind = element.kind;
  const int size = std::max(1, MaterialXSize(element.type()));
  *is_arithmetic = true;
  // Operands may have the size of the result, or be one number.
  const auto operand = [&](std::string_view name, double otherwise) {
    return Input(node, name, Repeated(otherwise, size));
  };
  for (const BinaryNode& row : kBinaryNodes) {
    if (kind == row.kind) return row.function(operand("in1", 0), operand("in2", row.second));
  }
  for (const UnaryNode& row : kUnaryNodes) {
    if (kind == row.kind) {
      return OfNumbers(row.kind, operand("in", 0), MaterialXNumber(0), row.function);
    }
  }
  if (kind == "power") {
    const Value base = operand("in1", 0), exponent = operand("in2", 1);
    if (exponent.Is(1)) return base;
    return OfNumbers("a power", base, exponent, [](double x, double y) { return std::pow(x, y); });
  }
  if (kind == "invert") return Subtract(operand("amount", 1), operand("in", 0));
  if (kind == "clamp") {
    return Minimum(Maximum(operand("in", 0), operand("low", 0)), operand("high", 1));
  }
  if (kind == "mix") return Mix(operand("bg", 0), operand("fg", 0), operand("mix", 0));
  *is_arithmetic = false;
  return {};
}

MaterialXValue MaterialXGraph::Image(size_t node) {
  const MaterialXElement& element = document_.elements[node];
  // A gltf_colorimage has a colour and alpha, as two outputs.
  const std::string type =
      element.kind == "gltf_colorimage" ? std::string("color4") : element.type();
  const int size = MaterialXSize(type);
  if (size == 0) return MaterialXUnknown("an image of this type");
  const Value file = Input(node, "file", WithText(""));
  const Value otherwise = Input(node, "default", Repeated(0, size));
  const size_t file_input = document_.FindChild(node, "file");
  if (file.kind != ValueKind::kText) return file.is_unknown() ? file : MaterialXUnknown("an image");
  const Source source = file_input == kNoElement ? Source{} : SourceOf(file_input);
  const MaterialXElement* const named =
      source.constant == kNoElement ? nullptr : &document_.elements[source.constant];
  if (named == nullptr || named->Attribute("value").empty()) return otherwise;
  if (file.text.find_first_of("<{") != std::string::npos) {
    return MaterialXUnknown(
        fmt::format("the set of images \"{}\" (line {})", Excerpt(file.text), named->line));
  }
  Value coordinates = Input(node, "texcoord", {.kind = ValueKind::kCoordinates, .size = 2});
  if (coordinates.is_unknown()) return coordinates;
  if (coordinates.kind != ValueKind::kCoordinates) return MaterialXUnknown("an image at one place");
  Value factor = Repeated(1, size), unknown;
  if (element.kind == "tiledimage") {
    Value tiling, offset, image_size, tile_size;
    const Value ones = NumbersOf({1, 1}), zeros = NumbersOf({0, 0});
    if (!Fixed(node, "uvtiling", ones, &tiling, &unknown) ||
        !Fixed(node, "uvoffset", zeros, &offset, &unknown) ||
        !Fixed(node, "realworldimagesize", ones, &image_size, &unknown) ||
        !Fixed(node, "realworldtilesize", ones, &tile_size, &unknown)) {
      return unknown;
    }
    coordinates =
        Multiply(Divide(Subtract(Multiply(coordinates, tiling), offset), image_size), tile_size);
  } else if (element.kind != "image") {
    // MaterialX's definition in terms of place2d, which divides by its scale, turns clockwise and
    // subtracts its offset.
    Value pivot, scale, rotate, offset, order;
    if (!Fixed(node, "pivot", NumbersOf({0, 1}), &pivot, &unknown) ||
        !Fixed(node, "scale", NumbersOf({1, 1}), &scale, &unknown) ||
        !Fixed(node, "rotate", MaterialXNumber(0), &rotate, &unknown) ||
        !Fixed(node, "offset", NumbersOf({0, 0}), &offset, &unknown) ||
        !Fixed(node, "operationorder", MaterialXNumber(0), &order, &unknown)) {
      return unknown;
    }
    if (element.kind == "gltf_image") {
      if (!Fixed(node, "factor", Repeated(1, size), &factor, &unknown)) return unknown;
    }
    const bool scales_first = order.numbers[0] == 0 || element.kind == "gltf_colorimage";
    const Value inverse = Divide(NumbersOf({1, 1}), scale);
    const Value down = NumbersOf({-offset.numbers[0], offset.numbers[1]});
    coordinates = Placed(node, pivot, inverse, -rotate.numbers[0], down, scales_first);
  }
  if (coordinates.is_unknown()) return coordinates;
  if (!PlacementOf(coordinates.coordinates)) {
    return MaterialXUnknown("an image that is sheared");
  }
  Value value{.kind = ValueKind::kImage, .size = size, .numbers = factor.numbers};
  for (int i = 0; i < size; ++i) value.channels[static_cast<size_t>(i)] = i;
  const std::filesystem::path folder =
      std::filesystem::path(document_.files[named->file]).parent_path();
  value.image.file = (folder / file.text).string();
  if (IsColorType(type)) value.image.colorspace = named->colorspace;
  value.image.at = coordinates.coordinates;
  const auto wrap = [&](std::string_view name, std::string_view* to) {
    const std::string mode = Input(node, name, WithText("periodic")).text;
    *to = mode == "clamp" || mode == "constant" ? "clamp" : mode == "mirror" ? "mirror" : "repeat";
    return mode;
  };
  if (element.kind != "tiledimage") {
    for (const auto& mode :
         {wrap("uaddressmode", &value.image.wrap_u), wrap("vaddressmode", &value.image.wrap_v)}) {
      if (mode == "constant") value.image.has_border = true;
    }
  }
  if (Input(node, "filtertype", WithText("linear")).text == "closest") {
    value.image.filter = "nearest";
  }
  return value;
}

MaterialXValue MaterialXGraph::ColorImage(size_t node, const std::string& output) {
  Value image = Image(node), unknown, color, vertex;
  const Value ones = Repeated(1, 4);
  if (!Fixed(node, "color", ones, &color, &unknown) ||
      !Fixed(node, "geomcolor", ones, &vertex, &unknown)) {
    return unknown;
  }
  image = Multiply(Multiply(image, color), vertex);
  if (output == "outa") return Component(image, 3);
  return image.is_unknown() ? image : Resized(image, 3);
}

MaterialXValue MaterialXGraph::NormalMap(size_t node) {
  const bool is_gltf = document_.elements[node].kind == "gltf_normalmap";
  const Value image = is_gltf ? Image(node) : Input(node, "in", NumbersOf({0.5, 0.5, 1}));
  if (image.is_unknown()) return image;
  Value scale, unknown;
  // The node's scale is one number or one for each axis, of which a scene has one.
  if (!Fixed(node, "scale", NumbersOf({1, 1}), &scale, &unknown)) return unknown;
  if (is_gltf) scale = NumbersOf({1, 1});
  if (scale.numbers[0] != scale.numbers[1]) {
    return MaterialXUnknown("a normal map with two scales");
  }
  if (!is_gltf && Input(node, "space", WithText("tangent")).text != "tangent") {
    return MaterialXUnknown("a normal map that is not in tangent space");
  }
  Value normal{.kind = ValueKind::kNormal, .size = 3, .numbers = {scale.numbers[0], 0, 0, 0}};
  if (image.is_numbers()) {
    const auto& n = image.numbers;
    const bool is_flat = scale.numbers[0] == 0 || (n[0] == 0.5 && n[1] == 0.5);
    return is_flat ? normal : MaterialXUnknown("a normal map of one normal");
  }
  const bool is_whole = image.is_image() &&
                        image.channels == std::array{0, 1, 2, Value::kConstant} &&
                        image.numbers[0] == 1 && image.numbers[1] == 1 && image.numbers[2] == 1;
  if (!is_whole) return MaterialXUnknown("a normal map of what is no plain image");
  normal.image = image.image;
  normal.image.colorspace.clear();  // data, whatever the image's type
  return normal;
}

MaterialXValue MaterialXGraph::Separate(size_t node, const std::string& output) {
  // Outputs are named "outx" or "outr" by the type of "in".
  constexpr std::array<std::string_view, 2> kLetters = {"xyzw", "rgba"};
  const Value in = Input(node, "in", {});
  const std::string_view letter =
      std::string_view(output).substr(output.starts_with("out") ? 3 : 0);
  for (const std::string_view letters : kLetters) {
    const size_t at = letter.size() == 1 ? letters.find(letter) : std::string_view::npos;
    if (at != std::string_view::npos) return Component(in, static_cast<int>(at));
  }
  return MaterialXUnknown(fmt::format("an output \"{}\" that is none", Excerpt(output, 40)));
}

MaterialXValue MaterialXGraph::Place(size_t node) {
  Value pivot, scale, rotate, offset, order, unknown;
  if (!Fixed(node, "pivot", NumbersOf({0, 0}), &pivot, &unknown) ||
      !Fixed(node, "scale", NumbersOf({1, 1}), &scale, &unknown) ||
      !Fixed(node, "rotate", MaterialXNumber(0), &rotate, &unknown) ||
      !Fixed(node, "offset", NumbersOf({0, 0}), &offset, &unknown) ||
      !Fixed(node, "operationorder", MaterialXNumber(0), &order, &unknown)) {
    return unknown;
  }
  return Placed(node, pivot, scale, rotate.numbers[0], offset, order.numbers[0] == 0);
}

// As MaterialX's node graph of place2d.
MaterialXValue MaterialXGraph::Placed(size_t node, const MaterialXValue& pivot,
                                      const MaterialXValue& scale, double degrees,
                                      const MaterialXValue& offset, bool scales_first) {
  Value at = Subtract(Input(node, "texcoord", {.kind = ValueKind::kCoordinates, .size = 2}), pivot);
  if (scales_first) {
    at = Subtract(TurnedClockwise(Divide(at, scale), degrees), offset);
  } else {
    at = Divide(TurnedClockwise(Subtract(at, offset), degrees), scale);
  }
  return Add(at, pivot);
}

}  // namespace nacre
