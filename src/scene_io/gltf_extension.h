// SPDX-License-Identifier: Apache-2.0
// scene_io/gltf_extension.h: typed access to an extension's members, which ReadModel skips.
#pragma once

#include <cmath>
#include <string>
#include <utility>

#include "base/vec.h"
#include "scene_io/gltf_document.h"

namespace nacre {

// Each getter reads a member, or returns `otherwise` where there is none. Throws Error (kBadInput)
// for members of wrong types.
class GltfExtension {
 public:
  GltfExtension(const GltfDocument& document, const Json& value, std::string place)
      : document_(document), value_(value), place_(std::move(place)) {}

  bool Has(const char* name) const { return value_.contains(name); }
  const Json& Get(const char* name) const { return value_[name]; }  // the member must exist

  double Number(const char* name, double otherwise) const {
    return Has(name) ? NumberOf(Get(name), name) : otherwise;
  }
  Rgb Color(const char* name, const Rgb& otherwise) const {
    if (!Has(name)) return otherwise;
    const Json& array = ArrayOf(name, 3);
    return {NumberOf(array[0], name), NumberOf(array[1], name), NumberOf(array[2], name)};
  }
  // The fourth number of a colour; `otherwise` if the colour has no four.
  double Alpha(const char* name, double otherwise) const {
    if (!Has(name) || !Get(name).is_array() || Get(name).size() < 4) return otherwise;
    return NumberOf(Get(name)[3], name);
  }
  // A number that is refused unless it is in [0, 1].
  double Unit(const char* name, double otherwise) const {
    const double number = Number(name, otherwise);
    if (!(number >= 0 && number <= 1)) Refuse(name, "is not in [0, 1]");
    return number;
  }
  Vec2d Pair(const char* name, const Vec2d& otherwise) const {
    if (!Has(name)) return otherwise;
    const Json& array = ArrayOf(name, 2);
    return {NumberOf(array[0], name), NumberOf(array[1], name)};
  }

  [[noreturn]] void Refuse(const char* name, const char* what) const {
    document_.Refuse(PlaceOf(name), what);
  }
  // The JSON pointer to a member.
  std::string PlaceOf(const char* name) const { return place_ + "/" + name; }

 private:
  const Json& ArrayOf(const char* name, size_t least) const {
    const Json& array = Get(name);
    if (!array.is_array() || array.size() < least) Refuse(name, "is not an array of numbers");
    return array;
  }
  double NumberOf(const Json& value, const char* name) const {
    if (!value.is_number()) Refuse(name, "is not a number");
    return value.get<double>();
  }
  const GltfDocument& document_;
  const Json& value_;
  std::string place_;
};

}  // namespace nacre
