// SPDX-License-Identifier: Apache-2.0
#include "scene_io/obj_file.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include <fmt/format.h>

#include "base/error.h"
#include "base/excerpt.h"
#include "color/transfer.h"
#include "scene_io/scene_budget.h"
#include "scene_io/text_file.h"
#include "scene_io/text_lines.h"

namespace nacre {
namespace {

constexpr uint64_t kMaxObjBytes = uint64_t{4} << 30;
constexpr size_t kMaxObjCorners = 255;

// Statements that say nothing about what is shown here.
constexpr std::array<std::string_view, 15> kIgnored = {
    "g",        "o",        "s", "mg", "usemap",     "maplib",    "lod", "bevel",
    "c_interp", "d_interp", "t", "vw", "shadow_obj", "trace_obj", "vp"};
constexpr std::array<std::string_view, 18> kFreeForm = {
    "curv", "curv2", "surf", "cstype", "deg", "bmat",  "step",  "parm", "trim",
    "hole", "scrv",  "sp",   "end",    "con", "ctech", "stech", "bsp",  "bzp"};

bool IsOneOf(const auto& words, std::string_view word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

class ObjReader {
 public:
  ObjReader(const std::filesystem::path& path, const std::function<void(const std::string&)>& warn)
      : file_(path.string()), warn_(warn) {}

  ObjFile Read(std::string_view text) {
    budget_ = SceneBudget(TrianglesOfBytes(text.size()));
    TextLines lines(WithoutByteOrderMark(text, file_));
    for (std::string_view line; lines.Next(&line);) {
      number_ = lines.number();
      ReadStatement(line);
    }
    if (obj_.corner_counts.empty()) {
      throw Error(ExitCode::kBadInput, file_, "has no faces");
    }
    CheckIndices();
    FinishColors();
    return std::move(obj_);
  }

 private:
  [[noreturn]] void Refuse(size_t line, std::string what, std::string hint = {}) const {
    throw Error(ExitCode::kBadInput, fmt::format("{}:{}", file_, line), std::move(what),
                std::move(hint));
  }

  void WarnOnce(const std::string& text) {
    if (warn_ && warned_.insert(text).second) warn_(text);
  }

  void ReadStatement(std::string_view line) {
    const std::string_view written = NextWord(&line);
    if (written.empty() || written.starts_with('#')) return;
    keyword_ = written.substr(0, 16);
    for (char& c : keyword_) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    if (keyword_ == "v") {
      ReadPosition(line);
    } else if (keyword_ == "vn") {
      std::array<double, 3> n{};
      ReadNumbers(line, 3, n);
      obj_.normals.emplace_back(n[0], n[1], n[2]);
    } else if (keyword_ == "vt") {
      std::array<double, 2> uv{};
      ReadNumbers(line, 1, uv);
      obj_.uvs.emplace_back(uv[0], uv[1]);
    } else if (keyword_ == "f" || keyword_ == "fo") {
      ReadFace(line);
    } else if (keyword_ == "usemtl") {
      UseMaterial(std::string(Trimmed(line)));
    } else if (keyword_ == "mtllib") {
      const auto [name, is_new] = libraries_.emplace(Trimmed(line));
      if (is_new) obj_.libraries.push_back(*name);
    } else if (keyword_ == "l") {
      WarnOnce("lines are not shown");
    } else if (keyword_ == "p") {
      WarnOnce("points are not shown");
    } else if (keyword_ == "call" || keyword_ == "csh") {
      WarnOnce("other files and commands are not called");
    } else if (IsOneOf(kFreeForm, keyword_)) {
      WarnOnce("free-form curves and surfaces are not shown");
    } else if (!IsOneOf(kIgnored, keyword_) && !std::exchange(warned_of_unknown_, true)) {
      WarnOnce(fmt::format("statements that are not known are left out, the first is \"{}\"",
                           Excerpt(written)));
    }
  }

  // The first numbers of `line`, of which `fewest` must be there. Returns how many there are.
  template <size_t N>
  size_t ReadNumbers(std::string_view line, size_t fewest, std::array<double, N>& numbers) const {
    for (size_t i = 0; i < N; ++i) {
      const std::string_view word = NextWord(&line);
      if (i >= fewest && (word.empty() || word.starts_with('#'))) return i;
      const std::optional<double> number = ParseNumber(word);
      if (!number) {
        constexpr std::array<std::string_view, 4> kNames = {"no", "one", "two", "three"};
        Refuse(number_, fmt::format("\"{}\" is not a finite number", Excerpt(word)),
               fmt::format("\"{}\" is followed by {}", keyword_, kNames[fewest]));
      }
      numbers[i] = *number;
    }
    return N;
  }

  // Three numbers, and then a weight, which only free-form surfaces have, or a colour.
  void ReadPosition(std::string_view line) {
    std::array<double, 6> numbers{};
    const size_t count = ReadNumbers(line, 3, numbers);
    obj_.positions.emplace_back(numbers[0], numbers[1], numbers[2]);
    if (count < 6) {
      if (!obj_.colors.empty()) obj_.colors.emplace_back(1);
      return;
    }
    obj_.colors.resize(obj_.positions.size(), Vec3f(1));  // vertices before the first one are white
    Vec3f& color = obj_.colors.back();
    for (int c = 0; c < 3; ++c) {
      const auto value = static_cast<float>(numbers[static_cast<size_t>(3 + c)]);
      color[c] = value > 0 ? value : 0;
      largest_color_ = std::max(largest_color_, color[c]);
    }
  }

  // Takes an index off the front of `word`, up to a slash: 0 if there is none.
  int64_t NextIndex(std::string_view* word) const {
    const size_t length = std::min(word->find('/'), word->size());
    std::string_view digits = word->substr(0, length);
    word->remove_prefix(std::min(length + 1, word->size()));
    if (digits.starts_with('+')) digits.remove_prefix(1);
    if (digits.empty()) return 0;
    int64_t index = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), index);
    if (error != std::errc() || end != digits.data() + digits.size()) {
      Refuse(number_, fmt::format("\"{}\" is no index", Excerpt(digits)),
             "a corner is a position, or position/uv/normal, counted from 1");
    }
    return index;
  }

  // The zero-based element that an index refers to: positive indices count from the first element,
  // negative ones backwards from the latest; 0 gives -1, none. Elements may be defined after the
  // face, so CheckIndices tests the upper bound at the end of the file.
  int64_t PlaceOf(int64_t index, size_t so_far, std::string_view what) const {
    if (index > 0) return std::min<int64_t>(index - 1, 0x7fffffff);
    const auto count = static_cast<int64_t>(so_far);
    if (index < -count) {
      Refuse(number_, fmt::format("a face has {} {}", what, index),
             fmt::format("there are {} before it", count));
    }
    return index == 0 ? -1 : count + index;
  }

  void ReadFace(std::string_view line) {
    size_t count = 0;
    for (std::string_view word = NextWord(&line); !word.empty() && !word.starts_with('#');
         word = NextWord(&line)) {
      if (++count > kMaxObjCorners) {
        Refuse(number_, fmt::format("a face has more than {} corners", kMaxObjCorners),
               "cut it into triangles before");
      }
      const int64_t position = PlaceOf(NextIndex(&word), obj_.positions.size(), "position");
      if (position < 0) Refuse(number_, "a face has position 0", "indices are counted from 1");
      const bool has_uv = !word.empty() && word.front() != '/';  // 1//3 has none, nor has 1//
      const int64_t uv = NextIndex(&word);
      const bool has_normal = !word.empty();
      const int64_t normal = NextIndex(&word);
      if (has_normal && normal == 0) {
        WarnOnce("normals of index 0 are taken for none: indices are counted from 1");
      }
      if (has_uv && uv == 0) {
        WarnOnce("texture coordinates of index 0 are taken for none: indices are counted from 1");
      }
      obj_.corners.push_back(
          {static_cast<uint32_t>(position),
           static_cast<int32_t>(PlaceOf(uv, obj_.uvs.size(), "uv")),
           static_cast<int32_t>(PlaceOf(normal, obj_.normals.size(), "normal"))});
    }
    if (count < 3) Refuse(number_, "a face has fewer than three corners");
    SpendTriangles(count - 2, file_, &budget_, kTooManyForItsSize);
    obj_.corner_counts.push_back(static_cast<unsigned char>(count));
    face_lines_.push_back(static_cast<uint32_t>(number_));
  }

  void UseMaterial(std::string name) {
    const auto next = static_cast<uint32_t>(obj_.material_names.size());
    const auto [known, is_new] = materials_.try_emplace(std::move(name), next);
    if (is_new) obj_.material_names.push_back(known->first);
    const size_t first_face = obj_.corner_counts.size();
    if (!obj_.uses.empty() && obj_.uses.back().first_face == first_face) obj_.uses.pop_back();
    obj_.uses.push_back({first_face, known->second});
  }

  void CheckIndices() const {
    const auto check = [&](size_t face, int64_t place, size_t count, std::string_view what) {
      if (place < static_cast<int64_t>(count)) return;
      Refuse(face_lines_[face], fmt::format("a face has {} {}", what, place + 1),
             fmt::format("there are {}", count));
    };
    const ObjCorner* corner = obj_.corners.data();
    for (size_t face = 0; face < obj_.corner_counts.size(); ++face) {
      for (size_t i = 0; i < obj_.corner_counts[face]; ++i, ++corner) {
        check(face, corner->position, obj_.positions.size(), "position");
        check(face, corner->normal, obj_.normals.size(), "normal");
        check(face, corner->uv, obj_.uvs.size(), "uv");
      }
    }
  }

  void FinishColors() {
    const double scale = largest_color_ > 1 ? 1.0 / 255 : 1;
    for (Vec3f& color : obj_.colors) {
      for (int c = 0; c < 3; ++c) {
        color[c] = static_cast<float>(SrgbEotf(std::min(scale * double{color[c]}, 1.0)));
      }
    }
  }

  const std::string file_;
  const std::function<void(const std::string&)>& warn_;
  ObjFile obj_;
  size_t number_ = 0;    // of the line that is read,
  std::string keyword_;  // and its first word, in lower case
  float largest_color_ = 0;
  SceneBudget budget_{0};
  bool warned_of_unknown_ = false;
  std::vector<uint32_t> face_lines_;
  std::unordered_map<std::string, uint32_t> materials_;
  std::unordered_set<std::string> warned_, libraries_;
};

}  // namespace

ObjFile ReadObjFile(const std::filesystem::path& path,
                    const std::function<void(const std::string&)>& warn) {
  return ObjReader(path, warn).Read(ReadTextFile(path, kMaxObjBytes));
}

}  // namespace nacre
