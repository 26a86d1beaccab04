// SPDX-License-Identifier: Apache-2.0
// A small HTTP client over plain sockets, for servers of this machine.
#pragma once

#include <chrono>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "link/tcp_client.h"

namespace navvy::link::testing {

/// Answer to a request.
struct Reply {
  int status = 0;
  std::string head, body;
};

/// Returns port and path of an address such as http://127.0.0.1:8080/token/.
struct Address {
  explicit Address(const std::string& url) {
    const std::size_t colon = url.rfind(':'), slash = url.find('/', colon);
    port = std::stoi(url.substr(colon + 1, slash - colon - 1));
    path = url.substr(slash);
  }
  std::string host() const { return "127.0.0.1:" + std::to_string(port); }
  int port = 0;
  std::string path;
};

/// Sends a request with these header lines and a body; returns the open socket.
inline int send_request(int port, const std::string& first, const std::string& headers,
                        const std::string& body = "") {
  const int file = connected(port);
  std::string text = first + " HTTP/1.1\r\n" + headers;
  if (!body.empty()) text += "Content-Length: " + std::to_string(body.size()) + "\r\n";
  text += "\r\n" + body;
  EXPECT_EQ(::send(file, text.data(), text.size(), MSG_NOSIGNAL),
            static_cast<ssize_t>(text.size()));
  return file;
}

/// Sends a request and reads the whole answer.
inline Reply ask(int port, const std::string& first, const std::string& headers,
                 const std::string& body = "") {
  const int file = send_request(port, first, headers, body);
  std::string all;
  for (std::string part = receive(file, 1); !part.empty(); part = receive(file, 1 << 16))
    all += part;
  ::close(file);
  Reply out;
  const std::size_t end = all.find("\r\n\r\n");
  if (end == std::string::npos || all.rfind("HTTP/1.1 ", 0) != 0) return out;
  out.status = std::stoi(all.substr(9, 3));
  out.head = all.substr(0, end);
  out.body = all.substr(end + 4);
  return out;
}

inline Reply get(const Address& at, const std::string& rest) {
  return ask(at.port, "GET " + at.path + rest, "Host: " + at.host() + "\r\n");
}

/// Sends a command; returns the answer.
inline Reply post(const Address& at, const std::string& body) {
  return ask(at.port, "POST " + at.path + "control",
             "Host: " + at.host() + "\r\nContent-Type: application/json\r\n", body);
}

/// A stream of server-sent events.
class Events {
 public:
  explicit Events(const Address& at)
      : file_(send_request(at.port, "GET " + at.path + "events", "Host: " + at.host() + "\r\n")) {}
  ~Events() { leave(); }
  Events(const Events&) = delete;
  Events& operator=(const Events&) = delete;

  /// Closes the connection as a killed browser does.
  void leave() {
    if (file_ >= 0) ::close(file_);
    file_ = -1;
  }
  /// Returns the data of the next event; discarded JSON if the stream ends or none comes for 10 s.
  nlohmann::json next() {
    for (;;) {
      const std::size_t end = text_.find("\n\n");
      if (end == std::string::npos) {
        char bytes[65536];
        const ssize_t got = ::recv(file_, bytes, sizeof bytes, 0);
        if (got <= 0) return nlohmann::json::parse("", nullptr, false);
        text_.append(bytes, static_cast<std::size_t>(got));
        continue;
      }
      const std::string event = text_.substr(0, end);
      text_.erase(0, end + 2);
      const std::size_t data = event.find("data: ");
      if (data == std::string::npos) continue;
      is_end_ = event.find("event: end") != std::string::npos;
      return nlohmann::json::parse(event.substr(data + 6), nullptr, false);
    }
  }
  /// Returns true if the last event was the end of the run.
  bool is_end() const { return is_end_; }

 private:
  int file_;
  std::string text_;
  bool is_end_ = false;
};

}  // namespace navvy::link::testing
