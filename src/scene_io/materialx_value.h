// SPDX-License-Identifier: Apache-2.0
// scene_io/materialx_value.h: what a node of a MaterialX graph evaluates to: numbers, or what a
// material of a scene can look up itself. The arithmetic keeps to these; what leaves them becomes
// unknown, with the reason.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "base/vec.h"

namespace nacre {

// Texture coordinates (u', v') = rows * (u, v, 1).
struct MaterialXCoordinates {
  std::array<Vec3d, 2> rows{Vec3d(1, 0, 0), Vec3d(0, 1, 0)};
  friend bool operator==(const MaterialXCoordinates&, const MaterialXCoordinates&) = default;
};

// An image file and how it is looked up.
struct MaterialXImage {
  std::string file;        // relative to the document's folder
  std::string colorspace;  // of colours; empty for data
  MaterialXCoordinates at;
  std::string_view wrap_u = "repeat", wrap_v = "repeat", filter = "trilinear";  // as in scenes
  bool has_border = false;  // the address mode "constant", which scenes have not
  friend bool operator==(const MaterialXImage&, const MaterialXImage&) = default;
};

struct MaterialXValue {
  enum class Kind : uint8_t {
    kUnknown,      // `text` says why
    kNumbers,      // the first `size` numbers
    kImage,        // component i: channel channels[i] of the image times numbers[i]
    kCoordinates,  // texture coordinates
    kNormal,       // a normal map: the image, and numbers[0], the scale of x and y
    kText,         // `text`: a string, or a file's name
  };
  static constexpr int kConstant = -1;  // in `channels`: the number itself

  Kind kind = Kind::kUnknown;
  int size = 0;
  std::array<double, 4> numbers{};
  std::array<int, 4> channels{kConstant, kConstant, kConstant, kConstant};
  MaterialXImage image{};
  MaterialXCoordinates coordinates{};
  std::string text{};

  bool is_numbers() const { return kind == Kind::kNumbers; }
  bool is_image() const { return kind == Kind::kImage; }
  bool is_unknown() const { return kind == Kind::kUnknown; }
  // Whether all components are this number.
  bool Is(double number) const;
  // The first three numbers; a single one three times.
  Rgb Color() const {
    return size == 1 ? Rgb(numbers[0]) : Rgb(numbers[0], numbers[1], numbers[2]);
  }
  friend bool operator==(const MaterialXValue&, const MaterialXValue&) = default;
};

MaterialXValue MaterialXNumber(double number);
MaterialXValue MaterialXColor(const Rgb& color);
MaterialXValue MaterialXUnknown(std::string why);

// The arithmetic. A single number stands for all components of the other operand. An unknown
// operand makes the result unknown, but for products with 0 and mixes that do not need it.
MaterialXValue Multiply(const MaterialXValue& a, const MaterialXValue& b);
MaterialXValue Divide(const MaterialXValue& a, const MaterialXValue& b);
MaterialXValue Add(const MaterialXValue& a, const MaterialXValue& b);
MaterialXValue Subtract(const MaterialXValue& a, const MaterialXValue& b);
// (1 - t) bg + t fg.
MaterialXValue Mix(const MaterialXValue& bg, const MaterialXValue& fg, const MaterialXValue& t);
// Any other function of two numbers, of numbers alone. `name` is for the reason.
MaterialXValue OfNumbers(std::string_view name, const MaterialXValue& a, const MaterialXValue& b,
                         double (*function)(double, double));
// Values of images are taken to lie in [0, 1]: bounds that do not cut these leave an image as it
// is.
MaterialXValue Maximum(const MaterialXValue& a, const MaterialXValue& b);
MaterialXValue Minimum(const MaterialXValue& a, const MaterialXValue& b);
// One component as a value of its own.
MaterialXValue Component(const MaterialXValue& value, int index);
// `size` components: grey is repeated, a colour without alpha gets 1, what is too much is dropped.
MaterialXValue Resized(const MaterialXValue& value, int size);
// Joins the components of the parts.
MaterialXValue Joined(const std::array<MaterialXValue, 4>& parts, size_t count);

// Texture coordinates that are turned clockwise by the angle about the origin.
MaterialXValue TurnedClockwise(const MaterialXValue& value, double degrees);

// The coordinates as a texture of a scene has them: scaled, rotated and translated. nullopt if they
// are sheared.
struct TexturePlacement {
  Vec2d scale{1, 1}, offset{0, 0};
  double rotate_deg = 0;
};
std::optional<TexturePlacement> PlacementOf(const MaterialXCoordinates& at);

}  // namespace nacre
