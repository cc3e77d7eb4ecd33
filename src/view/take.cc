// SPDX-License-Identifier: Apache-2.0
#include "view/take.h"

#include "image_io/exr_writer.h"
#include "output/metadata.h"

namespace nacre {

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
