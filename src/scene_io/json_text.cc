// SPDX-License-Identifier: Apache-2.0
#include "scene_io/json_text.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <unordered_set>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/error.h"
#include "base/excerpt.h"
#include "scene_io/text_file.h"
#include "scene_io/text_lines.h"

namespace nacre {
namespace {

// The line and column of the last one of the first `bytes_read` bytes, counted from 1: "3:14".
std::string LineAndColumn(std::string_view text, size_t bytes_read) {
  const size_t offset = bytes_read > 0 ? bytes_read - 1 : 0;
  const std::string_view before = text.substr(0, std::min(offset, text.size()));
  const auto line = std::count(before.begin(), before.end(), '\n') + 1;
  const size_t line_start = before.rfind('\n') + 1;  // npos + 1 is 0
  return fmt::format("{}:{}", line, before.size() - line_start + 1);
}

// Iterates over the text. The position is shared with TreeBuilder, which may advance it.
struct SharedIterator {
  using iterator_category = std::input_iterator_tag;
  using value_type = char;
  using difference_type = std::ptrdiff_t;
  using pointer = const char*;
  using reference = const char&;

  const char** at = nullptr;

  reference operator*() const { return **at; }
  SharedIterator& operator++() {
    ++*at;
    return *this;
  }
  bool operator==(const SharedIterator& other) const { return *at == *other.at; }
};

// Builds the tree from the parser's events. The parser's own builder reports neither repeated names
// nor the location of a number that overflows.
class TreeBuilder : public nlohmann::json_sax<Json> {
 public:
  TreeBuilder(std::string_view text, const std::string& file, FaultList* faults,
              const std::function<void(double)>& on_progress, PlainSpheres* spheres)
      : text_(text),
        file_(file),
        faults_(faults),
        on_progress_(on_progress),
        spheres_(spheres),
        reached_(text.data()),
        end_(text.data() + text.size()) {}

  SharedIterator begin() { return {&reached_}; }
  SharedIterator end() { return {&end_}; }

  Json TakeRoot() {
    if (spheres_ != nullptr) spheres_->materials = sphere_reader_.TakeMaterials();
    return std::move(root_);
  }

  bool null() override { return Add(nullptr); }
  bool boolean(bool value) override { return Add(value); }
  bool number_integer(number_integer_t value) override { return Add(value); }
  bool number_unsigned(number_unsigned_t value) override { return Add(value); }
  bool number_float(number_float_t value, const string_t&) override { return Add(value); }
  bool string(string_t& value) override { return Add(std::move(value)); }
  bool binary(binary_t&) override { return false; }  // JSON text has none
  bool start_object(size_t) override { return Open(Json::object()); }
  bool start_array(size_t) override { return Open(Json::array()); }
  bool end_object() override { return Close(); }
  bool end_array() override { return Close(); }

  bool key(string_t& name) override {
    Level& level = levels_.back();
    if (IsRepeated(name, &level)) {
      faults_->Add(Pointer(), fmt::format("\"{}\" is there twice", Excerpt(name)),
                   "keep one of them");
    }
    level.name = std::move(name);
    if (levels_.size() == 1 && level.name == kShapes) ++shapes_;
    return true;
  }

  bool parse_error(size_t bytes_read, const std::string& token,
                   const nlohmann::json::exception& error) override {
    // The parser's message quotes the text before the error, but the parser has not seen plain
    // spheres.
    if (spheres_ != nullptr && !spheres_->runs.empty()) {
      FaultList ignored;
      ParseJson(text_, file_, &ignored);  // throws
    }
    constexpr int kNumberOverflow = 406;
    if (error.id == kNumberOverflow) {
      throw Error(ExitCode::kBadInput, PlaceInFile(file_, Pointer(/*to_next=*/true)),
                  fmt::format("{} is not a finite number", Excerpt(token)),
                  "at most 1.8e308 in magnitude");
    }
    // "[json.exception.parse_error.101] parse error at line 1, column 2: what we want"
    std::string_view message = error.what();
    const size_t start = message.find(": ", message.find("column"));
    if (start != std::string_view::npos) message.remove_prefix(start + 2);
    // The message may quote all of a long string: "; last read: '...'".
    const size_t quoted = message.find("last read: '");
    std::string shown(message.substr(0, quoted));
    if (quoted != std::string_view::npos) shown += Excerpt(message.substr(quoted));
    throw Error(ExitCode::kBadInput, file_ + ":" + LineAndColumn(text_, bytes_read),
                "not JSON: " + shown, HintFor(message, bytes_read));
  }

 private:
  static constexpr std::string_view kShapes = "shapes";

  // The hint for the parser's message after `bytes_read` bytes of the text.
  std::string HintFor(std::string_view message, size_t bytes_read) const {
    if (message.find("surrogate") != std::string_view::npos) {
      return R"(half a character: give both of its \u escapes, or the character itself)";
    }
    const auto is_letter = [](char c) { return (c | 0x20) >= 'a' && (c | 0x20) <= 'z'; };
    size_t begin = std::min(bytes_read, text_.size()), end = begin;
    while (begin > 0 && is_letter(text_[begin - 1])) --begin;
    while (end < text_.size() && is_letter(text_[end])) ++end;
    std::string word(text_.substr(begin, std::min<size_t>(end - begin, 9)));
    for (char& c : word) c = static_cast<char>(c | 0x20);
    if (word == "nan" || word == "inf" || word == "infinity") {
      return "JSON has no NaN and no Infinity: give a finite number";
    }
    return "JSON has no comments and no comma after the last item";
  }

  struct Level {
    Json* value;       // object or array; does not move while it is the last element of its parent
    size_t plain = 0;  // elements of an array that are in spheres_ instead
    std::string name;  // in an object: the name of the next member
    std::unordered_set<std::string> names;  // in a large object: the names of its members so far
  };

  // Whether the innermost object already has a member with this name; remembers the name.
  static bool IsRepeated(const std::string& name, Level* level) {
    // In a small object, of which a million may occur as spheres, comparing all names is faster
    // than a set.
    constexpr size_t kFew = 16;
    const auto& members = level->value->get_ref<const Json::object_t&>();
    if (members.size() <= kFew) {
      return std::any_of(members.begin(), members.end(),
                         [&](const auto& member) { return member.first == name; });
    }
    if (level->names.empty()) {
      for (const auto& member : members) level->names.insert(member.first);
    }
    return !level->names.insert(name).second;
  }

  // The JSON pointer to the innermost open object or array, or to the value that comes next in it.
  std::string Pointer(bool to_next = false) const {
    std::string pointer;
    for (size_t i = 0; i + (to_next ? 0 : 1) < levels_.size(); ++i) {
      const auto& [value, plain, name, names] = levels_[i];
      const size_t is_open = i + 1 < levels_.size() ? 1 : 0;  // its last element is open, too
      pointer += '/';
      pointer +=
          value->is_array() ? std::to_string(value->size() + plain - is_open) : PointerToken(name);
    }
    return pointer;
  }

  Json* Insert(Json value) {
    if (levels_.empty()) {
      root_ = std::move(value);
      return &root_;
    }
    Json& parent = *levels_.back().value;
    if (parent.is_array()) {
      auto& array = parent.get_ref<Json::array_t&>();
      return &array.emplace_back(std::move(value));
    }
    // Appends directly: operator[] would compare each name with all earlier ones.
    auto& object = parent.get_ref<Json::object_t&>();
    return &static_cast<Json::object_t::Container&>(object)
                .emplace_back(levels_.back().name, std::move(value))
                .second;
  }

  bool Add(Json value) {
    Insert(std::move(value));
    return true;
  }

  bool Open(Json value) {
    if (levels_.size() >= kMaxJsonDepth) {
      throw Error(ExitCode::kBadInput, PlaceInFile(file_, Pointer(/*to_next=*/true)),
                  fmt::format("nested deeper than {} levels", kMaxJsonDepth));
    }
    Json* const inserted = Insert(std::move(value));
    levels_.push_back({inserted, 0, {}, {}});
    return true;
  }

  bool Close() {
    levels_.pop_back();
    TellProgress();
    // At this point the parser has read the element's closing bracket, and nothing after it.
    if (spheres_ != nullptr && levels_.size() == 2 && IsInShapes()) TakePlainSpheres();
    return true;
  }

  void TellProgress() {
    constexpr size_t kEvery = size_t{1} << 12;
    if (on_progress_ && ++closed_ % kEvery == 0) {
      on_progress_(static_cast<double>(reached_ - text_.data()) /
                   static_cast<double>(text_.size()));
    }
  }

  // Whether the innermost of the two open values is the scene's array "shapes". It must be the
  // first one with this name: a second is a fault.
  bool IsInShapes() const {
    return shapes_ == 1 && levels_.back().value->is_array() && levels_.front().name == kShapes;
  }

  void TakePlainSpheres() {
    Level& shapes = levels_.back();
    SphereRun run{shapes.value->size() + shapes.plain, {}, shapes.value->size()};
    while (const std::optional<Sphere> sphere = sphere_reader_.Next(&reached_, end_)) {
      run.spheres.push_back(*sphere);
      TellProgress();
    }
    if (run.spheres.empty()) return;
    shapes.plain += run.spheres.size();
    spheres_->runs.push_back(std::move(run));
  }

  std::string_view text_;
  const std::string& file_;
  FaultList* faults_;
  const std::function<void(double)>& on_progress_;
  PlainSpheres* spheres_;
  PlainSphereReader sphere_reader_;
  const char* reached_;
  const char* end_;
  size_t shapes_ = 0;  // number of members "shapes" of the outermost object
  size_t closed_ = 0;
  Json root_;
  std::vector<Level> levels_;
};

}  // namespace

std::optional<Json> TryParseJson(std::string_view text) {
  FaultList faults;
  try {
    Json value = ParseJson(text, {}, &faults);
    if (faults.count() == 0) return value;
  } catch (const Error&) {  // callers report it in their own words
  }
  return std::nullopt;
}

std::string JsonText(const Json& json, int indent) {
  return json.dump(indent, ' ', /*ensure_ascii=*/false, Json::error_handler_t::replace);
}

std::string PlaceInFile(const std::string& file, const std::string& pointer) {
  if (pointer.empty()) return file;
  // The names in it come from a file: they may have any length and contain line ends.
  constexpr size_t kLongestToken = 80, kLongest = 400;
  std::string shown;
  for (size_t begin = 0; begin < pointer.size();) {
    const size_t end = std::min(pointer.find('/', begin + 1), pointer.size());
    shown += Shortened(std::string_view(pointer).substr(begin, end - begin), kLongestToken);
    begin = end;
  }
  return file + ": " + Shortened(shown, kLongest);
}

void ThrowFaults(std::vector<Fault> faults, const std::string& file, ExitCode code) {
  if (faults.empty()) return;
  for (Fault& fault : faults) fault.where = PlaceInFile(file, fault.where);
  throw Error(code, std::move(faults));
}

Json ParseJson(std::string_view text, const std::string& file, FaultList* faults,
               const std::function<void(double)>& on_progress, PlainSpheres* spheres) {
  const std::string_view json = WithoutByteOrderMark(text, file);
  // The parser would take a character 0 for the end.
  const size_t zero = json.find('\0');
  if (zero != std::string_view::npos) RefuseZero(json, zero, file);
  TreeBuilder builder(json, file, faults, on_progress, spheres);
  Json::sax_parse(builder.begin(), builder.end(), &builder);
  return builder.TakeRoot();
}

}  // namespace nacre
