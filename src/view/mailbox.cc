// SPDX-License-Identifier: Apache-2.0
#include "view/mailbox.h"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "base/error.h"
#include "color/tone.h"
#include "scene/limits.h"
#include "scene_io/json_reader.h"
#include "shading/material_fit.h"

namespace nacre {
namespace {

// Whole numbers that a double holds exactly.
constexpr Range kCounter{0, 9007199254740991.0};
constexpr Range kStops{-60, 60};
constexpr Range kPixel{0, limits::kImageSide.max};

bool IsBelow(std::string_view pointer, std::string_view above) {
  return pointer.size() > above.size() && pointer.starts_with(above) &&
         pointer[above.size()] == '/';
}

// Refuses pointers that are too long for any value of a scene, before the cost of following them.
void ReadPointer(const char* name, JsonObject* message, std::string* pointer) {
  message->Text(name, pointer);
  const auto depth = static_cast<size_t>(std::count(pointer->begin(), pointer->end(), '/'));
  if (pointer->size() > kMaxPointerBytes || depth > kMaxJsonDepth) {
    message->Find(name)->AddFault(
        "is longer than any scene's pointers",
        fmt::format("{} bytes and {} levels at most", kMaxPointerBytes, kMaxJsonDepth));
    pointer->clear();
  }
}

SetRequest ReadSet(JsonObject* message) {
  SetRequest set;
  ReadPointer("set", message, &set.pointer);
  if (const auto value = message->Require("value")) set.value = value->json;
  message->Whole("gesture", kCounter, &set.gesture);
  message->Whole("serial", kCounter, &set.serial);
  return set;
}

LookRequest ReadLook(JsonObject* message) {
  LookRequest look;
  const std::vector<std::string> names = ToneOperatorNames();
  const std::vector<std::string_view> tones(names.begin(), names.end());
  size_t tone = 0;
  message->Choice("look", tones, &tone);
  look.tone = names[tone];
  message->Text("layer", &look.layer);
  message->Number("exposure", kStops, &look.exposure);
  return look;
}

}  // namespace

bool PointersOverlap(std::string_view a, std::string_view b) {
  return a == b || IsBelow(a, b) || IsBelow(b, a);
}

bool Request::ChangesPicture() const {
  return std::holds_alternative<SetRequest>(what) || std::holds_alternative<HistoryRequest>(what) ||
         std::holds_alternative<LookRequest>(what) ||
         std::holds_alternative<ConvertRequest>(what) ||
         std::holds_alternative<OfferedRequest>(what);
}

bool Request::ChangesScene() const {
  return ChangesPicture() && !std::holds_alternative<LookRequest>(what);
}

Request ReadRequest(ClientId client, std::string_view text) {
  const std::string file = "message";
  FaultList faults;
  const Json json = ParseJson(text, file, &faults);
  const JsonPath root;
  JsonObject message({json, root, &faults});
  constexpr std::array<std::string_view, 3> kSteps = {"undo", "redo", "reset"};
  constexpr std::array<std::string_view, 2> kFiles = {"exr", "report"};
  constexpr std::array<std::string_view, 2> kOffered = {"restore", "discard"};
  Request request{client, {}, text.size()};
  size_t step = 0;
  if (message.Find("set")) {
    request.what = ReadSet(&message);
  } else if (message.Find("look")) {
    request.what = ReadLook(&message);
  } else if (message.Find("samples")) {
    SamplesRequest samples;
    message.Text("samples", &samples.layer);
    message.Whole("id", Range{0, std::numeric_limits<uint32_t>::max()}, &samples.id);
    request.what = samples;
  } else if (message.Find("explain")) {
    ExplainRequest explain;
    message.Whole("explain", kPixel, &explain.x);
    message.Whole("y", kPixel, &explain.y);
    request.what = explain;
  } else if (message.Find("convert")) {
    ConvertRequest convert;
    const std::span<const std::string_view> models = FitTargets();
    ReadPointer("convert", &message, &convert.pointer);
    size_t model = 0;
    message.Choice("model", models, &model);
    convert.model = models[model];
    message.Whole("gesture", kCounter, &convert.gesture);
    request.what = convert;
  } else if (message.Find("keep")) {
    KeepRequest keep;
    message.Boolean("keep", &keep.keep);
    request.what = keep;
  } else if (message.Find("take")) {
    message.Choice("take", kFiles, &step);
    request.what = static_cast<TakeRequest>(step);
  } else if (message.Find("history")) {
    message.Choice("history", kSteps, &step);
    request.what = static_cast<HistoryRequest>(step);
  } else if (message.Find("offered")) {
    message.Choice("offered", kOffered, &step);
    request.what = static_cast<OfferedRequest>(step);
  } else {
    faults.Add("", "asks for nothing known",
               "it has one of set, look, samples, explain, convert, keep, take, history, offered");
  }
  message.RefuseOthers();
  ThrowFaults(faults, file);
  return request;
}

// The waiting change that is obsolete because of this newer value for the same pointer; or the end.
std::vector<Request>::iterator Mailbox::Outdated(const SetRequest& set, bool crowded) {
  for (auto at = waiting_.end(); at != waiting_.begin();) {
    --at;
    const auto* other = std::get_if<SetRequest>(&at->what);
    if (other == nullptr && at->ChangesScene()) break;  // it may depend on the older value
    if (other == nullptr || !PointersOverlap(other->pointer, set.pointer)) continue;
    if (other->pointer != set.pointer) break;
    return other->gesture == set.gesture || crowded ? at : waiting_.end();
  }
  return waiting_.end();
}

void Mailbox::Add(Request request) {
  if (!request.ChangesScene()) {
    std::erase_if(waiting_, [&](const Request& other) {
      return other.client == request.client && other.what.index() == request.what.index();
    });
    waiting_.push_back(std::move(request));
    return;
  }
  size_t changes = 1, bytes = request.bytes;
  for (const Request& other : waiting_) {
    if (!other.ChangesScene()) continue;
    ++changes;
    bytes += other.bytes;
  }
  const auto* const set = std::get_if<SetRequest>(&request.what);
  const auto outdated = set != nullptr ? Outdated(*set, changes > kCrowded) : waiting_.end();
  if (outdated != waiting_.end()) {
    --changes;
    bytes -= outdated->bytes;
  }
  if (changes > kMaxWaiting || bytes > kMaxWaitingBytes) {
    throw Error(ExitCode::kUsage, "", "too many changes wait", "send them more slowly");
  }
  if (outdated != waiting_.end()) waiting_.erase(outdated);
  waiting_.push_back(std::move(request));
}

void Mailbox::Forget(ClientId client) {
  std::erase_if(waiting_, [&](const Request& request) {
    return request.client == client && !request.ChangesScene();
  });
}

std::vector<Request> Mailbox::Take() { return std::exchange(waiting_, {}); }

}  // namespace nacre
