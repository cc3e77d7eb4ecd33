// SPDX-License-Identifier: Apache-2.0
#include "visibility/cut_out.h"

#include <algorithm>

#include "scene/material_parameters.h"
#include "scene/mesh.h"

namespace nacre {
namespace {

// Always samples the full-resolution image: mip levels would close the holes of distant foliage, or
// lose the leaves.
double MapOpacity(const CutOut& cut_out, const Vec2d& uv) {
  const SampleSettings& sampling = cut_out.texture.sampling;
  return sampling.filter == TextureFilter::kNearest
             ? SampleNearest(*cut_out.image, 0, sampling, uv.x, uv.y, 0)
             : SampleBilinear(*cut_out.image, 0, sampling, uv.x, uv.y, 0);
}

}  // namespace

std::optional<CutOut> MakeCutOut(const Scene& scene, const Mesh& mesh) {
  if (mesh.material.index >= scene.materials.size()) return std::nullopt;  // it is never shaded
  const Material& material = scene.materials[mesh.material.index];
  if (!CutsHoles(material) && mesh.opacities.empty()) return std::nullopt;
  CutOut made;
  made.opacity = material.opacity;
  made.cutoff = material.opacity_cutoff;
  double least = made.opacity;
  if (!mesh.opacities.empty()) {
    least *= double{*std::min_element(mesh.opacities.begin(), mesh.opacities.end())};
  }
  if (material.opacity_map.valid()) {
    made.texture = scene.textures[material.opacity_map.index];
    made.image = scene.images[made.texture.image.index].texels;
    least *= std::max(double{made.image->least}, 0.0);
  }
  if (least >= made.cutoff) return std::nullopt;
  made.opacities = mesh.opacities;
  if (made.image == nullptr) return made;
  made.transform = TransformOf(made.texture);
  if (made.texture.mapping == MappingKind::kUv) made.uvs = UvsOf(mesh, made.texture.second_uvs);
  return made;
}

void MoveCutOut(const Vec3d& camera_position, CutOut* cut_out) {
  cut_out->center = cut_out->texture.center - camera_position;
}

bool IsSolidAt(const CutOut& cut_out, const std::vector<Vec3d>& positions,
               const std::array<uint32_t, 3>& corners, const std::array<double, 3>& weights) {
  double opacity = cut_out.opacity;
  if (!cut_out.opacities.empty()) {
    // Interpolated by differences from the first corner, because the sum of the weights is rounded:
    // between corners of equal opacity the result is exactly that opacity, and so on the same side
    // of the cutoff.
    const auto at = [&](size_t k) {
      return double{cut_out.opacities[corners[k] - cut_out.first_vertex]};
    };
    opacity *= at(0) + (weights[1] * (at(1) - at(0)) + weights[2] * (at(2) - at(0)));
  }
  if (cut_out.image != nullptr) {
    Vec2d uv(0, 0);
    if (cut_out.texture.mapping == MappingKind::kUv) {
      for (size_t k = 0; k < 3; ++k) {
        uv += cut_out.uvs[corners[k] - cut_out.first_vertex] * weights[k];
      }
      uv = cut_out.transform.Apply(uv);
    } else {
      Vec3d point(0, 0, 0);
      for (size_t k = 0; k < 3; ++k) point += positions[corners[k]] * weights[k];
      uv = MapToTexture(cut_out.texture, (point - cut_out.center) / cut_out.texture.size);
    }
    opacity *= MapOpacity(cut_out, uv);
  }
  return opacity >= cut_out.cutoff;
}

const CutOut* FindCutOut(const std::vector<CutOut>& cut_outs, uint32_t triangle) {
  const auto after =
      std::upper_bound(cut_outs.begin(), cut_outs.end(), triangle,
                       [](uint32_t index, const CutOut& holes) { return index < holes.begin; });
  if (after == cut_outs.begin()) return nullptr;
  const CutOut& holes = *(after - 1);
  return triangle < holes.end ? &holes : nullptr;
}

}  // namespace nacre
