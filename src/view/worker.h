// SPDX-License-Identifier: Apache-2.0
// view/worker.h: the thread that owns the scene: it takes what pages ask for, renders, and gives
// away pictures. While something moves, pictures keep to a time; then they are refined.
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
  int samples = 0;       // of a pixel at rest; 0: the scene's
  double max_error = 0;  // > 0: adaptive at rest, as --max-error
  int threads = 0;
  DisplaySettings display;
  // What the command line says of the scene, for the page's own command line.
  std::string generator;  // "nacre 0.2.0 (c0ffee)"
  std::string file;
  std::vector<std::string> given;  // options that have changed it
  // A page of A and B, as `nacre report` makes one.
  std::function<std::string(const Image& a, const Image& b, const DisplaySettings&)> make_report;
};

// What the worker's pictures and answers go to. Called from its thread.
struct WorkerSinks {
  std::function<void(SharedBytes)> show;            // to all pages
  std::function<void(ClientId, std::string)> say;   // JSON; client 0: to all
  std::function<void(ClientId, SharedBytes)> send;  // samples and files, to one
};

// Makes the document. Throws Error.
using OpenDocument = std::function<std::unique_ptr<ViewDocument>()>;

class Worker {
 public:
  // Opens the document in this thread, whose errors come out.
  Worker(const OpenDocument& open, const WorkerOptions& options);
  ~Worker();  // ends it, whatever it does
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  // `edits`, if any: where edits are kept beyond the server's end.
  void Start(WorkerSinks sinks, std::unique_ptr<EditsFile> edits);
  // The sinks are not called any more, and edits have been kept.
  void Stop();

  // From any thread. Throws Error for a message that is not understood.
  void Receive(ClientId client, std::string_view message);
  void Opened(ClientId client);
  void Closed(ClientId client);
  // Some page could take a picture now. It took `ms` to have the last one, of so many bytes.
  void Ready(double ms, size_t bytes);

 private:
  enum class Next { kMoving, kRefine, kMeasure, kNothing };
  // A picture that a page has kept as A.
  struct KeptPicture {
    std::shared_ptr<const Image> image;
    bool measured = false;  // against the present picture
  };

  void Add(Request request);
  void Run();
  bool Step();
  void Finish();
  void Serve(const Request& request);
  void Answer(const Request& request);
  void ServeSet(ClientId client, const SetRequest& set);
  void ServeHistory(HistoryRequest step);
  void ServeConvert(ClientId client, const ConvertRequest& convert);
  void ServeOffered(ClientId client, OfferedRequest what);
  void KeepEdits(bool at_once);
  void Explain(ClientId client, const ExplainRequest& request);
  void SendSamples(ClientId client, const SamplesRequest& request);
  void Keep(ClientId client, bool keep);
  void Take(ClientId client, TakeRequest what);
  SharedBytes TakeExr();
  SharedBytes TakeReport(ClientId client);
  bool AnyToMeasure() const;
  void Measure();
  void SayScene(ClientId client);
  void Changed();
  void CheckFiles();
  ImageSettings FullImage() const;
  int FitDivisor() const;
  void Plan(int divisor, bool moving = false);
  void RenderMoving();
  void Refine();
  void Adapt(double ms);
  void Publish(bool done, bool moving = false);
  RenderSettings Settings();

  const WorkerOptions options_;
  WorkerSinks sinks_;

  std::mutex mutex_;
  std::condition_variable woken_;
  Mailbox mailbox_;                // under mutex_
  std::vector<ClientId> clients_;  // under mutex_
  bool ready_ = false;             // under mutex_: a page waits for a picture
  double ms_per_byte_ = 0;         // under mutex_: of pictures on their way
  bool stop_ = false;              // under mutex_
  bool refining_ = false;          // under mutex_: what runs may be cancelled
  std::atomic<bool> cancel_ = false;

  // Of the thread alone.
  std::unique_ptr<ViewDocument> document_;
  DisplaySettings display_;
  std::string layer_;
  uint32_t revision_ = 1;
  int divisor_ = 1;  // of the size while something moves
  bool moved_ = true;
  std::optional<FramePlan> plan_;
  FrameFilm film_;
  Image image_;  // the last that was finished, which is what pages see
  Image next_;   // being rendered, which may end half-way
  bool done_ = false;
  std::map<ClientId, KeptPicture> kept_;
  double render_ms_ = 0;
  std::string banner_;
  std::chrono::steady_clock::time_point last_change_, last_files_;
  std::unique_ptr<EditsFile> edits_;
  bool edits_to_keep_ = false;  // there are newer ones than in the file
  bool edits_failed_ = false;   // which pages have been told
  std::chrono::steady_clock::time_point keep_edits_at_;
  std::thread thread_;
};

}  // namespace nacre
