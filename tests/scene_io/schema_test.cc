// SPDX-License-Identifier: Apache-2.0
// The schema that the program carries, against the tables that the reader uses. Against scenes:
// schema_test.py.
#include "scene_io/schema.h"

#include <fstream>
#include <iterator>
#include <set>
#include <string>

#include <nlohmann/json.hpp>

#include "catch.h"
#include "scene/filter_width.h"
#include "scene/limits.h"
#include "scene/material_parameters.h"
#include "scene/sphere_mesh.h"
#include "scene_io/load_scene.h"

namespace nacre {
namespace {

using nlohmann::json;

json Schema() { return json::parse(SceneSchema()); }

// What a property says once its references are followed; its own keys win.
json Resolved(const json& schema, json property) {
  while (property.contains("$ref")) {
    const std::string reference = property["$ref"];
    property.erase("$ref");
    json target = schema.at(json::json_pointer(reference.substr(1)));
    target.update(property);
    property = target;
  }
  return property;
}

Range RangeOf(const json& number) {
  const bool min_open = number.contains("exclusiveMinimum");
  const bool max_open = number.contains("exclusiveMaximum");
  return {number[min_open ? "exclusiveMinimum" : "minimum"].get<double>(),
          number[max_open ? "exclusiveMaximum" : "maximum"].get<double>(), min_open, max_open};
}

json Property(const std::string& definition, const std::string& name) {
  const json schema = Schema();
  return Resolved(schema, schema.at("$defs").at(definition).at("properties").at(name));
}

TEST_CASE("the program carries the schema file") {
  std::ifstream file(NACRE_SOURCE_DIR "/scenes/nacre.schema.json");
  const std::string text((std::istreambuf_iterator<char>(file)), {});
  REQUIRE(!text.empty());
  CHECK(SceneSchema() == text);
}

TEST_CASE("the schema's materials are those of the parameter table") {
  const json schema = Schema();
  std::set<std::string> in_schema;
  for (const json& option : schema["$defs"]["material"]["oneOf"]) in_schema.insert(option["$ref"]);
  std::set<std::string> in_table = {"#/$defs/split_material", "#/$defs/materialx_material"};

  for (const MaterialModel& model : MaterialModels()) {
    const std::string name = std::string(model.name) + "_material";
    in_table.insert("#/$defs/" + name);
    INFO(name);
    const json& definition = schema["$defs"].at(name);
    CHECK(definition["additionalProperties"] == false);
    CHECK(definition["properties"]["model"]["const"] == model.name);
    // The model, its parameters, choices and maps, and the maps that all have; of what is measured
    // the file.
    const size_t files = model.name == "measured" ? 1 : 0;
    CHECK(definition["properties"].size() == 1 + files + model.parameters.size() +
                                                 model.choices.size() + model.maps.size() +
                                                 model.normal_maps.size() + 1);
    for (const MaterialMap& map : model.maps) {
      INFO(map.name);
      CHECK(definition["properties"].at(std::string(map.name))["$ref"] == "#/$defs/texture_name");
    }

    for (const MaterialParameter& parameter : model.parameters) {
      INFO(parameter.name);
      const json property = Property(name, std::string(parameter.name));
      const Rgb value = parameter.get(model.make());
      const bool is_grey = value.x == value.y && value.y == value.z;
      CHECK(property["default"] == (is_grey ? json(value.x) : json({value.x, value.y, value.z})));
      CHECK(property.contains("description"));
      CHECK(parameter.is_color == property.contains("anyOf"));
      if (parameter.is_color) {
        CHECK(RangeOf(property["anyOf"][0]) == parameter.range);
        CHECK(RangeOf(property["anyOf"][1]["items"]) == parameter.range);
      } else {
        CHECK(RangeOf(property) == parameter.range);
      }
    }
    for (const MaterialChoice& choice : model.choices) {
      const json property = Property(name, std::string(choice.name));
      CHECK(property["enum"] ==
            json(std::vector<std::string>(choice.options.begin(), choice.options.end())));
    }
  }
  CHECK(in_schema == in_table);
}

TEST_CASE("the schema's ranges are those of scene/limits.h") {
  const json definitions = Schema()["$defs"];
  CHECK(RangeOf(definitions["coordinate"]) == limits::kCoordinate);
  CHECK(RangeOf(definitions["length"]) == limits::kLength);
  CHECK(RangeOf(definitions["exponent"]) == limits::kExponent);
  CHECK(RangeOf(definitions["seed"]) == limits::kSeed);
  CHECK(RangeOf(definitions["radiance"]["anyOf"][0]) == limits::kRadiance);
  CHECK(RangeOf(definitions["axis_count"]) == limits::kGridCount);
  CHECK(RangeOf(definitions["texture_scale"]) == limits::kTextureScale);
  CHECK(RangeOf(definitions["sphere"]["properties"]["displacement"]["properties"]["segments"]) ==
        limits::kDisplacedSegments);
  CHECK(RangeOf(definitions["angle_deg"]) == limits::kAngleDeg);
  CHECK(RangeOf(definitions["normal_map"]["anyOf"][1]["properties"]["scale"]) ==
        limits::kNormalScale);
  CHECK(RangeOf(Property("perspective_camera", "fov_y_deg")) == limits::kFovYDeg);
  CHECK(RangeOf(Property("image", "width")) == limits::kImageSide);
  CHECK(RangeOf(Property("image", "height")) == limits::kImageSide);
  CHECK(RangeOf(Property("image", "spp")) == limits::kSpp);
  CHECK(RangeOf(Property("filter", "width")) == limits::kFilterWidth);
  CHECK(RangeOf(Property("spot_light", "cutoff_deg")) == limits::kCutoffDeg);
  CHECK(RangeOf(Property("spot_light", "inner_deg")) == limits::kInnerDeg);
  CHECK(RangeOf(Property("split_material", "at")["items"]) == limits::kSplitAt);
  CHECK(RangeOf(Property("cloud", "count")) == limits::kCloudCount);
  CHECK(RangeOf(Property("mesh", "crease_angle_deg")) == limits::kCreaseAngleDeg);
  CHECK(RangeOf(Property("icosphere", "subdivisions")) == limits::kSubdivisions);
  CHECK(RangeOf(Property("uv_sphere", "segments")) == limits::kSegments);
  CHECK(RangeOf(Property("uv_sphere", "rings")) == limits::kRings);
  for (const char* term : {"constant", "linear", "quadratic"}) {
    CHECK(RangeOf(definitions["attenuation"]["anyOf"][1]["properties"][term]) ==
          limits::kAttenuation);
  }
}

TEST_CASE("the schema's defaults are those of scene/scene.h") {
  const Scene scene;
  CHECK(Property("image", "width")["default"] == scene.image.width);
  CHECK(Property("image", "height")["default"] == scene.image.height);
  CHECK(Property("image", "spp")["default"] == scene.image.spp);
  CHECK(Property("perspective_camera", "fov_y_deg")["default"] == scene.camera.fov_y_deg);
  CHECK(Property("orthographic_camera", "height")["default"] == scene.camera.height);
  CHECK(Property("spot_light", "cutoff_deg")["default"] == SpotLight{}.cutoff_deg);
  CHECK(Property("icosphere", "subdivisions")["default"] == Icosphere{}.subdivisions);
  CHECK(Property("uv_sphere", "segments")["default"] == UvSphere{}.segments);
  CHECK(Property("uv_sphere", "rings")["default"] == UvSphere{}.rings);
}

// Objects that do not say additionalProperties would let slips through.
void CheckClosed(const json& node, const std::string& where) {
  if (node.is_object() && node.value("type", json()) == "object") {
    INFO(where);
    CHECK(node.contains("additionalProperties"));
    CHECK((node.contains("title") || node.contains("description") || where.ends_with("/anyOf/1")));
  }
  if (!node.is_structured()) return;
  for (const auto& [name, child] : node.items()) CheckClosed(child, where + "/" + name);
}

TEST_CASE("the schema is closed and explained everywhere") { CheckClosed(Schema(), ""); }

}  // namespace
}  // namespace nacre
