// SPDX-License-Identifier: Apache-2.0
#include "scene_io/obj_file.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include <fmt/format.h>

#include "base/error.h"
#include "base/excerpt.h"
#include "base/float_mode.h"
#include "base/numbers.h"
#include "base/parallel.h"
#include "color/transfer.h"
#include "scene_io/scene_budget.h"
#include "scene_io/text_file.h"
#include "scene_io/text_lines.h"

namespace nacre {
namespace {

constexpr uint64_t kMaxObjBytes = uint64_t{4} << 30;

// Statements that do not affect what nacre shows.
constexpr std::array<std::string_view, 14> kIgnored = {
    "g",        "o",        "mg", "usemap", "maplib",     "lod",       "bevel",
    "c_interp", "d_interp", "t",  "vw",     "shadow_obj", "trace_obj", "vp"};
constexpr std::array<std::string_view, 18> kFreeForm = {
    "curv", "curv2", "surf", "cstype", "deg", "bmat",  "step",  "parm", "trim",
    "hole", "scrv",  "sp",   "end",    "con", "ctech", "stech", "bsp",  "bzp"};

bool IsOneOf(const auto& words, std::string_view word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

// The numbers of elements before a place in the text, to which negative indices in faces are
// relative.
struct ObjCounts {
  size_t lines = 0, positions = 0, normals = 0, uvs = 0;

  void Add(const ObjCounts& other) {
    lines += other.lines;
    positions += other.positions;
    normals += other.normals;
    uvs += other.uvs;
  }
};

ObjCounts CountElements(std::string_view text) {
  ObjCounts counts;
  TextLines lines(text);
  for (std::string_view line; lines.Next(&line);) {
    const std::string_view word = NextWord(&line);
    if (word.empty() || word.size() > 2 || (word[0] != 'v' && word[0] != 'V')) continue;
    if (word.size() == 1) {
      ++counts.positions;
    } else if (word[1] == 'n' || word[1] == 'N') {
      ++counts.normals;
    } else if (word[1] == 't' || word[1] == 'T') {
      ++counts.uvs;
    }
  }
  counts.lines = lines.lines();
  return counts;
}

// Distinct texts, numbered in the order in which they were added.
class NumberedNames {
 public:
  // The number of a name, and whether it is new.
  std::pair<uint32_t, bool> Add(const std::string& name) {
    const auto [known, is_new] = numbers_.try_emplace(name, static_cast<uint32_t>(names_.size()));
    if (is_new) names_.push_back(name);
    return {known->second, is_new};
  }
  const std::vector<std::string>& names() const { return names_; }

 private:
  std::unordered_map<std::string, uint32_t> numbers_;
  std::vector<std::string> names_;
};

// The name of the group for "s off" and "s 0".
constexpr char kOff[] = "off";

// A piece of the text, cut between statements, and what is read from it. Pieces are read in
// parallel; what depends on the pieces before is resolved when they are joined.
struct ObjPiece {
  std::string_view text;
  ObjCounts before;  // in all pieces before this one

  std::vector<Vec3f> colors;  // like ObjFile::colors, but not decoded yet
  float largest_color = 0;
  std::vector<uint16_t> corner_counts;
  std::vector<ObjCorner> corners;
  uint64_t triangles = 0;
  std::vector<ObjFile::Use> uses, smoothing;  // faces and names are numbered within this piece
  NumberedNames materials, groups, libraries;
  struct Warning {
    std::string kind, example;  // only the first example of each kind is reported
  };
  std::vector<Warning> warnings;
  std::optional<Error> error;        // of the first wrong statement, where reading stops
  std::optional<Error> index_error;  // of the first face with an index beyond all positions
};

// So long that the cost per piece does not matter.
constexpr size_t kPieceBytes = size_t{1} << 20;

// Cuts the text after lines that are not continued in the next one. A text without LF is one piece.
std::vector<ObjPiece> CutIntoPieces(std::string_view text) {
  std::vector<ObjPiece> pieces;
  const auto goes_on = [&](size_t line_end) {
    if (line_end > 0 && text[line_end - 1] == '\r') --line_end;
    return line_end > 0 && text[line_end - 1] == '\\';
  };
  for (size_t begin = 0; begin < text.size();) {
    size_t end = text.find('\n', begin + kPieceBytes);
    while (end != std::string_view::npos && goes_on(end)) end = text.find('\n', end + 1);
    end = end == std::string_view::npos ? text.size() : end + 1;
    pieces.emplace_back().text = text.substr(begin, end - begin);
    begin = end;
  }
  return pieces;
}

class PieceReader {
 public:
  // Positions, normals and uvs are written to their indices in `obj`, which has room for all of the
  // file's. `most_triangles` is more than the file may have.
  PieceReader(const std::string& file, uint64_t most_triangles, ObjFile* obj, ObjPiece* piece)
      : file_(file),
        most_triangles_(most_triangles),
        obj_(*obj),
        piece_(*piece),
        positions_(piece->before.positions),
        normals_(piece->before.normals),
        uvs_(piece->before.uvs) {}

  void Read() {
    TextLines lines(piece_.text);
    try {
      for (std::string_view line; lines.Next(&line);) {
        number_ = piece_.before.lines + lines.number();
        ReadStatement(line);
        if (piece_.triangles >= most_triangles_) return;  // joining the pieces refuses it
      }
    } catch (const Error& error) {
      piece_.error = error;
    }
  }

 private:
  Error ErrorHere(std::string what, std::string hint = {}) const {
    return Error(ExitCode::kBadInput, fmt::format("{}:{}", file_, number_), std::move(what),
                 std::move(hint));
  }

  [[noreturn]] void Refuse(std::string what, std::string hint = {}) const {
    throw ErrorHere(std::move(what), std::move(hint));
  }

  void WarnOnce(const std::string& kind, std::string example = {}) {
    if (warned_.insert(kind).second) piece_.warnings.push_back({kind, std::move(example)});
  }

  // Warns of the first case, with the current line.
  void WarnOfFirst(const std::string& kind) {
    WarnOnce(kind, fmt::format(", the first in line {}", number_));
  }

  void ReadStatement(std::string_view line) {
    const std::string_view written = NextWord(&line);
    if (written.empty() || written.starts_with('#')) return;
    keyword_ = LowerCase(written.substr(0, 16));
    if (keyword_ == "v") {
      ReadPosition(line);
    } else if (keyword_ == "vn") {
      std::array<double, 3> n{};
      ReadNumbers(line, 3, n);
      const bool is_number = std::none_of(n.begin(), n.end(), [](double c) { return c != c; });
      if (!is_number) WarnOfFirst("normals that are no numbers are taken for none");
      obj_.normals[normals_++] = is_number ? Vec3d(n[0], n[1], n[2]) : Vec3d(0, 0, 0);
    } else if (keyword_ == "vt") {
      std::array<double, 2> uv{};
      ReadNumbers(line, 1, uv);
      for (double& c : uv) {
        if (!std::isnan(c)) continue;
        WarnOfFirst("texture coordinates that are no numbers are taken for 0");
        c = 0;
      }
      obj_.uvs[uvs_++] = Vec2d(uv[0], uv[1]);
    } else if (keyword_ == "f" || keyword_ == "fo") {
      ReadFace(line);
    } else if (keyword_ == "usemtl") {
      const uint32_t name = piece_.materials.Add(std::string(Trimmed(line))).first;
      piece_.uses.push_back({piece_.corner_counts.size(), name});
    } else if (keyword_ == "mtllib") {
      piece_.libraries.Add(std::string(Trimmed(line)));
    } else if (keyword_ == "s") {
      ReadSmoothing(NextWord(&line));
    } else if (keyword_ == "l") {
      WarnOnce("lines are not shown");
    } else if (keyword_ == "p") {
      WarnOnce("points are not shown");
    } else if (keyword_ == "call" || keyword_ == "csh") {
      WarnOnce("other files and commands are not called");
    } else if (IsOneOf(kFreeForm, keyword_)) {
      WarnOnce("free-form curves and surfaces are not shown");
    } else if (!IsOneOf(kIgnored, keyword_)) {
      WarnOnce("statements that are not known are left out",
               fmt::format(", the first is \"{}\"", Excerpt(written)));
    }
  }

  // Reads the number of a group. It may be any word: what some programs write after an "s" of their
  // own is treated as a group, too.
  void ReadSmoothing(std::string_view word) {
    const bool is_number = word.find_first_not_of("0123456789") == std::string_view::npos;
    std::string name = LowerCase(word.starts_with('#') ? std::string_view() : word);
    if (is_number && !word.empty()) {  // 01 equals 1, and 0 is off
      name.erase(0, name.find_first_not_of('0'));
      if (name.empty()) name = kOff;
    }
    if (name == "none" || name == "null") name = kOff;
    piece_.smoothing.push_back({piece_.corner_counts.size(), piece_.groups.Add(name).first});
  }

  // Reads up to N numbers of `line`, of which the first `fewest` are required. Words that stand for
  // NaN or infinity become NaN. Returns how many there are.
  template <size_t N>
  size_t ReadNumbers(std::string_view line, size_t fewest, std::array<double, N>& numbers) const {
    for (size_t i = 0; i < N; ++i) {
      const std::string_view word = NextWord(&line);
      if (i >= fewest && (word.empty() || word.starts_with('#'))) return i;
      std::optional<double> number = ParseNumber(word);
      if (!number && IsNoNumber(word)) number = std::numeric_limits<double>::quiet_NaN();
      if (!number) {
        constexpr std::array<std::string_view, 4> kNames = {"no", "one", "two", "three"};
        Refuse(fmt::format("\"{}\" is not a finite number", Excerpt(word)),
               fmt::format("\"{}\" is followed by {}", keyword_, kNames[fewest]));
      }
      numbers[i] = *number;
    }
    return N;
  }

  // Reads three numbers, followed by a weight, which only free-form surfaces have, or a colour.
  void ReadPosition(std::string_view line) {
    std::array<double, 6> numbers{};
    const size_t count = ReadNumbers(line, 3, numbers);
    Vec3d& position = obj_.positions[positions_++];
    position = Vec3d(numbers[0], numbers[1], numbers[2]);
    if (std::isnan(position.x + position.y + position.z)) {
      WarnOfFirst("faces with a position that is no number are left out, and such positions");
      position.x = std::numeric_limits<double>::quiet_NaN();
    }
    if (count < 6) {
      if (!piece_.colors.empty()) piece_.colors.emplace_back(1);
      return;
    }
    // Vertices before the first one with a colour are white.
    piece_.colors.resize(positions_ - piece_.before.positions, Vec3f(1));
    Vec3f& color = piece_.colors.back();
    for (int c = 0; c < 3; ++c) {
      const auto value = static_cast<float>(numbers[static_cast<size_t>(3 + c)]);
      color[c] = value > 0 ? value : 0;
      piece_.largest_color = std::max(piece_.largest_color, color[c]);
    }
  }

  // Takes an index off the front of `word`, up to a slash; 0 if there is none.
  int64_t NextIndex(std::string_view* word) const {
    const size_t length = std::min(word->find('/'), word->size());
    std::string_view digits = word->substr(0, length);
    word->remove_prefix(std::min(length + 1, word->size()));
    if (digits.starts_with('+')) digits.remove_prefix(1);
    if (digits.empty()) return 0;
    int64_t index = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), index);
    if (error != std::errc() || end != digits.data() + digits.size()) {
      Refuse(fmt::format("\"{}\" is no index", Excerpt(digits)),
             "a corner is a position, or position/uv/normal, counted from 1");
    }
    return index;
  }

  // The zero-based index of the element that an index of the file refers to: positive indices count
  // from the first element, negative ones backwards from the latest. Negative if there is no such
  // element. Elements may be defined after the face, so positive indices may exceed `so_far`.
  static int64_t PlaceOf(int64_t index, size_t so_far) {
    if (index > 0) return std::min<int64_t>(index - 1, 0x7fffffff);
    return index == 0 ? -1 : std::max<int64_t>(index, -0x7fffffff) + static_cast<int64_t>(so_far);
  }

  uint32_t PositionAt(int64_t index) {
    if (index == 0) Refuse("a face has position 0", "indices are counted from 1");
    const int64_t place = PlaceOf(index, positions_);
    if (place < 0) {
      Refuse(fmt::format("a face has position {}", index),
             fmt::format("there are {} before it", positions_));
    }
    // Positions beyond the end of the file's are an error only if there is no other one.
    if (place >= static_cast<int64_t>(obj_.positions.size()) && !piece_.index_error) {
      piece_.index_error = ErrorHere(fmt::format("a face has position {}", place + 1),
                                     fmt::format("there are {}", obj_.positions.size()));
    }
    return static_cast<uint32_t>(place);
  }

  // The index of a normal or of texture coordinates; -1 if the file does not have it.
  int32_t PlaceOrNone(int64_t index, size_t so_far, size_t count, const std::string& what) {
    const int64_t place = PlaceOf(index, so_far);
    if (place >= 0 && place < static_cast<int64_t>(count)) return static_cast<int32_t>(place);
    if (index != 0) WarnOfFirst(what + " that the file does not have are taken for none");
    return -1;
  }

  void ReadFace(std::string_view line) {
    const size_t first = piece_.corners.size();
    for (std::string_view word = NextWord(&line); !word.empty() && !word.starts_with('#');
         word = NextWord(&line)) {
      if (piece_.corners.size() - first == kMaxCorners) {
        Refuse(fmt::format("a face has more than {} corners", kMaxCorners),
               "cut it into triangles before");
      }
      const uint32_t position = PositionAt(NextIndex(&word));
      const bool has_uv = !word.empty() && word.front() != '/';  // 1//3 and 1// have none
      const int64_t uv = NextIndex(&word);
      const bool has_normal = !word.empty();
      const int64_t normal = NextIndex(&word);
      if (has_normal && normal == 0) {
        WarnOnce("normals of index 0 are taken for none: indices are counted from 1");
      }
      if (has_uv && uv == 0) {
        WarnOnce("texture coordinates of index 0 are taken for none: indices are counted from 1");
      }
      piece_.corners.push_back({position,
                                PlaceOrNone(uv, uvs_, obj_.uvs.size(), "texture coordinates"),
                                PlaceOrNone(normal, normals_, obj_.normals.size(), "normals")});
    }
    const size_t count = piece_.corners.size() - first;
    if (count < 3) {
      WarnOfFirst("faces of fewer than three corners are left out");
      piece_.corners.resize(first);
      return;
    }
    piece_.triangles += count - 2;
    piece_.corner_counts.push_back(static_cast<uint16_t>(count));
  }

  const std::string& file_;
  const uint64_t most_triangles_;
  ObjFile& obj_;
  ObjPiece& piece_;
  size_t positions_, normals_, uvs_;  // numbers of the file's elements read so far
  size_t number_ = 0;                 // the current line,
  std::string keyword_;               // and its first word, in lower case
  std::unordered_set<std::string> warned_;
};

// Reads all pieces, or those up to the first one with an error.
void ReadPieces(const std::string& file, uint64_t most_triangles, int threads,
                std::vector<ObjPiece>* pieces, ObjFile* obj) {
  std::vector<ObjCounts> counts(pieces->size());
  ParallelFor(pieces->size(), threads,
              [&](size_t i) { counts[i] = CountElements((*pieces)[i].text); });
  ObjCounts all;
  for (size_t i = 0; i < pieces->size(); ++i) {
    (*pieces)[i].before = all;
    all.Add(counts[i]);
  }
  obj->positions.resize(all.positions);
  obj->normals.resize(all.normals);
  obj->uvs.resize(all.uvs);
  std::atomic<size_t> first_wrong = pieces->size();
  ParallelFor(pieces->size(), threads, [&](size_t i) {
    if (i > first_wrong) return;
    const DefaultFloatMode mode;  // colours may be denormal
    ObjPiece& piece = (*pieces)[i];
    PieceReader(file, most_triangles, obj, &piece).Read();
    if (!piece.error && piece.triangles < most_triangles) return;
    size_t first = first_wrong;
    while (i < first && !first_wrong.compare_exchange_weak(first, i)) {
    }
  });
}

// Joins the pieces in their order. Throws the error of the first wrong statement of the file.
class PieceJoiner {
 public:
  PieceJoiner(const std::string& file, const std::function<void(const std::string&)>& warn,
              uint64_t budget, ObjFile* obj)
      : file_(file), warn_(warn), budget_(budget), obj_(*obj) {
    groups_.Add(kOff);  // number 0 is kSmoothingOff
  }

  // Frees each piece once it is joined.
  void Join(std::vector<ObjPiece> pieces) {
    size_t faces = 0, corners = 0;
    float largest_color = 0;
    std::optional<Error> index_error;
    for (const ObjPiece& piece : pieces) {
      Warn(piece);
      budget_.Spend(piece.triangles, file_, kTooManyForItsSize);
      if (piece.error) throw Error(*piece.error);
      if (!index_error) index_error = piece.index_error;
      faces += piece.corner_counts.size();
      corners += piece.corners.size();
      largest_color = std::max(largest_color, piece.largest_color);
    }
    if (faces == 0) throw Error(ExitCode::kBadInput, file_, "has no faces");
    if (index_error) throw Error(*index_error);
    obj_.corner_counts.reserve(faces);
    obj_.corners.reserve(corners);
    for (ObjPiece& piece : pieces) {
      const ObjPiece taken = std::move(piece);
      AddNames(taken);
      AddColors(taken);
      obj_.corner_counts.insert(obj_.corner_counts.end(), taken.corner_counts.begin(),
                                taken.corner_counts.end());
      obj_.corners.insert(obj_.corners.end(), taken.corners.begin(), taken.corners.end());
    }
    if (!obj_.colors.empty()) obj_.colors.resize(obj_.positions.size(), Vec3f(1));
    DecodeColors(largest_color);
  }

 private:
  void Warn(const ObjPiece& piece) {
    if (!warn_) return;
    for (const auto& [kind, example] : piece.warnings) {
      if (warned_.insert(kind).second) warn_(kind + example);
    }
  }

  void AddNames(const ObjPiece& piece) {
    for (const std::string& library : piece.libraries.names()) {
      if (libraries_.Add(library).second) obj_.libraries.push_back(library);
    }
    AddUses(piece.uses, piece.materials, &materials_, &obj_.uses);
    AddUses(piece.smoothing, piece.groups, &groups_, &obj_.smoothing);
    obj_.material_names = materials_.names();
  }

  void AddUses(const std::vector<ObjFile::Use>& of_piece, const NumberedNames& names,
               NumberedNames* all_names, std::vector<ObjFile::Use>* uses) const {
    std::vector<uint32_t> numbers;  // numbers in the file by number in the piece
    for (const std::string& name : names.names()) numbers.push_back(all_names->Add(name).first);
    for (const ObjFile::Use& use : of_piece) {
      const size_t first_face = obj_.corner_counts.size() + use.first_face;
      if (!uses->empty() && uses->back().first_face == first_face) uses->pop_back();
      uses->push_back({first_face, numbers[use.name]});
    }
  }

  // Vertices before the first one with a colour are white, as are others without a colour.
  void AddColors(const ObjPiece& piece) {
    if (piece.colors.empty()) return;
    obj_.colors.resize(piece.before.positions, Vec3f(1));
    obj_.colors.insert(obj_.colors.end(), piece.colors.begin(), piece.colors.end());
  }

  void DecodeColors(float largest) {
    const double scale = largest > 1 ? 1.0 / 255 : 1;
    for (Vec3f& color : obj_.colors) {
      for (int c = 0; c < 3; ++c) {
        color[c] = static_cast<float>(SrgbEotf(std::min(scale * double{color[c]}, 1.0)));
      }
    }
  }

  const std::string& file_;
  const std::function<void(const std::string&)>& warn_;
  SceneBudget budget_;
  ObjFile& obj_;
  NumberedNames materials_, groups_, libraries_;
  std::unordered_set<std::string> warned_;
};

}  // namespace

ObjFile ReadObjFile(const std::filesystem::path& path, int threads,
                    const std::function<void(const std::string&)>& warn) {
  const std::string file = path.string();
  const std::string bytes = ReadTextFile(path, kMaxObjBytes);
  const std::string_view text = WithoutByteOrderMark(bytes, file);
  const uint64_t budget = TrianglesOfBytes(bytes.size());
  std::vector<ObjPiece> pieces = CutIntoPieces(text);
  ObjFile obj;
  ReadPieces(file, budget + 1, threads, &pieces, &obj);
  PieceJoiner(file, warn, budget, &obj).Join(std::move(pieces));
  CheckCuts(obj.corner_counts, file);
  return obj;
}

}  // namespace nacre
