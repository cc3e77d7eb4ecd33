// SPDX-License-Identifier: Apache-2.0
#include "cli/report_sections.h"

#include <algorithm>
#include <iterator>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "base/error.h"
#include "base/path.h"
#include "base/target.h"
#include "base/version.h"
#include "cli/metrics_json.h"
#include "cli/print.h"
#include "scene_io/json_text.h"

namespace nacre {
namespace {

Json FrameOf(const Image& image) {
  return {{"width", image.display.width()}, {"height", image.display.height()}};
}

void AddNote(const Packing& packing, const std::vector<const Image*>& images, Json* section) {
  const std::string words = packing.InWords();
  if (words.empty()) return;
  (*section)["notes"].push_back(
      fmt::format("So that {} fit into this page, {}. All figures are of the whole pictures.",
                  images.size() == 1 ? "the picture would" : "the pictures would", words));
}

// The metrics of a picture against its reference, with the maps of FLIP.
Json Compare(const Image& got, const Image& reference, const CompareOptions& options,
             const Verdict& verdict, const std::optional<PerceptualOptions>& perceptual,
             const Packing& packing, size_t index, Page* page) {
  std::vector<PerceptualMetrics> seen;
  if (perceptual) seen = MeasurePerceptual(got, reference, *perceptual, options);
  const Window window = FromCorner(Intersect(got.data, reference.data), reference.display);
  Json maps = Json::array();
  for (const PerceptualMetrics& metrics : seen) {
    if (metrics.flip_map.size() > 0) {
      maps.push_back(PackMap(metrics.flip_map, window, "flip", metrics.layer, packing, page));
    }
    if (metrics.hdr_flip_map.size() > 0) {
      maps.push_back(
          PackMap(metrics.hdr_flip_map, window, "hdr_flip", metrics.layer, packing, page));
    }
  }
  return {{"image", index}, {"verdict", VerdictJson(verdict, seen)}, {"maps", maps}};
}

// The layers that both images have: pictures of other renderers have fewer.
std::vector<std::string> CommonLayers(const Image& a, const Image& b) {
  std::set<std::string> shared, lacking;  // layers with a channel that both have, or only one has
  for (const auto& [image, other] : {std::pair(&a, &b), std::pair(&b, &a)}) {
    for (const Channel& channel : image->channels) {
      (other->Find(channel.name) ? shared : lacking).insert(LayerOfChannel(channel.name));
    }
  }
  std::vector<std::string> common;
  std::ranges::set_difference(shared, lacking, std::back_inserter(common));
  return common;
}

Json CompareWith(const ReportPicture& got, const ReportPicture& reference,
                 const std::optional<PerceptualOptions>& perceptual, const Packing& packing,
                 size_t index, Page* page) {
  CompareOptions options;
  options.got_name = got.name;
  options.reference_name = reference.name;
  options.layers = CommonLayers(got.image, reference.image);
  if (options.layers.empty()) {
    throw Error(ExitCode::kCannotCompare, got.name,
                "has no layer that " + reference.name + " has too");
  }
  const Verdict verdict = Judge(got.image, reference.image, {}, options);
  return Compare(got.image, reference.image, options, verdict, perceptual, packing, index, page);
}

std::string Summary(const PerceptualArguments& shown, const Json& sections) {
  const bool pictures = std::any_of(sections.begin(), sections.end(),
                                    [](const Json& s) { return s["kind"] == "images"; });
  if (!pictures) return fmt::format("By nacre {}.", kVersion);
  return fmt::format(
      "By nacre {}, SIMD target {}. Pictures open with the tone operator {} at {} "
      "stops; what they hold is linear.",
      kVersion, TargetName(ActiveTarget()), ToneOperatorName(shown.display.tone),
      shown.display.exposure_ev);
}

}  // namespace

Json PictureSection(const std::vector<ReportPicture>& pictures, size_t reference,
                    const std::optional<PerceptualOptions>& perceptual, size_t limit, Page* page) {
  std::vector<const Image*> images;
  images.reserve(pictures.size());
  for (const ReportPicture& picture : pictures) images.push_back(&picture.image);
  const Packing packing = ChoosePacking(images, limit);
  Json set = {{"name", pictures[0].name},
              {"frame", FrameOf(pictures[reference].image)},
              {"reference", reference},
              {"images", Json::array()},
              {"comparisons", Json::array()}};
  for (const ReportPicture& picture : pictures) {
    Json image = PackImage(picture.image, picture.name, packing, page);
    if (picture.stats) image["stats"] = *picture.stats;
    set["images"].push_back(image);
  }
  for (size_t i = 0; i < pictures.size(); ++i) {
    if (i == reference) continue;
    set["comparisons"].push_back(
        CompareWith(pictures[i], pictures[reference], perceptual, packing, i, page));
  }
  Json section = {{"kind", "images"},
                  {"title", pictures.size() == 1 ? "Picture" : "Comparison"},
                  {"notes", Json::array()},
                  {"sets", {set}}};
  AddNote(packing, images, &section);
  return section;
}

ValidationSection::ValidationSection(const std::optional<PerceptualOptions>& perceptual,
                                     size_t limit, Page* page)
    : perceptual_(perceptual),
      limit_(limit),
      page_(page),
      section_({{"kind", "images"},
                {"title", "Validation against references"},
                {"notes", Json::array()},
                {"cases", Json::array()},
                {"sets", Json::array()}}) {}

void ValidationSection::Add(const ReferenceOutcome& outcome) {
  if (outcome.run) return AddRun(outcome);
  section_["cases"].push_back(
      {{"name", outcome.name}, {"outcome", "error"}, {"reason", outcome.failure}});
}

// Adds a row to the table, and the two pictures as a set of the viewer.
void ValidationSection::AddRun(const ReferenceOutcome& outcome) {
  const Reference& reference = outcome.reference;
  const ReferenceRun& run = *outcome.run;
  const std::vector<const Image*> images = {&run.got, &run.expected};
  const Packing packing = ChoosePacking(images, limit_);
  const Json comparison = Compare(run.got, run.expected, OptionsOf(reference), run.verdict,
                                  perceptual_, packing, 0, page_);
  Json row = comparison["verdict"];
  row["name"] = reference.name;
  row["outcome"] = run.verdict.match ? "match" : "differ";
  if (run.verdict.match) row["reason"] = reference.reason;
  row["set"] = section_["sets"].size();
  section_["cases"].push_back(row);
  section_["sets"].push_back(
      {{"name", reference.name},
       {"frame", FrameOf(run.expected)},
       {"reference", 1},
       {"images",
        {PackImage(run.got, "nacre", packing, page_),
         PackImage(run.expected, reference.image.filename().string(), packing, page_)}},
       {"comparisons", {comparison}}});
  AddNote(packing, images, &section_);
}

Json BenchSection(const std::string& path) {
  const Json data = ReadJson(path);
  for (const char* key : {"machine", "benchmarks", "targets", "best_target"}) {
    if (!data.contains(key)) {
      throw Error(ExitCode::kBadInput, path, fmt::format("has no \"{}\"", key),
                  "scripts/bench writes out/bench/bench.json");
    }
  }
  return {{"kind", "bench"}, {"title", "Benchmark"}, {"data", data}};
}

void CheckReportPath(const std::string& path) {
  if (!HasExtension(path, ".html")) {
    throw Error(ExitCode::kUsage, path, "unknown output extension", "a report is a .html file");
  }
  CheckTextOutput(path);
}

std::string ReportHtml(const std::string& title, const Json& sections,
                       const PerceptualArguments& shown, const Page& page) {
  const std::string generator = fmt::format("nacre {} ({})", kVersion, kCommit);
  return page.Html(title, generator,
                   {{"generator", generator},
                    {"summary", Summary(shown, sections)},
                    {"notes", Json::array()},
                    {"tone", ToneOperatorName(shown.display.tone)},
                    {"exposure", shown.display.exposure_ev},
                    {"sections", sections}});
}

void WriteReport(const std::string& path, const std::string& title, const Json& sections,
                 const PerceptualArguments& shown, const Page& page) {
  const std::string html = ReportHtml(title, sections, shown, page);
  WriteText(path, html);
  PrintError("{}: {:.1f} MiB\n", path, static_cast<double>(html.size()) / (1024 * 1024));
}

}  // namespace nacre
