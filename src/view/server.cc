// SPDX-License-Identifier: Apache-2.0
#include "view/server.h"

#include <algorithm>
#include <chrono>
#include <deque>
#include <list>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <fmt/format.h>

#include "base/error.h"
#include "view/answer.h"
#include "view/token.h"

namespace nacre {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using Tcp = asio::ip::tcp;
using boost::system::error_code;
using Clock = std::chrono::steady_clock;
using HttpRequest = http::request<http::empty_body>;
using HttpResponse = http::response<http::string_body>;

// Limit on connections that have not shown the token; one more closes the oldest. They do not keep
// out clients that have the token.
constexpr size_t kMaxStrangers = 64;
constexpr size_t kMaxPages = 16;  // pages with a socket
constexpr uint32_t kMaxHeaderBytes = 8 << 10;
constexpr size_t kMaxMessageBytes = 1 << 20;
// Timeout for a request, which is small and comes at once.
constexpr std::chrono::seconds kRequestTime(5);
// Timeout for a page that receives nothing: it is gone, or asleep, and will reconnect.
constexpr std::chrono::seconds kIdleTime(60);
// Limit on data that waits for slow pages, for all together: a file or two. Beyond it, the slowest
// page is disconnected.
constexpr size_t kMaxWaitingBytes = size_t{384} << 20;
constexpr std::chrono::milliseconds kTick(50);
// Pictures are sent in pieces, of which at most kPiecesAhead are unacknowledged. So the rest of a
// refined picture need not be sent when a change supersedes it.
constexpr size_t kPieceBytes = size_t{512} << 10;
constexpr int kPiecesAhead = 2;

// The answer to clients that have the token, but use another name for the server.
constexpr char kOtherName[] =
    "nacre view: the browser calls this server {0}, and that is not its own name.\n"
    "Through a tunnel (ssh -L) or a proxy, start it with\n\n    nacre view --origin {0} ...\n\n"
    "(https:// behind a proxy with TLS) and open the address that it prints then.\n";

std::string_view View(beast::string_view text) { return {text.data(), text.size()}; }

}  // namespace

class PageSocket;
class HttpConnection;

struct Server::Impl {
  Impl(ServerOptions server_options, ServedPage served, ServerEvents server_events)
      : options(std::move(server_options)),
        page(std::move(served)),
        events(std::move(server_events)),
        acceptor(context) {}

  void Listen();
  void Accept();
  std::string HostName() const;
  bool IsOwnHost(std::string_view host) const;
  bool IsOwnOrigin(std::string_view origin) const;
  // The HTTP status for a request: 200 if the token and the names that it uses for the server are
  // right.
  unsigned Judge(const HttpRequest& request) const;
  bool HasToken(const HttpRequest& request) const;
  // The origin by which a browser with the token calls the server, if that is not the server's own
  // name; else empty.
  std::string OtherName(const HttpRequest& request) const;
  HttpResponse Answer(const HttpRequest& request, unsigned status) const;

  ServerOptions options;
  ServedPage page;
  ServerEvents events;
  std::list<HttpConnection*> strangers;  // must outlive the context, whose handlers own connections
  asio::io_context context{1};
  Tcp::acceptor acceptor;
  bool accepting = false;
  uint16_t port = 0;
  std::set<std::string> other_names;  // those reported already
  ClientId last_client = 0;
  std::map<ClientId, std::shared_ptr<PageSocket>> pages;
  size_t waiting_bytes = 0;  // for all pages
  SharedBytes latest;
};

namespace {

// Runs work of a connection, which is closed if that throws.
template <class Connection, class Work>
void DoFor(Connection* connection, const Work& work) {
  try {
    work();
  } catch (...) {
    connection->Close();
  }
}

// A completion handler of the connection, which also closes it on errors.
template <class Connection, class Work>
auto HandlerOf(std::shared_ptr<Connection> connection, Work work) {
  return [connection = std::move(connection), work = std::move(work)](error_code error,
                                                                      size_t /*bytes*/ = 0) {
    if (error) return connection->Close();
    DoFor(connection.get(), work);
  };
}

}  // namespace

// ---- A page's WebSocket -------------------------------------------------------------------------

// At most one picture at a time is in transit to a page, which acknowledges each piece with
// "taken". Only the differences from the page's last complete picture are sent.
class PageSocket : public std::enable_shared_from_this<PageSocket> {
 public:
  PageSocket(Server::Impl* server, Tcp::socket socket, ClientId id)
      : server_(server), socket_(std::move(socket)), id_(id) {}

  void Accept(const HttpRequest& request) {
    websocket::stream_base::timeout limits{};
    limits.handshake_timeout = kRequestTime;
    limits.idle_timeout = kIdleTime;
    limits.keep_alive_pings = true;
    socket_.set_option(limits);
    socket_.read_message_max(kMaxMessageBytes);
    socket_.auto_fragment(false);  // sends a picture as a single frame, not as nine hundred
    socket_.binary(true);
    socket_.async_accept(request, HandlerOf(shared_from_this(), [this] {
                           server_->pages[id_] = shared_from_this();
                           open_ = true;
                           server_->events.opened(id_);
                           server_->events.ready(0, 0);
                           Read();
                         }));
  }

  // Removes the page from the server. Does not throw.
  void Close() {
    beast::close_socket(beast::get_lowest_layer(socket_));
    if (!std::exchange(open_, false)) return;
    server_->waiting_bytes -= std::exchange(waiting_bytes_, 0);
    server_->events.closed(id_);
    server_->pages.erase(id_);
  }

  void Say(std::shared_ptr<const std::string> text) { Add({std::move(text), nullptr}); }
  void Send(SharedBytes bytes) { Add({nullptr, std::move(bytes)}); }

  // To be called when there is a newer picture, or room for another piece.
  void Show() {
    const SharedBytes& latest = server_->latest;
    if (sending_ == nullptr || IsOvertaken()) {
      if (latest == shown_ || latest == nullptr) return;
      sending_ = latest;
      pieces_.emplace(shown_.get(), latest, kPieceBytes);
      next_piece_ = 0;
      behind_others_ = in_flight_ > 0;
    }
    for (; in_flight_ < kPiecesAhead && next_piece_ < pieces_->count(); ++in_flight_) {
      if (next_piece_ == 0) sent_at_ = Clock::now();
      Add({nullptr, pieces_->Piece(next_piece_++)});
    }
  }

 private:
  struct Outgoing {
    std::shared_ptr<const std::string> text;
    SharedBytes bytes;
    size_t size() const { return text ? text->size() : bytes->size(); }
  };

  // Whether the picture in transit is superseded and can be abandoned. A picture made while the
  // scene changes is always completed, however slow the page is, and so is one whose last piece has
  // been sent.
  bool IsOvertaken() const {
    if (sending_ == server_->latest || next_piece_ == pieces_->count()) return false;
    return HeadOf(*sending_).moving == 0 && HeadOf(*server_->latest).moving != 0;
  }

  void Taken() {
    if (in_flight_ == 0) return;
    --in_flight_;
    if (in_flight_ > 0 || next_piece_ < pieces_->count()) return Show();
    const bool moving = HeadOf(*sending_).moving != 0;
    shown_ = std::exchange(sending_, nullptr);
    pieces_.reset();
    if (shown_ != server_->latest) return Show();
    const std::chrono::duration<double, std::milli> taken = Clock::now() - sent_at_;
    // If older pieces were in transit, too, the time says nothing about pictures of a changing
    // scene.
    const bool is_measure = moving && !behind_others_;
    server_->events.ready(taken.count(), is_measure ? shown_->size() : 0);
  }

  void Read() {
    socket_.async_read(buffer_, HandlerOf(shared_from_this(), [this] {
                         if (!socket_.got_text()) return Close();
                         const std::string text = beast::buffers_to_string(buffer_.data());
                         buffer_.consume(buffer_.size());
                         Received(text);
                         if (open_) Read();
                       }));
  }

  void Received(const std::string& text) {
    if (text == "taken") return Taken();
    try {
      server_->events.message(id_, text);
    } catch (...) {
      Say(std::make_shared<const std::string>(CaughtFault("")));
    }
  }

  void Add(Outgoing message) {
    if (!open_) return;
    const size_t bytes = message.size();
    waiting_.push_back(std::move(message));
    waiting_bytes_ += bytes;
    server_->waiting_bytes += bytes;
    if (waiting_.size() == 1) Write();
    if (server_->waiting_bytes <= kMaxWaitingBytes) return;
    const auto slowest = std::ranges::max_element(
        server_->pages, {}, [](const auto& page) { return page.second->waiting_bytes_; });
    const auto page = slowest->second;  // a copy, since closing removes it from `pages`
    page->Close();
  }

  void Write() {
    const Outgoing& next = waiting_.front();
    socket_.text(next.text != nullptr);
    const auto data = next.text ? asio::buffer(*next.text) : asio::buffer(*next.bytes);
    socket_.async_write(data, HandlerOf(shared_from_this(), [this] {
                          if (!open_) return;
                          waiting_bytes_ -= waiting_.front().size();
                          server_->waiting_bytes -= waiting_.front().size();
                          waiting_.pop_front();
                          if (!waiting_.empty()) Write();
                        }));
  }

  Server::Impl* server_;
  websocket::stream<beast::tcp_stream> socket_;
  ClientId id_;
  beast::flat_buffer buffer_;
  bool open_ = false;
  std::deque<Outgoing> waiting_;  // the first one is being written
  size_t waiting_bytes_ = 0;
  SharedBytes shown_, sending_;  // the last complete picture, and the one in transit
  std::optional<PicturePieces> pieces_;
  uint32_t next_piece_ = 0;
  int in_flight_ = 0;           // unacknowledged pieces, including those of superseded pictures
  Clock::time_point sent_at_;   // when the first piece was sent
  bool behind_others_ = false;  // pieces of a superseded picture were in transit, too
};

// ---- An HTTP connection -------------------------------------------------------------------------

// Serves one request, after which the connection is closed or becomes a page's socket.
class HttpConnection : public std::enable_shared_from_this<HttpConnection> {
 public:
  HttpConnection(Server::Impl* server, Tcp::socket socket)
      : server_(server),
        stream_(std::move(socket)),
        place_(server->strangers.insert(server->strangers.end(), this)) {}
  ~HttpConnection() { BeKnown(); }

  void Start() {
    parser_.header_limit(kMaxHeaderBytes);
    parser_.body_limit(0);
    stream_.expires_after(kRequestTime);
    http::async_read(stream_, buffer_, parser_, HandlerOf(shared_from_this(), [this] { Serve(); }));
  }

  // Does not throw.
  void Close() {
    BeKnown();
    stream_.close();
  }

 private:
  // Removes the connection from the strangers.
  void BeKnown() {
    if (!std::exchange(is_stranger_, false)) return;
    server_->strangers.erase(place_);
  }

  void Serve() {
    const HttpRequest& request = parser_.get();
    const unsigned status = server_->Judge(request);
    if (status == 200) BeKnown();
    if (status == 200 && websocket::is_upgrade(request)) {
      stream_.expires_never();
      if (server_->pages.size() >= kMaxPages) return Write(server_->Answer(request, 503));
      const auto page =
          std::make_shared<PageSocket>(server_, stream_.release_socket(), ++server_->last_client);
      return DoFor(page.get(), [&] { page->Accept(request); });
    }
    const std::string other = server_->OtherName(request);
    constexpr size_t kMaxNames = 8;
    if (!other.empty() && server_->other_names.size() < kMaxNames &&
        server_->other_names.insert(other).second) {
      server_->events.other_name(other);
    }
    Write(server_->Answer(request, status));
  }

  void Write(HttpResponse answer) {
    answer_ = std::move(answer);
    stream_.expires_after(kRequestTime);
    http::async_write(stream_, *answer_, HandlerOf(shared_from_this(), [this] {
                        error_code ignored;
                        stream_.socket().shutdown(Tcp::socket::shutdown_send, ignored);
                      }));
  }

  Server::Impl* server_;
  beast::tcp_stream stream_;
  std::list<HttpConnection*>::iterator place_;  // in server_->strangers
  bool is_stranger_ = true;
  beast::flat_buffer buffer_{kMaxHeaderBytes};
  http::request_parser<http::empty_body> parser_;
  std::optional<HttpResponse> answer_;
};

// ---- The server ---------------------------------------------------------------------------------

namespace {

// Whether the text is an origin as browsers write it: a scheme and a host, with nothing after it.
bool IsOrigin(std::string_view text) {
  const size_t host = text.starts_with("https://") ? 8 : text.starts_with("http://") ? 7 : 0;
  return host > 0 && text.size() > host &&
         text.substr(host).find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789._-:[]") ==
             std::string_view::npos;
}

// Runs work(page) for a client's page; client 0: for all pages.
template <class Work>
void ForPages(Server::Impl* server, ClientId client, const Work& work) {
  const auto pages = server->pages;  // a copy, since a page that fails is removed
  for (const auto& [id, page] : pages) {
    if (client == 0 || id == client) DoFor(page.get(), [&work, &page = page] { work(page.get()); });
  }
}

}  // namespace

void Server::Impl::Listen() {
  error_code error;
  if (!options.origin.empty() && !IsOrigin(options.origin)) {
    throw Error(
        ExitCode::kUsage, "--origin", fmt::format("\"{}\" is no origin", options.origin),
        "https://HOST in lower case, as browsers call the proxy, with its port if it has one");
  }
  const auto address = asio::ip::make_address(options.address, error);
  if (error) {
    throw Error(ExitCode::kUsage, "--listen", fmt::format("\"{}\" is no address", options.address),
                "127.0.0.1 or ::1 for this machine alone, an address of its own for others");
  }
  if (address.is_unspecified() && options.origin.empty()) {
    throw Error(
        ExitCode::kUsage, "--listen",
        fmt::format("{} stands for all addresses, and no browser calls it so", options.address),
        "one address of this machine; or --origin, how browsers call the proxy ahead");
  }
  const Tcp::endpoint endpoint(address, options.port);
  acceptor.open(endpoint.protocol(), error);
  if (!error) acceptor.set_option(asio::socket_base::reuse_address(true), error);
  if (!error) acceptor.bind(endpoint, error);
  if (!error) acceptor.listen(asio::socket_base::max_listen_connections, error);
  if (error) {
    throw Error(ExitCode::kUsage, fmt::format("{}:{}", options.address, options.port),
                fmt::format("cannot listen: {}", error.message()),
                options.port != 0 ? "another --port, or none for one that is free" : "");
  }
  port = acceptor.local_endpoint().port();
}

void Server::Impl::Accept() {
  acceptor.async_accept([this](error_code error, Tcp::socket socket) {
    accepting = false;
    // If the process has too many open files, the next tick tries again.
    if (error) return;
    error_code ignored;
    socket.set_option(Tcp::no_delay(true), ignored);
    if (strangers.size() >= kMaxStrangers) strangers.front()->Close();
    const auto connection = std::make_shared<HttpConnection>(this, std::move(socket));
    DoFor(connection.get(), [&] { connection->Start(); });
    Accept();
  });
  accepting = true;
}

std::string Server::Impl::HostName() const {
  const bool v6 = options.address.find(':') != std::string::npos;
  return fmt::format(fmt::runtime(v6 ? "[{}]:{}" : "{}:{}"), options.address, port);
}

bool Server::Impl::IsOwnHost(std::string_view host) const {
  if (host == HostName() || host == fmt::format("localhost:{}", port)) return true;
  return !options.origin.empty() && host == options.origin.substr(options.origin.find("//") + 2);
}

bool Server::Impl::IsOwnOrigin(std::string_view origin) const {
  return origin == "http://" + HostName() || origin == fmt::format("http://localhost:{}", port) ||
         (!options.origin.empty() && origin == options.origin);
}

namespace {

// The first segment of the path "/TOKEN/...", and the rest, with its slash.
struct TargetParts {
  std::string_view token, path;
};
TargetParts PartsOf(const HttpRequest& request) {
  const std::string_view target = View(request.target());
  const size_t slash = target.find('/', 1);
  if (target.empty() || target[0] != '/' || slash == std::string_view::npos) return {};
  return {target.substr(1, slash - 1), target.substr(slash)};
}

}  // namespace

bool Server::Impl::HasToken(const HttpRequest& request) const {
  return SameToken(options.token, PartsOf(request).token);
}

unsigned Server::Impl::Judge(const HttpRequest& request) const {
  // A foreign page whose host name resolves to this server (DNS rebinding) uses that name as the
  // host.
  if (!IsOwnHost(View(request[http::field::host]))) return 403;
  const std::string_view origin = View(request[http::field::origin]);
  const bool upgrade = websocket::is_upgrade(request);
  if ((upgrade || !origin.empty()) && !IsOwnOrigin(origin)) return 403;
  if (request.method() != http::verb::get) return 405;
  const std::string_view path = PartsOf(request).path;
  if (path.empty()) return 404;
  if (!HasToken(request)) return 403;
  return path == (upgrade ? "/socket" : "/") ? 200 : 404;
}

std::string Server::Impl::OtherName(const HttpRequest& request) const {
  if (!HasToken(request)) return "";
  const std::string_view host = View(request[http::field::host]);
  std::string name(View(request[http::field::origin]));
  if (name.empty() || IsOwnOrigin(name)) name = fmt::format("http://{}", host);
  return IsOrigin(name) && !IsOwnOrigin(name) ? name : "";
}

HttpResponse Server::Impl::Answer(const HttpRequest& request, unsigned status) const {
  HttpResponse answer(static_cast<http::status>(status), request.version());
  answer.keep_alive(false);
  answer.set(http::field::cache_control, "no-store");
  answer.set("X-Content-Type-Options", "nosniff");
  answer.set("Referrer-Policy", "no-referrer");
  answer.set("Cross-Origin-Opener-Policy", "same-origin");
  answer.set("Cross-Origin-Resource-Policy", "same-origin");
  const std::string host(View(request[http::field::host]));
  answer.set(
      "Content-Security-Policy",
      status == 200
          ? fmt::format("default-src 'none'; script-src {}; style-src {}; img-src data: blob:; "
                        "connect-src 'self' {}://{}; base-uri 'none'; form-action 'none'; "
                        "frame-ancestors 'none'",
                        page.script_hashes, page.style_hashes,
                        options.origin.starts_with("https:") ? "wss" : "ws", host)
          : "default-src 'none'; frame-ancestors 'none'");
  answer.set(http::field::content_type,
             status == 200 ? "text/html; charset=utf-8" : "text/plain; charset=utf-8");
  const std::string other = OtherName(request);
  answer.body() = status == 200    ? page.html
                  : !other.empty() ? fmt::format(kOtherName, other)
                  : status == 403  ? "nacre view: this is not the address that it has printed\n"
                  : status == 503  ? "nacre view: too many pages are open\n"
                                   : "nacre view: there is nothing here\n";
  answer.prepare_payload();
  return answer;
}

Server::Server(ServerOptions options, ServedPage page, ServerEvents events)
    : impl_(std::make_unique<Impl>(std::move(options), std::move(page), std::move(events))) {
  impl_->Listen();
}

Server::~Server() { impl_->pages.clear(); }

std::string Server::url() const {
  const ServerOptions& options = impl_->options;
  if (!options.origin.empty()) return fmt::format("{}/{}/", options.origin, options.token);
  return fmt::format("http://{}/{}/", impl_->HostName(), options.token);
}

void Server::Run(const std::function<bool()>& stopped) {
  const auto work = asio::make_work_guard(impl_->context);  // keeps the context running even if it
                                                            // does not accept
  while (!stopped()) {
    try {
      if (!impl_->accepting) impl_->Accept();
      impl_->context.run_for(kTick);
      impl_->events.tick();
    } catch (...) {  // A handler failed and its connection was closed; the others go on.
    }
  }
}

void Server::Show(SharedBytes frame) {
  asio::post(impl_->context, [impl = impl_.get(), frame = std::move(frame)] {
    impl->latest = frame;
    ForPages(impl, 0, [](PageSocket* page) { page->Show(); });
  });
}

void Server::Say(ClientId client, std::string text) {
  asio::post(impl_->context, [impl = impl_.get(), client,
                              text = std::make_shared<const std::string>(std::move(text))] {
    ForPages(impl, client, [&](PageSocket* page) { page->Say(text); });
  });
}

void Server::Serve(ServedPage page) {
  asio::post(impl_->context, [impl = impl_.get(), page = std::move(page)] { impl->page = page; });
}

void Server::Send(ClientId client, SharedBytes bytes) {
  asio::post(impl_->context, [impl = impl_.get(), client, bytes = std::move(bytes)] {
    ForPages(impl, client, [&](PageSocket* page) { page->Send(bytes); });
  });
}

}  // namespace nacre
