#include "scene_io/obj.h"

#include <charconv>
#include <cmath>
#include <exception>
#include <sstream>
#include <string_view>
#include <unordered_map>
#include <utility>

#include <fmt/format.h>
#include <tiny_obj_loader.h>

#include "base/error.h"
#include "scene/polygon.h"
#include "scene_io/text_file.h"

namespace nacre {
namespace {

constexpr uint64_t kMaxBytes = uint64_t{4} << 30;

[[noreturn]] void Refuse(const std::string& where, std::string what, std::string hint = {}) {
  throw Error(ExitCode::kBadInput, where, std::move(what), std::move(hint));
}

// Takes the next word off the front of `line`.
std::string_view NextWord(std::string_view* line) {
  constexpr std::string_view kBlanks = " \t\r";
  const size_t begin = std::min(line->find_first_not_of(kBlanks), line->size());
  const size_t end = std::min(line->find_first_of(kBlanks, begin), line->size());
  const std::string_view word = line->substr(begin, end - begin);
  line->remove_prefix(end);
  return word;
}

bool IsFiniteNumber(std::string_view word) {
  if (word.starts_with('+')) word.remove_prefix(1);
  double number = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
  return error == std::errc() && end == word.data() + word.size() && std::isfinite(number);
}

void CheckNumbers(std::string_view line, std::string_view keyword, const std::string& place) {
  for (int i = 0; i < 3; ++i) {
    const std::string_view word = NextWord(&line);
    if (IsFiniteNumber(word)) continue;
    Refuse(place, fmt::format("\"{}\" is not a finite number", word),
           fmt::format("\"{}\" is followed by three", keyword));
  }
}

// What tinyobjloader would not survive or not tell: it takes numbers that it cannot read as 0, and
// makes room for as many tags (t) as the file says there are. Tags become comments.
void Prepare(const std::string& file, std::string* text) {
  size_t start = 0;
  for (size_t line_number = 1; start < text->size(); ++line_number) {
    const size_t end = std::min(text->find('\n', start), text->size());
    std::string_view line = std::string_view(*text).substr(start, end - start);
    const std::string_view keyword = NextWord(&line);
    if (keyword == "v" || keyword == "vn") {
      CheckNumbers(line, keyword, fmt::format("{}:{}", file, line_number));
    } else if (keyword == "t") {
      (*text)[static_cast<size_t>(keyword.data() - text->data())] = '#';
    }
    start = end + 1;
  }
}

struct ObjFile {
  tinyobj::attrib_t attributes;
  std::vector<tinyobj::shape_t> shapes;
};

ObjFile Parse(std::string text, const std::string& file) {
  ObjFile obj;
  std::vector<tinyobj::material_t> materials;
  std::string warning;
  std::string error;
  std::istringstream stream(std::move(text));
  constexpr bool kTriangulate = false;  // see scene/polygon.h
  constexpr bool kColorsByDefault = false;
  bool is_read = false;
  try {
    is_read = tinyobj::LoadObj(&obj.attributes, &obj.shapes, &materials, &warning, &error, &stream,
                               nullptr, kTriangulate, kColorsByDefault);
  } catch (const std::exception& e) {
    error = e.what();
  }
  if (!is_read || !error.empty()) {
    while (!error.empty() && error.back() == '\n') error.pop_back();
    Refuse(file, error.empty() ? "is not an OBJ file" : error);
  }
  if (warning.find("Degenerated face") != std::string::npos) {
    Refuse(file, "a face has fewer than three corners");
  }
  return obj;
}

void CheckIndices(const ObjFile& obj, const std::string& file) {
  const size_t positions = obj.attributes.vertices.size() / 3;
  const size_t normals = obj.attributes.normals.size() / 3;
  size_t corners = 0;
  for (const tinyobj::shape_t& shape : obj.shapes) {
    size_t expected = 0;
    for (const unsigned char count : shape.mesh.num_face_vertices) expected += count;
    if (expected != shape.mesh.indices.size()) {  // it counts them modulo 256
      Refuse(file, "a face has more than 255 corners", "cut it into triangles before");
    }
    for (const tinyobj::index_t& corner : shape.mesh.indices) {
      if (corner.vertex_index < 0 || static_cast<size_t>(corner.vertex_index) >= positions) {
        Refuse(file, fmt::format("a face has position {}", int64_t{corner.vertex_index} + 1),
               fmt::format("there are {}", positions));
      }
      if (corner.normal_index < -1 ||
          (corner.normal_index >= 0 && static_cast<size_t>(corner.normal_index) >= normals)) {
        Refuse(file, fmt::format("a face has normal {}", int64_t{corner.normal_index} + 1),
               fmt::format("there are {}", normals));
      }
    }
    corners += expected;
  }
  if (corners == 0) Refuse(file, "has no faces");
}

bool AllHaveNormals(const ObjFile& obj) {
  for (const tinyobj::shape_t& shape : obj.shapes) {
    for (const tinyobj::index_t& corner : shape.mesh.indices) {
      if (corner.normal_index < 0) return false;
    }
  }
  return true;
}

Vec3d Triple(const std::vector<double>& numbers, int index) {
  const auto i = 3 * static_cast<size_t>(index);
  return {numbers[i], numbers[i + 1], numbers[i + 2]};
}

// Collects vertices: OBJ numbers positions and normals apart, a mesh has one normal per position.
class MeshBuilder {
 public:
  MeshBuilder(const ObjFile& obj, const std::string& file)
      : obj_(obj), file_(file), with_normals_(AllHaveNormals(obj)) {}

  void AddFace(const tinyobj::index_t* corners, size_t count) {
    face_.clear();
    for (size_t i = 0; i < count; ++i) {
      face_.push_back(Triple(obj_.attributes.vertices, corners[i].vertex_index));
    }
    local_.clear();
    Triangulate(face_, &local_);
    for (const uint32_t i : local_) mesh_.triangles.push_back(Vertex(corners[i]));
  }

  Mesh Take() { return std::move(mesh_); }

 private:
  uint32_t Vertex(const tinyobj::index_t& corner) {
    const auto position = static_cast<uint64_t>(corner.vertex_index);
    const auto normal = with_normals_ ? static_cast<uint64_t>(corner.normal_index) : 0;
    const auto [entry, is_new] = vertices_.try_emplace(
        position << 32 | normal, static_cast<uint32_t>(mesh_.positions.size()));
    if (!is_new) return entry->second;
    mesh_.positions.push_back(Triple(obj_.attributes.vertices, corner.vertex_index));
    if (with_normals_) {
      const Vec3d unit = Triple(obj_.attributes.normals, corner.normal_index).normalized();
      if (unit == Vec3d(0, 0, 0)) {
        Refuse(file_, fmt::format("normal {} has length 0", normal + 1),
               "leave the normals out to have smooth ones computed");
      }
      mesh_.normals.push_back(unit);
    }
    return entry->second;
  }

  const ObjFile& obj_;
  const std::string& file_;
  bool with_normals_;
  std::unordered_map<uint64_t, uint32_t> vertices_;
  std::vector<Vec3d> face_;      // of one face: its corners,
  std::vector<uint32_t> local_;  // and its triangles as indices into them
  Mesh mesh_;
};

}  // namespace

Mesh ReadObj(const std::filesystem::path& path) {
  const std::string file = path.string();
  std::string text = ReadTextFile(path, kMaxBytes);
  Prepare(file, &text);
  const ObjFile obj = Parse(std::move(text), file);
  CheckIndices(obj, file);

  MeshBuilder builder(obj, file);
  for (const tinyobj::shape_t& shape : obj.shapes) {
    const tinyobj::index_t* corners = shape.mesh.indices.data();
    for (const unsigned char count : shape.mesh.num_face_vertices) {
      builder.AddFace(corners, count);
      corners += count;
    }
  }
  Mesh mesh = builder.Take();
  mesh.name = path.stem().string();
  return mesh;
}

}  // namespace nacre
