// SPDX-License-Identifier: Apache-2.0
#include "view/answer.h"

#include <cmath>
#include <exception>
#include <new>

#include "base/cancel.h"
#include "base/printable.h"
#include "compare/metrics.h"
#include "compare/perceptual.h"
#include "image_io/exr_writer.h"
#include "output/metadata.h"

namespace nacre {

std::string FaultMessage(const std::string& pointer, const Error& error) {
  Json faults = Json::array();
  for (const Fault& fault : error.faults()) {
    faults.push_back({{"where", Printable(fault.where)},
                      {"what", Printable(fault.what)},
                      {"hint", Printable(fault.hint)}});
  }
  return JsonText({{"fault", pointer}, {"faults", std::move(faults)}});
}

std::string CaughtFault(const std::string& pointer) {
  try {
    throw;
  } catch (const Error& error) {
    return FaultMessage(pointer, error);
  } catch (const Cancelled&) {
    return FaultMessage(pointer, Error(ExitCode::kUsage, "", "the scene has changed meanwhile",
                                       "ask for it again"));
  } catch (const std::bad_alloc&) {
    return FaultMessage(pointer, Error(ExitCode::kInternal, "", "out of memory",
                                       "a smaller picture or scene needs less"));
  } catch (const std::exception& error) {
    return FaultMessage(pointer, Error(ExitCode::kInternal, "", error.what()));
  }
}

Json BeautyMetricsJson(const Image& got, const Image& reference, const DisplaySettings& display) {
  CompareOptions options;
  options.layers = {""};
  const ImagePair pair = PairImages(got, reference, options);
  const LayerMetrics metrics = CompareLayer(pair, pair.layers.front());
  Json json = {{"rmse", metrics.rmse},
               {"rel_mse", metrics.rel_mse},
               // JSON has no infinity, which is the PSNR of equal pictures.
               {"psnr_db", std::isfinite(metrics.psnr_db) ? Json(metrics.psnr_db) : Json()},
               {"max_abs", std::isfinite(metrics.max_abs) ? Json(metrics.max_abs) : Json()},
               {"max_abs_at", {metrics.max_abs_at.x, metrics.max_abs_at.y}}};
  PerceptualOptions perceptual;
  perceptual.hdr_flip = false;  // takes seconds
  perceptual.display = display;
  for (const PerceptualMetrics& seen : MeasurePerceptual(got, reference, perceptual, options)) {
    if (seen.ssim) json["ssim"] = *seen.ssim;
    if (seen.flip_mean) json["flip"] = *seen.flip_mean;
  }
  return json;
}

std::vector<uint8_t> RenderExr(const FramePlan& plan, const RenderSettings& settings) {
  ExrHeader header = MakeExrHeader(plan, /*reproducible=*/true);
  for (const ChannelSpec& channel : StripChannels(plan.film.layers, PixelType::kHalf)) {
    header.channels.push_back({channel.name, channel.type});
  }
  std::vector<uint8_t> bytes;
  ExrWriter writer(&bytes, header, {.reproducible = true});
  Render(plan, settings, [&](const Strip& strip) {
    StripView view{strip.window.y0, strip.window.height(), {}};
    for (const auto& plane : strip.colors) view.channels.emplace_back(plane.data());
    for (const auto& plane : strip.ids) view.channels.emplace_back(plane.data());
    writer.WriteStrip(view);
  });
  writer.Finish();
  return bytes;
}

}  // namespace nacre
