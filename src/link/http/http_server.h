// SPDX-License-Identifier: Apache-2.0
// A small HTTP server on the loopback interface; the only place with cpp-httplib.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace navvy::link {

/// A request as a handler sees it. Members that the client did not send are empty.
struct HttpRequest {
  std::string method;  ///< "GET" or "POST"
  std::string path;    ///< decoded path of the address, without a query
  std::string host;    ///< header Host
  std::string origin;  ///< header Origin
  std::string type;    ///< header Content-Type
  std::string body;    ///< content of a POST
};

/// Answer to a request.
struct HttpAnswer {
  /// Sends text to the client. Returns false if the client is gone.
  using Write = std::function<bool(std::string_view)>;

  int status = 200;
  std::string type = "text/plain; charset=utf-8";
  std::string body;
  /// If set, it is called repeatedly to send a stream instead of `body`, until it returns false. It
  /// must return within a second or so, since the server can end only between two calls.
  std::function<bool(const Write&)> stream;
};

/// Serves HTTP on 127.0.0.1, each request in a thread out of a fixed number.
///
/// A client that takes nothing for kPatience seconds is disconnected. Requests of more than
/// kMostBytes are refused.
class HttpServer {
 public:
  /// Answers one request. Called from several threads at the same time. An exception becomes the
  /// status 500.
  using Handler = std::function<HttpAnswer(const HttpRequest&)>;

  /// Starts to serve on `port`, 0 for a free one, with `threads` threads. Every answer gets the
  /// headers `headers`.
  /// @param option name of the option that holds the port, for messages
  /// @throws InputError if the port is in use, or if Navvy was built without HTTP.
  HttpServer(const std::string& option, int port, int threads,
             std::vector<std::pair<std::string, std::string>> headers, Handler handler);
  /// Ends as `close` does.
  ~HttpServer();
  HttpServer(const HttpServer&) = delete;
  HttpServer& operator=(const HttpServer&) = delete;

  /// Checks that this build has HTTP. @throws InputError that says what is missing if it has not.
  static void require_built(const std::string& option);

  /// Accepts no more requests, and waits until the present ones have ended. Later calls do nothing.
  void close();
  /// Returns the port that the server listens on.
  int port() const;

  /// Maximum time that a client may take nothing [s].
  static constexpr int kPatience = 3;
  /// Maximum size of the content of a request [bytes].
  static constexpr std::size_t kMostBytes = std::size_t{64} << 10;

 private:
  /// Server and thread.
  struct State;
  /// Server and thread; never null.
  std::unique_ptr<State> state_;
};

}  // namespace navvy::link
