// SPDX-License-Identifier: Apache-2.0
#include "compare/layers.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "base/error.h"
#include "base/excerpt.h"
#include "color/primaries.h"

namespace nacre {
namespace {

bool IsWanted(const std::string& layer, const CompareOptions& options) {
  return options.layers.empty() ||
         std::find(options.layers.begin(), options.layers.end(), layer) != options.layers.end();
}

// Throws if `image` lacks a channel of `other` that is to be compared.
void RequireChannels(const Image& image, const std::string& name, const Image& other,
                     const std::string& other_name, const CompareOptions& options) {
  for (const Channel& channel : other.channels) {
    if (!IsWanted(LayerOfChannel(channel.name), options) || image.Find(channel.name)) continue;
    throw Error(ExitCode::kCannotCompare, name,
                fmt::format("has no channel {}, which {} has", channel.name, other_name),
                "name the layers to compare");
  }
}

void RequireLayers(const Image& reference, const CompareOptions& options) {
  for (const std::string& layer : options.layers) {
    const auto has_layer = [&](const Channel& c) { return LayerOfChannel(c.name) == layer; };
    if (std::any_of(reference.channels.begin(), reference.channels.end(), has_layer)) continue;
    throw Error(ExitCode::kCannotCompare, options.reference_name,
                layer.empty() ? "has no R, G or B" : "has no layer " + layer);
  }
}

// Samples with different primaries cannot be compared. Missing or invalid primaries are taken for
// Rec. 709's.
void RequireSamePrimaries(const Image& got, const Image& reference, const CompareOptions& options) {
  const auto text = [](const Image& image) {
    const auto found = image.metadata.find("chromaticities");
    return found != image.metadata.end() && ParsePrimaries(found->second)
               ? found->second
               : std::string(kRec709Primaries);
  };
  const std::string a = text(got), b = text(reference);
  if (SamePrimaries(*ParsePrimaries(a), *ParsePrimaries(b))) return;
  throw Error(ExitCode::kCannotCompare, options.got_name,
              fmt::format("its primaries are {}, those of {} {}", Excerpt(a),
                          options.reference_name, Excerpt(b)),
              "convert one of them first");
}

}  // namespace

std::string LayerOfChannel(const std::string& channel) {
  const size_t dot = channel.rfind('.');
  if (dot != std::string::npos) return channel.substr(0, dot);
  return channel == "R" || channel == "G" || channel == "B" ? "" : channel;
}

ImagePair PairImages(const Image& got, const Image& reference, const CompareOptions& options) {
  const Window& a = got.display;
  const Window& b = reference.display;
  if (!options.sizes_may_differ && (a.width() != b.width() || a.height() != b.height())) {
    throw Error(ExitCode::kCannotCompare, options.got_name,
                fmt::format("is {}x{}, but {} is {}x{}", a.width(), a.height(),
                            options.reference_name, b.width(), b.height()));
  }
  RequireSamePrimaries(got, reference, options);
  RequireLayers(reference, options);
  RequireChannels(got, options.got_name, reference, options.reference_name, options);
  RequireChannels(reference, options.reference_name, got, options.got_name, options);
  if (reference.channels.empty()) {
    throw Error(ExitCode::kCannotCompare, options.reference_name, "has no channels");
  }
  ImagePair pair;
  pair.window = Intersect(got.data, reference.data);
  if (pair.window.empty()) {
    throw Error(ExitCode::kCannotCompare, options.got_name,
                "has no pixel in common with " + options.reference_name);
  }
  const size_t got_first = IndexIn(got.data, pair.window.x0, pair.window.y0);
  const size_t reference_first = IndexIn(reference.data, pair.window.x0, pair.window.y0);
  pair.got_stride = static_cast<size_t>(got.data.width());
  pair.reference_stride = static_cast<size_t>(reference.data.width());
  for (const Channel& channel : reference.channels) {
    const std::string layer = LayerOfChannel(channel.name);
    if (!IsWanted(layer, options)) continue;
    auto found = std::ranges::find(pair.layers, layer, &LayerPair::layer);
    if (found == pair.layers.end()) found = pair.layers.insert(found, {layer, {}});
    found->channels.push_back({channel.name, got.Find(channel.name)->samples.data() + got_first,
                               channel.samples.data() + reference_first});
  }
  return pair;
}

double SampleError(float got, float reference) {
  if (std::isfinite(got) && std::isfinite(reference)) {
    return std::abs(static_cast<double>(got) - reference);
  }
  const bool same = got == reference || (std::isnan(got) && std::isnan(reference));
  return same ? 0 : std::numeric_limits<double>::infinity();
}

double RelativeError(double error, float reference) {
  if (error == 0) return 0;
  return error / std::abs(static_cast<double>(reference));
}

double SoftenedError(double error, float reference) {
  if (error == 0) return 0;
  return error / std::hypot(static_cast<double>(reference), kDarkReference);
}

}  // namespace nacre
