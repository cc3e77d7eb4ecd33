// SPDX-License-Identifier: Apache-2.0
// scene_io/model_files.h: meshes and scenes from Wavefront OBJ files (obj.cc), PLY files (ply.cc)
// and glTF 2.0 files (gltf.cc).
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "scene/scene.h"
#include "scene_io/load_options.h"

namespace nacre {

struct ObjReading {
  int threads = 0;  // 0: as many as the machine has
  // Corners without a normal get one if the file has normals or smoothing groups.
  bool complete_normals = true;
  std::function<void(const std::string&)> on_warning = {};  // as LoadOptions::on_warning
};

// Reads all faces of an OBJ file as one mesh, named after the file, with polygons cut into
// triangles. Normals are those of the file, normalised. Corners without a normal, or with one of
// length 0, get the average over the faces of their smoothing group, or over all faces if the file
// has no groups; where smoothing is off, they get the normal of their face. A mesh has no normals
// if the file has neither normals nor groups. It has texture coordinates if any corner does; the
// other corners then have (0, 0). Lines, points, colours and materials (MTL) are not read. Throws
// Error (kBadInput) as ReadObjFile (obj_file.h) does.
Mesh ReadObj(const std::filesystem::path& path, const ObjReading& reading = {});

// Reads the same faces as a scene, with the materials of the libraries (MTL) that the file names
// and the colours of its vertices. If the file has no smoothing groups, averages are taken only
// across edges where faces meet at no more than kModelCreaseAngleDeg; if it has no normals either,
// they are taken within each material. Camera and light are left to CompleteModelScene
// (model_scene.h). Contents that are not shown are reported to options.on_warning.
Scene ReadObjScene(const std::filesystem::path& path, const LoadOptions& options);

// Reads the elements "vertex" (x, y, z; nx, ny, nz; u, v or s, t) and "face" (vertex_indices) or
// "tristrips" of a PLY file as one mesh, named after the file, with polygons cut into triangles.
// The mesh has the normals of the file, or none. Faces of fewer than three corners are left out,
// with a warning. Throws Error (kBadInput) with the file for malformed contents, positions that are
// not finite or out of range, indices out of range, faces of more than 65 535 corners, and files
// without faces.
Mesh ReadPly(const std::filesystem::path& path,
             const std::function<void(const std::string&)>& on_warning = {});

// Reads a PLY file as a scene. Faces without normals get averages, taken only across edges where
// faces meet at no more than kModelCreaseAngleDeg. A file without faces is a cloud of spheres, with
// the vertices' "radius" or one that suits their distances, and a material for each colour (red,
// green, blue: sRGB in bytes, linear in floats). Camera and light are left to CompleteModelScene
// (model_scene.h). Contents that are not shown are reported to options.on_warning.
Scene ReadPlyScene(const std::filesystem::path& path, const LoadOptions& options);

// The vertices of a PLY file without faces.
struct PlyPoints {
  std::vector<Vec3d> positions;
  std::vector<double> radii;      // the property "radius", or empty
  std::vector<double> materials;  // the property "material", or empty
};

// Throws Error (kBadInput) with the file for malformed contents, positions out of range, and files
// with faces.
PlyPoints ReadPlyPoints(const std::filesystem::path& path);

// Reads the meshes, skins, materials with their textures, lights and first camera of the default
// scene of a .gltf or .glb file. *has_camera is set to whether there is a camera. What the file
// does not specify is left to CompleteModelScene (model_scene.h). Contents that nacre does not show
// are reported to options.on_warning. Throws Error (kBadInput), with the file and the JSON pointer,
// for whatever is wrong.
Scene ReadGltf(const std::filesystem::path& path, const LoadOptions& options, bool* has_camera);

}  // namespace nacre
