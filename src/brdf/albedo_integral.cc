// SPDX-License-Identifier: Apache-2.0
#include "brdf/albedo_integral.h"

#include <algorithm>
#include <utility>

#include "brdf/fresnel.h"
#include "brdf/quadrature.h"

namespace nacre {
namespace {

double Square(double x) { return x * x; }

constexpr double kPanelRatio = 4;  // size of a panel over that of its neighbour nearer the anchor

// An interval of light elevations, measured from the horizon or from the viewer's elevation,
// whichever is nearer, so that neither distance is a difference of rounded angles.
struct Panel {
  bool from_viewer;
  double begin, end;
};

// Appends panels that cover `length` on one side of an anchor (the viewer or the horizon); `sign`
// is the side. Their sizes grow by kPanelRatio from `finest` at the anchor.
void AppendPanels(bool from_viewer, double length, double finest, double sign,
                  std::vector<Panel>* panels) {
  double begin = 0;
  for (double end = finest; begin < length; end *= kPanelRatio) {
    if (!(end * 1.5 < length)) end = length;  // no sliver at the end
    panels->push_back(
        {from_viewer, std::min(sign * begin, sign * end), std::max(sign * begin, sign * end)});
    begin = end;
  }
}

// The panels are as fine as 2 alpha about the mirror direction. At the horizon, where the
// visibility has a pole at -n.v and bends at alpha, they are as fine as the lesser of the two.
std::vector<Panel> MakePanels(double alpha, double view) {
  std::vector<Panel> panels;
  panels.reserve(64);
  const double peak = 2 * alpha;
  // Closer to the horizon than 1e-10 there is too little light to matter.
  const double horizon = view > 0 ? std::min(alpha, std::max(view, 1e-10)) : alpha;
  AppendPanels(true, M_PI_2 - view, std::min(peak, 2 * horizon), 1, &panels);
  if (view > 0) {
    AppendPanels(true, view / 2, peak, -1, &panels);
    AppendPanels(false, view / 2, horizon, 1, &panels);
  }
  return panels;
}

// Ends panels where v.h is the corner's cosine, the light in the viewer's plane.
std::vector<Panel> SplitAtCorner(const std::vector<Panel>& panels, double view, double corner) {
  const double apart = 2 * std::acos(corner);
  const double places[] = {view - apart, view + apart, M_PI - apart - view};  // elevations
  std::vector<Panel> split = panels;
  for (const double place : places) {
    std::vector<Panel> finer;
    for (const Panel& panel : split) {
      const double at = panel.from_viewer ? place - view : place;
      if (at > panel.begin && at < panel.end) {
        finer.push_back({panel.from_viewer, panel.begin, at});
        finer.push_back({panel.from_viewer, at, panel.end});
      } else {
        finer.push_back(panel);
      }
    }
    split = std::move(finer);
  }
  return split;
}

}  // namespace

double Visibility(Shadowing shadowing, double n_dot_l, double n_dot_v, double roughness) {
  const double alpha = AlphaFromRoughness(roughness);
  switch (shadowing) {
    case Shadowing::kHeightCorrelated:
      return VisibilityHeightCorrelated(n_dot_l, n_dot_v, alpha);
    case Shadowing::kSeparable:
      return VisibilitySeparable(n_dot_l, n_dot_v, alpha);
    case Shadowing::kSchlickDirect:
    case Shadowing::kSchlickIbl:
      return VisibilitySchlick(n_dot_l, n_dot_v, SchlickK(shadowing, roughness));
  }
  return 0;
}

std::vector<AlbedoNode> MakeAlbedoNodes(double alpha, double n_dot_v, int points, double corner) {
  const QuadratureRule& rule = GaussLegendre(points);
  const double view = std::asin(std::min(n_dot_v, 1.0));
  std::vector<AlbedoNode> nodes;
  std::vector<Panel> panels = MakePanels(alpha, view);
  if (corner > 0) panels = SplitAtCorner(panels, view, corner);
  nodes.reserve(panels.size() * rule.x.size());
  for (const Panel& panel : panels) {
    const double length = panel.end - panel.begin;
    for (size_t i = 0; i < rule.x.size(); ++i) {
      const double at = panel.begin + length * rule.x[i];
      const double difference = (panel.from_viewer ? at : at - view) / 2;
      const double elevation = panel.from_viewer ? view + at : at;
      const double sum = (panel.from_viewer ? 2 * view + at : view + at) / 2;
      AlbedoNode node;
      node.n_dot_l = std::sin(elevation);
      node.weight = rule.w[i] * length * node.n_dot_l * std::cos(elevation);
      node.sin_sum2 = Square(std::sin(sum));
      // Near the zenith the complement of the sum is small, and known to full precision.
      node.cos_sum2 = Square(std::sin(M_PI_2 - view - (panel.from_viewer ? at : at - view) / 2));
      node.sin_difference2 = Square(std::sin(difference));
      node.cos_difference2 = 1 - node.sin_difference2;
      node.p = node.sin_difference2 + alpha * alpha * node.cos_difference2;
      node.q = node.cos_sum2 + alpha * alpha * node.sin_sum2;
      nodes.push_back(node);
    }
  }
  return nodes;
}

double AlbedoOfOne(Shadowing shadowing, double roughness, double n_dot_v, int points) {
  const double alpha = AlphaFromRoughness(roughness);
  if (IsDeltaLobe(alpha)) {  // a mirror reflects the mirror direction only, where n.l = n.v
    if (shadowing != Shadowing::kSchlickDirect) return 1;
    return 4 * n_dot_v * n_dot_v * Visibility(shadowing, n_dot_v, n_dot_v, roughness);
  }
  double sum = 0;
  for (const AlbedoNode& node : MakeAlbedoNodes(alpha, n_dot_v, points)) {
    // int D dphi = 2 alpha^2 (1 + 2 K / s + K^2 A / s^3) with s^2 = 4 C^2 c^2 p q, K = 2 (1 -
    // alpha^2) C^2 c^2 and A = C^2 p + c^2 q; C and c are cancelled analytically.
    const double pq_root = std::sqrt(node.p * node.q);
    const double both = (1 - alpha * alpha) * std::sqrt(node.sin_sum2 * node.cos_difference2);
    const double mixed = node.sin_sum2 * node.p + node.cos_difference2 * node.q;
    const double azimuth = 1 + 2 * both / pq_root +
                           (1 - alpha * alpha) * both * mixed / (2 * pq_root * pq_root * pq_root);
    sum += node.weight * 2 * alpha * alpha * azimuth *
           Visibility(shadowing, node.n_dot_l, n_dot_v, roughness);
  }
  return sum;
}

double AlbedoOfSchlick(Shadowing shadowing, double roughness, double n_dot_v) {
  return AlbedoOf(shadowing, roughness, n_dot_v,
                  [](double, double one_minus_vh) { return Power5(one_minus_vh); });
}

}  // namespace nacre
