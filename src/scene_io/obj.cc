#include "scene_io/obj.h"

#include <array>
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

// `line` begins with `fewest` numbers, or more up to `most`.
void CheckNumbers(std::string_view line, std::string_view keyword, int fewest, int most,
                  const std::string& place) {
  constexpr std::array<std::string_view, 4> kNumberNames = {"no", "one", "two", "three"};
  for (int i = 0; i < most; ++i) {
    const std::string_view word = NextWord(&line);
    if (IsFiniteNumber(word) || (word.empty() && i >= fewest)) continue;
    Refuse(place, fmt::format("\"{}\" is not a finite number", word),
           fmt::format("\"{}\" is followed by {}", keyword,
                       kNumberNames[static_cast<size_t>(fewest)]));
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
      CheckNumbers(line, keyword, 3, 3, fmt::format("{}:{}", file, line_number));
    } else if (keyword == "vt") {
      CheckNumbers(line, keyword, 1, 2, fmt::format("{}:{}", file, line_number));
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
  const size_t uvs = obj.attributes.texcoords.size() / 2;
  const auto check = [&](int index, size_t count, const char* what) {
    if (index < -1 || (index >= 0 && static_cast<size_t>(index) >= count)) {
      Refuse(file, fmt::format("a face has {} {}", what, int64_t{index} + 1),
             fmt::format("there are {}", count));
    }
  };
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
      check(corner.normal_index, normals, "normal");
      check(corner.texcoord_index, uvs, "uv");
    }
    corners += expected;
  }
  if (corners == 0) Refuse(file, "has no faces");
}

// Whether every corner has a normal, or a uv.
bool AllHave(const ObjFile& obj, int tinyobj::index_t::*index) {
  for (const tinyobj::shape_t& shape : obj.shapes) {
    for (const tinyobj::index_t& corner : shape.mesh.indices) {
      if (corner.*index < 0) return false;
    }
  }
  return true;
}

Vec3d Triple(const std::vector<double>& numbers, int index) {
  const auto i = 3 * static_cast<size_t>(index);
  return {numbers[i], numbers[i + 1], numbers[i + 2]};
}

// What makes a vertex of its own.
struct VertexKey {
  int position, normal, uv;
  bool operator==(const VertexKey&) const = default;
};
struct HashKey {
  size_t operator()(const VertexKey& key) const {
    uint64_t hash = static_cast<uint32_t>(key.position);
    for (const int index : {key.normal, key.uv}) {
      hash = (hash ^ hash >> 32) * 0x9e3779b97f4a7c15u + static_cast<uint32_t>(index);
    }
    return hash ^ hash >> 29;
  }
};

// Collects vertices: OBJ numbers positions, normals and uvs apart, a mesh has them by position.
class MeshBuilder {
 public:
  MeshBuilder(const ObjFile& obj, const std::string& file)
      : obj_(obj),
        file_(file),
        with_normals_(AllHave(obj, &tinyobj::index_t::normal_index)),
        with_uvs_(AllHave(obj, &tinyobj::index_t::texcoord_index)) {}

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
    const VertexKey key{corner.vertex_index, with_normals_ ? corner.normal_index : 0,
                        with_uvs_ ? corner.texcoord_index : 0};
    const auto [entry, is_new] =
        vertices_.try_emplace(key, static_cast<uint32_t>(mesh_.positions.size()));
    if (!is_new) return entry->second;
    mesh_.positions.push_back(Triple(obj_.attributes.vertices, corner.vertex_index));
    if (with_normals_) {
      const Vec3d unit = Triple(obj_.attributes.normals, corner.normal_index).normalized();
      if (unit == Vec3d(0, 0, 0)) {
        Refuse(file_, fmt::format("normal {} has length 0", key.normal + 1),
               "leave the normals out to have smooth ones computed");
      }
      mesh_.normals.push_back(unit);
    }
    if (with_uvs_) {
      const auto uv = 2 * static_cast<size_t>(key.uv);
      mesh_.uvs.emplace_back(obj_.attributes.texcoords[uv], obj_.attributes.texcoords[uv + 1]);
    }
    return entry->second;
  }

  const ObjFile& obj_;
  const std::string& file_;
  bool with_normals_, with_uvs_;
  std::unordered_map<VertexKey, uint32_t, HashKey> vertices_;
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
