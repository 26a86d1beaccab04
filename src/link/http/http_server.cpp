// SPDX-License-Identifier: Apache-2.0
#include "link/http/http_server.h"

#include <httplib.h>
#include <sys/socket.h>

#include <chrono>
#include <thread>

#include "core/error.h"
#include "link/tcp_server.h"

namespace navvy::link {
namespace {

/// Sets the options of the listening socket. Those of the library would let two programs of one
/// user share a port, and a port in use would not be noticed.
void set_options(int file) {
  const int yes = 1;
  ::setsockopt(file, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
}

void send(const HttpAnswer& answer, httplib::Response& response) {
  response.status = answer.status;
  if (!answer.stream) {
    response.set_content(answer.body, answer.type);
    return;
  }
  response.set_chunked_content_provider(
      answer.type, [stream = answer.stream](std::size_t, httplib::DataSink& sink) {
        bool alive = true;
        const bool more = stream([&](std::string_view text) {
          alive = alive && sink.is_writable() && sink.write(text.data(), text.size());
          return alive;
        });
        if (alive && !more) sink.done();
        return alive;
      });
}

}  // namespace

struct HttpServer::State {
  httplib::Server server;
  Handler handler;
  int port = 0;
  std::thread thread;

  void answer(const httplib::Request& in, httplib::Response& out) const;
};

void HttpServer::State::answer(const httplib::Request& in, httplib::Response& out) const {
  const HttpRequest request{in.method,
                            in.path,
                            in.get_header_value("Host"),
                            in.get_header_value("Origin"),
                            in.get_header_value("Content-Type"),
                            in.body};
  try {
    send(handler(request), out);
  } catch (const std::exception& error) {
    send({500, "text/plain; charset=utf-8", std::string(error.what()) + "\n", {}}, out);
  }
}

void HttpServer::require_built(const std::string&) {}

HttpServer::HttpServer(const std::string& option, int port, int threads,
                       std::vector<std::pair<std::string, std::string>> headers, Handler handler)
    : state_(std::make_unique<State>()) {
  State& s = *state_;
  s.handler = std::move(handler);
  const auto answer = [&s](const httplib::Request& in, httplib::Response& out) {
    s.answer(in, out);
  };
  s.server.Get(".*", answer);
  s.server.Post(".*", answer);
  s.server.set_default_headers({headers.begin(), headers.end()});
  s.server.set_socket_options(set_options);
  s.server.set_tcp_nodelay(true);
  // A connection that waits for its next request would hold a thread.
  s.server.set_keep_alive_max_count(1);
  s.server.set_read_timeout(kPatience);
  s.server.set_write_timeout(kPatience);
  s.server.set_payload_max_length(kMostBytes);
  s.server.new_task_queue = [threads] {
    return new httplib::ThreadPool(static_cast<std::size_t>(threads));
  };
  // The check has the better message: it names the cause.
  TcpServer::require_address(option, "tcp:" + std::to_string(port));
  s.port = port != 0 ? (s.server.bind_to_port("127.0.0.1", port) ? port : -1)
                     : s.server.bind_to_any_port("127.0.0.1");
  if (s.port < 0)
    throw InputError(Fault{Fault::Severity::kError, "", 0, option, std::to_string(port),
                           "cannot listen there", "choose another port, or 0 for a free one"});
  s.thread = std::thread([&s] { s.server.listen_after_bind(); });
  // The library ends only a server that has begun to run.
  while (!s.server.is_running()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

HttpServer::~HttpServer() { close(); }

void HttpServer::close() {
  if (!state_->thread.joinable()) return;
  state_->server.stop();
  state_->thread.join();
}

int HttpServer::port() const { return state_->port; }

}  // namespace navvy::link
