// SPDX-License-Identifier: Apache-2.0
// shading/layer_sample.cc: samples directions to light for the diffuse component of materials with
// layers: each layer has its own sampler, the base is sampled by cosine, and they are chosen in
// proportion to what they reflect.
#include <algorithm>
#include <cmath>

#include "brdf/lobe_sampling.h"
#include "shading/hit_parameters.h"
#include "shading/lobe_sample.h"

namespace nacre {
namespace {

// The layers at one hit, and the probability of sampling each of them rather than what lies below.
class LayersOfHit {
 public:
  LayersOfHit(const ShadingMaterial& material, const LobeRange& range, size_t i)
      : material_(material),
        maps_(material.mapped_model ? range.textures : nullptr),
        i_(i),
        normal_(VectorAt(range.surface.normal, i)),
        n_dot_v_(std::clamp(normal_.dot(VectorAt(range.surface.to_view, i)), 0.0, 1.0)),
        // Rounded to float as the maps' albedo is, so that a constant map changes no direction.
        base_(LargestChannel(maps_ != nullptr ? Rgb(VectorAt(maps_->albedo, i))
                                              : Rgb(Vec3f(material.albedo)))) {
    for (size_t k = 0; k < material.layers.size(); ++k) {
      reflects_ = reflects_ || Share(Layer(k)) > 0;
    }
  }

  // Whether any layer reflects light.
  bool Reflects() const { return reflects_; }

  Vec3d Sample(double u0, double u1) const {
    for (size_t k = material_.layers.size(); k-- > 0;) {
      const LayerModel layer = Layer(k);
      const double share = Share(layer);
      if (u0 < share) return SampleLayer(layer, normal_, u0 / share, u1);
      u0 = (u0 - share) / (1 - share);  // the number that made the choice is rescaled to [0, 1)
    }
    // Sampled in polar coordinates, as layers are, not by SampleCosine: the direction is then a
    // continuous function of the point, which keeps the strata of Sobol points.
    const double sin = std::sqrt(std::clamp(u0, 0.0, 1.0)), phi = 2 * M_PI * u1;
    return BasisAbout(normal_).ToWorld(
        {sin * std::cos(phi), sin * std::sin(phi), std::sqrt(std::max(1 - sin * sin, 0.0))});
  }

  double Pdf(const Vec3d& to_light) const {
    const double n_dot_l = normal_.dot(to_light);
    double pdf = 0, left = 1;
    for (size_t k = material_.layers.size(); k-- > 0;) {
      const LayerModel layer = Layer(k);
      const double share = Share(layer);
      pdf += left * share * LayerPdf(layer, n_dot_l);
      left *= 1 - share;
    }
    return pdf + left * CosinePdf(n_dot_l);
  }

 private:
  LayerModel Layer(size_t k) const {
    return maps_ != nullptr ? LayerAtHit(material_.layers[k], *maps_, i_) : material_.layers[k];
  }

  // The layer's fraction of its albedo plus that of the base below it.
  double Share(const LayerModel& layer) const {
    const LayerReflection albedo = LayerAlbedo(layer, n_dot_v_);
    const double lobe = LargestChannel(albedo.lobe), sum = lobe + albedo.below * base_;
    return sum > 0 ? lobe / sum : 0;
  }

  const ShadingMaterial& material_;
  const HitTextures* maps_;
  size_t i_;
  Vec3d normal_;
  double n_dot_v_, base_;
  bool reflects_ = false;
};

}  // namespace

void SampleUnderLayers(const ShadingMaterial& material, const LobeRange& range, const float* u,
                       const float* v, Soa3<float>* to_light) {
  for (size_t i = range.begin; i < range.end; ++i) {
    const LayersOfHit layers(material, range, i);
    if (layers.Reflects()) SetVector(layers.Sample(u[i], v[i]), i, to_light);
  }
}

void UnderLayersPdf(const ShadingMaterial& material, const LobeRange& range,
                    const Soa3<float>& to_light, const float* light_pdf, float* pdf) {
  for (size_t i = range.begin; i < range.end; ++i) {
    const LayersOfHit layers(material, range, i);
    if (!layers.Reflects()) continue;
    pdf[i] = static_cast<float>(layers.Pdf(VectorAt(to_light, i)));
    if (light_pdf != nullptr) pdf[i] += light_pdf[i];
  }
}

}  // namespace nacre
