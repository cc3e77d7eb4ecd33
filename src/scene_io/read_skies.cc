// SPDX-License-Identifier: Apache-2.0
// scene_io/read_skies.cc: the sky of an environment.
#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "base/error.h"
#include "base/parallel.h"
#include "image_io/color_channels.h"
#include "image_io/read_image.h"
#include "scene_io/read_keys.h"
#include "scene_io/readers.h"
#include "scene_io/text_file.h"

namespace nacre {
namespace {

// Reads a sky that is an object of its own.
template <class Sky>
Sky ReadSkyObject(const JsonValue& value, std::string_view hint) {
  Sky sky;
  JsonObject object(value, hint);
  ReadKeys(&object, &sky);
  object.RefuseOthers();
  return sky;
}

struct PictureReading {
  std::string part;             // which part of a multi-part EXR file
  bool clamp_negative = false;  // negative samples count as 0
};

constexpr float kMostRadiance = limits::kRadiance.max;

// Whether all samples are valid radiances.
bool AreRadiances(std::span<const float> samples, int threads) {
  constexpr size_t kPiece = size_t{1} << 18;
  std::atomic<bool> all = true;
  ParallelForBlocks(samples.size(), kPiece, threads, [&](size_t begin, size_t end) {
    bool good = true;
    for (const float sample : samples.subspan(begin, end - begin)) {
      good &= sample >= 0 && sample <= kMostRadiance;
    }
    if (!good) all = false;
  });
  return all;
}

// Reads an environment picture. Throws Error (kBadInput) for files that are not one. `light` is its
// pointer in the scene; remarks about the picture are added to `notes`.
std::shared_ptr<const SkyPicture> MakePicture(const std::string& path, const std::string& file,
                                              const PictureReading& reading,
                                              const std::string& light, int threads,
                                              std::vector<std::string>* notes) {
  const auto refuse = [&](const std::string& what, const std::string& hint) {
    throw Error(ExitCode::kBadInput, file, what, hint);
  };
  const ImageFile image = OpenImage(path, reading.part);
  const Window window = WholeWindow(image, "an environment");
  if (image.header.metadata.at("transfer") == "display") {
    refuse("display codes, not radiance", "use an EXR or a Radiance HDR picture");
  }
  const auto envmap = image.header.metadata.find("envmap");
  if (envmap != image.header.metadata.end() && envmap->second == "cube") {
    refuse("it is a cube map", "make latitude and longitude of it: exrenvmap -l IN OUT");
  }
  const std::optional<ColorChannels> colors = FindColors(image.header.channels, "");
  if (!colors) {
    refuse("no channels R, G and B, nor one alone", TellChannels(image.header.channels));
  }
  // Without this note, a fisheye picture or a photograph would silently be taken for a panorama.
  if (envmap == image.header.metadata.end() && std::abs(window.width() - 2 * window.height()) > 2) {
    notes->push_back(fmt::format(
        "{} x {} pixels are not 2:1, and are taken as latitude and longitude all the same",
        window.width(), window.height()));
  }
  image.CheckSize(window, 3);  // also for grey pictures: the radiance has three channels
  auto picture = std::make_shared<SkyPicture>();
  picture->width = window.width();
  picture->height = window.height();
  picture->rgb.resize(3 * window.pixel_count());
  float* const rgb = picture->rgb.data();
  const ptrdiff_t step_y = ptrdiff_t{3} * window.width();
  const std::array<size_t, 3> channels = {colors->r, colors->g, colors->b};
  std::vector<SampleTarget> targets;
  for (size_t c = 0; c < (colors->is_grey() ? 1 : 3); ++c) {
    targets.push_back({channels[c], rgb + c, 3, step_y});
  }
  image.read(window, targets);
  // Throws for the first sample that is not a radiance. If `clamp`, negative samples count as 0.
  const auto judge = [&](bool clamp, const std::string& of) {
    if (AreRadiances(picture->rgb, threads)) return;
    size_t clamped = 0;
    float lowest = 0;
    for (size_t i = 0; i < picture->rgb.size(); ++i) {
      if (rgb[i] < 0 && rgb[i] >= std::numeric_limits<float>::lowest() && clamp) {
        ++clamped;
        lowest = std::min(lowest, rgb[i]);
        rgb[i] = 0;
      }
      if (rgb[i] >= 0 && rgb[i] <= kMostRadiance) continue;
      const size_t pixel = i / 3, width = static_cast<size_t>(window.width());
      const bool is_negative = rgb[i] < 0 && std::isfinite(rgb[i]);
      refuse(fmt::format("pixel {},{} has {} = {}{}", pixel % width, pixel / width,
                         image.header.channels[channels[i % 3]].name, rgb[i], of),
             is_negative ? fmt::format(R"("clamp_negative": true counts samples below 0 as 0; )"
                                       "--set {}/clamp_negative=true says so",
                                       light)
                         : "radiance is " + Describe(limits::kRadiance));
    }
    notes->push_back(
        fmt::format("{} samples below 0, down to {}, count as 0{}", clamped, lowest, of));
  };
  if (colors->is_grey()) {
    for (size_t i = 0; i < picture->rgb.size(); ++i) rgb[i] = rgb[i - i % 3];
  }
  judge(reading.clamp_negative, "");
  if (colors->is_grey()) return picture;
  const ColorConversion conversion = ConversionToRec709(image.header.metadata);
  if (!conversion.note.empty()) notes->push_back(conversion.note);
  if (!conversion.matrix) return picture;
  ConvertColors(*conversion.matrix, {rgb, rgb + 1, rgb + 2}, 3, window.pixel_count(),
                /*clip=*/false, threads);
  judge(/*clamp=*/true, " (in Rec. 709)");
  return picture;
}

void ReadPicture(const JsonValue& value, const PictureReading& reading, const SceneContext& context,
                 PictureSky* sky) {
  std::string file;
  if (!ReadText(value, &file)) return;
  if (!context.budget->TakeSkyPicture()) {
    value.AddFault("a second environment", "one picture holds all directions: add them up");
    return;
  }
  try {
    const auto path = ResolveReference(context.folder, file, context.references);
    std::string key;
    if (context.kept != nullptr) {
      key = fmt::format("{}|{}|{}", KeyOfFile(path), reading.part, reading.clamp_negative);
      const auto kept = context.kept->skies.find(key);
      if (kept != context.kept->skies.end()) sky->picture = kept->second.lock();
      if (sky->picture != nullptr) return;
    }
    std::vector<std::string> notes;
    sky->picture = MakePicture(path.string(), file, reading, value.path.parent->ToString(),
                               context.threads, &notes);
    if (context.kept != nullptr) context.kept->skies[key] = sky->picture;
    for (const std::string& note : notes) {
      if (context.on_warning) context.on_warning(file + ": " + note);
    }
  } catch (const Error& error) {
    AddFileFaults(error, value);
  }
}

}  // namespace

void ReadSky(JsonObject* object, const SceneContext& context, EnvironmentLight* light) {
  const auto radiance = object->Find("radiance");
  const auto gradient = object->Find("gradient");
  const auto quadratic = object->Find("quadratic");
  const auto image = object->Find("image");
  const int given =
      radiance.has_value() + gradient.has_value() + quadratic.has_value() + image.has_value();
  if (given == 0 && context.room != nullptr) {
    PictureSky room{context.room, Rgb(1)};
    ReadKeys(object, &room);
    light->sky = std::move(room);
  } else if (given != 1) {
    object->value().AddFault(given == 0 ? "no sky" : "more than one sky",
                             R"(give one of "radiance", "gradient", "quadratic" and "image")");
  }
  if (radiance) {
    ConstantSky sky;
    ReadKeys(object, &sky);
    light->sky = sky;
  } else if (gradient) {
    light->sky =
        ReadSkyObject<GradientSky>(*gradient, R"({"zenith": c, "horizon": c, "ground": c})");
  } else if (quadratic) {
    light->sky = ReadSkyObject<QuadraticSky>(
        *quadratic, R"({"axis": [x, y, z], "constant": a, "linear": b, "quadratic": c})");
  } else if (image) {
    PictureSky sky;
    PictureReading reading;
    object->Text("part", &reading.part);
    object->Boolean("clamp_negative", &reading.clamp_negative);
    ReadPicture(*image, reading, context, &sky);
    ReadKeys(object, &sky);
    // Without a picture, whose fault has been reported, the light keeps its default sky.
    if (sky.picture != nullptr) light->sky = std::move(sky);
  }
}

}  // namespace nacre
