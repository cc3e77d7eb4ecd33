// SPDX-License-Identifier: Apache-2.0
#include "report/picture.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string_view>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "compare/layers.h"
#include "image_io/half.h"

namespace nacre {
namespace {

using Json = nlohmann::ordered_json;

int FloorDivide(int a, int b) { return a / b - (a % b < 0 ? 1 : 0); }

// The cells of factor x factor pixels, counted from the frame's corner, that `window` touches.
Window CellsOf(const Window& window, int factor) {
  return {FloorDivide(window.x0, factor), FloorDivide(window.y0, factor),
          FloorDivide(window.x1 - 1, factor) + 1, FloorDivide(window.y1 - 1, factor) + 1};
}

// The mean of the image's samples in a cell, computed in double; for ids, the middle pixel's value.
float CellValue(const float* samples, const Window& window, int cell_x, int cell_y, int factor,
                bool is_id) {
  const Window cell = Intersect(
      window, {cell_x * factor, cell_y * factor, (cell_x + 1) * factor, (cell_y + 1) * factor});
  const auto at = [&](int x, int y) { return samples[IndexIn(window, x, y)]; };
  if (is_id) return at((cell.x0 + cell.x1) / 2, (cell.y0 + cell.y1) / 2);
  double sum = 0;
  for (int y = cell.y0; y < cell.y1; ++y) {
    for (int x = cell.x0; x < cell.x1; ++x) sum += at(x, y);
  }
  return static_cast<float>(sum / static_cast<double>(cell.pixel_count()));
}

std::vector<float> Shrink(const std::vector<float>& samples, const Window& window, int factor,
                          bool is_id) {
  if (factor == 1) return samples;
  const Window cells = CellsOf(window, factor);
  std::vector<float> out;
  out.reserve(cells.pixel_count());
  for (int y = cells.y0; y < cells.y1; ++y) {
    for (int x = cells.x0; x < cells.x1; ++x) {
      out.push_back(CellValue(samples.data(), window, x, y, factor, is_id));
    }
  }
  return out;
}

// Separates the bytes of words, all lowest ones first, then the next ones. The high bytes of
// neighbours are similar, so this deflates better.
template <class Word>
std::vector<uint8_t> SplitBytes(const std::vector<Word>& words) {
  std::vector<uint8_t> bytes(words.size() * sizeof(Word));
  for (size_t i = 0; i < words.size(); ++i) {
    for (size_t b = 0; b < sizeof(Word); ++b) {
      bytes[b * words.size() + i] = static_cast<uint8_t>(words[i] >> (8 * b));
    }
  }
  return bytes;
}

bool WantsHalf(const Channel& channel, const Packing& packing) {
  return channel.type == PixelType::kHalf || (packing.half && channel.type == PixelType::kFloat);
}

Json PackChannel(const Channel& channel, const Window& window, const Packing& packing, Page* page) {
  const std::vector<float> samples =
      Shrink(channel.samples, window, packing.factor, channel.type == PixelType::kUint);
  Json json = {{"name", channel.name.substr(channel.name.rfind('.') + 1)}};
  if (WantsHalf(channel, packing)) {
    std::vector<uint16_t> halves(samples.size());
    const SampleCounts counts = FloatToHalf(samples.data(), samples.size(), halves.data());
    if (counts.clamped == 0 && counts.infinite == 0) {
      json["type"] = "half";
      json["blob"] = page->AddBlob(SplitBytes(halves));
      return json;
    }
  }
  std::vector<uint32_t> words(samples.size());
  std::memcpy(words.data(), samples.data(), words.size() * sizeof(uint32_t));
  json["type"] = "float";
  json["blob"] = page->AddBlob(SplitBytes(words));
  return json;
}

// How the page draws the layer.
std::string KindOf(const std::string& layer, const std::vector<const Channel*>& channels) {
  if (channels.size() == 3 && channels[0]->name.ends_with('R')) return "color";
  if (layer == "N" && channels.size() == 3) return "normal";
  return channels[0]->type == PixelType::kUint ? "id" : "data";
}

struct LayerChannels {
  std::string name;
  std::vector<const Channel*> channels;
};

// The layers of an image, with the beauty first.
std::vector<LayerChannels> LayersOf(const Image& image) {
  std::vector<LayerChannels> layers;
  for (const Channel& channel : image.channels) {
    // Ids of objects and of materials are layers of their own, as they are not parts of one colour.
    const std::string name =
        channel.type == PixelType::kUint ? channel.name : LayerOfChannel(channel.name);
    auto found = std::ranges::find(layers, name, &LayerChannels::name);
    if (found == layers.end()) found = layers.insert(found, {name, {}});
    found->channels.push_back(&channel);
  }
  // R, G, B and X, Y, Z come in that order, instead of EXR's alphabetical order, and others (npos)
  // last.
  const auto place = [](const Channel* c) {
    return std::string_view("RGBXYZ").find(c->name.back());
  };
  for (LayerChannels& layer : layers) std::ranges::stable_sort(layer.channels, {}, place);
  std::stable_partition(layers.begin(), layers.end(),
                        [](const LayerChannels& l) { return l.name.empty(); });
  return layers;
}

void AddPlace(const Window& data, const Window& display, int factor, Json* json) {
  const Window cells = CellsOf(FromCorner(data, display), factor);
  (*json)["x0"] = cells.x0;
  (*json)["y0"] = cells.y0;
  (*json)["width"] = cells.width();
  (*json)["height"] = cells.height();
}

size_t BytesOf(const Image& image, const Packing& packing) {
  const size_t cells = CellsOf(image.data, packing.factor).pixel_count();
  size_t bytes = 0;
  for (const Channel& channel : image.channels)
    bytes += cells * (WantsHalf(channel, packing) ? 2 : 4);
  return bytes;
}

}  // namespace

std::string Packing::InWords() const {
  std::string text;
  if (half) text = "32-bit floats are shown as halves, of 11 significant bits";
  if (factor > 1) {
    text += fmt::format("{}each pixel shown is the mean of {}x{} pixels of the picture",
                        text.empty() ? "" : ", and ", factor, factor);
  }
  return text;
}

Window FromCorner(const Window& window, const Window& display) {
  return {window.x0 - display.x0, window.y0 - display.y0, window.x1 - display.x0,
          window.y1 - display.y0};
}

Packing ChoosePacking(const std::vector<const Image*>& images, size_t limit) {
  Packing packing;
  const auto fits = [&] {
    size_t bytes = 0;
    for (const Image* image : images) bytes += BytesOf(*image, packing);
    return bytes <= limit;
  };
  if (fits()) return packing;
  packing.half = true;
  // This ends, since a picture of one cell always fits: any limit is larger than the number of
  // channels.
  while (!fits() && packing.factor < 65536) ++packing.factor;
  return packing;
}

Json PackImage(const Image& image, const std::string& name, const Packing& packing, Page* page) {
  Json json = {{"name", name}, {"factor", packing.factor}};
  AddPlace(image.data, image.display, packing.factor, &json);
  const auto transfer = image.metadata.find("transfer");
  json["transfer"] = transfer == image.metadata.end() ? "linear" : transfer->second;
  const Window moved = FromCorner(image.data, image.display);
  Json layers = Json::array();
  for (const LayerChannels& layer : LayersOf(image)) {
    Json channels = Json::array();
    for (const Channel* channel : layer.channels) {
      channels.push_back(PackChannel(*channel, moved, packing, page));
    }
    layers.push_back({{"name", layer.name},
                      {"kind", KindOf(layer.name, layer.channels)},
                      {"channels", channels}});
  }
  json["layers"] = layers;
  Json facts = Json::array();
  for (const auto& [key, value] : image.metadata) facts.push_back({key, value});
  json["facts"] = facts;
  return json;
}

Json PackMap(const Plane& map, const Window& window, const std::string& kind,
             const std::string& layer, const Packing& packing, Page* page) {
  std::vector<uint8_t> bytes;
  const std::vector<float> shown = Shrink(map.values, window, packing.factor, /*is_id=*/false);
  bytes.reserve(shown.size());
  for (const float value : shown) {
    bytes.push_back(static_cast<uint8_t>(std::lround(255 * std::clamp(value, 0.0f, 1.0f))));
  }
  Json json = {{"kind", kind}, {"layer", layer}, {"type", "byte"}, {"blob", page->AddBlob(bytes)}};
  AddPlace(window, {}, packing.factor, &json);
  return json;
}

}  // namespace nacre
