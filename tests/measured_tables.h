// SPDX-License-Identifier: Apache-2.0
// tests/measured_tables.h: measured BRDFs without a database: tables of analytic models, and of
// random numbers, and the bytes of files that have them.
#pragma once

#include <cstring>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "brdf/fresnel.h"
#include "brdf/ggx.h"
#include "brdf/measured.h"

namespace nacre {

// Light and viewer at the centre of a cell, the half vector at azimuth 0.
inline std::pair<Vec3d, Vec3d> MerlDirections(size_t half, size_t diff, size_t phi) {
  const double root = (static_cast<double>(half) + 0.5) / MerlTable::kThetaHalf;
  const double theta_half = root * root * M_PI_2;
  const double theta_diff = (static_cast<double>(diff) + 0.5) / MerlTable::kThetaDiff * M_PI_2;
  const double phi_diff = (static_cast<double>(phi) + 0.5) / MerlTable::kPhiDiff * M_PI;
  const Vec3d h(std::sin(theta_half), 0, std::cos(theta_half));
  const Vec3d along(h.z, 0, -h.x), across(0, 1, 0);
  const Vec3d l = h * std::cos(theta_diff) +
                  (along * std::cos(phi_diff) + across * std::sin(phi_diff)) * std::sin(theta_diff);
  return {l, Mirrored(l, h)};
}

// A table of f(n, l, v); black where a direction is below the surface.
template <class Function>
MerlTable MakeMerlTable(const Function& f) {
  MerlTable table;
  table.rgb.resize(3 * MerlTable::kCells);
  for (size_t i = 0; i < MerlTable::kThetaHalf; ++i) {
    for (size_t j = 0; j < MerlTable::kThetaDiff; ++j) {
      for (size_t k = 0; k < MerlTable::kPhiDiff; ++k) {
        const auto [l, v] = MerlDirections(i, j, k);
        if (!(l.z > 0) || !(v.z > 0)) continue;
        const Rgb value = f(Vec3d(0, 0, 1), l, v);
        for (int c = 0; c < 3; ++c) {
          table.rgb[3 * MerlCell(i, j, k) + static_cast<size_t>(c)] = static_cast<float>(value[c]);
        }
      }
    }
  }
  return table;
}

// A rough gold over a base: GGX with Schlick's Fresnel term, height-correlated Smith, and Lambert.
struct AnalyticGgx {
  Rgb f0{1, 0.77, 0.34};
  double alpha = 0.2;
  double diffuse = 0;

  Rgb operator()(const Vec3d& n, const Vec3d& l, const Vec3d& v) const {
    const Angles<double> a = ComputeAngles(n, l, v);
    const double lobe =
        GgxDistribution(a, alpha) * VisibilityHeightCorrelated(a.n_dot_l, a.n_dot_v, alpha);
    const double edge = Power5(1 - std::sqrt(a.u_squared) / 2);
    return MakeRgb([&](int c) { return diffuse / M_PI + lobe * (f0[c] + (1 - f0[c]) * edge); });
  }
};

inline MeasuredBrdf AnalyticMerl(const AnalyticGgx& f = {}) {
  MeasuredBrdf brdf;
  brdf.table = MakeMerlTable(f);
  FinishMeasured(&brdf);
  return brdf;
}

// An array of a file of EPFL's.
struct TensorField {
  std::string name;
  std::vector<uint64_t> shape;
  std::vector<float> values;
};

// Random tables of the form of an .bsdf: angles at unequal steps, tables of unequal sizes.
struct RandomRgl {
  std::vector<float> theta{0, 0.2f, 0.7f, 1.55f}, phi{0};
  std::vector<TensorField> fields;

  // `phis` azimuths over 2 pi / reduction, or 1.
  explicit RandomRgl(uint32_t seed, size_t phis = 1, int reduction = 1) {
    std::mt19937 random(seed);
    for (size_t p = 1; p < phis; ++p) phi.push_back(static_cast<float>(p));
    for (size_t p = 0; p < phis && phis > 1; ++p) {
      const double t = static_cast<double>(p) / static_cast<double>(phis - 1);
      phi[p] = static_cast<float>(-M_PI + 2 * M_PI / reduction * t);
    }
    const uint64_t p = phi.size(), t = theta.size();
    Add("theta_i", {t}, theta);
    Add("phi_i", {p}, phi);
    const auto add = [&](const char* name, std::vector<uint64_t> shape) {
      uint64_t count = 1;
      for (const uint64_t n : shape) count *= n;
      std::vector<float> values(count);
      for (float& value : values) {
        value = 0.25f + 0.75f * static_cast<float>(random() >> 8) * 0x1p-24f;
      }
      if (std::string(name) == "vndf") AsVisible(&values);
      Add(name, std::move(shape), std::move(values));
    };
    add("ndf", {4, 9});
    add("sigma", {3, 5});
    add("vndf", {p, t, 6, 8});
    add("luminance", {p, t, 7, 7});
    add("rgb", {p, t, 3, 7, 7});
  }

  // Densities as those of visible normals, whose pdf per solid angle is finite: 0 around the
  // normal, where the square has no area, and where half vectors face away from the viewer.
  void AsVisible(std::vector<float>* vndf) const {
    for (size_t k = 0; k < vndf->size(); ++k) {
      const size_t i = k % 8, j = k / 8 % 6, t = k / 48 % theta.size(), p = k / 48 / theta.size();
      const double x = static_cast<double>(i) / 7, y = static_cast<double>(j) / 5;
      const double theta_m = x * x * M_PI_2, phi_m = (2 * y - 1) * M_PI;
      const double v_dot_m = std::sin(theta_m) * std::sin(theta[t]) * std::cos(phi_m - phi[p]) +
                             std::cos(theta_m) * std::cos(theta[t]);
      (*vndf)[k] *= i < 2 ? 0.0f : static_cast<float>(std::max(v_dot_m, 0.0));
    }
  }

  void Add(const char* name, std::vector<uint64_t> shape, std::vector<float> values) {
    fields.push_back({name, std::move(shape), std::move(values)});
  }
  TensorField& At(const std::string& name) {
    for (TensorField& field : fields) {
      if (field.name == name) return field;
    }
    return fields.front();
  }
};

// What a reader makes of the file.
inline MeasuredBrdf MakeRglBrdf(const RandomRgl& of, int reduction = 1) {
  MeasuredBrdf brdf;
  brdf.isotropic = of.phi.size() <= 2;
  brdf.reduction = reduction;
  const auto field = [&](const char* name) { return const_cast<RandomRgl&>(of).At(name); };
  const auto square = [&](const char* name) {
    const TensorField from = field(name);
    return SquareTable{from.shape[1], from.shape[0], from.values};
  };
  const auto warp = [&](const char* name) {
    const TensorField from = field(name);
    return MakeTabulatedWarp({of.phi, of.theta}, from.shape[3], from.shape[2], from.values);
  };
  brdf.half = warp("vndf");
  brdf.luminance = warp("luminance");
  brdf.table =
      RglTable{true, square("ndf"), square("sigma"), field("rgb").shape[4], field("rgb").values};
  FinishMeasured(&brdf);
  return brdf;
}

// The file: its header, then the arrays.
inline std::string TensorBytes(const std::vector<TensorField>& fields) {
  std::string head("tensor_file\0\1\0", 14), data;
  size_t size = head.size() + 4;
  for (const TensorField& field : fields) {
    size += 2 + field.name.size() + 11 + 8 * field.shape.size();
  }
  const auto put = [&](auto number) {
    head.append(reinterpret_cast<const char*>(&number), sizeof(number));
  };
  put(static_cast<uint32_t>(fields.size()));
  for (const TensorField& field : fields) {
    put(static_cast<uint16_t>(field.name.size()));
    head += field.name;
    put(static_cast<uint16_t>(field.shape.size()));
    put(static_cast<uint8_t>(10));
    put(static_cast<uint64_t>(size + data.size()));
    for (const uint64_t n : field.shape) put(n);
    data.append(reinterpret_cast<const char*>(field.values.data()), 4 * field.values.size());
  }
  return head + data;
}

// The bytes of a MERL file. Black cells have -1.
inline std::string MerlBytes(const MerlTable& table) {
  const int32_t counts[3] = {90, 90, 180};
  const double scales[3] = {1.0 / 1500, 1.15 / 1500, 1.66 / 1500};
  std::string bytes(reinterpret_cast<const char*>(counts), sizeof(counts));
  std::vector<double> values(MerlTable::kCells);
  for (size_t c = 0; c < 3; ++c) {
    for (size_t cell = 0; cell < MerlTable::kCells; ++cell) {
      const float* const rgb = table.rgb.data() + 3 * cell;
      const bool black = rgb[0] == 0 && rgb[1] == 0 && rgb[2] == 0;
      values[cell] = black ? -1 : double{rgb[c]} / scales[c];
    }
    bytes.append(reinterpret_cast<const char*>(values.data()), 8 * values.size());
  }
  return bytes;
}

}  // namespace nacre
