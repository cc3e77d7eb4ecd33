// SPDX-License-Identifier: Apache-2.0
// scene_io/obj.h: triangle meshes from Wavefront OBJ files.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "scene/scene.h"
#include "scene_io/load_scene.h"

namespace nacre {

struct ObjReading {
  int threads = 0;  // 0: as many as the machine has
  // Corners without a normal get one, if the file has normals or smoothing groups.
  bool complete_normals = true;
  std::function<void(const std::string&)> on_warning = {};  // as LoadOptions::on_warning
};

// All faces of the file as one mesh, polygons cut into triangles, named after the file. Normals are
// the file's, made unit. Corners without one, or with one of length 0, get the average of the faces
// of their smoothing group, or of all faces if the file has no groups; the face's own where
// smoothing is off. A mesh has no normals if the file has neither. It has texture coordinates if
// any corner does; others then have (0, 0). Lines, points, colours and materials (MTL) are not
// read. Throws Error (kBadInput) as ReadObjFile (obj_file.h) does.
Mesh ReadObj(const std::filesystem::path& path, const ObjReading& reading = {});

// The same faces as a scene of their own, with the materials of the libraries (MTL) that the file
// names and the colours of its vertices. If the file has no smoothing groups, averages are parted
// where faces meet at more than kModelCreaseAngleDeg; if it has no normals either, those of each
// material for itself. Camera and light are left to CompleteModelScene
// (model_scene.h). What is not shown is told by options.on_warning.
Scene ReadObjScene(const std::filesystem::path& path, const LoadOptions& options);

}  // namespace nacre
