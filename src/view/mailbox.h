// SPDX-License-Identifier: Apache-2.0
// view/mailbox.h: what pages ask for until the render thread takes it. Of several values for one
// pointer the newest is kept.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "scene_io/json_text.h"

namespace nacre {

using ClientId = uint64_t;  // a page's connection; counted from 1

struct SetRequest {
  std::string pointer;
  Json value;
  uint64_t gesture = 0;  // changes of one drag have one number
  uint64_t serial = 0;   // of the client's requests
};
enum class HistoryRequest : uint8_t { kUndo, kRedo, kReset };
// How the picture is shown.
struct LookRequest {
  std::string tone, layer;
  double exposure = 0;
};
// The samples of a layer of the picture that was shown last.
struct SamplesRequest {
  std::string layer;
  uint32_t id = 0;  // comes back with them
};
// Where a pixel's value comes from.
struct ExplainRequest {
  int x = 0, y = 0;
};
// The material at a pointer becomes the nearest one of another model, as `nacre convert` finds it.
struct ConvertRequest {
  std::string pointer, model;
  uint64_t gesture = 0;
};
// The picture at rest is kept as A, which later ones are measured against; or not any more.
struct KeepRequest {
  bool keep = true;
};
// A file to take away: the picture with all layers, or a report of A and the present picture.
enum class TakeRequest : uint8_t { kExr, kReport };
struct WelcomeRequest {};  // a page that has just connected: it is told all
// What becomes of the edits that an earlier server had when it ended.
enum class OfferedRequest : uint8_t { kRestore, kDiscard };

struct Request {
  ClientId client = 0;
  std::variant<SetRequest, HistoryRequest, LookRequest, SamplesRequest, ExplainRequest,
               ConvertRequest, KeepRequest, TakeRequest, WelcomeRequest, OfferedRequest>
      what;
  size_t bytes = 0;  // of the message
  // Whether it changes what the picture shows, or how: a render for what was before may end.
  bool ChangesPicture() const;
  // Whether it changes the scene: each does, in turn. Of others a page's newest is enough.
  bool ChangesScene() const;
};

// Of pointers in messages: no scene's names are as long.
inline constexpr size_t kMaxPointerBytes = 4096;

// Whether a value at one of the pointers is part of a value at the other.
bool PointersOverlap(std::string_view a, std::string_view b);

// What a message of a page asks for. Throws Error (kBadInput) for one that asks for nothing known.
Request ReadRequest(ClientId client, std::string_view text);

// What waits is bounded: of each page its newest request of every kind, and changes of the scene by
// number and size.
class Mailbox {
 public:
  static constexpr size_t kMaxWaiting = 1024;
  // From here on drags of the same value are no steps of their own any more.
  static constexpr size_t kCrowded = kMaxWaiting / 2;
  // Of messages. Their trees take some twenty times as much.
  static constexpr size_t kMaxWaitingBytes = size_t{8} << 20;

  // Throws Error (kUsage) for a change of the scene if too many wait already.
  void Add(Request request);
  // The page has gone: it needs no answers.
  void Forget(ClientId client);
  std::vector<Request> Take();
  bool empty() const { return waiting_.empty(); }

 private:
  std::vector<Request>::iterator Outdated(const SetRequest& set, bool crowded);

  std::vector<Request> waiting_;
};

}  // namespace nacre
