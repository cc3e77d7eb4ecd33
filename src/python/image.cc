// SPDX-License-Identifier: Apache-2.0
// python/image.cc: converts images between Python, where all channels are one array, and the public
// API.
#include <algorithm>
#include <cstring>
#include <iterator>
#include <map>

#include <pybind11/stl.h>

#include "python/module.h"

namespace nacre_python {
namespace {

using namespace py::literals;

constexpr const char* kTypes[] = {"half", "float", "uint"};

py::tuple ToTuple(const nacre::Window& w) { return py::make_tuple(w.x0, w.y0, w.x1, w.y1); }

nacre::Window WindowOf(const py::handle& tuple) {
  const auto [x0, y0, x1, y1] = tuple.cast<std::tuple<int, int, int, int>>();
  return {x0, y0, x1, y1};
}

// Whether the window has the width and height of the block of channels.
bool HasSizeOf(const nacre::Window& window, const py::array& block) {
  return int64_t{window.x1} - window.x0 == block.shape(2) &&
         int64_t{window.y1} - window.y0 == block.shape(1);
}

py::array_t<uint8_t> PixelsOf(const nacre::Picture& picture) {
  py::array_t<uint8_t> pixels({picture.height, picture.width, 4});
  std::copy(picture.rgba.begin(), picture.rgba.end(), pixels.mutable_data());
  return pixels;
}

using Bytes = py::array_t<uint8_t, py::array::c_style>;

nacre::Picture PictureOf(const Bytes& pixels) {
  const auto channels = pixels.ndim() == 3 ? pixels.shape(2) : 0;
  if (channels != 3 && channels != 4) {
    throw py::value_error("a picture has the shape (height, width, 3 or 4) and type uint8");
  }
  nacre::Picture picture{static_cast<int>(pixels.shape(1)), static_cast<int>(pixels.shape(0)), {}};
  const auto count = static_cast<size_t>(pixels.shape(0) * pixels.shape(1));
  picture.rgba.resize(4 * count, 255);
  for (size_t i = 0; i < count; ++i) {
    std::memcpy(picture.rgba.data() + 4 * i, pixels.data() + static_cast<size_t>(channels) * i, 3);
  }
  return picture;
}

py::bytes FileOf(const std::vector<uint8_t>& bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

py::dict ToDict(const nacre::LayerMetrics& m) {
  return py::dict("layer"_a = m.layer.empty() ? "beauty" : m.layer, "samples"_a = m.samples,
                  "rmse"_a = m.rmse, "rel_mse"_a = m.rel_mse, "psnr_db"_a = m.psnr_db,
                  "max_abs"_a = m.max_abs, "max_rel"_a = m.max_rel,
                  "zero_mismatches"_a = m.zero_mismatches, "mean"_a = m.mean,
                  "mean_reference"_a = m.mean_reference, "ssim"_a = m.ssim, "flip"_a = m.flip,
                  "hdr_flip"_a = m.hdr_flip);
}

// The rank of a channel within its layer: R, G, B and A, or X, Y and Z.
size_t RankOf(const std::string& channel) {
  const std::string component = channel.substr(channel.rfind('.') + 1);
  const size_t rank = component.size() == 1 ? std::string("RGBAXYZ").find(component[0]) : 0;
  return rank == std::string::npos ? 0 : rank;
}

std::string LayerOf(const std::string& channel) {
  const size_t dot = channel.rfind('.');
  return dot == std::string::npos ? std::string() : channel.substr(0, dot);
}

// Sorts the channels so that those of a layer are adjacent and in the usual order; files sort them
// alphabetically.
void SortChannels(std::vector<nacre::Channel>* channels) {
  std::map<std::string, size_t> layers;
  for (const nacre::Channel& channel : *channels) {
    layers.try_emplace(LayerOf(channel.name), layers.size());
  }
  const auto place = [&](const nacre::Channel& channel) {
    return std::pair(layers.at(LayerOf(channel.name)), RankOf(channel.name));
  };
  std::stable_sort(
      channels->begin(), channels->end(),
      [&](const nacre::Channel& a, const nacre::Channel& b) { return place(a) < place(b); });
}

}  // namespace

py::object ToPython(nacre::Image&& image) {
  SortChannels(&image.channels);
  const auto width = static_cast<size_t>(image.width());
  const auto height = static_cast<size_t>(image.height());
  py::array_t<float> block({image.channels.size(), height, width});
  py::list names, types;
  float* to = block.mutable_data();
  for (nacre::Channel& channel : image.channels) {
    names.append(TextOf(channel.name));
    types.append(kTypes[static_cast<size_t>(channel.type)]);
    const std::vector<float> samples = std::move(channel.samples);
    if (channel.type == nacre::SampleType::kUint) {
      auto* const ids = reinterpret_cast<uint32_t*>(to);
      for (size_t i = 0; i < samples.size(); ++i) ids[i] = static_cast<uint32_t>(samples[i]);
    } else {
      std::copy(samples.begin(), samples.end(), to);
    }
    to += width * height;
  }
  py::dict metadata;
  for (const auto& [key, value] : image.metadata) metadata[TextOf(key)] = TextOf(value);
  return py::module_::import("nacre._image")
      .attr("Image")
      .attr("_of")(block, names, types, ToTuple(image.frame), ToTuple(image.data), metadata);
}

nacre::Image FromPython(const py::object& image) {
  nacre::Image result;
  try {
    result.frame = WindowOf(image.attr("frame"));
    result.data = WindowOf(image.attr("data"));
    for (const auto& [key, value] : image.attr("metadata").cast<py::dict>()) {
      if (!py::isinstance<py::str>(key) || !py::isinstance<py::str>(value)) throw py::cast_error();
      result.metadata[BytesOf(key)] = BytesOf(value);
    }
  } catch (const py::cast_error&) {
    throw py::type_error(
        "an image's frame and data are nacre.Window, and its metadata texts by name");
  }
  const auto block = image.attr("_block").cast<py::array_t<float, py::array::c_style>>();
  std::vector<std::string> names;
  for (const py::handle name : image.attr("_names")) names.push_back(BytesOf(name));
  const auto types = image.attr("_types").cast<std::vector<std::string>>();
  // Users may have changed members of an image, so they are checked against each other.
  const bool is_whole = block.ndim() == 3 && static_cast<size_t>(block.shape(0)) == names.size() &&
                        types.size() == names.size() && HasSizeOf(result.data, block) &&
                        result.frame.x0 <= result.frame.x1 && result.frame.y0 <= result.frame.y1;
  if (!is_whole) {
    throw py::value_error("nacre: the names, types, windows and samples of an image do not fit");
  }
  const size_t count = static_cast<size_t>(block.shape(1) * block.shape(2));
  const float* from = block.data();
  for (size_t i = 0; i < names.size(); ++i, from += count) {
    const auto* const type = std::find(std::begin(kTypes), std::end(kTypes), types[i]);
    if (type == std::end(kTypes)) throw py::value_error("unknown channel type");
    nacre::Channel channel{names[i], static_cast<nacre::SampleType>(type - std::begin(kTypes)),
                           std::vector<float>(count)};
    if (channel.type == nacre::SampleType::kUint) {
      const auto* const ids = reinterpret_cast<const uint32_t*>(from);
      for (size_t k = 0; k < count; ++k) channel.samples[k] = static_cast<float>(ids[k]);
    } else {
      std::copy(from, from + count, channel.samples.begin());
    }
    result.channels.push_back(std::move(channel));
  }
  return result;
}

void BindImages(py::module_* module) {
  module->def("read", [](const std::string& path) {
    return ToPython(Unlocked([&] { return nacre::Read(path); }));
  });
  module->def("write", [](const py::object& image, const std::string& path, bool half_floats,
                          const std::string& compression, bool small, const std::string& tonemap,
                          double exposure) {
    const nacre::Image own = FromPython(image);
    const py::gil_scoped_release release;
    nacre::Write(own, path, {half_floats, compression, small, tonemap, exposure});
  });
  module->def("tone_map", [](const py::object& image, const std::string& layer,
                             const std::string& tonemap, double exposure) {
    const nacre::Image own = FromPython(image);
    return PixelsOf(Unlocked([&] { return nacre::ToneMap(own, {layer, tonemap, exposure}); }));
  });
  module->def("encode_png",
              [](const Bytes& pixels) { return FileOf(nacre::EncodePng(PictureOf(pixels))); });
  module->def("encode_jpeg", [](const Bytes& pixels, int quality) {
    return FileOf(nacre::EncodeJpeg(PictureOf(pixels), quality));
  });
  module->def("heat_map", [](const py::object& image, const py::object& reference,
                             const std::string& layer, bool relative, double low, double high) {
    const nacre::Image got = FromPython(image), expected = FromPython(reference);
    return PixelsOf(Unlocked([&] {
      return nacre::HeatMap(got, expected, {layer, relative, low, high});
    }));
  });
  module->def("compare",
              [](const py::object& image, const py::object& reference,
                 const std::vector<std::string>& layers, double max_abs, double max_rel,
                 double exceeding_fraction, double max_rmse, bool perceptual, bool crop) {
                const nacre::Image got = FromPython(image), expected = FromPython(reference);
                const nacre::Comparison comparison = Unlocked([&] {
                  return nacre::Compare(
                      got, expected,
                      {layers, max_abs, max_rel, exceeding_fraction, max_rmse, perceptual, crop});
                });
                py::list measured;
                for (const nacre::LayerMetrics& layer : comparison.layers)
                  measured.append(ToDict(layer));
                return py::make_tuple(comparison.match, comparison.reason, comparison.pixels,
                                      comparison.exceeding_pixels, measured);
              });
}

}  // namespace nacre_python
