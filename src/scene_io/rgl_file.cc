// SPDX-License-Identifier: Apache-2.0
#include "scene_io/rgl_file.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <map>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/error.h"
#include "base/excerpt.h"
#include "brdf/visible_spectrum.h"

namespace nacre {
namespace {

constexpr std::string_view kTensorMagic("tensor_file\0", 12);
constexpr const char* kRglHint = "is it a .bsdf of EPFL's material database, whole?";

// The types of numbers that arrays may have, by their number in the file.
struct TensorType {
  const char* name;
  size_t bytes;
};
constexpr std::array<TensorType, 12> kTensorTypes = {{{"none", 0},
                                                      {"uint8", 1},
                                                      {"int8", 1},
                                                      {"uint16", 2},
                                                      {"int16", 2},
                                                      {"uint32", 4},
                                                      {"int32", 4},
                                                      {"uint64", 8},
                                                      {"int64", 8},
                                                      {"float16", 2},
                                                      {"float32", 4},
                                                      {"float64", 8}}};
constexpr size_t kTensorUint8 = 1, kTensorFloat32 = 10, kTensorFloat64 = 11;

// An array of the file.
struct Tensor {
  size_t type = 0;
  std::vector<uint64_t> shape;  // the last dimension varies fastest
  std::string_view data;

  size_t count() const { return data.size() / kTensorTypes[type].bytes; }
};

// Reads the header from the front to the back. The host is little-endian, as files are.
class TensorFile {
 public:
  TensorFile(std::string_view bytes, const std::string& file) : bytes_(bytes), file_(file) {
    if (!IsTensorFile(bytes)) Refuse("is not a list of arrays (\"tensor_file\")");
    at_ = kTensorMagic.size();
    const auto major = Take<uint8_t>(), minor = Take<uint8_t>();
    if (major != 1 || minor != 0) {
      Refuse(fmt::format("is of version {}.{} of the format, not 1.0", major, minor));
    }
    const auto fields = Take<uint32_t>();
    constexpr uint32_t kMostFields = 64;
    if (fields > kMostFields) Refuse(fmt::format("has {} arrays: {} at most", fields, kMostFields));
    for (uint32_t i = 0; i < fields; ++i) TakeTensor();
  }

  [[noreturn]] void Refuse(std::string what, std::string hint = kRglHint) const {
    throw Error(ExitCode::kBadInput, file_, std::move(what), std::move(hint));
  }

  const Tensor* Find(const std::string& name) const {
    const auto found = tensors_.find(name);
    return found != tensors_.end() ? &found->second : nullptr;
  }

  // The array of this name, which must have so many dimensions.
  const Tensor& Require(const std::string& name, size_t dimensions) const {
    const Tensor* const tensor = Find(name);
    if (tensor == nullptr) Refuse(fmt::format("has no array \"{}\"", name));
    if (tensor->shape.size() != dimensions) {
      Refuse(
          fmt::format("\"{}\" has {} dimensions, not {}", name, tensor->shape.size(), dimensions));
    }
    return *tensor;
  }

  // Numbers [first, first + count) of the array.
  std::vector<float> Floats(const std::string& name, const Tensor& tensor, size_t first,
                            size_t count, bool may_be_negative = false) const {
    if (tensor.type != kTensorFloat32 && tensor.type != kTensorFloat64) {
      Refuse(fmt::format("\"{}\" is of {}, not of float32 or float64", name,
                         kTensorTypes[tensor.type].name));
    }
    std::vector<float> values(count);
    for (size_t i = 0; i < count; ++i) {
      double value = 0;
      if (tensor.type == kTensorFloat32) {
        float stored;
        std::memcpy(&stored, tensor.data.data() + 4 * (first + i), sizeof(stored));
        value = stored;
      } else {
        std::memcpy(&value, tensor.data.data() + 8 * (first + i), sizeof(value));
      }
      // Products of them stay finite in float.
      constexpr double kMost = 1e9;
      if (!(std::abs(value) <= kMost) || (value < 0 && !may_be_negative)) {
        Refuse(fmt::format("\"{}\" has the number {} at {}", name, value, Place(tensor, first + i)),
               may_be_negative ? "numbers are finite, and at most 1e9"
                               : "numbers are finite, at most 1e9, and not negative");
      }
      values[i] = static_cast<float>(value);
    }
    return values;
  }
  std::vector<float> Floats(const std::string& name, const Tensor& tensor,
                            bool may_be_negative = false) const {
    return Floats(name, tensor, 0, tensor.count(), may_be_negative);
  }

 private:
  // The indices of a number.
  static std::string Place(const Tensor& tensor, size_t i) {
    std::vector<uint64_t> place(tensor.shape.size());
    for (size_t k = place.size(); k-- > 0;) {
      place[k] = i % tensor.shape[k];
      i /= tensor.shape[k];
    }
    return fmt::format("[{}]", fmt::join(place, ", "));
  }

  template <class Number>
  Number Take() {
    if (bytes_.size() - at_ < sizeof(Number)) Refuse("ends in its header");
    Number number;
    std::memcpy(&number, bytes_.data() + at_, sizeof(Number));
    at_ += sizeof(Number);
    return number;
  }

  void TakeTensor() {
    const auto length = Take<uint16_t>();
    if (bytes_.size() - at_ < length) Refuse("ends in its header");
    const std::string name(bytes_.substr(at_, length));
    at_ += length;
    const auto dimensions = Take<uint16_t>();
    const auto type = Take<uint8_t>();
    const auto offset = Take<uint64_t>();
    constexpr uint16_t kMostDimensions = 8;
    if (dimensions > kMostDimensions) {
      Refuse(fmt::format("\"{}\" has {} dimensions: {} at most", Excerpt(name), dimensions,
                         kMostDimensions));
    }
    if (type == 0 || type >= kTensorTypes.size()) {
      Refuse(fmt::format("\"{}\" is of the unknown type {}", Excerpt(name), type));
    }
    Tensor tensor{type, {}, {}};
    uint64_t size = kTensorTypes[type].bytes;
    for (uint16_t i = 0; i < dimensions; ++i) {
      const auto extent = Take<uint64_t>();
      tensor.shape.push_back(extent);
      if (extent == 0) Refuse(fmt::format("\"{}\" is empty", Excerpt(name)));
      // Before the product: it may need more than 64 bits.
      if (extent > bytes_.size() || size * extent > bytes_.size()) {
        Refuse(fmt::format("\"{}\" is larger than the file: it is damaged or incomplete",
                           Excerpt(name)));
      }
      size *= extent;
    }
    if (offset > bytes_.size() || size > bytes_.size() - offset) {
      Refuse(fmt::format("\"{}\" reaches beyond the end of the file: it is damaged or incomplete",
                         Excerpt(name)));
    }
    tensor.data = bytes_.substr(offset, size);
    if (!tensors_.emplace(name, std::move(tensor)).second) {
      Refuse(fmt::format("has two arrays \"{}\"", Excerpt(name)));
    }
  }

  std::string_view bytes_;
  const std::string& file_;
  size_t at_ = 0;
  std::map<std::string, Tensor> tensors_;
};

// Ascending angles, at most `most`.
std::vector<float> ReadAngles(const TensorFile& file, const std::string& name, double least,
                              double most, size_t at_least) {
  std::vector<float> angles = file.Floats(name, file.Require(name, 1), true);
  if (angles.size() < at_least) {
    file.Refuse(fmt::format("\"{}\" has {} angles, too few to interpolate", name, angles.size()));
  }
  constexpr double kRounding = 1e-4;
  for (size_t i = 0; i < angles.size(); ++i) {
    if (angles[i] < least - kRounding || angles[i] > most + kRounding ||
        (i > 0 && !(angles[i] > angles[i - 1]))) {
      file.Refuse(fmt::format("\"{}\" has the angle {} at [{}]", name, angles[i], i),
                  fmt::format("angles ascend, from {:.4g} to {:.4g} radians", least, most));
    }
  }
  return angles;
}

SquareTable ReadSquare(const TensorFile& file, const std::string& name) {
  const Tensor& tensor = file.Require(name, 2);
  if (tensor.shape[0] < 2 || tensor.shape[1] < 2) {
    file.Refuse(fmt::format("\"{}\" has {} x {} nodes, too few to interpolate", name,
                            tensor.shape[0], tensor.shape[1]));
  }
  return {tensor.shape[1], tensor.shape[0], file.Floats(name, tensor)};
}

// Checks that the first dimensions are those of the viewer's angles and the last two those of a
// square, and returns how many numbers there are for the azimuths that are read.
size_t CheckSlices(const TensorFile& file, const std::string& name, const Tensor& tensor,
                   size_t phis, const SliceAngles& angles) {
  const auto& shape = tensor.shape;
  if (shape[0] != phis || shape[1] != angles.theta.size()) {
    file.Refuse(
        fmt::format("\"{}\" is of {} x {} directions, not of the {} x {} of phi_i and "
                    "theta_i",
                    name, shape[0], shape[1], phis, angles.theta.size()));
  }
  const size_t last = shape.size() - 1;
  if (shape[last] < 2 || shape[last - 1] < 2) {
    file.Refuse(fmt::format("\"{}\" has {} x {} nodes, too few to interpolate", name,
                            shape[last - 1], shape[last]));
  }
  return tensor.count() / phis * angles.phi.size();
}

TabulatedWarp ReadWarp(const TensorFile& file, const std::string& name, size_t phis,
                       const SliceAngles& angles) {
  const Tensor& tensor = file.Require(name, 4);
  const size_t count = CheckSlices(file, name, tensor, phis, angles);
  return MakeTabulatedWarp(angles, tensor.shape[3], tensor.shape[2],
                           file.Floats(name, tensor, 0, count));
}

// What each wavelength of a spectrum adds to the channels of Rec. 709: the spectrum is linear
// between its wavelengths and constant beyond them.
std::vector<Rgb> WeighWavelengths(const std::vector<float>& wavelengths) {
  std::vector<Rgb> weights(wavelengths.size(), Rgb(0, 0, 0));
  Rgb total(0, 0, 0);
  for (double nm = kShortestWavelength; nm <= kLongestWavelength; ++nm) {
    const Rgb seen = ChannelSensitivity(Illuminant::kD65, nm);
    const BetweenNodes at = FindAngle(wavelengths, nm);
    weights[at.index] += seen * (1 - at.fraction);
    if (at.fraction > 0) weights[at.index + 1] += seen * at.fraction;
    total += seen;
  }
  for (Rgb& weight : weights) weight = MakeRgb([&](int c) { return weight[c] / total[c]; });
  return weights;
}

// The table of colours, from "rgb" or from "spectra".
void ReadTensorColors(const TensorFile& file, size_t phis, const SliceAngles& angles,
                      RglTable* table) {
  const bool is_rgb = file.Find("rgb") != nullptr;
  const std::string name = is_rgb ? "rgb" : "spectra";
  if (!is_rgb && file.Find(name) == nullptr) {
    file.Refuse("has neither an array \"rgb\" nor \"spectra\"");
  }
  const Tensor& tensor = file.Require(name, 5);
  const size_t count = CheckSlices(file, name, tensor, phis, angles);
  if (tensor.shape[3] != tensor.shape[4]) {
    file.Refuse(fmt::format("\"{}\" has {} x {} nodes, which are no square", name, tensor.shape[3],
                            tensor.shape[4]));
  }
  const size_t bands = tensor.shape[2], nodes = tensor.shape[3] * tensor.shape[4];
  table->size = tensor.shape[3];
  const size_t slices = angles.count();
  table->rgb.resize(slices * 3 * nodes);
  std::vector<Rgb> weights;
  if (is_rgb) {
    if (bands != 3) file.Refuse(fmt::format("\"rgb\" has {} channels, not 3", bands));
  } else {
    const std::vector<float> nm = ReadAngles(file, "wavelengths", 1, 1e5, 1);
    if (nm.size() != bands) {
      file.Refuse(
          fmt::format("\"spectra\" has {} wavelengths, \"wavelengths\" {}", bands, nm.size()));
    }
    weights = WeighWavelengths(nm);
  }
  const size_t of_slice = count / slices;
  std::vector<double> sums(3 * nodes);
  for (size_t s = 0; s < slices; ++s) {
    const std::vector<float> values = file.Floats(name, tensor, s * of_slice, of_slice, true);
    std::fill(sums.begin(), sums.end(), 0.0);
    for (size_t band = 0; band < bands; ++band) {
      for (size_t c = 0; c < 3; ++c) {
        const double weight = is_rgb ? (band == c ? 1.0 : 0.0) : weights[band][static_cast<int>(c)];
        if (weight == 0) continue;
        for (size_t k = 0; k < nodes; ++k) {
          sums[c * nodes + k] += weight * double{values[band * nodes + k]};
        }
      }
    }
    for (size_t k = 0; k < 3 * nodes; ++k) {
      table->rgb[s * 3 * nodes + k] = static_cast<float>(std::max(sums[k], 0.0));
    }
  }
}

// Over how much of the circle azimuths go.
int ReductionOf(const TensorFile& file, const std::vector<float>& phi) {
  const double range = double{phi.back()} - double{phi.front()};
  const double turns = std::rint(2 * M_PI / range);
  if (turns == 1 || turns == 2 || turns == 4) return static_cast<int>(turns);
  file.Refuse(fmt::format("\"phi_i\" covers {:.4g} radians", range),
              "azimuths cover the circle, a half or a quarter of it");
}

}  // namespace

bool IsTensorFile(std::string_view head) { return head.starts_with(kTensorMagic); }

MeasuredBrdf ReadRgl(std::string_view bytes, const std::string& file_name) {
  const TensorFile file(bytes, file_name);
  MeasuredBrdf brdf;
  SliceAngles angles;
  angles.theta = ReadAngles(file, "theta_i", 0, M_PI_2, 2);
  angles.phi = ReadAngles(file, "phi_i", -M_PI, M_PI, 1);
  const size_t phis = angles.phi.size();
  brdf.isotropic = phis <= 2;
  if (brdf.isotropic) {
    angles.phi.resize(1);
  } else {
    brdf.reduction = ReductionOf(file, angles.phi);
  }
  RglTable table;
  if (const Tensor* const jacobian = file.Find("jacobian")) {
    if (jacobian->type != kTensorUint8 || jacobian->count() != 1) {
      file.Refuse("\"jacobian\" is not one number of uint8");
    }
    table.jacobian = jacobian->data[0] != 0;
  }
  table.ndf = ReadSquare(file, "ndf");
  table.sigma = ReadSquare(file, "sigma");
  for (float& area : table.sigma.values) {
    if (area < 1e-9f) area = 0;  // nothing is reflected there, and nothing is divided by it
  }
  brdf.half = ReadWarp(file, "vndf", phis, angles);
  if (file.Find("luminance") != nullptr) {
    brdf.luminance = ReadWarp(file, "luminance", phis, angles);
  }
  ReadTensorColors(file, phis, angles, &table);
  if (const Tensor* const text = file.Find("description");
      text != nullptr && text->type == kTensorUint8) {
    brdf.description = Excerpt(text->data);
  }
  brdf.table = std::move(table);
  return brdf;
}

}  // namespace nacre
