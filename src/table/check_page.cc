// SPDX-License-Identifier: Apache-2.0
// table/check_page.cc: a TableCheck in words, and as JSON.
#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "table/check_table.h"

namespace nacre {
namespace {

std::string Numbers(const std::array<double, 3>& rgb) {
  if (rgb[0] == rgb[1] && rgb[1] == rgb[2]) return fmt::format("{:.9g}", rgb[0]);
  return fmt::format("{:.9g} {:.9g} {:.9g}", rgb[0], rgb[1], rgb[2]);
}

// "theirs 1, nacre's 0.318, 3.14159 times as much".
std::string Values(const PartErrors& part) {
  std::string text = fmt::format("theirs {}, nacre's {}", Numbers(part.theirs), Numbers(part.ours));
  size_t channel = 0;
  for (size_t c = 1; c < 3; ++c) {
    if (std::abs(part.ours[c]) > std::abs(part.ours[channel])) channel = c;
  }
  const double ratio = part.theirs[channel] / part.ours[channel];
  if (std::isfinite(ratio)) text += fmt::format(", {:.6g} times that", ratio);
  return text;
}

void AddVerdict(const TableCheck& check, std::string* page) {
  const std::string model = check.material.value("model", "");
  *page += fmt::format("{}, against {}: {}\n", check.file, model,
                       check.ok ? "they agree" : "they differ");
  *page += fmt::format(
      "  {:7}  finite     {}\n", check.not_finite == 0 ? "ok" : "FAIL",
      check.not_finite == 0
          ? fmt::format("in all of {} rows", check.rows)
          : fmt::format("not in {} of {} rows: {}{}; below, they are left out", check.not_finite,
                        check.rows, fmt::join(check.not_finite_at, ", "),
                        check.not_finite > check.not_finite_at.size() ? ", ..." : ""));
  if (check.f.rows == 0) return;
  *page += fmt::format(
      "  {:7}  f          error rms {:.2e}, half of the rows below {:.1e}, largest {:.2e} ({:g} is "
      "allowed)\n",
      check.f.largest <= check.tolerance ? "ok" : "FAIL", check.f.rms, check.median,
      check.f.largest, check.tolerance);
  if (check.f.largest > 0) {
    *page +=
        fmt::format("                      largest at {}: {}\n", check.worst_at, Values(check.f));
  }
  for (const PartErrors& part : check.parts) {
    if (part.rows == 0) continue;
    const char* const word = part.largest <= check.tolerance ? "same" : "differs";
    *page += fmt::format("  {:7}  {:10} error rms {:.2e}, largest {:.2e}", word, part.name,
                         part.rms, part.largest);
    if (part.largest > check.tolerance) *page += fmt::format(": {}", Values(part));
    *page += '\n';
  }
}

void AddDiagnosis(const TableCheck& check, std::string* page) {
  if (check.diagnosed_rows == 0) return;
  *page += fmt::format("\n  what it looks like, and the error rms that this leaves of {:.2e}\n",
                       check.diagnosed_rms);
  if (check.explanation.empty()) {
    *page += "    no mistake that is known explains it: none leaves less than a tenth\n";
  } else {
    for (size_t i = 0; i < check.explanation.size(); ++i) {
      const bool is_last = i + 1 == check.explanation.size();
      *page += fmt::format("    {} {}{}\n", i == 0 ? "->" : "and", check.explanation[i],
                           is_last ? fmt::format(": leaves {:.1e}, at most {:.1e}",
                                                 check.explained_rms, check.explained_largest)
                                   : "");
    }
    constexpr size_t kShown = 4;
    for (size_t i = 0; i < std::min(check.also.size(), kShown); ++i) {
      const RankedHypothesis& also = check.also[i];
      *page += fmt::format("    or {}: leaves {:.1e}\n", also.text, also.rms);
    }
  }
  if (!check.fit.empty() && check.fit_rms < 0.5 * check.diagnosed_rms) {
    *page += fmt::format("    as a sum of nacre's lobes: ");
    for (size_t i = 0; i < check.fit.size(); ++i) {
      *page +=
          fmt::format("{}{} x {:.5g}", i > 0 ? ", " : "", check.fit[i].lobe, check.fit[i].factor);
    }
    *page += fmt::format(": leaves {:.1e}\n", check.fit_rms);
  }
  const auto ranking = [&](const char* title, const std::vector<RankedHypothesis>& ranked) {
    if (ranked.empty()) return;
    *page += fmt::format("\n  {}\n    error rms  largest\n", title);
    for (const RankedHypothesis& one : ranked) {
      *page += fmt::format("    {:>9.2e} {:>8.1e}  {}\n", one.rms, one.largest, one.text);
    }
  };
  ranking("the nearest single mistakes", check.mistakes);
  ranking("the nearest rules and options, each in place of the material's own", check.choices);
}

void AddAngles(const TableCheck& check, std::string* page) {
  const AngleErrors& angles = check.angles;
  if (angles.errors.empty()) return;
  *page += "\n  largest error of f; light down, view across, degrees\n         ";
  for (const std::string& view : angles.view) *page += fmt::format("{:>9}", view);
  *page += '\n';
  for (size_t i = 0; i < angles.light.size(); ++i) {
    *page += fmt::format("  {:>7}", angles.light[i]);
    for (size_t k = 0; k < angles.view.size(); ++k) {
      const double error = angles.errors[i * angles.view.size() + k];
      *page += error < 0 ? fmt::format("{:>9}", "-") : fmt::format("{:>9.1e}", error);
    }
    *page += '\n';
  }
}

Json PartJson(const PartErrors& part) {
  return {{"name", part.name},          {"rows", part.rows},     {"rms", part.rms},
          {"largest", part.largest},    {"theirs", part.theirs}, {"nacre", part.ours},
          {"worst_row", part.worst_row}};
}

Json RankedJson(const std::vector<RankedHypothesis>& ranked) {
  constexpr const char* kKinds[] = {"mistake", "choice", "rules"};
  Json json = Json::array();
  for (const RankedHypothesis& one : ranked) {
    json.push_back({{"kind", kKinds[static_cast<size_t>(one.kind)]},
                    {"what", one.text},
                    {"rms", one.rms},
                    {"largest", one.largest}});
  }
  return json;
}

}  // namespace

std::string PageOf(const TableCheck& check) {
  std::string page;
  AddVerdict(check, &page);
  AddDiagnosis(check, &page);
  AddAngles(check, &page);
  if (!check.notes.empty()) page += '\n';
  for (const std::string& note : check.notes) page += fmt::format("  note: {}\n", note);
  return page;
}

Json CheckJson(const TableCheck& check) {
  Json json = {{"ok", check.ok},
               {"file", check.file},
               {"tolerance", check.tolerance},
               {"material", check.material},
               {"rows", check.rows},
               {"not_finite", check.not_finite},
               {"not_finite_at", check.not_finite_at},
               {"f", PartJson(check.f)},
               {"median", check.median},
               {"worst_at", check.worst_at}};
  Json parts = Json::array();
  for (const PartErrors& part : check.parts) parts.push_back(PartJson(part));
  json["parts"] = parts;
  Json rows = Json::array();
  for (size_t i = 0; i < check.angles.light.size(); ++i) {
    Json row = Json::array();
    for (size_t k = 0; k < check.angles.view.size(); ++k) {
      const double error = check.angles.errors[i * check.angles.view.size() + k];
      row.push_back(error < 0 ? Json() : Json(error));
    }
    rows.push_back(row);
  }
  json["angles"] = {{"light", check.angles.light}, {"view", check.angles.view}, {"errors", rows}};
  json["diagnosed_rows"] = check.diagnosed_rows;
  json["diagnosed_rms"] = check.diagnosed_rms;
  json["explanation"] = check.explanation;
  json["explained_rms"] = check.explained_rms;
  json["explained_largest"] = check.explained_largest;
  json["also"] = RankedJson(check.also);
  json["mistakes"] = RankedJson(check.mistakes);
  json["choices"] = RankedJson(check.choices);
  Json fit = Json::object();
  for (const LobeFactor& lobe : check.fit) fit[lobe.lobe] = lobe.factor;
  json["fit"] = fit;
  json["fit_rms"] = check.fit_rms;
  json["notes"] = check.notes;
  return json;
}

}  // namespace nacre
