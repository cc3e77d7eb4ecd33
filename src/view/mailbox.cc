// SPDX-License-Identifier: Apache-2.0
#include "view/mailbox.h"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "base/error.h"
#include "color/tone.h"
#include "scene/limits.h"
#include "scene_io/json_reader.h"
#include "shading/material_fit.h"

namespace nacre {
namespace {

// Whole numbers that a double holds.
constexpr Range kCounter{0, 9007199254740991.0};
constexpr Range kStops{-60, 60};
constexpr Range kPixel{0, limits::kImageSide.max};

bool IsBelow(std::string_view pointer, std::string_view above) {
  return pointer.size() > above.size() && pointer.starts_with(above) &&
         pointer[above.size()] == '/';
}

// Whether a value at one of the pointers is part of a value at the other.
bool Overlap(std::string_view a, std::string_view b) {
  return a == b || IsBelow(a, b) || IsBelow(b, a);
}

SetRequest ReadSet(JsonObject* message) {
  SetRequest set;
  message->Text("set", &set.pointer);
  if (const Json* value = message->Require("value")) set.value = *value;
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

bool Request::ChangesPicture() const {
  return std::holds_alternative<SetRequest>(what) || std::holds_alternative<HistoryRequest>(what) ||
         std::holds_alternative<LookRequest>(what) || std::holds_alternative<ConvertRequest>(what);
}

Request ReadRequest(ClientId client, std::string_view text) {
  const std::string file = "message";
  FaultList faults;
  const Json json = ParseJson(text, file, &faults);
  const JsonPath root;
  JsonObject message({json, root, &faults});
  constexpr std::array<std::string_view, 3> kSteps = {"undo", "redo", "reset"};
  constexpr std::array<std::string_view, 2> kFiles = {"exr", "report"};
  Request request{client, {}};
  size_t step = 0;
  if (message.Find("set") != nullptr) {
    request.what = ReadSet(&message);
  } else if (message.Find("look") != nullptr) {
    request.what = ReadLook(&message);
  } else if (message.Find("samples") != nullptr) {
    SamplesRequest samples;
    message.Text("samples", &samples.layer);
    message.Whole("id", Range{0, std::numeric_limits<uint32_t>::max()}, &samples.id);
    request.what = samples;
  } else if (message.Find("explain") != nullptr) {
    ExplainRequest explain;
    message.Whole("explain", kPixel, &explain.x);
    message.Whole("y", kPixel, &explain.y);
    request.what = explain;
  } else if (message.Find("convert") != nullptr) {
    ConvertRequest convert;
    const std::span<const std::string_view> models = FitTargets();
    message.Text("convert", &convert.pointer);
    size_t model = 0;
    message.Choice("model", models, &model);
    convert.model = models[model];
    message.Whole("gesture", kCounter, &convert.gesture);
    request.what = convert;
  } else if (message.Find("keep") != nullptr) {
    KeepRequest keep;
    message.Boolean("keep", &keep.keep);
    request.what = keep;
  } else if (message.Find("take") != nullptr) {
    message.Choice("take", kFiles, &step);
    request.what = static_cast<TakeRequest>(step);
  } else if (message.Find("history") != nullptr) {
    message.Choice("history", kSteps, &step);
    request.what = static_cast<HistoryRequest>(step);
  } else {
    faults.Add("", "asks for nothing known",
               "it has one of set, look, samples, explain, convert, keep, take, history");
  }
  message.RefuseOthers();
  ThrowFaults(faults, file);
  return request;
}

void Mailbox::Add(Request request) {
  if (const auto* set = std::get_if<SetRequest>(&request.what)) {
    // An older value of the same place need never be made, unless something between depends on it.
    for (size_t i = waiting_.size(); i-- > 0;) {
      const auto* other = std::get_if<SetRequest>(&waiting_[i].what);
      if (other == nullptr && waiting_[i].ChangesPicture() &&
          !std::holds_alternative<LookRequest>(waiting_[i].what)) {
        break;
      }
      if (other == nullptr || !Overlap(other->pointer, set->pointer)) continue;
      if (other->pointer == set->pointer && other->gesture == set->gesture) {
        waiting_.erase(waiting_.begin() + static_cast<std::ptrdiff_t>(i));
      }
      break;
    }
  } else if (!request.ChangesPicture() || std::holds_alternative<LookRequest>(request.what)) {
    std::erase_if(waiting_, [&](const Request& other) {
      return other.client == request.client && other.what.index() == request.what.index();
    });
  }
  if (waiting_.size() >= kMaxWaiting) {
    throw Error(ExitCode::kUsage, "", "too many changes wait", "send them more slowly");
  }
  waiting_.push_back(std::move(request));
}

std::vector<Request> Mailbox::Take() { return std::exchange(waiting_, {}); }

}  // namespace nacre
