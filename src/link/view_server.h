// SPDX-License-Identifier: Apache-2.0
// Serves the live page of a run to browsers of this machine.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "link/http/http_server.h"
#include "link/view_feed.h"

namespace navvy::link {

/// Content of a file that a page links to.
struct ViewFile {
  std::string type, bytes;
};

/// Content of a ViewServer. The functions are called from several threads at the same time.
struct ViewContent {
  /// Returns the page.
  std::function<std::string()> page;
  /// Returns the frames of the run; null if the page needs none.
  std::function<std::shared_ptr<ViewFeed>()> feed;
  /// Carries out a command, which is a JSON object, or throws InputError. Empty: the page can only
  /// look.
  std::function<void(const std::string&)> control;
  /// Returns the file of a path below the page; nothing if there is none. Empty: there are none.
  std::function<std::optional<ViewFile>(const std::string&)> file;
};

/// Serves a page, its stream of frames and its commands on the loopback interface, at an address
/// with a random token: http://127.0.0.1:PORT/TOKEN/.
///
/// Nobody without the token gets anything but status 403, and neither do pages of other sites: the
/// headers Host and Origin must name this machine, and commands must be of type application/json,
/// which browsers do not send across sites unasked.
class ViewServer {
 public:
  /// Starts to serve on `port`, 0 for a free one. `option` names the port's option in messages.
  /// @throws InputError as HttpServer.
  ViewServer(const std::string& option, int port, ViewContent content);
  /// Checks that a server could start. @throws InputError as the constructor.
  static void require_port(const std::string& option, int port);

  /// Returns the address of the page, with its token.
  std::string address() const;
  /// Ends streams and requests. Later calls do nothing.
  void close();

  /// Maximum number of streams at the same time; more are refused with status 503.
  static constexpr int kMostStreams = 16;

 private:
  /// Returns the answer to a request.
  HttpAnswer answer(const HttpRequest& request) const;
  /// Returns the answer for the path `rest` below the page.
  HttpAnswer dispatch(const HttpRequest& request, const std::string& rest) const;
  /// Returns the answer to a command.
  HttpAnswer command(const HttpRequest& request) const;
  /// Returns a stream of frames as server-sent events.
  HttpAnswer events() const;

  ViewContent content_;
  std::string token_;
  HttpServer server_;
};

}  // namespace navvy::link
