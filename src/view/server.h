// SPDX-License-Identifier: Apache-2.0
// view/server.h: one page and its connections over HTTP and WebSocket, both by Boost.Beast. Whoever
// does not name the token, or comes by another name than the server's own, gets nothing. Whatever
// goes wrong with a connection closes that one, and ends nothing else.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "view/frame.h"
#include "view/mailbox.h"

namespace nacre {

struct ServerOptions {
  std::string address = "127.0.0.1";
  uint16_t port = 0;   // 0: any that is free
  std::string token;   // of the address: http://ADDRESS:PORT/TOKEN/
  std::string origin;  // of a proxy ahead, which browsers then name: "https://example.org"
};

// What is served at /TOKEN/.
struct ServedPage {
  std::string html;
  std::string style_hashes, script_hashes;  // 'sha256-...' as its policy allows them
};

// Called by the thread in Run.
struct ServerEvents {
  std::function<void(ClientId)> opened, closed;
  std::function<void(ClientId, std::string_view)> message;  // throws Error for a bad one
  // A page could take a picture. It took `ms` to have what was new of the last one, which is of so
  // many bytes in all; 0: that is no measure for one that is made while things move.
  std::function<void(double ms, size_t bytes)> ready;
  std::function<void()> tick;  // twenty times a second
  // A page knows the token, but calls the server by another name than its own: as browsers call it
  // at the other end of a tunnel. Told once of each.
  std::function<void(const std::string& origin)> other_name;
};

class Server {
 public:
  // Listens. Throws Error (kUsage) if it cannot.
  Server(ServerOptions options, ServedPage page, ServerEvents events);
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  std::string url() const;  // with the token

  // Serves until it is stopped, which it asks twenty times a second.
  void Run(const std::function<bool()>& stopped);

  // From any thread. Pages that have not taken the last picture are sent the newest then.
  void Show(SharedBytes frame);
  void Say(ClientId client, std::string text);  // client 0: to all
  void Send(ClientId client, SharedBytes bytes);
  void Serve(ServedPage page);  // from now on in the place of the one before

  struct Impl;

 private:
  std::unique_ptr<Impl> impl_;
};

}  // namespace nacre
