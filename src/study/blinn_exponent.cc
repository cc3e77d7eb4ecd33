// SPDX-License-Identifier: Apache-2.0
#include "study/blinn_exponent.h"

#include <cmath>
#include <limits>
#include <vector>

#include "brdf/phong.h"
#include "brdf/quadrature.h"
#include "study/reflection.h"

namespace nacre {
namespace {

constexpr double kDark = -std::numeric_limits<double>::infinity();

// A sample at which both lobes are compared: its weight, Phong's value, and the logarithm of
// Blinn's cosine, -infinity where the lobe is 0.
struct Node {
  double weight, phong, log_blinn;
};

double BlinnAt(const Node& node, double exponent) {
  return node.log_blinn == kDark ? 0 : std::exp(exponent * node.log_blinn);
}

// Minimises the sum of squares by finding the zero of its derivative; that of (phong - c^m)^2 with
// respect to m is -2 (phong - c^m) c^m log(c).
BlinnMatch Fit(const std::vector<Node>& nodes, double n) {
  const auto slope = [&](double exponent) {
    double sum = 0;
    for (const Node& node : nodes) {
      if (node.log_blinn == kDark) continue;
      const double blinn = BlinnAt(node, exponent);
      sum -= node.weight * (node.phong - blinn) * blinn * node.log_blinn;
    }
    return sum;
  };
  // Blinn's lobe is too wide at the lower end and too narrow at the upper one. The zero between is
  // found by false position, where a retained end is halved (Dowell and Jarratt 1971).
  double low = n;
  double high = 6 * n;
  double slope_low = slope(low);
  double slope_high = slope(high);
  for (int i = 0; i < 40 && high - low > 1e-12 * high; ++i) {
    const double middle = (low * slope_high - high * slope_low) / (slope_high - slope_low);
    const double slope_middle = slope(middle);
    if ((slope_middle < 0) == (slope_low < 0)) {
      low = middle;
      slope_low = slope_middle;
      slope_high /= 2;
    } else {
      high = middle;
      slope_high = slope_middle;
      slope_low /= 2;
    }
    if (slope_middle == 0) low = high = middle;
  }
  double squares = 0;
  double weights = 0;
  for (const Node& node : nodes) {
    const double difference = node.phong - BlinnAt(node, low);
    squares += node.weight * difference * difference;
    weights += node.weight;
  }
  return {low, std::sqrt(squares / weights)};
}

Node MakeNode(double weight, const Vec3d& normal, const Vec3d& to_light, const Vec3d& to_view,
              double n) {
  const double blinn = BlinnLobe(ComputeAngles(normal, to_light, to_view), 1.0);
  return {weight, PhongLobe(normal, to_light, to_view, n), blinn > 0 ? std::log(blinn) : kDark};
}

// Gauss-Legendre nodes in [0, 1], in equal panels.
QuadratureRule Panels(int panels) {
  const QuadratureRule& rule = GaussLegendre(16);
  QuadratureRule all;
  for (int panel = 0; panel < panels; ++panel) {
    for (size_t i = 0; i < rule.x.size(); ++i) {
      all.x.push_back((panel + rule.x[i]) / panels);
      all.w.push_back(rule.w[i] / panels);
    }
  }
  return all;
}

constexpr int kAzimuths = 720;

}  // namespace

BlinnMatch MatchInPlane(double n) {
  std::vector<Node> nodes;
  const QuadratureRule rule = Panels(64);
  for (size_t i = 0; i < rule.x.size(); ++i) {
    const double angle = rule.x[i] * M_PI / 2;  // between viewer and mirror direction
    nodes.push_back({rule.w[i], std::pow(std::cos(angle), n), std::log(std::cos(angle / 2))});
  }
  return Fit(nodes, n);
}

double MatchHalfMaximum(double n) {
  const double angle = std::acos(std::pow(0.5, 1 / n));
  return std::log(0.5) / std::log(std::cos(angle / 2));
}

BlinnMatch MatchOnSphere(double n, const Vec3d& to_light) {
  const Vec3d light = to_light.normalized();
  const Vec3d view(0, 0, 1);
  std::vector<Node> nodes;
  const QuadratureRule rule = Panels(24);
  for (size_t i = 0; i < rule.x.size(); ++i) {
    // The area of the disc is r dr. With r = sin(polar), the rim, where normals vary fast, has as
    // many nodes as the rest.
    const double polar = rule.x[i] * M_PI / 2;
    const double radius = std::sin(polar);
    const double weight = rule.w[i] * radius * std::cos(polar) / kAzimuths;
    for (int j = 0; j < kAzimuths; ++j) {
      const double phi = 2 * M_PI * (j + 0.5) / kAzimuths;
      const Vec3d normal(radius * std::cos(phi), radius * std::sin(phi), std::cos(polar));
      if ((normal ^ light) > 0) nodes.push_back(MakeNode(weight, normal, light, view, n));
    }
  }
  return Fit(nodes, n);
}

BlinnMatch MatchOnHemisphere(double n, double light_deg) {
  const Vec3d normal(0, 0, 1);
  const Vec3d light = DirectionAt(-light_deg);
  std::vector<Node> nodes;
  const QuadratureRule rule = Panels(24);
  for (size_t i = 0; i < rule.x.size(); ++i) {
    const double polar = rule.x[i] * M_PI / 2;
    const double weight = rule.w[i] * std::sin(polar) / kAzimuths;
    for (int j = 0; j < kAzimuths; ++j) {
      const double phi = 2 * M_PI * (j + 0.5) / kAzimuths;
      const Vec3d view(std::sin(polar) * std::cos(phi), std::sin(polar) * std::sin(phi),
                       std::cos(polar));
      nodes.push_back(MakeNode(weight, normal, light, view, n));
    }
  }
  return Fit(nodes, n);
}

}  // namespace nacre
