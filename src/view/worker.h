// SPDX-License-Identifier: Apache-2.0
// view/worker.h: the thread that owns the scene: it serves the requests of pages, renders, and
// publishes pictures. While the scene is being changed, pictures are rendered within a time limit;
// then they are refined.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "color/display.h"
#include "render/render.h"
#include "view/document.h"
#include "view/edits.h"
#include "view/frame.h"
#include "view/mailbox.h"

namespace nacre {

struct WorkerOptions {
  int samples = 0;          // per pixel of the refined picture; 0: the scene's
  RenderSettings settings;  // of all pictures, but that only the refined one is sampled adaptively
  DisplaySettings display;
  // What the command line specifies, for the page's own command line.
  std::string generator;  // "nacre 0.2.0 (c0ffee)"
  std::string file;
  std::vector<std::string> given;  // options that have changed the scene
  // Makes a page that compares A and B, as `nacre report` does.
  std::function<std::string(const Image& a, const Image& b, const DisplaySettings&)> make_report;
};

// Receivers of the worker's pictures and answers. Called from its thread.
struct WorkerSinks {
  std::function<void(SharedBytes)> show;            // to all pages
  std::function<void(ClientId, std::string)> say;   // JSON; client 0: to all
  std::function<void(ClientId, SharedBytes)> send;  // samples and files, to one page
};

// Opens the document. Throws Error.
using OpenDocument = std::function<std::unique_ptr<ViewDocument>()>;

class Worker {
 public:
  // Opens the document in the calling thread, and throws its errors.
  Worker(const OpenDocument& open, const WorkerOptions& options);
  ~Worker();  // stops the thread
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  // `edits`, which may be null, keeps edits beyond the server's end.
  void Start(WorkerSinks sinks, std::unique_ptr<EditsFile> edits);
  // After it returns, edits have been kept, and the sinks are no longer called.
  void Stop();

  // Receive, Opened and Closed may be called from any thread. Receive throws Error for an invalid
  // message.
  void Receive(ClientId client, std::string_view message);
  void Opened(ClientId client);
  void Closed(ClientId client);
  // Some page can take a picture. It took `ms` to receive the last one, of `bytes` bytes; 0 bytes:
  // no measurement.
  void Ready(double ms, size_t bytes);

 private:
  enum class Next { kMoving, kRefine, kMeasure, kNothing };
  // A picture that a page has kept as A.
  struct KeptPicture {
    std::shared_ptr<const Image> image;
    bool measured = false;  // compared with the present picture
  };

  void Add(Request request);
  void Run();
  bool Step();
  void Finish();
  void Serve(const Request& request);
  // What each kind of request asks for.
  void Answer(ClientId client, const SetRequest& set);
  void Answer(ClientId client, HistoryRequest step);
  void Answer(ClientId client, const LookRequest& look);
  void Answer(ClientId client, const SamplesRequest& request);
  void Answer(ClientId client, const ExplainRequest& request);
  void Answer(ClientId client, const ConvertRequest& convert);
  void Answer(ClientId client, const KeepRequest& request);
  void Answer(ClientId client, TakeRequest what);
  void Answer(ClientId client, const WelcomeRequest& request);
  void Answer(ClientId client, OfferedRequest what);
  void KeepEdits(bool at_once);
  SharedBytes TakeExr();
  SharedBytes TakeReport(ClientId client);
  bool AnyToMeasure() const;
  void Measure();
  void SayScene(ClientId client);
  void Changed();
  void CheckFiles();
  // The settings of the picture at rest, with its sides divided.
  ImageSettings RestingImage(int divisor = 1) const;
  int FitDivisor() const;
  void Plan(int divisor, bool moving = false);
  void RenderMoving();
  void Refine();
  void Adapt(double ms);
  void Publish(bool moving = false);
  RenderSettings Settings(bool adaptive = false);

  const WorkerOptions options_;
  WorkerSinks sinks_;

  std::mutex mutex_;
  std::condition_variable woken_;
  Mailbox mailbox_;                // guarded by mutex_
  std::vector<ClientId> clients_;  // guarded by mutex_
  bool ready_ = false;             // guarded by mutex_: a page waits for a picture
  double ms_per_byte_ = 0;         // guarded by mutex_: transmission time of pictures
  bool stop_ = false;              // guarded by mutex_
  bool refining_ = false;          // guarded by mutex_: the current work may be cancelled
  std::atomic<bool> cancel_ = false;

  // Used by the worker's thread only.
  std::unique_ptr<ViewDocument> document_;
  DisplaySettings display_;
  std::string layer_;
  uint32_t revision_ = 1;
  int divisor_ = 1;  // of the size while the scene is being changed
  bool moved_ = true;
  std::optional<FramePlan> plan_;
  FrameFilm film_;
  Image image_;  // the last finished one, which pages see
  Image next_;   // being rendered, perhaps incomplete
  bool done_ = false;
  std::map<ClientId, KeptPicture> kept_;
  double render_ms_ = 0;
  std::string banner_;
  std::chrono::steady_clock::time_point last_change_, last_files_;
  std::unique_ptr<EditsFile> edits_;
  bool edits_to_keep_ = false;  // there are newer edits than in the file
  bool edits_failed_ = false;   // pages have been told of it
  std::chrono::steady_clock::time_point keep_edits_at_;
  std::thread thread_;
};

}  // namespace nacre
