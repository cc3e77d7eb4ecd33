// SPDX-License-Identifier: Apache-2.0
#include "view/worker.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <exception>
#include <utility>

#include "base/printable.h"
#include "base/seconds_since.h"
#include "scene/material_parameters.h"
#include "scene_io/load_scene.h"
#include "scene_io/scene_json.h"
#include "shading/material_fit.h"
#include "view/answer.h"
#include "view/explain.h"

namespace nacre {
namespace {

using Clock = std::chrono::steady_clock;

// The time until a page has a picture while the scene is being changed: of the 33 ms from a
// slider's event to the screen, the browser may wait up to 17 for its next frame.
constexpr double kMovingMs = 16;
// How long the scene must be unchanged before the picture is refined: a drag sends a change every 8
// to 17 ms.
constexpr std::chrono::milliseconds kRest(90);
// A page that takes no picture for this time no longer delays the others.
constexpr std::chrono::milliseconds kPatience(250);
constexpr std::chrono::milliseconds kFilesEvery(100);
// The interval of refined pictures, except for the first and the last: sending one, with all of its
// pixels, delays the next picture of a changing scene.
constexpr double kRefinedEveryMs = 250;
// How long the picture must be unchanged before it is compared with those kept: FLIP takes longer
// than a pause of the hand.
constexpr std::chrono::milliseconds kMeasureAfter(400);
// For all kept pictures together.
constexpr size_t kMaxKeptBytes = size_t{200} << 20;
// Divisors of the width and height, by which frames are made smaller.
constexpr std::array<int, 8> kDivisors = {1, 2, 3, 4, 6, 8, 12, 16};
// The maximum of pixels sent to a page: 33 MB. Larger pictures are shown smaller.
constexpr double kMaxPixels = 3840.0 * 2160;
// The minimum interval of writing the file of edits; at least kKeepShare times the time that
// finding the edits takes.
constexpr std::chrono::milliseconds kKeepEvery(250);
constexpr int kKeepShare = 20;
// Time for changes that are still waiting when the server ends.
constexpr std::chrono::milliseconds kLastChanges(300);
// Longer scenes are sent without their shapes: no page has controls for so many.
constexpr size_t kMaxSceneText = size_t{2} << 20;

double MsSince(Clock::time_point start) { return 1e3 * SecondsSince(start); }

// Takes the maps out of a scene file's material: the rest can be read without textures.
Json TakeMaps(Json* material) {
  Json maps = Json::object();
  if (!material->is_object()) return maps;
  for (const auto& [name, value] : material->items()) {
    if (name.ends_with("_map")) maps[name] = value;
  }
  for (const auto& [name, value] : maps.items()) material->erase(name);
  return maps;
}

bool HasMap(const MaterialModel& model, std::string_view name) {
  const auto named = [&](const auto& map) { return map.name == name; };
  return std::ranges::any_of(model.maps, named) || std::ranges::any_of(model.normal_maps, named);
}

// Adds the maps to a material of another model; maps of the main colour get the name that they have
// there. Returns the names of maps that the model does not have.
std::vector<std::string> KeepMaps(const Json& maps, std::string_view model_name, Json* material) {
  constexpr std::array<std::string_view, 3> kOfColor = {"base_color_map", "albedo_map",
                                                        "diffuse_map"};
  const MaterialModel* const model = FindModel(model_name);
  std::vector<std::string> lost;
  for (const auto& [name, value] : maps.items()) {
    std::vector<std::string_view> names = {name};
    if (std::ranges::find(kOfColor, name) != kOfColor.end()) {
      names.insert(names.end(), kOfColor.begin(), kOfColor.end());
    }
    const auto found = std::ranges::find_if(names, [&](std::string_view candidate) {
      return model != nullptr && HasMap(*model, candidate);
    });
    if (found != names.end()) {
      (*material)[std::string(*found)] = value;
    } else {
      lost.push_back(name);
    }
  }
  return lost;
}

size_t BytesOf(const Image& image) {
  return image.channels.size() * image.data.pixel_count() * sizeof(float);
}

// The channels of an image's layer, in the order R G B, or X Y Z.
std::vector<const Channel*> ChannelsOf(const Image& image, const std::string& layer) {
  std::vector<const Channel*> found;
  const std::string prefix = layer.empty() ? "" : layer + ".";
  for (const char* const letters : {"RGB", "XYZ"}) {
    for (const char* letter = letters; *letter != 0; ++letter) {
      const Channel* const channel = image.Find(prefix + *letter);
      if (channel != nullptr && !(layer.empty() && *letters == 'X')) found.push_back(channel);
    }
    if (found.size() == 3) return found;
    found.clear();
  }
  if (const Channel* const channel = image.Find(layer)) found.push_back(channel);
  return found;
}

}  // namespace

Worker::Worker(const OpenDocument& open, const WorkerOptions& options)
    : options_(options), document_(open()), display_(options.display) {}

Worker::~Worker() { Stop(); }

void Worker::Stop() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
    cancel_ = true;
  }
  woken_.notify_all();
  if (thread_.joinable()) thread_.join();
}

void Worker::Start(WorkerSinks sinks, std::unique_ptr<EditsFile> edits) {
  sinks_ = std::move(sinks);
  edits_ = std::move(edits);
  thread_ = std::thread([this] { Run(); });
}

void Worker::Receive(ClientId client, std::string_view message) {
  Add(ReadRequest(client, message));
}

void Worker::Add(Request request) {
  {
    const std::lock_guard lock(mutex_);
    const bool changes = request.ChangesPicture();
    mailbox_.Add(std::move(request));
    if (changes && refining_) cancel_ = true;
  }
  woken_.notify_all();
}

void Worker::Opened(ClientId client) {
  {
    const std::lock_guard lock(mutex_);
    clients_.push_back(client);
  }
  Add({client, WelcomeRequest{}});
}

void Worker::Closed(ClientId client) {
  const std::lock_guard lock(mutex_);
  std::erase(clients_, client);
  mailbox_.Forget(client);
}

void Worker::Ready(double ms, size_t bytes) {
  {
    const std::lock_guard lock(mutex_);
    ready_ = true;
    // A moving average, since a single measurement may be due to a busy browser.
    if (bytes > 0) ms_per_byte_ += 0.3 * (ms / static_cast<double>(bytes) - ms_per_byte_);
  }
  woken_.notify_all();
}

void Worker::Run() {
  last_change_ = last_files_ = Clock::now();
  bool runs = true;
  while (runs) {
    try {
      runs = Step();
    } catch (const Cancelled&) {
      plan_.reset();  // its film is no longer valid
    } catch (...) {
      // Do not render this picture again before something changes.
      done_ = true;
      moved_ = false;
      plan_.reset();
      sinks_.say(0, CaughtFault(""));
    }
  }
  Finish();
}

// Waits for work and does it. Returns false once the worker is to stop.
bool Worker::Step() {
  std::vector<Request> requests;
  Next next = Next::kNothing;
  {
    std::unique_lock lock(mutex_);
    refining_ = false;
    std::erase_if(kept_, [&](const auto& kept) {
      return std::ranges::find(clients_, kept.first) == clients_.end();
    });
    const auto since_change = [&] { return Clock::now() - last_change_; };
    const bool to_measure = AnyToMeasure();
    const auto has_work = [&] {
      if (stop_ || !mailbox_.empty()) return true;
      if (clients_.empty()) return false;
      return moved_ || (!done_ && since_change() >= kRest) ||
             (to_measure && since_change() >= kMeasureAfter);
    };
    if (!has_work()) {
      // Waits for a request, or until it is time to refine, to measure or to look at the files.
      const auto until = clients_.empty() || moved_ ? Clock::now() + kFilesEvery
                         : !done_                   ? last_change_ + kRest
                         : to_measure               ? last_change_ + kMeasureAfter
                                                    : Clock::now() + kFilesEvery;
      woken_.wait_until(lock, until, has_work);
    }
    // A picture that no page can take yet would be outdated when it is sent: wait for newer values.
    if (!stop_ && (moved_ || !mailbox_.empty()) && !clients_.empty()) {
      woken_.wait_for(lock, kPatience, [&] { return stop_ || ready_; });
    }
    if (stop_) return false;
    requests = mailbox_.Take();
    cancel_ = false;
  }
  const bool was_moved = std::exchange(moved_, false);
  for (const Request& request : requests) {
    Serve(request);
    KeepEdits(false);
  }
  if (moved_ || std::ranges::any_of(requests, &Request::ChangesPicture)) {
    last_change_ = Clock::now();
  }
  moved_ |= was_moved;
  KeepEdits(false);
  if (requests.empty() && Clock::now() - last_files_ >= kFilesEvery) {
    last_files_ = Clock::now();
    CheckFiles();
  }
  {
    const std::lock_guard lock(mutex_);
    if (clients_.empty()) return true;
    next = moved_                                                           ? Next::kMoving
           : !done_ && Clock::now() - last_change_ >= kRest                 ? Next::kRefine
           : AnyToMeasure() && Clock::now() - last_change_ >= kMeasureAfter ? Next::kMeasure
                                                                            : Next::kNothing;
    // Requests from now on cancel the refinement at once; earlier ones have not set the flag.
    refining_ = next == Next::kRefine && mailbox_.empty();
    if (next == Next::kRefine && !mailbox_.empty()) return true;
    if (next == Next::kMoving) ready_ = false;
  }
  if (next == Next::kMoving) RenderMoving();
  if (next == Next::kRefine) Refine();
  if (next == Next::kMeasure) Measure();
  return true;
}

// Called when the server ends. Serves and keeps the changes that pages have asked for, as far as
// there is time.
void Worker::Finish() {
  try {
    KeepEdits(true);
    std::vector<Request> requests;
    {
      const std::lock_guard lock(mutex_);
      requests = mailbox_.Take();
    }
    const auto start = Clock::now();
    for (const Request& request : requests) {
      if (request.ChangesScene() && Clock::now() - start < kLastChanges) Serve(request);
    }
    KeepEdits(true);
  } catch (...) {  // the last file that was written remains
  }
}

// Writes the changes since the last time, unless that was only a moment ago.
void Worker::KeepEdits(bool at_once) {
  const auto start = Clock::now();
  if (!edits_ || !edits_to_keep_ || (start < keep_edits_at_ && !at_once)) return;
  bool kept = false;
  try {
    kept = edits_->Keep(document_->Edits());
  } catch (const std::exception&) {  // out of memory
  }
  edits_to_keep_ = !kept;
  const Clock::duration took = Clock::now() - start;
  keep_edits_at_ = start + std::max<Clock::duration>(kKeepEvery, kKeepShare * took);
  if (kept || std::exchange(edits_failed_, !kept)) return;
  sinks_.say(0, FaultMessage("", Error(ExitCode::kCannotWrite, "",
                                       "edits cannot be kept for the case that the server ends",
                                       "take the scene away before it does")));
}

// Serves one request; exceptions are reported to its page.
void Worker::Serve(const Request& request) {
  try {
    std::visit([&](const auto& what) { Answer(request.client, what); }, request.what);
  } catch (...) {
    sinks_.say(request.client, CaughtFault(""));
  }
  // A change may have cancelled this request; the next one starts afresh.
  const std::lock_guard lock(mutex_);
  refining_ = false;
  cancel_ = stop_;
}

void Worker::Answer(ClientId /*client*/, const LookRequest& look) {
  display_.tone = ParseToneOperator(look.tone);
  display_.exposure_ev = look.exposure;
  for (auto& [id, kept] : kept_) kept.measured = false;  // SSIM and FLIP compare display pictures
  ParseLayers({"all", look.layer.empty() ? "albedo" : look.layer}, document_->scene());
  const bool another = layer_ != look.layer;
  layer_ = look.layer;
  if (another) {
    Changed();
  } else if (!image_.channels.empty()) {
    Publish();
  }
}

void Worker::Answer(ClientId client, const WelcomeRequest& /*request*/) {
  SayScene(client);
  if (image_.channels.empty()) {
    moved_ = true;
  } else {
    Publish();
  }
}

void Worker::Answer(ClientId client, const SetRequest& set) {
  plan_.reset();  // it refers to the scene
  try {
    document_->Set(set.pointer, set.value, set.gesture);
  } catch (...) {
    moved_ = true;  // the picture that was being refined is lost
    sinks_.say(client, CaughtFault(set.pointer));
    return;
  }
  Changed();
  edits_to_keep_ = true;
  Json told = {{"changed", set.pointer},         {"value", set.value},
               {"revision", revision_},          {"client", client},
               {"serial", set.serial},           {"camera", document_->Camera()},
               {"undo", document_->can_undo()},  {"redo", document_->can_redo()},
               {"reset", document_->can_reset()}};
  if (document_->is_model()) {
    told["lights"] = document_->ModelLights();
    told["original_lights"] = document_->OriginalModelLights();
  }
  sinks_.say(0, JsonText(told));
}

void Worker::Answer(ClientId client, const ConvertRequest& convert) {
  try {
    const Json tree = document_->Tree();
    const Json::json_pointer pointer(convert.pointer);
    if (pointer.empty() || !tree.contains(pointer)) {
      throw Error(ExitCode::kUsage, convert.pointer, "there is no material here");
    }
    Json own = tree.at(pointer);
    const Json maps = TakeMaps(&own);
    const MaterialFit fit =
        FitMaterial(LoadMaterialText(JsonText(own), convert.pointer), convert.model);
    Json fitted = MaterialJson(fit.fitted);
    Json notes = KeepMaps(maps, convert.model, &fitted);
    Answer(client, SetRequest{convert.pointer, std::move(fitted), convert.gesture});
    if (notes.empty() && fit.notes.empty()) return;
    for (const std::string& note : fit.notes) notes.push_back(Printable(note));
    sinks_.say(client, JsonText({{"not_kept", std::move(notes)}, {"convert", convert.pointer}}));
  } catch (const Json::exception&) {
    sinks_.say(client, FaultMessage(convert.pointer, Error(ExitCode::kUsage, convert.pointer,
                                                           "is no JSON pointer")));
  } catch (...) {
    sinks_.say(client, CaughtFault(convert.pointer));
  }
}

void Worker::Answer(ClientId client, OfferedRequest what) {
  if (!edits_ || edits_->offered().empty()) return SayScene(client);  // another page has decided
  const std::vector<Edit> offered = edits_->offered();
  plan_.reset();  // it refers to the scene
  std::vector<std::string> unfit;
  if (what == OfferedRequest::kRestore) unfit = document_->Restore(offered);
  edits_->ForgetOffered();
  edits_to_keep_ = true;
  Changed();
  SayScene(0);
  if (unfit.empty()) return;
  std::vector<Fault> faults;
  for (const std::string& pointer : unfit) {
    faults.push_back({pointer, "is not in the scene as it is now: this edit was left out", ""});
  }
  sinks_.say(client, FaultMessage("", Error(ExitCode::kUsage, std::move(faults))));
}

void Worker::Answer(ClientId client, const ExplainRequest& request) {
  // A filter of almost no width, so that the ray goes through the pixel's centre, where the terms
  // are computed.
  constexpr double kNoWidth = 1e-6;
  constexpr int kSamples = 64;  // per light that is sampled
  plan_.reset();                // it refers to the scene
  const bool sampled = std::ranges::any_of(document_->scene().lights, [](const Light& light) {
    return !IsPunctual(light) && !std::holds_alternative<AmbientLight>(light.kind);
  });
  const int divisor = FitDivisor();
  ImageSettings image = RestingImage(divisor);
  image.filter = {FilterKind::kBox, kNoWidth};
  image.spp = sampled ? kSamples : 1;
  document_->UseImage(image);
  RenderSettings settings = Settings();
  settings.layers = {"all"};
  const int x = std::min(request.x / divisor, image.width - 1);
  const int y = std::min(request.y / divisor, image.height - 1);
  settings.region = {x, y, x + 1, y + 1};
  const auto render = [&] {
    const FramePlan plan = MakePlan(document_->scene(), settings, document_->prepared());
    return RenderImage(plan, settings, nullptr);
  };
  PixelLayers pixel;
  pixel.samples = image.spp;
  pixel.all = render();
  settings.diffuse_light_layers = true;
  pixel.diffuse_light = render();
  const auto pixel_with = [&](size_t index, const Material& other) {
    const Material own = document_->scene().materials[index];
    document_->UseMaterial(index, other);
    const auto put_back = [&] { document_->UseMaterial(index, own); };
    try {
      Image of_other = render();
      put_back();
      return of_other;
    } catch (...) {
      put_back();
      throw;
    }
  };
  Json json = ExplainPixel(document_->scene(), pixel, pixel_with);
  json["x"] = request.x;
  json["y"] = request.y;
  sinks_.say(client, JsonText({{"explained", std::move(json)}, {"revision", revision_}}));
}

void Worker::Answer(ClientId /*client*/, HistoryRequest step) {
  plan_.reset();
  const bool did = step == HistoryRequest::kUndo   ? document_->Undo()
                   : step == HistoryRequest::kRedo ? document_->Redo()
                                                   : document_->Reset();
  Changed();
  if (!did) return;
  edits_to_keep_ = true;
  SayScene(0);
}

void Worker::Changed() {
  plan_.reset();
  ++revision_;
  moved_ = true;
  done_ = false;
  for (auto& [id, kept] : kept_) kept.measured = false;
}

void Worker::SayScene(ClientId client) {
  Json tree = document_->Tree(), original = document_->OriginalTree();
  const bool whole = document_->lists_all_shapes() && JsonText(tree).size() <= kMaxSceneText;
  if (!whole) {
    tree.erase("shapes");
    original.erase("shapes");
  }
  Json layers = Json::array();
  for (const Layer& layer : ParseLayers({"all"}, document_->scene())) {
    if (layer.kind != LayerKind::kAlpha) layers.push_back(layer.name);
  }
  Json offered;
  if (edits_ && !edits_->offered().empty()) {
    offered = {{"edits", edits_->offered().size()}, {"time", edits_->offered_time()}};
  }
  Json given = Json::array();
  for (const std::string& word : options_.given) given.push_back(Printable(word));
  sinks_.say(client, JsonText({{"scene", std::move(tree)},
                               {"given", std::move(given)},
                               {"camera", document_->Camera()},
                               {"original", std::move(original)},
                               {"whole", whole},
                               {"name", Printable(document_->name())},
                               {"file", Printable(options_.file)},
                               {"layers", std::move(layers)},
                               {"files", document_->ImageFiles()},
                               {"generator", options_.generator},
                               {"width", document_->own_image().width},
                               {"height", document_->own_image().height},
                               {"revision", revision_},
                               {"client", client},
                               {"banner", banner_},
                               {"offered", std::move(offered)},
                               {"undo", document_->can_undo()},
                               {"redo", document_->can_redo()},
                               {"reset", document_->can_reset()}}));
}

void Worker::CheckFiles() {
  if (!document_->FilesChanged()) return;
  try {
    plan_.reset();  // it refers to the scene
    document_->ReadChangedFiles();
    banner_.clear();
    edits_to_keep_ = true;
    Changed();
    SayScene(0);
  } catch (const std::exception& error) {
    // The last good picture stays.
    banner_ = PrintableLines(error.what());
    sinks_.say(0, JsonText({{"banner", banner_}}));
  }
}

void Worker::Answer(ClientId client, const SamplesRequest& request) {
  std::vector<const Channel*> channels;
  if (!image_.channels.empty()) channels = ChannelsOf(image_, request.layer);
  FrameHead head;
  head.revision = revision_;
  head.samples = request.id;
  head.of_samples = static_cast<uint32_t>(channels.size());
  head.width = static_cast<uint32_t>(channels.empty() ? 0 : image_.data.width());
  head.height = static_cast<uint32_t>(channels.empty() ? 0 : image_.data.height());
  head.done = done_ ? 1 : 0;
  sinks_.send(client, SampleBytes(head, channels));
}

// ---- A and B, and what is taken away ------------------------------------------------------------

void Worker::Answer(ClientId client, const KeepRequest& request) {
  const bool keep = request.keep && done_;
  kept_.erase(client);
  size_t bytes = 0;
  for (const auto& [id, kept] : kept_) bytes += BytesOf(*kept.image);
  if (keep && bytes + BytesOf(image_) > kMaxKeptBytes) {
    throw Error(ExitCode::kUsage, "", "pictures that are kept as A take too much memory",
                "a smaller picture, or fewer pages that keep one");
  }
  if (keep) kept_[client] = {std::make_shared<const Image>(image_)};
  sinks_.say(client, JsonText({{"kept", keep}, {"revision", revision_}}));
}

bool Worker::AnyToMeasure() const {
  return done_ &&
         std::ranges::any_of(kept_, [](const auto& kept) { return !kept.second.measured; });
}

void Worker::Measure() {
  for (auto& [client, kept] : kept_) {
    if (std::exchange(kept.measured, true)) continue;
    Json metrics;  // null: the pictures differ in size
    if (kept.image->data == image_.data) metrics = BeautyMetricsJson(image_, *kept.image, display_);
    sinks_.say(client, JsonText({{"metrics", std::move(metrics)}, {"revision", revision_}}));
  }
}

void Worker::Answer(ClientId client, TakeRequest what) {
  {
    const std::lock_guard lock(mutex_);
    refining_ = true;  // a change cancels it
  }
  SharedBytes bytes;
  try {
    bytes = what == TakeRequest::kExr ? TakeExr() : TakeReport(client);
  } catch (const Cancelled&) {
    throw Error(ExitCode::kUsage, "", "the scene has changed meanwhile", "take it away again");
  }
  if (bytes->size() > kMaxFileBytes) {
    throw Error(ExitCode::kUsage, "", "the file is too large to be sent",
                "the command line makes it: nacre render, nacre report");
  }
  sinks_.send(client, std::move(bytes));
}

SharedBytes Worker::TakeExr() {
  plan_.reset();  // it refers to the scene
  document_->UseImage(RestingImage());
  RenderSettings settings = Settings(true);
  settings.layers = {"all"};
  const FramePlan plan = MakePlan(document_->scene(), settings, document_->prepared());
  return FileBytes(FileKind::kExr, RenderExr(plan, settings));
}

SharedBytes Worker::TakeReport(ClientId client) {
  const auto kept = kept_.find(client);
  if (kept == kept_.end() || !options_.make_report) {
    throw Error(ExitCode::kUsage, "", "there is no A to compare with", "keep a picture as A first");
  }
  if (!done_) {
    throw Error(ExitCode::kUsage, "", "the picture is not finished", "take it away once it is");
  }
  const std::string html = options_.make_report(*kept->second.image, image_, display_);
  return FileBytes(FileKind::kReport, std::vector<uint8_t>(html.begin(), html.end()));
}

// ---- Rendering ----------------------------------------------------------------------------------

RenderSettings Worker::Settings(bool adaptive) {
  RenderSettings settings = options_.settings;
  if (!adaptive) settings.max_error = 0;
  settings.cancel = &cancel_;
  if (!layer_.empty()) settings.layers = {layer_};
  return settings;
}

ImageSettings Worker::RestingImage(int divisor) const {
  ImageSettings image = document_->own_image();
  image.width = (image.width + divisor - 1) / divisor;
  image.height = (image.height + divisor - 1) / divisor;
  if (options_.samples > 0) image.spp = options_.samples;
  return image;
}

int Worker::FitDivisor() const {
  const ImageSettings image = document_->own_image();
  for (const int divisor : kDivisors) {
    if (static_cast<double>(image.width) / divisor * image.height / divisor <= kMaxPixels) {
      return divisor;
    }
  }
  return 32;
}

void Worker::Plan(int divisor, bool moving) {
  plan_.reset();
  ImageSettings image = RestingImage(divisor);
  if (moving) image.spp = 1;  // one sample per pixel has fast paths of its own
  document_->UseImage(image);
  plan_.emplace(MakePlan(document_->scene(), Settings(), document_->prepared()));
  film_ = {};
}

void Worker::RenderMoving() {
  const auto start = Clock::now();
  const int divisor = std::max(divisor_, FitDivisor());
  Plan(divisor, true);
  RenderInto(*plan_, Settings(), &next_);
  std::swap(image_, next_);
  plan_.reset();  // refined pictures have more samples
  moved_ = false;
  render_ms_ = MsSince(start);
  done_ = RestingImage().spp == 1 && divisor == FitDivisor() && !(options_.settings.max_error > 0);
  Publish(true);
  // The time of the first picture is not representative, as it builds the data that later ones
  // reuse.
  if (revision_ <= 1) return;
  double way_ms = 0;
  {
    const std::lock_guard lock(mutex_);
    way_ms = ms_per_byte_ * 4.0 * static_cast<double>(image_.data.pixel_count());
  }
  Adapt(render_ms_ + way_ms);
}

// Chooses the next divisor from the time of this picture: reduces the size at once, but increases
// it only stepwise, if there is time to spare.
void Worker::Adapt(double ms) {
  const auto place = std::find(kDivisors.begin(), kDivisors.end(), divisor_);
  if (ms > kMovingMs) {
    const double wanted = divisor_ * std::sqrt(ms / kMovingMs);
    const auto enough =
        std::find_if(place, kDivisors.end() - 1, [&](int d) { return d >= wanted; });
    divisor_ = *enough;
  } else if (place != kDivisors.begin()) {
    const double larger = *(place - 1);
    if (ms * (divisor_ / larger) * (divisor_ / larger) < 0.8 * kMovingMs) divisor_ = *(place - 1);
  }
}

void Worker::Refine() {
  const auto start = Clock::now();
  const bool adaptive = options_.settings.max_error > 0;
  const RenderSettings settings = Settings(adaptive && plan_ && film_.samples > 0);
  if (settings.max_error > 0) {
    plan_.reset();
    FramePlan plan = MakePlan(document_->scene(), settings, document_->prepared());
    RenderInto(plan, settings, &next_);
    std::swap(image_, next_);
    plan_.emplace(std::move(plan));
    render_ms_ = MsSince(start);
    done_ = true;
    return Publish();
  }
  if (!plan_) Plan(FitDivisor());
  const int spp = plan_->scene->image.spp;
  double last_shown = film_.samples == 0 ? -kRefinedEveryMs : 0;
  do {
    const int end = std::min(std::max(1, 2 * film_.samples), spp);
    FitImage(*plan_, settings, &next_);
    RenderPass(*plan_, settings, end, &film_, &next_);
    std::swap(image_, next_);
    // Pictures are not shown faster than pages can display them while the rendering goes on.
    if (film_.samples < spp && MsSince(start) - last_shown < kRefinedEveryMs) continue;
    last_shown = MsSince(start);
    render_ms_ = last_shown;
    done_ = film_.samples == spp && !adaptive;
    Publish();
  } while (film_.samples < spp && !cancel_ && !adaptive);
}

void Worker::Publish(bool moving) {
  std::vector<const Channel*> channels = ChannelsOf(image_, layer_);
  if (channels.empty()) channels = ChannelsOf(image_, "");
  const std::array<const float*, 3> rgb = {channels[0]->samples.data(),
                                           channels[channels.size() > 1 ? 1 : 0]->samples.data(),
                                           channels[channels.size() > 2 ? 2 : 0]->samples.data()};
  const ImageSettings own = document_->own_image();
  FrameHead head;
  head.revision = revision_;
  head.width = static_cast<uint32_t>(image_.data.width());
  head.height = static_cast<uint32_t>(image_.data.height());
  head.frame_width = static_cast<uint32_t>(own.width);
  head.frame_height = static_cast<uint32_t>(own.height);
  head.samples = static_cast<uint32_t>(std::max(film_.samples, 1));
  head.moving = moving ? 1 : 0;
  head.of_samples = static_cast<uint32_t>(RestingImage().spp);
  head.done = done_ ? 1 : 0;
  head.render_us = static_cast<uint32_t>(std::min(1e3 * render_ms_, 4e9));
  sinks_.show(PictureBytes(head, rgb, display_));
}

}  // namespace nacre
