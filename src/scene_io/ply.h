// SPDX-License-Identifier: Apache-2.0
// scene_io/ply.h: triangle meshes and clouds of points from PLY files.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "scene/scene.h"
#include "scene_io/load_options.h"

namespace nacre {

// Reads the elements "vertex" (x, y, z; nx, ny, nz; u, v or s, t) and "face" (vertex_indices) or
// "tristrips" of a PLY file as one mesh, named after the file, with polygons cut into triangles.
// The mesh has the normals of the file, or none. Faces of fewer than three corners are left out,
// with a warning. Throws Error (kBadInput) with the file for malformed contents, positions that are
// not finite or out of range, indices out of range, faces of more than 65 535 corners, and files
// without faces.
Mesh ReadPly(const std::filesystem::path& path,
             const std::function<void(const std::string&)>& on_warning = {});

// Reads a file as a scene. Faces without normals get averages, taken only across edges where faces
// meet at no more than kModelCreaseAngleDeg. A file without faces is a cloud of spheres, with the
// vertices' "radius" or one that suits their distances, and a material for each colour (red, green,
// blue: sRGB in bytes, linear in floats). Camera and light are left to CompleteModelScene
// (model_scene.h). Contents that are not shown are reported to options.on_warning.
Scene ReadPlyScene(const std::filesystem::path& path, const LoadOptions& options);

// The vertices of a file without faces.
struct PlyPoints {
  std::vector<Vec3d> positions;
  std::vector<double> radii;      // the property "radius", or empty
  std::vector<double> materials;  // the property "material", or empty
};

// Throws Error (kBadInput) with the file for malformed contents, positions out of range, and files
// with faces.
PlyPoints ReadPlyPoints(const std::filesystem::path& path);

}  // namespace nacre
