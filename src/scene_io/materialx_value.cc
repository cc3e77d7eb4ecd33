// SPDX-License-Identifier: Apache-2.0
#include "scene_io/materialx_value.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace nacre {
namespace {

using Value = MaterialXValue;
using ValueKind = MaterialXValue::Kind;

size_t Index(int component) { return static_cast<size_t>(component); }

// Component i of an operand of one or more.
double At(const Value& value, size_t i) { return value.numbers[value.size == 1 ? 0 : i]; }
int ChannelAt(const Value& value, size_t i) { return value.channels[value.size == 1 ? 0 : i]; }

// nullopt if the operands' sizes fit each other.
std::optional<Value> Misfit(std::string_view name, const Value& a, const Value& b) {
  if (a.is_unknown()) return a;
  if (b.is_unknown()) return b;
  if (a.kind == ValueKind::kText || b.kind == ValueKind::kText || a.kind == ValueKind::kNormal ||
      b.kind == ValueKind::kNormal) {
    return MaterialXUnknown(fmt::format("{} of what are no numbers", name));
  }
  if (a.size == b.size || a.size == 1 || b.size == 1) return std::nullopt;
  return MaterialXUnknown(
      fmt::format("{} of {} and {} numbers, which do not fit", name, a.size, b.size));
}

Value Beyond(std::string_view name, const Value& a, const Value& b) {
  const auto what = [](const Value& value) {
    return value.is_image()                        ? "an image"
           : value.kind == ValueKind::kCoordinates ? "coordinates"
                                                   : "numbers";
  };
  return MaterialXUnknown(fmt::format("{} of {} and {}", name, what(a), what(b)));
}

// The coordinates with each row changed.
template <class Change>
Value ChangedRows(const Value& value, const Change& change) {
  Value result = value;
  for (size_t i = 0; i < 2; ++i) change(i, &result.coordinates.rows[i]);
  return result;
}

}  // namespace

bool MaterialXValue::Is(double number) const {
  if (!is_numbers()) return false;
  return std::all_of(numbers.begin(), numbers.begin() + size,
                     [&](double own) { return own == number; });
}

MaterialXValue MaterialXNumber(double number) {
  return {.kind = ValueKind::kNumbers, .size = 1, .numbers = {number, 0, 0, 0}};
}

MaterialXValue MaterialXColor(const Rgb& color) {
  return {.kind = ValueKind::kNumbers, .size = 3, .numbers = {color.x, color.y, color.z, 0}};
}

MaterialXValue MaterialXUnknown(std::string why) {
  return {.kind = ValueKind::kUnknown, .text = std::move(why)};
}

MaterialXValue OfNumbers(std::string_view name, const MaterialXValue& a, const MaterialXValue& b,
                         double (*function)(double, double)) {
  if (auto misfit = Misfit(name, a, b)) return *std::move(misfit);
  if (!a.is_numbers() || !b.is_numbers()) return Beyond(name, a, b);
  Value result = a.size >= b.size ? a : b;
  for (size_t i = 0; i < Index(result.size); ++i) {
    result.numbers[i] = function(At(a, i), At(b, i));
    if (std::isfinite(result.numbers[i])) continue;
    return MaterialXUnknown(
        fmt::format("{} of {} and {}, which is not a finite number", name, At(a, i), At(b, i)));
  }
  return result;
}

MaterialXValue Multiply(const MaterialXValue& a, const MaterialXValue& b) {
  if (a.Is(0) && (b.is_unknown() || b.size <= a.size)) return a;
  if (b.Is(0) && (a.is_unknown() || a.size <= b.size)) return b;
  if (auto misfit = Misfit("a product", a, b)) return *std::move(misfit);
  if (a.is_numbers() && b.is_numbers()) {
    return OfNumbers("a product", a, b, [](double x, double y) { return x * y; });
  }
  if (a.is_numbers()) return Multiply(b, a);
  if (a.kind == ValueKind::kCoordinates && b.is_numbers()) {
    return ChangedRows(a, [&](size_t i, Vec3d* row) { *row *= At(b, i); });
  }
  if (!a.is_image() || !b.is_numbers()) return Beyond("a product", a, b);
  Value result = a;
  result.size = std::max(a.size, b.size);
  for (size_t i = 0; i < Index(result.size); ++i) {
    result.numbers[i] = At(a, i) * At(b, i);
    result.channels[i] = ChannelAt(a, i);
    if (!std::isfinite(result.numbers[i])) {
      return MaterialXUnknown("a product that is not a finite number");
    }
  }
  return result;
}

MaterialXValue Divide(const MaterialXValue& a, const MaterialXValue& b) {
  if (b.is_numbers()) {
    Value inverse = b;
    for (size_t i = 0; i < Index(b.size); ++i) {
      if (b.numbers[i] == 0) return MaterialXUnknown("a quotient by 0");
      inverse.numbers[i] = 1 / b.numbers[i];
    }
    if (!a.is_numbers()) return Multiply(a, inverse);
  }
  return OfNumbers("a quotient", a, b, [](double x, double y) { return x / y; });
}

MaterialXValue Add(const MaterialXValue& a, const MaterialXValue& b) {
  if (a.Is(0) && !b.is_unknown() && b.size >= a.size) return b;
  if (b.Is(0) && !a.is_unknown() && a.size >= b.size) return a;
  if (a.is_numbers() && b.kind == ValueKind::kCoordinates) return Add(b, a);
  if (a.kind == ValueKind::kCoordinates && b.is_numbers() && b.size <= 2) {
    return ChangedRows(a, [&](size_t i, Vec3d* row) { row->z += At(b, i); });
  }
  return OfNumbers("a sum", a, b, [](double x, double y) { return x + y; });
}

MaterialXValue Subtract(const MaterialXValue& a, const MaterialXValue& b) {
  if (!b.is_numbers()) {
    return OfNumbers("a difference", a, b, [](double x, double y) { return x - y; });
  }
  return Add(a, Multiply(b, MaterialXNumber(-1)));
}

MaterialXValue Mix(const MaterialXValue& bg, const MaterialXValue& fg, const MaterialXValue& t) {
  if (bg == fg && !bg.is_unknown()) return bg;
  if (t.Is(0)) return bg;
  if (t.Is(1)) return fg;
  if (bg.is_unknown()) return bg;
  if (fg.is_unknown()) return fg;
  if (t.is_unknown()) return t;
  const Value rest = Subtract(MaterialXNumber(1), t);
  if (bg.Is(0)) return Multiply(fg, t);
  if (fg.Is(0)) return Multiply(bg, rest);
  // Two factors of the same texels have a factor between them.
  const bool same_texels = bg.is_image() && fg.is_image() && bg.image == fg.image &&
                           bg.size == fg.size && bg.channels == fg.channels;
  if (!same_texels || !t.is_numbers()) {
    if (bg.is_numbers() && fg.is_numbers() && t.is_numbers()) {
      return Add(Multiply(bg, rest), Multiply(fg, t));
    }
    return MaterialXUnknown("a mix of images");
  }
  Value result = bg;
  for (size_t i = 0; i < Index(bg.size); ++i) {
    result.numbers[i] = bg.numbers[i] * At(rest, i) + fg.numbers[i] * At(t, i);
  }
  return result;
}

MaterialXValue Maximum(const MaterialXValue& a, const MaterialXValue& b) {
  if (a.is_numbers() && b.is_image()) return Maximum(b, a);
  if (a.is_image() && b.is_numbers() && b.size <= a.size) {
    bool cuts = false;
    for (size_t i = 0; i < Index(a.size); ++i) {
      const double least = ChannelAt(a, i) < 0 ? a.numbers[i] : std::min(a.numbers[i], 0.0);
      cuts |= At(b, i) > least;
    }
    if (!cuts) return a;
  }
  return OfNumbers("the larger", a, b, [](double x, double y) { return std::max(x, y); });
}

MaterialXValue Minimum(const MaterialXValue& a, const MaterialXValue& b) {
  if (a.is_numbers() && b.is_image()) return Minimum(b, a);
  if (a.is_image() && b.is_numbers() && b.size <= a.size) {
    bool cuts = false;
    for (size_t i = 0; i < Index(a.size); ++i) {
      const double most = ChannelAt(a, i) < 0 ? a.numbers[i] : std::max(a.numbers[i], 0.0);
      cuts |= At(b, i) < most;
    }
    if (!cuts) return a;
  }
  return OfNumbers("the smaller", a, b, [](double x, double y) { return std::min(x, y); });
}

MaterialXValue Component(const MaterialXValue& value, int index) {
  if (value.is_unknown()) return value;
  if ((!value.is_numbers() && !value.is_image()) || index < 0 || index >= value.size) {
    return MaterialXUnknown(fmt::format("component {} of {}", index, value.size));
  }
  Value result = value;
  result.size = 1;
  result.numbers = {value.numbers[Index(index)], 0, 0, 0};
  result.channels = {value.channels[Index(index)], Value::kConstant, Value::kConstant,
                     Value::kConstant};
  if (result.channels[0] == Value::kConstant) {
    result.kind = ValueKind::kNumbers;
    result.image = {};
  }
  return result;
}

MaterialXValue Resized(const MaterialXValue& value, int size) {
  if ((!value.is_numbers() && !value.is_image()) || value.size == size) return value;
  Value result = value;
  result.size = size;
  for (size_t i = 0; i < 4; ++i) {
    const bool is_there = i < Index(size), is_known = value.size == 1 || i < Index(value.size);
    // Alpha is 1 where there is none; a vector's further components are 0.
    const double beyond = i == 3 ? 1 : 0;
    result.numbers[i] = !is_there ? 0 : is_known ? At(value, i) : beyond;
    result.channels[i] = is_there && is_known ? ChannelAt(value, i) : Value::kConstant;
  }
  return result;
}

MaterialXValue Joined(const std::array<MaterialXValue, 4>& parts, size_t count) {
  Value result{.kind = ValueKind::kNumbers};
  for (size_t part = 0; part < count; ++part) {
    const Value& value = parts[part];
    if (value.is_unknown()) return value;
    if (!value.is_numbers() && !value.is_image()) {
      return MaterialXUnknown("components of what are no numbers");
    }
    if (value.is_image()) {
      if (result.is_image() && result.image != value.image) {
        return MaterialXUnknown("components of two images");
      }
      result.kind = ValueKind::kImage;
      result.image = value.image;
    }
    for (size_t i = 0; i < Index(value.size); ++i) {
      if (result.size == 4) return MaterialXUnknown("more than four components");
      result.numbers[Index(result.size)] = value.numbers[i];
      result.channels[Index(result.size)] = value.channels[i];
      ++result.size;
    }
  }
  return result;
}

MaterialXValue TurnedClockwise(const MaterialXValue& value, double degrees) {
  const double angle = degrees * (M_PI / 180), c = std::cos(angle), s = std::sin(angle);
  Value result = value;
  if (value.kind == ValueKind::kCoordinates) {
    const auto& [u, v] = value.coordinates.rows;
    result.coordinates.rows = {u * c + v * s, v * c - u * s};
    return result;
  }
  if (value.is_numbers() && value.size == 2) {
    const auto& n = value.numbers;
    result.numbers = {c * n[0] + s * n[1], c * n[1] - s * n[0], 0, 0};
    return result;
  }
  return value.is_unknown() ? value : MaterialXUnknown("a rotation of what are no coordinates");
}

std::optional<TexturePlacement> PlacementOf(const MaterialXCoordinates& at) {
  const Vec2d u(at.rows[0].x, at.rows[1].x), v(at.rows[0].y, at.rows[1].y);
  TexturePlacement placement;
  placement.offset = {at.rows[0].z, at.rows[1].z};
  const double u_length = u.length(), v_length = v.length();
  // Rounding of a rotation leaves about 1e-16 of this.
  constexpr double kRounding = 1e-9;
  if (std::abs(u.dot(v)) > kRounding * u_length * v_length) return std::nullopt;
  if (u.y == 0 && v.x == 0) {
    placement.scale = {u.x, v.y};
    return placement;
  }
  // The axis of u; where the scale leaves nothing of it, at a right angle before that of v.
  const Vec2d axis = u_length > 0 ? u / u_length : Vec2d(v.y, -v.x) / v_length;
  placement.rotate_deg = std::atan2(axis.y, axis.x) * (180 / M_PI);
  placement.scale = {u_length, Vec2d(-axis.y, axis.x).dot(v)};
  return placement;
}

}  // namespace nacre
