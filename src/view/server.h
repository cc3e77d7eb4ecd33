// SPDX-License-Identifier: Apache-2.0
// view/server.h: serves one page and its connections over HTTP and WebSocket, with Boost.Beast.
// Clients that do not know the token, or use another name than the server's own, get nothing. An
// error of a connection closes that connection, and affects nothing else.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "view/frame.h"
#include "view/mailbox.h"

namespace nacre {

struct ServerOptions {
  std::string address = "127.0.0.1";
  uint16_t port = 0;   // 0: any free port
  std::string token;   // the secret in the address: http://ADDRESS:PORT/TOKEN/
  std::string origin;  // of a proxy ahead, which browsers then name: "https://example.org"
};

// The page that is served at /TOKEN/.
struct ServedPage {
  std::string html;
  std::string style_hashes, script_hashes;  // 'sha256-...', as the page's policy lists them
};

// All are called by the thread that is in Run.
struct ServerEvents {
  std::function<void(ClientId)> opened, closed;
  std::function<void(ClientId, std::string_view)> message;  // throws Error for an invalid message
  // A page can take a picture. It took `ms` to receive the changes in the last one, which has
  // `bytes` bytes as a whole; 0: the time is no measure for pictures of a changing scene.
  std::function<void(double ms, size_t bytes)> ready;
  std::function<void()> tick;  // called twenty times a second
  // A page that knows the token uses another name for the server, as browsers do at the far end of
  // a tunnel. Called once for each name.
  std::function<void(const std::string& origin)> other_name;
};

class Server {
 public:
  // Starts to listen. Throws Error (kUsage) if that fails.
  Server(ServerOptions options, ServedPage page, ServerEvents events);
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  std::string url() const;  // including the token

  // Serves until stopped() is true, which is checked twenty times a second.
  void Run(const std::function<bool()>& stopped);

  // These can be called from any thread. Show: a page that has not received the last picture gets
  // the newest one after that.
  void Show(SharedBytes frame);
  void Say(ClientId client, std::string text);  // client 0: all pages
  void Send(ClientId client, SharedBytes bytes);
  void Serve(ServedPage page);  // replaces the page for new requests

  struct Impl;

 private:
  std::unique_ptr<Impl> impl_;
};

}  // namespace nacre
