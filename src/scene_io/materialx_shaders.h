// SPDX-License-Identifier: Apache-2.0
// scene_io/materialx_shaders.h: the shaders of MaterialX as the models of a scene.
//
// open_pbr_surface is nacre's model open_pbr, parameter by parameter. standard_surface becomes it
// by MaterialX's own translation graph (standard_surface_to_open_pbr). gltf_pbr becomes
// metallic_roughness, as the materials of glTF files do. What these models have not is told if it
// has any weight:
// - Transmission is not rendered: the dielectric keeps its diffuse base.
// - Subsurface scattering is shown as the diffuse reflection of its colour.
// - Films, dispersion and normals of the coat alone are left out.
// Numbers outside of a parameter's range, such as colours that leave [0, 1] in Rec. 709, are
// clamped to it. A graph that cannot be followed gives its input the shader's default.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "scene_io/materialx_graph.h"
#include "scene_io/materialx_material.h"

namespace nacre {

// Whether MaterialXShaderToMaterial takes this kind of node.
bool IsMaterialXShader(std::string_view kind);
std::string MaterialXShaderKinds();  // for hints

// Converts the shader node, of such a kind; fills all of *result but its name, which is there.
// `label` begins the names of its textures.
void MaterialXShaderToMaterial(MaterialXGraph* graph, size_t shader, const std::string& label,
                               MaterialXMaterial* result);

}  // namespace nacre
