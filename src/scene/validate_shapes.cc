// SPDX-License-Identifier: Apache-2.0
// scene/validate_shapes.cc: the part of Validate() that checks spheres and meshes.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "scene/limits.h"
#include "scene/material_parameters.h"
#include "scene/mesh.h"
#include "scene/primitives.h"
#include "scene/validate.h"
#include "scene/validate_numbers.h"

namespace nacre {
namespace {

// A normal that was stored in float and read back is unit to 1e-7; this is a hundred times as much.
constexpr double kUnitLengthTolerance = 1e-5;

// Reports only the first invalid position, or index, of a mesh: the others have the same cause.
void ValidatePositions(const Mesh& mesh, const std::string& where, FaultList* faults) {
  for (size_t i = 0; i < mesh.positions.size(); ++i) {
    if (limits::kCoordinate.Contains(mesh.positions[i]))
      continue;  // no text is formatted for a million others
    CheckPoint(mesh.positions[i], fmt::format("{}/positions/{}", where, i), faults);
    return;
  }
}

void ValidateNormals(const Mesh& mesh, const std::string& where, FaultList* faults) {
  if (mesh.normals.empty()) return;
  if (mesh.normals.size() != mesh.positions.size()) {
    faults->Add(
        where + "/normals",
        fmt::format("{} normals for {} positions", mesh.normals.size(), mesh.positions.size()),
        "one per position, or none for face normals");
  }
  for (size_t i = 0; i < mesh.normals.size(); ++i) {
    const double length = mesh.normals[i].length();
    if (std::abs(length - 1) <= kUnitLengthTolerance) continue;  // also false for NaN
    faults->Add(fmt::format("{}/normals/{}", where, i), fmt::format("has length {}", length),
                "normals have length 1");
    return;
  }
}

// Reports only the first invalid colour and the first invalid opacity.
void ValidateColors(const Mesh& mesh, const std::string& where, FaultList* faults) {
  const Range& unit = limits::kUnit;
  for (size_t i = 0; i < mesh.colors.size(); ++i) {
    const Vec3f& color = mesh.colors[i];
    if (unit.Contains(color.x) && unit.Contains(color.y) && unit.Contains(color.z)) continue;
    CheckColor(Rgb(color), unit, fmt::format("{}/colors/{}", where, i), faults);
    break;
  }
  for (size_t i = 0; i < mesh.opacities.size(); ++i) {
    if (unit.Contains(mesh.opacities[i])) continue;
    CheckNumber(mesh.opacities[i], unit, fmt::format("{}/opacities/{}", where, i), faults);
    return;
  }
}

// Reports only the first invalid coordinates.
void ValidateRange(const std::vector<Vec2d>& uvs, const std::string& where, FaultList* faults) {
  for (size_t i = 0; i < uvs.size(); ++i) {
    const auto& [u, v] = uvs[i];
    if (limits::kCoordinate.Contains(u) && limits::kCoordinate.Contains(v)) continue;
    faults->Add(fmt::format("{}/{}", where, i), fmt::format("[{}, {}] is out of range", u, v),
                "each coordinate " + Describe(limits::kCoordinate));
    return;
  }
}

void ValidateUvs(const Mesh& mesh, const std::string& where, FaultList* faults) {
  for (const size_t count : {mesh.second_uvs.size(), mesh.colors.size(), mesh.opacities.size()}) {
    if (count == 0 || count == mesh.positions.size()) continue;
    faults->Add(where,
                fmt::format("{} coordinates, colours or opacities for {} positions", count,
                            mesh.positions.size()),
                "one per position, or none");
  }
  ValidateRange(mesh.second_uvs, where + "/second_uvs", faults);
  if (mesh.uvs.empty()) return;
  if (mesh.uvs.size() != mesh.positions.size()) {
    faults->Add(where + "/uvs",
                fmt::format("{} uvs for {} positions", mesh.uvs.size(), mesh.positions.size()),
                "one per position, or none");
  }
  ValidateRange(mesh.uvs, where + "/uvs", faults);
}

void ValidateTangents(const Mesh& mesh, const std::string& where, FaultList* faults) {
  if (mesh.tangents.empty()) return;
  if (mesh.tangents.size() != mesh.positions.size() ||
      mesh.normals.size() != mesh.positions.size()) {
    faults->Add(where + "/tangents",
                fmt::format("{} tangents for {} positions with {} normals", mesh.tangents.size(),
                            mesh.positions.size(), mesh.normals.size()),
                "one per position that has a normal, or none");
    return;
  }
  for (size_t i = 0; i < mesh.tangents.size(); ++i) {
    const auto& [direction, sign] = mesh.tangents[i];
    if (std::abs(direction.length() - 1) <= kUnitLengthTolerance && std::abs(sign) == 1) continue;
    faults->Add(fmt::format("{}/tangents/{}", where, i),
                fmt::format("has length {} and sign {}", direction.length(), sign),
                "tangents have length 1 and the sign 1 or -1");
    return;
  }
}

void ValidateIndices(const Mesh& mesh, const std::string& where, FaultList* faults) {
  if (mesh.triangles.empty() || mesh.triangles.size() % 3 != 0) {
    faults->Add(
        where + "/triangles",
        mesh.triangles.empty() ? "no triangles" : fmt::format("{} indices", mesh.triangles.size()),
        "three for each triangle, and at least one triangle");
    return;
  }
  for (size_t i = 0; i < mesh.triangles.size(); ++i) {
    if (mesh.triangles[i] < mesh.positions.size()) continue;
    faults->Add(fmt::format("{}/triangles/{}", where, i / 3),
                fmt::format("there is no position {}", mesh.triangles[i]),
                fmt::format("the mesh has {}", mesh.positions.size()));
    return;
  }
  if (!HasArea(mesh)) faults->Add(where, "no triangle has an area", {});
}

bool IsSound(const Sphere& sphere, size_t material_count) {
  return limits::kCoordinate.Contains(sphere.center) && limits::kLength.Contains(sphere.radius) &&
         sphere.material.index < material_count;
}

bool IsOfMeshes(const Material& material) { return CutsHoles(material) || material.single_sided; }

}  // namespace

void ValidateSphere(const Sphere& sphere, size_t material_count, const std::string& where,
                    FaultList* faults) {
  CheckPoint(sphere.center, where + "/center", faults);
  CheckNumber(sphere.radius, limits::kLength, where + "/radius", faults);
  CheckMaterial(sphere.material, material_count, where + "/material", faults);
}

void ValidateTriangles(const Mesh& mesh, const std::string& where, FaultList* faults) {
  const size_t before = faults->count();
  ValidatePositions(mesh, where, faults);
  if (faults->count() == before) ValidateIndices(mesh, where, faults);
}

void ValidateMesh(const Mesh& mesh, size_t material_count, const std::string& where,
                  FaultList* faults) {
  const size_t before = faults->count();
  ValidatePositions(mesh, where, faults);
  ValidateNormals(mesh, where, faults);
  ValidateUvs(mesh, where, faults);
  ValidateColors(mesh, where, faults);
  ValidateTangents(mesh, where, faults);
  if (mesh.interpolation == Interpolation::kGouraud && mesh.normals.empty()) {
    faults->Add(where + "/interpolation", "Gouraud's needs a normal at each vertex",
                "give the mesh normals, or choose another interpolation");
  }
  if (faults->count() == before) ValidateIndices(mesh, where, faults);
  CheckMaterial(mesh.material, material_count, where + "/material", faults);
}

void ValidateShapes(const Scene& scene, FaultList* faults) {
  const size_t material_count = scene.materials.size();
  for (size_t i = 0; i < scene.spheres.size(); ++i) {
    if (IsSound(scene.spheres[i], material_count)) continue;  // no text for a million others
    ValidateSphere(scene.spheres[i], material_count, fmt::format("/spheres/{}", i), faults);
  }
  for (size_t i = 0; i < scene.meshes.size(); ++i) {
    ValidateMesh(scene.meshes[i], material_count, fmt::format("/meshes/{}", i), faults);
  }
}

// Spheres have intersection tests of their own, without holes and without sides.
void ValidateMaterialOfSphere(const Scene& scene, size_t index, FaultList* faults) {
  const size_t material = scene.spheres[index].material.index;
  if (material >= scene.materials.size() || !IsOfMeshes(scene.materials[material])) return;
  faults->Add(fmt::format("/spheres/{}/material", index),
              CutsHoles(scene.materials[material])
                  ? "its opacity cuts holes, which only meshes have"
                  : "it is single-sided, which only meshes are",
              "make the sphere of triangles: the shapes \"uv_sphere\" and \"icosphere\"");
}

// Reports shapes whose material they cannot have.
void ValidateMaterialsOfShapes(const Scene& scene, FaultList* faults) {
  if (std::none_of(scene.materials.begin(), scene.materials.end(), IsOfMeshes)) return;
  for (size_t i = 0; i < scene.spheres.size(); ++i) ValidateMaterialOfSphere(scene, i, faults);
}

// Checks the number of primitives, including those of lights.
void ValidatePrimitives(const Scene& scene, FaultList* faults) {
  uint64_t primitives = scene.spheres.size() + CountTriangles(scene);
  for (const Light& light : scene.lights) {
    const auto* area = std::get_if<MeshAreaLight>(&light.kind);
    if (area != nullptr && area->mesh != nullptr) primitives += area->mesh->triangles.size() / 3;
  }
  if (primitives > limits::kMaxPrimitives) {
    faults->Add("/shapes", fmt::format("{} spheres and triangles", primitives),
                fmt::format("at most {}", limits::kMaxPrimitives));
  }
}

}  // namespace nacre
