// SPDX-License-Identifier: Apache-2.0
// scene_io/obj.h: triangle meshes from Wavefront OBJ files.
#pragma once

#include <filesystem>

#include "scene/scene.h"
#include "scene_io/load_scene.h"

namespace nacre {

// All faces of the file as one mesh, polygons cut into triangles, named after the file. Normals
// are the file's, made unit, if all corners of all faces have one, and averages in the place of
// those of length 0; otherwise there are none. The same goes for texture coordinates. Groups,
// lines, points, colours and materials (MTL) are not read. Throws Error (kBadInput) as ReadObjFile
// (obj_file.h) does.
Mesh ReadObj(const std::filesystem::path& path, int threads = 0);

// The same faces as a scene of their own, with the materials of the libraries (MTL) that the file
// names and the colours of its vertices; faces without normals get averages, parted where they meet
// at more than kModelCreaseAngleDeg. Camera and light are left to CompleteModelScene
// (model_scene.h). What is not shown is told by options.on_warning.
Scene ReadObjScene(const std::filesystem::path& path, const LoadOptions& options);

}  // namespace nacre
