// SPDX-License-Identifier: Apache-2.0
// view/mailbox.h: requests of pages that wait for the render thread. Of several values for one
// pointer, only the newest is kept.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "scene_io/json_text.h"

namespace nacre {

using ClientId = uint64_t;  // identifies a page's connection; counted from 1

struct SetRequest {
  std::string pointer;
  Json value;
  uint64_t gesture = 0;  // the same number for all changes of one drag
  uint64_t serial = 0;   // numbers the client's requests
};
enum class HistoryRequest : uint8_t { kUndo, kRedo, kReset };
// Sets how the picture is shown.
struct LookRequest {
  std::string tone, layer;
  double exposure = 0;
};
// Asks for the samples of a layer of the picture that was shown last.
struct SamplesRequest {
  std::string layer;
  uint32_t id = 0;  // returned with the samples
};
// Asks for an explanation of a pixel's value.
struct ExplainRequest {
  int x = 0, y = 0;
};
// Replaces the material at a pointer by the nearest one of another model, as `nacre convert` does.
struct ConvertRequest {
  std::string pointer, model;
  uint64_t gesture = 0;
};
// Keeps the current picture, if finished, as A, with which later ones are compared; or drops A.
struct KeepRequest {
  bool keep = true;
};
// Asks for a file to download: the picture with all layers, or a report of A and the present
// picture.
enum class TakeRequest : uint8_t { kExr, kReport };
struct WelcomeRequest {};  // a page has just connected, and needs the whole state
// Decides about the edits that an earlier server had when it ended.
enum class OfferedRequest : uint8_t { kRestore, kDiscard };

struct Request {
  ClientId client = 0;
  std::variant<SetRequest, HistoryRequest, LookRequest, SamplesRequest, ExplainRequest,
               ConvertRequest, KeepRequest, TakeRequest, WelcomeRequest, OfferedRequest>
      what;
  size_t bytes = 0;  // size of the message
  // Whether it changes the picture or how it is shown: a render of the previous state may be
  // cancelled.
  bool ChangesPicture() const;
  // Whether it changes the scene. Such requests are all served, in order; of others, only the
  // newest of each page.
  bool ChangesScene() const;
};

// Limit on pointers in messages, longer than any name in a scene.
inline constexpr size_t kMaxPointerBytes = 4096;

// Whether one of the pointers points to or into the value of the other.
bool PointersOverlap(std::string_view a, std::string_view b);

// Parses a message of a page. Throws Error (kBadInput) for an unknown request.
Request ReadRequest(ClientId client, std::string_view text);

// The queue is bounded: it holds the newest request of each kind for each page, and changes of the
// scene up to a number and a size.
class Mailbox {
 public:
  static constexpr size_t kMaxWaiting = 1024;
  // Beyond this many changes, values of different drags of the same pointer are merged, too.
  static constexpr size_t kCrowded = kMaxWaiting / 2;
  // Total size of messages. Their trees take about twenty times as much.
  static constexpr size_t kMaxWaitingBytes = size_t{8} << 20;

  // Throws Error (kUsage) for a change of the scene if too many are waiting.
  void Add(Request request);
  // Drops requests of a page that has gone and needs no answers.
  void Forget(ClientId client);
  std::vector<Request> Take();
  bool empty() const { return waiting_.empty(); }

 private:
  std::vector<Request>::iterator Outdated(const SetRequest& set, bool crowded);

  std::vector<Request> waiting_;
};

}  // namespace nacre
