// SPDX-License-Identifier: Apache-2.0
#include "link/view_server.h"

#include <sys/random.h>

#include <cstdint>
#include <nlohmann/json.hpp>
#include <utility>

#include "core/error.h"
#include "link/tcp_server.h"

namespace navvy::link {
namespace {

using nlohmann::json;

/// Time between two signs of life of a stream without frames [s]; a client that is gone is noticed
/// by them.
constexpr double kSign = 1;

/// Returns 128 random bits as 32 hexadecimal digits.
std::string random_token() {
  unsigned char bytes[16];
  if (::getrandom(bytes, sizeof bytes, 0) != sizeof bytes)
    throw Error("the system has no random numbers for the address of the page");
  std::string out;
  for (const unsigned char byte : bytes) {
    out += "0123456789abcdef"[byte >> 4];
    out += "0123456789abcdef"[byte & 15];
  }
  return out;
}

/// Compares without a hint in the time taken about the first wrong digit.
bool same(const std::string& a, const std::string& b) {
  if (a.size() != b.size()) return false;
  unsigned different = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    different |= static_cast<unsigned>(static_cast<unsigned char>(a[i] ^ b[i]));
  return different == 0;
}

/// Returns true if the header Host names this machine. A name of another site that resolves to
/// 127.0.0.1 does not. Any port: it may be forwarded, as by ssh -L.
bool is_loopback(const std::string& host) {
  const std::size_t colon = host.rfind(':');
  const std::string name = host.substr(0, colon == std::string::npos ? host.size() : colon);
  return name == "127.0.0.1" || name == "localhost";
}

HttpAnswer refusal(int status, const std::string& text) {
  HttpAnswer out;
  out.status = status;
  out.body = text + "\n";
  return out;
}

HttpAnswer json_answer(int status, const json& value) {
  HttpAnswer out;
  out.status = status;
  out.type = "application/json";
  out.body = value.dump(-1, ' ', false, json::error_handler_t::replace) + "\n";
  return out;
}

/// Returns an event of a stream, whose data is one line.
std::string event(const std::string& name, const std::string& data) {
  return (name.empty() ? "" : "event: " + name + "\n") + "data: " + data + "\n\n";
}

/// Headers of every answer: the address stays secret, and no other page may hold or frame it.
std::vector<std::pair<std::string, std::string>> headers() {
  return {{"Cache-Control", "no-store"},
          {"Referrer-Policy", "no-referrer"},
          {"X-Content-Type-Options", "nosniff"},
          {"X-Frame-Options", "DENY"},
          {"Cross-Origin-Opener-Policy", "same-origin"},
          {"Cross-Origin-Resource-Policy", "same-origin"},
          {"Content-Security-Policy", "frame-ancestors 'none'"}};
}

}  // namespace

ViewServer::ViewServer(const std::string& option, int port, ViewContent content)
    : content_(std::move(content)),
      token_(random_token()),
      // Streams hold a thread each; the others are for short requests.
      server_(option, port, kMostStreams + 8, headers(),
              [this](const HttpRequest& request) { return answer(request); }) {}

void ViewServer::require_port(const std::string& option, int port) {
  HttpServer::require_built(option);
  TcpServer::require_address(option, "tcp:" + std::to_string(port));
}

std::string ViewServer::address() const {
  return "http://127.0.0.1:" + std::to_string(server_.port()) + "/" + token_ + "/";
}

void ViewServer::close() { server_.close(); }

HttpAnswer ViewServer::answer(const HttpRequest& request) const {
  if (!is_loopback(request.host))
    return refusal(403, "this server answers only as 127.0.0.1 or localhost");
  if (!request.origin.empty() && request.origin != "http://" + request.host)
    return refusal(403, "a page of another site asked");
  const std::size_t end = request.path.find('/', 1);
  if (end == std::string::npos || !same(request.path.substr(1, end - 1), token_))
    return refusal(403, "the token in the address is wrong; open the address that navvy printed");
  return dispatch(request, request.path.substr(end + 1));
}

HttpAnswer ViewServer::dispatch(const HttpRequest& request, const std::string& rest) const {
  const bool post = request.method == "POST";
  if (rest == "control" && content_.control)
    return post ? command(request) : refusal(405, "commands are sent by POST");
  if (post) return refusal(rest.empty() || rest == "events" ? 405 : 404, "nothing takes this");
  if (rest.empty()) return {200, "text/html; charset=utf-8", content_.page(), {}};
  if (rest == "events") return events();
  if (content_.file)
    if (std::optional<ViewFile> file = content_.file(rest))
      return {200, file->type, std::move(file->bytes), {}};
  return refusal(404, "there is no such page");
}

HttpAnswer ViewServer::command(const HttpRequest& request) const {
  if (request.type.rfind("application/json", 0) != 0)
    return json_answer(415, {{"error", "commands are of type application/json"}});
  try {
    content_.control(request.body);
  } catch (const InputError& error) {
    return json_answer(400, {{"error", error.what()}});
  }
  return json_answer(200, {{"ok", true}});
}

HttpAnswer ViewServer::events() const {
  const std::shared_ptr<ViewFeed> feed = content_.feed();
  if (!feed) return refusal(404, "there are no frames");
  if (feed->subscribers() >= kMostStreams)
    return refusal(503, "as many pages as possible are open: " + std::to_string(kMostStreams));
  HttpAnswer out;
  out.type = "text/event-stream";
  out.stream = [feed, place = feed->subscribe(), seen = std::uint64_t{0},
                began = false](const HttpAnswer::Write& write) mutable {
    if (!std::exchange(began, true)) return write("retry: 1000\n\n");
    if (const auto update = feed->wait(seen, kSign)) {
      seen = update->number;
      return write(event("", update->text));
    }
    if (const auto end = feed->end()) {
      write(event("end", json(*end).dump(-1, ' ', false, json::error_handler_t::replace)));
      return false;
    }
    return write(":\n\n");
  };
  return out;
}

}  // namespace navvy::link
