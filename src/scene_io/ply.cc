// SPDX-License-Identifier: Apache-2.0
// scene_io/ply.cc: triangle meshes and clouds of points from PLY files.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <Imath/ImathBox.h>
#include <fmt/format.h>

#include "base/error.h"
#include "color/transfer.h"
#include "scene/limits.h"
#include "scene/mesh.h"
#include "scene/polygon.h"
#include "scene_io/model_files.h"
#include "scene_io/model_scene.h"
#include "scene_io/obj_materials.h"
#include "scene_io/ply_file.h"
#include "scene_io/scene_budget.h"
#include "scene_io/text_file.h"

namespace nacre {
namespace {

constexpr uint64_t kMaxPlyBytes = uint64_t{4} << 30;

// The contents of a file, unprocessed.
struct PlyData {
  std::vector<Vec3d> positions, normals;
  std::vector<Vec2d> uvs;
  std::vector<Rgb> colors;  // linear
  bool has_face_colors = false, has_face_uvs = false;
  std::vector<double> radii, materials;
  std::vector<uint32_t> triangles;
  static constexpr uint64_t kNone = ~uint64_t{0};
  uint64_t first_without_area = kNone;  // index of the first face of fewer than three corners
};

class PlyReader {
 public:
  explicit PlyReader(const std::filesystem::path& path)
      : file_(path.string()),
        bytes_(ReadBytes(path, kMaxPlyBytes,
                         [&](std::string_view head, uint64_t size) {
                           CheckPlyMagic(head, file_);
                           return size;
                         })),
        header_(ReadPlyHeader(bytes_, file_)),
        numbers_(bytes_, header_, file_),
        budget_(TrianglesOfBytes(bytes_.size())) {}

  PlyData Read() {
    const auto vertices = std::ranges::find(header_.elements, "vertex", &PlyElement::name);
    if (vertices == header_.elements.end() || vertices->count == 0) Refuse("has no vertices");
    vertex_count_ = vertices->count;
    if (vertex_count_ > 0xfffffffeu) Refuse("has more than 4 thousand million vertices");
    for (const PlyElement& element : header_.elements) {
      if (element.name == "vertex") {
        ReadVertices(element);
      } else if (element.name == "face") {
        ReadFaces(element);
      } else if (element.name == "tristrips") {
        ReadStrips(element);
      } else {
        for (uint64_t i = 0; i < element.count; ++i) {
          for (const PlyProperty& property : element.properties) numbers_.Skip(property);
        }
      }
    }
    CutPolygons();
    if (data_.triangles.empty() && data_.first_without_area != PlyData::kNone) {
      Refuse("has no face of three corners or more");
    }
    return std::move(data_);
  }

 private:
  [[noreturn]] void Refuse(std::string what, std::string hint = {}) const {
    throw Error(ExitCode::kBadInput, file_, std::move(what), std::move(hint));
  }

  // Throws an error located at the number that was read last.
  [[noreturn]] void RefuseNumber(std::string what, std::string hint) const {
    throw Error(ExitCode::kBadInput, numbers_.place(), std::move(what), std::move(hint));
  }

  // The indices of several properties; all kNone unless all of them exist and none is a list.
  template <size_t N>
  static std::array<size_t, N> FindAll(const PlyElement& element,
                                       const std::array<std::string_view, N>& names) {
    std::array<size_t, N> places;
    for (size_t i = 0; i < N; ++i) {
      places[i] = element.Find(names[i]);
      if (places[i] == PlyElement::kNone || element.properties[places[i]].is_list) {
        places.fill(PlyElement::kNone);
        return places;
      }
    }
    return places;
  }

  // The indices of the first candidate whose properties all exist.
  template <size_t N, size_t Count>
  static std::array<size_t, N> FindFirst(
      const PlyElement& element, const std::array<std::array<std::string_view, N>, Count>& names) {
    std::array<size_t, N> places{};
    for (const auto& candidate : names) {
      places = FindAll<N>(element, candidate);
      if (places[0] != PlyElement::kNone) break;
    }
    return places;
  }

  static constexpr std::array<std::array<std::string_view, 3>, 3> kColorNames = {
      {{"red", "green", "blue"},
       {"diffuse_red", "diffuse_green", "diffuse_blue"},
       {"r", "g", "b"}}};

  void ReadVertices(const PlyElement& element) {
    const auto xyz = FindAll<3>(element, {"x", "y", "z"});
    if (xyz[0] == PlyElement::kNone) Refuse("its vertices have no x, y and z");
    const auto normal =
        FindFirst<3, 2>(element, {{{"nx", "ny", "nz"}, {"normal_x", "normal_y", "normal_z"}}});
    const auto color = FindFirst(element, kColorNames);
    const auto radius = FindAll<1>(element, {"radius"});
    const auto material = FindAll<1>(element, {"material"});
    const auto uv = FindFirst<2, 4>(
        element,
        {{{"u", "v"}, {"s", "t"}, {"texture_u", "texture_v"}, {"texture_s", "texture_t"}}});
    data_.positions.reserve(element.count);
    std::vector<double> values(element.properties.size());
    const auto triple = [&](const std::array<size_t, 3>& at) {
      return Vec3d(values[at[0]], values[at[1]], values[at[2]]);
    };
    for (uint64_t i = 0; i < element.count; ++i) {
      for (size_t k = 0; k < values.size(); ++k) {
        const PlyProperty& property = element.properties[k];
        if (property.is_list) {
          numbers_.Skip(property);
        } else {
          values[k] = numbers_.Next(property.type);
        }
      }
      AddPosition(triple(xyz), i);
      if (normal[0] != PlyElement::kNone) data_.normals.push_back(triple(normal).normalized());
      if (uv[0] != PlyElement::kNone) data_.uvs.emplace_back(values[uv[0]], values[uv[1]]);
      if (color[0] != PlyElement::kNone) {
        data_.colors.push_back(Linear(triple(color), element.properties[color[0]].type));
      }
      if (radius[0] != PlyElement::kNone) data_.radii.push_back(values[radius[0]]);
      if (material[0] != PlyElement::kNone) data_.materials.push_back(values[material[0]]);
    }
  }

  void AddPosition(const Vec3d& position, uint64_t number) {
    if (!limits::kCoordinate.Contains(position)) {
      RefuseNumber(
          fmt::format("vertex {} is at [{}, {}, {}]", number, position.x, position.y, position.z),
          "each coordinate " + Describe(limits::kCoordinate));
    }
    data_.positions.push_back(position);
  }

  // Integers are sRGB codes; floats are linear.
  static Rgb Linear(const Vec3d& color, NumberType type) {
    const bool is_real = type == NumberType::kFloat || type == NumberType::kDouble;
    const double largest = is_real ? 1 : type == NumberType::kUint16 ? 65535 : 255;
    Rgb linear;
    for (int c = 0; c < 3; ++c) {
      const double value = color[c] > 0 ? std::min(color[c] / largest, 1.0) : 0;  // NaN becomes 0
      linear[c] = is_real ? value : SrgbEotf(value);
    }
    return linear;
  }

  // The vertex with the number `index` of the file, of a strip or of the present face.
  uint32_t VertexOf(double index, bool of_strip = false) const {
    if (!(index >= 0) || index >= static_cast<double>(vertex_count_) ||
        index != std::floor(index)) {
      const std::string what = of_strip ? "a strip" : fmt::format("face {}", faces_);
      RefuseNumber(fmt::format("{} has vertex {}", what, index),
                   fmt::format("there are {}, counted from 0", vertex_count_));
    }
    return static_cast<uint32_t>(index);
  }

  // The index of the list of vertex indices, or kNone.
  static size_t FindIndices(const PlyElement& element) {
    for (const std::string_view name : {"vertex_indices", "vertex_index", "vertex_indexes"}) {
      const size_t place = element.Find(name);
      if (place != PlyElement::kNone && element.properties[place].is_list) return place;
    }
    return PlyElement::kNone;
  }

  // Calls read(property) where the list `list` of each element comes next, and skips all others.
  template <class Read>
  void ForEachList(const PlyElement& element, size_t list, const Read& read) {
    for (faces_ = 0; faces_ < element.count; ++faces_) {
      for (size_t k = 0; k < element.properties.size(); ++k) {
        const PlyProperty& property = element.properties[k];
        k == list ? read(property) : numbers_.Skip(property);
      }
    }
  }

  void ReadFaces(const PlyElement& element) {
    const size_t indices = FindIndices(element);
    if (indices == PlyElement::kNone) Refuse("its faces have no list \"vertex_indices\"");
    data_.has_face_colors = FindFirst(element, kColorNames)[0] != PlyElement::kNone;
    data_.has_face_uvs = element.Find("texcoord") != PlyElement::kNone;
    ForEachList(element, indices, [&](const PlyProperty& property) {
      const size_t count = numbers_.NextLength(property);
      if (count > kMaxCorners) {
        RefuseNumber(fmt::format("face {} has {} corners", faces_, count),
                     fmt::format("at most {}", kMaxCorners));
      }
      if (count < 3) {
        for (size_t c = 0; c < count; ++c) VertexOf(numbers_.Next(property.type));
        if (data_.first_without_area == PlyData::kNone) data_.first_without_area = faces_;
        return;
      }
      budget_.Spend(count - 2, file_, kTooManyForItsSize);
      corner_counts_.push_back(static_cast<uint16_t>(count));
      for (size_t c = 0; c < count; ++c) {
        corners_.push_back(VertexOf(numbers_.Next(property.type)));
      }
    });
  }

  // Reads strips, which follow each other with -1 between them.
  void ReadStrips(const PlyElement& element) {
    ForEachList(element, FindIndices(element), [&](const PlyProperty& property) {
      std::vector<uint32_t> strip;
      const size_t count = numbers_.NextLength(property);
      budget_.Spend(count, file_, kTooManyForItsSize);
      for (size_t k = 0; k < count; ++k) AddToStrip(numbers_.Next(property.type), &strip);
    });
  }

  void AddToStrip(double index, std::vector<uint32_t>* strip) {
    if (index == -1) {
      strip->clear();
      return;
    }
    strip->push_back(VertexOf(index, /*of_strip=*/true));
    const size_t n = strip->size();
    if (n < 3) return;
    const uint32_t a = (*strip)[n - 3], b = (*strip)[n - 2], c = (*strip)[n - 1];
    const bool odd = n % 2 == 0;  // every second triangle has the opposite winding
    data_.triangles.insert(data_.triangles.end(), {odd ? b : a, odd ? a : b, c});
  }

  // To be called after all elements are read: faces may come before the vertices.
  void CutPolygons() {
    std::vector<Vec3d> corners;
    std::vector<uint32_t> local;
    const uint32_t* face = corners_.data();
    CheckCuts(corner_counts_, file_);
    for (const uint16_t count : corner_counts_) {
      corners.clear();
      local.clear();
      for (size_t i = 0; i < count; ++i) corners.push_back(data_.positions[face[i]]);
      Triangulate(corners, &local);
      for (const uint32_t i : local) data_.triangles.push_back(face[i]);
      face += count;
    }
  }

  std::string file_;
  std::string bytes_;
  PlyHeader header_;
  PlyNumbers numbers_;
  SceneBudget budget_;
  PlyData data_;
  uint64_t vertex_count_ = 0;
  uint64_t faces_ = 0;                   // number of the present face, or strip
  std::vector<uint16_t> corner_counts_;  // for each face,
  std::vector<uint32_t> corners_;        // and its vertex indices
};

void WarnOfFaces(const PlyData& data, const std::filesystem::path& path,
                 const std::function<void(const std::string&)>& on_warning) {
  if (data.first_without_area == PlyData::kNone || !on_warning) return;
  on_warning(fmt::format("{}: faces of fewer than three corners are left out, the first is face {}",
                         path.string(), data.first_without_area));
}

Mesh TakeMesh(const std::filesystem::path& path, PlyData* data) {
  Mesh mesh;
  mesh.name = path.stem().string();
  mesh.positions = std::move(data->positions);
  mesh.normals = std::move(data->normals);
  mesh.uvs = std::move(data->uvs);
  mesh.triangles = std::move(data->triangles);
  if (!mesh.normals.empty()) MendNormals(&mesh);
  return mesh;
}

// About a third of the distance between neighbours, if the points lie on a surface.
double SuitableRadius(const std::vector<Vec3d>& positions) {
  Imath::Box3d box;
  for (const Vec3d& position : positions) box.extendBy(position);
  const double spacing = box.size().length() / std::sqrt(static_cast<double>(positions.size()));
  return spacing > 0 ? std::max(spacing / 3, limits::kLength.min) : 1;
}

constexpr size_t kMaxColors = 4096;

// Replaces the scene's materials by those of the colours in a cloud, which are rounded to `steps`
// per channel unless that is 0. Returns the index of each point's material; nullopt if there would
// be more than kMaxColors.
std::optional<std::vector<uint32_t>> AddColors(const std::vector<Rgb>& colors, int steps,
                                               Scene* scene) {
  std::map<std::array<double, 3>, uint32_t> by_color;
  std::vector<uint32_t> indices;
  scene->materials.clear();
  for (const Rgb& color : colors) {
    std::array<double, 3> key = {color.x, color.y, color.z};
    if (steps > 0) {
      for (double& c : key) c = SrgbEotf(std::round(SrgbOetf(c) * (steps - 1)) / (steps - 1));
    }
    const auto next = static_cast<uint32_t>(scene->materials.size());
    const auto [entry, is_new] = by_color.try_emplace(key, next);
    if (is_new) {
      if (scene->materials.size() == kMaxColors) return std::nullopt;
      Material& material = scene->materials.emplace_back(MakeClay());
      material.name = fmt::format("color {}", next);
      std::get<MetallicRoughnessMaterial>(material.model).base_color = {key[0], key[1], key[2]};
    }
    indices.push_back(entry->second);
  }
  return indices;
}

void AddCloud(const PlyData& data, const std::string& file, const LoadOptions& options,
              Scene* scene) {
  if (static_cast<double>(data.positions.size()) > limits::kCloudCount.max) {
    throw Error(ExitCode::kBadInput, file, fmt::format("{} points", data.positions.size()),
                fmt::format("at most {}", limits::kCloudCount.max));
  }
  std::optional<std::vector<uint32_t>> materials = AddColors(data.colors, 0, scene);
  if (!materials) {
    materials = AddColors(data.colors, 16, scene);
    if (options.on_warning) {
      options.on_warning(file + ": more than 4096 colours: rounded to 16 steps a channel");
    }
  }
  if (data.colors.empty()) scene->materials.push_back(MakeClay());
  const double radius = SuitableRadius(data.positions);
  scene->spheres.reserve(data.positions.size());
  for (size_t i = 0; i < data.positions.size(); ++i) {
    const double own = data.radii.empty() ? radius : data.radii[i];
    if (!limits::kLength.Contains(own)) {
      throw Error(ExitCode::kBadInput, file, fmt::format("vertex {} has radius {}", i, own),
                  "a length " + Describe(limits::kLength));
    }
    scene->spheres.push_back({data.positions[i], own, {materials->empty() ? 0 : (*materials)[i]}});
  }
}

}  // namespace

Mesh ReadPly(const std::filesystem::path& path,
             const std::function<void(const std::string&)>& on_warning) {
  PlyData data = PlyReader(path).Read();
  WarnOfFaces(data, path, on_warning);
  if (data.triangles.empty()) throw Error(ExitCode::kBadInput, path.string(), "has no faces");
  return TakeMesh(path, &data);
}

PlyPoints ReadPlyPoints(const std::filesystem::path& path) {
  PlyData data = PlyReader(path).Read();
  if (!data.triangles.empty()) {
    throw Error(ExitCode::kBadInput, path.string(), "has faces", "it is a \"mesh\"");
  }
  return {std::move(data.positions), std::move(data.radii), std::move(data.materials)};
}

Scene ReadPlyScene(const std::filesystem::path& path, const LoadOptions& options) {
  PlyData data = PlyReader(path).Read();
  WarnOfFaces(data, path, options.on_warning);
  Scene scene;
  if (data.triangles.empty()) {
    AddCloud(data, path.string(), options, &scene);
    return scene;
  }
  const auto warn = [&](const char* text) {
    if (options.on_warning) options.on_warning(path.string() + ": " + text);
  };
  if (data.has_face_colors) warn("the colours of faces are not shown: those of vertices are");
  if (data.has_face_uvs) {
    warn("texture coordinates of faces are left out: those of vertices are read");
  }
  scene.materials.push_back(MakeClay());
  Mesh& mesh = scene.meshes.emplace_back(TakeMesh(path, &data));
  mesh.material = {0};
  mesh.colors.assign(data.colors.begin(), data.colors.end());
  if (mesh.normals.empty()) ComputeNormals(NormalWeighting::kAngle, kModelCreaseAngleDeg, &mesh);
  if (!HasArea(mesh)) {
    throw Error(ExitCode::kBadInput, path.string(), "has no face with an area");
  }
  SplitColoredMaterials(&scene);
  return scene;
}

}  // namespace nacre
