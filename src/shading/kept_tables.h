// SPDX-License-Identifier: Apache-2.0
// shading/kept_tables.h: a cache of tables that take long to make, keyed by what they were made of.
// The tables of one plan are reused by the next plan of the same scene.
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
  // Never changed. Held here, so that no other source can have the same address.
  std::shared_ptr<const Source> source;
  std::shared_ptr<const Table> table;
};

struct KeptTangents {
  size_t mesh;  // index in the scene
  bool second_uvs;
  UvRows rows;
  std::shared_ptr<const CornerTangents> tangents;
};

struct KeptTables {
  std::vector<KeptTable<SkyPicture, EnvironmentMap>> skies;
  std::vector<KeptTable<Mesh, MeshLight>> mesh_lights;
  std::vector<KeptTangents> tangents;  // valid while the scene's meshes do not change
};

// Returns the table of a source, which is made by make() if `kept` does not have it.
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

// Drops the tables that only `kept` still refers to.
template <class Source, class Table>
void DropUnused(std::vector<KeptTable<Source, Table>>* kept) {
  std::erase_if(*kept, [](const auto& entry) { return entry.table.use_count() == 1; });
}

}  // namespace nacre
