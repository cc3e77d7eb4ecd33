// SPDX-License-Identifier: Apache-2.0
// scene_io/obj.h: triangle meshes from Wavefront OBJ files.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "scene/scene.h"
#include "scene_io/load_options.h"

namespace nacre {

struct ObjReading {
  int threads = 0;  // 0: as many as the machine has
  // Corners without a normal get one if the file has normals or smoothing groups.
  bool complete_normals = true;
  std::function<void(const std::string&)> on_warning = {};  // as LoadOptions::on_warning
};

// Reads all faces of the file as one mesh, named after the file, with polygons cut into triangles.
// Normals are those of the file, normalised. Corners without a normal, or with one of length 0, get
// the average over the faces of their smoothing group, or over all faces if the file has no groups;
// where smoothing is off, they get the normal of their face. A mesh has no normals if the file has
// neither normals nor groups. It has texture coordinates if any corner does; the other corners then
// have (0, 0). Lines, points, colours and materials (MTL) are not read. Throws Error (kBadInput) as
// ReadObjFile (obj_file.h) does.
Mesh ReadObj(const std::filesystem::path& path, const ObjReading& reading = {});

// Reads the same faces as a scene, with the materials of the libraries (MTL) that the file names
// and the colours of its vertices. If the file has no smoothing groups, averages are taken only
// across edges where faces meet at no more than kModelCreaseAngleDeg; if it has no normals either,
// they are taken within each material. Camera and light are left to CompleteModelScene
// (model_scene.h). Contents that are not shown are reported to options.on_warning.
Scene ReadObjScene(const std::filesystem::path& path, const LoadOptions& options);

}  // namespace nacre
