// SPDX-License-Identifier: Apache-2.0
// shading/layer.h: layers over a model, such as the fuzz of cloth. A layer reflects some of the
// light itself, and scales down what the model and the layers below it reflect. SIMD twin:
// cover_kernel.cc. A clear coat lies over such layers, or below them (LiesOverCoats), and has a
// shading normal of its own (bsdf.h).
#pragma once

#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "brdf/angles.h"
#include "brdf/fuzz.h"
#include "brdf/sheen.h"
#include "scene/model_options.h"
#include "shading/reflection.h"

namespace nacre {

struct Material;

// The fuzz of cloth (brdf/sheen.h). Its lobe is as wide as diffuse reflection and belongs to the
// same component, as in Blender's passes.
struct SheenModel {
  static constexpr std::string_view kName = "sheen";
  static constexpr LobeKind kKind = LobeKind::kDiffuse;
  Rgb color{0, 0, 0};
  Charlie<double> charlie;
  SheenScaling scaling = SheenScaling::kReciprocal;
};

// The fuzz of OpenPBR (brdf/fuzz.h), which lies over coats. Its lobe is as wide as that of sheen.
struct FuzzModel {
  static constexpr std::string_view kName = "fuzz";
  static constexpr LobeKind kKind = LobeKind::kDiffuse;
  double weight = 1;  // the fraction of what is below that it covers
  Rgb color{1, 1, 1};
  Fuzz<double> fuzz;
};

using LayerModel = std::variant<SheenModel, FuzzModel>;

// A material has at most this many layers.
inline constexpr size_t kMostLayers = 4;

inline std::string_view NameOf(const LayerModel& layer) {
  return std::visit([](const auto& model) { return model.kName; }, layer);
}
inline LobeKind KindOf(const LayerModel& layer) {
  return std::visit([](const auto& model) { return model.kKind; }, layer);
}

// The layers of a material, with the factors of its maps as parameters, bottom to top. Layers that
// reflect nothing, whatever the maps, are left out.
std::vector<LayerModel> MakeLayers(const Material& material);

// Whether the layer lies over a material's coats, not below them. Such layers are the last.
inline bool LiesOverCoats(const LayerModel& layer) {
  return std::holds_alternative<FuzzModel>(layer);
}

struct HitParameters;

// A layer with the parameters of hit i; the layer itself if `maps` is null.
LayerModel LayerAtHit(const LayerModel& layer, const HitParameters* maps, size_t i);

// Removes the layers from a material and returns their names.
std::vector<std::string_view> RemoveLayers(Material* material);

// Angles, and for lobes about another half vector than h the directions themselves. The cosines of
// the angles are at least 0.
struct LayerAngles : Angles<double> {
  Vec3d normal, to_light, to_view;
};
inline LayerAngles LayerAnglesOf(const Vec3d& n, const Vec3d& l, const Vec3d& v) {
  return {ComputeAngles(n, l, v), n, l, v};
}

// The reflection of one layer for one direction of light and one of view.
struct LayerReflection {
  Rgb lobe{0, 0, 0};  // f n.l of the layer itself
  double below = 1;   // the factor for the reflection of all that is below
};
LayerReflection EvaluateLayer(const LayerModel& layer, const LayerAngles& angles);

// At n.v, `lobe` is the directional albedo of the layer, and `below` the factor for light that
// arrives and leaves at the same angle, as by a mirror. The factor is used for ambient light, too,
// so that a white surface reflects all of it.
LayerReflection LayerAlbedo(const LayerModel& layer, double n_dot_v);

// The angle between normal and half vector at which the layer's lobe has fallen to about half its
// peak, in radians: adaptive sampling seeks such peaks. Infinite for a layer that reflects
// diffusely, or whose peak is elsewhere.
double LayerLobeWidth(const LayerModel& layer);

// The terms of the layer's lobe by name, for explaining a pixel.
std::vector<std::pair<std::string_view, double>> LayerTerms(const LayerModel& layer,
                                                            const LayerAngles& angles);

// Samples a direction to light for the layer's own reflection, with u0 and u1 in [0, 1). LayerPdf
// is its pdf, per solid angle.
Vec3d SampleLayer(const LayerModel& layer, const Vec3d& normal, const Vec3d& to_view, double u0,
                  double u1);
double LayerPdf(const LayerModel& layer, const LayerAngles& angles);

}  // namespace nacre
