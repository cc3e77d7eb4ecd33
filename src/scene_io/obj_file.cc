// SPDX-License-Identifier: Apache-2.0
#include "scene_io/obj_file.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <exception>
#include <new>
#include <sstream>
#include <utility>

#include <fmt/format.h>

#include "base/error.h"
#include "scene_io/text_file.h"

namespace nacre {
namespace {

constexpr uint64_t kMaxObjBytes = uint64_t{4} << 30;

[[noreturn]] void RefuseObj(const std::string& where, std::string what, std::string hint = {}) {
  throw Error(ExitCode::kBadInput, where, std::move(what), std::move(hint));
}

bool IsFiniteNumber(std::string_view word) {
  if (word.starts_with('+')) word.remove_prefix(1);
  double number = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
  return error == std::errc() && end == word.data() + word.size() && std::isfinite(number);
}

// What is not used of a line: tinyobjloader would read its numbers, whose exponents it lets
// overflow.
void BlankAfter(size_t words, std::string_view line, std::string* text) {
  for (size_t i = 0; i < words; ++i) NextObjWord(&line);
  std::fill_n(text->begin() + (line.data() - text->data()), line.size(), ' ');
}

// What tinyobjloader would not survive or not tell: it takes numbers that it cannot read as 0, and
// makes room for as many tags (t) as the file says there are. Tags and weights (vw) become
// comments.
void Prepare(const std::string& file, std::string* text) {
  size_t start = 0;
  for (size_t line_number = 1; start < text->size(); ++line_number) {
    const size_t end = std::min(text->find('\n', start), text->size());
    std::string_view line = std::string_view(*text).substr(start, end - start);
    const std::string_view keyword = NextObjWord(&line);
    if (keyword == "v" || keyword == "vn") {
      CheckObjNumbers(line, keyword, 3, 3, fmt::format("{}:{}", file, line_number));
      BlankAfter(3, line, text);
    } else if (keyword == "vt") {
      CheckObjNumbers(line, keyword, 1, 2, fmt::format("{}:{}", file, line_number));
    } else if (keyword == "t" || keyword == "vw") {
      (*text)[static_cast<size_t>(keyword.data() - text->data())] = '#';
    }
    start = end + 1;
  }
}

ObjFile Parse(std::string text, const std::string& file, tinyobj::MaterialReader* materials) {
  ObjFile obj;
  std::string warning;
  std::string error;
  std::istringstream stream(std::move(text));
  constexpr bool kTriangulate = false;  // see scene/polygon.h
  constexpr bool kColorsByDefault = false;
  bool is_read = false;
  try {
    is_read = tinyobj::LoadObj(&obj.attributes, &obj.shapes, &obj.materials, &warning, &error,
                               &stream, materials, kTriangulate, kColorsByDefault);
  } catch (const Error&) {  // of the reader of materials
    throw;
  } catch (const std::bad_alloc&) {
    error = "there is no memory for it";
  } catch (const std::exception& e) {
    error = e.what();
  }
  if (!is_read || !error.empty()) {
    while (!error.empty() && error.back() == '\n') error.pop_back();
    RefuseObj(file, error.empty() ? "is not an OBJ file" : error);
  }
  if (warning.find("Degenerated face") != std::string::npos) {
    RefuseObj(file, "a face has fewer than three corners");
  }
  return obj;
}

void CheckIndices(const ObjFile& obj, const std::string& file) {
  const size_t positions = obj.attributes.vertices.size() / 3;
  const size_t normals = obj.attributes.normals.size() / 3;
  const size_t uvs = obj.attributes.texcoords.size() / 2;
  const auto check = [&](int index, size_t count, const char* what) {
    if (index < -1 || (index >= 0 && static_cast<size_t>(index) >= count)) {
      RefuseObj(file, fmt::format("a face has {} {}", what, int64_t{index} + 1),
                fmt::format("there are {}", count));
    }
  };
  size_t corners = 0;
  for (const tinyobj::shape_t& shape : obj.shapes) {
    size_t expected = 0;
    size_t most = 0;
    for (const size_t count : shape.mesh.num_face_vertices) {
      expected += count;
      most = std::max(most, count);
    }
    // Release 2.0.0rc10 counts them modulo 256; the bound is the same with all.
    if (most > 255 || expected != shape.mesh.indices.size()) {
      RefuseObj(file, "a face has more than 255 corners", "cut it into triangles before");
    }
    for (const tinyobj::index_t& corner : shape.mesh.indices) {
      if (corner.vertex_index < 0 || static_cast<size_t>(corner.vertex_index) >= positions) {
        RefuseObj(file, fmt::format("a face has position {}", int64_t{corner.vertex_index} + 1),
                  fmt::format("there are {}", positions));
      }
      check(corner.normal_index, normals, "normal");
      check(corner.texcoord_index, uvs, "uv");
    }
    corners += expected;
  }
  if (corners == 0) RefuseObj(file, "has no faces");
}

}  // namespace

std::string_view NextObjWord(std::string_view* line) {
  constexpr std::string_view kBlanks = " \t\r";
  const size_t begin = std::min(line->find_first_not_of(kBlanks), line->size());
  const size_t end = std::min(line->find_first_of(kBlanks, begin), line->size());
  const std::string_view word = line->substr(begin, end - begin);
  line->remove_prefix(end);
  return word;
}

void CheckObjNumbers(std::string_view line, std::string_view keyword, int fewest, int most,
                     const std::string& place) {
  constexpr std::array<std::string_view, 4> kNumberNames = {"no", "one", "two", "three"};
  for (int i = 0; i < most; ++i) {
    const std::string_view word = NextObjWord(&line);
    if (IsFiniteNumber(word) || (word.empty() && i >= fewest)) continue;
    RefuseObj(place, fmt::format("\"{}\" is not a finite number", word),
              fmt::format("\"{}\" is followed by {}", keyword,
                          kNumberNames[static_cast<size_t>(fewest)]));
  }
}

ObjFile ReadObjFile(const std::filesystem::path& path, tinyobj::MaterialReader* materials) {
  const std::string file = path.string();
  std::string text = ReadTextFile(path, kMaxObjBytes);
  Prepare(file, &text);
  ObjFile obj = Parse(std::move(text), file, materials);
  CheckIndices(obj, file);
  return obj;
}

}  // namespace nacre
