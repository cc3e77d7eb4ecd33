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

struct Request {
  ClientId client = 0;
  std::variant<SetRequest, HistoryRequest, LookRequest, SamplesRequest, ExplainRequest,
               ConvertRequest, KeepRequest, TakeRequest, WelcomeRequest>
      what;
  // Whether it changes what the picture shows, or how: a render for what was before may end.
  bool ChangesPicture() const;
};

// What a message of a page asks for. Throws Error (kBadInput) for one that asks for nothing known.
Request ReadRequest(ClientId client, std::string_view text);

class Mailbox {
 public:
  static constexpr size_t kMaxWaiting = 1024;

  // Throws Error (kUsage) if too much waits already.
  void Add(Request request);
  std::vector<Request> Take();
  bool empty() const { return waiting_.empty(); }

 private:
  std::vector<Request> waiting_;
};

}  // namespace nacre
