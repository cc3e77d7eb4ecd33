// SPDX-License-Identifier: Apache-2.0
#include "scene_io/mtl_file.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "base/error.h"
#include "base/excerpt.h"
#include "base/numbers.h"
#include "scene/limits.h"
#include "scene_io/scene_budget.h"
#include "scene_io/text_file.h"
#include "scene_io/text_lines.h"

namespace nacre {
namespace {

constexpr uint64_t kMaxMtlBytes = uint64_t{64} << 20;

struct ColorKey {
  std::string_view name;
  Rgb MtlMaterial::*member;
  Range range;
};
constexpr std::array kColorKeys = {ColorKey{"ka", &MtlMaterial::ka, limits::kUnit},
                                   ColorKey{"kd", &MtlMaterial::kd, limits::kUnit},
                                   ColorKey{"ks", &MtlMaterial::ks, limits::kUnit},
                                   ColorKey{"ke", &MtlMaterial::ke, limits::kRadiance}};

struct ImageKey {
  std::string_view name;
  MtlImage MtlMaterial::*member;
};
constexpr std::array kImageKeys = {
    ImageKey{"map_ka", &MtlMaterial::map_ka},   ImageKey{"map_kd", &MtlMaterial::map_kd},
    ImageKey{"map_ks", &MtlMaterial::map_ks},   ImageKey{"map_ns", &MtlMaterial::map_ns},
    ImageKey{"map_ke", &MtlMaterial::map_ke},   ImageKey{"map_emissive", &MtlMaterial::map_ke},
    ImageKey{"map_d", &MtlMaterial::map_d},     ImageKey{"map_tr", &MtlMaterial::map_d},
    ImageKey{"map_pr", &MtlMaterial::map_pr},   ImageKey{"map_pm", &MtlMaterial::map_pm},
    ImageKey{"map_ps", &MtlMaterial::map_ps},   ImageKey{"map_pc", &MtlMaterial::map_pc},
    ImageKey{"map_pcr", &MtlMaterial::map_pcr}, ImageKey{"norm", &MtlMaterial::norm},
    ImageKey{"map_kn", &MtlMaterial::norm},     ImageKey{"bump", &MtlMaterial::bump},
    ImageKey{"map_bump", &MtlMaterial::bump},   ImageKey{"disp", &MtlMaterial::disp},
    ImageKey{"map_disp", &MtlMaterial::disp}};

// Images that are left out with a warning.
struct NotShown {
  std::string_view name;
  std::string_view warning;
};
constexpr std::array kImagesNotShown = {
    NotShown{"refl", "reflection images (refl) are not shown"},
    NotShown{"map_refl", "reflection images (refl) are not shown"},
    NotShown{"decal", "decals are not shown"},
    NotShown{"map_rma", "images of several channels (map_RMA, map_ORM) are not shown"},
    NotShown{"map_orm", "images of several channels (map_RMA, map_ORM) are not shown"}};

// Statements that are left out without a warning: transmission, which the warnings about illum and
// d cover; filters and sampling; the angle of anisotropy, which the warning about aniso covers.
constexpr std::array<std::string_view, 7> kSilent = {
    "kt", "tf", "km", "sharpness", "anisor", "map_aat", "interpolatemode"};

// Keywords that are followed by one number.
constexpr std::array<std::string_view, 10> kNumbers = {"ns", "ni", "d",  "tr", "illum",
                                                       "pr", "pm", "ps", "pc", "pcr"};

class MtlFileReader {
 public:
  MtlFileReader(const std::filesystem::path& path, size_t max_materials,
                const std::function<void(const std::string&)>& warn)
      : file_(path.string()), max_materials_(max_materials), warn_(warn) {}

  std::vector<MtlMaterial> Read(std::string_view text) {
    TextLines lines(WithoutByteOrderMark(text, file_));
    for (std::string_view line; lines.Next(&line);) {
      number_ = lines.number();
      const std::string_view word = NextWord(&line);
      if (word.empty() || word.starts_with('#')) continue;
      ReadStatement(word, LowerCase(word.substr(0, 20)), line);
    }
    return std::move(materials_);
  }

 private:
  [[noreturn]] void Refuse(std::string what, std::string hint = {}) const {
    throw Error(ExitCode::kBadInput, fmt::format("{}:{}", file_, number_), std::move(what),
                std::move(hint));
  }

  void ReadStatement(std::string_view written, const std::string& keyword, std::string_view line) {
    if (keyword == "newmtl") {
      if (materials_.size() == max_materials_) {
        Refuse(fmt::format("a model has more than {} materials", kMaxModelMaterials),
               "leave out those that no face uses");
      }
      materials_.emplace_back().name = Trimmed(line);
      has_opacity_ = false;
      return;
    }
    const auto image = std::ranges::find(kImagesNotShown, keyword, &NotShown::name);
    if (keyword == "aniso") {
      if (Number(keyword, line).value_or(0) != 0) warn_("anisotropy (aniso, anisor) is not shown");
    } else if (image != kImagesNotShown.end()) {
      warn_(std::string(image->warning));
    } else if (materials_.empty()) {
      warn_("what a material library says before its first material (newmtl) is left out");
    } else if (!ReadMember(keyword, line, &materials_.back()) &&
               std::find(kSilent.begin(), kSilent.end(), keyword) == kSilent.end()) {
      if (std::exchange(warned_of_unknown_, true)) return;
      warn_(fmt::format("statements that are not known are left out, the first is \"{}\"",
                        Excerpt(written)));
    }
  }

  // Reads the statement if `keyword` is one of materials. Returns whether it is.
  bool ReadMember(const std::string& keyword, std::string_view line, MtlMaterial* material) {
    for (const ColorKey& color : kColorKeys) {
      if (color.name != keyword) continue;
      ReadColor(color, line, &(material->*color.member));
      return true;
    }
    for (const ImageKey& image : kImageKeys) {
      if (image.name != keyword) continue;
      material->*image.member = Image(line);
      return true;
    }
    if (std::find(kNumbers.begin(), kNumbers.end(), keyword) == kNumbers.end()) return false;
    std::string_view rest = line;
    if (keyword == "d" && NextWord(&rest) == "-halo") line = rest;
    if (const std::optional<double> number = Number(keyword, line)) {
      SetNumber(keyword, *number, material);
    }
    return true;
  }

  void SetNumber(const std::string& keyword, double number, MtlMaterial* material) {
    const auto clamped = [&] { return Clamped(keyword, number, limits::kUnit); };
    if (keyword == "ns") material->ns = Clamped(keyword, number, limits::kExponent);
    if (keyword == "ni") material->ni = number;
    // Some programs write the opacity as Tr; their files also have d, which takes precedence.
    if (keyword == "tr" && !has_opacity_) material->opacity = 1 - number;
    if (keyword == "d") material->opacity = number;
    has_opacity_ |= keyword == "d";
    if (keyword == "illum") material->illum = static_cast<int>(std::clamp(number, 0.0, 10.0));
    if (keyword == "pr") material->pr = clamped();
    if (keyword == "pm") material->pm = clamped();
    if (keyword == "ps") material->ps = clamped();
    if (keyword == "pc") material->pc = clamped();
    if (keyword == "pcr") material->pcr = clamped();
  }

  // The number in `word`; nullopt, with one warning per file, if there is none, or NaN or infinity.
  std::optional<double> NumberOf(std::string_view word, std::string_view keyword,
                                 std::string_view count) {
    const std::optional<double> number = ParseNumber(word);
    if (number) return number;
    if (!word.empty() && !word.starts_with('#') && !IsNoNumber(word)) {
      Refuse(fmt::format("\"{}\" is not a finite number", Excerpt(word)),
             fmt::format("\"{}\" is followed by {}", keyword, count));
    }
    if (!std::exchange(warned_of_no_number_, true)) {
      warn_(fmt::format("numbers that are none are left out, the first is {} in {}:{}", keyword,
                        file_, number_));
    }
    return std::nullopt;
  }

  std::optional<double> Number(std::string_view keyword, std::string_view line) {
    return NumberOf(NextWord(&line), keyword, "one");
  }

  // Clamps the number to its range. Exporters write a little more than white, and -1 for none.
  double Clamped(std::string_view keyword, double number, const Range& range) {
    if (range.Contains(number)) return number;
    if (!std::exchange(warned_of_range_, true)) {
      warn_(fmt::format("numbers out of range are clamped, the first is {} {} in {}:{} ({})",
                        keyword, number, file_, number_, Describe(range)));
    }
    return std::clamp(number, range.min, range.max);
  }

  // Reads three numbers, or one for grey.
  void ReadColor(const ColorKey& key, std::string_view line, Rgb* out) {
    const std::string_view first = NextWord(&line);
    if (first == "spectral" || first == "xyz") {
      if (!std::exchange(warned_of_form_, true)) {
        warn_(fmt::format("colours as spectra or XYZ are left out, the first is {} {} in {}:{}",
                          key.name, first, file_, number_));
      }
      return;
    }
    std::array<std::optional<double>, 3> numbers;
    numbers.fill(NumberOf(first, key.name, "three"));
    const std::string_view second = NextWord(&line);
    if (!second.empty() && !second.starts_with('#')) {
      numbers[1] = NumberOf(second, key.name, "three");
      numbers[2] = NumberOf(NextWord(&line), key.name, "three");
    }
    if (!numbers[0] || !numbers[1] || !numbers[2]) return;
    const Rgb color(*numbers[0], *numbers[1], *numbers[2]);
    for (int c = 0; c < 3; ++c) (*out)[c] = Clamped(key.name, color[c], key.range);
  }

  // Takes up to three numbers off the front of `line`. The others keep their values.
  void Numbers(std::string_view* line, std::array<double, 3>* numbers) const {
    for (double& number : *numbers) {
      std::string_view rest = *line;
      const std::string_view word = NextWord(&rest);
      const std::optional<double> value = ParseNumber(word);
      if (!value) {
        // A number that no double holds cannot be the name of a file either.
        if (word.find_first_not_of("+-.0123456789eE") == std::string_view::npos &&
            word.find_first_of("0123456789") != std::string_view::npos) {
          Refuse(fmt::format("\"{}\" is not a finite number", Excerpt(word)));
        }
        return;
      }
      number = *value;
      *line = rest;
    }
  }

  // Reads options and then the name of the file, which may contain blanks. Many files have options
  // after the name, where the format does not allow them.
  MtlImage Image(std::string_view line) {
    MtlImage image;
    ReadOptions(&line, &image);
    const size_t later = std::min({line.find(" -bm "), line.find(" -s "), line.find(" -o "),
                                   line.find(" -clamp "), line.size()});
    std::string_view options = line.substr(later);
    ReadOptions(&options, &image);
    image.file = WithoutComment(Trimmed(line.substr(0, later)));
    image.place = fmt::format("{}:{}", file_, number_);
    return image;
  }

  void ReadOptions(std::string_view* line, MtlImage* image) {
    while (true) {
      std::string_view rest = *line;
      const std::string_view option = NextWord(&rest);
      if (option.size() < 2 || option[0] != '-') return;
      if (option == "-s" || option == "-o" || option == "-t") {
        std::array<double, 3> numbers = {option == "-s" ? 1.0 : 0.0, option == "-s" ? 1.0 : 0.0, 0};
        Numbers(&rest, &numbers);
        if (option != "-t") {
          for (double& number : numbers) number = Clamped(option, number, limits::kTextureScale);
          (option == "-s" ? image->scale : image->offset) = Vec2d(numbers[0], numbers[1]);
        }
        const bool turbulent = numbers[0] != 0 || numbers[1] != 0 || numbers[2] != 0;
        if (option == "-t" && turbulent) warn_("the turbulence of images (-t) is not shown");
      } else if (option == "-mm") {
        std::array<double, 3> numbers = {0, 1, 0};
        Numbers(&rest, &numbers);
        if (numbers[0] != 0 || numbers[1] != 1) {
          warn_("the base and gain of images (-mm) are left out");
        }
      } else if (option == "-bm" || option == "-boost" || option == "-texres") {
        std::array<double, 3> numbers = {1, 0, 0};
        Numbers(&rest, &numbers);
        if (option == "-bm") image->multiplier = numbers[0];
      } else if (option == "-clamp") {
        image->clamp = NextWord(&rest) == "on";
      } else if (option == "-imfchan") {
        const std::string_view channel = NextWord(&rest);
        if (channel != "l" && channel != "m" && channel != "r") {
          warn_("the channel of an image (-imfchan) is left out: its first one is read");
        }
      } else if (option == "-blendu" || option == "-blendv" || option == "-cc" ||
                 option == "-type" || option == "-colorspace") {
        NextWord(&rest);
      } else {
        return;  // the file's name
      }
      *line = rest;
    }
  }

  const std::string file_;
  const size_t max_materials_;
  const std::function<void(const std::string&)>& warn_;
  size_t number_ = 0;         // current line
  bool has_opacity_ = false;  // the current material has a d
  bool warned_of_unknown_ = false, warned_of_range_ = false, warned_of_form_ = false;
  bool warned_of_no_number_ = false;
  std::vector<MtlMaterial> materials_;
};

}  // namespace

std::vector<MtlMaterial> ReadMtlFile(const std::filesystem::path& path, size_t max_materials,
                                     const std::function<void(const std::string&)>& warn) {
  return MtlFileReader(path, max_materials, warn).Read(ReadTextFile(path, kMaxMtlBytes));
}

}  // namespace nacre
