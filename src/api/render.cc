// SPDX-License-Identifier: Apache-2.0
// api/render.cc: renders of the public API.
#include <chrono>
#include <map>
#include <utility>
#include <variant>

#include "api/render_impl.h"
#include "api/scene_impl.h"
#include "base/overloaded.h"
#include "output/metadata.h"
#include "scene/limits.h"
#include "scene_io/json_reader.h"

namespace nacre::v0 {
namespace {

void Require(bool is_right, const char* setting, const std::string& range) {
  if (is_right) return;
  throw nacre::Error(ExitCode::kUsage, std::string("RenderSettings::") + setting, "is out of range",
                     "it is " + range);
}

void RequireWithin(double value, const Range& range, const char* setting) {
  Require(value == 0 || range.Contains(value), setting, "0 or " + Describe(range));
}

// Sets what is given by name. Throws nacre::Error.
void ReadOthers(const Parameters& others, nacre::RenderSettings* own) {
  if (others.empty()) return;
  const std::string where = "RenderSettings::others";
  FaultList faults;
  const nacre::Json json = ParseJson(Value(others).json(), where, &faults);
  JsonObject object({json, {}, &faults});
  for (const SettingKey& key : SettingKeys()) {
    if (key.library == LibraryUse::kNone) continue;
    std::visit(Overloaded{[&](double nacre::RenderSettings::*field) {
                            object.Number(key.name, key.range, &(own->*field));
                          },
                          [&](int nacre::RenderSettings::*field) {
                            object.Whole(key.name, key.range, &(own->*field));
                          },
                          [&](bool nacre::RenderSettings::*field) {
                            object.Boolean(key.name, &(own->*field));
                          },
                          [](std::vector<std::string> nacre::RenderSettings::*) {},  // a member
                          [&](const SettingChoice& choice) {
                            size_t option = 0;
                            const bool given = object.Choice(key.name, choice.options, &option);
                            if (given) choice.set(*own, option);
                          },
                          [&](const SettingText& of_text) {
                            std::string text;
                            if (object.Text(key.name, &text)) of_text.parse(text, own);
                          }},
               key.field);
  }
  object.RefuseOthers();
  ThrowFaults(faults, where, ExitCode::kUsage);
}

}  // namespace

std::map<std::string, std::string> NamedSettings() {
  std::map<std::string, std::string> named;
  for (const SettingKey& key : SettingKeys()) {
    if (key.library == LibraryUse::kByName) named.emplace(key.name, key.meaning);
  }
  return named;
}

nacre::RenderSettings ToOwn(const RenderSettings& settings) {
  RequireWithin(settings.width, limits::kImageSide, "width");
  RequireWithin(settings.height, limits::kImageSide, "height");
  RequireWithin(settings.samples, limits::kSpp, "samples");
  nacre::RenderSettings own;
  own.max_error = settings.max_error;
  own.threads = settings.threads;
  own.region = ToOwn(settings.region);
  const Window& region = settings.region;
  const bool all = region.x0 == 0 && region.y0 == 0 && region.x1 == 0 && region.y1 == 0;
  Require(all || !own.region.empty(), "region", "x0 < x1 and y0 < y1");
  own.layers = settings.layers;
  if (settings.samples > 0) own.max_samples = settings.samples;
  SetChoice(SettingNamed("intersector"), settings.intersector, &own);
  ReadOthers(settings.others, &own);
  CheckSettings(own);
  own.on_progress = settings.on_progress;
  own.cancel = settings.cancel;
  return own;
}

nacre::ImageSettings Adjusted(nacre::ImageSettings image, const RenderSettings& settings) {
  if (settings.width > 0) image.width = settings.width;
  if (settings.height > 0) image.height = settings.height;
  if (settings.samples > 0) image.spp = settings.samples;
  if (settings.seed) image.seed = *settings.seed;
  return image;
}

namespace {

// The scene with the size, samples and seed of the settings; the same object if it has them.
std::shared_ptr<const nacre::Scene> Adjusted(std::shared_ptr<const nacre::Scene> scene,
                                             const RenderSettings& settings) {
  const nacre::ImageSettings image = Adjusted(scene->image, settings);
  if (image == scene->image) return scene;
  auto copy = std::make_shared<nacre::Scene>(*scene);
  copy->image = image;
  return copy;
}

}  // namespace

Image Finish(const FramePlan& plan, PreparedScene* prepared, nacre::Image rendered,
             const nacre::RenderStats& counted, double plan_seconds, RenderStats* stats) {
  // In files, colours and normals are stored as half floats.
  const std::vector<ChannelSpec> in_files = StripChannels(plan.film.layers, PixelType::kHalf);
  for (size_t i = 0; i < in_files.size(); ++i) rendered.channels[i].type = in_files[i].type;
  nacre::ExrHeader header = MakeExrHeader(plan, false, {}, prepared);
  header.attributes[kRenderTimeAttribute] = static_cast<float>(counted.render_seconds);
  AddMetadata(header, &rendered);
  if (stats != nullptr) {
    *stats = {.camera_rays = counted.camera_rays,
              .shadow_rays = counted.shadow_rays,
              .plan_seconds = plan_seconds,
              .render_seconds = counted.render_seconds,
              .threads = counted.threads,
              .notes = plan.why.notes,
              .unsettled_pixels = counted.unsettled_pixels,
              .fewest_samples = counted.pixel_samples.fewest,
              .most_samples = counted.pixel_samples.most,
              .mean_samples = counted.pixel_samples.Mean(),
              .hits = counted.hits,
              .shades = counted.shades};
    const std::string unsettled = UnsettledNote(plan, counted);
    if (!unsettled.empty()) stats->notes.push_back(unsettled);
  }
  return ToPublic(std::move(rendered));
}

Cancelled::~Cancelled() = default;
const char* Cancelled::what() const noexcept { return "cancelled"; }

Image Render(const Scene& scene, const RenderSettings& settings, RenderStats* stats) {
  return Cancellable([&] {
    const nacre::RenderSettings own = ToOwn(settings);
    const std::shared_ptr<const nacre::Scene> made = Adjusted(scene.impl().Made(), settings);
    const auto start = std::chrono::steady_clock::now();
    const FramePlan plan = MakePlan(*made, own);
    const std::chrono::duration<double> plan_time = std::chrono::steady_clock::now() - start;
    nacre::RenderStats counted;
    nacre::Image rendered = RenderImage(plan, own, &counted);
    return Finish(plan, nullptr, std::move(rendered), counted, plan_time.count(), stats);
  });
}

}  // namespace nacre::v0
