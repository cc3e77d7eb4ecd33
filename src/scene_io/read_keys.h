// SPDX-License-Identifier: Apache-2.0
// scene_io/read_keys.h: reads the keys of scene/keys.h from a JSON tree, and converts them back.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "scene/keys.h"
#include "scene_io/json_reader.h"

namespace nacre {

// The part of a key's name before the slash, which names the object that contains it; "" if there
// is no slash.
inline std::string_view OuterName(std::string_view name) {
  const size_t slash = name.find('/');
  return slash == std::string_view::npos ? std::string_view() : name.substr(0, slash);
}
inline std::string_view InnerName(std::string_view name) {
  return name.substr(name.find('/') + 1);  // npos + 1 is 0
}

// Describes what to write for a missing key: "[x, y, z]".
std::string HintOf(KeyForm form, const Range& range, std::span<const std::string_view> options,
                   std::string_view meaning);

// Reads one value; nullopt if it is missing or invalid.
std::optional<Vec3d> ReadKeyValue(JsonObject* object, std::string_view name, KeyForm form,
                                  const Range& range, std::span<const std::string_view> options);

template <class Owner>
void ReadKey(const SceneKey<Owner>& key, JsonObject* object, Owner* owner) {
  const std::string_view name = InnerName(key.name);
  if (key.use == KeyUse::kRequired) {
    object->Require(name, HintOf(key.form, key.range, key.options, key.meaning));
  }
  if (const auto value = ReadKeyValue(object, name, key.form, key.range, key.options)) {
    key.set(*owner, *value);
  }
}

// Reads the keys that are members of the object itself.
template <class Owner>
void ReadKeys(JsonObject* object, Owner* owner) {
  for (const SceneKey<Owner>& key : KeysFor(*owner)) {
    if (OuterName(key.name).empty()) ReadKey(key, object, owner);
  }
}

// Reads the keys that are members of the object `inner`, which the object has under the name
// `outer`.
template <class Owner>
void ReadInnerKeys(std::string_view outer, JsonObject* inner, Owner* owner) {
  for (const SceneKey<Owner>& key : KeysFor(*owner)) {
    if (OuterName(key.name) == outer) ReadKey(key, inner, owner);
  }
}

Json KeyValueJson(KeyForm form, std::span<const std::string_view> options, const Vec3d& value);

// All keys of the owner as JSON.
template <class Owner>
Json KeysJson(const Owner& owner) {
  Json json = Json::object();
  for (const SceneKey<Owner>& key : KeysFor(owner)) {
    const std::string_view outer = OuterName(key.name);
    Json& to = outer.empty() ? json : json[std::string(outer)];
    to[std::string(InnerName(key.name))] = KeyValueJson(key.form, key.options, key.get(owner));
  }
  return json;
}

}  // namespace nacre
