// SPDX-License-Identifier: Apache-2.0
#include "cli/stats_json.h"

#include "base/target.h"
#include "base/version.h"
#include "output/metadata.h"
#include "scene/primitives.h"
#include "scene_io/json_text.h"

namespace nacre {

std::string StatsJson(const FramePlan& plan, const RenderStats& stats, const JobTimes& times,
                      const OutputCounts& counts) {
  const Scene& scene = *plan.scene;
  const auto ms = [](double seconds) { return 1e3 * seconds; };
  const auto rate = [&](uint64_t count) {
    return stats.render_seconds > 0 ? static_cast<double>(count) / stats.render_seconds : 0.0;
  };
  Json stages = Json::object();
  for (size_t i = 0; i < kStageCount; ++i) {
    stages[std::string(StageName(static_cast<Stage>(i)))] = ms(stats.stage_seconds[i]);
  }
  Json items = Json::array();
  for (const PlanItem& item : plan.why.items) {
    items.push_back({{"what", item.what}, {"used", item.used}, {"reason", item.reason}});
  }
  Json substitutions = Json::array();
  for (const PlanItem& item : plan.why.substitutions) {
    substitutions.push_back({{"what", item.what}, {"reason", item.reason}});
  }
  Json forecast;
  if (times.forecast) {
    forecast = {{"samples_per_pixel", times.forecast->samples_per_pixel},
                {"seconds", times.forecast->seconds},
                {"unsettled_share", times.forecast->unsettled_share}};
  }
  const Json json = {
      {"nacre", {{"version", std::string(kVersion)}, {"commit", std::string(kCommit)}}},
      {"target", TargetName(ActiveTarget())},
      {"threads", stats.threads},
      {"image",
       {{"width", plan.frame.width()},
        {"height", plan.frame.height()},
        {"pixels", plan.window.pixel_count()},
        {"spp", scene.image.spp},
        {"samples_per_pixel",
         {{"min", stats.pixel_samples.fewest},
          {"mean", stats.pixel_samples.Mean()},
          {"max", stats.pixel_samples.most}}},
        {"max_error", plan.adaptive.max_error},
        {"unsettled_pixels", stats.unsettled_pixels},
        {"forecast", forecast}}},
      {"scene",
       {{"spheres", scene.spheres.size()},
        {"triangles", CountTriangles(scene)},
        {"lights", scene.lights.size()},
        {"materials", scene.materials.size()},
        {"shadowing", ShadowingForms(plan.surfaces.prepared->any)}}},
      {"time_ms",
       {{"load", ms(times.load_seconds)},
        {"plan", ms(stats.plan_seconds)},
        {"render", ms(stats.render_seconds)},
        {"finish", ms(times.finish_seconds)},
        {"total", ms(times.total_seconds)},
        {"stages_all_threads", stages}}},
      {"counts",
       {{"camera_rays", stats.camera_rays},
        {"hits", stats.hits},
        {"shadow_rays", stats.shadow_rays},
        {"shades", stats.shades},
        {"light_batches", stats.light_batches}}},
      {"per_second",
       {{"camera_rays", rate(stats.camera_rays)},
        {"shadow_rays", rate(stats.shadow_rays)},
        {"shades", rate(stats.shades)}}},
      {"plan", items},
      {"substitutions", substitutions},
      {"samples_not_as_computed",
       {{"clamped", counts.exr.clamped},
        {"infinite", counts.exr.infinite},
        {"nan", counts.exr.nan},
        {"png_nan_pixels", counts.nan_pixels},
        {"directions_not_finite", stats.directions_not_finite}}},
  };
  return JsonText(json, 2) + "\n";
}

std::string DryRunJson(const ExrHeader& header, const RenderOptions& options, int most_tiles) {
  Json attributes = Json::object();
  for (const auto& [name, value] : header.attributes) {
    Json& attribute = attributes[name];  // Clang 14 does not capture structured bindings
    std::visit([&](const auto& plain) { attribute = plain; }, value);
  }
  Json channels = Json::object();
  for (const ExrChannel& channel : header.channels) {
    channels[channel.name] = PixelTypeName(channel.type);
  }
  const Window& data = header.data;
  const Json json = {{"display_window", {header.display.x1, header.display.y1}},
                     {"data_window", {data.x0, data.y0, data.x1, data.y1}},
                     {"most_tiles", most_tiles},
                     {"compression", options.compression},
                     {"channels", channels},
                     {"attributes", attributes}};
  return JsonText(json, 2) + "\n";
}

}  // namespace nacre
