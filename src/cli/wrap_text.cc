// SPDX-License-Identifier: Apache-2.0
#include "cli/wrap_text.h"

#include <algorithm>
#include <charconv>

#include "image_io/draw_text.h"

namespace nacre {
namespace {

// Words with the space or underscore that ends them.
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

// Room between neighbouring labels, in sizes of the text.
constexpr double kBetween = 0.6;

bool Fits(const FittedLabels& fitted, double room) {
  constexpr size_t kMostLines = 3;
  for (const FittedLabels::Label& label : fitted.labels) {
    if (label.lines.size() > kMostLines) return false;
    for (const std::string& line : label.lines) {
      if (TextWidth(line, fitted.size) + kBetween * fitted.size > room) return false;
    }
  }
  return true;
}

bool IsNumber(const std::string& text) {
  double number = 0;
  const char* const end = text.data() + text.size();
  const auto result = std::from_chars(text.data(), end, number);
  return result.ec == std::errc() && result.ptr == end;
}

FittedLabels Fit(const std::vector<std::string>& labels, const std::vector<size_t>& places,
                 double size_px, double room) {
  FittedLabels fitted;
  fitted.size = size_px;
  for (const size_t i : places) {
    fitted.labels.push_back({i, WrapText(labels[i], size_px, room - kBetween * size_px)});
    fitted.lines = std::max(fitted.lines, static_cast<double>(fitted.labels.back().lines.size()));
  }
  return fitted;
}

// Every label, label i in tier i modulo `tiers`: neighbours in a tier are that many places apart.
FittedLabels FitTiers(const std::vector<std::string>& labels, const std::vector<size_t>& places,
                      size_t tiers, double size_px, double width) {
  FittedLabels fitted = Fit(labels, places, size_px, static_cast<double>(tiers) * width);
  fitted.lines = 0;
  for (size_t tier = 0; tier < tiers; ++tier) {
    double most = 0;
    for (size_t i = tier; i < fitted.labels.size(); i += tiers) {
      fitted.labels[i].below = fitted.lines;
      most = std::max(most, static_cast<double>(fitted.labels[i].lines.size()));
    }
    fitted.lines += most;
  }
  return fitted;
}

}  // namespace

std::vector<std::string> WrapText(const std::string& text, double size_px, double width) {
  std::vector<std::string> lines;
  std::string line;
  for (const std::string& word : Words(text)) {
    if (!line.empty() && TextWidth(WithoutEndSpace(line + word), size_px) > width) {
      lines.push_back(WithoutEndSpace(line));
      line.clear();
    }
    line += word;
  }
  if (!line.empty()) lines.push_back(WithoutEndSpace(line));
  return lines;
}

std::vector<size_t> SpreadPlaces(size_t last, size_t count) {
  std::vector<size_t> places;
  places.reserve(count);
  for (size_t i = 0; i < count; ++i) {
    places.push_back((2 * i * last + count - 1) / (2 * (count - 1)));  // rounded
  }
  return places;
}

FittedLabels FitLabels(const std::vector<std::string>& labels, double size_px, double width) {
  FittedLabels fitted;
  std::vector<size_t> places(labels.size());
  for (size_t i = 0; i < places.size(); ++i) places[i] = i;
  for (const double scale : {1.0, 0.85, 0.7}) {
    fitted = Fit(labels, places, scale * size_px, width);
    if (Fits(fitted, width)) return fitted;
  }
  const bool are_numbers = std::all_of(labels.begin(), labels.end(), IsNumber);
  for (size_t tiers = 2; tiers <= 4 && !are_numbers; ++tiers) {
    fitted = FitTiers(labels, places, tiers, 0.7 * size_px, width);
    if (Fits(fitted, static_cast<double>(tiers) * width)) return fitted;
  }
  for (size_t count = labels.size() - 1; labels.size() > 2 && count >= 2; --count) {
    const size_t last = labels.size() - 1;
    const double room = static_cast<double>(last / (count - 1)) * width;  // at least
    fitted = Fit(labels, SpreadPlaces(last, count), 0.7 * size_px, room);
    if (Fits(fitted, room)) return fitted;
  }
  return fitted;
}

}  // namespace nacre
