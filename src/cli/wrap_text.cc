// SPDX-License-Identifier: Apache-2.0
#include "cli/wrap_text.h"

#include <algorithm>

#include "base/numbers.h"
#include "base/printable.h"
#include "image_io/draw_text.h"

namespace nacre {
namespace {

// Splits the text into words, each with the space or underscore that ends it.
std::vector<std::string> Words(const std::string& text) {
  std::vector<std::string> words;
  size_t begin = 0;
  while (begin < text.size()) {
    const size_t end = std::min(text.find_first_of(" _", begin), text.size() - 1) + 1;
    words.push_back(text.substr(begin, end - begin));
    begin = end;
  }
  return words;
}

std::string WithoutEndSpace(std::string text) {
  while (!text.empty() && text.back() == ' ') text.pop_back();
  return text;
}

// The number of bytes of the longest prefix of whole characters that is at most `width` wide.
size_t LengthThatFits(const std::string& text, double size_px, double width) {
  double used = 0;
  size_t length = 0;
  while (length < text.size()) {
    size_t next = length + 1;
    while (next < text.size() && (static_cast<unsigned char>(text[next]) & 0xc0) == 0x80) ++next;
    used += DrawnWidth(std::string_view(text).substr(length, next - length), size_px);
    if (used > width) break;
    length = next;
  }
  return length;
}

// Wraps whole words; a word that is too wide gets a line of its own. Control characters are first
// spelled out as in drawing, since that widens the text.
std::vector<std::string> WrapWords(const std::string& text, double size_px, double width) {
  std::vector<std::string> lines;
  std::string line;
  for (const std::string& word : Words(Printable(text))) {
    if (!line.empty() && DrawnWidth(WithoutEndSpace(line + word), size_px) > width) {
      lines.push_back(WithoutEndSpace(line));
      line.clear();
    }
    line += word;
  }
  if (!line.empty()) lines.push_back(WithoutEndSpace(line));
  return lines;
}

// The minimum gap between neighbouring labels, in multiples of the text size.
constexpr double kBetween = 0.6;
constexpr size_t kMostLines = 3;

struct LabelRow {
  const std::vector<std::string>& labels;
  double width;
  RoomBeside beside;
};

// The part of `room`, centred at place i, that lies on the page.
double RoomAt(const LabelRow& row, size_t i, double room) {
  const double left = row.beside.left + (static_cast<double>(i) + 0.5) * row.width;
  const double right =
      row.beside.right + (static_cast<double>(row.labels.size() - i) - 0.5) * row.width;
  return std::min({room, 2 * left, 2 * right});
}

bool Fits(const LabelRow& row, const FittedLabels& fitted, double room) {
  for (const FittedLabels::Label& label : fitted.labels) {
    if (label.lines.size() > kMostLines) return false;
    for (const std::string& line : label.lines) {
      const double width = DrawnWidth(line, fitted.size) + kBetween * fitted.size;
      if (width > RoomAt(row, label.place, room)) return false;
    }
  }
  return true;
}

FittedLabels Fit(const LabelRow& row, const std::vector<size_t>& places, double size_px,
                 double room) {
  FittedLabels fitted;
  fitted.size = size_px;
  for (const size_t i : places) {
    const double width = RoomAt(row, i, room) - kBetween * size_px;
    fitted.labels.push_back({i, WrapWords(row.labels[i], size_px, width)});
    fitted.lines = std::max(fitted.lines, static_cast<double>(fitted.labels.back().lines.size()));
  }
  return fitted;
}

// Puts label i into tier i modulo `tiers`.
void StackTiers(size_t tiers, FittedLabels* fitted) {
  fitted->lines = 0;
  for (size_t tier = 0; tier < tiers; ++tier) {
    double most = 0;
    for (size_t i = tier; i < fitted->labels.size(); i += tiers) {
      fitted->labels[i].below = fitted->lines;
      most = std::max(most, static_cast<double>(fitted->labels[i].lines.size()));
    }
    fitted->lines += most;
  }
}

// For labels that do not fit: breaks words, and ends labels with too many lines in an ellipsis.
void CutToFit(const LabelRow& row, size_t tiers, double room, FittedLabels* fitted) {
  for (FittedLabels::Label& label : fitted->labels) {
    const double width = RoomAt(row, label.place, room) - kBetween * fitted->size;
    label.lines = WrapText(row.labels[label.place], fitted->size, width);
    if (label.lines.size() <= kMostLines) continue;
    label.lines.resize(kMostLines);
    // Makes the line too long, so that it is cut and ends in an ellipsis.
    label.lines.back() = CutText(label.lines.back() + "……", fitted->size, width);
  }
  StackTiers(tiers, fitted);
}

}  // namespace

std::vector<std::string> WrapText(const std::string& text, double size_px, double width) {
  std::vector<std::string> lines;
  for (std::string& line : WrapWords(text, size_px, width)) {
    while (DrawnWidth(line, size_px) > width) {
      const size_t length = LengthThatFits(line, size_px, width);
      if (length == 0) break;  // no room for a single character
      lines.push_back(line.substr(0, length));
      line.erase(0, length);
    }
    lines.push_back(std::move(line));
  }
  return lines;
}

std::string CutText(const std::string& text, double size_px, double width) {
  const std::string shown = Printable(text);
  if (DrawnWidth(shown, size_px) <= width) return shown;
  const double room = width - DrawnWidth("…", size_px);
  return WithoutEndSpace(shown.substr(0, LengthThatFits(shown, size_px, room))) + "…";
}

std::vector<size_t> SpreadPlaces(size_t last, size_t count) {
  std::vector<size_t> places;
  places.reserve(count);
  for (size_t i = 0; i < count; ++i) {
    places.push_back((2 * i * last + count - 1) / (2 * (count - 1)));  // rounds to nearest
  }
  return places;
}

FittedLabels FitLabels(const std::vector<std::string>& labels, double size_px, double width,
                       const RoomBeside& beside) {
  const LabelRow row{labels, width, beside};
  FittedLabels fitted;
  std::vector<size_t> places(labels.size());
  for (size_t i = 0; i < places.size(); ++i) places[i] = i;
  for (const double scale : {1.0, 0.85, 0.7}) {
    fitted = Fit(row, places, scale * size_px, width);
    if (Fits(row, fitted, width)) return fitted;
  }
  size_t last_tiers = 1;
  double room = width;
  const bool are_numbers = std::all_of(labels.begin(), labels.end(), ParseNumber);
  for (size_t tiers = 2; tiers <= 4 && !are_numbers; ++tiers) {
    room = static_cast<double>(tiers) * width;  // neighbours within a tier are `tiers` places apart
    fitted = Fit(row, places, 0.7 * size_px, room);
    StackTiers(tiers, &fitted);
    last_tiers = tiers;
    if (Fits(row, fitted, room)) return fitted;
  }
  for (size_t count = labels.size() - 1; labels.size() > 2 && count >= 2; --count) {
    const size_t last = labels.size() - 1;
    room = static_cast<double>(last / (count - 1)) * width;  // at least
    last_tiers = 1;
    fitted = Fit(row, SpreadPlaces(last, count), 0.7 * size_px, room);
    if (Fits(row, fitted, room)) return fitted;
  }
  CutToFit(row, last_tiers, room, &fitted);
  return fitted;
}

}  // namespace nacre
