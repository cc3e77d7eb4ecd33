// SPDX-License-Identifier: Apache-2.0
// shading/kept_tables.h: tables that take long to make, by what they were made of: those that a
// plan made are there for the next one of the same scene.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "light/environment.h"
#include "light/mesh_light.h"
#include "scene/light.h"
#include "scene/shapes.h"
#include "scene/tangents.h"

namespace nacre {

template <class Source, class Table>
struct KeptTable {
  std::shared_ptr<const Source> source;  // never changed; held, so that no other has its address
  std::shared_ptr<const Table> table;
};

struct KeptTangents {
  size_t mesh;  // its number in the scene
  bool second_uvs;
  UvRows rows;
  std::shared_ptr<const CornerTangents> tangents;
};

struct KeptTables {
  std::vector<KeptTable<SkyPicture, EnvironmentMap>> skies;
  std::vector<KeptTable<Mesh, MeshLight>> mesh_lights;
  std::vector<KeptTangents> tangents;  // of the scene's meshes as they are
};

// The table of a source, made by make() if it is not there.
template <class Source, class Table, class Make>
std::shared_ptr<const Table> TableOf(const std::shared_ptr<const Source>& source, const Make& make,
                                     std::vector<KeptTable<Source, Table>>* kept) {
  for (const KeptTable<Source, Table>& entry : *kept) {
    if (entry.source == source) return entry.table;
  }
  auto table = std::make_shared<const Table>(make());
  kept->push_back({source, table});
  return table;
}

// Drops tables that nobody but `kept` holds.
template <class Source, class Table>
void DropUnused(std::vector<KeptTable<Source, Table>>* kept) {
  std::erase_if(*kept, [](const auto& entry) { return entry.table.use_count() == 1; });
}

}  // namespace nacre
