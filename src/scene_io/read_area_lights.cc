// SPDX-License-Identifier: Apache-2.0
// scene_io/read_area_lights.cc: lights with an extent, and environments.
#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "base/error.h"
#include "image_io/image_reader.h"
#include "scene_io/readers.h"
#include "scene_io/text_file.h"

namespace nacre {
namespace {

constexpr std::string_view kRadianceHint = "radiance, [r, g, b] or grey, the same all over";

void ReadLength(JsonObject* object, std::string_view name, double* out) {
  object->Require(name, "a length greater than 0");
  object->Number(name, limits::kLength, out);
}

// What rectangles and disks have in common.
template <class Flat>
void ReadFlat(JsonObject* object, Flat* light) {
  ReadRequiredPoint(object, "center", "[x, y, z]", &light->center);
  ReadRequiredPoint(object, "facing", "[x, y, z], from the light to what it shines on",
                    &light->facing);
  ReadRadiance(object, "radiance", kRadianceHint, &light->radiance);
  object->Boolean("two_sided", &light->two_sided);
  object->Boolean("visible", &light->visible);
}

// Up, or for a light that faces up or down, away from the viewer.
Vec3d DefaultUp(const Vec3d& facing) {
  const bool vertical = std::hypot(facing.x, facing.z) <= 1e-6 * std::abs(facing.y);
  return vertical ? Vec3d(0, 0, -1) : Vec3d(0, 1, 0);
}

GradientSky ReadGradient(const JsonValue& value) {
  GradientSky sky;
  JsonObject object(value, R"({"zenith": c, "horizon": c, "ground": c})");
  object.Color("zenith", limits::kRadiance, &sky.zenith);
  object.Color("horizon", limits::kRadiance, &sky.horizon);
  object.Color("ground", limits::kRadiance, &sky.ground);
  object.RefuseOthers();
  return sky;
}

QuadraticSky ReadQuadratic(const JsonValue& value) {
  QuadraticSky sky;
  JsonObject object(value, R"({"axis": [x, y, z], "constant": a, "linear": b, "quadratic": c})");
  ReadRadiance(&object, "radiance", "[r, g, b] or grey, what the quadratic scales", &sky.radiance);
  object.Point("axis", &sky.axis);
  object.Number("constant", limits::kSkyTerm, &sky.constant);
  object.Number("linear", limits::kSkyTerm, &sky.linear);
  object.Number("quadratic", limits::kSkyTerm, &sky.quadratic);
  object.RefuseOthers();
  return sky;
}

// Throws Error (kBadInput) for what is no picture of light.
std::shared_ptr<const SkyPicture> MakePicture(const Image& image, const std::string& file) {
  const auto refuse = [&](const std::string& what, const std::string& hint) {
    throw Error(ExitCode::kBadInput, file, what, hint);
  };
  const Window& window = image.data;
  if (window != image.display) {
    refuse("the picture is a crop", "an environment needs all directions");
  }
  const Channel* const channels[3] = {image.Find("R"), image.Find("G"), image.Find("B")};
  const bool is_grey = image.Find("Y") != nullptr && channels[0] == nullptr;
  const auto transfer = image.metadata.find("transfer");
  if (transfer != image.metadata.end() && transfer->second == "display") {
    refuse("display codes, not radiance", "use an EXR or a Radiance HDR picture");
  }
  auto picture = std::make_shared<SkyPicture>();
  picture->width = window.width();
  picture->height = window.height();
  picture->rgb.resize(3 * window.pixel_count());
  for (size_t c = 0; c < 3; ++c) {
    const Channel* const channel = is_grey ? image.Find("Y") : channels[c];
    if (channel == nullptr) refuse("no channels R, G and B", "or Y alone");
    for (size_t i = 0; i < channel->samples.size(); ++i) {
      const float value = channel->samples[i];
      if (!(value >= 0) || !(value <= limits::kRadiance.max)) {
        const auto width = static_cast<size_t>(window.width());
        refuse(fmt::format("pixel {},{} has {} = {}", i % width, i / width, channel->name, value),
               "radiance is " + Describe(limits::kRadiance));
      }
      picture->rgb[3 * i + c] = value;
    }
  }
  return picture;
}

void ReadPicture(const JsonValue& value, const SceneContext& context, PictureSky* sky) {
  std::string file;
  if (!ReadText(value, &file)) return;
  if (!context.budget->TakeSkyPicture()) {
    value.AddFault("a second environment", "one picture holds all directions: add them up");
    return;
  }
  try {
    const auto path = ResolveReference(context.folder, file, context.references);
    sky->picture = MakePicture(ReadImage(path.string()), file);
  } catch (const Error& error) {
    for (const Fault& fault : error.faults()) {
      value.AddFault(fault.where.empty() ? fault.what : fault.where + ": " + fault.what,
                     fault.hint);
    }
  }
}

}  // namespace

SphereAreaLight ReadSphereArea(JsonObject* object) {
  SphereAreaLight light;
  ReadRequiredPoint(object, "center", "[x, y, z]", &light.center);
  ReadLength(object, "radius", &light.radius);
  ReadRadiance(object, "radiance", kRadianceHint, &light.radiance);
  object->Boolean("visible", &light.visible);
  return light;
}

RectangleAreaLight ReadRectangleArea(JsonObject* object) {
  RectangleAreaLight light;
  ReadFlat(object, &light);
  ReadLength(object, "width", &light.width);
  ReadLength(object, "height", &light.height);
  if (!object->Point("up", &light.up)) light.up = DefaultUp(light.facing);
  return light;
}

DiskAreaLight ReadDiskArea(JsonObject* object) {
  DiskAreaLight light;
  ReadFlat(object, &light);
  ReadLength(object, "radius", &light.radius);
  return light;
}

MeshAreaLight ReadMeshArea(JsonObject* object, const SceneContext& context) {
  MeshAreaLight light;
  light.mesh = ReadLightMesh(object, context);
  ReadRadiance(object, "radiance", kRadianceHint, &light.radiance);
  object->Boolean("two_sided", &light.two_sided);
  object->Boolean("visible", &light.visible);
  return light;
}

EnvironmentLight ReadEnvironment(JsonObject* object, const SceneContext& context) {
  EnvironmentLight light;
  const Json* const radiance = object->Find("radiance");
  const Json* const gradient = object->Find("gradient");
  const Json* const quadratic = object->Find("quadratic");
  const Json* const image = object->Find("image");
  const auto value = [&](std::string_view name, const Json* json) {
    return JsonValue{*json, object->path().Member(name), object->faults()};
  };
  const int given =
      (radiance != nullptr) + (gradient != nullptr) + (quadratic != nullptr) + (image != nullptr);
  if (given != 1) {
    object->value().AddFault(given == 0 ? "no sky" : "more than one sky",
                             R"(give one of "radiance", "gradient", "quadratic" and "image")");
  }
  if (radiance != nullptr) {
    ConstantSky sky;
    ReadColor(value("radiance", radiance), limits::kRadiance, &sky.radiance);
    light.sky = sky;
  } else if (gradient != nullptr) {
    light.sky = ReadGradient(value("gradient", gradient));
  } else if (quadratic != nullptr) {
    light.sky = ReadQuadratic(value("quadratic", quadratic));
  } else if (image != nullptr) {
    PictureSky sky;
    ReadPicture(value("image", image), context, &sky);
    object->Color("scale", limits::kRadiance, &sky.scale);
    // Without a picture, of which there is a fault, the default sky stands in.
    if (sky.picture != nullptr) light.sky = std::move(sky);
  }
  object->Number("rotate_deg", limits::kCoordinate, &light.rotate_deg);
  object->Boolean("background", &light.background);
  return light;
}

}  // namespace nacre
